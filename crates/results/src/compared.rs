//! Two runs side by side: what they were asked, and how they came out.

use std::path::Path;

use serde_json::{Value, json};
use tracelight_task::Failure;
use unicode_width::UnicodeWidthStr as _;

use crate::journal::Asked;
use crate::listed::{ListedRun, listed};

/// Flags that say nothing of what is drawn or how.
const ASIDE: [&str; 7] = ["--out", "-o", "--json", "--quiet", "--open", "--events", "--real-time"];

/// A figure that both runs have or could have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// What it is.
    pub name: &'static str,
    /// What it counts.
    pub unit: &'static str,
    /// Digits after the point that tell runs apart.
    digits: usize,
    /// Of the first run and of the second; nothing where a run has none.
    pub of: [Option<f64>; 2],
}

/// Two runs, compared.
#[derive(Clone, Debug)]
pub struct Compared {
    runs: [ListedRun; 2],
    /// Whether both have as many strokes, and as long ones for their size.
    pub same_drawing: bool,
    /// What only the first was asked, and what only the second.
    pub asked: [Vec<String>; 2],
    /// How they came out.
    pub figures: Vec<Figure>,
}

/// Compares the runs of two folders.
///
/// # Errors
/// `not-a-run`.
pub fn compare(one: &Path, other: &Path) -> Result<Compared, Failure> {
    let read = |dir: &Path| -> Result<ListedRun, Failure> {
        let kept = crate::journal::read(dir)?;
        Ok(listed(dir, kept))
    };
    let runs = [read(one)?, read(other)?];
    let [first, second] = [0, 1].map(|n: usize| words(&runs[n].asked.arguments));
    let only = |of: &[String], not_in: &[String]| {
        of.iter().filter(|word| !not_in.contains(word)).cloned().collect::<Vec<_>>()
    };
    let asked = [only(&first, &second), only(&second, &first)];
    let same_drawing = is_alike(&runs[0].asked, &runs[1].asked);
    let figures = figures(&runs);
    Ok(Compared { runs, same_drawing, asked, figures })
}

/// Whether the same drawing was asked for, at whatever size, in whatever order.
fn is_alike(one: &Asked, other: &Asked) -> bool {
    const NEAR: f64 = 1e-6;
    let for_its_size = |asked: &Asked| asked.length_m / asked.size_m[0].max(f64::MIN_POSITIVE);
    let (one_is, other_is) = (for_its_size(one), for_its_size(other));
    one.strokes == other.strokes && (one_is - other_is).abs() <= NEAR * one_is.max(other_is)
}

/// A command's words, each flag with its value, but for those that say nothing of the drawing.
fn words(arguments: &[String]) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut takes_value = false;
    for argument in arguments.iter().skip(1) {
        let is_flag = argument.starts_with("--");
        match words.last_mut() {
            Some(last) if takes_value && !is_flag => {
                last.push(' ');
                last.push_str(argument);
            }
            _ => words.push(argument.clone()),
        }
        takes_value = is_flag && !argument.contains('=');
    }
    let is_aside = |word: &String| {
        let name = word.split(['=', ' ']).next().unwrap_or_default();
        ASIDE.contains(&name)
    };
    words.retain(|word| !is_aside(word));
    words
}

fn figures(runs: &[ListedRun; 2]) -> Vec<Figure> {
    let both = |of: &dyn Fn(&ListedRun) -> Option<f64>| [of(&runs[0]), of(&runs[1])];
    let summed = |path: [&'static str; 2], factor: f64| {
        both(&move |run| Some(factor * run.summary[path[0]][path[1]].as_f64()?))
    };
    let figure = |name, unit, digits, of| Figure { name, unit, digits, of };
    vec![
        figure("width", "mm", 1, both(&|run| Some(1e3 * run.asked.size_m[0]))),
        figure("height", "mm", 1, both(&|run| Some(1e3 * run.asked.size_m[1]))),
        figure("strokes", "", 0, both(&|run| Some(run.asked.strokes as f64))),
        figure("lines", "m", 3, both(&|run| Some(run.asked.length_m))),
        figure("planned time", "s", 1, summed(["plan", "duration_s"], 1.0)),
        figure("time", "s", 1, summed(["run", "duration_s"], 1.0)),
        figure("light on", "s", 1, summed(["laser", "lit_s"], 1.0)),
        figure("speed of the light", "mm/s", 1, summed(["tracking", "lit_speed_m_s"], 1e3)),
        figure("error, rms", "mm", 3, both(&ListedRun::rms_mm)),
        figure("error, most", "mm", 3, summed(["tracking", "max_mm"], 1.0)),
        figure("faults", "", 0, both(&faults)),
    ]
}

/// How many faults a run had; that somebody stopped it is none.
fn faults(run: &ListedRun) -> Option<f64> {
    let faults = run.summary["laser"]["faults"].as_array()?;
    Some(faults.iter().filter(|fault| fault["code"] != "disarmed").count() as f64)
}

impl Figure {
    /// Second less first, where both are there.
    #[must_use]
    pub fn difference(&self) -> Option<f64> {
        self.of[1].zip(self.of[0]).map(|(second, first)| second - first)
    }

    fn shown(&self, value: Option<f64>) -> String {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.*} {}", self.digits, self.unit))
    }

    fn shown_difference(&self) -> String {
        let Some(difference) = self.difference() else { return "–".to_owned() };
        let text = format!("{difference:+.*}", self.digits);
        // less than what is shown of the figures is none
        let is_none = text.chars().all(|c| matches!(c, '+' | '-' | '0' | '.'));
        if is_none { "same".to_owned() } else { format!("{text} {}", self.unit) }
    }
}

impl Compared {
    /// A table for people, 80 columns wide where names are short.
    #[must_use]
    pub fn text(&self) -> String {
        let name = |run: &ListedRun| {
            run.dir
                .file_name()
                .map_or_else(|| run.dir.display().to_string(), |name| name.to_string_lossy().into_owned())
        };
        let [first, second] = &self.runs;
        let mut lines = vec![[String::new(), name(first), name(second), "difference".to_owned()]];
        lines.extend(self.figures.iter().map(|figure| {
            let [first, second] = figure.of.map(|value| figure.shown(value).trim_end().to_owned());
            [figure.name.to_owned(), first, second, figure.shown_difference().trim_end().to_owned()]
        }));
        let widths: [usize; 4] =
            std::array::from_fn(|i| lines.iter().map(|line| line[i].width()).max().unwrap_or_default());
        let row = |line: &[String; 4]| {
            let pad = |n: usize| " ".repeat(widths[n] - line[n].width());
            let row = format!(
                "{}{}  {}{}  {}{}  {}{}",
                line[0],
                pad(0),
                pad(1),
                line[1],
                pad(2),
                line[2],
                pad(3),
                line[3]
            );
            row.trim_end().to_owned()
        };
        let mut text: Vec<String> = lines.iter().map(row).collect();
        for (run, asked) in self.runs.iter().zip(&self.asked) {
            if !asked.is_empty() {
                text.push(format!("only {} was asked: {}", name(run), asked.join(" ")));
            }
        }
        for run in self.runs.iter().filter(|run| !run.is_finished()) {
            text.push(format!(
                "{} did not finish ({}): its figures are of that part",
                name(run),
                run.how_far()
            ));
        }
        if !self.same_drawing {
            text.push("they have other strokes: the figures are of two drawings".to_owned());
        }
        text.join("\n")
    }

    /// For scripts.
    #[must_use]
    pub fn json(&self) -> Value {
        let figure = |figure: &Figure| {
            json!({
                "name": figure.name, "unit": figure.unit, "digits": figure.digits,
                "first": figure.of[0], "second": figure.of[1], "difference": figure.difference(),
            })
        };
        json!({
            "first": self.runs[0].json(),
            "second": self.runs[1].json(),
            "same_drawing": self.same_drawing,
            "only_first_asked": self.asked[0],
            "only_second_asked": self.asked[1],
            "figures": self.figures.iter().map(figure).collect::<Vec<_>>(),
        })
    }
}
