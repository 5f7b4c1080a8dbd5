//! `--set`: the report's two parameter sets, for every command of the bench that takes a rig.

use serde_json::Value;

use crate::support::{folder, lab, run};

/// What is asked of the preset `report-b`, and of `--set B`.
const LINES: &[&str] = &[
    "step --axis tilt --to 10deg",
    "move arc",
    "friction --fixture --most 1V --step 0.5V --hold 2s --out @",
    "inertia --fixture --most 2V --step 1V --hold 2s --out @",
    "frequency --axis pan",
    "simulate --random 2s --law report-pd",
    "montecarlo --plants 2 --shape line",
    "velocity --speeds 1ft/s --intervals 5ms",
];

/// The answer, without the rig's name.
fn answer(line: &str, rig: &[&str]) -> Value {
    let out = folder("lab-sets").display().to_string();
    let words: Vec<&str> = line
        .split(' ')
        .map(|word| if word == "@" { out.as_str() } else { word })
        .chain(rig.to_vec())
        .collect();
    let mut answer = lab(&words);
    if let Some(object) = answer.as_object_mut() {
        object.remove("rig");
    }
    answer
}

#[test]
fn set_b_is_the_preset_report_b_in_every_command() {
    for line in LINES {
        let preset = answer(line, &["--rig", "report-b"]);
        assert_eq!(answer(line, &["--set", "b"]), preset, "{line}");
        assert_ne!(answer(line, &[]), preset, "{line}: the set changes nothing");
    }
}

#[test]
fn every_command_that_takes_a_rig_takes_a_set() {
    let help = |words: &[&str]| String::from_utf8(run(words).stdout).unwrap();
    let listed = help(&["lab", "--help"]);
    let commands = listed.lines().skip_while(|line| !line.starts_with("Commands:")).skip(1);
    let names: Vec<&str> = commands
        .take_while(|line| line.starts_with(' '))
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    let mut with_rig = 0;
    for name in names {
        let of: &[&[&str]] = match name {
            "move" => &[&["lab", "move", "arc", "--help"], &["lab", "move", "line", "--help"]],
            "design" => &[&["lab", "design", "pid", "--help"]],
            "help" => continue,
            _ => &[&["lab", name, "--help"]],
        };
        for words in of {
            let text = help(words);
            assert_eq!(text.contains("--rig <"), text.contains("--set <"), "{words:?}");
            with_rig += usize::from(text.contains("--rig <"));
        }
    }
    assert!(with_rig >= 20, "{with_rig}");
}

#[test]
fn a_set_is_not_saved_into_a_rig_file_that_has_its_own_masses() {
    let dir = folder("lab-set-saved");
    let path = dir.join("own.toml");
    std::fs::write(&path, "base = \"report\"\n").unwrap();
    let before = std::fs::read(&path).unwrap();
    let own = path.to_str().unwrap();
    let out = dir.join("out").display().to_string();
    let output = run(&["lab", "inertia", "--rig", own, "--set", "B", "--save", "--out", &out]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("--set"), "{output:?}");
    assert_eq!(std::fs::read(&path).unwrap(), before);
}
