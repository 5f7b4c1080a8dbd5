//! What the report has, chapter by chapter, and the commands that make it again.

mod controller;
mod ending;
mod images;
mod measured;
mod model;
mod motion;
mod objectives;

use std::path::Path;

use crate::chapter::{Chapter, Fact, Part, Run};
use crate::table::Compared;

/// All of them, for a book in a folder.
pub(crate) fn chapters(out: &Path) -> Vec<Chapter> {
    let book = Places { out };
    vec![
        book.objectives(),
        book.friction(),
        book.velocity(),
        book.model(),
        book.linear(),
        book.loops(),
        book.profiles(),
        book.following(),
        book.moves(),
        book.images(),
        book.laser(),
        book.missing(),
    ]
}

/// Where a book's files are.
struct Places<'a> {
    out: &'a Path,
}

/// A command without figure and numbers.
fn command(caption: &str, arguments: &[&str]) -> Run {
    Run {
        caption: caption.into(),
        arguments: arguments.iter().map(|&argument| argument.to_owned()).collect(),
        ..Run::default()
    }
}

fn text(paragraph: &str) -> Part {
    Part::Text(paragraph.into())
}

/// A number that the book works out itself.
fn own(what: &str, report: impl Into<Option<f64>>, ours: f64, unit: &'static str, why: &str) -> Compared {
    Compared { what: what.into(), report: report.into(), ours: Some(ours), unit, why: why.into() }
}

impl Run {
    /// Its figure goes into the book's own folder.
    fn drawn(mut self, book: &Places<'_>, name: &str) -> Self {
        let path = book.out.join("figures").join(name);
        self.arguments.extend(["-o".to_owned(), path.display().to_string()]);
        self.figure = Some(path);
        self
    }

    /// Numbers of this size that the report has not: what each is, where it stands, and what it means.
    fn more(mut self, (scale, unit): (f64, &'static str), facts: &[(&str, &str, &str)]) -> Self {
        for (what, pointer, why) in facts {
            self = self.scaled(what, None, pointer, (scale, unit), why);
        }
        self
    }

    /// A number, plain.
    fn fact(self, what: &str, report: impl Into<Option<f64>>, pointer: &str, why: &str) -> Self {
        self.scaled(what, report, pointer, (1.0, ""), why)
    }

    /// A number in a unit.
    fn scaled(
        mut self,
        what: &str,
        report: impl Into<Option<f64>>,
        pointer: &str,
        (scale, unit): (f64, &'static str),
        why: &str,
    ) -> Self {
        self.facts.push(Fact {
            what: what.into(),
            report: report.into(),
            pointer: pointer.into(),
            scale,
            unit,
            why: why.into(),
        });
        self
    }
}

const MILLI: f64 = 1e3;

impl Places<'_> {
    fn path(&self, folder: &str, name: &str) -> String {
        self.out.join(folder).join(name).display().to_string()
    }
}
