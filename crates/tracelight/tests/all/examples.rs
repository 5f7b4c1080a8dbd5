//! The six example pictures, from pixels to light, against what was really drawn.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot go on may panic, and shows figures"
)]

use serde_json::Value;
use tracelight_stroke::{Comparison, Point, compare_polylines};

use crate::support::{folder, lit_lines, root, rows, trace};

const EXAMPLES: [&str; 6] = ["star", "shapes", "house", "silhouette", "handwriting", "chalk"];
/// 24 in.
const WIDTH_M: f64 = 0.6096;
const TOLERANCE_M: f64 = 2e-3;

/// The truth of an example on the target, m.
fn truth(name: &str) -> Vec<Vec<Point>> {
    let text = std::fs::read_to_string(root().join(format!("examples/truth/{name}.json"))).unwrap();
    let truth: Value = serde_json::from_str(&text).unwrap();
    let scale = WIDTH_M / truth["width_px"].as_f64().unwrap();
    let (w, h) = (truth["width_px"].as_f64().unwrap(), truth["height_px"].as_f64().unwrap());
    let stroke = |s: &Value| {
        let mut line: Vec<Point> = s["points"]
            .as_array()
            .unwrap()
            .iter()
            .map(|p| Point::new(p[0].as_f64().unwrap() - w / 2.0, h / 2.0 - p[1].as_f64().unwrap()))
            .map(|p| Point::new(p.x * scale, p.y * scale))
            .collect();
        if s["closed"] == true {
            line.push(line[0]);
        }
        line
    };
    truth["strokes"].as_array().unwrap().iter().map(stroke).collect()
}

fn figure(summary: &Value, name: &str) -> f64 {
    summary["tracking"][name].as_f64().unwrap()
}

#[test]
fn every_example_is_drawn_true_to_the_picture() {
    let mut bad = Vec::new();
    for name in EXAMPLES {
        let dir = folder(&format!("example-{name}"));
        let summary = trace(&[&format!("examples/{name}.png")], &dir);
        let lit = lit_lines(&rows(&dir));
        let Comparison { rms, coverage, precision, length_ratio, .. } =
            compare_polylines(&lit, &truth(name), TOLERANCE_M).unwrap();
        println!(
            "{name:12} tracking rms {:.3} max {:.3} mm, overshoot {:.3} %, final {:.3} mm; truth rms {:.3} mm, \
             coverage {:.2} %, precision {:.2} %, length {:.3}",
            figure(&summary, "rms_mm"),
            figure(&summary, "max_mm"),
            figure(&summary, "overshoot_percent"),
            figure(&summary, "final_error_mm"),
            rms * 1e3,
            coverage * 100.0,
            precision * 100.0,
            length_ratio
        );
        let good = figure(&summary, "rms_mm") <= 0.04
            && figure(&summary, "max_mm") <= 0.25
            && figure(&summary, "overshoot_percent") <= 0.5
            && figure(&summary, "final_error_mm") <= 0.1
            && rms <= 0.6e-3
            && coverage >= 0.995
            && precision >= 0.995
            && (0.97..=1.04).contains(&length_ratio)
            && summary["laser"]["faults"].as_array().unwrap().is_empty();
        if !good {
            bad.push(name);
        }
    }
    assert!(bad.is_empty(), "beyond their bounds: {bad:?}");
}

#[test]
fn a_picture_that_is_not_the_one_drawn_is_noticed() {
    let dir = folder("example-swapped");
    trace(&["examples/star.png"], &dir);
    let comparison = compare_polylines(&lit_lines(&rows(&dir)), &truth("shapes"), TOLERANCE_M).unwrap();
    assert!(comparison.coverage < 0.5 && comparison.rms > 5e-3);
}

#[test]
fn ten_heads_draw_the_same_star() {
    let runs: Vec<_> = (0..10)
        .map(|seed| {
            let dir = folder(&format!("seed-{seed}"));
            trace(&["examples/star.png", "--seed", &seed.to_string()], &dir);
            rows(&dir)
        })
        .collect();
    let (mut sum, mut count) = (0.0, 0.0);
    for i in (0..runs[0].len()).filter(|&i| runs.iter().all(|r| r[i].lit)) {
        let mean = runs.iter().fold(Point::ORIGIN, |m, r| m + 0.1 * r[i].spot.to_vec2());
        sum += runs.iter().map(|r| r[i].spot.distance_squared(mean)).sum::<f64>();
        count += 10.0;
    }
    let spread_mm = (sum / f64::max(count, 1.0)).sqrt() * 1e3;
    println!("spread over ten seeds: {spread_mm:.3} mm rms");
    assert!(count > 0.0 && spread_mm <= 0.2);
}
