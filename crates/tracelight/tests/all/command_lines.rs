//! Command lines as people type them: each ends as it should, and what is wrong is told with what to type instead.

use crate::support::{folder, program, run};

/// Exit status 2, and a message that contains each of these.
fn check_wrong(line: &[&str], wanted: &[&str]) {
    let output = run(line);
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line:?}: {message}");
    assert!(message.starts_with("error: ") && output.stdout.is_empty(), "{line:?}: {message}");
    for words in wanted {
        assert!(message.contains(words), "{line:?} does not say {words:?}: {message}");
    }
}

#[test]
fn what_is_no_command_is_answered_with_what_to_type() {
    let cases: &[(&[&str], &[&str])] = &[
        (
            &["trcae", "examples/star.png"],
            &["trcae is no command", "tracelight trace?", "tracelight trace FILE"],
        ),
        (&["stroke"], &["tracelight strokes?"]),
        (&["banana"], &["banana is no command, and no file", "tracelight trace FILE", "tracelight --help"]),
        (&["examples"], &["examples is a folder", "tracelight strokes examples -o out/"]),
        (&["studio"], &["studio is not built yet"]),
        (&["help", "trcae"], &["did you mean trace?"]),
        (&["help", "lab", "boed"], &["did you mean bode?"]),
        (&["no-such.png"], &["cannot read no-such.png"]),
    ];
    cases.iter().for_each(|(line, wanted)| check_wrong(line, wanted));
    let json = run(&["banana", "--json"]);
    let error: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!((json.status.code(), &error["error"]["code"]), (Some(2), &"usage".into()));
}

#[test]
fn a_picture_alone_is_traced() {
    let dir = folder("alone");
    let picture = crate::support::root().join("examples/star.png");
    std::fs::copy(picture, dir.join("star.png")).unwrap();
    let output = program().current_dir(&dir).args(["star.png", "--width", "12in"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("305 × 229 mm"));
    assert!(dir.join("out/star/report.html").is_file());
}
