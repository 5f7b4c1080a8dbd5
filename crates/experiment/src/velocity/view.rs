//! Errors of velocity and acceleration, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Scale, Theme};
use tracelight_lab::VelocityError;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::ObserverName;
use tracelight_task::Failure;

use super::{Finding, Row, WITH_INTERVAL};
use crate::finding::{self, Plotted};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let stamps = if self.rig.truth.model.encoder.edge_stamps { "stamped" } else { "not stamped" };
        let mut text = format!(
            "{} on rig {}, edges {stamps}; error of the velocity while lit, rms over both joints, rad/s\n\n{:14} {:>10}",
            self.shape, self.rig.name, "observer", "best at"
        );
        self.speeds_m_s.iter().for_each(|&speed| text += &format!("{:>11}", in_words(speed)));
        for row in self.recommended() {
            text += &format!("\n{:14} {:>10}", row.observer.name(), interval_of(row));
            row.errors.iter().for_each(|error| text += &format!("{:11.5}", error.velocity_rms_rad_s));
        }
        text += "\n\nerror of the acceleration, rad/s²\n";
        for row in self.recommended() {
            text += &format!("\n{:14} {:>10}", row.observer.name(), interval_of(row));
            row.errors.iter().for_each(|error| text += &format!("{:11.3}", error.acceleration_rms_rad_s2));
        }
        text += "\n\nhighest:";
        for joint in Joint::BOTH {
            let (seen, truly) = (self.seen[joint], self.truly[joint]);
            // writing to a String cannot fail
            let _ = write!(
                text,
                " {joint} {:.3} rad/s and {:.2} rad/s² seen ({:.3} and {:.2} true){}",
                seen.velocity_rad_s,
                seen.acceleration_rad_s2,
                truly.velocity_rad_s,
                truly.acceleration_rad_s2,
                if joint == Joint::Pan { ";" } else { "" }
            );
        }
        text
    }

    fn json(&self) -> String {
        let recommended: serde_json::Map<_, _> = self
            .recommended()
            .iter()
            .filter(|row| WITH_INTERVAL.contains(&row.observer))
            .map(|row| (row.observer.name().to_owned(), (row.interval_ticks as f64).into()))
            .collect();
        let errors: Vec<_> = self
            .entries()
            .map(|(row, speed, error)| {
                json!({
                    "observer": row.observer.name(),
                    "interval_ms": WITH_INTERVAL.contains(&row.observer).then_some(row.interval_ticks),
                    "speed_m_s": speed,
                    "velocity_rms_rad_s": error.velocity_rms_rad_s,
                    "velocity_max_rad_s": error.velocity_max_rad_s,
                    "acceleration_rms_rad_s2": error.acceleration_rms_rad_s2,
                })
            })
            .collect();
        let highest = |joint: Joint| {
            let (seen, truly) = (self.seen[joint], self.truly[joint]);
            json!({
                "velocity_rad_s": seen.velocity_rad_s, "acceleration_rad_s2": seen.acceleration_rad_s2,
                "true_velocity_rad_s": truly.velocity_rad_s, "true_acceleration_rad_s2": truly.acceleration_rad_s2,
            })
        };
        json!({
            "recommended_interval_ms": recommended,
            "highest": { "pan": highest(Joint::Pan), "tilt": highest(Joint::Tilt) },
            "errors": errors,
        })
        .to_string()
    }
}

/// An error that is plotted.
type ErrorValue = fn(&VelocityError) -> f64;

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let key = |(number, &speed): (usize, &f64)| Key { colour: colour(number), name: in_words(speed) };
        let velocity: ErrorValue = |e| e.velocity_rms_rad_s;
        let acceleration: ErrorValue = |e| e.acceleration_rms_rad_s2;
        let panels = WITH_INTERVAL.into_iter().flat_map(|observer| {
            [
                self.panel(observer, format!("{}: velocity, rad/s", observer.name()), velocity),
                self.panel(observer, format!("{}: acceleration, rad/s²", observer.name()), acceleration),
            ]
        });
        Ok(Figure {
            title: "Error rms of velocity and acceleration over the interval (dashed: the Kalman filter)"
                .into(),
            legend: self.speeds_m_s.iter().enumerate().map(key).collect(),
            panels: panels.collect(),
            columns: 2,
            panel: (520, 260),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from(
            "observer,interval_s,speed_m_s,velocity_rms_rad_s,velocity_max_rad_s,acceleration_rms_rad_s2\n",
        );
        for (row, speed, error) in self.entries() {
            let interval = if WITH_INTERVAL.contains(&row.observer) {
                format!("{:.3}", row.interval_ticks as f64 * TICK_F64_S)
            } else {
                String::new()
            };
            let _ = writeln!(
                text,
                "{},{interval},{speed:.6},{:.7},{:.7},{:.5}",
                row.observer.name(),
                error.velocity_rms_rad_s,
                error.velocity_max_rad_s,
                error.acceleration_rms_rad_s2
            );
        }
        Ok(text)
    }
}

impl Finding {
    fn panel(&self, observer: ObserverName, title: String, value: ErrorValue) -> Panel {
        let rows: Vec<&Row> = self.rows.iter().filter(|row| row.observer == observer).collect();
        let kalman = self.rows.iter().find(|row| row.observer == ObserverName::Kalman);
        let at = |row: &Row| row.interval_ticks as f64;
        let mut curves = Vec::new();
        for number in 0..self.speeds_m_s.len() {
            let points = rows.iter().map(|row| (at(row), value(&row.errors[number])));
            curves.push(Curve { colour: colour(number), pen: Pen::Solid, points: points.collect() });
            let flat = kalman.iter().flat_map(|k| rows.iter().map(|row| (at(row), value(&k.errors[number]))));
            curves.push(Curve { colour: colour(number), pen: Pen::Dashed, points: flat.collect() });
        }
        Panel {
            x_title: "interval, ms".into(),
            y_title: title,
            curves,
            levels: Vec::new(),
            scale: Scale::Log,
            ..Panel::default()
        }
    }
}

fn interval_of(row: &Row) -> String {
    if WITH_INTERVAL.contains(&row.observer) {
        format!("{} ms", row.interval_ticks)
    } else {
        "–".to_owned()
    }
}

fn in_words(speed_m_s: f64) -> String {
    format!("{speed_m_s:.4} m/s")
}

/// The colour of a speed, slowest first.
const fn colour(number: usize) -> Colour {
    const COLOURS: [Colour; 6] =
        [Colour::Black, Colour::Violet, Colour::Green, Colour::Slate, Colour::Ochre, Colour::Olive];
    COLOURS[number % COLOURS.len()]
}
