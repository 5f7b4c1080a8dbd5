//! Removes branches caused by the pen's outline: bumps, whiskers, and the points of corners.
//!
//! A spur between two lines is where both run together, up to the corner's point or the hairpin's turn, or it is a third
//! line. A point goes; where the turn of a hairpin is, the two sides are told.

use tracelight_image::Plane;
use tracelight_image::median::median;
use tracelight_maths::sin;
use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::bridge::{angle, from_end};
use crate::crumbs;
use crate::graph::{Branch, Graph, Node, TurnTip};

/// Removes spurs, shortest first, and joins what they parted, until none is left.
pub(crate) fn prune(graph: &mut Graph, dark: &Plane<u8>) {
    let pen = graph.pen_radius();
    for _ in 0..MOST_ROUNDS {
        graph.join_pairs();
        let at_nodes = graph.ends_at_nodes();
        let mut spurs = Vec::new();
        for ends in &at_nodes {
            let spur = |&end: &(usize, usize)| {
                free_end(graph, end)?;
                let pen = pen_beside(graph, ends, end, pen);
                let is_whisker = is_whisker(graph, ends, end, pen, dark);
                let goes = is_whisker || is_bump(graph, end) || is_mitre(graph, ends, end, pen);
                goes.then_some(Spur { branch: end.0, is_whisker })
            };
            let length = |spur: &Spur| graph.branches[spur.branch].length();
            // one at a time at each node: a spur less can make a line of the two others
            spurs.extend(ends.iter().filter_map(spur).min_by(|a, b| length(a).total_cmp(&length(b))));
        }
        if spurs.is_empty() {
            return;
        }
        spurs.sort_unstable_by_key(|spur| std::cmp::Reverse(spur.branch));
        let points = spurs.iter().filter(|spur| !spur.is_whisker);
        points.for_each(|spur| keep_turn(graph, &at_nodes, spur.branch, pen));
        spurs.into_iter().for_each(|spur| drop(graph.branches.swap_remove(spur.branch)));
    }
}

/// A branch that goes.
struct Spur {
    branch: usize,
    /// Whether it leads to no turn of the pen.
    is_whisker: bool,
}

/// Rounds of pruning; drawings take two or three, texture could take thousands.
const MOST_ROUNDS: usize = 50;

/// The node at an end of a branch whose other end is free, and the free end's place and distance to the edge.
fn free_end(graph: &Graph, (branch, end): (usize, usize)) -> Option<(Node, Point, f64)> {
    let Branch { nodes, points, radii, .. } = &graph.branches[branch];
    let node = graph.nodes[nodes[end].filter(|_| nodes[1 - end].is_none())?];
    let tip = if end == 0 { points.len() - 1 } else { 0 };
    Some((node, points[tip], radii[tip]))
}

/// Whether a branch with one free end hardly leaves the disc of ink about its node: a bump of the outline.
fn is_bump(graph: &Graph, end: (usize, usize)) -> bool {
    free_end(graph, end).is_some_and(|(node, tip, radius)| {
        tip.distance(node.at) + radius - node.radius < (0.6 * node.radius).max(1.5)
    })
}

/// Whether a branch with one free end is what a pencil leaves on the paper's grain at its lines' edges: short, and much thinner than
/// the lines that it leaves, or thinner and paler.
fn is_whisker(
    graph: &Graph,
    ends: &[(usize, usize)],
    end: (usize, usize),
    pen: f64,
    dark: &Plane<u8>,
) -> bool {
    let Some((node, tip, _)) = free_end(graph, end) else { return false };
    let radius = median(&graph.branches[end.0].radii);
    let length = tip.distance(node.at) - node.radius;
    // a letter's bars are as short, and as thin where they are a pixel wide
    if radius < HAIR * pen && length < 2.0 * HAIR_PENS * pen && !graph.is_letter() {
        return true;
    }
    if radius > THINNER * pen || length > 2.0 * crumbs::LONGEST_PENS * pen {
        return false;
    }
    let darkness = |(branch, end): (usize, usize)| {
        dark.mean_at(from_end(&graph.branches[branch].points, end).take(BESIDE).copied())
    };
    let others = ends.iter().filter(|&&other| other != end).map(|&other| darkness(other));
    darkness(end) < crumbs::PALE * others.fold(f64::INFINITY, f64::min)
}

/// Largest width of a whisker, as a share of the lines that it leaves, and its largest length in their widths.
const HAIR: f64 = 0.4;
const HAIR_PENS: f64 = 1.5;
/// Largest relative width of a whisker that would be a crumb without the line that it touches.
const THINNER: f64 = 0.6;

/// Half the width of the narrower of the lines beside a spur, px: where a pencil went to and fro they are wider than elsewhere. At least
/// `pen`, which is half the graph's.
fn pen_beside(graph: &Graph, ends: &[(usize, usize)], spur: (usize, usize), pen: f64) -> f64 {
    let beside = |&(branch, end): &(usize, usize)| {
        let along = from_end(&graph.branches[branch].radii, end);
        let near: Vec<f64> = along.skip((2.0 * pen) as usize).take(BESIDE).copied().collect();
        if near.len() < BESIDE / 2 { pen } else { median(&near) }
    };
    ends.iter().filter(|&&end| end != spur).map(beside).fold(f64::INFINITY, f64::min).max(pen)
}

/// Points of a line that tell its width beside a spur.
const BESIDE: usize = 16;

/// Whether a branch with one free end is the point of a mitred corner: it leads away from two others, midway
/// between their backs, as far as their outer edges take to meet.
///
/// With pen half-width r and s = sin(θ/2) of the angle θ between the two, the fork lies r(1 − s)/(s(1 + s)) inside
/// the corner (a disc there touches the inner corner and both outer edges) and the point r/s outside. Its ink gets as much
/// narrower on the way as that takes: what goes on straight as one of the two, as wide as the pen up to its end, is a nub.
fn is_mitre(graph: &Graph, ends: &[(usize, usize)], end: (usize, usize), pen: f64) -> bool {
    let Some((node, tip, radius)) = free_end(graph, end).filter(|_| ends.len() == 3) else { return false };
    let out = tip - node.at;
    let is_half = |&other: &(usize, usize)| other != end && is_other_half(graph, end, other);
    if is_line(&graph.branches[end.0], node.at, pen) || ends.iter().any(is_half) {
        return false;
    }
    // skeleton pixels lie up to half a pixel beside the middle, hence `pen + 0.5` below;
    // between curved sides the point is longer, but it thins out all along
    let tapers = median(&graph.branches[end.0].radii) < 0.85 * pen;
    let most = if tapers { 7.0 * pen } else { 0.0 };
    // either may tell
    WINDOWS.into_iter().any(|window| {
        let others = ends.iter().filter(|&&e| e != end).map(|&e| leaving(graph, e, node.at, window));
        let others: Vec<Vec2> = others.collect();
        let back = -(others[0] + others[1]);
        let s = sin(0.5 * angle(others[0], others[1]).abs());
        let inside = (pen + 0.5) * (1.0 - s) / (s * (1.0 + s)).max(0.05);
        // a nub goes on straight as one of the two, the point of a corner as neither
        let straight = |other: &&Vec2| out.dot(**other) < -GOES_ON * out.hypot();
        let is_nub = others.iter().filter(straight).count() == 1;
        let beyond = if is_nub { (pen + 1.0 - radius).clamp(0.0, pen + 0.5) } else { pen + 0.5 };
        let length = inside + beyond / s.max(0.1);
        let midway =
            out.dot(back) > GOES_ON * out.hypot() * back.hypot() && !is_bent(&graph.branches[end.0].points);
        s < MITRED && midway && out.hypot() < (1.25 * length + (1.0 + pen).min(2.5)).max(most)
    })
}

/// Whether a branch goes on straight beyond its node as another one: both are halves of the bar of a small letter, too short for
/// their width to tell. The point of a corner leads midway between its sides.
fn is_other_half(graph: &Graph, (spur, end): (usize, usize), (other, from): (usize, usize)) -> bool {
    if !graph.is_letter() {
        return false;
    }
    let (spur, other) = (&graph.branches[spur], &graph.branches[other]);
    if spur.points.is_empty() || other.points.len() < 2 {
        return false;
    }
    let on =
        |branch: &Branch, end, most| from_end(&branch.points, end).take(most).copied().collect::<Vec<_>>();
    let (half, rest) = (on(spur, end, spur.points.len()), on(other, from, spur.points.len().max(HALF)));
    let (Some(&tip), Some(&far)) = (half.last(), rest.last()) else { return false };
    let along = (tip - far) / tip.distance(far).max(1e-9);
    let off = |p: &Point| (*p - far).cross(along).abs();
    half.iter().chain(&rest).all(|p| off(p) < STRAIGHT_PX)
}

/// Points of the other half that are looked at, and how far they may be off a straight line, px.
const HALF: usize = 4;
const STRAIGHT_PX: f64 = 0.5;

/// Cosine of the most by which a line bends that goes on straight: 25°.
const GOES_ON: f64 = 0.9;

/// Whether a branch, by its pixels, bends more than skeletons of points do.
pub(crate) fn is_bent(pixels: &[Point]) -> bool {
    let [first, .., last] = pixels else { return false };
    polyline_length(pixels) > BENT * first.distance(*last) + 4.0
}

/// Skeletons go from pixel to pixel, up to 8 % longer than what they follow.
const BENT: f64 = 1.15;

/// Keeps where the pen turned, if a spur that goes leads there. Lines that meet at less than a mitre is drawn for meet nowhere
/// in particular.
fn keep_turn(graph: &mut Graph, at_nodes: &[Vec<(usize, usize)>], spur: usize, pen: f64) {
    let branch = &graph.branches[spur];
    let end = usize::from(branch.nodes[0].is_none());
    let Some((node, tip, radius)) = free_end(graph, (spur, end)) else { return };
    let Some(number) = branch.nodes[end] else { return };
    let n = branch.points.len();
    let back = if end == 0 { n.saturating_sub(LEADING) } else { LEADING.min(n) - 1 };
    let from = if n >= LEADING { branch.points[back] } else { node.at };
    let along = (tip - from) / (tip - from).hypot().max(1e-9);
    let turn = tip + along * (radius - pen);
    let far = along.dot(turn - node.at);
    // what blur and the node's own disc cover needs no turn
    if far <= LEAST_TURN * pen + 1.0 {
        return;
    }
    let ends = &at_nodes[number];
    let acute = WINDOWS.into_iter().any(|window| half_angle_sine(graph, ends, (spur, end), window) < ACUTE);
    // a pen's round end is where it turned; a point that tapers was drawn as the corner of both sides
    let corner_px = match (acute, radius < BLUNT * pen) {
        (true, _) => 0.0,
        (_, true) => f64::INFINITY,
        _ => pen,
    };
    graph.nodes[number].turn = Some(TurnTip { at: turn, corner_px, is_near: far <= FAR_TURN * pen + 1.0 });
}

/// Sine of half the angle between the two other branches at a spur's node.
fn half_angle_sine(
    graph: &Graph,
    ends: &[(usize, usize)],
    spur: (usize, usize),
    window: (usize, usize),
) -> f64 {
    let Some(node) = graph.branches[spur.0].nodes[spur.1].map(|n| graph.nodes[n].at) else { return 1.0 };
    let others: Vec<Vec2> =
        ends.iter().filter(|&&e| e != spur).map(|&e| leaving(graph, e, node, window)).collect();
    let [a, b] = others[..] else { return 1.0 };
    sin(0.5 * angle(a, b).abs())
}

/// Near an acute corner the two skeletons lean together, far from it they may have bent: points of them, from and to.
const WINDOWS: [(usize, usize); 2] = [(0, 10), (12, 36)];

/// A spur whose end is as wide as this, half pen widths, ends as a pen does.
const BLUNT: f64 = 0.7;
/// Sine of half the least angle of a mitre: sharper corners are cut off (SVG's limit of 4).
const ACUTE: f64 = 0.25;

/// Points of a spur that tell where it leads.
const LEADING: usize = 6;
/// A turn is this far from its fork, half pen widths: nearer than that even a short side of a corner is seen. To where it is a far one,
/// most are corners, whose sides tell where they meet.
const LEAST_TURN: f64 = 0.7;
const FAR_TURN: f64 = 3.0;

/// Whether a branch is as wide as the pen beyond the ink of its node, and stays so: a line's. Over a corner's point the
/// two sides' ink is one, wider than the pen, and runs out.
fn is_line(branch: &Branch, node: Point, pen: f64) -> bool {
    let rows = branch.points.iter().zip(&branch.radii);
    let radii: Vec<f64> =
        rows.filter(|(p, _)| p.distance(node) > 1.3 * pen + 0.5).map(|(_, &radius)| radius).collect();
    let long = radii.len() as f64 > (1.5 * pen).max(4.0);
    let (first, second) = radii.split_at(radii.len() / 2);
    let (one, other) = (median(first), median(second));
    long && (0.75..1.25).contains(&(median(&radii) / pen)) && one.min(other) > 0.8 * one.max(other)
}

/// Sine of half the widest angle at which a corner's point is long enough to show: 150°.
const MITRED: f64 = 0.966;

/// Direction in which a branch leaves its node, between two of its points; over all of a short one.
fn leaving(graph: &Graph, (branch, end): (usize, usize), node: Point, (near, far): (usize, usize)) -> Vec2 {
    let points = &graph.branches[branch].points;
    let at = |k: usize| points[if end == 0 { k } else { points.len() - 1 - k }];
    let far = (points.len() - 1).min(far);
    let way = if near > 0 && far >= near + 8 { at(far) - at(near) } else { at(far) - node };
    way / way.hypot().max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn branch(length: i32, direction: (f64, f64), radius: f64, nodes: [Option<usize>; 2]) -> Branch {
        let at = |i: i32| Point::new(50.0 + f64::from(i) * direction.0, 50.0 + f64::from(i) * direction.1);
        let points: Vec<Point> = (1..=length).map(at).collect();
        Branch { radii: vec![radius; points.len()], points, nodes, ring: false, turns: Vec::new() }
    }

    fn pruned(branches: Vec<Branch>) -> Graph {
        pruned_on(&Plane::filled(100, 100, 255), branches)
    }

    fn pruned_on(dark: &Plane<u8>, branches: Vec<Branch>) -> Graph {
        let node = Node { at: Point::new(50.0, 50.0), radius: 3.0, turn: None };
        let mut graph = Graph { nodes: vec![node], branches };
        prune(&mut graph, dark);
        graph
    }

    #[test]
    fn a_bump_goes_and_leaves_one_line() {
        let n = [Some(0), None];
        let graph = pruned(vec![
            branch(30, (1.0, 0.0), 2.5, n),
            branch(30, (-1.0, 0.0), 2.5, n),
            branch(2, (0.0, 1.0), 1.0, n),
        ]);
        assert_eq!(graph.branches.len(), 1);
        assert_eq!(graph.branches[0].points.len(), 61);
        assert_eq!(graph.branches[0].length(), 60.0);
    }

    #[test]
    fn the_point_of_a_mitred_corner_goes() {
        let n = [Some(0), None];
        let (c, s) = (0.866, 0.5);
        let legs = || vec![branch(30, (c, s), 2.5, n), branch(30, (c, -s), 2.5, n)];
        let with = |stub| pruned([legs(), vec![stub]].concat()).branches.len();
        assert_eq!(with(branch(6, (-1.0, 0.0), 1.5, n)), 1);
        assert_eq!(with(branch(14, (-1.0, 0.0), 2.5, n)), 3);
        assert_eq!(with(branch(6, (0.0, 1.0), 2.5, n)), 3);
    }

    #[test]
    fn a_short_bar_stays() {
        let n = [Some(0), None];
        let graph = pruned(vec![
            branch(30, (1.0, 0.0), 2.5, n),
            branch(30, (-1.0, 0.0), 2.5, n),
            branch(6, (0.0, 1.0), 2.5, n),
        ]);
        assert_eq!(graph.branches.len(), 3);
    }

    #[test]
    fn a_whisker_at_a_lines_edge_goes_and_a_third_line_stays() {
        let n = [Some(0), None];
        let line = || vec![branch(30, (1.0, 0.0), 2.5, n), branch(30, (-1.0, 0.0), 2.5, n)];
        let left = |dark: &Plane<u8>, length, radius| {
            pruned_on(dark, [line(), vec![branch(length, (0.2, 0.98), radius, n)]].concat()).branches.len()
        };
        let even = Plane::filled(100, 100, 255);
        assert_eq!((left(&even, 8, 0.9), left(&even, 14, 0.9), left(&even, 8, 2.0)), (1, 3, 3));
        // as pale as a crumb it goes up to a crumb's length
        let mut pale = even;
        (52..100).for_each(|y| pale.row_mut(y).fill(120));
        assert_eq!((left(&pale, 14, 1.2), left(&pale, 14, 2.0), left(&pale, 26, 1.2)), (1, 3, 3));
    }
}
