//! Lines and arcs that meet become one stroke, as they were drawn: a CAD program keeps an outline in pieces.
//!
//! Ends of one layer and colour that lie together are a node. Where two ends meet they are joined, and so are the only
//! two at the very same point; else, where more meet, those that go straight on, the straightest first. Ends are found
//! by a grid, so this is linear; every choice is by place and file order, so equal files give equal strokes.

use std::collections::{BTreeSet, HashMap};
use std::f64::consts::TAU;

use tracelight_stroke::{Element, Path, Piece, Point, Vec2, turn_rad};

use super::blocks::Drawn;
use crate::circular::arc_between;

/// Ends this near are together, as a share of the drawing's size: 3 µm on 300 mm.
const NEAR: f64 = 1e-5;

/// Side of a cell of the grid, in that distance: large, so that most ends lie away from its sides.
const CELL: f64 = 8.0;

/// And as a share of the shorter path, so that the small in a large drawing stays what it is.
const NEAR_OF_LENGTH: f64 = 1e-2;

/// Nodes of more ends than this are left alone: stars and hatchings.
const MOST_ENDS: usize = 8;

/// Where more than two meet, a join turns by less than this: 10°.
const STRAIGHT_RAD: f64 = 0.1745;

/// Two ends that meet and go back the way they came, to a ten-thousandth, are two lines on top of each other.
const BACK_RAD: f64 = 1e-4;

/// An arc of more than this keeps its circle where it is joined, rad: 270°.
const NEARLY_WHOLE_RAD: f64 = 0.75 * TAU;

/// An end of a path: twice its number, plus one for its last point.
type End = usize;

/// Joins what meets. `size` is the drawing's, in its unit.
pub(super) fn joined(drawn: Vec<Drawn>, size: f64) -> Vec<Drawn> {
    let mut partners = vec![None; 2 * drawn.len()];
    for node in nodes(&drawn, NEAR * size) {
        pair(&node, &drawn, &mut partners);
    }
    chained(drawn, &partners)
}

fn point_of(end: End, drawn: &[Drawn]) -> Point {
    let path = &drawn[end / 2].path;
    if end.is_multiple_of(2) { path.start() } else { path.end() }
}

/// Ends that lie within `near` of the first of them, in file order.
fn nodes(drawn: &[Drawn], near: f64) -> Vec<Vec<End>> {
    let mut nodes: Vec<Vec<End>> = Vec::new();
    if near <= 0.0 {
        return nodes;
    }
    let mut grid: HashMap<(usize, u32, i64, i64), Vec<usize>> = HashMap::new();
    let is_open = |end: &End| !(drawn[end / 2].path.is_closed() || drawn[end / 2].is_dot);
    let open = (0..2 * drawn.len()).filter(is_open);
    for end in open {
        let (own, point) = (&drawn[end / 2], point_of(end, drawn));
        let colour = u32::from_be_bytes([0, own.colour.r, own.colour.g, own.colour.b]);
        let cell = |v: f64| (v / (CELL * near)).floor() as i64;
        let around = |v: f64| cell(v - near)..=cell(v + near);
        let cells = around(point.x).flat_map(|column| around(point.y).map(move |row| (column, row)));
        let known = cells.filter_map(|(column, row)| grid.get(&(own.layer, colour, column, row)));
        let known = known.flatten().copied();
        // the nodes of a cell are `near` apart: there are few
        let known = known.filter(|&n| point_of(nodes[n][0], drawn).distance(point) <= near).min();
        match known {
            Some(node) => nodes[node].push(end),
            None => {
                grid.entry((own.layer, colour, cell(point.x), cell(point.y))).or_default().push(nodes.len());
                nodes.push(vec![end]);
            }
        }
    }
    nodes
}

/// Decides which ends of a node belong together.
fn pair(node: &[End], drawn: &[Drawn], partners: &mut [Option<End>]) {
    if !(2..=MOST_ENDS).contains(&node.len()) {
        return;
    }
    let mut pairs: Vec<(f64, End, End)> = Vec::new();
    for (i, &a) in node.iter().enumerate() {
        for &b in &node[i + 1..] {
            let turn = turn(a, b, drawn);
            let most =
                if is_alone(a, b, node, drawn) { std::f64::consts::PI - BACK_RAD } else { STRAIGHT_RAD };
            if turn <= most && is_near(a, b, drawn) {
                pairs.push((turn, a, b));
            }
        }
    }
    pairs.sort_by(|x, y| x.0.total_cmp(&y.0).then((x.1, x.2).cmp(&(y.1, y.2))));
    for (_, a, b) in pairs {
        if partners[a].is_none() && partners[b].is_none() {
            (partners[a], partners[b]) = (Some(b), Some(a));
        }
    }
}

/// Whether two ends are a node's only ones, or the only ones at their very point.
fn is_alone(a: End, b: End, node: &[End], drawn: &[Drawn]) -> bool {
    let here = point_of(a, drawn);
    let same = node.iter().filter(|&&end| point_of(end, drawn) == here).count();
    node.len() == 2 || (same == 2 && point_of(b, drawn) == here)
}

fn is_near(a: End, b: End, drawn: &[Drawn]) -> bool {
    let length = |end: End| drawn[end / 2].path.rough_length();
    let gap = point_of(a, drawn).distance(point_of(b, drawn));
    gap == 0.0 || gap <= NEAR_OF_LENGTH * length(a).min(length(b))
}

/// The change of direction on the way in by one end and out by the other, rad.
fn turn(a: End, b: End, drawn: &[Drawn]) -> f64 {
    turn_rad(outwards(a, drawn), -outwards(b, drawn))
}

/// The direction into the path at one of its ends.
fn outwards(end: End, drawn: &[Drawn]) -> Vec2 {
    let path = &drawn[end / 2].path;
    match end % 2 {
        0 => path.pieces().next().map_or(Vec2::ZERO, |p| p.start_tangent()),
        _ => path.pieces().last().map_or(Vec2::ZERO, |p| -p.end_tangent()),
    }
}

/// The chains that the partners make, each where its first member stood and in its direction.
fn chained(drawn: Vec<Drawn>, partners: &[Option<End>]) -> Vec<Drawn> {
    let mut done = vec![false; drawn.len()];
    let mut chains: Vec<(Vec<End>, bool)> = Vec::new();
    for first in 0..drawn.len() {
        if done[first] {
            continue;
        }
        let (entry, is_ring) = beginning(2 * first, partners);
        let mut chain = vec![entry];
        done[entry / 2] = true;
        while let Some(next) = partners[chain[chain.len() - 1] ^ 1].filter(|next| !done[next / 2]) {
            done[next / 2] = true;
            chain.push(next);
        }
        chains.push((chain, is_ring));
    }
    chains.into_iter().map(|(chain, is_ring)| one(&chain, is_ring, &drawn)).collect()
}

/// The end by which the chain of a path is entered, and whether it is a ring.
fn beginning(start: End, partners: &[Option<End>]) -> (End, bool) {
    let mut entry = start;
    while let Some(before) = partners[entry] {
        entry = before ^ 1;
        if entry == start {
            return (start, true);
        }
    }
    (entry, false)
}

/// One path of many, entered by the given ends in turn.
fn one(chain: &[End], is_ring: bool, drawn: &[Drawn]) -> Drawn {
    let own = &drawn[chain[0] / 2];
    let ways: Vec<Path> = chain.iter().map(|&end| entered(&drawn[end / 2].path, end)).collect();
    if let ([path], false) = (ways.as_slice(), is_ring) {
        return own.along(path.clone());
    }
    let start = ways[0].start();
    let mut path = Path::new(start);
    let pieces: Vec<Piece> = ways.iter().flat_map(Path::pieces).collect();
    for (i, piece) in pieces.iter().enumerate() {
        let is_last = i + 1 == pieces.len();
        let to = if is_last && is_ring { start } else { piece.end() };
        path.push(ending_at(piece, path.end(), to));
    }
    if is_ring {
        path.close();
    }
    let entities: BTreeSet<_> = chain.iter().map(|end| drawn[end / 2].origin).collect();
    Drawn { more: entities.len() - 1, ..own.along(path) }
}

fn entered(path: &Path, end: End) -> Path {
    if end.is_multiple_of(2) { path.clone() } else { path.reversed() }
}

/// A piece between two points that are its own ends but for the gap of a join, which an arc shares out.
fn ending_at(piece: &Piece, from: Point, to: Point) -> Element {
    match piece.element {
        Element::Line { .. } => Element::Line { to },
        Element::Cubic { c1, c2, .. } => Element::Cubic { c1, c2, to },
        // the ends of a nearly whole circle say little of where it lies: it is moved, and closed if it returns
        Element::Arc { centre, sweep } if sweep.abs() > NEARLY_WHOLE_RAD => {
            let sweep = if from == to { TAU.copysign(sweep) } else { sweep };
            Element::Arc { centre: centre + (from - piece.from), sweep }
        }
        Element::Arc { sweep, .. } if from != piece.from || to != piece.end() => arc_between(from, to, sweep),
        arc => arc,
    }
}
