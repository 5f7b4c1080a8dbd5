//! What a book is made of.

use std::path::PathBuf;

use serde_json::Value;

/// A part of the report.
pub(crate) struct Chapter {
    pub(crate) title: &'static str,
    /// What the report has, and what became of it.
    pub(crate) parts: Vec<Part>,
}

/// What a chapter is made of.
pub(crate) enum Part {
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
pub(crate) struct Run {
    /// What the figure is called in the report; empty where there is none.
    pub(crate) caption: String,
    pub(crate) arguments: Vec<String>,
    /// Where it leaves its figure.
    pub(crate) figure: Option<PathBuf>,
    pub(crate) facts: Vec<Fact>,
}

/// A number of the report, and where it is in what a command answers.
pub(crate) struct Fact {
    pub(crate) what: String,
    /// As the report has it; nothing where it has none.
    pub(crate) report: Option<f64>,
    /// Place in the command's JSON.
    pub(crate) pointer: String,
    /// By what that is multiplied, and the unit then.
    pub(crate) scale: f64,
    pub(crate) unit: &'static str,
    /// What explains the difference, or what it means.
    pub(crate) why: String,
}

/// A number of the report beside ours.
#[derive(Clone)]
pub(crate) struct Compared {
    pub(crate) what: String,
    pub(crate) report: Option<f64>,
    pub(crate) ours: Option<f64>,
    pub(crate) unit: &'static str,
    pub(crate) why: String,
}

impl Part {
    pub(crate) const fn run(&self) -> Option<&Run> {
        match self {
            Self::Run(run) => Some(run),
            _ => None,
        }
    }
}

impl Fact {
    pub(crate) fn compared(&self, answer: &Value) -> Compared {
        Compared {
            what: self.what.clone(),
            report: self.report,
            ours: answer.pointer(&self.pointer).and_then(Value::as_f64).map(|value| self.scale * value),
            unit: self.unit,
            why: self.why.clone(),
        }
    }
}
