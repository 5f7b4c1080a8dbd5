//! Each crate's page: it says what the crate must never know, and whatever it and the map point to is there.

use std::fs;
use std::path::{Path, PathBuf};

/// A page is read in a minute.
const LINES: std::ops::RangeInclusive<usize> = 10..=25;

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Where a page's links within the repository lead, without a place in a page.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let own = targets.filter(|target| !target.starts_with("http") && !target.starts_with('#'));
    own.map(|target| target.split('#').next().unwrap_or_default())
}

/// Files of crates that the map names, such as `rig/src/joint.rs`.
fn named(map: &str) -> impl Iterator<Item = &str> {
    map.split('`').skip(1).step_by(2).filter(|word| word.contains("/src/") && !word.contains([' ', '…']))
}

/// What is wrong with a crate's page, as sentences without its name.
fn complaints(text: &str, exists: impl Fn(&str) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    let lines = text.lines().count();
    if !LINES.contains(&lines) {
        found.push(format!("has {lines} lines; {} to {} are read", LINES.start(), LINES.end()));
    }
    if !text.contains("**Must never know:** ") {
        found.push("does not say what the crate must never know".to_owned());
    }
    found.extend(links(text).filter(|link| !exists(link)).map(|link| format!("{link} is not there")));
    found
}

#[test]
fn every_crate_has_a_page_whose_links_lead_somewhere() {
    let mut found = Vec::new();
    let map = read(&crates().join("../ARCHITECTURE.md"));
    for folder in fs::read_dir(crates()).unwrap().map(|entry| entry.unwrap().path()) {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let page = read(&folder.join("README.md"));
        let wrong = complaints(&page, |link| folder.join(link).exists());
        found.extend(wrong.into_iter().map(|what| format!("{name}/README.md: {what}")));
        if !map.contains(&format!("(crates/{name}/README.md)")) {
            found.push(format!("ARCHITECTURE.md does not lead to {name}/README.md"));
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn what_the_map_points_to_is_there() {
    let root = crates().join("..");
    let map = read(&root.join("ARCHITECTURE.md"));
    assert!(named(&map).count() > 20 && links(&map).count() > 20, "the map was not understood");
    let lost: Vec<_> = links(&map).filter(|link| !root.join(link).exists()).collect();
    assert!(lost.is_empty(), "{lost:?}");
    let lost: Vec<_> =
        named(&map).filter(|file| !crates().join(file.trim_start_matches("crates/")).exists()).collect();
    assert!(lost.is_empty(), "{lost:?}");
}

#[test]
fn what_a_page_lacks_is_told() {
    let page =
        |never: &str, link: &str| format!("{}\n**{never}:** files.\n[a]({link})\n", "line\n".repeat(9));
    let check = |text: &str| complaints(text, |link| link == "src/a.rs");
    assert!(check(&page("Must never know", "src/a.rs#L1")).is_empty());
    assert!(check(&page("Must never know", "https://b.org")).is_empty());
    assert_eq!(check(&page("Must never know", "src/b.rs")), ["src/b.rs is not there"]);
    assert!(check(&page("Knows", "src/a.rs"))[0].contains("must never know"));
    assert!(check(&"**Must never know:** ".repeat(2))[0].contains("1 lines"));
    assert_eq!(named("`rig/src/a.rs`, `rig` and src/b.rs; `a/src/…`").collect::<Vec<_>>(), ["rig/src/a.rs"]);
}
