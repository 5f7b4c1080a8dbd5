//! Decides at junctions which lines continue through one another and which end.
//!
//! A skeleton is bent where lines meet: a crossing becomes two forks with a bridge, a T pulls its bar aside. So the
//! ink about a junction is not used. The lines are carried on into it from outside, and those that carry on into
//! each other are joined.

use std::f64::consts::PI;

use tracelight_image::Plane;
use tracelight_stroke::{Point, polyline_length};

use crate::bow::Bow;
use crate::bridge::{Tip, from_end, inked_towards, meeting};
use crate::graph::{Graph, Node};
use crate::line::{Line, off_the_grid};

/// A pair of lines that turns less than this from one into the other is one line passing through, rad (60°).
const THROUGH: f64 = PI / 3.0;
/// A pair that turns more than this is not joined: it would go back on itself, rad (165°).
const BACK: f64 = 165.0 * PI / 180.0;

/// Longest common parts of two crossing lines, pen widths, and by how much the lines may bend on the way over, rad: that of a
/// crossing at 15° by 40°, that of one at 3° by 10°.
const CROSSINGS: [(f64, f64); 2] = [(6.0, 40.0 * PI / 180.0), (32.0, 10.0 * PI / 180.0)];

/// Where more lines than this meet, no pen drew them through: texture, not a drawing.
const MOST_PORTS: usize = 32;

/// An end of a line at a junction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Port {
    pub(crate) line: usize,
    pub(crate) end: usize,
    /// Its direction leads into the junction.
    tip: Tip,
}

impl Port {
    /// By how much a line would have to leave its own curve to get from this port to another; see [`Bow::misfit`]. Its tips lean
    /// to the ink that is shared, and its bows may have bent otherwise before: both are asked.
    fn misfit(&self, other: &Self, lines: &[Line]) -> f64 {
        let tips = self.tip.misfit(&other.tip);
        self.misfit_of_bows(other, lines).map_or(tips, |bows| 0.5 * (tips + bows))
    }

    /// Measures the misfit of the bows further from the junction; `None` if one of the lines has none.
    fn misfit_of_bows(&self, other: &Self, lines: &[Line]) -> Option<f64> {
        let bow = |port: &Self| {
            let line = &lines[port.line];
            Bow::of(&line.points, port.end, line.width)
        };
        Some(bow(self)?.misfit(&bow(other)?))
    }
}

/// Two ports made one, with the points between them.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) ports: [Port; 2],
    /// From the first port's line to the second's, without their own points.
    pub(crate) bridge: Vec<Point>,
}

/// What became of the lines at the junctions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Junctions {
    pub(crate) joints: Vec<Joint>,
    /// Ports that end there, each with the way to the place where.
    pub(crate) ends: Vec<(Port, Vec<Point>)>,
}

/// Nodes whose discs of ink nearly touch and are bridged are one junction: the cluster of each node, and which branches
/// are bridges; `bars` are none.
pub(crate) fn clusters(graph: &Graph, bars: &[usize]) -> (Vec<usize>, Vec<bool>) {
    let mut cluster: Vec<usize> = (0..graph.nodes.len()).collect();
    let pen = graph.pen_radius();
    let is_bridge = |branch: &crate::graph::Branch| {
        let [Some(a), Some(b)] = branch.nodes else { return false };
        let Node { radius, at, .. } = graph.nodes[a];
        let reach = radius + graph.nodes[b].radius + pen;
        // a way round between the same two nodes is no bridge, however near they are
        at.distance(graph.nodes[b].at) <= reach && branch.length() <= 1.3 * reach
    };
    let mut bridges: Vec<bool> = graph.branches.iter().map(is_bridge).collect();
    bars.iter().for_each(|&bar| bridges[bar] = false);
    open_rings(graph, &mut bridges, pen);
    for (branch, _) in graph.branches.iter().zip(&bridges).filter(|(_, bridge)| **bridge) {
        if let [Some(a), Some(b)] = branch.nodes {
            let (a, b) = (root(&mut cluster, a), root(&mut cluster, b));
            cluster[a.max(b)] = a.min(b);
        }
    }
    // roots come before what hangs on them, so that one pass shortens every way
    (0..cluster.len()).for_each(|n| cluster[n] = cluster[cluster[n]]);
    (cluster, bridges)
}

/// Paper that is as wide as so many pens, and no crumb of so many px either way from its middle, is no crossing's own: what goes round
/// it is a line.
const RING_PENS: f64 = 1.0;
const RING_PX: f64 = 1.5;
/// Unless it is a slit between two strands: round that circle it is this share as far as round it. A square's is 0.79, a triangle's 0.6.
const ROUND: f64 = 0.6;

/// Bridges that go round paper are none: of a wheel's spokes none leads on over its hub's hole.
fn open_rings(graph: &Graph, bridges: &mut [bool], pen_radius: f64) {
    for ring in rings(graph, bridges) {
        let way = ring.iter().flat_map(|&(branch, forward)| way_along(graph, branch, forward));
        let way: Vec<Point> = way.collect();
        let sides = || way.iter().zip(way.iter().cycle().skip(1));
        let area = 0.5 * sides().map(|(a, b)| a.to_vec2().cross(b.to_vec2())).sum::<f64>().abs();
        let length: f64 = sides().map(|(a, b)| a.distance(*b)).sum();
        // the radius of the circle that all sides touch, for a ring like that
        let radius = 2.0 * area / length;
        let is_round = 2.0 * PI * radius >= ROUND * length;
        if is_round && radius - pen_radius > (RING_PENS * pen_radius).max(RING_PX) {
            ring.iter().for_each(|&(branch, _)| bridges[branch] = false);
        }
    }
}

/// A branch's places with that of the node that it leaves.
fn way_along(graph: &Graph, branch: usize, forward: bool) -> Vec<Point> {
    let branch = &graph.branches[branch];
    let mut way = branch.points.clone();
    if !forward {
        way.reverse();
    }
    let from = branch.nodes[usize::from(!forward)].map(|node| graph.nodes[node].at);
    from.into_iter().chain(way).collect()
}

/// The ways round along bridges that nothing else of them leads to: branches with whether they are gone along from their first point.
fn rings(graph: &Graph, bridges: &[bool]) -> Vec<Vec<(usize, bool)>> {
    let mut ends = graph.ends_at_nodes();
    ends.iter_mut().for_each(|at| at.retain(|&(branch, _)| bridges[branch]));
    // what leads nowhere is in no ring
    let mut bare: Vec<usize> = (0..ends.len()).filter(|&node| ends[node].len() == 1).collect();
    while let Some(node) = bare.pop() {
        let Some((branch, end)) = ends[node].pop() else { continue };
        let Some(far) = graph.branches[branch].nodes[1 - end] else { continue };
        ends[far].retain(|&(other, _)| other != branch);
        if ends[far].len() == 1 {
            bare.push(far);
        }
    }
    let (mut found, mut seen) = (Vec::new(), vec![false; bridges.len()]);
    for start in 0..ends.len() {
        let (mut ring, mut node) = (Vec::new(), start);
        while ends[node].len() == 2
            && let Some(&(branch, end)) = ends[node].iter().find(|(branch, _)| !seen[*branch])
            && let Some(far) = graph.branches[branch].nodes[1 - end]
        {
            seen[branch] = true;
            ring.push((branch, end == 0));
            node = far;
        }
        if !ring.is_empty() && node == start {
            found.push(ring);
        }
    }
    found
}

/// Two lines that cross at an acute angle run together for a while: the skeleton has two forks and one line between
/// them. Such lines are taken away and their ends made one junction.
pub(crate) fn merge_acute(lines: &mut Vec<Line>, cluster: &mut [usize]) {
    let mut ports = ports(lines, cluster);
    let mut joined: Vec<usize> = (0..cluster.len()).collect();
    let mut gone = vec![false; lines.len()];
    for (number, line) in lines.iter().enumerate() {
        let [Some(a), Some(b)] = line.nodes else { continue };
        let (a, b) = (root(&mut joined, cluster[a]), root(&mut joined, cluster[b]));
        let pens = line.length() / line.width;
        let most = CROSSINGS.iter().find(|(longest, _)| pens < *longest).map(|(_, most)| *most);
        if a != b && most.is_some_and(|most| is_acute(number, (&ports[a], &ports[b]), most, &lines[..])) {
            gone[number] = true;
            joined[b] = a;
            let moved = std::mem::take(&mut ports[b]);
            ports[a].extend(moved);
            ports[a].retain(|p| p.line != number);
        }
    }
    cluster.iter_mut().for_each(|c| *c = root(&mut joined, *c));
    let mut gone = gone.into_iter();
    lines.retain(|_| gone.next() == Some(false));
}

/// The first of those joined with `n`.
fn root(joined: &mut [usize], mut n: usize) -> usize {
    while joined[n] != n {
        joined[n] = joined[joined[n]]; // halves the way for the next one
        n = joined[n];
    }
    n
}

/// Whether a line between two junctions of three only is the common part of two that cross there.
fn is_acute(number: usize, (from, to): (&[Port], &[Port]), most: f64, lines: &[Line]) -> bool {
    let others = |at: &[Port]| at.iter().filter(|p| p.line != number).copied().collect::<Vec<Port>>();
    let (before, after) = (others(from), others(to));
    let ([p, q], [r, s]) = (&before[..], &after[..]) else { return false };
    p.tip.crosses(&r.tip, &q.tip, &s.tip, most)
        || p.tip.crosses(&s.tip, &q.tip, &r.tip, most)
        || touch((p, r), (q, s), lines)
        || touch((p, s), (q, r), lines)
}

/// Whether two lines that share ink for a while both bend on there as before.
fn touch((a, b): (&Port, &Port), (c, d): (&Port, &Port), lines: &[Line]) -> bool {
    let fits = |a: &Port, b: &Port| {
        a.misfit(b, lines) < TOUCHING || a.misfit_of_bows(b, lines).is_some_and(|bows| bows < TOUCHING)
    };
    fits(a, b) && fits(c, d)
}

/// Two lines that touch leave their own curves by less than this over their common ink; see [`Bow::misfit`].
const TOUCHING: f64 = 0.12;
/// A line bends by less than this over the ink that it shares: as a small ring does that touches a larger one, rad (100°).
const AROUND: f64 = 100.0 * PI / 180.0;
/// Of two ways to pair four lines the one is taken that leaves their curves so much less.
const CLEARLY: f64 = 0.7;

/// The pairs of four ports of two lines that touch or cross at a few degrees: those whose lines leave their own curves least. `None`
/// where they meet at an angle, which is clearer.
fn bent_on(ports: &[Port], lines: &[Line]) -> Option<[(usize, usize); 2]> {
    let [a, b, c, d] = ports else { return None };
    let ways = [
        ((a, b), (c, d), [(0, 1), (2, 3)]),
        ((a, c), (b, d), [(0, 2), (1, 3)]),
        ((a, d), (b, c), [(0, 3), (1, 2)]),
    ];
    let mut likely: Vec<(f64, [(usize, usize); 2])> = ways
        .into_iter()
        .filter(|((p, q), (r, s), _)| p.tip.bend(&q.tip).max(r.tip.bend(&s.tip)) < AROUND)
        .map(|((p, q), (r, s), pairs)| (p.misfit(q, lines) + r.misfit(s, lines), pairs))
        .collect();
    likely.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [first, second, ..] = &likely[..] else { return None };
    (first.0 < CLEARLY * second.0).then_some(first.1)
}

/// The ends of lines at each cluster.
fn ports(lines: &[Line], cluster: &[usize]) -> Vec<Vec<Port>> {
    let mut ports: Vec<Vec<Port>> = vec![Vec::new(); cluster.len()];
    for (number, line) in lines.iter().enumerate() {
        for (end, node) in line.nodes.iter().enumerate() {
            if let Some(node) = node {
                ports[cluster[*node]].push(Port { line: number, end, tip: line.tip(end) });
            }
        }
    }
    ports
}

/// Joins the lines of a graph at its junctions.
pub(crate) fn join(dark: &Plane<u8>, lines: &[Line], cluster: &[usize]) -> Junctions {
    let mut junctions = Junctions::default();
    ports(lines, cluster)
        .into_iter()
        .filter(|p| !p.is_empty())
        .for_each(|p| junctions.resolve(dark, p, lines));
    junctions
}

impl Junctions {
    /// Points along all ways through the junctions, about 1 px apart.
    pub(crate) fn ways(&self) -> Vec<Point> {
        let mut ways: Vec<Point> = self.joints.iter().flat_map(|joint| &joint.bridge).copied().collect();
        for (Port { tip, .. }, way) in &self.ends {
            let from = std::iter::once(&tip.at).chain(way);
            for (from, to) in from.zip(way) {
                let steps = from.distance(*to).ceil().max(1.0) as u32;
                ways.extend((0..=steps).map(|k| from.lerp(*to, f64::from(k) / f64::from(steps))));
            }
        }
        ways
    }

    /// One junction: the straightest pairs first, then any two that are left.
    fn resolve(&mut self, dark: &Plane<u8>, mut left: Vec<Port>, lines: &[Line]) {
        if left.len() > MOST_PORTS {
            self.ends.extend(left.into_iter().map(|p| (p, vec![p.tip.at])));
            return;
        }
        let tips: Vec<Tip> = left.iter().map(|p| p.tip).collect();
        let middle = meeting(&tips);
        let first = self.joints.len();
        if let Some([(a, b), (c, d)]) = bent_on(&left, lines) {
            let four = std::mem::take(&mut left);
            for (a, b) in [(four[a], four[b]), (four[c], four[d])] {
                // what bends on has no corner there
                let bridge = a.tip.smoothly_to(&b.tip);
                self.joints.push(Joint { ports: [a, b], bridge });
            }
        }
        for most in [THROUGH, BACK] {
            while let Some((i, j)) = straightest(&left, most) {
                let (b, a) = (left.remove(j), left.remove(i));
                let others: Vec<Point> =
                    self.joints[first..].iter().flat_map(|j| &j.bridge).copied().collect();
                let bridge = a.tip.bridge(&b.tip, dark, &others);
                self.joints.push(Joint { ports: [a, b], bridge });
            }
        }
        for port in left {
            let hits = self.joints[first..].iter().filter_map(|joint| hit(&port, joint, lines));
            let stop =
                hits.chain(middle).min_by(|a, b| a.distance(port.tip.at).total_cmp(&b.distance(port.tip.at)));
            let line = &lines[port.line];
            let straight = stop.map(|stop| (stop, inked_towards(dark, port.tip.at, stop, line.width)));
            let way = match straight {
                Some((stop, end)) if stop == end => vec![end],
                _ => self
                    .round(first, lines, &port)
                    .or(straight.map(|(_, end)| vec![end]))
                    .unwrap_or(vec![port.tip.at]),
            };
            self.ends.push((port, way));
        }
    }

    /// The way of a port along its skeleton to the nearest place on the joints from number `first` on: where a line bends in the
    /// ink that it shares with another, and carried straight on would miss it. `None` where it is hardly hidden.
    fn round(&self, first: usize, lines: &[Line], port: &Port) -> Option<Vec<Point>> {
        let line = &lines[port.line];
        let pixels = &line.lost[port.end];
        if polyline_length(pixels) < HIDDEN_PENS * line.width {
            return None;
        }
        let node = *pixels.last()?;
        let rows = self.joints[first..].iter().flat_map(|joint| row_of(joint, lines));
        let place = rows.min_by(|a, b| a.distance_squared(node).total_cmp(&b.distance_squared(node)))?;
        // no further than it is from where the ink is shared
        let own = pixels.iter().position(|p| p.distance(place) <= 0.5 * line.width).unwrap_or(pixels.len());
        Some(off_the_grid(&pixels[..own]).chain([place]).collect())
    }
}

/// A line that is hidden for less than this, in its own pens, is carried straight on.
const HIDDEN_PENS: f64 = 1.0;
/// The pair of ports that bends least on the way from one to the other, if less than `most`.
fn straightest(ports: &[Port], most: f64) -> Option<(usize, usize)> {
    let pairs = (0..ports.len()).flat_map(|i| (i + 1..ports.len()).map(move |j| (i, j)));
    let bends = pairs.map(|(i, j)| (ports[i].tip.bend(&ports[j].tip), i, j));
    let best = bends.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|b| b.0 < most)?;
    Some((best.1, best.2))
}

/// Where a port carried straight on hits a joint's line.
fn hit(port: &Port, joint: &Joint, lines: &[Line]) -> Option<Point> {
    row_of(joint, lines).windows(2).find_map(|w| {
        let (across, back) = (w[1] - w[0], port.tip.at - w[0]);
        let cross = port.tip.along.cross(across);
        let (ahead, share) = (-back.cross(across) / cross, port.tip.along.cross(back) / cross);
        (cross.abs() > 1e-9 && ahead > -1.0 && (0.0..=1.0).contains(&share))
            .then(|| port.tip.at + port.tip.along * ahead)
    })
}

/// The points of a joint, and of its two lines near it.
fn row_of(joint: &Joint, lines: &[Line]) -> Vec<Point> {
    let [a, b] = joint.ports;
    let mut row = near_tip(&lines[a.line], a.end);
    row.reverse();
    row.extend(&joint.bridge);
    row.extend(near_tip(&lines[b.line], b.end));
    row
}

/// Up to 12 points of a line from one end on.
fn near_tip(line: &Line, end: usize) -> Vec<Point> {
    from_end(&line.points, end).take(12).copied().collect()
}
