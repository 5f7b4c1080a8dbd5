//! What a shell is offered while somebody types, and the manual's pages.

use std::process::Command;

use crate::support::{folder, program, root, run};

/// What is offered for the last of these words, as the script for bash asks.
fn offered(words: &[&str]) -> Vec<String> {
    let output = program()
        .env("TRACELIGHT_COMPLETE", "bash")
        .env("_CLAP_COMPLETE_INDEX", words.len().to_string())
        .env("_CLAP_IFS", "\n")
        .args(["--", "tracelight"])
        .args(words)
        .output()
        .unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {output:?}");
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

fn check(words: &[&str], wanted: &[&str], unwanted: &[&str]) {
    let all = offered(words);
    let has = |word: &str| all.iter().any(|one| one == word);
    assert!(wanted.iter().all(|word| has(word)), "{words:?}: {all:?}");
    assert!(!unwanted.iter().any(|word| has(word)), "{words:?}: {all:?}");
}

#[test]
fn what_there_is_is_offered() {
    let dir = folder("completing");
    let at = |name: &str| dir.join(name).to_str().unwrap().to_owned();
    std::fs::write(at("my.toml"), "base = \"report\"\n").unwrap();
    std::fs::write(at("my.png"), "").unwrap();
    let layers = r#"{"width_px":10,"height_px":10,"mode":"auto","strokes":[{"closed":false,"kind":"centreline","pen_px":1,"layer":"studs","points":[[1,1],[9,9]]},{"closed":false,"kind":"centreline","pen_px":1,"layer":"walls","points":[[1,2],[9,2]]}]}"#;
    std::fs::write(at("plan.json"), layers).unwrap();
    check(&["tr"], &["trace"], &["plan"]);
    check(&["lab", "bo"], &["bode"], &["step"]);
    check(&["trace", "--wid"], &["--width"], &["--height"]);
    check(&["trace", "--mode", "o"], &["outline"], &["auto"]);
    check(&["trace", "--rig", ""], &["report", "worn"], &[]);
    check(&["lab", "step", "--rig", "re"], &["report"], &["worn"]);
    check(&["plan", "--rig", &at("m")], &[&at("my.toml")], &[&at("my.png")]);
    check(&["rigs", "show", "w"], &["worn"], &["report"]);
    check(&["explain", "following"], &["following-error"], &["usage"]);
    check(&["trace", "--camera", "si"], &["sim", "sim:"], &[]);
    check(&["trace", "--camera", "sim:examples/st"], &["sim:examples/star.png"], &[]);
    check(&["trace", &at("plan.json"), "--layer", ""], &["studs", "walls"], &[]);
    check(&["trace", &at("plan.json"), "--layer", "wa"], &["walls"], &["studs"]);
    check(&["trace", "examples/st"], &["examples/star.png"], &[]);
    check(&["trace", "--calibration", &at("my.t")], &[&at("my.toml")], &[&at("my.png")]);
}

/// Where there is a bash, it takes the script and asks.
#[test]
fn bash_takes_the_script() {
    let script = String::from_utf8(run(&["completions", "bash"]).stdout).unwrap();
    let binary = env!("CARGO_BIN_EXE_tracelight");
    let asks = "COMP_WORDS=(tracelight rigs show wo); COMP_CWORD=3; _clap_complete_tracelight tracelight wo show; echo ${COMPREPLY[@]}";
    let line = format!(
        "tracelight() {{ {binary} \"$@\"; }}\n{}\n{asks}",
        script.replace("\"tracelight\" --", "tracelight --")
    );
    let Ok(output) = Command::new("bash").current_dir(root()).args(["-c", &line]).output() else { return };
    assert_eq!(String::from_utf8_lossy(&output.stdout).trim(), "worn", "{output:?}");
}

#[test]
fn every_shell_has_a_script_that_asks_the_program() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = String::from_utf8(run(&["completions", shell]).stdout).unwrap();
        assert!(script.contains("TRACELIGHT_COMPLETE") && script.contains("tracelight"), "{shell}: {script}");
    }
}

#[test]
fn every_command_has_a_manual_page() {
    let dir = folder("manual").join("man1");
    let written = run(&["man", "-o", dir.to_str().unwrap()]);
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    let page = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap();
    for (name, wanted) in [
        ("tracelight.1", "tracelight\\-trace(1)"),
        ("tracelight-trace.1", "\\-\\-width"),
        ("tracelight-lab-step.1", "\\-\\-gains"),
        ("tracelight-lab-design-pid.1", "\\-\\-crossover"),
        ("tracelight-rigs-show.1", "SYNOPSIS"),
    ] {
        assert!(page(name).contains(wanted), "{name}: {}", page(name));
    }
    let pages = std::fs::read_dir(&dir).unwrap().count();
    assert!(pages > 40, "{pages} pages");
}
