//! Tilt's weight, as it is shown.

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Theme};
use tracelight_lab::Uncertain;
use tracelight_maths::{cos, sin};
use tracelight_rig::Joint;
use tracelight_task::Failure;

use super::Finding;
use crate::finding::{self, Filed, Improved, svg};
use crate::numbers::{HOW_SURE, lines, milli};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let believed = self.believed_nm();
        let spring = self.rig().quirks_of(Joint::Tilt).cable.spring_nm_per_rad;
        let row = |words: &str, found: Option<Uncertain>, had: f64| {
            format!("\n{words:26} {:>22} {:>17.4}", milli(found), 1e3 * had)
        };
        self.trials.in_words()
            + &lines(&self.said)
            + &format!("\n\n{:26} {:>22} {:>17}", "tilt", "found", "the rig file has")
            + &row("weight, beam level, mNm", Some(self.weight.nm[0]), believed[0])
            + &row("weight, beam upright, mNm", Some(self.weight.nm[1]), believed[1])
            + &row("cables, mNm/rad", self.weight.spring_nm_per_rad, spring)
            + &self.subject.left_out()
            + HOW_SURE
    }

    fn json(&self) -> String {
        let (weight, believed) = (&self.weight, self.believed_nm());
        json!({"tilt": {
            "gravity_level_nm": weight.nm[0].value,
            "gravity_upright_nm": weight.nm[1].value,
            "cable_spring_nm_per_rad": weight.spring_nm_per_rad.map(|u| u.value),
            "within": {
                "gravity_level_nm": weight.nm[0].within,
                "gravity_upright_nm": weight.nm[1].within,
                "cable_spring_nm_per_rad": weight.spring_nm_per_rad.map(|u| u.within),
            },
            "believed": {"gravity_level_nm": believed[0], "gravity_upright_nm": believed[1]},
        }})
        .to_string()
    }
}

impl Filed for Finding {
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        Ok(vec![("gravity.svg", svg(&self.figure())?)])
    }
}

impl Finding {
    /// Weight as it was believed, beam level and upright, N m.
    fn believed_nm(&self) -> [f64; 2] {
        self.subject.believed.gravity_nm.unwrap_or_default()
    }

    /// What holds tilt, over its angle.
    fn figure(&self) -> Figure {
        const MILLI: f64 = 1e3;
        const POINTS: i32 = 200;
        let parts = self.curves.parts.iter();
        let places = parts.map(|part| (part.angle_rad.to_degrees(), MILLI * part.weight_nm));
        let dots: Vec<(f64, f64)> = places.collect();
        let ends = dots
            .iter()
            .fold((0.0_f64, 0.0_f64), |(low, high), (angle, _)| (low.min(*angle), high.max(*angle)));
        let along = |holds: &dyn Fn(f64) -> f64| {
            let angle = |k: i32| ends.0 + (ends.1 - ends.0) * f64::from(k) / f64::from(POINTS);
            (0..=POINTS).map(|k| (angle(k), MILLI * holds(angle(k).to_radians()))).collect::<Vec<_>>()
        };
        let spring = self.weight.spring_nm_per_rad.map_or(0.0, |u| u.value);
        let held = |[level, upright]: [f64; 2], spring: f64| {
            move |angle: f64| spring * angle - level * cos(angle) - upright * sin(angle)
        };
        let believed = held(self.believed_nm(), 0.0);
        let found = held(self.weight.nm.map(|u| u.value), spring);
        Figure {
            title: format!("What holds tilt of rig {} against its weight", self.rig().name),
            legend: vec![
                Key::new(Colour::Tilt, "found (dots: a second each, less friction and what speeds it up)"),
                Key::new(Colour::Black, "dashed: the rig file has"),
            ],
            panels: vec![Panel {
                x_title: "tilt, ° (positive: the beam down)".into(),
                y_title: "torque, mN m".into(),
                curves: vec![
                    Curve { colour: Colour::Tilt, pen: Pen::Dots, points: dots },
                    Curve { colour: Colour::Tilt, pen: Pen::Solid, points: along(&found) },
                    Curve { colour: Colour::Black, pen: Pen::Dashed, points: along(&believed) },
                ],
                ..Panel::default()
            }],
            columns: 1,
            panel: (820, 420),
            theme: Theme::Light,
        }
    }
}
