//! Finds straight runs in a point sequence.

use kurbo::{Point, Vec2};

use super::window::unit;

/// A run of points `first..=last` that lie on a straight line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) first: usize,
    pub(super) last: usize,
    at: Point,
    pub(super) direction: Vec2,
}

impl Run {
    /// The point of the run's line nearest to `p`.
    pub(super) fn project(&self, p: Point) -> Point {
        self.at + self.direction * (p - self.at).dot(self.direction)
    }
}

/// Root mean square distance of points from the line or the arc they make, at most, as a share of the tolerance.
pub(super) const RMS: f64 = 0.3;

/// Points given back to the bend at either end of a run.
const MARGIN: usize = 3;

/// Sums of powers of the coordinates, so that a line through any run costs the same.
pub(super) struct Straightness<'a> {
    points: &'a [Point],
    sums: Vec<[f64; 5]>,
    /// Root mean square distance from its line that a run may have.
    rms: f64,
    /// Shortest run, in length.
    least: f64,
}

impl<'a> Straightness<'a> {
    pub(super) fn new(points: &'a [Point], tolerance: f64, least: f64) -> Self {
        let origin = points.first().copied().unwrap_or_default();
        let mut sums = vec![[0.0; 5]];
        for &p in points {
            let (x, y) = (p - origin).into();
            let [sx, sy, sxx, sxy, syy] = sums[sums.len() - 1];
            sums.push([sx + x, sy + y, sxx + x * x, sxy + x * y, syy + y * y]);
        }
        Self { points, sums, rms: RMS * tolerance, least }
    }

    /// Mean of points `i..=j` and their second moments about it: xx, xy, yy.
    fn moments(&self, i: usize, j: usize) -> (Vec2, [f64; 3]) {
        let (n, to, from) = ((j - i + 1) as f64, &self.sums[j + 1], &self.sums[i]);
        let of = |k: usize| (to[k] - from[k]) / n;
        let (mx, my) = (of(0), of(1));
        (Vec2::new(mx, my), [of(2) - mx * mx, of(3) - mx * my, of(4) - my * my])
    }

    /// Line through points `i..=j` by total least squares and the root mean square distance from it.
    fn line(&self, i: usize, j: usize) -> (Run, f64) {
        let (mean, [a, b, c]) = self.moments(i, j);
        // of the two forms of the long axis the one that does not cancel
        let long = 0.5 * (a + c) + root(a, b, c);
        let along = unit(if a > c { Vec2::new(long - c, b) } else { Vec2::new(b, long - a) });
        let ahead = along.dot(self.points[j] - self.points[i]) >= 0.0;
        let direction = if ahead { along } else { -along };
        (Run { first: i, last: j, at: self.points[0] + mean, direction }, across(a, b, c).sqrt())
    }

    /// Straight runs that are not just flat places of a curve, in order, none overlapping: the longest first, then the
    /// longest of what it leaves on either side, and so on.
    pub(super) fn runs(&self) -> Vec<Run> {
        let ends = self.ends();
        let is_long = |(i, &end): (usize, &usize)| self.points[i].distance(self.points[end]) >= self.least;
        if !ends.iter().enumerate().any(is_long) {
            return Vec::new();
        }
        let reaches = Longest::of(ends);
        let mut found = Vec::new();
        let mut spans = vec![(0, self.points.len() - 1)];
        while let Some((from, to)) = spans.pop() {
            let (first, last) = reaches.within(from, to);
            let run = self.trimmed(self.line(first, last).0);
            if self.length(&run) < self.least {
                continue;
            }
            spans.extend([(from, run.first), (run.last, to)].into_iter().filter(|(a, b)| b > a));
            if !self.bends_on(&run) {
                found.push(run);
            }
        }
        found.sort_by_key(|r| r.first);
        found
    }

    /// For each point the last one up to which the row from it is straight; they never go back.
    fn ends(&self) -> Vec<usize> {
        let last = self.points.len().saturating_sub(1);
        let mut end = 0;
        let reached = |i: usize| {
            end = end.max(i);
            while end < last && self.straight(i, end + 1) {
                end += 1;
            }
            end
        };
        (0..self.points.len()).map(reached).collect()
    }

    fn length(&self, run: &Run) -> f64 {
        self.points[run.first].distance(self.points[run.last])
    }

    fn straight(&self, i: usize, j: usize) -> bool {
        let [a, b, c] = if j < i + 3 { return true } else { self.moments(i, j).1 };
        across(a, b, c) <= self.rms * self.rms
    }

    /// Without the ends that already leave the line of the middle.
    fn trimmed(&self, run: Run) -> Run {
        let tenth = (run.last - run.first) / 10;
        let (middle, rms) = self.line(run.first + tenth, run.last - tenth);
        let near = |i: &usize| {
            self.points[*i].distance(middle.project(self.points[*i])) <= 1.5 * rms.max(0.2 * self.rms)
        };
        let first = (run.first..run.last).find(near).unwrap_or(run.first);
        let last = (first + 1..=run.last).rev().find(near).unwrap_or(run.last);
        // a bend leaves its tangent so gently that its first steps still pass for straight
        let bends = |end: usize| if end == 0 || end + 1 == self.points.len() { 0 } else { MARGIN };
        let (first, last) = (first + bends(first), last.saturating_sub(bends(last)));
        if last > first { self.line(first, last).0 } else { run }
    }

    /// Whether a curve of one bend explains the run together with as much again beyond its ends: then the run is
    /// only the flattest place of that curve.
    fn bends_on(&self, run: &Run) -> bool {
        let (more, end) = (run.last - run.first, self.points.len() - 1);
        let behind = run.first.min(more - (more / 2).min(end - run.last));
        let ahead = (end - run.last).min(more - behind);
        if 6 * (behind + ahead) < more {
            return false;
        }
        let (first, last) = (run.first - behind, run.last + ahead);
        let across = Vec2::new(-run.direction.y, run.direction.x);
        let of = |p: &Point| ((*p - run.at).dot(run.direction), (*p - run.at).dot(across));
        let points: Vec<(f64, f64)> = self.points[first..=last].iter().map(of).collect();
        cubic_rms(&points) <= 1.5 * self.rms
    }
}

/// Of runs that start at each point, and end ever later, the longest in any span: by a tree of the best of two, the best
/// of those two and so on, so that a row of many short sides costs little more than a curve.
struct Longest {
    ends: Vec<usize>,
    /// Starts of the best runs: the points themselves from `ends.len()` on, before them the better of places 2k and 2k+1.
    best: Vec<usize>,
}

impl Longest {
    fn of(ends: Vec<usize>) -> Self {
        let n = ends.len();
        let mut best: Vec<usize> = (0..n).chain(0..n).collect();
        for k in (1..n).rev() {
            best[k] = better(&ends, best[2 * k], best[2 * k + 1]);
        }
        Self { ends, best }
    }

    /// First and last point of the longest run between two points, `from` before `to`.
    fn within(&self, from: usize, to: usize) -> (usize, usize) {
        // from here on a run is cut off by the span's end, and the first of them is the longest
        let cut = self.ends.partition_point(|&end| end < to).max(from);
        let (mut low, mut high) = (from + self.ends.len(), cut.min(to) + self.ends.len());
        let mut first = cut.min(to);
        let longer =
            |a: usize, b: usize| if self.ends[b].min(to) - b > self.ends[a].min(to) - a { b } else { a };
        while low < high {
            if low % 2 == 1 {
                first = longer(first, self.best[low]);
                low += 1;
            }
            if high % 2 == 1 {
                high -= 1;
                first = longer(first, self.best[high]);
            }
            (low, high) = (low / 2, high / 2);
        }
        (first, self.ends[first].min(to))
    }
}

/// Which of two starts has the longer run.
fn better(ends: &[usize], a: usize, b: usize) -> usize {
    if ends[b] - b > ends[a] - a { b } else { a }
}

/// Half the difference of the moments along and across.
fn root(a: f64, b: f64, c: f64) -> f64 {
    (0.25 * (a - c) * (a - c) + b * b).sqrt()
}

/// The second moment across the line of least squares.
fn across(a: f64, b: f64, c: f64) -> f64 {
    (0.5 * (a + c) - root(a, b, c)).max(0.0)
}

/// Root mean square residual of the cubic polynomial v(u) that fits best, by orthogonal polynomials (Forsythe,
/// "Generation and use of orthogonal polynomials for data-fitting with a digital computer", 1957).
fn cubic_rms(points: &[(f64, f64)]) -> f64 {
    let mut residual: Vec<f64> = points.iter().map(|p| p.1).collect();
    let (mut before, mut now) = (vec![0.0; points.len()], vec![1.0; points.len()]);
    let mut norm_before = 1.0;
    for degree in 0..4 {
        let norm: f64 = now.iter().map(|q| q * q).sum();
        if norm <= 1e-300 {
            break;
        }
        let share: f64 = now.iter().zip(&residual).map(|(q, r)| q * r).sum::<f64>() / norm;
        residual.iter_mut().zip(&now).for_each(|(r, q)| *r -= share * q);
        let centre = now.iter().zip(points).map(|(q, p)| p.0 * q * q).sum::<f64>() / norm;
        let back = if degree == 0 { 0.0 } else { norm / norm_before };
        let next = now.iter().zip(&before).zip(points).map(|((q, b), p)| (p.0 - centre) * q - back * b);
        (before, now) = (now.clone(), next.collect());
        norm_before = norm;
    }
    (residual.iter().map(|r| r * r).sum::<f64>() / points.len() as f64).sqrt()
}

/// Direction from one point to another.
pub(super) fn direction(from: Point, to: Point) -> Vec2 {
    unit(to - from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_run_of_any_span_is_found() {
        let mut ends = vec![0usize];
        for i in 1..97 {
            let rise = [0, 3, 0, 1, 7, 0, 0, 2][(i * 5 + i / 9) % 8];
            ends.push((ends[i - 1] + rise).clamp(i, 96));
        }
        let runs = Longest::of(ends.clone());
        for from in 0..96 {
            for to in from + 1..97 {
                let (first, last) = runs.within(from, to);
                let longest = (from..to).map(|i| ends[i].min(to) - i).max();
                assert_eq!(Some(last - first), longest, "{from} to {to}: {first} to {last}");
                assert!(from <= first && last <= to && last <= ends[first]);
            }
        }
    }
}
