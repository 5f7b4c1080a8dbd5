//! Steps, as they are shown.

use std::fmt::Write;

use tracelight_chart::{Band, Colour, Figure, Key, Label, Mark, Panel, Pen, Sign, Theme};
use tracelight_lab::StepFigures;
use tracelight_rig::{Joint, TICK_F64_S};
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
        let shown = self.shown_ticks();
        let of_head = |value: &dyn Fn(&BenchTick) -> f64| {
            self.entries
                .iter()
                .map(|e| curve(colour(e.law), first(&e.response.nonlinear, shown), Pen::Solid, value))
                .collect::<Vec<_>>()
        };
        let mut angles = of_head(&angle);
        angles.extend(
            self.entries
                .iter()
                .map(|e| curve(colour(e.law), first(&e.response.linear, shown), Pen::Dashed, &angle)),
        );
        let goal = self.of.to_rad.to_degrees();
        let sides = [(1.0 - BAND) * goal, (1.0 + BAND) * goal];
        let mut of_angle = Panel {
            bands: vec![Band { low: sides[0].min(sides[1]), high: sides[0].max(sides[1]) }],
            ..over_time("angle, °", vec![goal], angles)
        };
        for entry in &self.entries {
            entry.mark(joint, goal, &mut of_angle);
        }
        // of many there would be more words than curves
        if self.entries.len() > MOST_NAMED {
            of_angle.labels.clear();
        }
        Ok(Figure {
            title: format!("{joint} sent to {goal:.2}°: the head (solid), linearized (dashed); shaded: ±2 %"),
            legend: self
                .entries
                .iter()
                .map(|e| Key {
                    colour: colour(e.law),
                    name: format!("{}, {:.2} % over", e.law.name(), e.nonlinear.overshoot_percent),
                })
                .collect(),
            panels: vec![of_angle, over_time("command, V", Vec::new(), of_head(&volts))],
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

/// Of more than this the marks have no words.
const MOST_NAMED: usize = 3;

/// Settled is within this share of the step.
const BAND: f64 = 0.02;

impl Finding {
    /// How many ticks are plotted: all, or, where every response settles, until they have and somewhat longer.
    fn shown_ticks(&self) -> usize {
        const MORE: f64 = 1.5;
        let figures = self.entries.iter().flat_map(|e| [&e.nonlinear, &e.linear]);
        let settled: Option<Vec<f64>> = figures.map(|figures| figures.settle_s).collect();
        let last_s = settled.map(|all| all.into_iter().fold(0.0, f64::max)).filter(|s| *s > 0.0);
        last_s.map_or(usize::MAX, |s| (MORE * s / TICK_F64_S).ceil() as usize)
    }
}

fn first(ticks: &[BenchTick], count: usize) -> &[BenchTick] {
    &ticks[..count.min(ticks.len())]
}

impl Entry {
    /// Peak and settling of the head, where they are.
    fn mark(&self, joint: Joint, goal: f64, panel: &mut Panel) {
        let colour = colour(self.law);
        let angles: Vec<f64> =
            self.response.nonlinear.iter().map(|tick| tick.angle_rad[joint].to_degrees()).collect();
        let beyond = |angle: f64| angle / goal;
        let peak = (0..angles.len()).max_by(|&a, &b| beyond(angles[a]).total_cmp(&beyond(angles[b])));
        let mut dot = |tick: usize, words: String| {
            let Some(&angle) = angles.get(tick) else { return };
            let at = (tick as f64 * TICK_F64_S, angle);
            panel.marks.push(Mark { colour, sign: Sign::Dot, at });
            panel.labels.push(Label::new(at, words));
        };
        if let Some(tick) = peak.filter(|_| self.nonlinear.overshoot_percent >= 100.0 * BAND) {
            dot(tick, format!("{}: {:.2} % over", self.law.name(), self.nonlinear.overshoot_percent));
        }
        if let Some(s) = self.nonlinear.settle_s {
            let tick = (s / TICK_F64_S).round() as usize;
            dot(tick, format!("{}: settled (2 %) at {s:.3} s", self.law.name()));
        }
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
