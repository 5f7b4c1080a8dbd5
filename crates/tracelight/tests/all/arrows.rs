//! Which crate may depend on which: the table in `ARCHITECTURE.md` is the law, the manifests are the facts.
//!
//! Arrows are counted in `[dependencies]`, `[build-dependencies]` and their per-target forms;
//! `[dev-dependencies]` are free.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use toml_edit::{DocumentMut, Item, TableLike};

/// Names without `tracelight-`; the host program is `tracelight`.
type Arrows = BTreeMap<String, BTreeSet<String>>;

const PREFIX: &str = "tracelight-";
const HOST: &str = "tracelight";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The manifests of the workspace and, where there is one, of the firmware.
fn manifests() -> Vec<String> {
    let crates = fs::read_dir(root().join("crates")).unwrap();
    let paths = crates.map(|entry| entry.unwrap().path().join("Cargo.toml"));
    let firmware = root().join("firmware/Cargo.toml");
    paths.chain([firmware]).filter(|p| p.exists()).map(|p| read(&p)).collect()
}

fn is_internal(package: &str) -> bool {
    package == HOST || package.starts_with(PREFIX)
}

fn short(package: &str) -> String {
    package.strip_prefix(PREFIX).unwrap_or(package).to_owned()
}

/// What one `[dependencies]` table names: package names, a renamed one by its real name.
fn packages(table: &dyn TableLike) -> Vec<String> {
    let named = |(key, item): (&str, &Item)| {
        let renamed = item.as_table_like().and_then(|t| t.get("package")).and_then(Item::as_str);
        renamed.unwrap_or(key).to_owned()
    };
    table.iter().map(named).collect()
}

/// Every package a manifest needs to build, tests aside.
fn needs(manifest: &DocumentMut) -> Vec<String> {
    let targets = manifest.get("target").and_then(Item::as_table_like);
    let per_target = targets.into_iter().flat_map(|t| t.iter()).filter_map(|(_, item)| item.as_table_like());
    let places = [manifest.as_table() as &dyn TableLike].into_iter().chain(per_target);
    let sections = places.flat_map(|p| ["dependencies", "build-dependencies"].map(|name| p.get(name)));
    sections.flatten().filter_map(Item::as_table_like).flat_map(packages).collect()
}

/// A manifest's own name and the packages it needs.
fn parsed(manifest: &str) -> (String, Vec<String>) {
    let manifest: DocumentMut = manifest.parse().unwrap();
    let name = manifest["package"]["name"].as_str().unwrap();
    (short(name), needs(&manifest))
}

/// The table of the map, the one whose last column is `may use`: `—` is nothing, `all above` every row before.
fn allowed(architecture: &str) -> Arrows {
    let from_table = architecture.lines().skip_while(|line| !line.ends_with("| may use |"));
    let mut arrows = Arrows::new();
    for row in from_table.skip(2).take_while(|line| line.starts_with('|')) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let name = cells[0].split('`').nth(1).unwrap().trim_end_matches('/');
        let may_use = match *cells.last().unwrap() {
            "—" => BTreeSet::new(),
            "all above" => arrows.keys().cloned().collect(),
            list => list.split(',').map(|word| word.trim().to_owned()).collect(),
        };
        arrows.insert(name.to_owned(), may_use);
    }
    arrows
}

/// Every arrow of the manifests that the table does not allow, as a sentence.
fn forbidden(manifests: &[String], allowed: &Arrows) -> Vec<String> {
    let mut found = Vec::new();
    for (from, needs) in manifests.iter().map(|m| parsed(m)) {
        let Some(may_use) = allowed.get(&from) else {
            found.push(format!("`{from}` has no row in ARCHITECTURE.md"));
            continue;
        };
        let internal = needs.iter().filter(|n| is_internal(n)).map(|n| short(n));
        let wrong = internal.filter(|to| !may_use.contains(to));
        found.extend(wrong.map(|to| format!("`{from}` must not use `{to}`")));
    }
    found
}

fn manifest_of(name: &str) -> Vec<String> {
    let found = manifests().iter().map(|m| parsed(m)).find(|(n, _)| n == name);
    found.unwrap_or_else(|| panic!("no crate {name}")).1
}

#[test]
fn every_arrow_between_crates_is_in_the_map() {
    let allowed = allowed(&read(&root().join("ARCHITECTURE.md")));
    assert!(allowed.len() >= 11, "the map's table was not understood: {allowed:?}");
    let manifests = manifests();
    assert!(manifests.len() >= 11);
    assert_eq!(forbidden(&manifests, &allowed), Vec::<String>::new());
}

#[test]
fn the_map_names_only_crates_above_their_users() {
    let allowed = allowed(&read(&root().join("ARCHITECTURE.md")));
    for (from, to) in allowed.iter().flat_map(|(from, uses)| uses.iter().map(move |to| (from, to))) {
        assert!(allowed.contains_key(to), "`{from}` may use `{to}`, which has no row");
        assert!(!allowed[to].contains(from), "`{from}` and `{to}` may use each other");
    }
    assert!(!allowed["control"].contains("plant") && !allowed["plant"].contains("control"));
}

#[test]
fn a_forbidden_arrow_is_found_wherever_it_hides() {
    let map = "| crate | knows | must never know | may use |\n|---|---|---|---|\n| `rig` *no_std* | w | a | — |\n\
               | `control` *no_std* | c | p | rig |\n| `plant` | e | c | rig |\n| `sim` | l | i | all above |";
    let allowed = allowed(map);
    let check = |name: &str, body: &str| {
        forbidden(&[format!("[package]\nname = \"tracelight-{name}\"\n{body}")], &allowed)
    };
    let peeks = ["`control` must not use `plant`"];
    assert_eq!(check("control", "[dependencies]\ntracelight-plant.workspace = true"), peeks);
    assert_eq!(
        check("control", "[dependencies]\ntruth = { package = \"tracelight-plant\", path = \"..\" }"),
        peeks
    );
    assert_eq!(check("control", "[build-dependencies]\ntracelight-plant = \"0.1\""), peeks);
    assert_eq!(check("control", "[target.'cfg(unix)'.dependencies]\ntracelight-plant = \"0.1\""), peeks);
    assert_eq!(check("plant", "[dependencies]\ntracelight = \"0.1\""), ["`plant` must not use `tracelight`"]);
    assert_eq!(check("shed", ""), ["`shed` has no row in ARCHITECTURE.md"]);
    assert!(check("control", "[dev-dependencies]\ntracelight-plant = \"0.1\"").is_empty());
    assert!(
        check("sim", "[dependencies]\ntracelight-plant = \"0.1\"\ntracelight-control = \"0.1\"").is_empty()
    );
}

#[test]
fn what_runs_on_the_board_needs_core_and_nothing_else() {
    for name in ["rig", "control"] {
        let lib = read(&root().join("crates").join(name).join("src/lib.rs"));
        assert!(lib.lines().any(|line| line == "#![no_std]"), "{name} is not `#![no_std]`");
        assert!(!lib.contains("extern crate"), "{name} brings in a crate that the board may not have");
    }
    assert_eq!(manifest_of("rig"), Vec::<String>::new());
    let control = manifest_of("control");
    assert!(control.iter().all(|n| n == "libm" || n == "tracelight-rig"), "{control:?}");
}
