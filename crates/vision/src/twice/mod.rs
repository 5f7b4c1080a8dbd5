//! A line that was sketched twice is one line.
//!
//! Who sketches with a pencil goes over a line again, a little beside it. Where two rows run side by side so near each other that the
//! slit between them is no paper, both are one line: its middle lies between them. Only in a sketch: with a pen two lines beside
//! each other, at a few degrees too, are two. A sketch shows by its lines, which are darker here and paler there, along their way and
//! one beside the other. Hatches, of which a third one is beside, stay.

use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::centreline::Row;
use crate::near::Near;
use crate::plane::Plane;
use crate::ridge::median;

/// Along a pencil's line the darkness varies by more than this share of its usual one, and from line to line by more than that:
/// measured from the 15th to the 85th percentile. Pens have 0.0 to 0.3 and 0.0 to 0.2, pencils in sketches 0.4 to 0.6 and 0.3 to 0.6.
const VARIES_ALONG: f64 = 0.3;
const VARIES_BETWEEN: f64 = 0.2;
/// Fewer points tell no variation, and fewer lines none between them.
const LEAST_POINTS: usize = 12;
const LEAST_ROWS: usize = 4;
/// The middles of two passes are no further apart than this, pens.
const APART_PENS: f64 = 1.9;
/// The slit between them is at least as dark as this share of the paler one.
const SLIT: f64 = 0.15;
/// They lead the same way within this angle, rad.
const ALIKE: f64 = 0.45;
/// They run beside each other for at least so many pens.
const LONG_PENS: f64 = 5.0;
/// And one begins or ends there, to so many times as far as both are apart.
const ENDS: f64 = 2.0;
/// Over more than this share of the way there is no third row beside them.
const THIRD: f64 = 0.3;
/// Places that are not beside the other row between two that are, px: a dark spot, a kink.
const SKIPPED_PX: f64 = 4.0;
/// So often what was made of two rows is looked at again.
const ROUNDS: usize = 4;

/// The rows of which those that were drawn twice are one.
pub(crate) fn once(dark: &Plane<u8>, mut rows: Vec<Row>) -> Vec<Row> {
    let pen = median(&rows.iter().filter(|row| !row.dot).map(|row| row.width).collect::<Vec<_>>());
    if pen <= 0.0 || !is_sketched(dark, &rows) {
        return rows;
    }
    for _ in 0..ROUNDS {
        let mut runs = runs(dark, &rows, APART_PENS * pen);
        if runs.is_empty() {
            break;
        }
        runs.sort_by(|a, b| b.length.total_cmp(&a.length));
        let mut is_taken = vec![false; rows.len()];
        for run in runs {
            if is_taken[run.kept] || is_taken[run.other] {
                continue;
            }
            (is_taken[run.kept], is_taken[run.other]) = (true, true);
            run.merge(&mut rows, APART_PENS * pen);
        }
        rows.retain(|row| row.points.len() > 1);
    }
    rows
}

/// Whether the lines are a pencil's, whose darkness varies along them and from one to the other.
fn is_sketched(dark: &Plane<u8>, rows: &[Row]) -> bool {
    let long = rows.iter().filter(|row| row.points.len() >= LEAST_POINTS);
    let of = |row: &Row| varies(row.points.iter().map(|&p| dark.at(p)).collect());
    let (along, levels): (Vec<f64>, Vec<f64>) = long.map(of).unzip();
    levels.len() >= LEAST_ROWS && median(&along) > VARIES_ALONG && varies(levels).0 > VARIES_BETWEEN
}

/// From the 15th to the 85th percentile of some levels, as a share of their median, and that.
fn varies(mut levels: Vec<f64>) -> (f64, f64) {
    levels.sort_unstable_by(f64::total_cmp);
    let at = |percent: usize| levels[(levels.len() - 1) * percent / 100];
    ((at(85) - at(15)) / at(50).max(1.0), at(50))
}

/// A place on a row.
#[derive(Clone, Copy, Debug)]
struct Place {
    row: usize,
    /// Its number on that row.
    number: usize,
    way: Vec2,
}

/// A stretch over which one row runs beside another.
#[derive(Clone, Debug)]
struct Run {
    /// The longer row, which stays.
    kept: usize,
    /// The other one, and from which to which of its points it runs beside the first.
    other: usize,
    from: usize,
    to: usize,
    /// For each of those points the one of the first row.
    beside: Vec<usize>,
    length: f64,
}

/// All stretches of rows that are a second pass of others.
fn runs(dark: &Plane<u8>, rows: &[Row], apart: f64) -> Vec<Run> {
    let lengths: Vec<f64> = rows.iter().map(|row| polyline_length(&row.points)).collect();
    let all =
        rows.iter().enumerate().filter(|(_, row)| !row.dot).flat_map(|(number, row)| places(number, row));
    let near = Near::of(all.map(|place| (rows[place.row].points[place.number], place)), apart);
    let longer = |a: usize, b: usize| (lengths[a], a) > (lengths[b], b);
    let mut found = Vec::new();
    for (other, row) in rows.iter().enumerate().filter(|(_, row)| !row.dot) {
        let own: Vec<Place> = places(other, row).collect();
        // what runs beside each of its places, and whether a third row does
        let beside = own.iter().map(|place| {
            let at = row.points[place.number];
            let mut others: Vec<(f64, Place)> = near
                .around(at)
                .filter(|(p, q)| q.row != other && is_beside((at, place.way), (*p, q.way)))
                .map(|(p, q)| (p.distance_squared(at), *q))
                .collect();
            others.sort_by(|a, b| a.0.total_cmp(&b.0));
            let first = others.first().map(|(_, q)| *q);
            let is_third = first.is_some_and(|f| others.iter().any(|(_, q)| q.row != f.row));
            (first, is_third)
        });
        let beside: Vec<(Option<Place>, bool)> = beside.collect();
        let mut candidates: Vec<usize> = beside.iter().filter_map(|(q, _)| q.map(|q| q.row)).collect();
        candidates.sort_unstable();
        candidates.dedup();
        for kept in candidates.into_iter().filter(|&kept| longer(kept, other)) {
            found.extend(run(dark, rows, (kept, other), &beside, apart));
        }
    }
    found
}

/// The ways from place to place of a row.
fn places(row: usize, r: &Row) -> impl Iterator<Item = Place> + '_ {
    let points = &r.points;
    (0..points.len()).map(move |number| {
        let (before, behind) = (number.saturating_sub(3), (number + 3).min(points.len() - 1));
        let way = points[behind] - points[before];
        Place { row, number, way: way / way.hypot().max(1e-9) }
    })
}

/// Whether two places lie beside each other on ways that are nearly parallel.
fn is_beside(a: (Point, Vec2), b: (Point, Vec2)) -> bool {
    let across = b.0 - a.0;
    a.1.cross(b.1).abs() < ALIKE.sin() && across.dot(a.1).abs() < 0.7 * across.hypot() + 0.5
}

/// The longest stretch of a row beside a longer one, if both are one line there.
fn run(
    dark: &Plane<u8>,
    rows: &[Row],
    (kept, other): (usize, usize),
    beside: &[(Option<Place>, bool)],
    apart: f64,
) -> Option<Run> {
    let points = &rows[other].points;
    let is_dark = |k: usize| {
        let place = beside[k].0.filter(|q| q.row == kept)?;
        let (a, b) = (points[k], rows[kept].points[place.number]);
        let slit = [0.35, 0.5, 0.65].map(|t| dark.at(a.lerp(b, t))).into_iter().fold(f64::MAX, f64::min);
        (slit >= SLIT * dark.at(a).min(dark.at(b))).then_some(place.number)
    };
    let seen: Vec<Option<usize>> = (0..points.len()).map(is_dark).collect();
    let way = ways(points);
    let (mut best, mut start, mut last) = ((0, 0, 0.0), None, 0);
    for k in (0..points.len()).filter(|&k| seen[k].is_some()) {
        let from = start.filter(|_| way[k] - way[last] <= SKIPPED_PX.max(apart)).unwrap_or(k);
        (start, last) = (Some(from), k);
        let long = way[k] - way[from];
        if long > best.2 {
            best = (from, k, long);
        }
    }
    let (from, to, long) = best;
    let thirds = beside[from..=to].iter().filter(|(_, third)| *third).count();
    if long < LONG_PENS / APART_PENS * apart || thirds as f64 > THIRD * (to - from + 1) as f64 {
        return None;
    }
    // where both go on at both ends they are two that run together for a while
    let reaches_end = |row: &Row, k: usize| {
        let near = |part: &[Point]| polyline_length(part) < ENDS * apart;
        !row.closed && (near(&row.points[..=k]) || near(&row.points[k..]))
    };
    let ends = [from, to].into_iter().filter_map(|k| Some((k, seen[k]?)));
    if !ends.into_iter().any(|(k, other_k)| reaches_end(&rows[other], k) || reaches_end(&rows[kept], other_k))
    {
        return None;
    }
    // between those that are seen the nearest that is
    let mut beside = Vec::with_capacity(to - from + 1);
    let mut known = seen[from]?;
    for seen in &seen[from..=to] {
        known = seen.unwrap_or(known);
        beside.push(known);
    }
    Some(Run { kept, other, from, to, beside, length: long })
}

/// How long the way is from the first of some points to each of them, px.
fn ways(points: &[Point]) -> Vec<f64> {
    let mut way = 0.0;
    let step = |k: usize| if k > 0 { points[k].distance(points[k - 1]) } else { 0.0 };
    (0..points.len())
        .map(|k| {
            way += step(k);
            way
        })
        .collect()
}

impl Run {
    /// Makes one row of both where they run beside each other, and rows of their own of what else there is of the other one.
    fn merge(mut self, rows: &mut Vec<Row>, apart: f64) {
        let other = rows[self.other].clone();
        rows[self.other].points.clear();
        let mut kept = rows[self.kept].clone();
        if kept.closed {
            self.turn_seam_away(&mut kept.points);
        }
        let way = ways(&kept.points);
        let whole = way[way.len() - 1];
        self.shift(&mut kept.points, &other.points, apart);
        kept.width = kept.width.max(other.width);
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

    /// Moves the points of the row that stays halfway over to the other one, and those before and behind by less and less.
    fn shift(&self, points: &mut [Point], other: &[Point], apart: f64) {
        let mut shifts = vec![None; points.len()];
        for (k, &at) in self.beside.iter().enumerate() {
            shifts[at] = Some((other[self.from + k] - points[at]) * 0.5);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane on which these lines are 2 px wide, as dark as the way along them says.
    fn sketched(lines: &[Vec<Point>], slit: u8) -> (Plane<u8>, Vec<Row>) {
        let mut plane = Plane::filled(200, 120, 0_u8);
        for (number, line) in lines.iter().enumerate() {
            for (k, p) in line.iter().enumerate() {
                let level = 60.0 + 15.0 * number as f64 + 30.0 * (k as f64 / 9.0).sin();
                for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, y) = ((p.x - 1.0) as usize + x, (p.y - 1.0) as usize + y);
                    plane.row_mut(y)[x] = level as u8;
                }
            }
        }
        for y in 44..48 {
            plane.row_mut(y).iter_mut().for_each(|v| *v = (*v).max(slit));
        }
        let row = |points: &Vec<Point>| Row {
            points: points.clone(),
            closed: false,
            width: 2.5,
            free: [true; 2],
            dot: false,
        };
        let rows = lines.iter().map(row).collect();
        (plane, rows)
    }

    fn level(from: f64, to: f64, y: f64) -> Vec<Point> {
        (0..=(to - from) as usize).map(|k| Point::new(from + k as f64, y)).collect()
    }

    /// Two lines 4 px apart, and four elsewhere.
    fn doubled(slit: u8) -> Vec<Row> {
        let others = (0..4).map(|k| level(20.0, 180.0, 70.0 + 12.0 * f64::from(k)));
        let lines: Vec<Vec<Point>> =
            [level(20.0, 180.0, 44.0), level(40.0, 150.0, 48.0)].into_iter().chain(others).collect();
        let (plane, rows) = sketched(&lines, slit);
        once(&plane, rows)
    }

    #[test]
    fn a_pencils_line_gone_over_again_is_one_line_between_both() {
        let rows = doubled(30);
        assert_eq!(rows.len(), 5);
        let at = |x: f64| rows[0].points.iter().find(|p| p.x == x).map(|p| p.y);
        assert_eq!((at(100.0), at(22.0)), (Some(46.0), Some(44.0)));
    }

    #[test]
    fn lines_with_paper_between_them_are_two() {
        assert_eq!(doubled(0).len(), 6);
    }
}
