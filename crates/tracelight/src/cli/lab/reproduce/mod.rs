//! The 2006 report made again: one page, every number of it from a command that stands beside it.

mod arrays;
mod blocks;
mod chapters;
mod page;

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};
use tracelight_files as files;
use tracelight_task::{Failure, Stop, Task, on_all_cores};

use super::make_folder;
use crate::bar::Bar;
use crate::cli::{Answer, Voice, answer};

/// Make every figure and table of the 2006 report again that can be: one page, its numbers beside ours, and what explains the difference
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab reproduce -o book\n\n\
                  The folder gets index.html, which needs nothing but itself, the figures by themselves, and the arrays and pictures that its \
                  commands are given. Beside each number stands the command that makes it.")]
pub(crate) struct ReproduceArgs {
    /// Folder for the book
    #[arg(short, long, value_name = "DIR", default_value = "book")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// A part of the report.
struct Chapter {
    title: &'static str,
    /// What the report has, and what became of it.
    parts: Vec<Part>,
}

/// What a chapter is made of.
enum Part {
    /// A paragraph.
    Text(String),
    Run(Run),
    /// A drawing that no command makes: its caption and its SVG.
    Drawing(String, String),
    /// Numbers that need no command.
    Facts(Vec<Compared>),
}

/// A command, and what is taken from it.
#[derive(Default)]
struct Run {
    /// What the figure is called in the report; empty where there is none.
    caption: String,
    arguments: Vec<String>,
    /// Where it leaves its figure.
    figure: Option<PathBuf>,
    facts: Vec<Fact>,
}

/// A number of the report, and where it is in what a command answers.
struct Fact {
    what: String,
    /// As the report has it; nothing where it has none.
    report: Option<f64>,
    /// Place in the command's JSON.
    pointer: String,
    /// By what that is multiplied, and the unit then.
    scale: f64,
    unit: &'static str,
    /// What explains the difference, or what it means.
    why: String,
}

/// A number of the report beside ours.
#[derive(Clone)]
struct Compared {
    what: String,
    report: Option<f64>,
    ours: Option<f64>,
    unit: &'static str,
    why: String,
}

/// What a command came to.
type Done = Result<(Value, Option<String>), Failure>;

pub(crate) fn run(args: &ReproduceArgs, stop: &Stop) -> Result<Answer, Failure> {
    for folder in ["figures", "arrays", "pictures", "friction"] {
        make_folder(&args.out.join(folder), "-o")?;
    }
    arrays::write(&args.out)?;
    let chapters = chapters::chapters(&args.out);
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    let runs: Vec<&Run> = chapters.iter().flat_map(|c| c.parts.iter()).filter_map(Part::run).collect();
    task.stage("figures", runs.len() as u64);
    let done: Vec<Done> = on_all_cores(runs.len(), task, |number| perform(runs[number], stop));
    stop.check()?;
    let done = done.into_iter().collect::<Result<Vec<_>, _>>()?;
    let index = args.out.join("index.html").display().to_string();
    files::write(&index, page::page(&chapters, &done))?;
    let compared = page::all_compared(&chapters, &done);
    let text = || {
        let numbers = compared.iter().filter(|(.., c)| c.report.is_some()).count();
        format!("{index}: {} figures, {numbers} numbers of the report beside ours", runs.len())
    };
    Ok(Answer::either(args.voice, text, || json(&index, &compared)))
}

/// Runs a command and reads its figure.
fn perform(run: &Run, stop: &Stop) -> Done {
    let with = ["--json", "--quiet"];
    let arguments: Vec<&str> = run.arguments.iter().map(String::as_str).chain(with).collect();
    let failed = |e: Failure| Failure {
        message: format!("tracelight {}: {}", run.arguments.join(" "), e.message),
        ..e
    };
    let answer = answer(&arguments, stop).map_err(failed)?;
    let value = serde_json::from_str(&answer.json).unwrap_or_default();
    let figure = run.figure.as_deref().map(read).transpose()?;
    Ok((value, figure))
}

fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path)
        .map_err(|e| Failure::failed("unreadable", format!("cannot read {}: {e}", path.display())))
}

impl Part {
    const fn run(&self) -> Option<&Run> {
        match self {
            Self::Run(run) => Some(run),
            _ => None,
        }
    }
}

impl Fact {
    fn compared(&self, answer: &Value) -> Compared {
        Compared {
            what: self.what.clone(),
            report: self.report,
            ours: answer.pointer(&self.pointer).and_then(Value::as_f64).map(|value| self.scale * value),
            unit: self.unit,
            why: self.why.clone(),
        }
    }
}

fn json(index: &str, compared: &[(String, String, Compared)]) -> String {
    let one = |(figure, command, c): &(String, String, Compared)| {
        json!({
            "figure": figure, "command": command, "what": c.what,
            "report": c.report, "ours": c.ours, "unit": c.unit, "why": c.why,
        })
    };
    json!({"page": index, "facts": compared.iter().map(one).collect::<Vec<_>>()}).to_string()
}
