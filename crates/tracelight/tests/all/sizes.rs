//! How large crates are: none so large that nobody holds it, and a command line that only hands on.

use std::fs;
use std::path::Path;

use crate::house_rules::sources;

/// Largest share of all code that a crate may be.
const MOST_SHARE: f64 = 0.15;
/// Most lines of the command line.
const MOST_LINES_OF_THE_PROGRAM: usize = 9000;

/// Lines without a file's own tests.
fn lines(text: &str) -> usize {
    text.split("\n#[cfg(test)]\nmod ").next().unwrap_or_default().lines().count()
}

/// What is too large of crates with so many lines.
fn complaints(crates: &[(String, usize)]) -> Vec<String> {
    let all: usize = crates.iter().map(|(_, lines)| lines).sum();
    let mut found = Vec::new();
    for (name, lines) in crates {
        let share = *lines as f64 / all as f64;
        if share > MOST_SHARE {
            found.push(format!("{name} is {:.1} % of all code: part it into rooms", 100.0 * share));
        }
        if name == "tracelight" && *lines > MOST_LINES_OF_THE_PROGRAM {
            found
                .push(format!("{name} has {lines} lines: what another front end needs too belongs below it"));
        }
    }
    found
}

#[test]
fn no_crate_is_too_large() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let size = |folder: &Path| {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let files = sources(&folder.join("src"));
        (name, files.iter().map(|file| lines(&fs::read_to_string(file).unwrap())).sum())
    };
    let sizes: Vec<_> = fs::read_dir(crates).unwrap().map(|entry| size(&entry.unwrap().path())).collect();
    assert!(sizes.iter().any(|(name, lines)| name == "tracelight" && *lines > 1000), "{sizes:?}");
    assert!(complaints(&sizes).is_empty(), "{:#?}", complaints(&sizes));
}

/// Most lines of the firmware that are neither comments nor empty: pins, and nothing that could be tried without them.
const MOST_LINES_OF_GLUE: usize = 500;

/// Lines of code.
fn code(text: &str) -> usize {
    text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

#[test]
fn the_firmware_is_glue() {
    let files = sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../firmware/src"));
    let lines: usize = files.iter().map(|file| code(&fs::read_to_string(file).unwrap())).sum();
    assert!(lines > 100, "{files:?}");
    assert!(
        lines <= MOST_LINES_OF_GLUE,
        "{lines} lines of code: what knows no pin belongs into crates/board"
    );
    assert_eq!(code("//! a\n\nfn b() {\n    // c\n}\n"), 2);
}

#[test]
fn what_is_too_large_is_told() {
    let crates = |program: usize, largest: usize| {
        let mut all = vec![("tracelight".to_owned(), program), ("vision".to_owned(), largest)];
        all.extend((0..10).map(|k| (format!("c{k}"), 10_000)));
        all
    };
    assert!(complaints(&crates(9000, 15_000)).is_empty());
    assert!(complaints(&crates(9001, 15_000))[0].contains("9001 lines"));
    assert!(complaints(&crates(9000, 25_000))[0].contains("vision is 18.7 %"));
    assert_eq!(lines("a\nb\n#[cfg(test)]\nmod tests {\n}\n"), 2);
}
