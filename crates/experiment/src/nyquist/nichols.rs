//! Nichols's chart.

use std::f64::consts::TAU;

use tracelight_chart::{Arrows, Colour, Curve, Figure, Guide, Key, Label, Mark, Panel, Pen, Sign};
use tracelight_linear::{Margins, decibels};
use tracelight_maths::{complex, powf};

use super::{Entry, Finding};
use crate::margins::summary;
use crate::numbers::{four, two_digits};

impl Finding {
    pub(super) fn nichols(&self) -> Figure {
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
        // of closed loops neither −1 nor what they would become once more closed is of interest
        let is_closed = self.entries.iter().all(Entry::is_closed);
        let what = if is_closed { "closed" } else { "open" };
        let critical = Mark { colour: Colour::Black, sign: Sign::Cross, at: (-180.0, 0.0) };
        let mut panel = Panel {
            x_title: format!("phase of the {what} loop, °"),
            y_title: format!("amplification of the {what} loop, dB"),
            curves: self.entries.iter().map(curve).collect(),
            levels: vec![0.0],
            guides: if is_closed { Vec::new() } else { closed_lines((low, high)) },
            marks: if is_closed { Vec::new() } else { vec![critical] },
            view: Some([(low, high), self.decibels()]),
            y_step: Some(10.0),
            ..Panel::default()
        };
        for entry in &self.entries {
            explain(entry, &mut panel);
        }
        let title = match is_closed {
            true => "Amplification over phase of closed loops",
            false => "Nichols chart: faint, what the closed loop amplifies",
        };
        self.draw(title, vec![panel], (820, 600))
    }

    /// What is shown upwards: usually from −40 to 40 dB, and every margin.
    fn decibels(&self) -> (f64, f64) {
        let open = self.entries.iter().filter(|entry| !entry.is_closed());
        let margins = open.filter_map(|entry| entry.margins.least_gain());
        let places = margins.map(|margin| -decibels(margin.factor));
        let (low, high) =
            places.fold((-40.0, 40.0), |(low, high): (f64, f64), db| (low.min(db), high.max(db)));
        // whole tens, with room for what is written
        let floor = |db: f64| ((db - 5.0) / 10.0).floor() * 10.0;
        (if low < -40.0 { floor(low) } else { low }, if high > 40.0 { -floor(-high) } else { high })
    }

    pub(super) fn draw(&self, title: &str, panels: Vec<Panel>, size: (i32, i32)) -> Figure {
        let key = |e: &Entry| Key {
            colour: e.named.colour,
            name: match e.is_closed() {
                true => e.named.name.clone(),
                false => summary(&e.named.name, &e.margins),
            },
        };
        Figure {
            title: title.into(),
            legend: self.entries.iter().map(key).collect(),
            panels,
            columns: 1,
            panel: size,
            theme: self.theme,
        }
    }
}

/// Margins, the direction of rising frequency, and some frequencies.
fn explain(entry: &Entry, panel: &mut Panel) {
    const COUNT: usize = 4;
    let named = &entry.named;
    let colour = entry.named.colour;
    let at = |w: f64| (named.phase(w).to_degrees(), decibels(complex::norm(named.at(w))));
    let mut mark = |sign: Sign, w: f64, words: String| {
        panel.marks.push(Mark { colour, sign, at: at(w) });
        panel.labels.push(Label::new(at(w), words));
    };
    let margins = (!entry.is_closed()).then_some(&entry.margins);
    if let Some(margin) =
        margins.and_then(Margins::least_gain).filter(|margin| margin.rad_s > 0.0 && margin.rad_s.is_finite())
    {
        let words =
            format!("gain margin {} dB at {} rad/s", four(decibels(margin.factor)), four(margin.rad_s));
        mark(Sign::Dot, margin.rad_s, words);
    }
    if let Some(margin) = margins.and_then(Margins::least_phase) {
        let words = format!("phase margin {}° at {} rad/s", four(margin.degrees()), four(margin.rad_s));
        mark(Sign::Dot, margin.rad_s, words);
    }
    let low = panel.view.map_or((-40.0, 40.0), |view| view[1]);
    let seen: Vec<f64> =
        entry.rad_s.iter().copied().filter(|w| (low.0..=low.1).contains(&at(*w).1)).collect();
    for number in 0..COUNT {
        if let Some(w) = seen.get(seen.len() * (2 * number + 1) / (2 * COUNT)).map(|w| two_digits(*w)) {
            mark(Sign::Point, w, format!("{} rad/s", four(w)));
        }
    }
    let points = entry.phases_deg.iter().zip(&entry.values);
    let points = points.map(|(phase, z)| (*phase, decibels(complex::norm(*z)))).collect();
    panel.arrows.push(Arrows { colour, points, count: 3, is_faint: false });
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
