//! Plans the lines and arcs of a point sequence and their connections.

use kurbo::Point;

use super::line::Line;
use super::round::Bow;
use super::straight::direction;
use super::tangent::{Part, Shape};

/// How a row of points ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shut {
    /// Both ends stay where they are; so many points at each may show the tip of a pen and not the line.
    Open(usize),
    /// The last point is the first one again, and the last line, if it ends there, passes into the first bend.
    Ring,
}

/// Lines and arcs in order, and which bend each arc belongs to.
pub(super) struct Plan {
    pub(super) parts: Vec<Part>,
    of: Vec<Of>,
    /// Bends of the row, with and without arcs.
    bends: usize,
}

/// What a part is: a piece of bend so and so, or line so and so. Bend i lies before line i.
#[derive(Clone, Copy, Debug)]
enum Of {
    Bend(usize),
    Line(usize),
}

impl Plan {
    /// The lines, with arcs in those bends that have some; there, everything is linked.
    /// Arcs at ends that are `loose` end where a pen's tip begins.
    pub(super) fn of(row: &[Point], lines: &[Line], shut: Shut, arcs: &[Vec<Bow>], loose: [bool; 2]) -> Self {
        let mut plan = Self { parts: Vec::new(), of: Vec::new(), bends: arcs.len().max(1) };
        for bend in 0..arcs.len().max(lines.len()) {
            let here = arcs.get(bend).map_or(&[][..], Vec::as_slice);
            if let Some(before) = plan.parts.last_mut() {
                before.linked = !here.is_empty();
            }
            plan.parts.extend(here.iter().map(|bow| arc(row, bow)));
            plan.of.extend(here.iter().map(|_| Of::Bend(bend)));
            if let Some(line) = lines.get(bend) {
                plan.parts.push(straight(line));
                plan.of.push(Of::Line(bend));
            } else if let Some(end) = plan.parts.last_mut() {
                end.linked = false;
            }
        }
        match shut {
            Shut::Open(tip) => plan.pin(row, tip, loose),
            Shut::Ring => {
                let ends_there = lines.last().is_none_or(|line| line.last + 1 == row.len());
                let linked = ends_there && arcs.first().is_some_and(|bows| !bows.is_empty());
                plan.parts.last_mut().into_iter().for_each(|end| end.linked = linked);
            }
        }
        plan
    }

    /// Ties the ends down: a line's where it reaches there, an arc's always, if not let loose; what is left out before it
    /// is a pen's tip.
    fn pin(&mut self, row: &[Point], tip: usize, loose: [bool; 2]) {
        let last = row.len() - 1;
        let round = |of: Option<&Of>| matches!(of, Some(Of::Bend(_)));
        let (starts_round, ends_round) = (round(self.of.first()), round(self.of.last()));
        if let Some(end) = self.parts.last_mut().filter(|p| ends_round || p.last == last) {
            if ends_round && loose[1] {
                end.last = end.last.min(last - tip).max(end.first + 1);
            } else {
                (end.pins[1], end.to) = (Some(row[last]), row[last]);
                end.tips[1] = if ends_round { last - end.last } else { tip };
                end.last = last;
            }
        }
        if let Some(start) = self.parts.first_mut().filter(|p| starts_round || p.first == 0) {
            if starts_round && loose[0] {
                start.first = start.first.max(tip).min(start.last - 1);
            } else {
                (start.pins[0], start.from) = (Some(row[0]), row[0]);
                start.tips[0] = if starts_round { start.first } else { tip };
                start.first = 0;
            }
        }
    }

    /// The bend a part lies in, or the bends beside a line.
    pub(super) fn beside(&self, part: usize) -> impl Iterator<Item = usize> + use<> {
        let bends = match self.of[part] {
            Of::Bend(bend) => [Some(bend), None],
            // behind a ring's last line comes its first bend
            Of::Line(line) => [Some(line), Some((line + 1) % self.bends)],
        };
        bends.into_iter().flatten()
    }

    /// The parts as they were joined; lines that are not linked stay as they were.
    pub(super) fn with(&self, joined: &[Part]) -> Vec<Part> {
        (0..joined.len()).map(|i| if is_moved(joined, i) { joined[i] } else { self.parts[i] }).collect()
    }
}

/// Whether a part is an arc or linked to one: other lines stay as they are.
pub(super) fn is_moved(parts: &[Part], i: usize) -> bool {
    let line = matches!(parts[i].shape, Shape::Line { .. });
    !line || parts[i].linked || parts[(i + parts.len() - 1) % parts.len()].linked
}

fn straight(line: &Line) -> Part {
    let shape = Shape::Line { at: line.from.midpoint(line.to), along: direction(line.from, line.to) };
    let &Line { first, last, from, to } = line;
    Part { first, last, shape, from, to, pins: [None; 2], tips: [0; 2], linked: false }
}

fn arc(row: &[Point], bow: &Bow) -> Part {
    let (from, to) = (row[bow.first], row[bow.last]);
    let line = || Shape::Line { at: from.midpoint(to), along: direction(from, to) };
    let shape = bow.circle.map_or_else(line, Shape::Round);
    Part { first: bow.first, last: bow.last, shape, from, to, pins: [None; 2], tips: [0; 2], linked: true }
}
