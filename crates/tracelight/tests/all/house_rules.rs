//! The house's style, as far as neither rustfmt nor clippy checks it.

use std::fs;
use std::path::{Path, PathBuf};

const LONGEST_FILE_LINES: usize = 500;
/// Names that say where something was put instead of what it is.
const EMPTY_NAMES: [&str; 4] = ["common", "utils", "util", "helpers"];
/// Half-done work. Split, so that this file may be searched for it too.
const UNFINISHED: [&str; 4] =
    [concat!("to", "do!("), concat!("un", "implemented!("), concat!("TO", "DO"), concat!("FIX", "ME")];
/// First words that are no subject: a reader has to look elsewhere for what is meant.
const NO_SUBJECTS: [&str; 4] = ["The same", "In the order", "It", "That"];
/// Crates with doc comments that are still to be rewritten, and the most complaints about each: these only become fewer.
const TO_REWRITE: [(&str, usize); 19] = [
    ("book", 2),
    ("camera", 3),
    ("campaign", 1),
    ("chart", 1),
    ("dynamics", 1),
    ("experiment", 9),
    ("eye", 18),
    ("files", 1),
    ("job", 1),
    ("lab", 21),
    ("linear", 8),
    ("maths", 3),
    ("pipeline", 2),
    ("report", 4),
    ("rigfile", 1),
    ("sheet", 9),
    ("task", 2),
    ("tracelight", 6),
    ("units", 1),
];

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

/// The marker and the text of a line of a doc comment.
fn doc_line(line: &str) -> Option<(&str, &str)> {
    let (marker, text) = line.trim().split_at_checked(3)?;
    (["///", "//!"].contains(&marker) && !text.starts_with('/')).then_some((marker, text.trim()))
}

/// What is wrong with a file's doc comments: a first sentence without a subject, a sentence that runs on into the next comment.
fn doc_complaints(text: &str) -> Vec<String> {
    let lines: Vec<_> = text.lines().map(doc_line).collect();
    let marker = |at: usize| lines.get(at).copied().flatten().map(|(marker, _)| marker);
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some((own, words)) = *line else { continue };
        let is_first = at == 0 || marker(at - 1) != Some(own);
        let starts = |start: &&str| {
            words.strip_prefix(*start).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
        };
        if let Some(start) = NO_SUBJECTS.iter().find(|start| is_first && starts(start)) {
            found.push(format!("line {}: a doc comment begins with `{start}`: name its subject", at + 1));
        }
        if marker(at + 1) != Some(own) && words.ends_with([',', ';']) {
            found.push(format!("line {}: a sentence runs on into the next doc comment; end it", at + 1));
        }
    }
    found
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
fn doc_comments_name_their_subject_and_end_their_sentences() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut wrong = Vec::new();
    for folder in fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path()) {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let of = |file: PathBuf| {
            let place = file.strip_prefix(crates).unwrap().display().to_string();
            let found = doc_complaints(&fs::read_to_string(&file).unwrap());
            found.into_iter().map(move |what| format!("{place}: {what}"))
        };
        let found: Vec<_> = sources(&folder.join("src")).into_iter().flat_map(of).collect();
        let allowed = TO_REWRITE.iter().find(|(of, _)| *of == name).map_or(0, |(_, most)| *most);
        if found.len() > allowed {
            wrong.push(format!("{name}: {} where {allowed} are allowed\n{}", found.len(), found.join("\n")));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_doc_comment_without_a_subject_or_an_end_is_found() {
    for start in NO_SUBJECTS {
        let text = format!("    /// {start} goes on.\n    fn f() {{}}\n");
        assert_eq!(
            doc_complaints(&text),
            [format!("line 1: a doc comment begins with `{start}`: name its subject")]
        );
    }
    assert!(doc_complaints("//! It is.\n//! More.\n")[0].starts_with("line 1: "));
    let runs_on =
        doc_complaints("/// Share of it,\nconst A: f32 = 0.5;\n/// and so on.\nconst B: f32 = 0.5;\n");
    assert_eq!(runs_on, ["line 1: a sentence runs on into the next doc comment; end it"]);
    let good = "/// Items, then more.\n/// It goes on in the second line,\n/// and ends.\nfn f() {} // It may be a comment,\n/// Thatch.\n";
    assert_eq!(doc_complaints(good), Vec::<String>::new());
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
