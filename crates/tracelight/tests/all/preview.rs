//! A plan as a picture.

use serde_json::Value;

use crate::support::{folder, run};

const HOUSE: &str = "examples/house.png";

/// The plan's figures, its preview coloured by something, and how wide its lit part is, m.
fn previewed(name: &str, by: &str) -> (Value, String, f64) {
    let dir = folder(name);
    let [svg, csv] = ["plan.svg", "plan.csv"].map(|file| dir.join(file).to_str().unwrap().to_owned());
    let output = run(&["plan", HOUSE, "-o", &csv, "--preview", &svg, "--colour-by", by, "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let csv = std::fs::read_to_string(csv).unwrap();
    let lit_x = csv.lines().skip(1).filter_map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        (fields[1] == "1").then(|| fields[6].parse::<f64>().unwrap())
    });
    let (low, high) = lit_x.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
    let plan = serde_json::from_slice(&output.stdout).unwrap();
    (plan, std::fs::read_to_string(svg).unwrap(), high - low)
}

/// Length of the lit way in an SVG.
fn lit_length(svg: &str) -> f64 {
    let lit = svg.split_once("<g ").unwrap().1.split_once("</g>").unwrap().0;
    let data = lit.split(" d=\"").skip(1).map(|rest| rest.split_once('"').unwrap().0);
    let row = |data: &str| -> f64 {
        let numbers: Vec<f64> =
            data.split(['M', 'L', ' ']).filter(|n| !n.is_empty()).map(|n| n.parse().unwrap()).collect();
        numbers.chunks(2).zip(numbers.chunks(2).skip(1)).map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).sum()
    };
    data.map(row).sum()
}

#[test]
fn a_preview_shows_the_whole_lit_way_whatever_its_colours_say() {
    for by in ["speed", "order", "limit"] {
        let (plan, svg, wide_m) = previewed(&format!("preview-{by}"), by);
        // the drawing is 1000 units wide
        let lit_m = lit_length(&svg) * wide_m / 1000.0;
        let true_m = plan["strokes"]["length_m"].as_f64().unwrap();
        assert!((lit_m / true_m - 1.0).abs() < 0.01, "{by}: {lit_m} m of {true_m} m");
        let numbers = svg.matches("<circle").count() as u64;
        assert_eq!(numbers, plan["strokes"]["count"].as_u64().unwrap());
    }
}

#[test]
fn the_limits_are_named_and_add_up_to_no_more_than_the_lit_time() {
    let (plan, svg, _) = previewed("preview-limits", "limit");
    let limits = plan["limits"].as_object().unwrap();
    let sum: f64 = limits.values().map(|share| share.as_f64().unwrap()).sum();
    assert!(limits["speed_cap"].as_f64().unwrap() > 0.7, "{limits:?}");
    assert!(limits["torque_pan"].as_f64().unwrap() > 0.02, "{limits:?}");
    assert!((0.8..=1.0).contains(&sum), "{sum}");
    assert!(limits.keys().all(|name| svg.contains(&name.replace('_', " "))));
}

#[test]
fn colours_without_a_preview_are_refused() {
    let output = run(&["plan", HOUSE, "--colour-by", "speed"]);
    assert_eq!(output.status.code(), Some(2));
}
