//! A move by every profile, as it is shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::{Curve, Figure, Key, Pen, Theme};
use tracelight_rig::TICK_F64_S;
use tracelight_task::Failure;
use tracelight_trajectory::{MovePoint, Peaks, Profile};

use super::{Finding, Move};
use crate::finding::{self, Plotted};
use crate::panels::over_time;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let limits = &self.of.limits;
        let mut text = format!(
            "{:.6} rad from rest to rest, at most {} rad/s, {} rad/s² speeding up, {} rad/s² braking\n\n\
             profile     duration, s  peak, rad/s  peak, rad/s²  peak, rad/s³",
            self.of.distance_rad, limits.speed, limits.acceleration, limits.deceleration
        );
        for (name, profile) in &self.all {
            let peaks = profile.peaks();
            let jerk = peaks.jerk.map_or_else(|| "–".to_owned(), |jerk| format!("{jerk:.5}"));
            // writing to a String cannot fail
            let _ = write!(
                text,
                "\n{:10} {:12.6} {:12.4} {:13.4} {:>13}",
                name.name(),
                profile.duration_s(),
                peaks.speed,
                peaks.acceleration.max(peaks.deceleration),
                trimmed(&jerk),
            );
        }
        text += "\n";
        for (name, profile) in &self.all {
            let Peaks { speed_jump, .. } = profile.peaks();
            if speed_jump > 0.0 {
                let _ =
                    write!(text, "\n{} starts and stops with a jump of {speed_jump:.3} rad/s.", name.name());
            }
        }
        text + "\n–: the acceleration jumps, so the jerk has no bound."
    }

    fn json(&self) -> String {
        let mut flat = figures(&self.first);
        flat["profiles"] = self.all.iter().map(figures).collect();
        flat.to_string()
    }
}

/// To a tenth, as far as columns go.
fn trimmed(number: &str) -> String {
    number
        .split_once('.')
        .map_or_else(|| number.to_owned(), |(whole, part)| format!("{whole}.{}", &part[..1]))
}

fn figures((name, profile): &Move) -> Value {
    let Peaks { speed, acceleration, deceleration, jerk, speed_jump } = profile.peaks();
    json!({
        "profile": name.name(),
        "duration_s": profile.duration_s(),
        "peak_rad_s": speed,
        "peak_rad_s2": acceleration.max(deceleration),
        "peak_rad_s3": jerk,
        "jump_rad_s": speed_jump,
    })
}

/// Longest move whose rows are written, s.
const LONGEST_S: f64 = 1800.0;

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let panel = |y_title: &str, value: &dyn Fn(&MovePoint) -> f64| {
            over_time(y_title, Vec::new(), self.chosen().map(|made| curve(made, value)).collect())
        };
        let key = |(name, profile): &Move| Key {
            colour: name.colour(),
            name: format!("{}, {:.4} s", name.name(), profile.duration_s()),
        };
        let limits = &self.of.limits;
        Ok(Figure {
            title: format!(
                "{:.4} rad at {} rad/s, {} and {} rad/s²",
                self.of.distance_rad, limits.speed, limits.acceleration, limits.deceleration
            ),
            legend: self.chosen().map(key).collect(),
            panels: vec![
                panel("angle, rad", &|p| p.position),
                panel("speed, rad/s", &|p| p.velocity),
                panel("acceleration, rad/s²", &|p| p.acceleration),
            ],
            columns: 1,
            panel: (680, 230),
            theme: Theme::Light,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let profile: &Profile = &self.first.1;
        if profile.duration_s() > LONGEST_S {
            let message = format!(
                "the move takes {:.0} s, and at most {LONGEST_S:.0} s of it are written row by row; give it a higher --vmax or --amax",
                profile.duration_s()
            );
            return Err(Failure::failed("too-long", message));
        }
        let mut text = String::from("t_s,x_rad,v_rad_s,a_rad_s2\n");
        let ticks = (profile.duration_s() / TICK_F64_S).ceil() as usize;
        for tick in 0..=ticks {
            let t_s = tick as f64 * TICK_F64_S;
            let MovePoint { position, velocity, acceleration } = profile.at(t_s);
            let _ = writeln!(text, "{t_s:.3},{position:.9},{velocity:.9},{acceleration:.9}");
        }
        Ok(text)
    }
}

/// Points of a plotted curve: every phase is smooth, so this many are enough.
const PLOTTED: u32 = 1000;

fn curve((name, profile): &Move, value: &dyn Fn(&MovePoint) -> f64) -> Curve {
    // just inside both ends, so that what jumps there is seen
    let inside = 1e-9 * profile.duration_s();
    let time = |i: u32| f64::from(i) / f64::from(PLOTTED) * (profile.duration_s() - 2.0 * inside) + inside;
    let points = (0..=PLOTTED).map(|i| (time(i), value(&profile.at(time(i)))));
    let ends = [0.0, profile.duration_s()].map(|t| (t, value(&profile.at(t))));
    let points = std::iter::once(ends[0]).chain(points).chain(std::iter::once(ends[1]));
    Curve { colour: name.colour(), pen: Pen::Solid, points: points.collect() }
}
