//! A controller and its loop, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Pen};
use tracelight_linear::Stability;
use tracelight_task::Failure;

use super::Finding;
use crate::design::panels::step_panels;
use crate::design::set;
use crate::finding::{self, Plotted};
use crate::margins::{margin_lines, margins_json};
use crate::numbers::{four, percent, seconds};
use crate::system_json::{pairs, stability_name, system_json};
use crate::systems::pole_lines;
use crate::trial::Trial;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let Self { name, plant, controller, closed, margins, info, .. } = self;
        let mut text = format!("{name} = {plant}\n{}\nK = {controller}\n", self.note);
        if let Some((design, _)) = &self.pid {
            text += &design.lines();
        }
        // writing to a String cannot fail
        let _ = writeln!(text, "\nthe loop\n{}", margin_lines(self.delay_margin, margins));
        if let Some(value) = info.ending.value() {
            let _ = writeln!(
                text,
                "\na step has final value {}, overshoot {}, rise time {}, settling time (2 %) {}",
                four(value),
                percent(info.overshoot_percent),
                seconds(info.rise_s),
                seconds(info.settle_s)
            );
            let _ = match self.peak {
                Some(peak) => writeln!(text, "for a step of 1 the input is {} at most", four(peak)),
                None => writeln!(
                    text,
                    "for a step of 1 the input has no largest value: it is an impulse, or grows"
                ),
            };
        }
        if let Some((design, weighted)) = &self.pid {
            text += &design.step_lines(weighted);
        }
        let closed_is = match self.stability {
            Stability::Stable => "stable",
            Stability::Marginal => "at the edge of stability, or nearer to it than rounding lets tell",
            Stability::Growing => "NOT stable: it grows",
        };
        let _ = write!(
            text,
            "\nclosed it is {closed_is}\n{}",
            pole_lines(&closed.denominator().distinct_roots(), closed.time())
        );
        if !self.set.is_empty() {
            text += &set::lines(&self.set);
        }
        if let Some(trial) = &self.trial {
            text += &format!("\n{}", trial.text());
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let info = self.info;
        let stable = self.stability == Stability::Stable;
        let modulus = self.margins.modulus.filter(|_| stable);
        let zpk = &self.controller;
        json!({
            "system": system_json(&self.name, &self.plant),
            "controller": {
                "text": zpk.to_string(),
                "gain": zpk.gain(),
                "zeros": pairs(zpk.zeros()),
                "poles": pairs(zpk.poles()),
                "num": zpk.transfer().numerator().coefficients(),
                "den": zpk.transfer().denominator().coefficients(),
            },
            "margins": margins_json(self.delay_margin, &self.margins),
            "closed_poles": pairs(&self.closed.poles()),
            "closed_stable": stable,
            "closed_stability": stability_name(self.stability),
            "bandwidth_rad_s": stable.then(|| self.closed.bandwidth()).flatten(),
            "sensitivity": modulus.map(|m| 1.0 / m.distance).filter(|s| s.is_finite()),
            "complementary_sensitivity": self.closed.peak().map(|peak| peak.gain),
            "step": info.ending.value().map(|value| json!({
                "final": value,
                "overshoot_percent": info.overshoot_percent,
                "rise_s": info.rise_s,
                "settle_s": info.settle_s,
            })),
            "pid": self.pid.as_ref().map(|(design, weighted)| design.json(weighted)),
            "set": (!self.set.is_empty()).then(|| set::json(&self.set)),
            "trial": self.trial.as_ref().map(Trial::json),
            "input_peak": self.peak.filter(|_| stable),
        })
        .to_string()
    }
}

impl Finding {
    /// Steps of the other systems.
    fn others(&self) -> impl Iterator<Item = &[f64]> {
        self.set.iter().skip(1).map(|member| member.step.as_slice())
    }
}

/// The step of another system, as far as a plot has room.
fn others_curve(step: &[f64], step_s: f64) -> Curve {
    /// What grows is shown to here.
    const MOST: f64 = 3.0;
    let points = (0..).zip(step).map(|(k, y)| (f64::from(k) * step_s, *y));
    Curve {
        colour: Colour::Grey,
        pen: Pen::Solid,
        points: points.take_while(|(_, y)| y.abs() <= MOST).collect(),
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let phase = self
            .margins
            .least_phase()
            .map_or(String::new(), |m| format!(", {}° of phase", four(m.degrees())));
        let modulus =
            self.margins.modulus.map_or(String::new(), |m| format!(", modulus {}", four(m.distance)));
        let mut panels = Vec::from(step_panels(&self.step, &self.input));
        let mut legend = vec![Key { colour: Colour::Violet, name: format!("a step of 1{phase}{modulus}") }];
        if !self.set.is_empty() {
            panels[0].curves.splice(..0, self.others().map(|step| others_curve(step, self.step.step_s)));
            legend.push(Key { colour: Colour::Grey, name: "with each other system".into() });
        }
        if let Some(trial) = &self.trial {
            panels.extend(trial.panels());
            legend.push(Key { colour: Colour::Ochre, name: trial.name() });
        }
        Ok(Figure {
            title: match self.controller.to_string() {
                text if text.chars().count() <= 70 => format!("{} with K = {text}", self.name),
                _ => format!("{} with a K of order {}", self.name, self.controller.poles().len()),
            },
            legend,
            columns: if panels.len() > 2 { 2 } else { 1 },
            panel: if panels.len() > 2 { (560, 280) } else { (820, 280) },
            panels,
            theme: self.theme,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("t_s,output,input");
        for number in 0..self.others().count() {
            let _ = write!(text, ",output_{}", number + 2);
        }
        text.push('\n');
        for (row, output) in self.step.values.iter().enumerate() {
            let input = self.input.values.get(row).map_or(String::new(), |u| format!("{u:.9e}"));
            let _ = write!(text, "{:.9e},{output:.9e},{input}", row as f64 * self.step.step_s);
            for step in self.others() {
                let _ = match step.get(row).filter(|y| y.is_finite()) {
                    Some(y) => write!(text, ",{y:.9e}"),
                    None => write!(text, ","),
                };
            }
            text.push('\n');
        }
        Ok(text)
    }
}
