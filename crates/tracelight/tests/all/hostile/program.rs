//! Runs the real program under a stopwatch and a memory limit, and says what is wrong with how it failed.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Longest a refusal may take.
const PATIENCE: Duration = Duration::from_secs(10);
/// Address space, KiB: 1.5 GiB.
const MEMORY_KIB: u32 = 1_572_864;
/// A message is read by a person: source line, caret and advice fit in this.
const LONGEST_MESSAGE_LINES: usize = 20;

/// How the program is to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Exit {
    /// 1: readable, but refused.
    Refused,
    /// 2: the command line or a file given to it is wrong.
    Wrong,
    /// Either: it depends on how far a reader gets.
    Either,
}

impl Exit {
    fn allows(self, code: i32) -> bool {
        match self {
            Exit::Refused => code == 1,
            Exit::Wrong => code == 2,
            Exit::Either => code == 1 || code == 2,
        }
    }
}

/// One bad input and what must come of it.
pub(crate) struct Case {
    /// The command line.
    pub(crate) args: Vec<String>,
    /// The exit status.
    pub(crate) exit: Exit,
    /// What the message names; `a|b` is satisfied by either.
    pub(crate) names: Vec<String>,
}

impl Case {
    /// `tracelight` with these arguments, which are one string split at spaces.
    pub(crate) fn new(command: &str, exit: Exit, names: &[&str]) -> Self {
        let args = command.split_whitespace().map(str::to_owned).collect();
        Self { args, exit, names: names.iter().map(|&n| n.to_owned()).collect() }
    }
}

/// How the program ended.
#[derive(Default)]
pub(crate) struct Ending {
    /// `None` when a signal ended it.
    pub(crate) code: Option<i32>,
    /// Whether it was killed for taking too long.
    pub(crate) late: bool,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs the program in `folder`, which exists.
pub(crate) fn run(folder: &Path, args: &[String]) -> Ending {
    let pipes = ["stdout", "stderr"].map(|name| folder.join(name));
    let [out, err] = pipes.each_ref().map(|path| File::create(path).unwrap());
    let mut child = Command::new("sh")
        .args([
            "-c",
            &format!("ulimit -v {MEMORY_KIB}; exec \"$0\" \"$@\""),
            env!("CARGO_BIN_EXE_tracelight"),
        ])
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(out)
        .stderr(err)
        .spawn()
        .unwrap();
    let status = wait(&mut child);
    let [stdout, stderr] = pipes.map(|path| String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned());
    Ending { code: status.and_then(|s| s.code()), late: status.is_none(), stdout, stderr }
}

fn wait(child: &mut Child) -> Option<ExitStatus> {
    let started = Instant::now();
    while started.elapsed() < PATIENCE {
        if let Some(status) = child.try_wait().unwrap() {
            return Some(status);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    None
}

/// Everything that is wrong with an ending, as sentences.
pub(crate) fn complaints(case: &Case, ending: &Ending) -> Vec<String> {
    let mut found = Vec::new();
    let mut must = |holds: bool, what: String| {
        if !holds {
            found.push(what);
        }
    };
    let text = &ending.stderr;
    must(!ending.late, format!("was not done after {PATIENCE:?}"));
    must(ending.late || ending.code.is_some(), "was ended by a signal (out of memory?)".to_owned());
    let fits = ending.code.is_none_or(|code| case.exit.allows(code));
    must(fits, format!("exit status {:?} instead of {:?}", ending.code, case.exit));
    must(!text.contains("panicked") && !text.contains("RUST_BACKTRACE"), "panicked".to_owned());
    if ending.code.is_some() && !wants_json(case) {
        let messages = text.lines().filter(|line| line.starts_with("error")).count();
        must(messages == 1, format!("{messages} messages (lines that begin with `error`) instead of one"));
        let lines = text.lines().count();
        must(lines <= LONGEST_MESSAGE_LINES, format!("the message has {lines} lines"));
        for name in case.names.iter().filter(|name| !says(text, name)) {
            must(false, format!("the message does not name `{name}`"));
        }
    }
    if ending.code.is_some() && wants_json(case) {
        found.extend(json_complaint(case, &ending.stdout));
    }
    found
}

fn wants_json(case: &Case) -> bool {
    case.args.iter().any(|arg| arg == "--json")
}

fn says(text: &str, name: &str) -> bool {
    let text = text.to_lowercase();
    name.split('|').any(|word| text.contains(&word.to_lowercase()))
}

/// `{"error":{"code":"…","message":"…"}}` and nothing else on stdout.
fn json_complaint(case: &Case, stdout: &str) -> Option<String> {
    let Ok(value) = serde_json::from_str::<serde_json::Value>(stdout) else {
        return Some(format!("stdout is not one JSON object: {stdout:?}"));
    };
    let field = |name: &str| value["error"][name].as_str().unwrap_or_default();
    if field("code").is_empty() || field("message").is_empty() {
        return Some(format!("no error code and message in {value}"));
    }
    let unnamed = case.names.iter().find(|name| !says(field("message"), name));
    unnamed.map(|name| format!("the JSON message does not name `{name}`: {value}"))
}

/// Runs every case in a folder of its own files and reports all that fail at once.
pub(crate) fn check(folder: &Path, cases: &[Case]) {
    let mut found = Vec::new();
    for case in cases {
        let ending = run(folder, &case.args);
        let wrong = complaints(case, &ending);
        if !wrong.is_empty() {
            let command = case.args.join(" ");
            found.push(format!(
                "tracelight {command}\n    {}\n    stderr: {}",
                wrong.join("\n    "),
                ending.stderr
            ));
        }
    }
    assert!(found.is_empty(), "{} of {} failed badly:\n{}", found.len(), cases.len(), found.join("\n"));
}
