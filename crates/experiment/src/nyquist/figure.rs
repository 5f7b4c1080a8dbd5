//! Nyquist's plot.

use std::f64::consts::TAU;

use tracelight_chart::{Arrows, Colour, Curve, Figure, Label, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{Complex, InfiniteArc, NyquistCurve, NyquistPart, RealCrossing, decibels};
use tracelight_maths::{complex, cos, sin};

use super::view::half_turns;
use super::{Entry, Finding};
use crate::numbers::{four, two_digits};

/// Pixels of a panel, and what axes and their words take of it.
const SIZE: (i32, i32) = (760, 640);
const AROUND: (i32, i32) = (98, 56);

/// From this size on what is about −1 is a dot, and is looked at closely as well.
const FAR: f64 = 8.0;

/// A distance below this share of what is shown is too small for words.
const LEAST: f64 = 0.1;

/// How far beyond what is finite the curve is followed before it is joined by an arc.
const BEYOND: f64 = 1.3;

/// What of the plane a panel shows: its middle on the real axis, and how far it goes up and down from there.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    middle: f64,
    up: f64,
}

impl Window {
    fn view(self) -> [(f64, f64); 2] {
        let across = self.across();
        [(self.middle - across, self.middle + across), (-self.up, self.up)]
    }

    /// A unit is as long on both axes.
    fn across(self) -> f64 {
        self.up * f64::from(SIZE.0 - AROUND.0) / f64::from(SIZE.1 - AROUND.1)
    }

    fn holds(self, z: Complex) -> bool {
        (z.re - self.middle).abs() <= self.across() && z.im.abs() <= self.up
    }
}

impl Entry {
    /// Beyond what the curve only runs off to infinity.
    pub(super) fn level(&self) -> f64 {
        BEYOND * self.named.largest_finite_gain().max(1.15)
    }

    pub(super) fn curve(&self, level: f64) -> NyquistCurve {
        const TOLERANCE: f64 = 5e-4;
        self.named.nyquist_curve(level, TOLERANCE)
    }

    /// Where it crosses the negative real axis between the ends.
    pub(super) fn negative_crossings(&self) -> impl Iterator<Item = &RealCrossing> {
        let end = self.named.system.time().nyquist_rad_s();
        self.crossings.iter().filter(move |c| c.value < 0.0 && c.rad_s > 0.0 && c.rad_s < end)
    }

    fn at(&self, rad_s: f64) -> Complex {
        self.named.at(rad_s)
    }
}

impl Finding {
    pub(super) fn nyquist(&self) -> Figure {
        let largest = self.entries.iter().map(Entry::level).fold(0.0, f64::max);
        let level = self.reach.map_or(largest, |reach| largest.max(0.88 * reach));
        let curves: Vec<NyquistCurve> = self.entries.iter().map(|entry| self.asked(entry, level)).collect();
        let windows = self.windows(&curves, level);
        let mut panels: Vec<Panel> = windows.iter().map(|window| self.panel(&curves, *window)).collect();
        if let [_, near] = &mut panels[..] {
            near.x_title = "real part, near −1".into();
        }
        self.draw("Nyquist plot; faint: its mirror, for frequencies below 0", panels, SIZE)
    }

    /// The curve over the frequencies that were asked for.
    fn asked(&self, entry: &Entry, level: f64) -> NyquistCurve {
        let (from, to) = self.asked_rad_s;
        let mut curve = entry.curve(level);
        for part in &mut curve.parts {
            if let NyquistPart::Finite { rad_s, values } = part {
                let kept: Vec<usize> =
                    (0..rad_s.len()).filter(|&i| (from..=to).contains(&rad_s[i])).collect();
                *values = kept.iter().map(|&i| values[i]).collect();
                *rad_s = kept.iter().map(|&i| rad_s[i]).collect();
            }
        }
        curve.parts.retain(|part| match part {
            NyquistPart::Finite { rad_s, .. } => rad_s.len() > 1,
            NyquistPart::Arc(arc) => (from..=to).contains(&arc.rad_s),
        });
        curve
    }

    /// The whole, and the surroundings of −1 where the whole makes them a dot.
    fn windows(&self, curves: &[NyquistCurve], level: f64) -> Vec<Window> {
        const CLOSE: Window = Window { middle: -0.5, up: 2.2 };
        if let Some(reach) = self.reach {
            return vec![Window { middle: 0.0, up: reach }];
        }
        let has_arcs =
            curves.iter().any(|curve| curve.parts.iter().any(|part| matches!(part, NyquistPart::Arc(_))));
        let whole = if has_arcs { Window { middle: 0.0, up: 1.2 * level } } else { bounded(curves) };
        if whole.up > FAR { vec![whole, CLOSE] } else { vec![whole] }
    }

    fn panel(&self, curves: &[NyquistCurve], window: Window) -> Panel {
        let mut panel = Panel {
            x_title: "real part".into(),
            y_title: "imaginary part".into(),
            levels: vec![0.0],
            scale: Scale::Even,
            view: Some(window.view()),
            ..Panel::default()
        };
        panel.curves.push(Curve { colour: Colour::Grey, pen: Pen::FaintDashed, points: unit_circle() });
        for (entry, curve) in self.entries.iter().zip(curves) {
            draw_curve(entry.named.colour, curve, &mut panel);
        }
        // closed loops do not turn round it
        if self.entries.iter().any(|entry| !entry.is_closed()) {
            panel.marks.push(Mark { colour: Colour::Black, sign: Sign::Cross, at: (-1.0, 0.0) });
            panel.labels.push(Label::new((-1.0, 0.0), "−1"));
        }
        for entry in self.entries.iter().filter(|entry| !entry.is_closed()) {
            mark_margins(entry, window, &mut panel);
        }
        for (entry, curve) in self.entries.iter().zip(curves) {
            name_arcs(curve, window, &mut panel);
            name_frequencies(entry, curve, window, &mut panel);
        }
        panel
    }
}

/// All of curves that stay finite, −1 and 0.
fn bounded(curves: &[NyquistCurve]) -> Window {
    const AIR: f64 = 1.2;
    let mut points = vec![Complex::new(-1.4, 0.0), Complex::new(1.0, 1.0)];
    for part in curves.iter().flat_map(|curve| &curve.parts) {
        if let NyquistPart::Finite { values, .. } = part {
            points.extend(values);
        }
    }
    let low = points.iter().map(|z| z.re).fold(f64::INFINITY, f64::min);
    let high = points.iter().map(|z| z.re).fold(f64::NEG_INFINITY, f64::max);
    let up = points.iter().map(|z| z.im.abs()).fold(0.0, f64::max);
    let flat = Window { middle: 0.5 * (low + high), up: 1.0 };
    Window { up: AIR * up.max(0.5 * (high - low) / flat.across()), ..flat }
}

/// The curve with its mirror, arcs, and arrows in the direction of rising frequency.
fn draw_curve(colour: Colour, curve: &NyquistCurve, panel: &mut Panel) {
    const MIRROR: [bool; 2] = [true, false];
    let mut arcs = 0.0;
    for part in &curve.parts {
        match part {
            NyquistPart::Finite { values, .. } => {
                for mirrored in MIRROR {
                    let pen = if mirrored { Pen::Faint } else { Pen::Solid };
                    add(panel, (colour, pen, 3), directed(values, mirrored));
                }
            }
            NyquistPart::Arc(arc) => {
                // each bulges in its own way, where several lie above each other
                let points = arc.points(curve.level, bulge(arc, arcs));
                arcs += 1.0;
                let mirrors = if arc.is_own_mirror { &MIRROR[1..] } else { &MIRROR[..] };
                for &mirrored in mirrors {
                    let pen = if mirrored { Pen::FaintDashed } else { Pen::Dashed };
                    add(panel, (colour, pen, 1 + arc.order), directed(&points, mirrored));
                }
            }
        }
    }
}

fn bulge(arc: &InfiniteArc, number: f64) -> f64 {
    (0.03 * number + 0.03 * (arc.order as f64 - 1.0)).min(0.12)
}

fn add(panel: &mut Panel, (colour, pen, count): (Colour, Pen, usize), points: Vec<(f64, f64)>) {
    let is_faint = matches!(pen, Pen::Faint | Pen::FaintDashed);
    panel.arrows.push(Arrows { colour, points: points.clone(), count, is_faint });
    panel.curves.push(Curve { colour, pen, points });
}

/// Places in the direction of rising frequency: the mirror's are gone through backwards.
fn directed(values: &[Complex], mirrored: bool) -> Vec<(f64, f64)> {
    match mirrored {
        true => values.iter().rev().map(|z| (z.re, -z.im)).collect(),
        false => values.iter().map(|z| (z.re, z.im)).collect(),
    }
}

/// The margins, and where the negative real axis is crossed.
fn mark_margins(entry: &Entry, window: Window, panel: &mut Panel) {
    const MOST: usize = 6;
    let colour = entry.named.colour;
    let mut dot = |at: Complex, words: String| {
        panel.marks.push(Mark { colour, sign: Sign::Dot, at: (at.re, at.im) });
        // about −1 there is no room for words where it is a dot
        if window.up <= FAR || complex::norm(at + 1.0) > LEAST * window.up {
            panel.labels.push(Label::new((at.re, at.im), words));
        }
    };
    let least = entry.margins.least_gain();
    if let Some(margin) = least {
        let value = -1.0 / margin.factor;
        let words = format!(
            "{} at {} rad/s: gain margin {} dB",
            four(value),
            four(margin.rad_s),
            four(decibels(margin.factor))
        );
        dot(value.into(), words);
    }
    if let Some(margin) = entry.margins.least_phase() {
        let words = format!("phase margin {}° at {} rad/s", four(margin.degrees()), four(margin.rad_s));
        dot(entry.at(margin.rad_s), words);
    }
    let is_other =
        |c: &&RealCrossing| least.is_none_or(|margin| (c.value * margin.factor + 1.0).abs() > 1e-6);
    for crossing in entry.negative_crossings().filter(is_other).take(MOST) {
        dot(crossing.value.into(), format!("{} at {} rad/s", four(crossing.value), four(crossing.rad_s)));
    }
    let modulus = entry.margins.modulus.filter(|_| window.up <= FAR);
    if let Some(margin) = modulus.filter(|m| m.rad_s.is_finite() && m.rad_s > 0.0) {
        let near = entry.at(margin.rad_s);
        let points = vec![(-1.0, 0.0), (near.re, near.im)];
        panel.curves.push(Curve { colour, pen: Pen::Dashed, points });
        panel.labels.push(Label::new(
            (0.5 * (near.re - 1.0), 0.5 * near.im),
            format!("modulus margin {}", four(margin.distance)),
        ));
    }
}

/// What each arc stands for, in its middle.
fn name_arcs(curve: &NyquistCurve, window: Window, panel: &mut Panel) {
    let arcs = curve.parts.iter().filter_map(|part| match part {
        NyquistPart::Arc(arc) => Some(arc),
        NyquistPart::Finite { .. } => None,
    });
    for (number, arc) in (0..).zip(arcs) {
        let points = arc.points(curve.level, bulge(arc, f64::from(number)));
        // beside the real axis, where other words are
        let seen: Vec<&Complex> = points.iter().filter(|z| window.holds(**z)).collect();
        let Some(at) = seen.get(seen.len() * 2 / 5) else { continue };
        let frequency = if arc.rad_s.is_finite() { four(arc.rad_s) } else { "∞".to_owned() };
        panel.labels.push(Label::new(
            (at.re, at.im),
            format!("at infinity, ω = {frequency}: {} clockwise", half_turns(arc.order)),
        ));
    }
}

/// Some frequencies, evenly along what of the curve is shown, at round numbers.
fn name_frequencies(entry: &Entry, curve: &NyquistCurve, window: Window, panel: &mut Panel) {
    const COUNT: usize = 5;
    let mut shown: Vec<(f64, Complex)> = Vec::new();
    for part in &curve.parts {
        if let NyquistPart::Finite { rad_s, values } = part {
            let both = rad_s.iter().copied().zip(values.iter().copied());
            shown.extend(both.filter(|(w, z)| {
                *w > 0.0 && w.is_finite() && window.holds(*z) && complex::norm(*z) < 0.95 * curve.level
            }));
        }
    }
    let gone: Vec<f64> = shown
        .windows(2)
        .scan(0.0, |sum, pair| {
            *sum += complex::norm(pair[1].1 - pair[0].1);
            Some(*sum)
        })
        .collect();
    let whole = gone.last().copied().unwrap_or(0.0);
    if whole < LEAST * window.up {
        // about one place for all frequencies
        if let Some((_, z)) = shown.first().filter(|(_, z)| complex::norm(*z) > LEAST * window.up) {
            panel.marks.push(Mark { colour: entry.named.colour, sign: Sign::Point, at: (z.re, z.im) });
            panel.labels.push(Label::new((z.re, z.im), "all frequencies"));
        }
        return;
    }
    // the origin is crowded enough
    let least = LEAST * window.up;
    let mut named: Vec<f64> = Vec::new();
    for number in 0..COUNT {
        let along = whole * (number as f64 + 0.3) / COUNT as f64;
        let place = gone.partition_point(|so_far| *so_far < along);
        let Some((rad_s, _)) = shown.get(place) else { continue };
        let rad_s = two_digits(*rad_s);
        let at = entry.at(rad_s);
        if named.contains(&rad_s) || !window.holds(at) || complex::norm(at) < least {
            continue;
        }
        named.push(rad_s);
        panel.marks.push(Mark { colour: entry.named.colour, sign: Sign::Point, at: (at.re, at.im) });
        panel.labels.push(Label::new((at.re, at.im), format!("{} rad/s", four(rad_s))));
    }
}

fn unit_circle() -> Vec<(f64, f64)> {
    let at = |k: i32| TAU * f64::from(k) / 180.0;
    (0..=180).map(|k| (cos(at(k)), sin(at(k)))).collect()
}

#[cfg(test)]
mod tests {
    use tracelight_linear::{Time, TransferFunction};

    use super::*;
    use crate::named::Named;
    use crate::nyquist::Chart;

    fn window(text: &str, reach: Option<f64>) -> Window {
        let system = TransferFunction::parse(text, Time::Continuous).unwrap();
        let named = Named::rational(text.into(), system, Colour::Violet);
        let entry = Entry::of(named, &[1.0]);
        let finding = Finding {
            theme: tracelight_chart::Theme::Light,
            chart: Chart::Nyquist,
            reach,
            asked_rad_s: (0.0, f64::INFINITY),
            entries: vec![entry],
        };
        let level = finding.entries[0].level();
        let curves = [finding.asked(&finding.entries[0], level)];
        finding.windows(&curves, level)[0]
    }

    #[test]
    fn a_window_holds_minus_one_and_every_crossing_of_the_real_axis() {
        for text in [
            "3(s+6)^2/(s(s+1)^2)",
            "1/(s^4+s^3)",
            "10/(s+1)^3",
            "0.01/(s+1)",
            "100/(s(s+1)(s+2))",
            "500/((s+1)(s+2)(s+3))",
        ] {
            let shown = window(text, None);
            let system = TransferFunction::parse(text, Time::Continuous).unwrap();
            assert!(shown.holds((-1.0).into()) && shown.holds(Complex::ZERO), "{text}: {shown:?}");
            for crossing in system.real_crossings() {
                assert!(shown.holds(crossing.value.into()), "{text}: {crossing:?} {shown:?}");
            }
        }
        assert_eq!(window("1/s", Some(7.0)), Window { middle: 0.0, up: 7.0 });
    }
}
