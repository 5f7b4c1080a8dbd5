//! A stretch between corners as straight lines and cubics that pass smoothly into each other.

use kurbo::{CubicBez, Point, Vec2};

use super::FitOptions;
use super::arc;
use super::chain;
use super::cubic::Ends;
use super::straight::{Run, Straightness, direction};
use crate::Element;

/// Points between two straight runs, at least: a break of direction gets this much room to become a bend.
const ROOM: usize = 4;

/// A line of the section, with the indices of the points it replaces.
#[derive(Clone, Copy, Debug)]
struct Line {
    first: usize,
    last: usize,
    from: Point,
    to: Point,
}

/// The section through `row`, from its first point to its last.
pub(super) fn open(row: &[Point], options: &FitOptions) -> Vec<Element> {
    let lines = lines(row, options);
    if let Some(arc) = arc::through(row, 0.7 * options.tolerance).filter(|_| lines.is_empty()) {
        return vec![arc];
    }
    let leaving = match lines.first() {
        Some(line) if line.first == 0 => direction(line.from, line.to),
        _ => chain::leaving(row, 0.2 * options.tolerance),
    };
    let back: Vec<Point> = row.iter().rev().copied().collect();
    let ends = Ends {
        from: row[0],
        leaving,
        to: row[row.len() - 1],
        arriving: -chain::leaving(&back, 0.2 * options.tolerance),
    };
    joined(row, &lines, &ends, options)
}

/// The closed line through the ring `row` (its first point is not repeated), with its start point; smooth at the
/// seam. `tangent` is its direction at the first point.
pub(super) fn ring(row: &[Point], tangent: Vec2, options: &FitOptions) -> (Point, Vec<Element>) {
    let mut row = row.to_vec();
    let seam = lines(&row, options).first().map(|line| line.last);
    row.rotate_left(seam.unwrap_or(0));
    row.push(row[0]);
    let last = row.len() - 1;
    let mut lines = lines(&row, options);
    let (mut at, mut along) = (row[0], tangent);
    if let Some(line) = lines.last_mut().filter(|l| seam.is_some() && l.last == last) {
        (at, along) = (line.to, direction(line.from, line.to));
    } else if seam.is_some() {
        along = chain::leaving(&row, 0.2 * options.tolerance);
    }
    row[0] = at;
    row[last] = at;
    let ends = Ends { from: at, leaving: along, to: at, arriving: along };
    (at, joined(&row, &lines, &ends, options))
}

/// The straight lines of a row, carried through to its ends where the points between allow it.
fn lines(row: &[Point], options: &FitOptions) -> Vec<Line> {
    // 30 tolerances: on a shorter chord a circle of 100 tolerances looks straight
    let least = (30.0 * options.tolerance).max(2.0 * options.reach);
    let runs = apart(Straightness::new(row, options.tolerance, least).runs());
    let last = row.len() - 1;
    let on = |range: std::ops::Range<usize>, run: &Run| {
        row[range].iter().all(|&p| p.distance(run.project(p)) <= options.tolerance)
    };
    let line = |run: &Run| {
        let first = if on(0..run.first, run) { 0 } else { run.first };
        let end = if on(run.last..row.len(), run) { last } else { run.last };
        let from = if first == 0 { row[0] } else { run.project(row[first]) };
        let to = if end == last { row[last] } else { run.project(row[end]) };
        Line { first, last: end, from, to }
    };
    runs.iter().map(line).collect()
}

/// Neighbouring runs shortened until there is room between them.
fn apart(mut runs: Vec<Run>) -> Vec<Run> {
    for i in 1..runs.len() {
        let (before, after) = (runs[i - 1].last, runs[i].first);
        if after < before + ROOM {
            runs[i - 1].last = before.saturating_sub(ROOM / 2).max(runs[i - 1].first + 1);
            runs[i].first = (after + ROOM / 2).min(runs[i].last - 1);
        }
    }
    runs
}

/// Lines and what bends between them.
fn joined(row: &[Point], lines: &[Line], ends: &Ends, options: &FitOptions) -> Vec<Element> {
    let mut elements = Vec::new();
    let (mut at, mut from, mut leaving) = (0, ends.from, ends.leaving);
    for line in lines {
        let along = direction(line.from, line.to);
        if line.first > at {
            let bend = Ends { from, leaving, to: line.from, arriving: along };
            elements.extend(bent(&row[at + 1..line.first], &bend, options));
        }
        elements.push(Element::Line { to: line.to });
        (at, from, leaving) = (line.last, line.to, along);
    }
    if at + 1 < row.len() {
        let bend = Ends { from, leaving, to: ends.to, arriving: ends.arriving };
        elements.extend(bent(&row[at + 1..row.len() - 1], &bend, options));
    }
    elements
}

fn bent(points: &[Point], ends: &Ends, options: &FitOptions) -> Vec<Element> {
    let element = |c: CubicBez| Element::Cubic { c1: c.p1, c2: c.p2, to: c.p3 };
    chain::through(points, ends, 0.7 * options.tolerance).into_iter().map(element).collect()
}
