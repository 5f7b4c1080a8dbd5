//! The complex plane: how much of it is shown, and the grids in it.

use std::f64::consts::PI;

use tracelight_chart::{Figure, Guide, Key, Mark, Panel, Scale, Sign, Theme};
use tracelight_linear::{Complex, Time};
use tracelight_maths as maths;

use crate::named::Named;
use crate::numbers::four;
use crate::systems::Systems;

/// Systems in the complex plane.
#[derive(Clone, Debug)]
pub struct Plane {
    /// The systems.
    pub systems: Systems,
    /// How far from zero is shown, 1/s (of samples: of z); if not given, all poles and zeros (of a locus without those that are far
    /// from all others), and the unit circle.
    pub reach: Option<f64>,
}

/// Pixels of the figure, and what axes and their words take of it.
const SIZE: (i32, i32) = (820, 640);
const AROUND: (i32, i32) = (98, 56);

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

/// What of the plane is shown, and what lies outside.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Extent {
    time: Time,
    /// What has to be inside.
    points: Vec<Complex>,
    /// Poles and zeros so far away that the others would be one dot beside them.
    pub(crate) outside: Vec<Complex>,
}

impl Extent {
    /// All of some places.
    pub(crate) const fn all(time: Time, points: Vec<Complex>) -> Self {
        Self { time, points, outside: Vec::new() }
    }

    /// What matters of some places: those that must be inside, and of the others all but those that are far away from most.
    pub(crate) fn what_matters(time: Time, must: &[Complex], others: &[Complex]) -> Self {
        /// How many times further than the rest what is far away is.
        const FAR: f64 = 8.0;
        let size = |z: &Complex| maths::complex::norm(*z);
        let least = must.iter().map(size).fold(0.0, f64::max);
        let mut sizes: Vec<f64> = must.iter().chain(others).map(size).filter(|size| *size > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        let gap = (1..sizes.len())
            .rev()
            .find(|&i| 2 * i > sizes.len() && sizes[i - 1] >= least && sizes[i] > FAR * sizes[i - 1]);
        let limit = gap.map_or(f64::INFINITY, |i| sizes[i - 1]);
        let (inside, outside): (Vec<Complex>, Vec<Complex>) =
            must.iter().chain(others).partition(|z| size(z) <= limit);
        Self { time, points: inside, outside }
    }

    /// From and to on both axes: a unit is as long on both, and zero and the unit circle of samples are inside.
    fn view(&self) -> [(f64, f64); 2] {
        const AIR: f64 = 1.3;
        /// The least of the width that lies to the right of 0: branches leave to there.
        const RIGHT: f64 = 0.12;
        let sampled = self.time != Time::Continuous;
        let least = if sampled { 1.0 } else { 0.0 };
        let finite = || self.points.iter().filter(|z| z.is_finite());
        let low = finite().map(|z| z.re).fold(-least, f64::min);
        let high = finite().map(|z| z.re).fold(least, f64::max);
        let up = finite().map(|z| z.im.abs()).fold(least, f64::max);
        let aspect = f64::from(SIZE.0 - AROUND.0) / f64::from(SIZE.1 - AROUND.1);
        let wide = (AIR * (high - low)).max(AIR * 2.0 * up * aspect);
        let wide = if wide > 0.0 { wide } else { 2.0 };
        let middle = (0.5 * (low + high)).max((RIGHT - 0.5) * wide);
        [(middle - 0.5 * wide, middle + 0.5 * wide), (-0.5 * wide / aspect, 0.5 * wide / aspect)]
    }
}

/// The plane with a grid of damping and natural frequency, as far from zero as asked for, or as large as its places need.
pub(crate) fn plane(extent: &Extent, reach: Option<f64>) -> Panel {
    let sampled = extent.time != Time::Continuous;
    let [x, y] = reach.map_or_else(
        || extent.view(),
        |up| {
            let across = up * f64::from(SIZE.0 - AROUND.0) / f64::from(SIZE.1 - AROUND.1);
            // what is stable has the larger part
            let (left, right) = if sampled { (-across, across) } else { (-1.6 * across, 0.4 * across) };
            [(left, right), (-up, up)]
        },
    );
    let guides =
        if let Time::Sampled(period_s) = extent.time { sampled_grid(period_s) } else { grid(y.1, x.0) };
    Panel {
        x_title: if sampled { "real part".into() } else { "real part, 1/s".into() },
        y_title: if sampled { "imaginary part".into() } else { "imaginary part, rad/s".into() },
        levels: vec![0.0],
        scale: Scale::Even,
        guides,
        view: Some([x, y]),
        ..Panel::default()
    }
}

/// Rays of even damping and half circles of even natural frequency.
fn grid(up: f64, left: f64) -> Vec<Guide> {
    const DAMPINGS: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.85, 0.95];
    let far = 2.0 * up.max(-left).max(1e-12);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn real(places: &[f64]) -> Vec<Complex> {
        places.iter().map(|&re| re.into()).collect()
    }

    #[test]
    fn a_far_pole_is_left_outside_where_most_are_near() {
        let outside = |must: &[f64], others: &[f64]| {
            Extent::what_matters(Time::Continuous, &real(must), &real(others)).outside.len()
        };
        assert_eq!(outside(&[], &[0.0, -1.0, -2.0, -3.0, -10_000.0]), 1);
        // one near zero does not push out what is the rest
        assert_eq!(outside(&[], &[0.0, -0.1, -33.0, -98.0, -177.0, -250.0]), 0);
        assert_eq!(outside(&[-10_000.0], &[0.0, -1.0, -2.0, -3.0, -10_000.0]), 0);
        assert_eq!(outside(&[], &[]), 0);
    }

    #[test]
    fn a_view_holds_its_places_and_zero() {
        for places in [vec![], real(&[-3.0, -5.0]), real(&[4.0]), vec![Complex::new(-0.1, 30.0)]] {
            let [x, y] = Extent::all(Time::Continuous, places.clone()).view();
            for z in places.into_iter().chain([Complex::ZERO]) {
                assert!(x.0 < z.re && z.re < x.1 && y.0 < z.im && z.im < y.1, "{z} {x:?} {y:?}");
            }
        }
    }
}
