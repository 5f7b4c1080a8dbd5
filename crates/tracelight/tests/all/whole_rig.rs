//! A rig file that is not whole drives nothing.

use std::path::Path;

use crate::support::{folder, run};

const STAR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/star.png");

/// Writes a rig file and plans with it: exit status, what is said of it.
fn planned(dir: &Path, name: &str, text: &str, more: &[&str]) -> (Option<i32>, String) {
    let file = dir.join(name).to_str().unwrap().to_owned();
    std::fs::write(&file, text).unwrap();
    let output = run(&[&["plan", STAR, "--rig", &file], more].concat());
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

fn shown(name: &str) -> String {
    String::from_utf8(run(&["rigs", "show", name]).stdout).unwrap()
}

#[test]
fn a_rig_file_that_was_cut_off_or_is_empty_is_refused() {
    let dir = folder("whole-rig-cut");
    let worn = shown("worn");
    let lines = worn.lines().count();
    for share in 1..10 {
        let head: Vec<&str> = worn.lines().take(lines * share / 10).collect();
        let (code, said) = planned(&dir, "cut.toml", &head.join("\n"), &[]);
        assert_eq!(code, Some(2), "{share} tenths: {said}");
        for words in
            ["cut.toml: it ends after", "has no ", "was it cut off?", "begin it with base = \"report\""]
        {
            assert!(said.contains(words), "{share} tenths: {said}");
        }
    }
    let (code, said) = planned(&dir, "empty.toml", "", &[]);
    assert!(code == Some(2) && said.contains("empty.toml is empty"), "{said}");
    assert_eq!(planned(&dir, "worn.toml", &worn, &["--quiet"]), (Some(0), String::new()));
}

#[test]
fn a_rig_file_with_a_base_needs_only_what_differs() {
    let dir = folder("whole-rig-base");
    let text = "base = \"worn\"\nname = \"wide\"\n[control]\ntolerance = \"4mm\"\n";
    assert_eq!(planned(&dir, "wide.toml", text, &["--quiet"]), (Some(0), String::new()));
    let whole = shown(dir.join("wide.toml").to_str().unwrap());
    let expected = shown("worn").replace("name = \"worn\"", "name = \"wide\"");
    let expected = expected.replacen("tolerance = \"0.003m\"", "tolerance = \"0.004m\"", 1);
    assert_eq!(whole, expected);
    let (code, said) = planned(&dir, "bare.toml", &text.replace("base = \"worn\"\n", ""), &[]);
    assert!(code == Some(2) && said.contains("has no model.gravity"), "{said}");
    let (code, said) = planned(&dir, "none.toml", &text.replace("worn", "old"), &[]);
    assert!(
        code == Some(2)
            && said
                .contains("base: must be one of the presets report, report-b, worn, bridge, stepper, servo"),
        "{said}"
    );
}

#[test]
fn a_rig_file_older_than_the_lasers_keys_is_read_with_a_note() {
    let dir = folder("whole-rig-old");
    let report = shown("report");
    let (before, rest) = report.split_once("[laser]").unwrap();
    let (_, after) = rest.split_once("[safety]").unwrap();
    let old = format!("{before}[safety]{after}");
    let (code, said) = planned(&dir, "old.toml", &old, &[]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("note: ") && said.contains("(laser.class to laser.operated_class)"), "{said}");
    assert_eq!(planned(&dir, "old.toml", &old, &["--quiet"]), (Some(0), String::new()));
    assert_eq!(shown(dir.join("old.toml").to_str().unwrap()), report);
}
