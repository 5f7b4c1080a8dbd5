use clap::Args;
use tracelight_experiment::lesson::{Finding, List, Request};
use tracelight_files as files;
use tracelight_lab::{Ask, Lesson};
use tracelight_rigfile as rigfile;
use tracelight_task::{Failure, Stop};

use super::by_hand::{number, settings};
use super::command::{self, LabCommand, OutFile, OutKind, out_file};
use crate::cli::answer::{Answer, Voice};

/// Learn control on the simulated head: eight lessons, each a text, a command to try, a plot and a question that the simulator grades
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab lesson 1\n\
                  Example: tracelight lab lesson 1 --answer kp=10,sticks=4 -o mine.svg   # not right yet: exit status 1\n\n\
                  Without a number: what lessons there are. An answer that is not right yet ends with exit status 1, and says by how much and \
                  what helps; with --json, in figures.")]
pub(crate) struct LessonArgs {
    /// Which lesson
    #[arg(value_name = "1…8", value_parser = lesson)]
    lesson: Option<Lesson>,
    /// Your answer to its question
    #[arg(long, value_name = "NAME=NUMBER,…", requires = "lesson")]
    answer: Option<String>,
    /// Plot the lesson's examples, and your answer, into an SVG or PNG; write what your answer does, a row a millisecond, to a CSV; or
    /// the lesson's rig to a rig file; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv|RIG.toml", value_parser = kept, requires = "lesson")]
    out: Vec<Kept>,
    #[command(flatten)]
    voice: Voice,
}

/// A file that a lesson leaves.
#[derive(Clone, Debug)]
enum Kept {
    Shown(OutFile),
    Rig(String),
}

fn kept(text: &str) -> Result<Kept, String> {
    if text.to_ascii_lowercase().ends_with(".toml") {
        return Ok(Kept::Rig(text.into()));
    }
    let other = |_| format!("{text} ends in none of .svg, .png (a plot), .csv (a table) and .toml (a rig)");
    out_file(text).map(Kept::Shown).map_err(other)
}

fn lesson(text: &str) -> Result<Lesson, String> {
    let number: Option<usize> = text.parse().ok();
    let found = number.and_then(|number| Lesson::ALL.into_iter().find(|lesson| lesson.number == number));
    found.ok_or_else(|| format!("there are lessons 1 to {}", Lesson::ALL.len()))
}

impl LabCommand for LessonArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let Some(lesson) = &self.lesson else { return Ok(command::answer(&List, self.voice)) };
        let answer = self.answer.as_deref().map(|text| values(lesson, text)).transpose()?;
        let finding = command::tried(Request { lesson: *lesson, answer }, self.voice, stop)?;
        self.out.iter().try_for_each(|file| file.keep(&finding, lesson))?;
        Ok(Answer { failure: finding.not_yet(), ..command::answer(&finding, self.voice) })
    }
}

impl Kept {
    fn keep(&self, finding: &Finding, lesson: &Lesson) -> Result<(), Failure> {
        match self {
            Self::Shown(file) if file.kind == OutKind::Table && !finding.is_answered() => {
                let message = format!("{} is of an answer: give one with --answer", file.path);
                Err(Failure::usage("usage", message))
            }
            Self::Shown(file) => file.write(finding),
            Self::Rig(path) => {
                let Some(rig) = finding.rig() else {
                    let message = format!("{path}: lesson {} is on the preset report", lesson.number);
                    return Err(Failure::usage("usage", message));
                };
                files::write(path, rigfile::write(&rig))
            }
        }
    }
}

/// The answer's values in the order they are asked for.
fn values(lesson: &Lesson, text: &str) -> Result<Vec<f64>, Failure> {
    let wrong = |what: String| {
        let asked: Vec<String> = lesson.asks.iter().map(|ask| format!("{}=…", ask.name)).collect();
        Failure::usage(
            "usage",
            format!("--answer: {what}; lesson {} asks {}", lesson.number, asked.join(",")),
        )
    };
    let given = settings(text).map_err(wrong)?;
    if let Some((name, _)) = given.iter().find(|(name, _)| !lesson.asks.iter().any(|ask| ask.name == *name)) {
        return Err(wrong(format!("{name} is not asked for")));
    }
    let value = |ask: &Ask| {
        let (_, value) = given
            .iter()
            .find(|(name, _)| *name == ask.name)
            .ok_or_else(|| wrong(format!("{} is missing", ask.name)))?;
        let (least, most) = ask.bounds;
        number(ask.name, value, least, most).map_err(wrong)
    };
    lesson.asks.iter().map(value).collect()
}
