//! Every command that the pages and the help texts show runs as it stands, in a fresh folder with the repository's example files.
//!
//! A page's command is a line of a fenced block of `sh`; each block has a folder of its own, so that a line may use what an earlier
//! line of its block wrote. A comment that ends in "exit status N" says which status the line has; without one it is 0.
//! Commands below a `$` in blocks of `text` are run by the tests of those pages (`lab.rs`).

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::house_rules::sources;
use crate::support::{folder, root};

/// Lines that cannot run here, exactly as they stand, and why.
const NOT_RUN: [(&str, &str); 28] = [
    ("tracelight studio", "opens a browser"),
    ("tracelight studio --lan", "opens a browser"),
    ("tracelight studio --rig /dev/ttyACM0:my-head.toml", "a real board"),
    ("tracelight studio examples/sign.svg --folder out/studio --no-open", "waits for Ctrl-C"),
    ("tracelight home --by-stops --rig /dev/ttyACM0:my-head.toml", "a real board"),
    ("cargo test --workspace", "it runs this test"),
    ("rustup target add thumbv8m.main-none-eabihf", "another compiler"),
    ("cargo xtask firmware", "cargo"),
    ("cargo run --release -p tracelight-job --example picture_to_figures", "cargo"),
    ("tracelight doctor", "looks at the cameras that are plugged in"),
    ("tracelight doctor --camera /dev/video2 --camera-size 640x480", "a real camera"),
    ("tracelight doctor --camera http://192.168.1.20:8080/video", "a camera on the net"),
    ("tracelight trace --camera /dev/video0", "a real camera"),
    ("tracelight doctor --rig /dev/ttyACM0", "a real board"),
    ("tracelight doctor --rig grbl:/dev/ttyUSB0", "a real board"),
    ("tracelight jog 3deg,0deg --dot 2s --rig /dev/ttyACM0:my-head.toml", "a real board"),
    ("tracelight home --rig /dev/ttyACM0:my-head.toml", "a real board"),
    ("tracelight jog 5deg,0deg --rig /dev/ttyACM0", "a real board"),
    ("tracelight jog 10cm,-2cm --rig /dev/ttyACM0:my-head.toml --distance 2m", "a real board"),
    ("tracelight jog --to 30cm,20cm --rig /dev/ttyACM0", "a real board"),
    ("tracelight jog 2deg,0deg --dot 1s --rig /dev/ttyACM0", "a real board"),
    ("tracelight park --rig /dev/ttyACM0", "a real board"),
    ("tracelight rig share /dev/ttyACM0 --for 10min", "a real board"),
    ("tracelight stop", "makes heads dark that other tests drive"),
    ("tracelight stop /dev/ttyACM0", "a real board"),
    ("tracelight watch", "waits until a program drives a head"),
    ("tracelight watch /dev/ttyACM0 --for 10s --json", "a real board"),
    ("tracelight completions bash > /etc/bash_completion.d/tracelight", "writes into the system's folders"),
];

/// Help examples that need what another command has written.
const BEFORE: [(&str, &str); 4] = [
    ("tracelight recover out/house/run.mcap", "tracelight trace examples/house.png"),
    ("tracelight resume out/house", "tracelight trace examples/house.png"),
    ("tracelight compare out/house out/house-2", "tracelight trace examples/house.png"),
    ("tracelight compare out/house out/house-2", "tracelight trace examples/house.png --speed 0.5ft/s"),
];

/// A command line of a page.
#[derive(Clone, Debug, PartialEq)]
struct Line {
    command: String,
    status: i32,
}

impl Line {
    /// A line of a block: `None` where there is only a comment, or nothing.
    fn of(text: &str) -> Option<Self> {
        let (command, comment) = text.split_once(" #").unwrap_or((text, ""));
        let status = comment.split("exit status ").nth(1).map_or(0, |number| number.trim().parse().unwrap());
        let command = command.trim();
        let command = command.replace("cargo run --release -- ", "tracelight ");
        (!command.is_empty() && !command.starts_with('#')).then_some(Self { command, status })
    }

    fn is_run(&self) -> bool {
        NOT_RUN.iter().all(|(line, _)| *line != self.command)
    }
}

/// The blocks of `sh` of a page.
fn blocks(page: &str) -> Vec<Vec<Line>> {
    let fenced = page.split("\n```sh\n").skip(1).filter_map(|rest| rest.split("\n```").next());
    fenced.map(|block| block.lines().filter_map(Line::of).collect()).collect()
}

/// The examples at the end of a command's help, from its source: a line that shows a command and nothing behind it.
fn help_examples(source: &str) -> Vec<Line> {
    let texts = source.split("after_help = \"").skip(1).map(unescaped);
    let lines: Vec<String> =
        texts.flat_map(|text| text.lines().map(str::to_owned).collect::<Vec<_>>()).collect();
    let shown = lines.iter().filter(|line| !line.trim_end().ends_with('.'));
    let command = |line: &String| {
        let at = line.find("tracelight ")?;
        let before = line[..at].trim();
        (before.is_empty() || before.ends_with(':')).then(|| Line::of(&line[at..]))?
    };
    shown.filter_map(command).collect()
}

/// What a string literal says that begins here, up to its closing quote.
fn unescaped(literal: &str) -> String {
    let mut text = String::new();
    let mut characters = literal.chars().peekable();
    while let Some(c) = characters.next() {
        match (c, characters.peek().copied()) {
            ('"', _) => break,
            ('\\', Some('\n')) => while characters.next_if(|c| c.is_whitespace()).is_some() {},
            ('\\', Some('n')) => {
                characters.next();
                text.push('\n');
            }
            ('\\', Some(escaped)) => {
                characters.next();
                text.push(escaped);
            }
            _ => text.push(c),
        }
    }
    text
}

/// A fresh folder with `examples/`, `docs/`, and a `bin/` that has the program and nothing to open pages with.
fn fresh(name: &str) -> PathBuf {
    let dir = folder(&format!("readme-commands/{name}"));
    copy(&root().join("examples"), &dir.join("examples"));
    symlink(fs::canonicalize(root().join("docs")).unwrap(), dir.join("docs")).unwrap();
    fs::create_dir(dir.join("bin")).unwrap();
    symlink(env!("CARGO_BIN_EXE_tracelight"), dir.join("bin/tracelight")).unwrap();
    for opener in ["xdg-open", "open"] {
        symlink("/bin/true", dir.join("bin").join(opener)).unwrap();
    }
    dir
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(|entry| entry.unwrap()) {
        let to = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &to);
        } else {
            fs::copy(entry.path(), to).unwrap();
        }
    }
}

/// Runs lines one after the other; what went wrong, as sentences.
fn complaints(dir: &Path, lines: &[Line]) -> Vec<String> {
    let path = format!("{}:{}", dir.join("bin").display(), std::env::var("PATH").unwrap_or_default());
    let run = |line: &Line| {
        let mut shell = Command::new("sh");
        shell.args(["-c", &line.command]).current_dir(dir).env("PATH", &path).stdin(Stdio::null());
        let output = shell.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        (output.status.code() != Some(line.status))
            .then(|| format!("{}: {}, not {}: {}", line.command, output.status, line.status, said.trim()))
    };
    lines.iter().filter(|line| line.is_run()).filter_map(run).collect()
}

/// Runs each group of lines in a folder of its own, on all cores.
fn check(name: &str, groups: &[Vec<Line>]) {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut found = Vec::new();
        while let Some((number, lines)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, groups.get(k)?)))
        {
            let dir = fresh(&format!("{name}-{number}"));
            found.extend(complaints(&dir, lines));
            fs::remove_dir_all(dir).unwrap();
        }
        found
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let found: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap()).collect()
    });
    assert!(found.is_empty(), "{found:#?}");
}

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).unwrap()
}

/// The pages of `docs` and its lessons.
fn pages() -> Vec<String> {
    let folders = ["docs", "docs/lessons"].map(|folder| fs::read_dir(root().join(folder)).unwrap());
    let files = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    pages.sort();
    pages.iter().map(|page| fs::read_to_string(page).unwrap()).collect()
}

/// The examples of all help texts.
fn help() -> Vec<Line> {
    let mut files = sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/cli"));
    files.sort();
    files.iter().flat_map(|file| help_examples(&fs::read_to_string(file).unwrap())).collect()
}

#[test]
fn every_command_of_the_readme_runs() {
    let groups = blocks(&readme());
    assert!(groups.iter().flatten().count() > 30, "too few commands");
    check("readme", &groups);
}

#[test]
fn every_command_of_the_pages_runs() {
    let groups: Vec<_> = pages().iter().flat_map(|page| blocks(page)).collect();
    assert!(groups.iter().flatten().count() > 8, "too few commands");
    check("pages", &groups);
}

#[test]
fn every_example_of_the_help_runs() {
    let lines = help();
    assert!(lines.len() > 40, "only {} examples", lines.len());
    let before = |line: &Line| {
        BEFORE.iter().filter(|(of, _)| *of == line.command).filter_map(|(_, first)| Line::of(first)).collect()
    };
    let groups: Vec<Vec<Line>> =
        lines.iter().map(|line| [before(line), vec![line.clone()]].concat()).collect();
    check("help", &groups);
}

#[test]
fn what_is_not_run_stands_on_a_page() {
    let pages: Vec<Line> =
        [vec![readme()], pages()].concat().iter().flat_map(|page| blocks(page).concat()).collect();
    let all = [pages, help()].concat();
    let stands = |command: &str| all.iter().any(|line| line.command == command);
    let stale: Vec<_> =
        NOT_RUN.iter().chain(&BEFORE).map(|(line, _)| line).filter(|line| !stands(line)).collect();
    assert!(stale.is_empty(), "on no page any more: {stale:?}");
}

#[test]
fn every_file_that_the_readme_names_is_there() {
    let text = readme();
    let ends = |c: char| c.is_whitespace() || "()[]`|,;\"'".contains(c);
    let named = |word: &&str| {
        ["examples/", "docs/", "crates/", "bench/"].iter().any(|folder| word.starts_with(folder))
    };
    let words: Vec<&str> =
        text.split(ends).map(|word| word.trim_end_matches(['.', ':'])).filter(named).collect();
    assert!(words.len() > 30, "only {} names", words.len());
    let lost: Vec<_> =
        words.iter().filter(|word| !word.contains('*') && !root().join(word).exists()).collect();
    assert!(lost.is_empty(), "{lost:?}");
    assert!(text.lines().count() <= 150, "{} lines; 150 are read", text.lines().count());
}

#[test]
fn a_command_that_does_not_run_is_noticed() {
    let page = "x\n```sh\ntracelight trace sketch.jpg\ntracelight rigs > rigs.txt   # what there is\n\n# a remark\n\
                tracelight explain nonsense # no such code: exit status 2\ncat rigs.txt\n```\n```text\n$ no\n```\n";
    let found = blocks(page);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].iter().map(|line| line.status).collect::<Vec<_>>(), [0, 0, 2, 0]);
    let dir = fresh("wrong");
    let wrong = complaints(&dir, &found[0]);
    assert!(wrong.len() == 1 && wrong[0].contains("cannot read sketch.jpg"), "{wrong:?}");
    let source = "#[command(after_help = \"Example: tracelight a \\\"b c\\\" \\\n     d\\n  e: tracelight f\\n\\nSee: tracelight g.\")]\n\"h: tracelight i\"";
    let shown: Vec<_> = help_examples(source).into_iter().map(|line| line.command).collect();
    assert_eq!(shown, ["tracelight a \"b c\" d", "tracelight f"]);
}
