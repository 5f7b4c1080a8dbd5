//! Fits a section between corners with lines, arcs and cubics that join smoothly.

use kurbo::{CubicBez, Point, Vec2};

use super::arc;
use super::bend::{Bends, is_near};
use super::chain;
use super::cubic::Ends;
use super::line::Line;
use super::options::FitOptions;
use super::plan::Shut;
use super::round::Circle;
use super::straight::{Run, Straightness};
use super::tangent::Part;
use crate::{Element, polyline_length};

/// Points between two straight runs, at least: a break of direction gets this much room to become a bend.
const ROOM: usize = 4;

/// The section through `row`, from its first point to its last.
pub(super) fn open(row: &[Point], options: &FitOptions) -> Vec<Element> {
    let lines = lines(row, options);
    if let Some(whole) = if lines.is_empty() { whole(row, options) } else { None } {
        return vec![whole];
    }
    let parts = Bends { row, lines: &lines, shut: Shut::Open(tip(row, options)), options }.parts();
    let leaving = match parts.first() {
        Some(part) if part.first == 0 => part.leaving(),
        _ => chain::leaving(row, 0.2 * options.tolerance),
    };
    let back: Vec<Point> = row.iter().rev().copied().collect();
    let ends = Ends {
        from: row[0],
        leaving,
        to: row[row.len() - 1],
        arriving: -chain::leaving(&back, 0.2 * options.tolerance),
    };
    joined(row, &parts, &ends, options)
}

/// Points up to so many pen's half-widths from an end may show the pen's tip and not the line.
const TIP: f64 = 3.0;

/// How many points at an end of a row may show the tip of a pen: not more than one in six.
fn tip(row: &[Point], options: &FitOptions) -> usize {
    let length = polyline_length(row);
    let step = length / (row.len() - 1).max(1) as f64;
    (TIP * options.reach / step).ceil().clamp(1.0, 1.0 + row.len() as f64 / 6.0) as usize
}

/// One arc from end to end. Its ends stay where they are, however far from the circle of the others: then it may be off
/// by more.
fn whole(row: &[Point], options: &FitOptions) -> Option<Element> {
    let arc = arc::through(row, options.tolerance)?;
    let Element::Arc { centre, sweep } = arc else { return None };
    let radius = centre.distance(row[0]);
    let near = row.iter().all(|p| (p.distance(centre) - radius).abs() <= 0.7 * options.tolerance);
    let circle = Circle { centre, radius: radius.copysign(sweep) };
    let round = |tip: usize| is_near(&row[tip..row.len() - tip], &circle, options);
    (near || round(1) || round(tip(row, options))).then_some(arc)
}

/// The closed line through the ring `row` (its first point is not repeated), with its start point; smooth at the
/// seam. `tangent` is its direction at the first point.
pub(super) fn ring(row: &[Point], tangent: Vec2, options: &FitOptions) -> (Point, Vec<Element>) {
    let mut row = row.to_vec();
    let seam = lines(&row, options).first().map(|line| line.last);
    row.rotate_left(seam.unwrap_or(0));
    row.push(row[0]);
    let last = row.len() - 1;
    let lines = lines(&row, options);
    let parts = Bends { row: &row, lines: &lines, shut: Shut::Ring, options }.parts();
    let (mut at, mut along) = (row[0], tangent);
    if let Some(part) = parts.last().filter(|p| p.linked || seam.is_some() && p.last == last) {
        (at, along) = (part.to, part.arriving());
    } else if seam.is_some() {
        along = chain::leaving(&row, 0.2 * options.tolerance);
    }
    row[0] = at;
    row[last] = at;
    let ends = Ends { from: at, leaving: along, to: at, arriving: along };
    (at, joined(&row, &parts, &ends, options))
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

/// Lines and arcs, and cubics between those that do not touch.
fn joined(row: &[Point], parts: &[Part], ends: &Ends, options: &FitOptions) -> Vec<Element> {
    let mut elements = Vec::new();
    let (mut at, mut from, mut leaving) = (0, ends.from, ends.leaving);
    let mut touches = parts.last().is_some_and(|p| p.linked);
    for part in parts {
        if part.first > at && !touches {
            let bend = Ends { from, leaving, to: part.from, arriving: part.leaving() };
            elements.extend(bent(&row[at + 1..part.first], &bend, options));
        }
        elements.push(part.element());
        (at, from, leaving, touches) = (part.last, part.to, part.arriving(), part.linked);
    }
    if at + 1 < row.len() && !touches {
        let bend = Ends { from, leaving, to: ends.to, arriving: ends.arriving };
        elements.extend(bent(&row[at + 1..row.len() - 1], &bend, options));
    }
    elements
}

fn bent(points: &[Point], ends: &Ends, options: &FitOptions) -> Vec<Element> {
    let element = |c: CubicBez| Element::Cubic { c1: c.p1, c2: c.p2, to: c.p3 };
    chain::through(points, ends, 0.7 * options.tolerance).into_iter().map(element).collect()
}
