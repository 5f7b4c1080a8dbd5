//! The house's style, as far as neither rustfmt nor clippy checks it.

use std::fs;
use std::path::{Path, PathBuf};

const LONGEST_FILE_LINES: usize = 500;
/// Names that say where something was put instead of what it is.
const EMPTY_NAMES: [&str; 4] = ["common", "utils", "util", "helpers"];
/// Half-done work. Split, so that this file may be searched for it too.
const UNFINISHED: [&str; 4] =
    [concat!("to", "do!("), concat!("un", "implemented!("), concat!("TO", "DO"), concat!("FIX", "ME")];

/// What is wrong with one source file, as sentences without its name.
fn complaints(path: &Path, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let lines = text.lines().count();
    if lines > LONGEST_FILE_LINES {
        found.push(format!("has {lines} lines; split it, {LONGEST_FILE_LINES} is the limit"));
    }
    let mut parts = path.iter().filter_map(|part| Path::new(part).file_stem()?.to_str());
    if let Some(name) = parts.find(|name| EMPTY_NAMES.contains(name)) {
        found.push(format!("`{name}` says nothing: name the file after what it holds"));
    }
    for (number, line) in (1..).zip(text.lines()) {
        found.extend(line_complaint(line.trim()).map(|what| format!("line {number}: {what}")));
    }
    found
}

fn line_complaint(line: &str) -> Option<String> {
    let exports = line.starts_with("pub use") || line.starts_with("pub(crate) use");
    if exports && line.contains("::*") {
        return Some("a glob re-export hides where a name comes from; list the names".to_owned());
    }
    let word = UNFINISHED.into_iter().find(|word| line.contains(word))?;
    Some(format!("`{word}`: finish it"))
}

/// Every `.rs` file below a folder.
pub(crate) fn sources(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    let of = |path: PathBuf| match path.is_dir() {
        true => sources(&path),
        false => vec![path],
    };
    paths.flat_map(of).filter(|path| path.extension().is_some_and(|e| e == "rs")).collect()
}

#[test]
fn every_source_file_keeps_the_house_rules() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let folders = fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path());
    let all: Vec<_> = folders.flat_map(|f| ["src", "tests", "benches"].map(|part| f.join(part))).collect();
    let files: Vec<_> = all.iter().flat_map(|folder| sources(folder)).collect();
    assert!(files.len() > 30, "only {} files found", files.len());
    let mut found = Vec::new();
    for file in &files {
        let name = file.strip_prefix(crates).unwrap();
        let text = fs::read_to_string(file).unwrap();
        found.extend(complaints(name, &text).into_iter().map(|what| format!("{}: {what}", name.display())));
    }
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn each_rule_can_fail() {
    let check = |path: &str, text: &str| complaints(Path::new(path), text);
    let long = "let x = 1;\n".repeat(501);
    assert!(check("aim/src/head.rs", &long)[0].contains("501 lines"));
    assert!(check("aim/src/utils.rs", "")[0].contains("`utils`"));
    assert!(check("aim/src/common/mod.rs", "")[0].contains("`common`"));
    assert!(check("aim/src/lib.rs", "mod a;\npub use a::*;")[0].contains("line 2: a glob"));
    for word in UNFINISHED {
        assert!(check("aim/src/lib.rs", &format!("    {word})"))[0].contains("finish it"), "{word}");
    }
}

#[test]
fn a_file_in_good_order_is_left_alone() {
    let text = "use std::io::*;\npub use head::{Head, Pose};\n".repeat(250);
    assert_eq!(complaints(Path::new("aim/src/utility_pole.rs"), &text), Vec::<String>::new());
}
