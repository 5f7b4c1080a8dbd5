//! The files of `examples/` are what their generators make, and small.

use std::fs;
use std::path::Path;

use crate::make_examples;
use crate::support::root;

/// Most bytes of one file, and of all together.
const MOST_OF_ONE: u64 = 400_000;
const MOST_OF_ALL: u64 = 2_000_000;

#[test]
fn the_examples_are_made_again_byte_for_byte() {
    let files = make_examples::files().unwrap();
    assert!(files.len() >= 13, "only {} files", files.len());
    for (name, bytes) in files {
        let same = fs::read(root().join("examples").join(name)).is_ok_and(|there| there == bytes);
        assert!(
            same,
            "examples/{name} differs: cargo run --release -p tracelight --example make_examples -- examples"
        );
    }
}

/// Sizes of all files below a folder.
fn sizes(folder: &Path) -> Vec<(String, u64)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let of = |path: std::path::PathBuf| match path.is_dir() {
        true => sizes(&path),
        false => vec![(path.display().to_string(), fs::metadata(&path).unwrap().len())],
    };
    entries.flat_map(of).collect()
}

#[test]
fn the_examples_are_small() {
    let sizes = sizes(&root().join("examples"));
    let large: Vec<_> = sizes.iter().filter(|(_, bytes)| *bytes > MOST_OF_ONE).collect();
    assert!(large.is_empty(), "{large:?}");
    assert!(sizes.iter().map(|(_, bytes)| bytes).sum::<u64>() < MOST_OF_ALL, "{sizes:?}");
}
