//! Files of one crate import each other in no circle.
//!
//! An import is followed to the file that defines the name, through whatever hands it on; a path that is written out where it is
//! used (`crate::one::f`, `super::f`, `child::f`) counts as one; tests do not. What a file passes on by `pub use` it imports if it
//! uses it by itself.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A module's path from its crate's root, such as `order::search`; empty for the root.
type Module = Vec<String>;

/// A crate's files without their tests.
#[derive(Default)]
struct Files(BTreeMap<Module, String>);

/// A path that is imported, and the name it has where it is.
struct Import {
    path: Vec<String>,
    name: String,
    /// Only passed on, to whoever imports from here.
    is_export: bool,
}

impl Files {
    fn of(source: &Path) -> Self {
        let mut files = Self::default();
        for path in rust_files(source) {
            let within = path.strip_prefix(source).unwrap().with_extension("");
            let mut module: Module = within.iter().map(|part| part.to_string_lossy().into_owned()).collect();
            if module.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
                module.pop();
            }
            files.add(module, &fs::read_to_string(&path).unwrap());
        }
        files
    }

    fn add(&mut self, module: Module, text: &str) {
        let code = text.split("\n#[cfg(test)]\nmod ").next().unwrap_or_default();
        let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
        self.0.insert(module, lines.collect::<Vec<_>>().join("\n"));
    }

    /// What a file imports from its own crate.
    fn imports(&self, module: &Module) -> Vec<Import> {
        let (uses, code) = parted(&self.0[module]);
        let mut found = Vec::new();
        for (is_export, tree) in uses {
            let own = expanded(&tree).into_iter();
            let own = own.filter_map(|(path, name)| Some((self.absolute(module, &path)?, name)));
            for (path, name) in own {
                if is_export && is_used(&code, &name) {
                    found.push(Import { path: path.clone(), name: String::new(), is_export: false });
                }
                found.push(Import { path, name, is_export });
            }
        }
        let own = written_out(&code).into_iter().filter_map(|path| self.absolute(module, &path));
        found.extend(own.map(|path| Import { path, name: String::new(), is_export: false }));
        found
    }

    /// A path from the crate's root; `None` if it leads into another crate.
    fn absolute(&self, module: &Module, path: &[impl AsRef<str>]) -> Option<Vec<String>> {
        let mut from = match path.first()?.as_ref() {
            "crate" => Vec::new(),
            "self" => module.clone(),
            "super" => module[..module.len().checked_sub(1)?].to_vec(),
            // a module of this file's own
            first => {
                let child: Module = module.iter().cloned().chain([first.to_owned()]).collect();
                return self.0.contains_key(&child).then(|| {
                    module.iter().cloned().chain(path.iter().map(|part| part.as_ref().to_owned())).collect()
                });
            }
        };
        for part in &path[1..] {
            match part.as_ref() {
                "super" => drop(from.pop()),
                "self" => {}
                part => from.push(part.to_owned()),
            }
        }
        Some(from)
    }

    /// The file that defines what a path names.
    fn defined(&self, path: &[String]) -> Module {
        let mut seen = BTreeSet::new();
        let mut path = path.to_vec();
        loop {
            let length = (0..=path.len()).rev().find(|&n| self.0.contains_key(&path[..n])).unwrap_or(0);
            let module = path[..length].to_vec();
            if !seen.insert(path.clone()) || length == path.len() {
                return module;
            }
            // what a file imports for itself it hands on to the files below it
            let found = self.imports(&module).into_iter().find(|import| import.name == path[length]);
            match found {
                Some(import) => path = import.path.into_iter().chain(path[length + 1..].to_vec()).collect(),
                None => return module,
            }
        }
    }

    /// Groups of files each of which imports, over others, itself; each as its files in order.
    fn circles(&self) -> BTreeSet<Vec<String>> {
        let reach: BTreeMap<&Module, BTreeSet<Module>> = {
            let direct = |module: &Module| -> BTreeSet<Module> {
                let imports = self.imports(module).into_iter().filter(|import| !import.is_export);
                imports.map(|import| self.defined(&import.path)).filter(|to| to != module).collect()
            };
            let direct: BTreeMap<&Module, BTreeSet<Module>> =
                self.0.keys().map(|module| (module, direct(module))).collect();
            let all = |start: &Module| {
                let mut seen = BTreeSet::new();
                let mut next: Vec<Module> = direct[start].iter().cloned().collect();
                while let Some(module) = next.pop() {
                    if seen.insert(module.clone()) {
                        next.extend(direct[&module].iter().cloned());
                    }
                }
                seen
            };
            self.0.keys().map(|module| (module, all(module))).collect()
        };
        let circle = |module: &&Module| {
            let others = reach[*module].iter().filter(|other| reach[*other].contains(*module));
            others.map(|module| module.join("::")).collect::<Vec<_>>()
        };
        self.0
            .keys()
            .filter(|module| reach[*module].contains(*module))
            .map(|module| circle(&module))
            .collect()
    }
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
    let of = |path: PathBuf| if path.is_dir() { rust_files(&path) } else { vec![path] };
    entries.flat_map(of).filter(|path| path.extension().is_some_and(|e| e == "rs")).collect()
}

/// The trees of a file's `use`s, each with whether it passes on what it names, and the code without them.
fn parted(text: &str) -> (Vec<(bool, String)>, String) {
    let (mut uses, mut code, mut rest) = (Vec::new(), String::new(), text);
    while let Some(start) = rest.find("use ") {
        let (before, tree) = (&rest[..start], &rest[start + 4..]);
        let line = before.rsplit('\n').next().unwrap_or_default().trim();
        code.push_str(before);
        rest = tree;
        if ["", "pub", "pub(crate)", "pub(super)"].contains(&line) {
            let end = tree.find(';').unwrap_or(tree.len());
            let words: Vec<&str> = tree[..end].split_whitespace().collect();
            uses.push((!line.is_empty(), words.join(" ")));
            rest = &tree[end..];
        }
    }
    (uses, code + rest)
}

/// Whether code uses a name by itself: a type, or a function that is called, and no field, method or part of a path.
fn is_used(code: &str, name: &str) -> bool {
    let in_word = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(name).any(|(start, _)| {
        let (before, after) = (&code[..start], &code[start + name.len()..]);
        let is_whole = !before.ends_with(in_word) && !after.starts_with(in_word);
        let is_own = !before.ends_with(['.', ':']) && !before.ends_with("fn ");
        is_whole && is_own && (name.starts_with(char::is_uppercase) || after.starts_with('('))
    })
}

/// The paths of more than one part that stand in code, such as `crate::one::One`, `super::f` and `child::f`.
fn written_out(code: &str) -> Vec<Vec<&str>> {
    let in_path = |c: char| c.is_alphanumeric() || "_:$".contains(c);
    // what stands behind a type's `:` is a path of its own, what begins with `::` leads out
    let words = code.split(|c: char| !in_path(c)).map(|word| word.trim_end_matches(':'));
    let paths = words.map(|word| word.split("::").collect::<Vec<_>>());
    paths.filter(|parts| parts.len() > 1 && !parts[0].is_empty()).collect()
}

/// The paths of a `use`, and the names they get.
fn expanded(tree: &str) -> Vec<(Vec<String>, String)> {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else {
        let (path, alias) = tree.split_once(" as ").unwrap_or((tree, ""));
        let mut parts: Vec<String> = path.split("::").map(|part| part.trim().to_owned()).collect();
        if parts.len() > 1 && parts.last().is_some_and(|last| last == "self") {
            parts.pop();
        }
        let name = if alias.is_empty() {
            parts.last().cloned().unwrap_or_default()
        } else {
            alias.trim().to_owned()
        };
        return vec![(parts, name)];
    };
    let head = &tree[..open];
    let inner = enclosed(&tree[open + 1..]);
    let (mut depth, mut start, mut parts) = (0_i32, 0, Vec::new());
    for (at, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&inner[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&inner[start..]);
    let parts = parts.into_iter().map(str::trim).filter(|part| !part.is_empty());
    parts.flat_map(|part| expanded(&format!("{head}{part}"))).collect()
}

/// What stands before the brace that closes a list.
fn enclosed(rest: &str) -> &str {
    let mut depth = 1;
    let end = rest.char_indices().find(|(_, c)| {
        depth += match c {
            '{' => 1,
            '}' => -1,
            _ => 0,
        };
        depth == 0
    });
    &rest[..end.map_or(rest.len(), |(at, _)| at)]
}

fn crates() -> Vec<(String, PathBuf)> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut all: Vec<PathBuf> = fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path()).collect();
    all.sort();
    let named = |path: PathBuf| (path.file_name().unwrap().to_string_lossy().into_owned(), path.join("src"));
    all.into_iter().map(named).filter(|(_, source)| source.is_dir()).collect()
}

#[test]
fn files_import_each_other_in_no_circle() {
    let mut found = BTreeSet::new();
    for (name, source) in crates() {
        let files = Files::of(&source);
        assert!(files.0.len() > 1 || name == "units", "{name} has no files");
        found.extend(files.circles().into_iter().map(|circle| format!("{name}: {}", circle.join(" "))));
    }
    assert!(found.is_empty(), "import from where a name is defined, or move it down: {found:#?}");
}

fn circles(files: &[(&str, &str)]) -> Vec<Vec<String>> {
    let mut all = Files::default();
    for (module, text) in files {
        all.add(module.split("::").filter(|part| !part.is_empty()).map(str::to_owned).collect(), text);
    }
    all.circles().into_iter().collect()
}

#[test]
fn a_circle_is_found_however_its_imports_are_written() {
    let one = ("one", "use crate::two::Two;\npub struct One;");
    for two in [
        "use crate::one::One;",
        "use super::one::{self, One};",
        "fn f() -> crate::one::One { todo() }",
        // through what the root passes on
        "use crate::{Other, One as First};",
        "use crate::nested::{inner::Passed};",
    ] {
        let files = [
            ("", "mod one;\nmod two;\npub use one::One;"),
            one,
            ("two", two),
            ("nested::inner", "pub(crate) use crate::one::One as Passed;"),
        ];
        assert_eq!(circles(&files), [["one", "two"]], "{two}");
    }
}

#[test]
fn a_circle_is_found_between_a_file_and_the_one_below_it() {
    for (parent, child) in [
        ("fn f() { child::g(); }", "use super::f;"),
        ("fn f() { self::child::g(); }", "fn g() { super::f(); }"),
        ("fn f() -> Vec<child::Of> { Vec::new() }", "fn g() { crate::parent::f(); }"),
        ("use child::g;", "fn g(a: &super::A) {}"),
        ("const F: fn() = child::g;", "use crate::parent::{self, A};"),
        // what it passes on, and uses
        ("pub use child::g;\nfn f() { g(); }", "use super::f;"),
        ("pub(crate) use child::{g, G};\nfn f() -> Vec<G> {}", "use super::f;"),
        // through the file beside it
        ("fn f() { child::g(); }", "use super::beside::h;"),
    ] {
        let files = [
            ("", "mod parent;"),
            ("parent", &format!("mod beside;\nmod child;\n{parent}")),
            ("parent::child", child),
            ("parent::beside", "fn h() { super::f(); }"),
        ];
        let found = circles(&files);
        assert!(found.len() == 1 && found[0][..1] == ["parent"], "{parent} {child}: {found:?}");
        assert!(found[0].contains(&"parent::child".to_owned()), "{parent} {child}: {found:?}");
    }
}

#[test]
fn what_leads_one_way_is_no_circle() {
    let root = ("", "mod one;\nmod two;\npub use one::One;\nuse two::Two;");
    let one = (
        "one",
        "use super::two::Two;\nuse std::one::One;\n#[cfg(test)]\nmod tests {\n    use crate::One;\n}",
    );
    let two = ("two", "// use crate::one::One;\npub struct Two;");
    assert!(circles(&[root, one, two]).is_empty());
}

#[test]
fn a_file_and_what_lies_below_it_are_no_circle_where_only_one_knows_the_other() {
    for (parent, child) in [
        // what the file is given, it hands on
        ("use below::A;\nfn f() { child::g(); }", "use super::A;"),
        ("fn f() { child::g(); }", "use super::below::A;\nfn g(a: &A) -> child::Other {}"),
        // another crate's, a macro's, a word's end
        ("fn f() { ::child::g(); grandchild::g(); $child::g(); other::child::g(); }", "use super::f;"),
        // only passed on
        ("pub use child::{g, G};\nfn f(h: H) { h.g(); other::g(); }", "use super::f;"),
        // only declared
        ("mod child;", "use super::f;"),
    ] {
        let files =
            [("", "mod parent;"), ("parent", parent), ("parent::child", child), ("parent::below", "")];
        assert!(circles(&files).is_empty(), "{parent} {child}");
    }
}
