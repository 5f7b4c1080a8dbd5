//! The book: its commands run, their figures and numbers put on one page.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use tracelight_task::{Failure, Task, on_all_cores};

use crate::chapter::{Chapter, Done, Part, Run};
use crate::table::Compared;
use crate::{chapters, given, page};

/// What the report has, and the commands that make it again in a folder.
pub struct Book {
    folder: PathBuf,
    chapters: Vec<Chapter>,
}

/// A command line of the book.
#[derive(Clone, Copy, Debug)]
pub struct CommandLine<'a> {
    /// Its words, without the program's name.
    pub arguments: &'a [String],
    /// The file that is read of what it leaves: a figure, as SVG, or a table, as CSV.
    pub figure: Option<&'a Path>,
    /// Whether that file is of no use once it is read.
    pub passing: bool,
    /// Whether a head that stops is an answer, too, and no failure.
    pub may_fail: bool,
}

/// A book that was made.
pub struct Made {
    /// The whole page as HTML.
    pub page: String,
    compared: Vec<(String, String, Compared)>,
    tables: Vec<Value>,
    figures: usize,
}

impl Book {
    /// The book whose commands write into a folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), chapters: chapters::chapters(folder) }
    }

    /// Folders that its commands need.
    pub fn folders(&self) -> impl Iterator<Item = PathBuf> {
        ["figures", "arrays", "pictures", "friction", "friction-a", "readings", "moves", "runs"]
            .into_iter()
            .map(|name| self.folder.join(name))
    }

    /// Files that its commands read: where each belongs, and what is in it.
    ///
    /// # Errors
    /// A picture that cannot be encoded, which is a mistake of the program.
    pub fn given(&self) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
        let files = given::files()?;
        Ok(files
            .into_iter()
            .map(|(folder, name, bytes)| (self.folder.join(folder).join(name), bytes))
            .collect())
    }

    /// Has every command done by `perform`, on all cores, and makes the page of what they come to.
    ///
    /// # Errors
    /// The first command that fails, or [`Failure::interrupted`].
    pub fn make(
        &self,
        task: Task<'_>,
        perform: impl Fn(CommandLine<'_>) -> Result<Done, Failure> + Sync,
    ) -> Result<Made, Failure> {
        let runs: Vec<&Run> =
            self.chapters.iter().flat_map(|c| c.parts.iter()).flat_map(Part::runs).collect();
        task.stage("figures", runs.len() as u64);
        let done: Vec<Result<Done, Failure>> = on_all_cores(runs.len(), task, |number| {
            let run = runs[number];
            perform(CommandLine {
                arguments: &run.arguments,
                figure: run.figure.as_deref(),
                passing: run.passing,
                may_fail: run.may_fail,
            })
        });
        task.check()?;
        let done = done.into_iter().collect::<Result<Vec<_>, _>>()?;
        Ok(Made {
            page: page::page(&self.folder, &self.chapters, &done),
            compared: page::all_compared(&self.folder, &self.chapters, &done),
            tables: page::all_tables(&self.folder, &self.chapters, &done),
            figures: runs.len(),
        })
    }
}

impl Made {
    /// For people: where the page is, and what is on it.
    #[must_use]
    pub fn text(&self, index: &str) -> String {
        let numbers = self.compared.iter().filter(|(.., c)| c.report.is_some()).count();
        format!("{index}: {} commands, {numbers} numbers of the report beside ours", self.figures)
    }

    /// For scripts: where the page is, and every number that is compared.
    #[must_use]
    pub fn json(&self, index: &str) -> String {
        let one = |(figure, command, c): &(String, String, Compared)| {
            json!({
                "figure": figure, "command": command, "what": c.what,
                "report": c.report, "ours": c.ours, "unit": c.unit, "why": c.why,
            })
        };
        json!({
            "page": index,
            "facts": self.compared.iter().map(one).collect::<Vec<_>>(),
            "tables": self.tables,
        })
        .to_string()
    }
}
