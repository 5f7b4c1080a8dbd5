//! What people type by mistake: a table of lines, each with how it ends and what is said. A message names what to do instead.

use std::path::Path;

use serde_json::Value;

use crate::support::{folder, program};

/// A line as it is typed in a shell, its exit status, and words of what is said; `@` is a folder with the files of [`files`].
type Row = (&'static str, i32, &'static [&'static str]);

const NAMES: &[Row] = &[
    ("trcae examples/star.png", 2, &["did you mean tracelight trace?"]),
    ("stroke examples/star.png", 2, &["did you mean tracelight strokes?"]),
    ("plann examples/star.png", 2, &["did you mean tracelight plan?"]),
    ("docter", 2, &["did you mean tracelight doctor?"]),
    ("banana", 2, &["no file of that name", "tracelight trace FILE"]),
    ("examples", 2, &["examples is a folder", "tracelight strokes examples -o out/"]),
    ("nosuch.png", 2, &["cannot read nosuch.png", "check the name"]),
    ("studio --port 70000", 2, &["give a whole number from 0 to 65535"]),
    ("jog 5deg,0deg", 2, &["--rig", "example: tracelight jog"]),
    ("jog 5 --rig /dev/ttyNONE", 2, &["is no way to go", "10cm,5cm"]),
    ("home --rig report", 2, &["rig serve --pty"]),
    ("help trcae", 2, &["did you mean trace?"]),
    ("help lab boed", 2, &["did you mean bode?"]),
    ("help trace width", 2, &["no command of trace"]),
    ("lab boed G11", 2, &["'bode'", "example: tracelight lab"]),
    ("lab banana", 2, &["there are: profile, move, step"]),
    ("lab move arcc", 2, &["'arc'"]),
    ("lab design pdi G11", 2, &["there are: lead-lag, pid, lqg, place"]),
    ("calibrate cornerz", 2, &["'corners'"]),
    ("rigs shwo report", 2, &["'show'"]),
    ("rigs list", 2, &["there are: show", "example: tracelight rigs show report"]),
    ("explain following-eror", 2, &["did you mean following-error?"]),
    ("explain nonsense", 2, &["`tracelight explain` lists all"]),
    ("completions bsh", 2, &["'bash'"]),
    ("completions", 2, &["<SHELL>", "example: tracelight completions bash"]),
    ("--versoin", 2, &["'--version'"]),
];

const FLAGS: &[Row] = &[
    ("trace", 2, &["what is to be drawn?", "tracelight trace examples/house.png --open", "--camera SOURCE"]),
    ("strokes", 2, &["of which pictures?", "-o drawing.svg"]),
    ("plan", 2, &["of which drawing", "-o star.csv"]),
    ("recover", 2, &["<RUN.mcap>", "example: tracelight recover"]),
    ("rigs show", 2, &["<NAME>", "example: tracelight rigs show worn"]),
    ("lab bode", 2, &["<SYSTEM>", "example: tracelight lab bode"]),
    ("calibrate sheet", 2, &["--output <FILE>", "example: tracelight calibrate sheet -o pages.pdf"]),
    ("calibrate ruler a.png", 2, &["<LEVEL>", "example: tracelight calibrate ruler"]),
    ("calibrate head", 2, &["which camera? --camera sim"]),
    ("plan examples/star.png --widht 3m", 2, &["'--width'"]),
    ("plan examples/star.png --lawz state", 2, &["--lawz", "example: tracelight plan"]),
    ("doctor --josn", 2, &["'--json'"]),
    ("plan examples/star.png --out", 2, &["a value is required", "example: tracelight plan"]),
    ("plan examples/star.png extra.png", 2, &["one picture at a time", "tracelight strokes PICTURE"]),
    ("plan examples/star.png --colour-by speed", 2, &["--preview <FILE.svg>"]),
    ("plan examples/star.png --width 24in --height 3m", 2, &["either --width or --height"]),
    ("examples/star.png --camera sim", 2, &["Either a PICTURE, or what a camera sees", "sim:PICTURE"]),
    ("trace examples/star.png --head x.toml", 2, &["cannot read x.toml"]),
    ("trace examples/star.png --text hello", 2, &["Either a picture, or the words of --text"]),
    ("trace examples/star.png --unit mm", 2, &["--width or --height set its size"]),
    ("trace --camera 0", 2, &["sim:PICTURE", "/dev/video0"]),
    ("trace --camera /dev/video97", 1, &["no such device", "tracelight doctor"]),
    ("trace --camera sim:nosuch.png", 2, &["cannot read nosuch.png"]),
    ("--color purple rigs", 2, &["auto, always, never"]),
];

const VALUES: &[Row] = &[
    ("plan examples/star.png --mode centerline", 2, &["'centreline'"]),
    ("plan examples/star.png --profile scurve", 2, &["'s-curve'"]),
    ("lab step --law sttae", 2, &["'state'"]),
    ("lab step --axis yaw", 2, &["pan, tilt"]),
    ("plan examples/star.png --lit-speed exakt", 2, &["'exact'"]),
    ("plan examples/star.png --order-by fast", 2, &["time, distance"]),
    ("plan examples/star.png --color reed", 2, &["#ff0000", "steelblue"]),
    ("plan examples/star.png --layer walls", 1, &["no layers", "leave --layer walls out"]),
    ("trace examples/star.png --paper a6", 2, &["a5, a4, a3, letter, legal"]),
    ("strokes examples/star.png --format svgg", 2, &["'svg'"]),
    ("trace examples/star.png --laps 0", 2, &["--laps 0: give a whole number from 1 to 1000"]),
    ("trace examples/star.png --laps 2.5", 2, &["--laps 2.5: give a whole number"]),
    ("trace examples/star.png --seed -1", 2, &["--seed -1: give a whole number"]),
    ("strokes examples/star.png --jobs 0", 2, &["--jobs 0: give a whole number from 1 to 1024"]),
    ("lab lesson 99", 2, &["lessons 1 to 8"]),
    ("strokes examples/star.png --threshold 300", 2, &["between 0.4 and 99.6 %"]),
    ("trace examples/star.png --straighten 1,2", 2, &["give \"X,Y X,Y X,Y X,Y\""]),
    ("lab step --gains kx=3", 2, &["none of kp, ki, kd"]),
    ("lab bode 'K11*G11*'", 2, &["the formula ends here", "^\n(see"]),
    ("lab bode K99", 2, &["the names are G11, G22, K11"]),
    ("trace --camera sim:examples/star.png --sim-trouble pan-slp=20@5", 2, &["pan-slip=COUNTS"]),
];

const QUANTITIES: &[Row] = &[
    ("strokes examples/star.png --width 24\"", 0, &[]),
    ("strokes examples/star.png --width 24inches", 0, &[]),
    ("strokes examples/star.png --width '5 feet'", 0, &[]),
    ("strokes examples/star.png --width \"5'6\\\"\"", 0, &[]),
    ("strokes examples/star.png --width 1/2in", 0, &[]),
    ("strokes examples/star.png --width '5 1/2in'", 0, &[]),
    ("strokes examples/star.png --width \"5'6 1/2\\\"\"", 0, &[]),
    ("strokes examples/star.png --rotate 15°", 0, &[]),
    ("plan examples/star.png --width 2,4m", 2, &["write 2.4m"]),
    ("plan examples/star.png --width 24", 2, &["such as 24in"]),
    ("plan examples/star.png --distance 3", 2, &["such as 3ft"]),
    ("plan examples/star.png --width 600", 2, &["such as 600mm"]),
    ("plan examples/star.png --rotate 15", 2, &["such as 15deg"]),
    ("plan examples/star.png --speed 5m", 2, &["use one of m/s"]),
    ("plan examples/star.png --width 15°", 2, &["the unit ° does not fit", "m, mm, cm, in, ft"]),
    ("plan examples/star.png --width wide", 2, &["is no number with a unit", "1in"]),
    ("plan examples/star.png --width -3m", 2, &["between 0.001 and 1000 m", "24in or 0.6m"]),
    ("plan examples/star.png --offset 10cm", 2, &["such as 10cm,-2in"]),
    ("plan examples/star.png --corner 2cm", 2, &["between 0 and 10 mm"]),
    ("plan examples/star.png --speed 100m/s", 1, &["the best possible is"]),
    ("plan examples/star.png --width 100m", 1, &["up to --width", "from --distance"]),
];

const RIGS: &[Row] = &[
    ("plan examples/star.png --rig reprot", 2, &["did you mean report?"]),
    (
        "plan examples/star.png --rig banana",
        2,
        &["no preset (report, report-b, worn, bridge, stepper, servo) and no rig file"],
    ),
    ("plan examples/star.png --rig /dev/ttyUSB0", 2, &["this command drives no head"]),
    ("plan examples/star.png --rig COM3", 2, &["this command drives no head"]),
    ("plan examples/star.png --rig nosuch.toml", 2, &["cannot read nosuch.toml"]),
    ("plan examples/star.png --rig examples/star.png", 2, &["give a rig file (.toml)"]),
    ("plan examples/star.png --rig @/near.toml", 2, &["near.toml:3:1:", "did you mean safety.standing?"]),
    ("plan examples/star.png --rig @/far.toml", 2, &["unknown key safety.banana; [safety] has ", "standing"]),
    ("plan examples/star.png --rig @/table.toml", 2, &["[model] has axis_skew, ", "pan, relay, tilt"]),
    ("plan examples/star.png --rig @/value.toml", 2, &["must be one of state, pid-ff", "^^^^^^^\n(see"]),
    ("plan examples/star.png --rig @/unit.toml", 2, &["3 has no unit", "s, ms, min"]),
    ("plan examples/star.png --rig @/base.toml", 2, &["report, report-b, worn, bridge, stepper, servo"]),
];

const FILES: &[Row] = &[
    ("strokes @/phone.heic", 2, &["share it as JPEG"]),
    ("strokes @/plan.pdf", 2, &["pdftocairo -svg"]),
    ("strokes @/logo.ai", 2, &["Illustrator", "SVG"]),
    ("strokes @/logo.eps", 2, &["Inkscape", "SVG"]),
    ("strokes @/layers.psd", 2, &["export it as PNG"]),
    ("strokes @/plan.dwg", 2, &["save it as ASCII DXF"]),
    ("strokes @/cut.gif", 2, &["is broken", "save it again"]),
    ("strokes @/cut.png", 2, &["is broken", "save it again"]),
    ("strokes @/words.txt", 2, &["is none of PNG, JPEG"]),
    ("trace @/empty.png", 2, &["is empty"]),
    ("trace examples", 2, &["is a folder", "give a file in it"]),
    ("strokes nosuch.png", 2, &["cannot read nosuch.png", "check the name"]),
    ("recover examples/star.png", 2, &["is no run log", "give a run.mcap"]),
    ("lab friction examples/star.png", 2, &["axis,volt,time_s,count"]),
    ("plan examples/star.png -o @/head.gcode", 2, &["--axes X=pan,Y=tilt", "tracelight strokes DRAWING -o"]),
    ("plan examples/star.png --preview @/star.png", 2, &["end it in .svg"]),
    ("strokes examples/star.png -o @/star.xyz", 2, &["cannot write .xyz; use .svg, .dxf"]),
    ("strokes examples/star.png examples/house.png -o @/x.svg", 2, &["end --out with /"]),
    ("lab bode G11 -o @/bode.gif", 2, &[".svg, .png (a plot) and .csv (a table)"]),
    ("calibrate sheet -o @/page.gif", 2, &[".pdf or .svg"]),
    ("calibrate head --camera sim -o @/head.json", 2, &["end it in .toml"]),
    ("recover nosuch.mcap -o @/whole.zip", 2, &["end it in .mcap"]),
];

/// Leaves what the lines name.
fn files(dir: &Path) {
    let star = std::fs::read(crate::support::root().join("examples/star.png")).unwrap();
    let all: [(&str, &[u8]); 17] = [
        ("near.toml", b"base = \"report\"\n[safety]\nstandng = \"1s\"\n"),
        ("far.toml", b"base = \"report\"\n[safety]\nbanana = \"1s\"\n"),
        ("table.toml", b"base = \"report\"\n[model.roll]\nlimit = \"10deg\"\n"),
        ("value.toml", b"base = \"report\"\n[control]\nlaw = \"sttae\"\n"),
        ("unit.toml", b"base = \"report\"\n[motion]\nramp = 3\n"),
        ("base.toml", b"base = \"reprot\"\n"),
        ("phone.heic", b"\0\0\0\x18ftypheic\0\0\0\0"),
        ("plan.pdf", b"%PDF-1.7\n"),
        ("logo.ai", b"%PDF-1.5\n%AI"),
        ("logo.eps", b"%!PS-Adobe-3.0 EPSF-3.0\n"),
        ("layers.psd", b"8BPS\0\x01"),
        ("plan.dwg", b"AC1027\0\0\0"),
        ("cut.gif", b"GIF89a\x10\0"),
        ("cut.png", &star[..300]),
        ("words.txt", b"a letter to nobody\n"),
        ("empty.png", b""),
        ("empty.toml", b""),
    ];
    all.into_iter().for_each(|(name, bytes)| std::fs::write(dir.join(name), bytes).unwrap());
}

/// A line's words: quotes keep spaces together, and a backslash the mark behind it.
fn words(line: &str) -> Vec<String> {
    let (mut all, mut last, mut within) = (Vec::new(), String::new(), None);
    let mut marks = line.chars();
    while let Some(mark) = marks.next() {
        match (mark, within) {
            ('\\', _) => last.extend(marks.next()),
            (' ', None) => all.push(std::mem::take(&mut last)),
            // `24"` has no other half
            ('"' | '\'', None) if last.is_empty() => within = Some(mark),
            (_, Some(quote)) if mark == quote => within = None,
            _ => last.push(mark),
        }
    }
    all.push(last);
    all
}

#[test]
fn every_wrong_line_is_answered_with_what_to_do() {
    let dir = folder("wrong-lines");
    files(&dir);
    let mut wrong = Vec::new();
    let all = [NAMES, FLAGS, VALUES, QUANTITIES, RIGS, FILES].concat();
    assert!(all.len() >= 88, "{} lines", all.len());
    for (line, status, wanted) in all {
        let words = words(&line.replace('@', dir.to_str().unwrap()));
        let output = program().args(&words).env("COLUMNS", "200").output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        let is_told = wanted.iter().all(|words| said.contains(words));
        let is_clean = status == 0 || said.starts_with("error: ") && output.stdout.is_empty();
        if output.status.code() != Some(status) || !is_told || !is_clean {
            wrong.push(format!("{line}: {:?} instead of {status} and {wanted:?}: {said}", output.status));
        }
    }
    let left: Vec<_> = std::fs::read_dir(&dir).unwrap().map(|file| file.unwrap().file_name()).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(left.len(), 17, "a refused line wrote a file: {left:?}");
}

/// With `--json` every one of them is one object, which says what to do too, and where where that is known.
#[test]
fn every_wrong_line_is_an_object_for_scripts() {
    let dir = folder("wrong-objects");
    files(&dir);
    for (line, status, _) in [NAMES, FLAGS, VALUES, QUANTITIES, RIGS, FILES].concat() {
        if status == 0 {
            continue;
        }
        let mut words = words(&line.replace('@', dir.to_str().unwrap()));
        words.push("--json".to_owned());
        let output = program().args(&words).output().unwrap();
        let object: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|e| panic!("{line}: {e}"));
        let error = &object["error"];
        let text = |key: &str| error[key].as_str().unwrap_or_default();
        assert!(["code", "message", "help"].into_iter().all(|key| !text(key).is_empty()), "{line}: {object}");
        assert_eq!(
            (error["exit"].as_i64(), output.status.code()),
            (Some(status.into()), Some(status)),
            "{line}"
        );
        assert!(error.as_object().unwrap().contains_key("where"), "{line}: {object}");
        if line.contains("near.toml") {
            let place = &error["where"];
            assert!(place["file"].as_str().unwrap().ends_with("near.toml"), "{object}");
            assert_eq!((place["line"].as_u64(), place["column"].as_u64()), (Some(3), Some(1)), "{object}");
        }
    }
}

/// The width and the distance that a picture out of reach is answered with are in reach, and not much more is.
#[test]
fn the_size_and_the_distance_that_are_named_are_in_reach() {
    let reaches = |width: &str, distance: &str| {
        let placed = ["--rotate", "20deg", "--speed", "5m/s", "--width", width, "--distance", distance];
        let output = program().args(["plan", "examples/star.png"]).args(placed).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        if said.contains("leaves the head's reach") { Err(said) } else { Ok(said) }
    };
    for (width, distance) in [("100m", "3ft"), ("12m", "50cm"), ("30m", "1m")] {
        let said = reaches(width, distance).unwrap_err();
        let after = |flag: &str| {
            let (_, rest) = said.split_once(&format!(" {flag} ")).unwrap();
            rest.split([';', ' ', '\n']).next().unwrap().to_owned()
        };
        let (largest, least) = (after("up to --width"), after("from --distance"));
        let times = |length: &str, share: f64| {
            format!("{}m", share * length.trim_end_matches('m').parse::<f64>().unwrap())
        };
        reaches(&largest, distance).unwrap();
        reaches(width, &least).unwrap();
        reaches(&times(&largest, 1.02), distance).unwrap_err();
        reaches(width, &times(&least, 0.98)).unwrap_err();
    }
}
