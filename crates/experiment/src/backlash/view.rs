//! Play and slip, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Figure, Key, Mark, Panel, Sign, Theme};
use tracelight_lab::{Backlash, Uncertain};
use tracelight_task::Failure;

use super::{Finding, Found, Reading};
use crate::finding::{self, Filed, svg};
use crate::numbers::{HOW_SURE, lines, rounded};
use crate::parts::by_joint;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let count_rad = self.of.rig.model.encoder.count_rad();
        let mut text = if self.of.logs.is_empty() {
            format!(
                "rig {}, {} ft from the target, a ruler read to {} mm, each place {} times from either side",
                self.of.rig.name,
                shortened(self.of.distance_m / 0.3048),
                shortened(1e3 * self.of.ruler_m),
                self.of.cycles
            )
        } else {
            format!("{}, on rig {}", self.of.names(), self.of.rig.name)
        };
        text += &lines(&self.said);
        for Found { joint, told: backlash, seen: readings } in &self.joints {
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n\n{:23} {:>18} {:>18} {:>18}",
                joint.name(),
                "mrad",
                "mm on the target",
                "counts"
            );
            let rows = [
                ("play", backlash.play_rad),
                ("beam ahead of encoder", backlash.zero_rad),
                ("further at the end", backlash.slip_rad),
            ];
            for (what, rad) in rows {
                let cell =
                    |scale: f64| format!("{} ± {:.3}", rounded(scale * rad.value, 3), scale * rad.within);
                let _ = write!(
                    text,
                    "\n{what:23} {:>18} {:>18} {:>18}",
                    cell(1e3),
                    cell(1e3 * self.of.distance_m),
                    cell(1.0 / count_rad)
                );
            }
            let _ = write!(
                text,
                "\n{} readings, {:.3} mm rms beside this.{}",
                readings.len(),
                1e3 * self.of.distance_m * backlash.left_rad,
                verdict(backlash)
            );
        }
        text + HOW_SURE
    }

    fn json(&self) -> String {
        let count_rad = self.of.rig.model.encoder.count_rad();
        let one = |Found { joint, told: backlash, seen: readings }: &Found| {
            let mut object = json!({
                "play_rad": backlash.play_rad.value,
                "play_mm": 1e3 * self.of.distance_m * backlash.play_rad.value,
                "zero_rad": backlash.zero_rad.value,
                "slip_rad": backlash.slip_rad.value,
                "slip_counts": backlash.slip_rad.value / count_rad,
                "slips": backlash.slip_rad.value.abs() > backlash.slip_rad.within,
                "left_rad": backlash.left_rad,
                "readings": readings.len(),
                "within": {
                    "play_rad": backlash.play_rad.within,
                    "zero_rad": backlash.zero_rad.within,
                    "slip_rad": backlash.slip_rad.within,
                },
            });
            if !self.said.is_empty() {
                object["read_as"] = self.said.clone().into();
            }
            (*joint, object)
        };
        by_joint(self.joints.iter().map(one))
    }
}

impl Filed for Finding {
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        let mut files = vec![("backlash.svg", svg(&self.figure())?)];
        if self.of.logs.is_empty() {
            files.push(("readings.csv", self.csv()));
        }
        Ok(files)
    }
}

impl Finding {
    fn csv(&self) -> String {
        let mut text = String::from("axis,count,way,spot_m\n");
        for Found { joint, seen: readings, .. } in &self.joints {
            for reading in readings {
                let _ = writeln!(text, "{joint},{},{},{:.6}", reading.count, reading.way, reading.spot_m);
            }
        }
        text
    }

    /// How far the beam is ahead of the encoder, reading by reading, from the mean of each place.
    fn figure(&self) -> Figure {
        let panel = |Found { joint, seen: readings, told: backlash }: &Found| {
            let mark = |(number, (reading, beside)): (usize, (&Reading, &Option<f64>))| {
                let colour = if reading.way > 0 { Colour::Violet } else { Colour::Ochre };
                let at = (number as f64 + 1.0, 1e3 * self.of.distance_m * (*beside)?);
                Some(Mark { colour, sign: Sign::Dot, at })
            };
            let half = 500.0 * self.of.distance_m * backlash.play_rad.value;
            let shown = readings.iter().zip(&backlash.beside_rad).enumerate();
            Panel {
                x_title: format!("{joint}: reading"),
                y_title: "beam ahead of encoder, from its place's mean, mm".into(),
                marks: shown.filter_map(mark).collect(),
                levels: vec![-half, half],
                ..Panel::default()
            }
        };
        Figure {
            title: format!("Play and slip of rig {}", self.of.rig.name),
            legend: vec![
                Key::new(Colour::Violet, "come turning positively"),
                Key::new(Colour::Ochre, "come turning negatively"),
            ],
            panels: self.joints.iter().map(panel).collect(),
            columns: self.joints.len(),
            panel: (560, 320),
            theme: Theme::Light,
        }
    }
}

/// A number without zeros behind it.
fn shortened(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn verdict(backlash: &Backlash) -> String {
    let sure = |u: Uncertain| u.value.abs() > u.within;
    let play = if backlash.play_rad.value > backlash.play_rad.within {
        ""
    } else {
        " No play that these readings could tell."
    };
    let slip = if sure(backlash.slip_rad) {
        " The encoder slips, or loses counts: its disc, its set-screw, its cable."
    } else {
        " The encoder does not slip."
    };
    format!("{play}{slip}")
}
