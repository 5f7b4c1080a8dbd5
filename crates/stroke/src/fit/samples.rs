use kurbo::{Point, Vec2};

use super::window::Parabola;
use crate::polyline_length;

/// More samples than this are not taken, however long the polyline is.
const MOST: f64 = 200_000.0;

/// A point further out than this is none: fourth powers of lengths are summed, and must stay finite.
const FURTHEST: f64 = 1e60;

/// Whether a point can be reckoned with.
pub(super) fn is_near(p: &Point) -> bool {
    p.x.abs() <= FURTHEST && p.y.abs() <= FURTHEST
}

/// A polyline resampled at equal steps of arc length.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    pub(super) points: Vec<Point>,
    /// Arc length between neighbours.
    pub(super) step: f64,
    pub(super) closed: bool,
}

impl Samples {
    /// Steps of about `step`; `None` for fewer than two distinct points up to [`FURTHEST`].
    pub(super) fn of(points: &[Point], closed: bool, step: f64) -> Option<Self> {
        let mut line: Vec<Point> = points.iter().copied().filter(is_near).collect();
        line.dedup();
        if closed && line.len() > 2 && line.first() != line.last() {
            line.push(line[0]);
        }
        let length = polyline_length(&line);
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        let closed = closed && line.len() > 3;
        let count = (length / step.max(1e-300)).round().clamp(if closed { 3.0 } else { 1.0 }, MOST);
        let mut points = at_equal_steps(&line, length / count, count as usize);
        if !closed {
            points.extend(line.last());
        }
        Some(Self { points, step: length / count, closed })
    }

    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// Sample number `i`, round the seam where closed; `None` beyond an open end.
    pub(super) fn get(&self, i: isize) -> Option<Point> {
        let n = self.points.len() as isize;
        let i = if self.closed { i.rem_euclid(n) } else { i };
        usize::try_from(i).ok().and_then(|i| self.points.get(i)).copied()
    }

    /// The sample `reach` behind sample `i`; `None` beyond an open end.
    pub(super) fn before(&self, i: usize, reach: usize) -> Option<Point> {
        let round = || if self.closed { (i + self.len()).checked_sub(reach) } else { None };
        self.points.get(i.checked_sub(reach).or_else(round)?).copied()
    }

    /// The sample `reach` ahead of sample `i`; `None` beyond an open end.
    pub(super) fn after(&self, i: usize, reach: usize) -> Option<Point> {
        let round = || if self.closed { self.points.get(i + reach - self.len()) } else { None };
        self.points.get(i + reach).or_else(round).copied()
    }

    /// Samples from `gap` on, ahead of sample `i` (`side` 1) or behind it (−1), with arc lengths measured from `i`; on a
    /// closed line never more than once round, on an open one up to its end.
    pub(super) fn beside(&self, i: usize, side: isize, gap: usize) -> impl Iterator<Item = (f64, Point)> {
        let n = self.points.len();
        let left = match (self.closed, side > 0) {
            (true, _) => n,
            (false, true) => n - i,
            (false, false) => i + 1,
        };
        let of = move |k: usize| {
            let at = if side > 0 { i + k } else { i + n - k };
            (side as f64 * k as f64 * self.step, self.points[if at >= n { at - n } else { at }])
        };
        (gap..left).map(of)
    }

    /// What lies between `gap` and `gap + length` samples from sample `i`, ahead (`side` 1) or behind (−1), with
    /// arc lengths measured from `i`. Short ones end where an open line ends.
    pub(super) fn flank(&self, i: usize, side: isize, gap: usize, length: usize) -> Option<Parabola> {
        self.widest_flank(i, side, gap, &[length], f64::INFINITY)
    }

    /// The widest of flanks of these lengths that is a parabola up to `rms`.
    pub(super) fn widest_flank(
        &self,
        i: usize,
        side: isize,
        gap: usize,
        lengths: &[usize],
        rms: f64,
    ) -> Option<Parabola> {
        let flank = self.beside(i, side, gap);
        if flank.size_hint().0 < LEAST_FLANK {
            return None;
        }
        Parabola::widest(flank, lengths, rms)
    }

    /// Direction at sample `i` from its neighbours up to `reach` samples away.
    pub(super) fn tangent(&self, i: usize, reach: usize) -> Option<Vec2> {
        let reach = reach as isize;
        let of = |k: isize| Some((k as f64 * self.step, self.get(i as isize + k)?));
        Some(Parabola::through((-reach..=reach).filter_map(of))?.tangent(0.0))
    }
}

/// Fewer samples than this say nothing about a direction.
const LEAST_FLANK: usize = 4;

/// Points at multiples of `step` along a polyline, `count` of them from its start on.
fn at_equal_steps(line: &[Point], step: f64, count: usize) -> Vec<Point> {
    let mut points = Vec::with_capacity(count + 1);
    let mut passed = 0.0;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        while points.len() < count && points.len() as f64 * step < passed + length {
            let share = (points.len() as f64 * step - passed) / length;
            points.push(pair[0].lerp(pair[1], share.clamp(0.0, 1.0)));
        }
        passed += length;
    }
    points
}
