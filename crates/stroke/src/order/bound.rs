use kurbo::{Point, Rect};

use super::ascent::Ascent;
use super::forest::Forest;
use super::kdtree::{Gather, KdTree};
use super::ports::Ports;

/// A length no order can travel less than: the largest of four bounds.
///
/// - The travels join the start and all strokes, so they are at least as long as the shortest tree that does, each
///   stroke shrunk to one knot.
/// - Every end but the last one is one side of a travel, which is at least as long as the way to the nearest port
///   of another stroke. Each travel has two sides.
/// - Where an odd number of ends meet, a travel has to lead elsewhere, to another such place in the end
///   ([`odd_places`]).
/// - Of a tree whose ends have other degrees than a route's, the ends can be taxed: π is added to every link of an
///   end with too many and taken off one with too few. A route pays every tax a known number of times, so what the
///   shortest taxed tree costs less these taxes bounds it too (Held & Karp, "The traveling-salesman problem and
///   minimum spanning trees", 1970; for strokes as here, the taxes belong to ends). Whatever the taxes, the bound
///   holds; `rounds` of ascent make them good.
pub(super) fn lower_bound(ports: &Ports, start: Point, rounds: usize) -> f64 {
    let mut points = ports.points.clone();
    let mut knot = ports.stroke.clone();
    points.push(start);
    knot.push(ports.strokes() as u32);
    let tree = KdTree::new(&points);
    let untaxed = vec![0.0; points.len()];
    let knots = Knots { tree: &tree, points: &points, knot: &knot, tax: &untaxed };
    let nearest = knots.nearest_strangers();
    let links = half_links(ports, &nearest);
    let shortest = knots.spanning_tree(nearest);
    let mut bound = links.max(shortest.cost).max(odd_places(ports, start));
    let mut ascent = Ascent::new(ports, &tree, &points, &knot);
    let mut links = shortest.links;
    for part in [rounds - rounds / 4, rounds / 4] {
        // the ascent sees short links only; those of the last tree that it did not see are added
        ascent.add(&points, links);
        ascent.climb(part, rounds);
        let tax = ascent.taxes();
        let knots = Knots { tax: &tax, ..knots };
        let taxed = knots.spanning_tree(knots.nearest_strangers());
        bound = bound.max(taxed.cost - ascent.paid());
        links = taxed.links;
    }
    bound
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

/// Bound from places where an odd number of ends meet, as at the junctions of a net of lines: all travels together,
/// but those from a place to itself, pair such places up, so that each pays half the way to the nearest other one at
/// least. The last stroke's end, which nothing leaves, saves one place this, or adds one.
fn odd_places(ports: &Ports, start: Point) -> f64 {
    let open = (0..ports.strokes() as u32).filter(|&stroke| !ports.is_closed(stroke));
    let mut ends: Vec<Point> = open.flat_map(|s| ports.range(s)).map(|p| ports.points[p as usize]).collect();
    ends.push(start);
    ends.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let odd: Vec<Point> =
        ends.chunk_by(|a, b| a == b).filter(|place| place.len() % 2 == 1).map(|p| p[0]).collect();
    let own: Vec<u32> = (0..odd.len() as u32).collect();
    let tree = KdTree::new(&odd);
    let untaxed = vec![0.0; odd.len()];
    let knots = Knots { tree: &tree, points: &odd, knot: &own, tax: &untaxed };
    let ways: Vec<f64> = knots.nearest_strangers().iter().map(Link::length).collect();
    let longest = ways.iter().copied().fold(0.0, f64::max);
    0.5 * (ways.iter().sum::<f64>() - longest)
}

/// A way from a port to one of another knot, and what it costs: its length and the taxes of both ends.
#[derive(Clone, Copy)]
struct Link {
    cost: f64,
    to: Option<u32>,
}

impl Link {
    const NONE: Link = Link { cost: f64::INFINITY, to: None };

    fn length(&self) -> f64 {
        self.to.map_or(0.0, |_| self.cost)
    }
}

/// A tree over all knots.
#[derive(Default)]
struct Tree {
    cost: f64,
    links: Vec<[u32; 2]>,
}

/// Points that belong to knots and are taxed.
#[derive(Clone, Copy)]
struct Knots<'a> {
    tree: &'a KdTree<'a>,
    points: &'a [Point],
    knot: &'a [u32],
    tax: &'a [f64],
}

impl Knots<'_> {
    /// From every point to the nearest one of another knot.
    fn nearest_strangers(&self) -> Vec<Link> {
        let nodes = self.nodes(self.knot);
        let of = |i: usize| {
            let limit = Link::NONE;
            self.nearest(i, self.knot, &nodes, limit)
        };
        (0..self.points.len()).map(of).collect()
    }

    fn nearest(&self, from: usize, label: &[u32], nodes: &[Node], limit: Link) -> Link {
        let own = label[from];
        let mut search = Stranger { label, nodes, tax: self.tax, own, own_tax: self.tax[from], best: limit };
        self.tree.search(self.points[from], &mut search);
        search.best
    }

    /// Cost of the cheapest tree over knots: Borůvka's rounds, each joining every component to its nearest other
    /// one. Nearest points come from the tree of boxes, skipping boxes that lie in the component as a whole (March,
    /// Ram & Gray, "Fast Euclidean minimum spanning tree", 2010).
    fn spanning_tree(&self, first: Vec<Link>) -> Tree {
        let mut label = self.knot.to_vec();
        let mut known = first;
        let mut tree = Tree::default();
        loop {
            let cheapest = self.cheapest_links(&label, &mut known);
            let mut forest = Forest::new(label.iter().max().map_or(0, |&m| m as usize + 1));
            let mut joined = false;
            for (component, &(from, link)) in cheapest.iter().enumerate() {
                let Some(to) = link.to else { continue };
                debug_assert_eq!(label[from as usize] as usize, component);
                if forest.unite(label[from as usize], label[to as usize]) {
                    tree.cost += link.cost;
                    tree.links.push([from, to]);
                    joined = true;
                }
            }
            if !joined {
                return tree;
            }
            label.iter_mut().for_each(|l| *l = forest.root(*l));
        }
    }

    /// For every component the cheapest link that leaves it, and the point it leaves from. `known` keeps each
    /// point's nearest stranger: it stays the answer until it joins the same component.
    fn cheapest_links(&self, label: &[u32], known: &mut [Link]) -> Vec<(u32, Link)> {
        let components = label.iter().max().map_or(0, |&m| m as usize + 1);
        let nodes = self.nodes(label);
        let mut cheapest = vec![(0, Link::NONE); components];
        for i in 0..self.points.len() {
            let best = &mut cheapest[label[i] as usize];
            // a link inside the component is a lower bound of the one that leaves it
            if known[i].cost >= best.1.cost {
                continue;
            }
            if known[i].to.is_none_or(|to| label[to as usize] == label[i]) {
                // nothing nearer than the limit: the limit is what is known of this point now
                known[i] = self.nearest(i, label, &nodes, Link { to: None, ..best.1 });
            }
            if known[i].to.is_some() && known[i].cost < best.1.cost {
                *best = (i as u32, known[i]);
            }
        }
        cheapest
    }

    /// For every box the label all its points share, if they do, and the lowest tax in it.
    fn nodes(&self, label: &[u32]) -> Vec<Node> {
        let leaf = |points: &[u32]| {
            let first = points.first().map(|&p| label[p as usize]);
            let shared = first.filter(|&first| points.iter().all(|&p| label[p as usize] == first));
            let tax = points.iter().map(|&p| self.tax[p as usize]).fold(f64::INFINITY, f64::min);
            Node { shared, tax }
        };
        let join = |a: Node, b: Node| Node {
            shared: a.shared.filter(|_| a.shared == b.shared),
            tax: a.tax.min(b.tax),
        };
        self.tree.fold(leaf, join)
    }
}

#[derive(Clone, Copy)]
struct Node {
    shared: Option<u32>,
    tax: f64,
}

struct Stranger<'a> {
    label: &'a [u32],
    nodes: &'a [Node],
    tax: &'a [f64],
    own: u32,
    own_tax: f64,
    best: Link,
}

impl Gather for Stranger<'_> {
    fn wants(&self, node: usize, _: &Rect, distance_sq: f64) -> bool {
        let Node { shared, tax } = self.nodes[node];
        // asked this way round, a point that is not a number is still found
        let no_nearer = distance_sq.sqrt() + tax + self.own_tax >= self.best.cost;
        !no_nearer && shared != Some(self.own)
    }

    fn offer(&mut self, point: u32, distance_sq: f64) {
        let cost = distance_sq.sqrt() + self.tax[point as usize] + self.own_tax;
        if self.label[point as usize] != self.own && cost < self.best.cost {
            self.best = Link { cost, to: Some(point) };
        }
    }
}
