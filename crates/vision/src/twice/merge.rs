//! Merges two passes into one line.

use tracelight_image::Plane;
use tracelight_stroke::{Point, Vec2, polyline_length};

use super::pencil::strength;
use super::place::ways;
use super::sketch::Run;
use crate::row::Row;

impl Run {
    /// Makes one row of both where they run beside each other, and rows of their own of what else there is of the other one.
    pub(super) fn merge(mut self, dark: &Plane<u8>, rows: &mut Vec<Row>, apart: f64) {
        let other = rows[self.other].clone();
        rows[self.other].points.clear();
        let mut kept = rows[self.kept].clone();
        if kept.closed {
            self.turn_seam_away(&mut kept.points);
        }
        let way = ways(&kept.points);
        let whole = way[way.len() - 1];
        if !self.stays {
            let over = self.share(dark, (&kept, &other));
            self.shift(&mut kept.points, &other.points, over, apart);
            kept.width = kept.width.max(other.width);
        }
        // where the other one leaves it
        let leaves = [self.beside[0], self.beside[self.beside.len() - 1]];
        let ties = leaves.map(|at| kept.points[at]);
        let own = |points: Vec<Point>, free: [bool; 2]| Row { points, closed: false, free, ..other.clone() };
        if other.closed {
            let mut points = [&other.points[self.to..], &other.points[..=self.from]].concat();
            let last = points.len() - 1;
            (points[0], points[last]) = (ties[1], ties[0]);
            if polyline_length(&points) >= apart {
                rows.push(own(points, [false; 2]));
            }
            rows[self.kept] = kept;
            return;
        }
        let before = other.points[..=self.from].iter().rev().copied().collect();
        let tails: [Vec<Point>; 2] = [before, other.points[self.to..].to_vec()];
        let (mut start, mut end) = (None, None);
        for (side, mut tail) in tails.into_iter().enumerate() {
            if polyline_length(&tail) < apart {
                continue;
            }
            tail[0] = ties[side];
            let (at, free) = (leaves[side], other.free[side]);
            // the one that stays ends there: it goes on as the other one does
            if !kept.closed && end.is_none() && whole - way[at] < apart {
                end = Some((at, tail, free));
            } else if !kept.closed && start.is_none() && way[at] < apart {
                start = Some((at, tail, free));
            } else {
                rows.push(own(tail, [false, free]));
            }
        }
        if let Some((at, tail, free)) = end {
            kept.points.truncate(at);
            kept.points.extend(tail);
            kept.free[1] = free;
        }
        if let Some((at, tail, free)) = start {
            kept.points.splice(..=at, tail.into_iter().rev());
            kept.free[0] = free;
        }
        rows[self.kept] = kept;
    }

    /// Lets a closed row begin as far as can be from where the other one runs beside it.
    fn turn_seam_away(&mut self, points: &mut [Point]) {
        let mut near = self.beside.clone();
        near.sort_unstable();
        near.dedup();
        let n = points.len();
        let next = near.iter().skip(1).copied().chain([near[0] + n]);
        let gaps = near.iter().zip(next).map(|(&at, next)| (next - at, at));
        let (gap, at) = gaps.max().unwrap_or((0, 0));
        let start = (at + gap / 2) % n;
        points.rotate_left(start);
        self.beside.iter_mut().for_each(|k| *k = (*k + n - start) % n);
    }

    /// How far over to the other row the line is: the darker one draws it nearer.
    fn share(&self, dark: &Plane<u8>, (kept, other): (&Row, &Row)) -> f64 {
        let other_sum: f64 = (self.from..=self.to).map(|k| strength(dark, other, k)).sum();
        let kept_sum: f64 = self.beside.iter().map(|&k| strength(dark, kept, k)).sum();
        other_sum / (kept_sum + other_sum).max(1.0)
    }

    /// Moves the points of the row that stays over to the other one by this share, and those before and behind by less and less.
    fn shift(&self, points: &mut [Point], other: &[Point], over: f64, apart: f64) {
        let mut shifts = vec![None; points.len()];
        for (k, &at) in self.beside.iter().enumerate() {
            shifts[at] = Some((other[self.from + k] - points[at]) * over);
        }
        let first = shifts.iter().position(Option::is_some).unwrap_or(0);
        let last = shifts.iter().rposition(Option::is_some).unwrap_or(0);
        let mut known = Vec2::ZERO;
        let steady: Vec<Vec2> = shifts
            .iter()
            .enumerate()
            .map(|(k, shift)| {
                known = shift.unwrap_or(known);
                if (first..=last).contains(&k) { known } else { Vec2::ZERO }
            })
            .collect();
        // the mean over as far as both are apart: neither jumps nor kinks
        let spacing = polyline_length(points) / points.len() as f64;
        let reach = ((apart / spacing.max(0.1)).round() as usize).max(1);
        for (k, point) in points.iter_mut().enumerate() {
            // an open row's ends go all the way
            let (from, to) = (k.saturating_sub(reach), (k + reach).min(steady.len() - 1));
            let near = &steady[from..=to];
            *point += near.iter().fold(Vec2::ZERO, |sum, v| sum + *v) / near.len() as f64;
        }
    }
}
