//! Drawings in and out of the whole program: sizes, layers, colours, every kind of file.

use std::path::Path;

use serde_json::Value;

use crate::support::{folder, run};

const PLATE: &str = "crates/formats/tests/data/plate.svg";

/// Runs `strokes … --json`, which must succeed, and returns what it prints and says.
fn strokes(arguments: &[&str]) -> (Value, String) {
    let output = run(&[&["strokes", "--json"], arguments].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    (serde_json::from_slice(&output.stdout).unwrap(), said)
}

fn count(document: &Value) -> usize {
    document["strokes"].as_array().unwrap().len()
}

fn written(folder: &Path, name: &str, more: &[&str]) -> String {
    let path = folder.join(name).to_str().unwrap().to_owned();
    strokes(&[&[PLATE, "-o", &path], more].concat());
    path
}

#[test]
fn layers_and_colours_choose_what_is_traced() {
    let (all, said) = strokes(&[PLATE]);
    assert_eq!(count(&all), 8);
    assert!(said.contains("trace their own files"), "{said}");
    assert_eq!(all["strokes"][0]["layer"], "Cut & drill");
    assert_eq!(all["strokes"][0]["colour"], "#ff0000");
    let check =
        |flags: &[&str], wanted: usize| assert_eq!(count(&strokes(&[&[PLATE], flags].concat()).0), wanted);
    check(&["--layer", "cut & drill"], 3);
    check(&["--layer", "Engrave", "--layer", "marks"], 5);
    check(&["--colour", "red", "--colour", "#12AB34"], 6);
    check(&["--layer", "Engrave", "--colour", "blue"], 2);
}

#[test]
fn what_no_stroke_has_is_refused_with_what_there_is() {
    let check = |flags: &[&str], status: i32, said: &str| {
        let output = run(&[&["plan", PLATE], flags].concat());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{flags:?}: {message}");
        assert!(message.contains(said), "{flags:?}: {message}");
    };
    check(&["--layer", "Score"], 1, "there are: Cut & drill, Engrave, marks");
    check(&["--colour", "lime"], 1, "there are: #ff0000, #0000ff, #12ab34");
    check(&["--colour", "blurple"], 2, "blurple is no colour");
    check(&["--layer", "marks", "--color", "red"], 1, "ask for less");
}

#[test]
fn every_kind_of_file_that_can_be_read_gives_the_same_strokes() {
    let folder = folder("formats");
    for name in ["plate.svg", "plate.dxf", "plate.json", "plate.csv"] {
        let path = written(&folder, name, &["--width", "120mm"]);
        let (back, _) = strokes(&[&path]);
        assert_eq!(count(&back), 8, "{name}");
    }
    for name in ["plate.gcode", "plate.nc", "plate.ild", "plate.hpgl", "plate.plt"] {
        assert!(std::fs::metadata(written(&folder, name, &[])).unwrap().len() > 500, "{name}");
    }
}

#[test]
fn a_dxf_with_a_unit_keeps_its_size() {
    let folder = folder("formats_size");
    let path = written(&folder, "plate.dxf", &[]);
    let (back, _) = strokes(&[&path, "-o", folder.join("back.svg").to_str().unwrap()]);
    // the sheet of a DXF is what is drawn: the plate, 100 × 60 mm
    assert!((back["width_px"].as_f64().unwrap() - 100.0).abs() < 1e-3);
    let svg = std::fs::read_to_string(folder.join("back.svg")).unwrap();
    assert!(svg.contains("width=\"100mm\" height=\"60mm\""), "{svg}");
    assert!(svg.contains("inkscape:label=\"Engrave\"") && svg.contains("stroke=\"#12ab34\""), "{svg}");
    let plan = run(&["plan", &path, "--layer", "engrave", "--json"]);
    let plan: Value = serde_json::from_slice(&plan.stdout).unwrap();
    assert!((plan["target"]["width_m"].as_f64().unwrap() - 0.1).abs() < 1e-6);
    assert_eq!(plan["strokes"]["count"], 2);
}

#[test]
fn an_extension_that_cannot_be_written_is_refused_with_those_that_can() {
    let output = run(&["strokes", PLATE, "-o", "drawing.pdf"]);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{message}");
    let all = [".svg", ".dxf", ".json", ".csv", ".gcode", ".gc", ".nc", ".ngc", ".ild", ".hpgl", ".plt"];
    assert!(all.iter().all(|e| message.contains(e)), "{message}");
}
