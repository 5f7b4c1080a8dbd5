//! Steps, as they are shown.

use std::fmt::Write;

use tracelight_chart::{Colour, Figure, Key, Pen, Theme};
use tracelight_lab::StepFigures;
use tracelight_rig::TICK_F64_S;
use tracelight_sim::{BenchTick, LawName};
use tracelight_task::Failure;

use super::{Entry, Finding};
use crate::finding::{self, Plotted};
use crate::panels::{curve, over_time};
use crate::step_words::{figures_json, heading, row};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = heading(&self.of.rig, self.of.joint, self.of.to_rad);
        for entry in &self.entries {
            text += &row(entry.law.name(), &entry.nonlinear, &entry.linear, &self.of.rig);
        }
        text + "\n\nmm on a target 3 ft away."
    }

    fn json(&self) -> String {
        let of = |figures: &StepFigures| figures_json(figures, &self.of.rig);
        let whole = |entry: &Entry| {
            let mut object = of(&entry.nonlinear);
            object["law"] = entry.law.name().into();
            object["linear"] = of(&entry.linear);
            object
        };
        let mut flat = self.entries.first().map(whole).unwrap_or_default();
        flat["axis"] = self.of.joint.name().into();
        flat["to_rad"] = self.of.to_rad.into();
        flat["laws"] = self.entries.iter().map(whole).collect();
        flat.to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let joint = self.of.joint;
        let angle = |tick: &BenchTick| tick.angle_rad[joint].to_degrees();
        let volts = |tick: &BenchTick| f64::from(tick.command_v[joint]);
        let of_head = |value: &dyn Fn(&BenchTick) -> f64| {
            self.entries
                .iter()
                .map(|e| curve(colour(e.law), &e.response.nonlinear, Pen::Solid, value))
                .collect::<Vec<_>>()
        };
        let mut angles = of_head(&angle);
        angles.extend(
            self.entries.iter().map(|e| curve(colour(e.law), &e.response.linear, Pen::Dashed, &angle)),
        );
        Ok(Figure {
            title: format!(
                "{joint} sent to {:.2}°: the head (solid), linearized (dashed)",
                self.of.to_rad.to_degrees()
            ),
            legend: self
                .entries
                .iter()
                .map(|e| Key {
                    colour: colour(e.law),
                    name: format!("{}, {:.2} % over", e.law.name(), e.nonlinear.overshoot_percent),
                })
                .collect(),
            panels: vec![
                over_time("angle, °", vec![self.of.to_rad.to_degrees()], angles),
                over_time("command, V", Vec::new(), of_head(&volts)),
            ],
            columns: 1,
            panel: (760, 300),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let Some(entry) = self.entries.first() else { return Ok(String::new()) };
        let joint = self.of.joint;
        let mut text = String::from("t_s,set_rad,angle_rad,est_rad,est_rad_s,count,command_v,linear_rad\n");
        let both = entry.response.nonlinear.iter().zip(&entry.response.linear);
        for (number, (is, linear)) in both.enumerate() {
            let estimate = &is.estimates[joint];
            let _ = writeln!(
                text,
                "{:.3},{:.7},{:.7},{:.7},{:.6},{},{:.4},{:.7}",
                number as f64 * TICK_F64_S,
                is.setpoint[joint].position_rad,
                is.angle_rad[joint],
                estimate.position_rad,
                estimate.velocity_rad_s,
                is.measured[joint].count,
                is.command_v[joint],
                linear.angle_rad[joint],
            );
        }
        Ok(text)
    }
}

/// The colour of a law in every plot.
const fn colour(law: LawName) -> Colour {
    match law {
        LawName::State => Colour::Violet,
        LawName::PidFeedforward => Colour::Green,
        LawName::Pid => Colour::Sky,
        LawName::HandTuned => Colour::Grey,
        LawName::LeadLag => Colour::Olive,
        LawName::ReportZpk => Colour::Ochre,
        LawName::ReportTimeConstants => Colour::Slate,
        LawName::ReportPd => Colour::Black,
    }
}
