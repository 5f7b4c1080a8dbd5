mod plot;
mod text;

use std::fmt::Write;

use clap::Args;
use serde_json::{Value, json};
use tracelight_files as files;
use tracelight_lab::{Check, Graded, Lesson};
use tracelight_rig::TICK_F64_S;
use tracelight_rigfile as rigfile;
use tracelight_task::Failure;

use super::by_hand::{number, settings};
use super::{OutFile, OutKind, out_file, write_all};
use crate::cli::{Answer, Voice};

/// Learn control on the simulated head: eight lessons, each a text, a command to try, a plot and a question that the simulator grades
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab lesson 1\n\
                  Example: tracelight lab lesson 1 --answer kp=10,sticks=4 -o mine.svg\n\n\
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
    pub(super) voice: Voice,
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

pub(crate) fn run(args: &LessonArgs) -> Result<Answer, Failure> {
    let Some(lesson) = &args.lesson else { return Ok(list()) };
    let answer = args.answer.as_deref().map(|text| values(lesson, text)).transpose()?;
    let graded = answer.as_deref().map(|values| lesson.grade(values));
    keep(args, lesson, graded.as_ref())?;
    Ok(match &graded {
        None => Answer::new(text::plain(lesson), about(lesson).to_string()),
        Some(graded) => judged(lesson, graded),
    })
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
    let value = |ask: &tracelight_lab::Ask| {
        let (_, value) = given
            .iter()
            .find(|(name, _)| *name == ask.name)
            .ok_or_else(|| wrong(format!("{} is missing", ask.name)))?;
        let (least, most) = ask.bounds;
        number(ask.name, value, least, most).map_err(wrong)
    };
    lesson.asks.iter().map(value).collect()
}

fn keep(args: &LessonArgs, lesson: &Lesson, graded: Option<&Graded>) -> Result<(), Failure> {
    for file in &args.out {
        match file {
            Kept::Shown(file) if file.kind == OutKind::Table && graded.is_none() => {
                let message = format!("{} is of an answer: give one with --answer", file.path);
                return Err(Failure::usage("usage", message));
            }
            Kept::Shown(file) => write_all(
                std::slice::from_ref(file),
                || plot::figure(lesson, graded),
                || Ok(graded.map(csv).unwrap_or_default()),
            )?,
            Kept::Rig(path) => {
                let Some(rig) = lesson.rig else {
                    let message = format!("{path}: lesson {} is on the preset report", lesson.number);
                    return Err(Failure::usage("usage", message));
                };
                files::write(path, rigfile::write(&rig()))?;
            }
        }
    }
    Ok(())
}

fn list() -> Answer {
    let mut text = String::from("Lessons, each `tracelight lab lesson NUMBER`:\n");
    for lesson in &Lesson::ALL {
        // writing to a String cannot fail
        let _ = write!(text, "\n{}  {}", lesson.number, lesson.title);
    }
    let all: Vec<Value> = Lesson::ALL.iter().map(about).collect();
    Answer::new(text, json!({ "lessons": all }).to_string())
}

/// A lesson for scripts.
fn about(lesson: &Lesson) -> Value {
    let ask = |ask: &tracelight_lab::Ask| json!({"name": ask.name, "unit": ask.unit, "least": ask.bounds.0, "most": ask.bounds.1, "meaning": ask.meaning});
    json!({
        "lesson": lesson.number,
        "title": lesson.title,
        "text": text::markdown(lesson.number),
        "asks": lesson.asks.iter().map(ask).collect::<Vec<_>>(),
    })
}

fn judged(lesson: &Lesson, graded: &Graded) -> Answer {
    let mut answer = Answer::new(table(lesson, graded), figures(lesson, graded).to_string());
    let unmet = graded.checks.iter().filter(|check| !check.is_met()).count();
    if unmet > 0 {
        let message = format!("{unmet} of {} figures not met yet", graded.checks.len());
        answer.failure = Some(Failure::failed("not-yet", message));
    }
    answer
}

fn table(lesson: &Lesson, graded: &Graded) -> String {
    let mut text =
        format!("Lesson {}: {}\n\n{:48} {:>10}  {:22}", lesson.number, lesson.title, "", "is", "must be");
    for check in &graded.checks {
        let mark = if check.is_met() { "ok" } else { "not yet" };
        let _ = write!(text, "\n{:48} {:>10}  {:22} {mark}", check.what, shown(check.value), bounds(check));
        if !check.is_met() {
            let _ = write!(text, "\n    {}", check.hint());
        }
    }
    if graded.is_right() {
        text += "\n\nRight.";
        if let Some(next) = Lesson::ALL.iter().find(|other| other.number == lesson.number + 1) {
            let _ = write!(text, " Next: `tracelight lab lesson {}`, {}", next.number, next.title);
        }
    }
    text
}

fn shown(value: f64) -> String {
    if value.is_finite() { format!("{value:.3}") } else { "never".into() }
}

fn bounds(check: &Check) -> String {
    let unit = check.unit;
    if check.least.is_finite() {
        format!("{:.3} to {:.3} {unit}", check.least, check.most)
    } else {
        format!("at most {:.3} {unit}", check.most)
    }
}

fn figures(lesson: &Lesson, graded: &Graded) -> Value {
    let number = |value: f64| value.is_finite().then_some(value);
    let one = |check: &Check| {
        json!({
            "what": check.what, "unit": check.unit, "value": number(check.value), "least": number(check.least),
            "most": check.most, "met": check.is_met(), "hint": if check.is_met() { "" } else { check.hint() },
        })
    };
    json!({
        "lesson": lesson.number,
        "right": graded.is_right(),
        "figures": graded.checks.iter().map(one).collect::<Vec<_>>(),
    })
}

/// What an answer did.
fn csv(graded: &Graded) -> String {
    let mut text = String::from("experiment,t_s,set_rad,angle_rad,est_rad,est_rad_s,count,command_v\n");
    for experiment in &graded.experiments {
        let j = experiment.joint;
        for (number, tick) in experiment.ticks.iter().enumerate() {
            let _ = writeln!(
                text,
                "\"{}\",{:.3},{:.7},{:.7},{:.7},{:.6},{},{:.4}",
                experiment.name,
                number as f64 * TICK_F64_S,
                tick.setpoint[j].position_rad,
                tick.angle_rad[j],
                tick.estimates[j].position_rad,
                tick.estimates[j].velocity_rad_s,
                tick.measured[j].count,
                tick.command_v[j],
            );
        }
    }
    text
}
