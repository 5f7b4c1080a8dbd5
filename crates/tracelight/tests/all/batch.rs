//! Batches of pictures: order, bad files, going on after an end of any kind.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::support::{self, program, root};

/// Pictures in the example folder, small and quick first.
const EXAMPLES: [&str; 5] = ["ruler-level", "star", "shapes", "house", "silhouette"];

/// A fresh folder with copies of examples in it.
fn folder(name: &str, pictures: &[&str]) -> PathBuf {
    let dir = support::folder(&format!("batch-{name}"));
    pictures.iter().for_each(|picture| put(&dir, &format!("{picture}.png"), picture));
    dir
}

fn put(dir: &Path, name: &str, example: &str) {
    let path = dir.join(name);
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::copy(root().join("examples").join(example).with_extension("png"), path).unwrap();
}

/// `tracelight strokes …` in a folder; the arguments are one string split at spaces.
fn command(dir: &Path, arguments: &str) -> Command {
    let mut command = program();
    command.current_dir(dir).arg("strokes").args(arguments.split_whitespace());
    command.stdin(Stdio::null());
    command
}

fn strokes(dir: &Path, arguments: &str) -> Output {
    command(dir, arguments).output().unwrap()
}

/// The same with `--json`: its exit status and its object without times.
fn told(dir: &Path, arguments: &str) -> (i32, Value) {
    let output = strokes(dir, &format!("{arguments} --json"));
    let mut value = serde_json::from_slice(&output.stdout).unwrap();
    timeless(&mut value);
    (output.status.code().unwrap(), value)
}

/// What the clock says differs from run to run; the rest must not.
fn timeless(value: &mut Value) {
    match value {
        Value::Object(fields) => {
            fields.remove("timing_ms");
            fields.values_mut().for_each(timeless);
        }
        Value::Array(items) => items.iter_mut().for_each(timeless),
        _ => {}
    }
}

/// Names below a folder that are not hidden, in order, with what the files hold.
fn files(dir: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else if !name.starts_with('.') {
            found.push((name, fs::read(&path).unwrap()));
        }
    }
    found.sort();
    found
}

fn names(dir: &Path) -> Vec<String> {
    files(dir).into_iter().map(|(name, _)| name).collect()
}

/// One field of every picture.
fn each<'a>(told: &'a Value, field: &str) -> Vec<&'a Value> {
    told["pictures"].as_array().unwrap().iter().map(|picture| &picture[field]).collect()
}

#[test]
fn one_thread_and_four_give_the_same_bytes_in_the_order_of_the_command_line() {
    let dir = folder("threads", &EXAMPLES);
    // the slow ones first, so that the quick ones overtake them
    let asked = "house.png silhouette.png shapes.png star.png ruler-level.png";
    let [one, four] = [1, 4].map(|jobs| told(&dir, &format!("{asked} -o out-{jobs}/ --jobs {jobs}")));
    let order: Vec<_> = each(&one.1, "picture").into_iter().map(|p| p.as_str().unwrap()).collect();
    assert_eq!(order.join(" "), asked);
    assert_eq!(one.1.to_string().replace("out-1", "out-4"), four.1.to_string());
    let [a, b] = ["out-1", "out-4"].map(|out| files(&dir.join(out)));
    assert_eq!(a.len(), 5);
    assert!(a == b, "files differ");
}

#[test]
fn a_batch_goes_on_past_bad_files_and_says_what_is_wrong_with_each() {
    let dir = folder("bad", &["star", "shapes"]);
    fs::write(dir.join("junk.png"), "no picture").unwrap();
    fs::write(dir.join("empty.png"), "").unwrap();
    let asked = "junk.png star.png missing.png empty.png shapes.png -o out/";
    let output = strokes(&dir, asked);
    assert_eq!(output.status.code(), Some(1));
    let (table, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(table.contains("missing.png  failed: cannot read missing.png"), "{table}");
    assert!(table.contains("\n5 pictures: 2 traced, 0 kept, 3 failed\n"), "{table}");
    assert!(error.contains("3 of 5 pictures failed: junk.png, missing.png, empty.png"), "{error}");
    assert_eq!(names(&dir.join("out")), ["shapes.svg", "star.svg"]);
    let (code, told) = told(&dir, asked);
    assert_eq!((code, &told["error"]["code"]), (1, &Value::from("pictures-failed")));
    for error in told["pictures"].as_array().unwrap().iter().map(|p| &p["error"]).filter(|e| !e.is_null()) {
        assert_eq!(error["exit"], 2, "{error}");
        assert!(error["help"].as_str().is_some_and(|help| help.len() > 20), "{error}");
    }
    let codes = told["pictures"].as_array().unwrap().iter().map(|p| p["error"]["code"].as_str());
    assert_eq!(
        codes.collect::<Vec<_>>(),
        [Some("not-a-picture"), None, Some("unreadable"), Some("empty-file"), None]
    );
}

#[test]
fn what_is_done_is_kept_until_the_picture_or_an_option_or_the_file_changes() {
    let dir = folder("kept", &["star", "shapes", "ruler-level"]);
    let kept = |arguments: &str| {
        let (code, told) = told(&dir, &format!("ruler-level.png shapes.png star.png -o out/ {arguments}"));
        assert_eq!(code, 0);
        each(&told, "kept").into_iter().map(|k| k.as_bool().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(kept(""), [false; 3]);
    let first = files(&dir.join("out"));
    assert_eq!(kept(""), [true; 3]);
    assert_eq!(kept("--jobs 1"), [true; 3], "the number of threads changes no file");
    assert_eq!(kept("--width 60cm"), [false; 3]);
    assert_eq!(kept("--width 60cm"), [true; 3]);
    assert_eq!(kept("--again"), [false; 3]);
    assert!(files(&dir.join("out")) == first, "files made twice differ");
    put(&dir, "star.png", "house");
    assert_eq!(kept(""), [true, true, false], "a picture that changed");
    fs::remove_file(dir.join("out/shapes.svg")).unwrap();
    assert_eq!(kept(""), [true, false, true], "a file that is gone");
}

#[test]
fn kept_pictures_are_told_of_as_they_were_when_they_were_traced() {
    let dir = folder("retold", &["star", "house"]);
    let [first, second] = [(); 2].map(|()| told(&dir, "star.png house.png -o out/").1);
    assert_eq!(each(&first, "figures"), each(&second, "figures"));
    assert_eq!(first["totals"]["strokes"], second["totals"]["strokes"]);
    assert_eq!(each(&second, "file"), ["out/star.svg", "out/house.svg"]);
    let table = String::from_utf8(strokes(&dir, "star.png house.png -o out/").stdout).unwrap();
    assert_eq!(table.lines().filter(|line| line.ends_with("  kept")).count(), 2, "{table}");
}

/// Copies of one picture in `in/`, and a batch of them to `out/` that has begun: at least three files are there. What
/// it prints goes to `printed`.
fn begun(dir: &Path, copies: usize) -> Child {
    (0..copies).for_each(|i| put(dir, &format!("in/{i:03}.png"), "house"));
    let printed = fs::File::create(dir.join("printed")).unwrap();
    let mut command = command(dir, "in/ -o out/ --jobs 2 --json");
    let child = command.stdout(printed).stderr(Stdio::null()).spawn().unwrap();
    let out = dir.join("out");
    let began = Instant::now();
    while !out.is_dir() || names(&out).len() < 3 {
        assert!(began.elapsed() < Duration::from_secs(60), "the batch does not begin");
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

/// Every file is whole, and the next run makes those that are not there, and only those.
fn check_completion(dir: &Path, copies: usize) {
    let whole = dir.join("whole");
    assert!(strokes(dir, "in/000.png -o whole/").status.success());
    let reference = &files(&whole)[0].1;
    let left_behind = files(&dir.join("out"));
    assert!((3..copies).contains(&left_behind.len()), "{} of {copies}", left_behind.len());
    assert!(left_behind.iter().all(|(_, bytes)| bytes == reference), "a file is not whole");
    let (code, told) = told(dir, "in/ -o out/");
    let kept = told["totals"]["kept"].as_u64().unwrap() as usize;
    // a file that was there when the end came may not have been noted yet: one a thread
    assert!(code == 0 && (left_behind.len() - 2..=left_behind.len()).contains(&kept), "{kept} kept");
    let all = files(&dir.join("out"));
    assert!(all.len() == copies && all.iter().all(|(_, bytes)| bytes == reference));
    let hidden = fs::read_dir(dir.join("out")).unwrap().count() - copies;
    assert_eq!(hidden, 1, "besides the journal something is left over");
}

#[test]
fn a_killed_batch_leaves_whole_files_and_the_next_run_completes_it() {
    const COPIES: usize = 60;
    let dir = folder("killed", &[]);
    let mut child = begun(&dir, COPIES);
    child.kill().unwrap();
    child.wait().unwrap();
    check_completion(&dir, COPIES);
}

#[cfg(unix)]
#[test]
fn an_interrupted_batch_says_how_to_go_on_and_exits_with_130() {
    const COPIES: usize = 60;
    let dir = folder("interrupted", &[]);
    let mut child = begun(&dir, COPIES);
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let told: Value = serde_json::from_slice(&fs::read(dir.join("printed")).unwrap()).unwrap();
    assert_eq!(told["pictures"].as_array().unwrap().len(), COPIES);
    assert_eq!(told["pictures"][COPIES - 1]["error"]["code"], "interrupted");
    let error = told["error"]["message"].as_str().unwrap();
    assert!(error.contains("of 60 pictures are done; the same command again goes on"), "{error}");
    check_completion(&dir, COPIES);
}

#[test]
fn pictures_of_one_name_keep_their_folders() {
    let dir = folder("names", &["house"]);
    put(&dir, "a/x.png", "star");
    put(&dir, "b/x.png", "shapes");
    let output = strokes(&dir, "a/x.png house.png b/x.png -o out/");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(names(&dir.join("out")), ["a/x.svg", "b/x.svg", "house.svg"]);
}

#[test]
fn names_that_meet_in_one_file_are_refused_before_any_work() {
    let dir = folder("meeting", &["star"]);
    put(&dir, "star.jpg", "house");
    for (asked, words) in [
        ("star.png star.jpg -o out/", "star.png and star.jpg would both be written"),
        ("star.png star.png -o out/", "star.png is given twice"),
        ("star.png star.jpg -o out.svg", "several pictures need a folder"),
    ] {
        let output = strokes(&dir, asked);
        let error = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{asked}: {error}");
        assert!(error.contains(words), "{asked}: {error}");
        assert_eq!(names(&dir), ["star.jpg", "star.png"], "{asked}");
    }
}

#[test]
fn strokes_never_lie_over_the_drawing_they_came_from() {
    let dir = folder("over", &["star"]);
    assert!(strokes(&dir, "star.png -o drawing.svg").status.success());
    let before = fs::read(dir.join("drawing.svg")).unwrap();
    for asked in ["drawing.svg -o ./", "star.png drawing.svg -o ./"] {
        let output = strokes(&dir, asked);
        assert_eq!(output.status.code(), Some(2), "{asked}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("is one of the pictures"), "{asked}");
    }
    assert_eq!(fs::read(dir.join("drawing.svg")).unwrap(), before);
}

#[test]
fn a_folder_stands_for_its_pictures_and_below_it_with_recursive() {
    let dir = folder("folders", &[]);
    for (name, example) in [("in/b.png", "star"), ("in/a.png", "shapes"), ("in/sub/b.png", "ruler-level")] {
        put(&dir, name, example);
    }
    fs::write(dir.join("in/notes.txt"), "no picture, and no error").unwrap();
    fs::write(dir.join("in/._a.png"), "what another system left").unwrap();
    let (code, flat) = told(&dir, "in/ -o out/");
    assert_eq!((code, names(&dir.join("out"))), (0, vec!["a.svg".to_owned(), "b.svg".to_owned()]));
    assert_eq!(each(&flat, "picture"), ["in/a.png", "in/b.png"]);
    assert_eq!(told(&dir, "in/ --recursive -o out/").0, 0);
    assert_eq!(names(&dir.join("out")), ["a.svg", "b.svg", "sub/b.svg"]);
    fs::create_dir(dir.join("none")).unwrap();
    let output = strokes(&dir, "none -o out/");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("none has no pictures"));
}

#[test]
fn a_pattern_that_no_shell_expanded_is_expanded() {
    let dir = folder("pattern", &["star", "shapes", "house"]);
    let (code, told) = told(&dir, "s*.png -o out");
    assert_eq!(
        (code, each(&told, "picture")),
        (0, vec![&Value::from("shapes.png"), &Value::from("star.png")])
    );
    let output = strokes(&dir, "z*.png");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("z*.png"));
}

#[test]
fn json_is_one_object_with_the_strokes_of_each_picture_as_alone() {
    let dir = folder("json", &["star", "house"]);
    let (_, batch) = told(&dir, "star.png house.png");
    for (index, name) in ["star.png", "house.png"].into_iter().enumerate() {
        let picture = &batch["pictures"][index];
        assert_eq!(picture["picture"], name);
        assert_eq!(picture["strokes"], told(&dir, name).1, "{name}");
        let count = picture["strokes"]["strokes"].as_array().unwrap().len();
        assert_eq!(picture["figures"]["count"], count);
        assert!(picture["figures"]["length"].as_f64().unwrap() > 100.0 && picture["figures"]["unit"] == "px");
    }
    assert_eq!(batch["totals"]["pictures"], 2);
    assert_eq!(names(&dir), ["house.png", "star.png"], "nothing is written without --out");
}

#[test]
fn every_format_that_is_offered_is_written() {
    let dir = folder("formats", &["star", "shapes"]);
    let refusal = String::from_utf8(strokes(&dir, "star.png --format nonsense").stderr).unwrap();
    let offered = refusal.split("possible values: ").nth(1).unwrap().split(']').next().unwrap();
    assert!(offered.split(", ").count() >= 3, "{offered}");
    for format in offered.split(", ") {
        let output = strokes(&dir, &format!("star.png shapes.png -o {format}/ --format {format}"));
        assert!(output.status.success(), "{format}: {}", String::from_utf8_lossy(&output.stderr));
        let expected = ["shapes", "star"].map(|stem| format!("{stem}.{format}"));
        assert_eq!(names(&dir.join(format)), expected);
    }
}
