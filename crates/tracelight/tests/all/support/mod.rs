//! Runs the program and reads what it leaves.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tracelight_stroke::Point;

/// The repository's folder.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder of this test's own, empty.
pub(crate) fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    dir
}

/// The program, in the repository's folder.
pub(crate) fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tracelight"));
    command.current_dir(root());
    command
}

/// Runs it to its end.
pub(crate) fn run(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

/// The object that a command that went well answered with.
pub(crate) fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A number of an object, by its path, is neither missing nor larger.
pub(crate) fn check_at_most(object: &Value, path: &str, most: f64) {
    let value = object.pointer(path).and_then(Value::as_f64);
    assert!(
        value.is_some_and(|value| (0.0..=most).contains(&value)),
        "{path}: {value:?}, at most {most}; {object}"
    );
}

/// Runs `trace … --out DIR --json` and returns its summary.
pub(crate) fn lab(arguments: &[&str]) -> Value {
    let output = run(&[&["lab"], arguments, &["--json"]].concat());
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

pub(crate) fn near(value: &Value, wanted: f64, tolerance: f64) {
    let number = value.as_f64().unwrap();
    assert!((number - wanted).abs() <= tolerance, "{number}, not {wanted}");
}

pub(crate) fn trace(arguments: &[&str], out: &Path) -> Value {
    let output = program().arg("trace").args(arguments).arg("--json").arg("--out").arg(out).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// One row of `trace.csv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    pub(crate) spot: Point,
    pub(crate) lit: bool,
}

/// `trace.csv`, its columns found by name.
pub(crate) fn rows(dir: &Path) -> Vec<Row> {
    let text = std::fs::read_to_string(dir.join("trace.csv")).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap();
    let (x, y, laser) = (column("x_m"), column("y_m"), column("laser"));
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |i: usize| fields[i].parse().unwrap();
            Row { spot: Point::new(number(x), number(y)), lit: fields[laser] == "1" }
        })
        .collect()
}

/// The lit stretches of a run.
pub(crate) fn lit_lines(rows: &[Row]) -> Vec<Vec<Point>> {
    rows.chunk_by(|a, b| a.lit == b.lit)
        .filter(|run| run[0].lit)
        .map(|run| run.iter().map(|r| r.spot).collect())
        .collect()
}
