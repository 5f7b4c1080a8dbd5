//! Many heads, as they are shown.

use std::fmt::Write;

use serde_json::{Value as Json, json};
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Scale, Theme};
use tracelight_lab::Quantiles;
use tracelight_task::Failure;

use super::{Finding, Trial};
use crate::finding::{self, Plotted};

/// A figure of a trial that is shown.
type Value = fn(&Trial) -> f64;

/// Their names in JSON and in the table.
const FIGURES: [(&str, &str, Value); 6] = [
    ("rms_mm", "error rms, mm", |t| t.tracking.rms_mm),
    ("max_mm", "error at most, mm", |t| t.tracking.max_mm),
    ("off_stroke_rms_mm", "off its stroke rms, mm", |t| t.tracking.off_stroke_rms_mm),
    ("off_stroke_max_mm", "off its stroke at most, mm", |t| t.tracking.off_stroke_max_mm),
    ("overshoot_percent", "overshoot, %", |t| t.tracking.overshoot_percent),
    ("final_error_mm", "error at rest, mm", |t| t.tracking.final_error_mm),
];

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = format!(
            "{}{} on {} heads like {}, law {}: {} finished, {} left the stroke and came back\n\n{:28} {:>8} {:>8} {:>8}",
            self.shape,
            if self.laps > 1 { format!(", lap {},", self.laps) } else { String::new() },
            self.trials.len(),
            self.rig,
            self.law.name(),
            self.finished().count(),
            self.held(),
            "",
            "median",
            "95 %",
            "worst"
        );
        for (_, words, value) in FIGURES {
            let Quantiles { median, p95, worst } = Quantiles::of(self.finished().map(value));
            // writing to a String cannot fail
            let _ = write!(text, "\n{words:28} {median:8.3} {p95:8.3} {worst:8.3}");
        }
        text
    }

    fn json(&self) -> String {
        let mut object = json!({
            "plants": self.trials.len(),
            "finished": self.finished().count(),
            "held": self.held(),
        });
        for (name, _, value) in FIGURES {
            if self.finished().next().is_none() {
                object[name] = Json::Null;
                continue;
            }
            let Quantiles { median, p95, worst } = Quantiles::of(self.finished().map(value));
            object[name] = json!({ "median": median, "p95": p95, "worst": worst });
        }
        object.to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let sorted = |colour: Colour, value: Value| {
            let mut values: Vec<f64> = self.finished().map(value).collect();
            values.sort_by(f64::total_cmp);
            let share = |k: usize| 100.0 * (k + 1) as f64 / values.len() as f64;
            let points = values.iter().enumerate().map(|(k, &v)| (share(k), v)).collect();
            Curve { colour, pen: Pen::Solid, points }
        };
        Ok(Figure {
            title: format!("{} on {} heads that differ", self.shape, self.trials.len()),
            legend: vec![
                Key { colour: Colour::Violet, name: "at most".into() },
                Key { colour: Colour::Ochre, name: "rms".into() },
            ],
            panels: vec![Panel {
                x_title: "share of the heads, %".into(),
                y_title: "error not above, mm".into(),
                curves: vec![sorted(Colour::Violet, FIGURES[1].2), sorted(Colour::Ochre, FIGURES[0].2)],
                levels: vec![0.0],
                scale: Scale::Free,
                ..Panel::default()
            }],
            columns: 1,
            panel: (680, 380),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let names: Vec<&str> = FIGURES.iter().map(|(name, _, _)| *name).collect();
        let mut text = format!("seed,finished,late_ticks,{}\n", names.join(","));
        for (number, trial) in self.trials.iter().enumerate() {
            let seed = self.seed + number as u64;
            let _ = write!(text, "{seed},{},{}", u8::from(trial.finished), trial.late_ticks);
            for (_, _, value) in FIGURES {
                let figure = if trial.finished { format!("{:.6}", value(trial)) } else { String::new() };
                text += &format!(",{figure}");
            }
            text.push('\n');
        }
        Ok(text)
    }
}
