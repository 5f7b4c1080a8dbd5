//! A motion and how it was followed, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_plant::Wear;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::ScopeTick;
use tracelight_task::Failure;

use super::{Entry, Figures, Finding, Motion};
use crate::finding::{self, Plotted};
use crate::panels::over_time;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let of = &self.of;
        let what = match &of.motion {
            Motion::Array(log, _) => log.name.clone(),
            Motion::Random(_) => format!("a random motion (seed {})", of.seed),
        };
        let seen = match (of.quantizer, of.hold) {
            (true, true) => "seen in counts, every millisecond",
            (true, false) => "seen in counts, at once",
            (false, true) => "seen as they are, every millisecond",
            (false, false) => "seen as they are, at once",
        };
        let mut text = format!(
            "{what}, {:.3} s and {} s of rest, on rig {}, angles {seen}\n\n{:28} {:>10} {:>14} {:>14} {:>10}",
            self.array.length_s(),
            of.rest_s,
            of.rig.name,
            "error",
            "rms, mrad",
            "at most, mrad",
            "at rest, mrad",
            "capped, %"
        );
        for entry in &self.entries {
            Joint::BOTH.into_iter().for_each(|joint| text += &row(entry, joint));
        }
        text += "\n\nA mrad is 0.91 mm on a target 3 ft away.";
        if of.followers.controllers.is_some() && of.rig.truth.wear != Wear::NONE {
            text += " The --controller drives a new head: wear is left out.";
        }
        text
    }

    fn json(&self) -> String {
        let joint = |figures: &Figures| {
            json!({
                "rms_rad": figures.rms_rad, "max_rad": figures.max_rad, "final_error_rad": figures.final_rad,
                "rms_mm": mm(figures.rms_rad), "max_mm": mm(figures.max_rad), "final_error_mm": mm(figures.final_rad),
                "capped_share": figures.capped,
            })
        };
        let one = |entry: &Entry| json!({"by": entry.name(), "pan": joint(&entry.figures.pan), "tilt": joint(&entry.figures.tilt)});
        json!({
            "length_s": self.array.length_s(),
            "seed": self.of.seed,
            "runs": self.entries.iter().map(one).collect::<Vec<_>>(),
        })
        .to_string()
    }
}

/// How a joint followed; a name too long for its column stands above.
fn row(entry: &Entry, joint: Joint) -> String {
    let figures = &entry.figures[joint];
    let name = format!("{joint}, {}", entry.by[joint]);
    let shown = if name.chars().count() > 28 { format!("{name}\n{:28}", "") } else { format!("{name:28}") };
    format!(
        "\n{shown} {:10.3} {:14.3} {:14.3} {:10.1}",
        1e3 * figures.rms_rad,
        1e3 * figures.max_rad,
        1e3 * figures.final_rad,
        100.0 * figures.capped
    )
}

fn mm(angle_rad: f64) -> f64 {
    1e3 * DEFAULT_DISTANCE_M * angle_rad
}

/// Something of a joint in each tick.
type Value = fn(&ScopeTick, Joint) -> f64;

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let mut legend: Vec<Key> =
            self.entries.iter().map(|entry| Key { colour: entry.colour, name: entry.name() }).collect();
        legend.push(Key { colour: Colour::Black, name: "dashed: desired".into() });
        let what = match &self.of.motion {
            Motion::Array(log, _) => &log.name,
            Motion::Random(_) => "A random motion",
        };
        Ok(Figure {
            title: format!("{what}, {:.3} s, on rig {}", self.array.length_s(), self.of.rig.name),
            legend,
            panels: self.panels(),
            columns: 2,
            panel: (600, 260),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from(
            "t_s,pan_set_rad,tilt_set_rad,pan_rad,tilt_rad,pan_error_rad,tilt_error_rad,pan_nm,tilt_nm\n",
        );
        let first = self.entries.first().map_or(&[][..], |entry| &entry.ticks);
        for (number, ScopeTick { set_rad, angle_rad, torque_nm }) in first.iter().enumerate() {
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "{:.3},{:.7},{:.7},{:.7},{:.7},{:.7},{:.7},{:.6},{:.6}",
                number as f64 * TICK_F64_S,
                set_rad.pan,
                set_rad.tilt,
                angle_rad.pan,
                angle_rad.tilt,
                set_rad.pan - angle_rad.pan,
                set_rad.tilt - angle_rad.tilt,
                torque_nm.pan,
                torque_nm.tilt,
            );
        }
        Ok(text)
    }
}

impl Finding {
    /// Angles, errors and torques, pan on the left.
    fn panels(&self) -> Vec<Panel> {
        // as many points as a panel is wide
        const POINTS: usize = 600;
        let longest = self.entries.iter().map(|entry| entry.ticks.len()).max().unwrap_or(1);
        let every = (longest / POINTS).max(1);
        let curve = |entry: &Entry, colour: Colour, joint: Joint, value: Value| {
            let ticks = entry.ticks.iter().enumerate().step_by(every);
            let points = ticks.map(|(number, tick)| (number as f64 * TICK_F64_S, value(tick, joint)));
            Curve { colour, pen: Pen::Solid, points: points.collect() }
        };
        let angle: Value = |tick, j| tick.angle_rad[j].to_degrees();
        let error: Value = |tick, j| 1e3 * (tick.set_rad[j] - tick.angle_rad[j]);
        let effort: Value = |tick, j| tick.torque_nm[j];
        let set: Value = |tick, j| tick.set_rad[j].to_degrees();
        let of_all = |joint: Joint, value: Value| -> Vec<Curve> {
            // the first on top
            self.entries.iter().rev().map(|entry| curve(entry, entry.colour, joint, value)).collect()
        };
        let angles = |joint: Joint| {
            let desired = self.entries.first().map(|entry| curve(entry, Colour::Black, joint, set));
            let mut curves = of_all(joint, angle);
            curves.extend(desired.map(|curve| Curve { pen: Pen::Dashed, ..curve }));
            over_time(format!("{joint}, °"), Vec::new(), curves)
        };
        let errors =
            |joint: Joint| over_time(format!("{joint} error, mrad"), vec![0.0], of_all(joint, error));
        let efforts =
            |joint: Joint| over_time(format!("{joint} torque, N m"), Vec::new(), of_all(joint, effort));
        [Joint::BOTH.map(angles), Joint::BOTH.map(errors), Joint::BOTH.map(efforts)]
            .into_iter()
            .flatten()
            .collect()
    }
}
