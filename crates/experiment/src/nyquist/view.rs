//! Nyquist's plot and Nichols's chart, as they are shown.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Guide, Key, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::decibels;
use tracelight_maths::{complex, cos, powf, sin};
use tracelight_task::Failure;

use super::{Chart, Entry, Finding};
use crate::finding::{self, Plotted};
use crate::margins::{margin_lines, margins_json, summary};
use crate::systems::system_json;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "{} = {}\n{}",
                entry.named.name,
                entry.named.system,
                margin_lines(&entry.named.system, &entry.margins)
            );
            let open = entry.open_unstable;
            let _ = match entry.closed_unstable {
                Some(closed) => writeln!(
                    text,
                    "    growing poles: {open} open, {closed} closed: it turns {} times {}clockwise round −1\n",
                    closed.abs_diff(open),
                    if closed < open { "counter" } else { "" }
                ),
                None => writeln!(text, "    growing poles: {open} open; closed it is not defined\n"),
            };
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| {
            let mut object = system_json(&entry.named.name, &entry.named.system);
            object["margins"] = margins_json(&entry.named.system, &entry.margins);
            object["open_unstable"] = entry.open_unstable.into();
            object["closed_unstable"] = entry.closed_unstable.into();
            object["values"] = entry.values.iter().map(|z| json!([z.re, z.im])).collect();
            object
        };
        let rad_s = self.entries.first().map(|entry| &entry.rad_s);
        json!({"rad_s": rad_s, "systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(match self.chart {
            Chart::Nyquist => self.nyquist(),
            Chart::Nichols => self.nichols(),
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("rad_s");
        for number in 1..=self.entries.len() {
            let _ = write!(text, ",re_{number},im_{number}");
        }
        let rad_s = self.entries.first().map(|entry| entry.rad_s.as_slice()).unwrap_or_default();
        for (row, w) in rad_s.iter().enumerate() {
            let _ = write!(text, "\n{w:.9e}");
            for entry in &self.entries {
                let _ = write!(text, ",{:.9e},{:.9e}", entry.values[row].re, entry.values[row].im);
            }
        }
        Ok(text + "\n")
    }
}

impl Finding {
    fn nyquist(&self) -> Figure {
        const SIZE: (i32, i32) = (760, 640);
        let mut curves = Vec::new();
        let mut marks = vec![Mark { colour: Colour::Black, sign: Sign::Cross, at: (-1.0, 0.0) }];
        for entry in &self.entries {
            let colour = entry.named.colour;
            let half = |pen: Pen, sign: f64| Curve {
                colour,
                pen,
                points: entry.values.iter().map(|z| (z.re, sign * z.im)).collect(),
            };
            curves.extend([half(Pen::Solid, 1.0), half(Pen::Dashed, -1.0)]);
            let at = |rad_s: f64| entry.named.system.at(entry.named.system.time().at_frequency(rad_s));
            let crossings = entry.margins.least_phase().map(|m| m.rad_s).into_iter();
            let crossings = crossings.chain(entry.margins.least_gain().map(|m| m.rad_s));
            marks.extend(crossings.map(at).map(|z| Mark { colour, sign: Sign::Dot, at: (z.re, z.im) }));
        }
        let reach = reach(&self.entries);
        // a unit is as long on both axes
        let across = reach * f64::from(SIZE.0 - 90) / f64::from(SIZE.1 - 54);
        let panel = Panel {
            x_title: "real part".into(),
            y_title: "imaginary part".into(),
            curves,
            levels: vec![0.0],
            scale: Scale::Even,
            guides: vec![Guide { points: circle((0.0, 0.0), 1.0), label: String::new() }],
            marks,
            view: Some([(-0.5 - across, -0.5 + across), (-reach, reach)]),
            ..Panel::default()
        };
        self.draw("Nyquist plot: solid from low frequencies up, dashed its mirror", panel, SIZE)
    }

    fn nichols(&self) -> Figure {
        let curve = |entry: &Entry| Curve {
            colour: entry.named.colour,
            pen: Pen::Solid,
            points: entry
                .phases_deg
                .iter()
                .copied()
                .zip(entry.values.iter().map(|z| decibels(complex::norm(*z))))
                .collect(),
        };
        let phases = || self.entries.iter().flat_map(|entry| entry.phases_deg.iter().copied());
        // whole half turns, −180° at least among them
        let low = (phases().fold(-200.0, f64::min) / 90.0).floor() * 90.0;
        let high = (phases().fold(-90.0, f64::max) / 90.0).ceil() * 90.0;
        let mut marks = vec![Mark { colour: Colour::Black, sign: Sign::Cross, at: (-180.0, 0.0) }];
        for entry in &self.entries {
            let crossings = entry.margins.least_phase().map(|m| m.rad_s).into_iter();
            let crossings = crossings.chain(entry.margins.least_gain().map(|m| m.rad_s).filter(|w| *w > 0.0));
            let system = &entry.named.system;
            let at = |w: f64| {
                (
                    system.phase(w).to_degrees(),
                    decibels(complex::norm(system.at(system.time().at_frequency(w)))),
                )
            };
            marks.extend(crossings.map(|w| Mark { colour: entry.named.colour, sign: Sign::Dot, at: at(w) }));
        }
        let panel = Panel {
            x_title: "phase of the open loop, °".into(),
            y_title: "amplification of the open loop, dB".into(),
            curves: self.entries.iter().map(curve).collect(),
            levels: vec![0.0],
            guides: closed_lines((low, high)),
            marks,
            view: Some([(low, high), (-40.0, 40.0)]),
            y_step: Some(10.0),
            ..Panel::default()
        };
        self.draw("Nichols chart: faint, what the closed loop amplifies", panel, (820, 600))
    }

    fn draw(&self, title: &str, panel: Panel, size: (i32, i32)) -> Figure {
        let key = |e: &Entry| Key { colour: e.named.colour, name: summary(&e.named.name, &e.margins) };
        Figure {
            title: title.into(),
            legend: self.entries.iter().map(key).collect(),
            panels: vec![panel],
            columns: 1,
            panel: size,
            theme: self.theme,
        }
    }
}

fn circle(centre: (f64, f64), radius: f64) -> Vec<(f64, f64)> {
    let at = |k: i32| TAU * f64::from(k) / 180.0;
    (0..=180).map(|k| (centre.0 + radius * cos(at(k)), centre.1 + radius * sin(at(k)))).collect()
}

/// How far about −1 is shown: all of what stays near, of what goes far away only the near part.
fn reach(entries: &[Entry]) -> f64 {
    const LEAST: f64 = 1.5;
    const MOST: f64 = 2.2;
    let far =
        entries.iter().flat_map(|entry| &entry.values).map(|z| complex::norm(*z)).filter(|r| r.is_finite());
    (1.1 * far.fold(0.0, f64::max)).clamp(LEAST, MOST)
}

/// Where the closed loop amplifies by so many dB, once a turn (Hall's circles in other coordinates).
fn closed_lines((low, high): (f64, f64)) -> Vec<Guide> {
    const LEVELS: [f64; 9] = [-20.0, -12.0, -6.0, -3.0, -1.0, 0.5, 3.0, 6.0, 12.0];
    let mut guides = Vec::new();
    let turns = (low / 360.0).floor() as i32..=(high / 360.0).ceil() as i32;
    for turn in turns {
        for level in LEVELS {
            let m = powf(10.0, level / 20.0);
            // L = T / (1 − T) for T on a circle of that radius
            let at = |k: i32| {
                let t = complex::from_polar(m, TAU * (f64::from(k) + 0.5) / 720.0);
                let open = t / (1.0 - t);
                let phase = complex::arg(open).to_degrees();
                let phase = if phase > 0.0 { phase - 360.0 } else { phase };
                (phase + 360.0 * f64::from(turn), decibels(complex::norm(open)))
            };
            let mut points: Vec<(f64, f64)> = Vec::new();
            for k in 0..720 {
                let point = at(k);
                // the phase begins again where a turn is over
                if points.last().is_some_and(|last| (last.0 - point.0).abs() > 180.0) {
                    points.push((f64::NAN, f64::NAN));
                }
                points.push(point);
            }
            guides.push(Guide { points, label: format!("{level} dB").replace('-', "−") });
        }
    }
    guides
}
