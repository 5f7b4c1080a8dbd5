//! Corners: places where the direction breaks within the line's own width.
//!
//! The direction on either side is taken from a parabola through a flank that keeps clear of the place itself, so
//! that a tight bend (its flanks bend alike) is told from a corner (its flanks do not).

use kurbo::Point;
use tracelight_maths::{cos, powi, tan};

use super::flank::Flanks;
use super::options::FitOptions;
use super::samples::Samples;
use super::window::{Parabola, turn};

/// A break of direction, with what was found out about it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Nearest sample.
    pub(super) index: usize,
    /// Samples either side that show the pen and not the line.
    pub(super) zone: usize,
    /// Where the two sides meet.
    pub(super) point: Point,
}

/// How the neighbourhood of a place is looked at, in samples.
struct Scale {
    reach: f64,
    gap: usize,
    flank: usize,
    /// How far samples may be from a parabola that stands for them, root mean square.
    rms: f64,
}

impl Scale {
    fn of(samples: &Samples, options: &FitOptions) -> Self {
        let reach = options.reach / samples.step;
        // 24 tolerances of flank: noise of a third of the tolerance turns a parabola through them by some 5°
        let flank = (24.0 * options.tolerance / samples.step).max(3.0 * reach).round() as usize;
        Self { reach, gap: zone(reach, 1.0), flank: flank.max(6), rms: 0.25 * options.tolerance }
    }
}

/// How far from a corner that turns by `turn_rad` a pen of half-width `reach` hides it: its inner edges meet at
/// `reach · tan(turn/2)` along either side. Past 152° the ink of both sides is one.
fn zone(reach: f64, turn_rad: f64) -> usize {
    (reach * (1.15 * tan(0.5 * turn_rad.abs()).min(4.0) + 0.3)).ceil() as usize + 1
}

impl FitOptions {
    /// How far the points pass inside a corner at most. The middle of a pen's line cuts a corner that turns by φ
    /// as an arc of half the pen's half-width would, whose sagitta is r/2 · (1/cos(φ/2) − 1), the pixels of a shape's
    /// edge up to a pixel more; a bend of three times that radius is no corner.
    fn cut(&self, turn_rad: f64) -> f64 {
        let sagitta = 1.0 / cos(0.5 * turn_rad).max(0.25) - 1.0;
        1.4 * self.reach * sagitta + 0.6 * self.tolerance
    }
}

/// All corners in order.
pub(super) fn find(samples: &Samples, options: &FitOptions) -> Vec<Corner> {
    let scale = Scale::of(samples, options);
    let flanks = Flanks::new(scale.gap, scale.flank);
    let breaks: Vec<f64> =
        (0..samples.len()).map(|i| break_at(samples, i, &scale, &flanks, options.corner_rad)).collect();
    let smooth = Samples::smoothed_ring(&breaks, scale.gap, samples.closed);
    let mut found: Vec<Corner> = Vec::new();
    let (mut is_corner, mut in_zone) = (vec![false; samples.len()], vec![false; samples.len()]);
    for peak in peaks(samples, &breaks, &smooth, options.corner_rad, scale.gap + scale.flank / 2) {
        let Some(corner) = measured(samples, peak, &scale, options) else { continue };
        let zone = || samples.around(corner.index, corner.zone);
        if in_zone[corner.index] || zone().any(|i| is_corner[i]) {
            continue;
        }
        is_corner[corner.index] = true;
        zone().for_each(|i| in_zone[i] = true);
        found.push(corner);
    }
    found.sort_by_key(|c| c.index);
    found
}

/// Where chords that reach over gap and flank turn by less than this share of a corner, there is none. A corner turns
/// them all, wherever it lies between their middles; only an S of two bends at once could hide one from them.
const CHORDS: f64 = 0.6;

/// Turn between the flanks of sample `i`, both carried on to it, rad; 0 where it cannot be a corner.
fn break_at(samples: &Samples, i: usize, scale: &Scale, flanks: &Flanks, corner_rad: f64) -> f64 {
    let &Scale { gap, flank, .. } = scale;
    if samples.goes_on(i, gap + flank / 2, CHORDS * corner_rad) {
        return 0.0;
    }
    match (flanks.tangent(samples, i, -1), flanks.tangent(samples, i, 1)) {
        (Some(before), Some(after)) => turn(before, after),
        _ => 0.0,
    }
}

impl Samples {
    /// The samples up to `reach` from sample `i`, itself included.
    fn around(&self, i: usize, reach: usize) -> impl Iterator<Item = usize> {
        let (n, closed) = (self.len() as isize, self.closed);
        let reach = reach.min(self.len()) as isize;
        let all = (i as isize - reach..=i as isize + reach).filter(move |k| closed || (0..n).contains(k));
        all.map(move |k| k.rem_euclid(n) as usize)
    }

    /// Whether the chords from `reach` samples before sample `i` to it and on to `reach` samples behind it turn by less
    /// than `most`, rad, up to a right angle; near an open end that is not known.
    fn goes_on(&self, i: usize, reach: usize, most: f64) -> bool {
        let Some((before, after)) = self.before(i, reach).zip(self.after(i, reach)) else { return false };
        let (chord, next) = (self.points[i] - before, after - self.points[i]);
        let dot = chord.dot(next);
        dot > 0.0 && dot * dot > powi(cos(most), 2) * chord.hypot2() * next.hypot2()
    }

    /// Mean of the values up to `reach` neighbours away; 0 where the value is.
    fn smoothed_ring(values: &[f64], reach: usize, closed: bool) -> Vec<f64> {
        let (n, reach) = (values.len() as isize, reach as isize);
        let at = |i: isize| if closed { i.rem_euclid(n) } else { i.clamp(0, n - 1) } as usize;
        let mean = |i: usize| (i as isize - reach..=i as isize + reach).map(|k| values[at(k)]).sum::<f64>();
        // only where there is a break its mean is asked for
        let smooth = |i: usize| if values[i] == 0.0 { 0.0 } else { mean(i) / (2 * reach + 1) as f64 };
        (0..values.len()).map(smooth).collect()
    }
}

/// Samples where the break is over `least` and its mean is the largest for `apart` samples either way.
fn peaks(samples: &Samples, breaks: &[f64], smooth: &[f64], least: f64, apart: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..breaks.len()).filter(|&i| breaks[i].abs() >= least).collect();
    order.sort_by(|&a, &b| smooth[b].abs().total_cmp(&smooth[a].abs()));
    let (mut taken, mut free) = (Vec::new(), vec![true; samples.len()]);
    for i in order {
        if free[i] {
            taken.push(i);
            samples.around(i, apart).for_each(|near| free[near] = false);
        }
    }
    taken
}

/// Looks again with flanks that keep clear of the zone this very turn hides, and puts the corner where they meet.
fn measured(samples: &Samples, peak: usize, scale: &Scale, options: &FitOptions) -> Option<Corner> {
    let (mut index, mut gap) = (peak, scale.gap);
    let mut point = samples.points[peak];
    for _ in 0..3 {
        let side = |side| {
            let lengths = [2, 3, 4, 6, 8, 12, 16, 24].map(|quarters| (quarters * scale.flank / 4).max(6));
            samples.widest_flank(index, side, gap, &lengths, scale.rms)
        };
        let (before, after) = (side(-1)?, side(1)?);
        let turned = turn(before.tangent(0.0), after.tangent(0.0));
        if turned.abs() < options.corner_rad {
            return None;
        }
        let hidden = gap as f64 * samples.step;
        let reachable = 2.5 * hidden + 2.0 * samples.step;
        let here = samples.points[index];
        point = meeting(&before, &after, hidden).filter(|p| p.distance(here) < reachable).unwrap_or(here);
        index = nearest(samples, index, gap, point);
        gap = zone(scale.reach, turned);
        if point.distance(samples.points[index]) > options.cut(turned) {
            return None;
        }
    }
    Some(Corner { index, zone: gap, point })
}

/// Where two flanks meet when they are carried on: tangents are intersected, and taken again at the meeting point.
fn meeting(before: &Parabola, after: &Parabola, hidden: f64) -> Option<Point> {
    let (mut s, mut t) = (-hidden, hidden);
    let mut point = None;
    for _ in 0..4 {
        let (a, u) = (before.point(s), before.tangent(s));
        let (b, v) = (after.point(t), after.tangent(t));
        let cross = u.cross(v);
        if cross.abs() < 0.05 {
            return None; // back on its own line: it meets itself everywhere
        }
        let along = (b - a).cross(v) / cross;
        let met = a + u * along;
        point = Some(met);
        s = (s + along).clamp(-3.0 * hidden, 3.0 * hidden);
        t = (t + (met - b).dot(v)).clamp(-3.0 * hidden, 3.0 * hidden);
    }
    point
}

/// The sample nearest to `point` within `reach` samples of `index`.
fn nearest(samples: &Samples, index: usize, reach: usize, point: Point) -> usize {
    let reach = reach as isize;
    let candidates = (-reach..=reach).filter_map(|k| Some((k, samples.get(index as isize + k)?)));
    let best = candidates.min_by(|a, b| a.1.distance(point).total_cmp(&b.1.distance(point)));
    let offset = best.map_or(0, |(k, _)| k);
    (index as isize + offset).rem_euclid(samples.len() as isize) as usize
}
