//! The 2006 report made again, by the whole program.

use serde_json::Value;

use crate::support::{folder, lab, run};

/// The numbers beside a name.
fn facts<'a>(book: &'a Value, name: &'a str) -> impl Iterator<Item = (f64, f64)> + 'a {
    let all = book["facts"].as_array().unwrap().iter().filter(move |fact| fact["what"] == name);
    all.map(|fact| (fact["report"].as_f64().unwrap(), fact["ours"].as_f64().unwrap()))
}

#[test]
fn the_book_has_every_figure_and_the_reports_numbers_beside_ours() {
    let dir = folder("lab-book");
    let book = lab(&["reproduce", "-o", dir.to_str().unwrap()]);
    let all = book["facts"].as_array().unwrap();
    assert!(all.len() > 100, "{}", all.len());
    for fact in all {
        assert!(fact["ours"].is_number(), "nothing beside {fact}");
    }
    for (name, share) in [
        ("pan: viscous, forwards, whole curves", 0.01),
        ("tilt: viscous, backwards, whole curves", 0.01),
        ("tilt: Coulomb, forwards, whole curves", 0.001),
        ("G11, s² above", 5e-4),
        ("G11, s below", 5e-4),
        ("G22, 1 below", 5e-4),
        ("trapezoid: duration", 5e-4),
        ("S-curve: highest speed", 5e-4),
        ("scale, level", 2e-3),
    ] {
        let mut found = 0;
        for (report, ours) in facts(&book, name) {
            assert!((ours / report - 1.0).abs() < share, "{name}: {report} {ours}");
            found += 1;
        }
        assert!(found > 0, "{name}");
    }
    // the literal reading is biased, and the page says by how much
    let (report, ours) = facts(&book, "pan: viscous, forwards, last speeds").next().unwrap();
    assert!((3.2..3.6).contains(&(ours / report)));
    let page = std::fs::read_to_string(dir.join("index.html")).unwrap();
    for number in 2..=27 {
        let named = |text: &str| page.contains(&format!("{text} {number}"));
        // pairs and rows are named by their ends
        let within = [(2, 4), (14, 15), (16, 17), (18, 19), (20, 21), (22, 23), (24, 27)];
        let covered = within
            .iter()
            .any(|&(from, to)| (from..=to).contains(&number) && page.contains(&format!("Figures {from}")));
        assert!(named("Figure") || covered, "figure {number}");
    }
    for word in ["+240 %", "Tables 1 and 2", "tracelight lab friction --fixture", "http-equiv"] {
        assert!(page.contains(word), "{word}");
    }
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"), "it needs nothing but itself");
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
    assert!(page.matches("<svg").count() >= 33);
    // the same again to the byte
    let again = folder("lab-book-again");
    let output = run(&["lab", "reproduce", "-o", again.to_str().unwrap(), "--quiet"]);
    assert!(output.status.success());
    let other = std::fs::read_to_string(again.join("index.html")).unwrap();
    assert_eq!(page.replace("lab-book/", ""), other.replace("lab-book-again/", ""));
}
