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

fn printed(line: &[&str], columns: Option<&str>) -> String {
    let mut command = program();
    command.args(line).env_remove("COLUMNS");
    if let Some(columns) = columns {
        command.env("COLUMNS", columns);
    }
    let output = command.output().unwrap();
    assert!(output.status.success(), "{line:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Lines that are too long although they could be broken between two words.
fn too_long(text: &str, columns: usize) -> Vec<&str> {
    text.lines().filter(|line| line.chars().count() > columns && line.trim().contains(' ')).collect()
}

#[test]
fn help_fits_eighty_columns_and_breaks_no_word() {
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    for command in [
        "",
        "trace",
        "strokes",
        "plan",
        "calibrate",
        "calibrate head",
        "calibrate markers",
        "lab",
        "lab simulate",
        "lab bode",
        "lab gang",
        "lab design",
        "lab step",
        "lab montecarlo",
        "doctor",
        "rigs",
        "explain",
        "completions",
    ] {
        for help in ["-h", "--help"] {
            let line: Vec<_> = command.split_whitespace().chain([help]).collect();
            let text = printed(&line, None);
            assert!(too_long(&text, 80).is_empty(), "{line:?}: {:#?}", too_long(&text, 80));
            assert_eq!(words(&text), words(&printed(&line, Some("1000"))), "{line:?}");
        }
    }
}

#[test]
fn flags_of_a_trace_stand_under_what_they_are_about() {
    let help = printed(&["trace", "-h"], None);
    let mut rest = help.as_str();
    for (heading, flag) in [
        ("Picture", "--mode"),
        ("Size and place", "--width"),
        ("Time and order", "--speed"),
        ("Rig and law", "--law"),
        ("Camera", "--camera"),
        ("Simulation", "--seed"),
        ("Output", "--out"),
    ] {
        let (_, after) =
            rest.split_once(&format!("\n{heading}:\n")).unwrap_or_else(|| panic!("no {heading}"));
        let group = after.split("\n\n").next().unwrap();
        assert!(group.contains(flag), "{flag} is not under {heading}");
        rest = after;
    }
}

#[test]
fn tables_of_words_fit_the_columns_they_are_told() {
    for line in [&["explain"][..], &["rigs"], &["lab", "linearize"], &["explain", "too-bent"]] {
        let text = printed(line, Some("80"));
        assert!(too_long(&text, 80).is_empty(), "{line:?}: {:#?}", too_long(&text, 80));
        let whole = printed(line, None);
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&text), words(&whole), "{line:?}");
    }
    // what becomes a file keeps its lines
    assert_eq!(printed(&["rigs", "show", "report"], Some("40")), printed(&["rigs", "show", "report"], None));
}

#[test]
fn colour_is_for_terminals_and_for_who_asks() {
    const ESCAPE: char = '\u{1b}';
    assert!(!printed(&["trace", "--help"], None).contains(ESCAPE), "a pipe is no terminal");
    assert!(printed(&["--color", "always", "trace", "--help"], None).contains(ESCAPE));
    let error = |line: &[&str]| String::from_utf8(run(line).stderr).unwrap();
    assert!(!error(&["banana"]).contains(ESCAPE));
    assert!(error(&["banana", "--color=always"]).starts_with("\u{1b}[1m\u{1b}[31merror:"));
    assert!(error(&["trace", "--color", "always"]).contains(ESCAPE));
    check_wrong(&["--color", "purple", "rigs"], &["auto, always, never"]);
    // what it has always been: a stroke's colour
    check_wrong(&["plan", "examples/star.png", "--color", "purplish"], &["is no colour"]);
}

#[test]
fn quantities_are_read_as_people_write_them() {
    let width = |text: &str| {
        let output = run(&["strokes", "examples/star.png", "--json", "--quiet", "--width", text]);
        assert!(output.status.success(), "{text}: {}", String::from_utf8_lossy(&output.stderr));
    };
    ["24\"", "5'6\"", "24inches", "3 feet", "600 mm", "0.6m"].into_iter().for_each(width);
    let wrong = |flag: &str, text: &str, wanted: &str| {
        check_wrong(&["plan", "examples/star.png", flag, text], &[wanted]);
    };
    wrong("--width", "2,4m", "write 2.4m");
    wrong("--distance", "3", "such as 3ft");
    wrong("--width", "24", "24 has no unit; write it with one of m, mm, cm, in, ft, such as 24in");
    wrong("--rotate", "15", "such as 15deg");
    wrong("--width", "15°", "the unit ° does not fit here");
}

#[test]
fn wrong_flags_and_names_are_answered_with_what_to_type() {
    let cases: &[(&[&str], &[&str])] = &[
        (
            &["trace"],
            &["what is to be drawn?", "tracelight trace examples/house.png --open", "--camera SOURCE"],
        ),
        (&["strokes"], &["of which pictures?", "tracelight strokes drawing.jpg"]),
        (&["plan"], &["of which drawing", "tracelight plan examples/star.png"]),
        (
            &["examples/star.png", "--camera", "sim"],
            &["Either a PICTURE, or what a camera sees", "--camera sim:PICTURE"],
        ),
        (&["trace", "--camera", "sim", "examples/star.png"], &["Either a PICTURE, or what a camera sees"]),
        (&["plan", "examples/star.png", "--text", "hello"], &["Either a picture, or the words of --text"]),
        (
            &["plan", "examples/star.png", "--rig", "reprot"],
            &["no preset (report, report-b, worn, bridge, stepper, servo)", "did you mean report?"],
        ),
        (
            &["plan", "examples/star.png", "--rig", "banana"],
            &["no preset (report, report-b, worn, bridge, stepper, servo) and no rig file"],
        ),
        (&["plan", "examples/star.png", "--rig", "/dev/ttyUSB0"], &["this command drives no head"]),
        (&["plan", "examples/star.png", "--rig", "COM3"], &["this command drives no head"]),
        (&["explain", "following-eror"], &["did you mean following-error?"]),
        (&["explain", "nonsense"], &["nonsense is no code", "lists all of them"]),
        (&["plan", "examples/star.png", "--widht", "3m"], &["--width"]),
    ];
    cases.iter().for_each(|(line, wanted)| check_wrong(line, wanted));
}

#[test]
fn a_file_of_a_kind_that_is_not_read_is_answered_with_how_to_convert_it() {
    let dir = folder("kinds");
    for (name, bytes, wanted) in [
        ("phone.heic", &b"\0\0\0\x18ftypheic\0\0\0\0"[..], "share it as JPEG"),
        ("plan.pdf", b"%PDF-1.7\n", "pdftocairo -svg"),
        ("logo.eps", b"%!PS-Adobe-3.0 EPSF-3.0\n", "save it as SVG"),
        ("old.eps", b"\xc5\xd0\xd3\xc6\x1e\0\0\0", "save it as SVG"),
        ("layers.psd", b"8BPS\0\x01", "export it as PNG"),
        ("other.xyz", b"\x01\x02\x03\x04 what is this", "is none of PNG"),
    ] {
        let path = dir.join(name);
        std::fs::write(&path, bytes).unwrap();
        check_wrong(&["strokes", path.to_str().unwrap()], &["is none of PNG", wanted]);
    }
}
