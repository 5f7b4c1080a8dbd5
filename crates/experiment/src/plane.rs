//! The complex plane: how much of it is shown, and the grids in it.

use std::f64::consts::PI;

use tracelight_chart::{Figure, Guide, Key, Mark, Panel, Scale, Sign, Theme};
use tracelight_linear::{Complex, Time, TransferFunction};
use tracelight_maths as maths;

use crate::numbers::four;
use crate::systems::{Named, Systems};

/// Systems in the complex plane.
#[derive(Clone, Debug)]
pub struct Plane {
    /// The systems.
    pub systems: Systems,
    /// How far from zero is shown, 1/s (of samples: of z); if not given, all poles and zeros, and the unit circle.
    pub reach: Option<f64>,
}

const SIZE: (i32, i32) = (820, 640);

/// A figure of one plane.
pub(crate) fn draw(title: &str, legend: Vec<Key>, panel: Panel, theme: Theme) -> Figure {
    Figure { title: title.into(), legend, panels: vec![panel], columns: 1, panel: SIZE, theme }
}

/// Crosses and rings.
pub(crate) fn signs(named: &Named) -> Vec<Mark> {
    let mark = |sign: Sign| move |z: Complex| Mark { colour: named.colour, sign, at: (z.re, z.im) };
    let poles = named.system.poles().into_iter().map(mark(Sign::Cross));
    poles.chain(named.system.zeros().into_iter().map(mark(Sign::Ring))).collect()
}

/// The plane with a grid of damping and natural frequency, as large as poles and zeros ask for.
pub(crate) fn plane<'a>(
    systems: impl Iterator<Item = (&'a TransferFunction, &'a [Complex])>,
    reach: Option<f64>,
) -> Panel {
    let mut most = 0.0_f64;
    let mut time = Time::Continuous;
    for (system, closed) in systems {
        time = system.time();
        let all = system.poles().into_iter().chain(system.zeros()).chain(closed.iter().copied());
        most = most.max(all.map(maths::complex::norm).filter(|size| size.is_finite()).fold(0.0, f64::max));
    }
    let sampled = time != Time::Continuous;
    let all = match (sampled, most) {
        (true, most) => 1.2 * most.max(1.0),
        (false, 0.0) => 1.0,
        (false, most) => 1.25 * most,
    };
    let up = reach.unwrap_or(all);
    let across = up * f64::from(SIZE.0 - 90) / f64::from(SIZE.1 - 54);
    // what is stable has the larger part
    let (left, right) = if sampled { (-across, across) } else { (-1.6 * across, 0.4 * across) };
    let guides = if let Time::Sampled(period_s) = time { sampled_grid(period_s) } else { grid(up, left) };
    Panel {
        x_title: if sampled { "real part".into() } else { "real part, 1/s".into() },
        y_title: if sampled { "imaginary part".into() } else { "imaginary part, rad/s".into() },
        levels: vec![0.0],
        scale: Scale::Even,
        guides,
        view: Some([(left, right), (-up, up)]),
        ..Panel::default()
    }
}

/// Rays of even damping and half circles of even natural frequency.
fn grid(up: f64, left: f64) -> Vec<Guide> {
    const DAMPINGS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.85, 0.95];
    let far = 2.0 * up.max(-left);
    let ray = |(damping, sign): (f64, f64)| {
        let (cos, sin) = (damping, (1.0 - damping * damping).sqrt());
        Guide {
            points: vec![(0.0, 0.0), (-far * cos, sign * far * sin)],
            label: if sign > 0.0 { format!("{damping}") } else { String::new() },
        }
    };
    let rays = DAMPINGS.into_iter().flat_map(|d| [(d, 1.0), (d, -1.0)]).map(ray);
    let step = round_step(far / 8.0);
    let ring = |k: i32| {
        let radius = step * f64::from(k);
        let at = |i: i32| PI * (0.5 + f64::from(i) / 90.0);
        // its label stands below, those of the rays above
        let points = (0..=90).map(|i| (radius * maths::cos(at(i)), radius * maths::sin(at(i)))).collect();
        Guide { points, label: format!("{} rad/s", four(radius)) }
    };
    rays.chain((1..=8).map(ring)).collect()
}

/// 1, 2 or 5 times a power of ten, the nearest not below.
fn round_step(value: f64) -> f64 {
    let power = maths::powf(10.0, maths::log10(value).floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|f| f * power).find(|step| *step >= value * 0.999).unwrap_or(power)
}

/// The unit circle, and in it the lines of even damping.
fn sampled_grid(period_s: f64) -> Vec<Guide> {
    const DAMPINGS: [f64; 6] = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9];
    let line = |(damping, sign): (f64, f64)| {
        let root = (1.0 - damping * damping).sqrt();
        let at = |k: i32| {
            let turn = PI * f64::from(k) / 90.0;
            let z = maths::complex::from_polar(maths::exp(-damping / root * turn), sign * turn);
            (z.re, z.im)
        };
        let label = if sign > 0.0 && damping > 0.0 { format!("{damping}") } else { String::new() };
        // the label stands at the last point: the lines come from within
        Guide { points: (0..=90).rev().map(at).take(if damping > 0.0 { 80 } else { 91 }).collect(), label }
    };
    debug_assert!(period_s > 0.0, "a period is positive");
    DAMPINGS.into_iter().flat_map(|d| [(d, 1.0), (d, -1.0)]).map(line).collect()
}
