//! The report's objectives, and what came of them.

use serde_json::Value;

use super::{Places, command, text};
use crate::chapter::{Chapter, Done, Joined, Part, Run};
use crate::table::{Cell, Kind, Table};

/// Whom the columns are of: law and set.
const COLUMNS: [(&str, &str, &str); 6] = [
    ("report-pd", "A", "the report's PD, set A"),
    ("report-pd", "B", "the report's PD, set B"),
    ("report-zpk", "A", "its compensators, set A"),
    ("report-zpk", "B", "its compensators, set B"),
    ("state", "A", "ours, set A"),
    ("state", "B", "ours, set B"),
];

impl Places<'_> {
    pub(super) fn objectives(&self) -> Chapter {
        let mut runs = Vec::new();
        for (law, set, _) in COLUMNS {
            runs.extend([self.drawn_by(law, set), step(law, set, "pan"), step(law, set, "tilt")]);
        }
        let joined = Joined {
            caption: "The objectives: a star of 24 in and steps of 15°",
            runs,
            show: Box::new(table),
        };
        Chapter {
            title: "1.0 The objectives",
            parts: vec![
                text(
                    "\"To traverse an image at a rate of 1 ft/sec with 0% overshoot and no steady state errors.\" In March 2006 the report had a simulation whose PD overshot and \
                      kept a constant error, and compensators on a linear model; nothing was drawn yet. Here is what its laws do in the whole loop, on both of its sets of \
                      masses, with encoder, amplifiers and friction, and what the law of this program does. A law that loses its stroke leaves the laser dark.",
                ),
                Part::Joined(joined),
            ],
        }
    }

    /// The star drawn by a law; it may well end in a fault.
    fn drawn_by(&self, law: &str, set: &str) -> Run {
        let preset = if set == "B" { "report-b" } else { "report" };
        let star = self.path("pictures", "star.png");
        let out = self.path("runs", &format!("{law}-{set}"));
        let arguments = ["trace", &star, "--speed", "1ft/s", "--law", law, "--rig", preset, "--out", &out];
        Run { may_fail: true, ..command("", &arguments) }
    }
}

fn step(law: &str, set: &str, joint: &str) -> Run {
    command("", &["lab", "step", "--axis", joint, "--to", "15deg", "--law", law, "--set", set])
}

/// A row of the table: what, and how it is told from the three answers of a column.
type Row = (&'static str, fn(&[Done]) -> Cell);

const ROWS: [Row; 8] = [
    ("drawn to the end", |done| match stopped_by(done) {
        Some(code) => Cell { text: format!("dark: {code}"), kind: Kind::Misses },
        None => Cell { text: "yes".into(), kind: Kind::Fits },
    }),
    ("speed of the lit spot (1 ft/s)", |done| lit(done, "/tracking/lit_speed_m_s", 1.0 / 0.3048, "ft/s")),
    ("share of the lit time at 1 ft/s", |done| lit(done, "/tracking/at_speed_share", 100.0, "%")),
    ("error on the star, rms", |done| lit(done, "/tracking/rms_mm", 1.0, "mm")),
    ("overshoot of a step, pan (0 %)", |done| of(done, 1, "/overshoot_percent", "%")),
    ("overshoot of a step, tilt (0 %)", |done| of(done, 2, "/overshoot_percent", "%")),
    ("error at rest, pan (none)", |done| of(done, 1, "/final_error_mm", "mm")),
    ("error at rest, tilt (none)", |done| of(done, 2, "/final_error_mm", "mm")),
];

/// The fault that ended a drawing.
fn stopped_by(done: &[Done]) -> Option<&str> {
    let faults = done.first()?.0.pointer("/laser/faults")?.as_array()?;
    faults.iter().find(|fault| fault["stops"] == true)?["code"].as_str()
}

/// A figure of what was lit, if anything was.
fn lit(done: &[Done], pointer: &str, scale: f64, unit: &str) -> Cell {
    let Some((answer, _)) = done.first() else { return Cell::number(None, unit) };
    let lit_s = answer.pointer("/laser/lit_s").and_then(Value::as_f64).unwrap_or(0.0);
    let value = answer.pointer(pointer).and_then(Value::as_f64).filter(|_| lit_s > 0.0);
    rounded(value.map(|v| scale * v), unit)
}

fn of(done: &[Done], which: usize, pointer: &str, unit: &str) -> Cell {
    rounded(done.get(which).and_then(|(answer, _)| answer.pointer(pointer)?.as_f64()), unit)
}

/// To three digits behind the point: a micrometre.
fn rounded(value: Option<f64>, unit: &str) -> Cell {
    Cell::number(value.map(|v| (1e3 * v).round() / 1e3), unit)
}

fn table(done: &[Done]) -> Table {
    const EACH: usize = 3;
    let heads = std::iter::once("objective").chain(COLUMNS.map(|(.., name)| name));
    let row = |(what, tell): &Row| {
        let mut cells = vec![Cell::words(*what)];
        cells.extend(done.chunks(EACH).map(tell));
        cells
    };
    Table {
        heads: heads.map(str::to_owned).collect(),
        rows: ROWS.iter().map(row).collect(),
        finding: "A star's corners cannot be passed at speed: there the spot slows down, or is run up to and out of in the dark; the planner decides what is \
                  faster within the motors' torque. Errors are those of the spot on a wall 3 ft away."
            .into(),
    }
}
