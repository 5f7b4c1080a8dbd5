//! What the program is made of may be passed on: every dependency has a licence that `deny.toml` allows and comes from where it allows,
//! and `NOTICE` names all that is in the program. What Cargo has fetched to build this is read, no network asked.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::iter::Peekable;
use std::path::Path;
use std::process::Command;
use std::vec::IntoIter;

use serde_json::Value;
use toml_edit::DocumentMut;

use crate::support::root;

/// Whose dependencies are looked at: others' are on no machine that does not build for them.
const PLATFORM: &str = "x86_64-unknown-linux-gnu";
/// Licences whose texts are beside `NOTICE` already.
const OWN: [&str; 2] = ["MIT", "Apache-2.0"];
/// Letters that a package carries, with a licence of their own.
const FONTS: [(&str, &str); 1] = [("dejavu", "assets/dejavu-fonts-ttf-2.37/LICENSE")];
/// Letters that are in the tree, with the licences of their own.
const OWN_FONTS: &str = "crates/letters/fonts/LICENSE";
const HEAD: &str = "\
Tracelight is made with the packages below, each under its own licence, as it is built for Linux on x86-64; builds for other systems
have a few more. Where a package leaves the choice, Tracelight takes MIT or Apache-2.0, whose texts are in LICENSE-MIT and
LICENSE-APACHE. What else asks for its words follows at the end, whole.

RENEW_NOTICE=1 cargo test -p tracelight --test all licences     # prints this anew
";

/// What Cargo knows of all packages that a build for [`PLATFORM`] takes, tests and build scripts too.
struct Metadata(Value);

impl Metadata {
    fn read() -> Self {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(cargo);
        command.args(["metadata", "--locked", "--format-version=1", "--filter-platform", PLATFORM]);
        let output = command.current_dir(root()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Self(serde_json::from_slice(&output.stdout).unwrap())
    }

    /// Packages of others.
    fn packages(&self) -> impl Iterator<Item = &Value> {
        self.0["packages"].as_array().unwrap().iter().filter(|package| !package["source"].is_null())
    }

    /// Those whose code is in the program, by name: neither of tests, build scripts nor macros.
    fn shipped(&self) -> Vec<&Value> {
        let needs = |node: &Value| {
            let is_normal = |dep: &&Value| list(&dep["dep_kinds"]).iter().any(|kind| kind["kind"].is_null());
            list(&node["deps"]).iter().filter(is_normal).map(|dep| text(&dep["pkg"])).collect::<Vec<_>>()
        };
        let nodes = list(&self.0["resolve"]["nodes"]).iter();
        let needs: HashMap<String, Vec<String>> =
            nodes.map(|node| (text(&node["id"]), needs(node))).collect();
        let all = list(&self.0["packages"]);
        let by_id: HashMap<String, &Value> =
            all.iter().map(|package| (text(&package["id"]), package)).collect();
        let program = all.iter().find(|package| package["name"] == "tracelight").unwrap();
        let (mut left, mut found) = (vec![text(&program["id"])], BTreeSet::new());
        while let Some(id) = left.pop() {
            if !is_macro(by_id[&id]) && found.insert(id.clone()) {
                left.extend(needs[&id].clone());
            }
        }
        let mut shipped: Vec<&Value> =
            found.iter().map(|id| by_id[id]).filter(|package| !package["source"].is_null()).collect();
        shipped.sort_by_key(|package| (text(&package["name"]), text(&package["version"])));
        shipped
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

fn is_macro(package: &Value) -> bool {
    list(&package["targets"]).iter().any(|target| list(&target["kind"]).contains(&"proc-macro".into()))
}

/// A list of `deny.toml`.
fn denys(table: &str, key: &str) -> Vec<String> {
    let file: DocumentMut = fs::read_to_string(root().join("deny.toml")).unwrap().parse().unwrap();
    let list = file[table][key].as_array().unwrap();
    list.iter().map(|item| item.as_str().unwrap().to_owned()).collect()
}

/// Whether licences suffice for an expression (SPDX 2.3, annex D; `/` is an old `OR`).
fn suffice(allowed: &[impl AsRef<str>], expression: &str) -> bool {
    let words = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<String> = words.split_whitespace().map(str::to_owned).collect();
    let allowed = allowed.iter().map(|name| name.as_ref().to_owned()).collect();
    let mut terms = Terms { words: words.into_iter().peekable(), allowed };
    let is_enough = terms.any();
    is_enough && terms.words.next().is_none()
}

struct Terms {
    words: Peekable<IntoIter<String>>,
    allowed: Vec<String>,
}

impl Terms {
    fn takes(&mut self, word: &str) -> bool {
        self.words.next_if(|next| next == word).is_some()
    }

    fn any(&mut self) -> bool {
        let mut is_enough = self.all();
        while self.takes("OR") {
            is_enough |= self.all();
        }
        is_enough
    }

    fn all(&mut self) -> bool {
        let mut is_enough = self.one();
        while self.takes("AND") {
            is_enough &= self.one();
        }
        is_enough
    }

    fn one(&mut self) -> bool {
        if self.takes("(") {
            return self.any() && self.takes(")");
        }
        let mut name = self.words.next().unwrap_or_default();
        if self.takes("WITH") {
            name = format!("{name} WITH {}", self.words.next().unwrap_or_default());
        }
        self.allowed.contains(&name)
    }
}

/// A package's files on its licence, the texts by name.
fn licence_files(package: &Value) -> Vec<String> {
    let manifest = text(&package["manifest_path"]);
    let folder = Path::new(&manifest).parent().unwrap();
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let is_one = |path: &&std::path::PathBuf| {
        let name = path.file_name().unwrap().to_string_lossy().to_lowercase();
        path.is_file() && ["licen", "unlicen", "copy", "notice"].iter().any(|begin| name.starts_with(begin))
    };
    paths.iter().filter(is_one).map(|path| words_of(path)).collect()
}

/// A text, its lines without what nobody sees.
fn words_of(path: &Path) -> String {
    let text = String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned();
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n").trim_matches('\n').to_owned()
}

/// Whom a package names: its lines of copyright, else its authors, else where it is kept.
fn named_by(package: &Value, files: &[String]) -> Vec<String> {
    let is_line = |line: &&str| {
        line.starts_with("Copyright") && line.contains(|c: char| c.is_ascii_digit()) && !line.contains("yyyy")
    };
    let mut lines: Vec<String> = Vec::new();
    for line in files.iter().flat_map(|file| file.lines().map(str::trim).filter(is_line)) {
        if !lines.iter().any(|known| known == line) {
            lines.push(line.to_owned());
        }
    }
    if lines.is_empty() {
        lines = list(&package["authors"]).iter().map(text).collect();
    }
    if lines.is_empty() {
        lines.push(text(&package["repository"]));
    }
    lines
}

/// `NOTICE`, as it should be.
fn notice(metadata: &Metadata) -> String {
    let (mut all, mut whole) = (HEAD.to_owned(), String::new());
    for package in metadata.shipped() {
        let (name, licence) = (text(&package["name"]), text(&package["license"]));
        let files = licence_files(package);
        all += &format!("\n{name} {}, {licence}\n", text(&package["version"]));
        named_by(package, &files).iter().for_each(|line| all += &format!("    {line}\n"));
        if !suffice(&OWN, &licence) {
            assert!(!files.is_empty(), "{name} ({licence}) has no text to pass on");
            files.iter().for_each(|file| whole += &titled(&name, file));
        }
        for (_, path) in FONTS.iter().filter(|(of, _)| *of == name) {
            let manifest = text(&package["manifest_path"]);
            whole +=
                &titled(&format!("{name}, its fonts"), &words_of(&Path::new(&manifest).with_file_name(path)));
        }
    }
    all + &whole
        + &titled("the single-line fonts in crates/letters/fonts", &words_of(&root().join(OWN_FONTS)))
}

fn titled(title: &str, text: &str) -> String {
    format!("\n---- {title} ----\n\n{text}\n")
}

#[test]
fn every_dependency_has_a_licence_that_is_allowed() {
    let (metadata, allowed) = (Metadata::read(), denys("licenses", "allow"));
    let all: Vec<(String, String)> =
        metadata.packages().map(|package| (text(&package["name"]), text(&package["license"]))).collect();
    assert!(all.len() > 100, "only {} packages", all.len());
    let wrong: Vec<_> = all.iter().filter(|(_, licence)| !suffice(&allowed, licence)).collect();
    assert!(wrong.is_empty(), "not allowed by deny.toml: {wrong:?}");
    for name in &allowed {
        let others: Vec<&String> = allowed.iter().filter(|other| *other != name).collect();
        let others: Vec<&str> = others.iter().map(|other| other.as_str()).collect();
        let is_needed = all.iter().any(|(_, licence)| !suffice(&others, licence));
        assert!(
            is_needed || OWN.contains(&name.as_str()),
            "no dependency needs {name}: take it off deny.toml"
        );
    }
}

#[test]
fn every_dependency_comes_from_a_registry_that_is_allowed() {
    let allowed = denys("sources", "allow-registry");
    for file in ["Cargo.lock", "fuzz/Cargo.lock", "bench/bits/Cargo.lock"] {
        let lock: DocumentMut = fs::read_to_string(root().join(file)).unwrap().parse().unwrap();
        for package in lock["package"].as_array_of_tables().unwrap() {
            let Some(source) = package.get("source").and_then(|source| source.as_str()) else { continue };
            let registry = source.strip_prefix("registry+");
            let is_allowed = registry.is_some_and(|registry| allowed.iter().any(|known| known == registry));
            assert!(is_allowed, "{file}: {} comes from {source}", package["name"]);
            assert!(package.contains_key("checksum"), "{file}: {} has no checksum", package["name"]);
        }
    }
}

#[test]
fn the_notice_names_what_is_in_the_program() {
    let (path, new) = (root().join("NOTICE"), notice(&Metadata::read()));
    for named in ["\nureq ", "\nnalgebra ", "\n---- tiny-skia ----\n", "Bitstream Vera Fonts Copyright"] {
        assert!(new.contains(named), "{named}");
    }
    for not in ["\nserde_derive ", "\nrsruckig ", "\ntracelight"] {
        assert!(!new.contains(not), "{not} is not in the program, or our own");
    }
    let old = fs::read_to_string(&path).unwrap_or_default();
    if std::env::var_os("RENEW_NOTICE").is_some() {
        fs::write(path, new).unwrap();
        return;
    }
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<BTreeSet<_>>();
    let differ: Vec<_> = lines(&old).symmetric_difference(&lines(&new)).cloned().collect();
    assert!(old == new, "NOTICE is old: RENEW_NOTICE=1 prints it anew; what differs: {differ:#?}");
}

#[test]
fn an_expression_is_held_against_what_is_allowed() {
    let allowed = ["MIT", "Zlib", "Unicode-3.0"];
    for (expression, wanted) in [
        ("MIT", true),
        ("GPL-3.0-only", false),
        ("", false),
        ("GPL-3.0-only OR MIT", true),
        ("MIT AND GPL-3.0-only", false),
        ("Apache-2.0/MIT", true),
        ("Apache-2.0 / ISC", false),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
        ("(GPL-2.0 OR Apache-2.0) AND Unicode-3.0", false),
        ("Apache-2.0 AND Zlib OR MIT", true),
        ("Zlib WITH LLVM-exception", false),
        ("MIT) OR (Zlib", false),
    ] {
        assert_eq!(suffice(&allowed, expression), wanted, "{expression}");
    }
}
