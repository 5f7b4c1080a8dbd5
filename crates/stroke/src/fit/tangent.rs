//! Fits tangent-continuous lines and arcs to points by least squares.
//!
//! Each line has two unknowns (direction, offset), each circle three (centre, radius). That neighbours touch is one
//! equation a joint, that an end stays where it is one more; the sum of squared distances is made least under them by
//! Newton's method with Lagrange multipliers. A line's two sides may be parallel or cross anywhere: nothing is special.

use kurbo::{Point, Vec2};

use super::round::Circle;
use super::skyline::Skyline;
use super::window::{turn, unit};
use crate::Element;

/// What a part of a path lies on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// Through `at`; `along` is a unit vector in drawing direction.
    Line { at: Point, along: Vec2 },
    /// Round a circle.
    Round(Circle),
}

/// A line or an arc, and the points of the row, `first..=last`, that it stands for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) first: usize,
    pub(super) last: usize,
    pub(super) shape: Shape,
    pub(super) from: Point,
    pub(super) to: Point,
    /// Where it must start and end; never both.
    pub(super) pins: [Option<Point>; 2],
    /// Points at its start and at its end that show the tip of a pen: they do not count.
    pub(super) tips: [usize; 2],
    /// Whether it passes into the next part, the last one into the first, without anything between.
    pub(super) linked: bool,
}

impl Shape {
    /// How far left of the shape a point lies, and how that changes with the shape's unknowns.
    fn off(&self, p: Point) -> (f64, [f64; 3]) {
        match *self {
            Self::Line { at, along } => (along.cross(p - at), [-along.dot(p - at), -1.0, 0.0]),
            Self::Round(Circle { centre, radius }) => {
                let (arm, sense) = (p - centre, radius.signum());
                let out = unit(arm) * sense;
                (radius - sense * arm.hypot(), [out.x, out.y, 1.0])
            }
        }
    }

    /// By how much two shapes fail to touch, and how that changes with the unknowns of each; `None` for two lines and
    /// for circles about one centre.
    fn gap(&self, next: &Self) -> Option<(f64, [f64; 3], [f64; 3])> {
        match (*self, *next) {
            (Self::Line { along, .. }, Self::Round(Circle { centre, radius })) => {
                let (off, change) = self.off(centre);
                Some((off - radius, change, [-along.y, along.x, -1.0]))
            }
            (Self::Round(_), Self::Line { .. }) => next.gap(self).map(|(gap, b, a)| (gap, a, b)),
            (Self::Round(a), Self::Round(b)) => {
                let (between, side) = (a.centre - b.centre, (a.radius - b.radius).signum());
                let e = unit(between);
                let gap = between.hypot() - side * (a.radius - b.radius);
                (e != Vec2::ZERO).then_some((gap, [e.x, e.y, -side], [-e.x, -e.y, side]))
            }
            _ => None,
        }
    }

    /// Where two shapes touch.
    fn joint(&self, next: &Self) -> Option<Point> {
        match (*self, *next) {
            (Self::Line { .. }, Self::Round(circle)) => Some(self.nearest(circle.centre)),
            (Self::Round(circle), Self::Line { .. }) => Some(next.nearest(circle.centre)),
            (Self::Round(a), Self::Round(b)) => {
                let side = (a.radius - b.radius).signum();
                Some(a.centre - unit(a.centre - b.centre) * (a.radius * side))
            }
            _ => None,
        }
    }

    /// The shape's point nearest to `p`.
    pub(super) fn nearest(&self, p: Point) -> Point {
        match *self {
            Self::Line { at, along } => at + along * along.dot(p - at),
            Self::Round(Circle { centre, radius }) => centre + unit(p - centre) * radius.abs(),
        }
    }

    fn changed(&self, by: &[f64]) -> Self {
        match *self {
            Self::Line { at, along } => {
                let across = along.turn_90();
                Self::Line { at: at + across * by[1], along: unit(along + across * by[0]) }
            }
            Self::Round(Circle { centre, radius }) => {
                Self::Round(Circle { centre: centre + Vec2::new(by[0], by[1]), radius: radius + by[2] })
            }
        }
    }

    /// Unit direction at a point of the shape.
    fn direction(&self, p: Point) -> Vec2 {
        match *self {
            Self::Line { along, .. } => along,
            Self::Round(Circle { centre, radius }) => (unit(p - centre) * radius.signum()).turn_90(),
        }
    }
}

impl Part {
    pub(super) fn leaving(&self) -> Vec2 {
        self.shape.direction(self.from)
    }

    pub(super) fn arriving(&self) -> Vec2 {
        self.shape.direction(self.to)
    }

    /// Signed angle of an arc from its start to its end, rad; 0 for a line.
    pub(super) fn sweep(&self) -> f64 {
        let Shape::Round(Circle { centre, radius }) = self.shape else { return 0.0 };
        let short = turn(self.from - centre, self.to - centre);
        if short * radius < 0.0 { short + std::f64::consts::TAU.copysign(radius) } else { short }
    }

    pub(super) fn length(&self) -> f64 {
        match self.shape {
            Shape::Line { .. } => self.from.distance(self.to),
            Shape::Round(circle) => self.sweep().abs() * circle.radius.abs(),
        }
    }

    pub(super) fn element(&self) -> Element {
        match self.shape {
            Shape::Line { .. } => Element::Line { to: self.to },
            Shape::Round(circle) => Element::Arc { centre: circle.centre, sweep: self.sweep() },
        }
    }

    /// How far the part's points are off, in order.
    pub(super) fn off(&self, row: &[Point]) -> Vec<f64> {
        row[self.first..=self.last].iter().map(|&p| self.shape.off(p).0).collect()
    }

    /// The points that count; all, where hardly any would.
    pub(super) fn counting<'a>(&self, row: &'a [Point]) -> &'a [Point] {
        let (from, to) = (self.first + self.tips[0], self.last.saturating_sub(self.tips[1]));
        if to > from + 3 { &row[from..=to] } else { &row[self.first..=self.last] }
    }
}

/// Unknowns and equations of a part, in order: three unknowns, its pin, its link to the next part.
const EACH: usize = 5;
const PIN: usize = 3;
const LINK: usize = 4;
/// Steps of Newton's method; each squares what is left of the gaps.
const STEPS: usize = 8;
/// After so many steps the points stay with their parts, so that the steps that follow converge.
const SHARING: usize = 3;
/// A radius that changes by more in one step was no good guess.
const RATIOS: std::ops::Range<f64> = 0.2..5.0;

/// Moves the parts of a row so that all that are linked touch, and are as near to their points as that allows. Ends
/// where parts touch, and each part's points, follow. Where there is no such way, the number of a part that cannot.
pub(super) fn join(row: &[Point], mut parts: Vec<Part>) -> Result<Vec<Part>, usize> {
    for step in 0..STEPS {
        let changes = change(row, &parts)?;
        let mut most = 0.0_f64;
        for (i, by) in changes.chunks(EACH).enumerate() {
            let changed = parts[i].shape.changed(by);
            if let (Shape::Round(old), Shape::Round(new)) = (parts[i].shape, changed) {
                if !RATIOS.contains(&(new.radius / old.radius)) {
                    return Err(i);
                }
                most = most.max(old.centre.distance(new.centre) / new.radius.abs());
            }
            parts[i].shape = changed;
        }
        place(row, &mut parts)?;
        if step < SHARING {
            share_out(row, &mut parts);
        } else if most < 1e-10 {
            break;
        }
    }
    let next = |i: usize| &parts[(i + 1) % parts.len()].shape;
    let apart = |i: &usize| {
        let (part, gap) = (&parts[*i], parts[*i].shape.gap(next(*i)));
        part.linked && gap.is_none_or(|(gap, ..)| gap.abs() > 1e-6 * part.from.distance(part.to))
    };
    match (0..parts.len()).find(apart) {
        Some(part) => Err(part),
        None => Ok(parts),
    }
}

/// One step of Newton's method: the changes of all unknowns, [`EACH`] a part.
fn change(row: &[Point], parts: &[Part]) -> Result<Vec<f64>, usize> {
    let n = parts.len();
    let mut matrix = Skyline::default();
    let mut right = vec![0.0; EACH * n];
    for (i, part) in parts.iter().enumerate() {
        let own = EACH * i;
        let before = if i > 0 && parts[i - 1].linked { own - 1 } else { own };
        (0..PIN).for_each(|_| matrix.push(before));
        matrix.push(own);
        matrix.push(if i + 1 == n && part.linked { 0 } else { own });
        least_squares(part.counting(row), &part.shape, own, &mut matrix, &mut right);
    }
    for (i, part) in parts.iter().enumerate() {
        let own = EACH * i;
        match part.pins[0].or(part.pins[1]) {
            Some(pin) => {
                let (off, changes) = part.shape.off(pin);
                right[own + PIN] = -off;
                (0..3).for_each(|k| matrix.add(own + PIN, own + k, changes[k]));
            }
            None => matrix.add(own + PIN, own + PIN, 1.0),
        }
        if !part.linked {
            matrix.add(own + LINK, own + LINK, 1.0);
            continue;
        }
        let next = (i + 1) % n;
        let (gap, of_this, of_next) = part.shape.gap(&parts[next].shape).ok_or(i)?;
        right[own + LINK] = -gap;
        for k in 0..3 {
            matrix.add(own + LINK, own + k, of_this[k]);
            let (a, b) = (own + LINK, EACH * next + k);
            matrix.add(a.max(b), a.min(b), of_next[k]);
        }
    }
    matrix.solve(right).map_err(|row| row / EACH)
}

fn least_squares(points: &[Point], shape: &Shape, own: usize, matrix: &mut Skyline, right: &mut [f64]) {
    let mut square = [[0.0; 3]; 3];
    for &p in points {
        let (off, changes) = shape.off(p);
        for j in 0..3 {
            right[own + j] -= off * changes[j];
            (0..=j).for_each(|k| square[j][k] += changes[j] * changes[k]);
        }
    }
    if matches!(shape, Shape::Line { .. }) {
        square[2][2] = 1.0; // a line has no third unknown
    }
    (0..3).for_each(|j| (0..=j).for_each(|k| matrix.add(own + j, own + k, square[j][k])));
}

/// Ends of all parts: where they touch, where they must stay, else where their points end.
fn place(row: &[Point], parts: &mut [Part]) -> Result<(), usize> {
    let n = parts.len();
    for i in 0..n {
        let (this, next) = (parts[i], parts[(i + 1) % n]);
        if this.linked {
            let joint = this.shape.joint(&next.shape).ok_or(i)?;
            (parts[i].to, parts[(i + 1) % n].from) = (joint, joint);
        } else {
            parts[i].to = this.pins[1].unwrap_or_else(|| this.shape.nearest(row[this.last]));
            let from = next.pins[0].unwrap_or_else(|| next.shape.nearest(row[next.first]));
            parts[(i + 1) % n].from = from;
        }
    }
    Ok(())
}

/// Each part gets the points between its ends.
fn share_out(row: &[Point], parts: &mut [Part]) {
    let n = parts.len();
    for i in 0..n {
        let (low, high) = (if i > 0 { parts[i - 1].last } else { 0 }, row.len() - 1);
        let part = &mut parts[i];
        if part.linked {
            part.last = nearest(row, part.last, part.to).clamp((part.first + 1).min(high), high);
        }
        if i > 0 && parts[i - 1].linked || i == 0 && parts[n - 1].linked {
            let part = &mut parts[i];
            part.first = nearest(row, part.first, part.from).clamp(low.min(part.last - 1), part.last - 1);
        }
    }
}

/// The point nearest to `p`, looked for from point `i` on downhill.
fn nearest(row: &[Point], mut i: usize, p: Point) -> usize {
    let far = |i: usize| row[i].distance_squared(p);
    while i + 1 < row.len() && far(i + 1) < far(i) {
        i += 1;
    }
    while i > 0 && far(i - 1) < far(i) {
        i -= 1;
    }
    i
}
