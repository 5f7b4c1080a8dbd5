//! Amplifiers, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_lab::{CurrentPoint, Uncertain};
use tracelight_task::{Failure, counted};

use super::{Finding, Found};
use crate::finding::{self, Filed, svg};
use crate::numbers::{HOW_SURE, lines, milli};
use crate::parts::by_joint;
use crate::table;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = if self.of.logs.is_empty() {
            format!(
                "rig {}, in a fixture, each axis upright and free: to ±{} V, an ammeter that shows {} mA",
                self.of.rig.name,
                self.of.most_v,
                1e3 * self.of.ammeter_a
            )
        } else {
            format!("{}, on rig {}", table::names(&self.of.logs), self.of.rig.name)
        };
        text += &lines(&self.said);
        for Found { joint, told: amplifier, .. } in &self.joints {
            let had = self.of.rig.model.motors[*joint].torque_nm_per_v;
            let torque = self.of.torque_nm_per_a;
            let scaled = |u: Uncertain| Uncertain { value: torque * u.value, within: torque * u.within };
            let rows = [
                ("amplifier, mA/V", milli(Some(amplifier.gain)), None),
                ("back-EMF, mA s/rad", milli(amplifier.back_emf), None),
                ("at 0 V, mA", milli(Some(amplifier.offset)), None),
                ("torque, mNm/V", milli(Some(scaled(amplifier.gain))), Some(1e3 * had)),
                ("back-EMF as friction, mNms/rad", milli(amplifier.back_emf.map(scaled)), None),
            ];
            // writing to a String cannot fail
            let _ = write!(text, "\n\n{:32} {:>22} {:>17}", joint.name(), "found", "the rig file has");
            for (what, found, had) in rows {
                let had = had.map_or(String::new(), |had| format!(" {had:>17.4}"));
                let _ = write!(text, "\n{what:32} {found:>22}{had}");
            }
            let _ = write!(
                text,
                "\namperes divided by volts, speed or not: {:.4} mA/V. {} readings, {:.2} mA rms beside this, r² {:.6}.",
                1e3 * amplifier.as_read,
                amplifier.points,
                1e3 * amplifier.left_a,
                amplifier.r2
            );
            for limit in &self.left_out[*joint] {
                let (readings, from_v) = (counted(limit.points.len(), "reading"), limit.from_v);
                text += &format!(
                    "\n{readings} left out: from {from_v:.2} V on nothing rises any more, whatever the volts: the amplifier's limit."
                );
            }
            if amplifier.back_emf.is_none() {
                text += " No speeds tell the back-EMF: with the motor turning the amplifier looks weaker than it is.";
            }
        }
        text + HOW_SURE
    }

    fn json(&self) -> String {
        let one = |Found { joint, told: amplifier, .. }: &Found| {
            let mut object = json!({
                "a_per_v": amplifier.gain.value,
                "back_emf_a_s_per_rad": amplifier.back_emf.map(|u| u.value),
                "offset_a": amplifier.offset.value,
                "torque_nm_per_v": amplifier.gain.value * self.of.torque_nm_per_a,
                "as_read_a_per_v": amplifier.as_read,
                "r2": amplifier.r2,
                "readings": amplifier.points,
                "within": {
                    "a_per_v": amplifier.gain.within,
                    "back_emf_a_s_per_rad": amplifier.back_emf.map(|u| u.within),
                    "offset_a": amplifier.offset.within,
                },
            });
            if !self.left_out[*joint].is_empty() {
                let counts = self.left_out[*joint].iter().map(|limit| limit.points.len());
                object["left_out"] = counts.sum::<usize>().into();
            }
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
        let mut files = vec![("amplifier.svg", svg(&self.figure())?)];
        if self.of.logs.is_empty() {
            files.push(("readings.csv", self.csv()));
        }
        Ok(files)
    }
}

impl Finding {
    fn csv(&self) -> String {
        let mut text = String::from("axis,volt,ampere,velocity_rad_s\n");
        for Found { joint, seen: points, .. } in &self.joints {
            for point in points {
                let rate = point.rate_rad_s.unwrap_or_default();
                let _ = writeln!(text, "{joint},{:.4},{:.6},{rate:.5}", point.volts, point.amperes);
            }
        }
        text
    }

    /// Amperes over volts: as read, and with the motor's own voltage given back.
    fn figure(&self) -> Figure {
        const MILLI: f64 = 1e3;
        let panel = |Found { joint, seen: points, told: amplifier }: &Found| {
            let dots =
                |of: &dyn Fn(&CurrentPoint) -> f64| points.iter().map(|p| (p.volts, MILLI * of(p))).collect();
            let back = amplifier.back_emf.map_or(0.0, |u| u.value);
            let ends = points.iter().fold((0.0_f64, 0.0_f64), |(l, h), p| (l.min(p.volts), h.max(p.volts)));
            let line =
                [ends.0, ends.1].map(|v| (v, MILLI * (amplifier.gain.value * v + amplifier.offset.value)));
            let still = |p: &CurrentPoint| p.amperes + back * p.rate_rad_s.unwrap_or_default();
            Panel {
                x_title: format!("{joint}: volts"),
                y_title: "mA".into(),
                curves: vec![
                    Curve { colour: Colour::Ochre, pen: Pen::Dots, points: dots(&|p| p.amperes) },
                    Curve { colour: Colour::Violet, pen: Pen::Dots, points: dots(&still) },
                    Curve { colour: Colour::Violet, pen: Pen::Solid, points: line.to_vec() },
                ],
                ..Panel::default()
            }
        };
        Figure {
            title: format!("Amplifiers of rig {}", self.of.rig.name),
            legend: vec![
                Key::new(Colour::Ochre, "as read, the motor turning or not"),
                Key::new(Colour::Violet, "as with the motor at rest; line: A/V found"),
            ],
            panels: self.joints.iter().map(panel).collect(),
            columns: self.joints.len(),
            panel: (520, 360),
            theme: Theme::Light,
        }
    }
}
