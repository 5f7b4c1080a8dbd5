use kurbo::Point;

use super::kdtree::{Gather, KdTree};
use super::ports::Ports;

/// A length no order can travel less than: the larger of two bounds.
///
/// - The travels join the start and all strokes, so they are at least as long as the shortest tree that does, each
///   stroke shrunk to one knot.
/// - Every end but the last one is one side of a travel, which is at least as long as the way to the nearest port
///   of another stroke. Each travel has two sides.
pub(super) fn lower_bound(ports: &Ports, start: Point) -> f64 {
    let mut points = ports.points.clone();
    let mut knot = ports.stroke.clone();
    points.push(start);
    knot.push(ports.strokes() as u32);
    let tree = KdTree::new(&points);
    let nearest = nearest_strangers(&tree, &points, &knot);
    half_links(ports, &nearest).max(spanning_tree(&tree, &points, &knot, nearest))
}

/// The second bound of [`lower_bound`].
fn half_links(ports: &Ports, nearest: &[Link]) -> f64 {
    let length = |port: u32| nearest[port as usize].length();
    let mut sum = nearest.last().map_or(0.0, Link::length);
    let mut longest = 0.0_f64;
    for stroke in 0..ports.strokes() as u32 {
        let range = ports.range(stroke);
        let shortest = range.clone().map(length).fold(f64::INFINITY, f64::min);
        let far = range.clone().map(length).fold(0.0, f64::max);
        let closed = ports.is_closed(stroke);
        sum += if closed { 2.0 * shortest } else { range.map(length).sum() };
        longest = longest.max(if closed { shortest } else { far });
    }
    (0.5 * (sum - longest)).max(0.0)
}

/// A way from a port to one of another knot.
#[derive(Clone, Copy)]
struct Link {
    distance_sq: f64,
    to: Option<u32>,
}

impl Link {
    const NONE: Link = Link { distance_sq: f64::INFINITY, to: None };

    fn length(&self) -> f64 {
        self.to.map_or(0.0, |_| self.distance_sq.sqrt())
    }
}

/// From every point to the nearest one of another knot.
fn nearest_strangers(tree: &KdTree, points: &[Point], knot: &[u32]) -> Vec<Link> {
    let uniform = uniform_nodes(tree, knot);
    let of = |(i, &at): (usize, &Point)| {
        let mut search = Stranger { label: knot, uniform: &uniform, own: knot[i], best: Link::NONE };
        tree.search(at, &mut search);
        search.best
    };
    points.iter().enumerate().map(of).collect()
}

/// Length of the shortest tree over knots: Borůvka's rounds, each joining every component to its nearest other one.
/// Nearest points come from the tree of boxes, skipping boxes that lie in the component as a whole (March, Ram &
/// Gray, "Fast Euclidean minimum spanning tree", 2010).
fn spanning_tree(tree: &KdTree, points: &[Point], knot: &[u32], first: Vec<Link>) -> f64 {
    let mut label = knot.to_vec();
    let mut known = first;
    let mut length = 0.0;
    loop {
        let cheapest = cheapest_links(tree, points, &label, &mut known);
        let mut forest = Forest::new(label.iter().max().map_or(0, |&m| m as usize + 1));
        let mut joined = false;
        for (component, &(from, link)) in cheapest.iter().enumerate() {
            let Some(to) = link.to else { continue };
            debug_assert_eq!(label[from as usize] as usize, component);
            if forest.unite(label[from as usize], label[to as usize]) {
                length += link.distance_sq.sqrt();
                joined = true;
            }
        }
        if !joined {
            return length;
        }
        label.iter_mut().for_each(|l| *l = forest.root(*l));
    }
}

/// For every component the shortest link that leaves it, and the point it leaves from. `known` keeps each point's
/// nearest stranger: it stays the answer until it joins the same component.
fn cheapest_links(tree: &KdTree, points: &[Point], label: &[u32], known: &mut [Link]) -> Vec<(u32, Link)> {
    let components = label.iter().max().map_or(0, |&m| m as usize + 1);
    let uniform = uniform_nodes(tree, label);
    let mut cheapest = vec![(0, Link::NONE); components];
    for (i, &at) in points.iter().enumerate() {
        let own = label[i];
        let best = &mut cheapest[own as usize];
        // a link inside the component is a lower bound of the one that leaves it
        if known[i].distance_sq >= best.1.distance_sq {
            continue;
        }
        if known[i].to.is_none_or(|to| label[to as usize] == own) {
            let limit = Link { to: None, ..best.1 };
            let mut search = Stranger { label, uniform: &uniform, own, best: limit };
            tree.search(at, &mut search);
            // nothing nearer than the limit: the limit is what is known of this point now
            known[i] = search.best;
        }
        if known[i].to.is_some() && known[i].distance_sq < best.1.distance_sq {
            *best = (i as u32, known[i]);
        }
    }
    cheapest
}

/// For every node the label all its points share, if they do.
fn uniform_nodes(tree: &KdTree, label: &[u32]) -> Vec<Option<u32>> {
    let leaf = |points: &[u32]| {
        let first = points.first().map(|&p| label[p as usize])?;
        points.iter().all(|&p| label[p as usize] == first).then_some(first)
    };
    tree.fold(leaf, |a, b| if a == b { a } else { None })
}

struct Stranger<'a> {
    label: &'a [u32],
    uniform: &'a [Option<u32>],
    own: u32,
    best: Link,
}

impl Gather for Stranger<'_> {
    fn wants(&self, node: usize, distance_sq: f64) -> bool {
        // asked this way round, a point that is not a number is still found
        let no_nearer = distance_sq >= self.best.distance_sq;
        !no_nearer && self.uniform[node] != Some(self.own)
    }

    fn offer(&mut self, point: u32, distance_sq: f64) {
        if self.label[point as usize] != self.own && distance_sq < self.best.distance_sq {
            self.best = Link { distance_sq, to: Some(point) };
        }
    }
}

/// Disjoint sets with path halving (Tarjan & van Leeuwen, 1984).
struct Forest(Vec<u32>);

impl Forest {
    fn new(len: usize) -> Self {
        Self((0..len as u32).collect())
    }

    fn root(&mut self, mut of: u32) -> u32 {
        while self.0[of as usize] != of {
            let above = self.0[self.0[of as usize] as usize];
            self.0[of as usize] = above;
            of = above;
        }
        of
    }

    /// Joins two sets; whether they were two.
    fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
        a != b
    }
}
