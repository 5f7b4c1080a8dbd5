//! Lessons, as they are shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::Figure;
use tracelight_lab::{Ask, Check, Graded, Lesson};
use tracelight_rig::TICK_F64_S;
use tracelight_task::Failure;

use super::{Finding, List, plot, text};
use crate::finding::{self, Plotted};

impl finding::Finding for List {
    fn text(&self) -> String {
        let mut text = String::from("Lessons, each `tracelight lab lesson NUMBER`:\n");
        for lesson in &Lesson::ALL {
            // writing to a String cannot fail
            let _ = write!(text, "\n{}  {}", lesson.number, lesson.title);
        }
        text
    }

    fn json(&self) -> String {
        let all: Vec<Value> = Lesson::ALL.iter().map(about).collect();
        json!({ "lessons": all }).to_string()
    }
}

impl finding::Finding for Finding {
    fn text(&self) -> String {
        match &self.graded {
            None => text::plain(&self.lesson),
            Some(graded) => table(&self.lesson, graded),
        }
    }

    fn json(&self) -> String {
        match &self.graded {
            None => about(&self.lesson).to_string(),
            Some(graded) => figures(&self.lesson, graded).to_string(),
        }
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(plot::figure(&self.lesson, self.graded.as_ref()))
    }

    fn csv(&self) -> Result<String, Failure> {
        Ok(self.graded.as_ref().map(csv).unwrap_or_default())
    }
}

/// A lesson for scripts.
fn about(lesson: &Lesson) -> Value {
    let ask = |ask: &Ask| json!({"name": ask.name, "unit": ask.unit, "least": ask.bounds.0, "most": ask.bounds.1, "meaning": ask.meaning});
    json!({
        "lesson": lesson.number,
        "title": lesson.title,
        "text": text::markdown(lesson.number),
        "asks": lesson.asks.iter().map(ask).collect::<Vec<_>>(),
    })
}

/// Columns of what is checked.
const NAME_COLUMNS: usize = 36;

fn table(lesson: &Lesson, graded: &Graded) -> String {
    let mut text =
        format!("Lesson {}: {}\n\n{:36} {:>10}  {:22}", lesson.number, lesson.title, "", "is", "must be");
    for check in &graded.checks {
        let mark = if check.is_met() { "ok" } else { "not yet" };
        // a name too long for its column stands above
        let name = match check.what.chars().count() > NAME_COLUMNS {
            true => format!("{}\n{:NAME_COLUMNS$}", check.what, ""),
            false => format!("{:NAME_COLUMNS$}", check.what),
        };
        let _ = write!(text, "\n{name} {:>10}  {:22} {mark}", shown(check.value), bounds(check));
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
