//! A frequency response, as it is shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Mark, Panel, Pen, Scale, Sign, Theme};
use tracelight_lab::FrequencyPoint;
use tracelight_linear::decibels;
use tracelight_maths::complex;
use tracelight_rig::TICK_F64_S;
use tracelight_task::Failure;

use super::{Finding, Measured};
use crate::finding::{self, Plotted};
use crate::numbers::lines;
use crate::panels::of_joint;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = format!(
            "{}\n\n{:>9} {:>13} {:>10} {:>10} {:>9} {:>10} {:>12}",
            self.in_words(),
            "rad/s",
            "amplified, dB",
            "model, dB",
            "phase, °",
            "model, °",
            "coherence",
            "known to, %"
        );
        for (number, point) in self.points.iter().enumerate() {
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n{:9.3} {:13.2} {:10.2} {:10.1} {:9.1} {:10.4} {:12.2}",
                point.rad_s,
                decibels(complex::norm(point.response)),
                decibels(complex::norm(self.model.values[number])),
                self.phase_deg(number),
                self.model.phases_rad[number].to_degrees(),
                point.coherence,
                100.0 * point.deviation
            );
        }
        let to = self.coherent_to().map_or("nowhere".to_owned(), |rad_s| format!("to {rad_s:.1} rad/s"));
        text += &format!(
            "\n\nThe angle follows the voltage {to} (coherence 0.9); above, a count hides it: more volts, or more periods."
        );
        if !self.measured.seen.one_way {
            text += "\nIt stood or turned back on the way, so friction was no constant: more --speed, or less --amplitude.";
        }
        text
    }

    fn json(&self) -> String {
        let one = |(number, point): (usize, &FrequencyPoint)| {
            let model = self.model.values[number];
            json!({
                "rad_s": point.rad_s,
                "magnitude": complex::norm(point.response),
                "phase_deg": self.phase_deg(number),
                "coherence": point.coherence,
                "deviation": point.deviation,
                "model_magnitude": complex::norm(model),
                "model_phase_deg": self.model.phases_rad[number].to_degrees(),
            })
        };
        let mut object = json!({
            "axis": self.of.joint.name(),
            "bias_v": self.measured.bias_v,
            "one_way": self.measured.seen.one_way,
            "coherent_to_rad_s": self.coherent_to(),
            "points": self.points.iter().enumerate().map(one).collect::<Vec<_>>(),
        });
        if !self.measured.said.is_empty() {
            object["read_as"] = self.measured.said.clone().into();
        }
        object.to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let own = of_joint(self.of.joint);
        let numbers = 0..self.points.len();
        let rad_s = |number: usize| self.points[number].rad_s;
        let dots = |value: &dyn Fn(usize) -> f64| -> Vec<Mark> {
            numbers.clone().map(|k| Mark { colour: own, sign: Sign::Dot, at: (rad_s(k), value(k)) }).collect()
        };
        let line = |value: &dyn Fn(usize) -> f64| {
            let points = numbers.clone().map(|k| (rad_s(k), value(k))).collect();
            vec![Curve { colour: Colour::Black, pen: Pen::Dashed, points }]
        };
        let panel = |title: &str, marks: Vec<Mark>, curves: Vec<Curve>| Panel {
            x_title: "frequency, rad/s".into(),
            y_title: title.into(),
            marks,
            curves,
            scale: Scale::LogX,
            ..Panel::default()
        };
        let coherence = |k: usize| self.points[k].coherence;
        let panels = vec![
            panel(
                "angle per volt, dB",
                dots(&|k| decibels(complex::norm(self.points[k].response))),
                line(&|k| decibels(complex::norm(self.model.values[k]))),
            ),
            panel("phase, °", dots(&|k| self.phase_deg(k)), line(&|k| self.model.phases_rad[k].to_degrees())),
            panel("coherence", dots(&coherence), vec![Curve { colour: own, ..line(&coherence).remove(0) }]),
        ];
        Ok(Figure {
            title: format!("Frequency response of {}, rig {}", self.of.joint, self.of.rig.name),
            legend: vec![
                Key::new(own, "dots: measured"),
                Key::new(Colour::Black, "dashed: the rig file's model"),
            ],
            panels,
            columns: 1,
            panel: (820, 250),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from(
            "rad_s,magnitude_rad_per_v,phase_deg,coherence,deviation,model_magnitude,model_phase_deg\n",
        );
        for (number, point) in self.points.iter().enumerate() {
            let _ = writeln!(
                text,
                "{:.6},{:.6e},{:.3},{:.6},{:.6},{:.6e},{:.3}",
                point.rad_s,
                complex::norm(point.response),
                self.phase_deg(number),
                point.coherence,
                point.deviation,
                complex::norm(self.model.values[number]),
                self.model.phases_rad[number].to_degrees()
            );
        }
        Ok(text)
    }
}

impl Finding {
    /// A period of the volts, to be played to a head: CSV, `t_s,volt`.
    #[must_use]
    pub fn volts(&self) -> String {
        let Measured { multisine, bias_v, .. } = &self.measured;
        let mut text = String::from("t_s,volt\n");
        for (number, volts) in multisine.volts().iter().enumerate() {
            // writing to a String cannot fail
            let _ = writeln!(text, "{:.3},{:.6}", number as f64 * TICK_F64_S, bias_v + volts);
        }
        text
    }

    /// What was seen, as a log: CSV, `axis,time_s,volt,count`.
    #[must_use]
    pub fn record(&self) -> String {
        let (joint, seen) = (self.of.joint, &self.measured.seen);
        let count_rad = self.of.rig.model.encoder.count_rad();
        let mut text = String::from("axis,time_s,volt,count\n");
        for (number, (angle_rad, volts)) in seen.angles_rad.iter().zip(&seen.volts).enumerate() {
            let count = (angle_rad / count_rad).round();
            let _ = writeln!(text, "{joint},{:.3},{volts:.6},{count}", number as f64 * TICK_F64_S);
        }
        text
    }

    /// The phase that was measured, turned as often as the model's.
    fn phase_deg(&self, number: usize) -> f64 {
        let (measured, model) = (complex::arg(self.points[number].response), self.model.phases_rad[number]);
        let turns = ((model - measured) / std::f64::consts::TAU).round();
        (measured + turns * std::f64::consts::TAU).to_degrees()
    }

    /// Up to which frequency the angle follows the voltage, rad/s.
    fn coherent_to(&self) -> Option<f64> {
        const COHERENT: f64 = 0.9;
        self.points.iter().take_while(|point| point.coherence >= COHERENT).last().map(|point| point.rad_s)
    }

    /// What was done.
    fn in_words(&self) -> String {
        let (joint, sines) = (self.of.joint, self.points.len());
        match &self.of.log {
            Some(log) => {
                let by = format!(
                    "{joint} by {}, on rig {}: {sines} sines that repeat each {} s, about {:.3} V",
                    log.name, self.of.rig.name, self.of.period_s, self.measured.bias_v
                );
                by + &lines(&self.measured.said)
            }
            None => format!(
                "{joint} of rig {} in a fixture, turning with {} rad/s under {:.3} V, {sines} sines together like one of {} V, {} periods of {} s",
                self.of.rig.name,
                self.of.speed_rad_s,
                self.measured.bias_v,
                self.of.amplitude_v,
                self.of.periods,
                self.of.period_s
            ),
        }
    }
}
