//! Fits the bend between two straight lines, with arcs if possible.

use kurbo::Point;
use tracelight_maths::{cos, powi};

use super::arc::SWEEPS;
use super::line::Line;
use super::options::FitOptions;
use super::plan::{Plan, Shut, is_moved};
use super::round::{Bow, Circle, FEWEST, bows, scatter};
use super::straight::{RMS, direction};
use super::tangent::{Part, Shape, join};
use crate::polyline_length;

/// A bend is looked at from where it has left the lines beside it by this share of the tolerance: noise leaves them
/// by half as much.
const LEFT: f64 = 0.5;
/// What is beside an arc, and its ends, may move it by so much off its points, root mean square, as a share of the
/// tolerance.
const PULL: f64 = 0.25;
/// Bends are tried anew so often, each time without those that turned out to be no arcs.
const TRIALS: usize = 4;

/// A row of points and the straight lines in it.
pub(super) struct Bends<'a> {
    pub(super) row: &'a [Point],
    pub(super) lines: &'a [Line],
    pub(super) shut: Shut,
    pub(super) options: &'a FitOptions,
}

impl Bends<'_> {
    /// The lines and the arcs between them, in order. Where arcs fill a bend, they and the lines beside it are linked; all
    /// other bends are left out.
    pub(super) fn parts(&self) -> Vec<Part> {
        let mut arcs: Vec<Vec<Bow>> = (0..self.count()).map(|i| self.bows(i)).collect();
        let mut loose = [false; 2];
        for _ in 0..TRIALS {
            if arcs.iter().all(Vec::is_empty) {
                break;
            }
            let plan = self.plan(&arcs, loose);
            let failed: Vec<usize> = match self.joined(&plan) {
                Err(part) => plan.beside(part).collect(),
                Ok(parts) => {
                    let bad = (0..parts.len()).filter(|&i| is_moved(&parts, i) && !self.holds(&parts, i));
                    let failed: Vec<usize> = bad.flat_map(|i| plan.beside(i)).collect();
                    if failed.is_empty() {
                        return plan.with(&parts);
                    }
                    failed
                }
            };
            if !self.loosen(&mut loose, &arcs, &failed) {
                for bend in failed {
                    arcs.get_mut(bend).into_iter().for_each(Vec::clear);
                }
            }
        }
        self.plan(&[], loose).parts
    }

    fn plan(&self, arcs: &[Vec<Bow>], loose: [bool; 2]) -> Plan {
        Plan::of(self.row, self.lines, self.shut, arcs, loose)
    }

    /// Lets those ends of the row go that are too far off their arcs; whether any was held until now.
    fn loosen(&self, loose: &mut [bool; 2], arcs: &[Vec<Bow>], failed: &[usize]) -> bool {
        let (row, last) = (self.row, arcs.len() - 1);
        let ends = [(0, arcs[0].first(), row[0]), (last, arcs[last].last(), row[row.len() - 1])];
        let before = *loose;
        for (loose, (bend, bow, end)) in loose.iter_mut().zip(ends) {
            let far =
                |c: Circle| (end.distance(c.centre) - c.radius.abs()).abs() > PULL * self.options.tolerance;
            let circle = bow.and_then(|bow| bow.circle);
            *loose |= self.shut != Shut::Ring && failed.contains(&bend) && circle.is_some_and(far);
        }
        before != *loose
    }

    /// Bend i lies before line i, and in an open row one more behind the last.
    fn count(&self) -> usize {
        self.lines.len() + usize::from(self.shut != Shut::Ring || self.lines.is_empty())
    }

    /// The arcs of bend `i`.
    fn bows(&self, i: usize) -> Vec<Bow> {
        let ((from, to), last) = (self.bend(i), self.row.len() - 1);
        let tip = |at_end: bool| match self.shut {
            Shut::Open(tip) if at_end => tip.min((to - from) / 4),
            _ => 0,
        };
        bows(self.row, from..=to, RMS * self.options.tolerance, [tip(from == 0), tip(to == last)])
    }

    /// First and last point of bend `i` that are clear of the lines beside it.
    fn bend(&self, i: usize) -> (usize, usize) {
        let clear = |line: &Line, k: usize| {
            let off = direction(line.from, line.to).cross(self.row[k] - line.from);
            off.abs() > LEFT * self.options.tolerance
        };
        let (before, after) = (i.checked_sub(1).map(|i| &self.lines[i]), self.lines.get(i));
        let from = before.map_or(0, |line| line.last);
        let to = after.map_or(self.row.len() - 1, |line| line.first);
        let before = before.or_else(|| self.lines.last().filter(|_| self.shut == Shut::Ring));
        let from = before.map_or(from, |line| (from..to).find(|&k| clear(line, k)).unwrap_or(to));
        let to = after.map_or(to, |line| (from..=to).rev().find(|&k| clear(line, k)).unwrap_or(from));
        (from, to)
    }

    fn joined(&self, plan: &Plan) -> Result<Vec<Part>, usize> {
        match plan.parts[..] {
            // from end to end there is nothing to choose
            [Part { shape: Shape::Line { .. }, .. }] => Ok(plan.parts.clone()),
            [Part { pins: [Some(_), Some(_)], .. }] => Err(0),
            _ => join(self.row, plan.parts.clone()),
        }
    }

    /// Whether a part is what its points show.
    fn holds(&self, parts: &[Part], number: usize) -> bool {
        let (part, tolerance) = (&parts[number], self.options.tolerance);
        let off = part.off(self.row);
        let most = off.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        // an end stays where it is, however far from its arc noise has put it
        let near = number.saturating_sub(1)..(number + 2).min(parts.len());
        let pinned = parts[near].iter().any(|p| p.pins != [None; 2]);
        match part.shape {
            Shape::Line { along, .. } => {
                let counting = part.counting(self.row);
                let square = counting.iter().map(|&p| p.distance_squared(part.shape.nearest(p))).sum::<f64>();
                let rms = if part.pins == [None; 2] { RMS } else { PULL };
                let even = square <= counting.len() as f64 * powi(rms * tolerance, 2);
                most <= tolerance && even && along.dot(part.to - part.from) > 0.0
            }
            Shape::Round(circle) => {
                let (sweep, radius) = (part.sweep().abs(), circle.radius.abs());
                let sagitta = radius * (1.0 - cos((0.5 * sweep).min(1.6)));
                most <= if pinned { 1.0 } else { 0.7 } * tolerance
                    && SWEEPS.contains(&sweep)
                    && sagitta >= tolerance
                    && part.last - part.first >= FEWEST - 1
                    && self.is_as_long(part)
                    && is_near(part.counting(self.row), &circle, self.options)
            }
        }
    }

    /// Whether an arc is as long as its points' polyline, which runs to and fro a little: else it goes the other way
    /// round.
    fn is_as_long(&self, part: &Part) -> bool {
        let points = &self.row[part.first..=part.last];
        let length = polyline_length(points);
        let step = length / (points.len() - 1).max(1) as f64;
        (part.length() - length).abs() <= 0.1 * length + 3.0 * step
    }
}

/// Whether points are off a circle by noise and little more.
pub(super) fn is_near(points: &[Point], circle: &Circle, options: &FitOptions) -> bool {
    let off = |p: &Point| powi(p.distance(circle.centre) - circle.radius.abs(), 2);
    let square = points.iter().map(off).sum::<f64>() / points.len() as f64;
    let noise = scatter(points, RMS * options.tolerance);
    noise.is_some_and(|noise| square <= noise + powi(PULL * options.tolerance, 2))
}
