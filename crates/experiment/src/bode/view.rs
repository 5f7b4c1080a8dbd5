//! A Bode plot and its margins, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Curve, Figure, Key, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{Stability, decibels};
use tracelight_task::Failure;

use super::{Entry, Finding};
use crate::finding::{self, Plotted};
use crate::margins::{margin_lines, margins_json, summary};
use crate::systems::{stability_name, system_json};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for Entry { named, margins, closed, .. } in &self.entries {
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", named.name, named.system);
            let _ = writeln!(text, "{}", margin_lines(&named.system, margins));
            let closed = match closed {
                Some(Stability::Stable) => "is stable",
                Some(Stability::Marginal) => {
                    "is at the edge of stability, or nearer to it than rounding lets tell"
                }
                Some(Stability::Growing) => "is not stable",
                None => "is not defined: 1 + G is zero at infinite frequency",
            };
            let _ = writeln!(text, "    closed by negative feedback it {closed}\n");
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| {
            let mut object = system_json(&entry.named.name, &entry.named.system);
            object["margins"] = margins_json(&entry.named.system, &entry.margins);
            object["closed_stable"] = entry.closed.map(|closed| closed == Stability::Stable).into();
            object["closed_stability"] = entry.closed.map(stability_name).into();
            object["bandwidth_rad_s"] = entry.named.system.bandwidth().into();
            object["magnitude_db"] = entry.response.magnitudes_db().collect();
            object["phase_deg"] = entry.response.phases_deg().collect();
            object
        };
        let rad_s = self.entries.first().map(|entry| &entry.response.rad_s);
        json!({"rad_s": rad_s, "systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let curve = |entry: &Entry, values: Vec<f64>| Curve {
            colour: entry.named.colour,
            pen: Pen::Solid,
            points: entry.response.rad_s.iter().copied().zip(values).collect(),
        };
        let panel = |title: &str, level: f64, step: f64, curves: Vec<Curve>| Panel {
            x_title: "frequency, rad/s".into(),
            y_title: title.into(),
            curves,
            levels: vec![level],
            scale: Scale::LogX,
            y_step: Some(step),
            ..Panel::default()
        };
        let mut magnitude = panel(
            "amplification, dB",
            0.0,
            20.0,
            self.entries.iter().map(|e| curve(e, e.response.magnitudes_db().collect())).collect(),
        );
        let mut phase = panel(
            "phase, °",
            -180.0,
            45.0,
            self.entries.iter().map(|e| curve(e, e.response.phases_deg().collect())).collect(),
        );
        for entry in &self.entries {
            mark(entry, &mut magnitude, &mut phase);
        }
        Ok(Figure {
            title: "Bode plot, margins marked".into(),
            legend: self
                .entries
                .iter()
                .map(|e| Key { colour: e.named.colour, name: summary(&e.named.name, &e.margins) })
                .collect(),
            panels: vec![magnitude, phase],
            columns: 1,
            panel: (820, 300),
            theme: self.theme,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("rad_s");
        for number in 1..=self.entries.len() {
            let _ = write!(text, ",magnitude_db_{number},phase_deg_{number}");
        }
        let columns: Vec<(Vec<f64>, Vec<f64>)> = self
            .entries
            .iter()
            .map(|e| (e.response.magnitudes_db().collect(), e.response.phases_deg().collect()))
            .collect();
        let rad_s = self.entries.first().map(|entry| entry.response.rad_s.as_slice()).unwrap_or_default();
        for (row, w) in rad_s.iter().enumerate() {
            let _ = write!(text, "\n{w:.9e}");
            for (magnitudes, phases) in &columns {
                let _ = write!(text, ",{:.6},{:.6}", magnitudes[row], phases[row]);
            }
        }
        Ok(text + "\n")
    }
}

/// Lines from the levels to the curves where the margins are.
fn mark(entry: &Entry, magnitude: &mut Panel, phase: &mut Panel) {
    let colour = entry.named.colour;
    let rad_s = &entry.response.rad_s;
    let band = rad_s.first().copied().unwrap_or(0.0)..=rad_s.last().copied().unwrap_or(0.0);
    let line = |panel: &mut Panel, rad_s: f64, from: f64, to: f64| {
        if !band.contains(&rad_s) {
            return;
        }
        panel.curves.push(Curve { colour, pen: Pen::Dashed, points: vec![(rad_s, from), (rad_s, to)] });
        panel.marks.push(Mark { colour, sign: Sign::Dot, at: (rad_s, to) });
    };
    if let Some(margin) = entry.margins.least_gain().filter(|margin| margin.rad_s > 0.0) {
        line(magnitude, margin.rad_s, 0.0, -decibels(margin.factor));
    }
    if let Some(margin) = entry.margins.least_phase() {
        // −180°, or that a whole number of turns further
        let shown = entry.named.system.phase(margin.rad_s).to_degrees();
        line(phase, margin.rad_s, shown - margin.degrees(), shown);
    }
}
