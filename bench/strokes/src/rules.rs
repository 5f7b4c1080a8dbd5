//! What is drawn only if a hand could decide it by looking: the README's bounds, checked on a figure as drawn.
//!
//! The check knows nothing of how a figure was made. It samples the strokes, finds where they cross, join, turn and end
//! (the figure's nodes) and asks whether these are far enough apart and open enough.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

use tracelight_stroke::{Path, Point, Vec2};

use crate::Figure;
use crate::bounds::{Bounds, WIDEST_CORNER_DEG};

/// The through stroke of a Y bends by up to this, degrees.
const WIDEST_BEND_DEG: f64 = 40.0;
/// A smaller change of direction is none, rad.
const SMOOTH_RAD: f64 = 0.05;
/// Points this near are one, px.
const SAME_PX: f64 = 0.05;
/// Lines that meet at 30° are apart from 1/sin 30° of their clearance on; a little more where they bend.
const NODE_REACH: f64 = 2.4;

/// The rule that a figure breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Broken {
    /// Two lines cross or meet at so few degrees.
    Angle(f64),
    /// A corner of so many degrees.
    Corner(f64),
    /// Two nodes are so many px apart.
    Nodes(f64),
    /// A curve of so small a radius, px.
    Radius(f64),
    /// Two lines run side by side, so many px from middle to middle.
    Alongside(f64),
    /// An end points at a line so many px ahead.
    Ahead(f64),
    /// A stroke of so many px.
    Short(f64),
}

/// The first rule that a figure breaks, if any, for this pen and least paper between lines, px.
pub fn broken(figure: &Figure, pen: f64, paper: f64) -> Option<Broken> {
    broken_within(figure, (pen, paper), &Bounds::USUAL)
}

/// [`broken`] with a kind's own bounds.
pub fn broken_within(figure: &Figure, (pen, paper): (f64, f64), bounds: &Bounds) -> Option<Broken> {
    let spacing = (0.4 * pen).max(0.8);
    let chains: Vec<_> = figure.strokes.iter().map(|s| Chain::of(&s.path, spacing)).collect();
    let near = Near::of(&chains, (pen + paper).max(2.0 * spacing));
    let nodes = Nodes::of(&chains, &near);
    let checks: [&dyn Fn() -> Option<Broken>; 6] = [
        &|| {
            chains
                .iter()
                .map(|c| c.length)
                .find(|&l| l < bounds.shortest.1.max(bounds.shortest.0 * pen))
                .map(Broken::Short)
        },
        &|| chains.iter().find_map(|c| c.tight(bounds.radius_pens * pen)).map(Broken::Radius),
        &|| {
            nodes
                .sharpest
                .filter(|&a| a < bounds.angle_deg.to_radians())
                .map(|a| Broken::Angle(a.to_degrees()))
        },
        &|| nodes.odd_corner(bounds.angle_deg).map(Broken::Corner),
        &|| nodes.too_near(bounds.node_pens * pen).map(Broken::Nodes),
        &|| {
            let near = alongside(&chains, &near, &nodes, pen + paper);
            near.filter(|_| bounds.alongside).map(Broken::Alongside)
        },
    ];
    checks
        .iter()
        .find_map(|check| check())
        .or_else(|| ahead(&chains, &nodes, bounds.ahead_pens * pen).map(Broken::Ahead))
}

/// A stroke as points, evenly enough.
struct Chain {
    points: Vec<Point>,
    along: Vec<f64>,
    length: f64,
    closed: bool,
    /// Change of direction at points where it is sudden.
    corners: Vec<(usize, f64)>,
}

impl Chain {
    fn of(path: &Path, spacing: f64) -> Self {
        let pieces: Vec<_> = path.pieces().filter(|p| p.length(1e-3) > 1e-9).collect();
        let mut chain = Self {
            points: vec![path.start()],
            along: vec![0.0],
            length: 0.0,
            closed: path.is_closed(),
            corners: vec![],
        };
        for (i, piece) in pieces.iter().enumerate() {
            let steps = (piece.length(1e-3) / spacing).ceil().max(1.0) as usize;
            (1..=steps).for_each(|k| chain.push(piece.at(k as f64 / steps as f64)));
            let next = pieces.get(i + 1).or(pieces.first().filter(|_| path.is_closed()));
            let turn = next.map_or(0.0, |next| between(piece.end_tangent(), next.start_tangent()));
            if turn > SMOOTH_RAD {
                chain.corners.push((chain.points.len() - 1, turn));
            }
        }
        chain
    }

    fn push(&mut self, point: Point) {
        self.length += point.distance(self.points[self.points.len() - 1]);
        self.points.push(point);
        self.along.push(self.length);
    }

    fn is_corner(&self, at: usize) -> bool {
        self.corners.iter().any(|&(corner, _)| corner == at)
    }

    /// A radius below `least`, away from corners.
    fn tight(&self, least: f64) -> Option<f64> {
        let radius = |i: usize| {
            let (before, after) = (self.points[i] - self.points[i - 1], self.points[i + 1] - self.points[i]);
            0.5 * (before.hypot() + after.hypot()) / between(before, after).max(1e-9)
        };
        // a chord's turn is not exactly its arc's
        let inner = (1..self.points.len() - 1).filter(|&i| !self.is_corner(i));
        inner.map(radius).find(|&r| r < 0.97 * least)
    }

    /// How far apart two of its points are along it, the short way round.
    fn apart(&self, i: usize, j: usize) -> f64 {
        let straight = (self.along[i] - self.along[j]).abs();
        if self.closed { straight.min(self.length - straight) } else { straight }
    }

    /// Its two ends with the directions out of them.
    fn ends(&self) -> Vec<(Point, Vec2)> {
        let n = self.points.len();
        match self.closed {
            true => vec![],
            false => {
                let out =
                    |a: usize, b: usize| (self.points[a], (self.points[a] - self.points[b]).normalize());
                vec![out(0, 1), out(n - 1, n - 2)]
            }
        }
    }
}

/// Angle between two directions, [0, π].
fn between(a: Vec2, b: Vec2) -> f64 {
    a.cross(b).atan2(a.dot(b)).abs()
}

/// Angle between two lines, [0, π/2].
fn folded(a: Vec2, b: Vec2) -> f64 {
    FRAC_PI_2 - (between(a, b) - FRAC_PI_2).abs()
}

/// Pairs of points of the chains that are near in the plane and not along a chain.
struct Near {
    /// (chain, point), twice.
    pairs: Vec<[(usize, usize); 2]>,
}

impl Near {
    fn of(chains: &[Chain], reach: f64) -> Self {
        let cell = |p: Point| ((p.x / reach).floor() as i64, (p.y / reach).floor() as i64);
        let mut cells: HashMap<(i64, i64), Vec<(usize, usize)>> = HashMap::new();
        let mut pairs = Vec::new();
        for (c, chain) in chains.iter().enumerate() {
            for (i, &point) in chain.points.iter().enumerate() {
                let (x, y) = cell(point);
                let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
                for &other in around.filter_map(|key| cells.get(&key)).flatten() {
                    let along = other.0 == c && chain.apart(other.1, i) < 3.0 * reach;
                    if !along && chains[other.0].points[other.1].distance(point) < reach {
                        pairs.push([other, (c, i)]);
                    }
                }
                cells.entry((x, y)).or_default().push((c, i));
            }
        }
        Self { pairs }
    }
}

/// Where strokes cross, join, turn and end.
struct Nodes {
    /// Each once, with the stroke whose corner or end it is; none for a crossing or a junction.
    places: Vec<(Point, Option<usize>)>,
    corners: Vec<(Point, f64)>,
    joints: Vec<Point>,
    ends: Vec<(Point, Vec2)>,
    /// Least angle at which lines cross or meet, rad.
    sharpest: Option<f64>,
}

impl Nodes {
    fn of(chains: &[Chain], near: &Near) -> Self {
        let corner =
            |c: &Chain| -> Vec<_> { c.corners.iter().map(|&(i, turn)| (c.points[i], turn)).collect() };
        let mut nodes = Self {
            places: vec![],
            corners: chains.iter().flat_map(corner).collect(),
            joints: vec![],
            ends: vec![],
            sharpest: None,
        };
        for (number, chain) in chains.iter().enumerate() {
            for (end, out) in chain.ends() {
                nodes.join(chains, number, end, out);
            }
        }
        near.pairs.iter().for_each(|&pair| nodes.cross(chains, pair));
        for (number, chain) in chains.iter().enumerate() {
            let ends = chain.ends();
            let corners = chain.corners.iter().map(|&(i, _)| chain.points[i]);
            corners.chain(ends.iter().map(|e| e.0)).for_each(|at| nodes.add(at, Some(number)));
        }
        nodes
    }

    /// Crossings and junctions come first: a corner or an end in one is no place of its own.
    fn add(&mut self, at: Point, of: Option<usize>) {
        if !self.places.iter().any(|p| p.0.distance(at) < SAME_PX) {
            self.places.push((at, of));
        }
    }

    fn angle(&mut self, angle: f64) {
        self.sharpest = Some(self.sharpest.map_or(angle, |s| s.min(angle)));
    }

    /// An end that lies on another stroke is a junction.
    fn join(&mut self, chains: &[Chain], own: usize, end: Point, out: Vec2) {
        let others = chains.iter().enumerate().filter(|&(other, _)| other != own);
        let pieces = others.flat_map(|(_, c)| c.points.windows(2));
        let met: Vec<_> =
            pieces.filter(|w| distance(w[0], w[1], end) < SAME_PX).map(|w| w[1] - w[0]).collect();
        if met.is_empty() {
            return self.ends.push((end, out));
        }
        met.iter().for_each(|&way| self.angle(folded(way, out)));
        self.joints.push(end);
        self.add(end, None);
    }

    /// Pieces after these points that cross in their insides.
    fn cross(&mut self, chains: &[Chain], pair: [(usize, usize); 2]) {
        let piece = |(c, i): (usize, usize)| chains[c].points.get(i..i + 2);
        let (Some(&[a, b]), Some(&[c, d])) = (pair.map(piece)[0], pair.map(piece)[1]) else { return };
        let (u, v) = (b - a, d - c);
        let whole = u.cross(v);
        let (t, s) = ((c - a).cross(v) / whole, (c - a).cross(u) / whole);
        let at = a + u * t;
        let inside = (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s);
        if inside && !self.joints.iter().any(|j| j.distance(at) < 2.0 * SAME_PX) {
            self.angle(folded(u, v));
            self.add(at, None);
        }
    }

    /// A corner whose inner angle is out of bounds. At a junction a slight bend is none.
    fn odd_corner(&self, least_deg: f64) -> Option<f64> {
        let odd = |&(at, turn): &(Point, f64)| {
            let inner = (PI - turn).to_degrees();
            let joint = self.joints.iter().any(|j| j.distance(at) < SAME_PX);
            let slight = joint && turn.to_degrees() <= WIDEST_BEND_DEG + 0.1;
            (!(least_deg..=WIDEST_CORNER_DEG).contains(&inner) && !slight).then_some(inner)
        };
        self.corners.iter().find_map(odd)
    }

    /// Two nodes of one stroke, or a crossing or junction and anything, nearer than `least`. Ends and corners of lines
    /// side by side may be as near as the lines are.
    fn too_near(&self, least: f64) -> Option<f64> {
        let pairs =
            self.places.iter().enumerate().flat_map(|(i, p)| self.places[..i].iter().map(move |q| (p, q)));
        let mut near = pairs.filter(|(p, q)| p.1.is_none() || q.1.is_none() || p.1 == q.1);
        near.find_map(|(p, q)| Some(p.0.distance(q.0)).filter(|&d| d < least))
    }
}

/// Lines side by side nearer than `clearance`, away from where they meet: a crossing, a junction, a corner of their own.
fn alongside(chains: &[Chain], near: &Near, nodes: &Nodes, clearance: f64) -> Option<f64> {
    let point = |(c, i): (usize, usize)| chains[c].points[i];
    let meet = |a: (usize, usize), b: (usize, usize)| {
        let (p, q) = (point(a), point(b));
        let by = |n: Point| n.distance(p).max(n.distance(q)) < NODE_REACH * clearance;
        let own = chains[a.0].corners.iter().filter(|_| a.0 == b.0).map(|&(i, _)| chains[a.0].points[i]);
        nodes.places.iter().filter(|n| n.1.is_none()).map(|n| n.0).chain(own).any(by)
    };
    near.pairs.iter().find_map(|&[a, b]| {
        let apart = point(a).distance(point(b));
        (apart < clearance - SAME_PX && !meet(a, b)).then_some(apart)
    })
}

/// An end that points at ink nearer than `least`.
fn ahead(chains: &[Chain], nodes: &Nodes, least: f64) -> Option<f64> {
    let points = || chains.iter().flat_map(|c| c.points.iter());
    nodes.ends.iter().find_map(|&(end, out)| {
        let seen = points().map(|&p| p - end).filter(|v| v.dot(out) > 0.6 * v.hypot());
        seen.map(Vec2::hypot).find(|&d| d > SAME_PX && d < least)
    })
}

fn distance(a: Point, b: Point, at: Point) -> f64 {
    let way = b - a;
    let share = ((at - a).dot(way) / way.hypot2().max(1e-12)).clamp(0.0, 1.0);
    at.distance(a + way * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Hand, Nib};

    /// Whether polylines in a pen of 2 px, 3 px of paper, break a rule.
    fn check(lines: &[&[(f64, f64)]]) -> Option<Broken> {
        let hand = Hand { pen: 2.0, nib: Nib::Round, paper: 3.0, size: 50.0 };
        let path = |points: &&[(f64, f64)]| {
            let points: Vec<Point> = points.iter().map(|&p| p.into()).collect();
            Path::polyline(&points, false)
        };
        broken(&Figure::lines(&hand, lines.iter().filter_map(path)), 2.0, 3.0)
    }

    #[test]
    fn what_a_hand_can_decide_is_drawn() {
        assert_eq!(check(&[&[(0., 0.), (100., 0.)]]), None);
        assert_eq!(check(&[&[(0., 0.), (100., 0.)], &[(50., -30.), (50., 30.)]]), None, "X");
        assert_eq!(check(&[&[(0., 0.), (100., 0.)], &[(50., 0.), (50., 30.)]]), None, "T");
        assert_eq!(check(&[&[(0., 0.), (50., 0.), (90., 20.)], &[(50., 0.), (50., -30.)]]), None, "Y");
        assert_eq!(check(&[&[(0., 0.), (100., 0.)], &[(0., 5.1), (100., 5.1)]]), None, "parallel");
        assert_eq!(check(&[&[(0., 0.), (50., 0.), (20., 30.)]]), None, "corner");
    }

    #[test]
    fn what_nobody_can_decide_is_not() {
        let flat = check(&[&[(0., 0.), (100., 0.)], &[(0., -20.), (100., 20.)]]);
        assert!(matches!(flat, Some(Broken::Angle(a)) if (a - 21.8).abs() < 0.1), "{flat:?}");
        let side = check(&[&[(0., 0.), (100., 0.)], &[(0., 4.), (100., 4.)]]);
        assert!(matches!(side, Some(Broken::Alongside(_))), "{side:?}");
        let two = check(&[&[(0., 0.), (100., 0.)], &[(50., 30.), (50., 0.)], &[(55., -30.), (55., 0.)]]);
        assert!(matches!(two, Some(Broken::Nodes(_))), "{two:?}");
        assert!(matches!(check(&[&[(0., 0.), (50., 0.), (10., 9.)]]), Some(Broken::Corner(_))));
        assert!(matches!(check(&[&[(0., 0.), (50., 0.), (90., 9.)]]), Some(Broken::Corner(_))));
        assert!(matches!(
            check(&[&[(0., 0.), (100., 0.)], &[(50., 5.5), (50., 40.)]]),
            Some(Broken::Ahead(_))
        ));
        assert!(matches!(check(&[&[(0., 0.), (10., 0.)]]), Some(Broken::Short(_))));
    }

    #[test]
    fn a_tight_curve_is_not_drawn() {
        let hand = Hand { pen: 2.0, nib: Nib::Round, paper: 3.0, size: 50.0 };
        let bow = |radius: f64| Figure::lines(&hand, [crate::shapes::arc(Point::ORIGIN, radius, 0.0, 4.3)]);
        assert_eq!(broken(&bow(6.0), 2.0, 3.0), None);
        assert!(matches!(broken(&bow(3.8), 2.0, 3.0), Some(Broken::Radius(_))));
    }
}
