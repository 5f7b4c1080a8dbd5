//! `lab lesson`: what is printed is what stands in `docs/lessons`, and answers are graded by the program as by the bench.

use serde_json::Value;

use crate::support::{folder, lab, root, run};

fn page(number: usize) -> String {
    std::fs::read_to_string(root().join(format!("docs/lessons/{number}.md"))).unwrap()
}

fn lessons() -> Vec<Value> {
    lab(&["lesson"])["lessons"].as_array().unwrap().clone()
}

#[test]
fn the_pages_are_the_texts_and_ask_what_is_asked() {
    let lessons = lessons();
    assert_eq!(lessons.len(), 8);
    let index = std::fs::read_to_string(root().join("docs/lessons/README.md")).unwrap();
    for (lesson, number) in lessons.iter().zip(1..) {
        let (page, title) = (page(number), lesson["title"].as_str().unwrap());
        assert_eq!(lesson["text"], page.as_str(), "one source");
        assert!(page.starts_with(&format!("# Lesson {number}: {title}\n")), "{title}");
        assert!(index.contains(&format!("{number}. [{title}]({number}.md)\n")), "{title}");
        // the page ends with an answer that has every name, and is not right
        let last = page.trim_end().lines().last().unwrap().trim();
        let words: Vec<&str> = last.strip_prefix("tracelight ").unwrap().split(' ').collect();
        let output = run(&words);
        assert_eq!(output.status.code(), Some(1), "{last}");
        for ask in lesson["asks"].as_array().unwrap() {
            let name = ask["name"].as_str().unwrap();
            assert!(last.contains(&format!("{name}=")), "{last}");
            assert!(page.contains(name), "{name}");
        }
        let printed = String::from_utf8(run(&["lab", "lesson", &number.to_string()]).stdout).unwrap();
        assert!(!printed.contains("```") && !printed.contains("![") && printed.contains("QUESTION"));
        let said = "Plot: tracelight lab lesson";
        assert!(printed.contains(said) && printed.contains(title));
    }
}

/// The plots beside the pages; with `RENEW_DOCS` set they are drawn anew.
#[test]
fn the_pages_plots_are_what_their_lessons_draw() {
    let dir = folder("lesson-plots");
    for number in 1..=8 {
        let drawn = dir.join(format!("{number}.svg"));
        run(&["lab", "lesson", &number.to_string(), "-o", drawn.to_str().unwrap()]);
        let kept = root().join(format!("docs/lessons/{number}.svg"));
        if std::env::var_os("RENEW_DOCS").is_some() {
            std::fs::copy(&drawn, &kept).unwrap();
        }
        let (drawn, kept) = (std::fs::read_to_string(drawn).unwrap(), std::fs::read_to_string(kept).unwrap());
        assert!(drawn == kept, "docs/lessons/{number}.svg is old; RENEW_DOCS=1 draws it anew");
    }
}

#[test]
fn a_right_answer_succeeds_and_a_wrong_one_says_what_helps() {
    let dir = folder("lesson-answers");
    let [svg, csv] = ["mine.svg", "mine.csv"].map(|name| dir.join(name).to_str().unwrap().to_owned());
    let right = run(&["lab", "lesson", "3", "--answer", "kp=40,kd=5", "-o", &svg, "-o", &csv]);
    assert!(right.status.success());
    let text = String::from_utf8(right.stdout).unwrap();
    assert!(text.contains("Right. Next: `tracelight lab lesson 4`"), "{text}");
    assert!(std::fs::read_to_string(&svg).unwrap().contains("your answer: right"));
    let rows = std::fs::read_to_string(&csv).unwrap();
    assert_eq!(rows.lines().count(), 1 + 14 * 3000, "seven small jumps and seven large ones of 3 s");

    let wrong = run(&["lab", "lesson", "3", "--answer", " kd = 1 , kp=20", "--json"]);
    assert_eq!(wrong.status.code(), Some(1));
    let json: Value = serde_json::from_slice(&wrong.stdout).unwrap();
    assert!(json["right"] == false && json["error"]["code"] == "not-yet", "{json}");
    let figures = json["figures"].as_array().unwrap();
    let (met, unmet): (Vec<&Value>, Vec<&Value>) = figures.iter().partition(|figure| figure["met"] == true);
    assert!(!met.is_empty() && unmet.iter().all(|figure| !figure["hint"].as_str().unwrap().is_empty()));
    assert!(unmet.iter().any(|figure| figure["value"].as_f64() > figure["most"].as_f64()));
}

#[test]
fn what_is_no_answer_is_said_and_nothing_is_written() {
    let dir = folder("lesson-refused");
    let csv = dir.join("none.csv").to_str().unwrap().to_owned();
    let refused: [(&[&str], &str); 10] = [
        (&["3", "--answer", "kp=40"], "kd is missing"),
        (&["3", "--answer", "kp=40,kd=5,ki=1"], "ki is not asked for"),
        (&["3", "--answer", "kp=40,kp=5"], "kp is given twice"),
        (&["3", "--answer", "kp=many,kd=5"], "many is no number"),
        (&["3", "--answer", "kp=NaN,kd=5"], "NaN is not between 0 and 10000"),
        (&["3", "--answer", "kp=-1,kd=5"], "-1 is not between"),
        (&["3", "--answer", "forty"], "forty is no name=value"),
        (&["9"], "there are lessons 1 to 8"),
        (&["3", "-o", &csv], "is of an answer"),
        (&["3", "-o", "x.toml"], "lesson 3 is on the preset report"),
    ];
    for (arguments, what) in refused {
        let output = run(&[&["lab", "lesson"], arguments].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(what), "{arguments:?}: {said}");
    }
    assert!(!std::path::Path::new(&csv).exists());
}

/// The seventh lesson much as its text says, with fewer voltages: write its head, identify it, answer with what was found.
#[test]
fn the_heavy_head_is_identified_and_answered() {
    let dir = folder("lesson-heavy");
    let path = |name: &str| dir.join(name).to_str().unwrap().to_owned();
    let rig = path("heavy.toml");
    assert!(run(&["lab", "lesson", "7", "-o", &rig]).status.success());
    let out = path("found");
    let mut command =
        vec!["friction", "--rig", &rig, "--fixture", "--axis", "pan", "--most", "3V", "--step", "0.25V"];
    command.extend(["--pulse", "3V", "--hold", "10s", "--out", &out]);
    let found = lab(&command);
    let of = |name: &str| found["pan"][name].as_f64().unwrap();
    let answer = format!(
        "inertia={},coulomb={},viscous={}",
        of("inertia_kg_m2"),
        of("coulomb_pos"),
        of("viscous_pos")
    );
    assert_eq!(lab(&["lesson", "7", "--answer", &answer])["right"], true, "{answer}");
}

/// Gains on the command line, and the same in a rig file.
#[test]
fn gains_by_hand_are_the_same_on_the_command_line_and_in_a_rig_file() {
    let dir = folder("lesson-gains");
    let rig = dir.join("mine.toml");
    let text = "base = \"report\"\n[control]\nlaw = \"hand-tuned\"\nobserver = \"differences\"\nobserver_interval = \"8ms\"\n\n\
                [control.hand_tuned.tilt]\nkp = \"30Nm/rad\"\nki = \"50Nm/rad/s\"\nkd = \"3Nms/rad\"\nposition_weight = 0.5\n\
                anti_windup = false\nfeedforward = \"none\"\n";
    std::fs::write(&rig, text).unwrap();
    let step = ["lab", "step", "--axis", "tilt", "--to", "10deg", "--json"];
    let by_file = run(&[&step[..], &["--rig", rig.to_str().unwrap()]].concat());
    let gains = ["--gains", "kp=30,ki=50,kd=3,b=0.5", "--anti-windup", "off", "--feedforward", "none"];
    let looks = ["--observer", "differences", "--interval", "8ms"];
    let by_flags = run(&[&step[..], &gains[..], &looks[..]].concat());
    assert!(by_file.status.success());
    assert_eq!(String::from_utf8(by_file.stdout), String::from_utf8(by_flags.stdout));

    let refused: [(&[&str], &str); 6] = [
        (&["--gains", "kd=3"], "kp is missing"),
        (&["--gains", "kp=3,b=2"], "b: 2 is not between 0 and 1"),
        (&["--gains", "kp=3,x=2"], "x is none of kp, ki, kd, b, c"),
        (&["--gains", "kp=3", "--law", "pid"], "law hand-tuned, which --law does not name"),
        (&["--feedforward", "all"], "none of none, gravity, model"),
        (&["--interval", "2.5ms"], "whole number of milliseconds"),
    ];
    for (flags, what) in refused {
        let output = run(&[&step[..], flags].concat());
        let said =
            String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
        assert!(output.status.code() == Some(2) && said.contains(what), "{flags:?}: {said}");
    }
}
