//! Broken and hostile inputs to the real program: each ends with exit status 1 or 2 and one clear message, within ten
//! seconds and 1.5 GiB. All files are made here.

#[cfg(target_os = "linux")]
mod bounds;
mod drawings;
mod exchange;
mod pictures;
mod program;

use std::fs;
use std::path::{Path, PathBuf};

use image::ImageFormat;
use program::Exit::{Either, Refused, Wrong};
use program::{Case, Ending, check, complaints, run};

const GOOD: &str = "good.png";

/// A fresh folder with a good picture in it.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile").join(name);
    let _ = fs::remove_dir_all(&folder); // it may not be there yet
    fs::create_dir_all(&folder).unwrap();
    write(&folder, GOOD, &pictures::encoded(&pictures::drawing(), ImageFormat::Png));
    folder
}

fn write(folder: &Path, name: &str, bytes: &[u8]) {
    fs::write(folder.join(name), bytes).unwrap();
}

/// Writes picture files and traces each.
fn check_pictures(group: &str, files: Vec<pictures::File>, exit: program::Exit) {
    let folder = folder(group);
    files.iter().for_each(|(name, bytes)| write(&folder, name, bytes));
    let case = |name: &str| Case::new(&format!("trace {name} --out out"), exit, &[name]);
    check(&folder, &files.iter().map(|(name, _)| case(name)).collect::<Vec<_>>());
}

#[test]
fn a_picture_that_is_cut_off_is_refused_by_name() {
    check_pictures("truncated", pictures::truncated(), Wrong);
}

#[test]
fn a_picture_that_lies_about_itself_is_refused_by_name() {
    check_pictures("malformed", pictures::malformed(), Wrong);
}

#[test]
fn a_picture_without_a_drawing_is_refused_by_name() {
    check_pictures("without_drawing", pictures::without_drawing(), Refused);
}

#[test]
fn a_hostile_svg_is_refused_by_name() {
    let folder = folder("svg");
    let files = drawings::svgs();
    files.iter().for_each(|(name, bytes, _)| write(&folder, name, bytes));
    let case = |name: &str, exit| Case::new(&format!("trace {name} --out out"), exit, &[name]);
    check(&folder, &files.iter().map(|(name, _, exit)| case(name, *exit)).collect::<Vec<_>>());
}

#[test]
fn a_broken_table_of_strokes_is_refused_by_name() {
    let folder = folder("tables");
    let files = drawings::tables();
    files.iter().for_each(|(name, bytes, _)| write(&folder, name, bytes));
    let case = |name: &str, exit| Case::new(&format!("plan {name} -o plan.csv"), exit, &[name]);
    check(&folder, &files.iter().map(|(name, _, exit)| case(name, *exit)).collect::<Vec<_>>());
}

#[test]
fn a_hostile_dxf_is_refused_by_name() {
    let folder = folder("dxf");
    let files = exchange::files();
    files.iter().for_each(|(name, bytes, _)| write(&folder, name, bytes));
    let case = |name: &str, exit| Case::new(&format!("plan {name} -o plan.csv"), exit, &[name]);
    check(&folder, &files.iter().map(|(name, _, exit)| case(name, *exit)).collect::<Vec<_>>());
}

#[test]
fn a_path_that_leads_to_no_picture_is_refused_by_name() {
    let folder = folder("paths");
    fs::create_dir(folder.join("folder.png")).unwrap();
    write(&folder, "broken.png", b"no picture");
    let long = "long".repeat(100) + ".png";
    let mut cases = vec![
        Case::new("trace missing.png --out out", Wrong, &["missing.png"]),
        Case::new("trace folder.png --out out", Wrong, &["folder.png"]),
        Case::new("trace good.png/inner.png --out out", Wrong, &["inner.png"]),
        Case::new(&format!("trace {long} --out out"), Wrong, &[&long]),
        Case::new("trace - --out out", Wrong, &["-|stdin|standard input"]),
        Case::new("trace good.png --out good.png", Either, &["good.png"]),
        Case::new("strokes missing.png -o out.svg", Wrong, &["missing.png"]),
        Case::new("strokes good.png -o out.xyz", Wrong, &["out.xyz|xyz"]),
        Case::new("strokes good.png broken.png", Refused, &["broken.png"]), // a batch: 1 if any failed
        Case::new("plan missing.csv", Wrong, &["missing.csv"]),
    ];
    if cfg!(target_os = "linux") {
        cases.push(Case::new("trace /dev/zero --out out", Wrong, &["/dev/zero"])); // never ends
        cases.push(Case::new("plan /dev/full", Wrong, &["/dev/full"]));
    }
    check(&folder, &cases);
}

/// `trace good.png` with these flags; the first word is named by the message.
fn flags(flags: &str, exit: program::Exit) -> Case {
    let name = flags.split([' ', '=']).next().unwrap();
    Case::new(&format!("trace {GOOD} --out out {flags}"), exit, &[name])
}

#[test]
fn a_flag_that_makes_no_sense_is_refused_by_name() {
    const WRONG: [&str; 26] = [
        "--width 24",
        "--width -3in",
        "--width=-3in",
        "--width 0in",
        "--width 1e400m",
        "--width nanm",
        "--width infm",
        "--width 24kg",
        "--width in",
        "--width=",
        "--height 1ft/s",
        "--offset 1in",
        "--offset 1in,2,3in",
        "--rotate 15",
        "--distance 0m",
        "--distance -3ft",
        "--speed 0ft/s",
        "--speed -1ft/s",
        "--speed 1ft",
        "--speed fast",
        "--mode wiggle",
        "--profile sawtooth",
        "--laps 0",
        "--laps 1.5",
        "--seed -1",
        "--frobnicate",
    ];
    check(&folder("flags"), &WRONG.map(|words| flags(words, Wrong)));
}

#[test]
fn a_wish_beyond_the_rig_is_refused_with_what_it_ran_into() {
    let cases = [
        Case::new("trace good.png --out out --offset 100m,0m", Refused, &["reach|limit|offset"]),
        Case::new("trace good.png --out out --speed 1000ft/s", Refused, &["speed"]),
        // these ask for more ticks than any memory holds
        Case::new("trace good.png --out out --width 1000000m", Either, &["width|reach|limit|long|distance"]),
        Case::new("trace good.png --out out --speed 0.000000001m/s", Either, &["speed|long|slow"]),
        Case::new("trace good.png --out out --laps 1000000000", Either, &["laps|long"]),
        Case::new("trace good.png --out out --distance 1e12m", Either, &["distance|reach|limit|small"]),
        Case::new("trace good.png --out out --width 1e-12m", Either, &["width|small|short"]),
    ];
    check(&folder("wishes"), &cases);
}

#[test]
fn a_command_that_is_none_is_refused() {
    let cases = [
        Case::new("tracee good.png", Wrong, &["tracee"]),
        Case::new("trace --out out", Wrong, &["picture"]),
        Case::new("trace good.png --out out --rig nosuch", Wrong, &["nosuch"]),
        Case::new("rigs show nosuch", Wrong, &["nosuch"]),
        Case::new("explain nosuch", Wrong, &["nosuch"]),
        Case::new("calibrate ruler", Wrong, &["picture|upright|required"]),
    ];
    check(&folder("commands"), &cases);
}

#[test]
fn a_drawing_full_of_ties_is_put_in_order() {
    // what rounding makes of equal costs must not look like a gain, over and over
    let folder = folder("ties");
    let square = |i: u32| {
        let (x, y) = (20 + 7 * (i / 40), 20 + 7 * (i % 40));
        let (right, down) = (x + 5, y + 5);
        format!(
            "<polyline fill=\"none\" stroke=\"black\" points=\"{x},{y} {right},{y} {right},{down} {x},{down} {x},{y}\"/>"
        )
    };
    let squares: String = (0..1600).map(square).collect();
    let head =
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"400mm\" height=\"400mm\" viewBox=\"0 0 400 400\">";
    write(&folder, "squares.svg", format!("{head}{squares}</svg>").as_bytes());
    let ending = run(&folder, &["plan".to_owned(), "squares.svg".to_owned()]);
    assert!(ending.code == Some(0) && !ending.late, "{:?} {}", ending.code, ending.stderr);
}

#[test]
fn a_broken_rig_file_is_refused_by_name() {
    let folder = folder("rigs");
    let shown = run(&folder, &["rigs", "show", "report"].map(str::to_owned));
    assert_eq!(shown.code, Some(0), "{}", shown.stderr);
    let files = drawings::rigs(&shown.stdout);
    files.iter().for_each(|(name, bytes)| write(&folder, name, bytes));
    let case = |name: &str| Case::new(&format!("trace {GOOD} --rig {name} --out out"), Wrong, &[name]);
    check(&folder, &files.iter().map(|(name, _)| case(name)).collect::<Vec<_>>());
}

#[test]
fn a_failure_can_be_read_by_a_machine() {
    let folder = folder("json");
    let white = &pictures::without_drawing()[0];
    write(&folder, &white.0, &white.1);
    write(&folder, "cut.toml", b"[model\n");
    let cases = [
        Case::new("trace missing.png --out out --json", Wrong, &["missing.png"]),
        Case::new("trace white.png --out out --json", Refused, &["white.png"]),
        Case::new("trace good.png --out out --width 24 --json", Wrong, &["--width"]),
        Case::new("trace good.png --out out --rig cut.toml --json", Wrong, &["cut.toml"]),
        Case::new("strokes missing.png --json", Wrong, &["missing.png"]),
        Case::new("plan missing.csv --json", Wrong, &["missing.csv"]),
    ];
    check(&folder, &cases);
}

#[test]
fn a_bad_ending_is_noticed() {
    let plain = Case::new("trace x.png", Wrong, &["x.png"]);
    let json = Case::new("trace x.png --json", Wrong, &["x.png"]);
    let ending = |code, stderr: &str| Ending { code, stderr: stderr.to_owned(), ..Ending::default() };
    let good = ending(Some(2), "error: x.png: not a picture\n");
    assert_eq!(complaints(&plain, &good), Vec::<String>::new());
    let bad = [
        ending(Some(0), "error: x.png: not a picture\n"),
        ending(Some(1), "error: x.png: not a picture\n"),
        ending(Some(2), "error: not a picture\n"),
        ending(Some(2), ""),
        ending(Some(2), "error: x.png: one\nerror: x.png: two\n"),
        ending(Some(2), &format!("error: x.png\n{}", "and on\n".repeat(30))),
        ending(Some(2), "error: x.png\nthread 'main' panicked at src/main.rs\n"),
        ending(None, ""),
        Ending { late: true, ..Ending::default() },
    ];
    for (number, ending) in bad.iter().enumerate() {
        assert!(!complaints(&plain, ending).is_empty(), "{number}");
    }
    for stdout in
        ["", "error: x.png", "{\"error\":{\"code\":\"c\"}}", "{\"error\":{\"code\":\"c\",\"message\":\"m\"}}"]
    {
        let ending = Ending { code: Some(2), stdout: stdout.to_owned(), ..Ending::default() };
        assert!(!complaints(&json, &ending).is_empty(), "{stdout}");
    }
}
