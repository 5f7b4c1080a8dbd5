//! What a book is made of.

use std::path::PathBuf;

use serde_json::Value;

use crate::table::{Compared, Table};

/// What a command came to: its JSON, and the text of its file.
pub type Done = (Value, Option<String>);

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
    /// Commands whose answers stand in one table.
    Joined(Joined),
    /// A drawing that no command makes: its caption and its SVG.
    Drawing(String, String),
    /// Numbers that need no command: of what, and which.
    Facts(&'static str, Vec<Compared>),
    /// A list.
    List(Vec<(&'static str, &'static str)>),
}

/// A command, and what is taken from it.
#[derive(Default)]
pub(crate) struct Run {
    /// What the figure is called in the report; empty where there is none.
    pub(crate) caption: String,
    pub(crate) arguments: Vec<String>,
    /// The file that is read of what it leaves: a figure, or a table.
    pub(crate) figure: Option<PathBuf>,
    /// Whether that file is of no use once it is read.
    pub(crate) passing: bool,
    /// Whether a head that stops is an answer, too.
    pub(crate) may_fail: bool,
    pub(crate) facts: Vec<Fact>,
}

/// Makes a table of what commands came to.
pub(crate) type Show = Box<dyn Fn(&[Done]) -> Table + Send + Sync>;

/// Commands, and the table of what all of them came to.
pub(crate) struct Joined {
    pub(crate) caption: &'static str,
    pub(crate) runs: Vec<Run>,
    pub(crate) show: Show,
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

impl Part {
    /// Its commands.
    pub(crate) fn runs(&self) -> &[Run] {
        match self {
            Self::Run(run) => std::slice::from_ref(run),
            Self::Joined(joined) => &joined.runs,
            _ => &[],
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
