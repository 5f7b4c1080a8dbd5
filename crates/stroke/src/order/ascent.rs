use std::collections::HashSet;

use kurbo::{Point, Rect};
use tracelight_maths::powf;

use super::forest::Forest;
use super::kdtree::{Gather, KdTree};
use super::ports::Ports;

/// Links from each end, to the nearest others, among which the ascent looks for trees.
const NEAREST: usize = 6;

/// First step of the taxes, in mean links, and what is left of it after the last round. As in the classical ascents
/// (Volgenant & Jonker, 1982) the last round's excess of links counts too, with a share of 0.3.
const STEP: f64 = 0.3;
const LAST_STEP: f64 = 0.01;
const MEMORY: f64 = 0.3;

/// Subgradient ascent of the taxes on the ends of strokes over the trees of short links. There is one tax for each
/// end of an open stroke, one for all of a closed one, one for the start.
pub(super) struct Ascent<'a> {
    knot: &'a [u32],
    edges: Vec<Edge>,
    known: HashSet<[u32; 2]>,
    tax: Vec<f64>,
    /// The taxes of the round with the best bound, and that bound.
    best: (f64, Vec<f64>),
    /// How many links a route has where a tax is paid.
    degree: Vec<i32>,
    /// Which tax a point pays.
    of_point: Vec<u32>,
    step: f64,
}

/// A link between two points.
struct Edge {
    length: f64,
    ends: [u32; 2],
}

impl<'a> Ascent<'a> {
    /// No taxes yet, on the ports of strokes and one more point, the start.
    pub(super) fn new(ports: &Ports, tree: &KdTree<'_>, points: &[Point], knot: &'a [u32]) -> Self {
        let mut degree = Vec::new();
        let mut of_point = Vec::new();
        for stroke in 0..ports.strokes() as u32 {
            let closed = ports.is_closed(stroke);
            for (number, _) in ports.range(stroke).enumerate() {
                if number == 0 || !closed {
                    degree.push(if closed { 2 } else { 1 });
                }
                of_point.push(degree.len() as u32 - 1);
            }
        }
        of_point.push(degree.len() as u32);
        degree.push(1);
        let tax = vec![0.0; degree.len()];
        let best = (f64::NEG_INFINITY, tax.clone());
        let (edges, known) = (Vec::new(), HashSet::new());
        let mut ascent = Self { knot, edges, known, tax, best, degree, of_point, step: 0.0 };
        ascent.add(points, short_links(tree, points, knot));
        ascent
    }

    /// Adds links to look for trees among.
    pub(super) fn add(&mut self, points: &[Point], links: impl IntoIterator<Item = [u32; 2]>) {
        for [a, b] in links {
            let ends = [a.min(b), a.max(b)];
            if self.known.insert(ends) {
                let length = points[a as usize].distance(points[b as usize]);
                self.edges.push(Edge { length, ends });
            }
        }
        // what was the best among fewer links may be none among more
        self.best.0 = f64::NEG_INFINITY;
    }

    /// The best tax of every point.
    pub(super) fn taxes(&self) -> Vec<f64> {
        self.of_point.iter().map(|&m| self.best.1[m as usize]).collect()
    }

    /// What a route pays at most of these taxes.
    pub(super) fn paid(&self) -> f64 {
        paid(&self.best.1, &self.degree)
    }

    /// Improves the taxes by some of `all` rounds, starting from the best.
    pub(super) fn climb(&mut self, rounds: usize, all: usize) {
        self.tax.clone_from(&self.best.1);
        let mut last_excess = vec![0.0; self.tax.len()];
        for _ in 0..rounds {
            let (cost, degree) = self.cheapest_tree();
            let bound = cost - paid(&self.tax, &self.degree);
            if self.step <= 0.0 {
                self.step = STEP * bound / self.degree.len() as f64;
            }
            if bound > self.best.0 {
                self.best.0 = bound;
                self.best.1.clone_from(&self.tax);
            }
            for (i, tax) in self.tax.iter_mut().enumerate() {
                let excess = f64::from(degree[i] - self.degree[i]);
                *tax += self.step * ((1.0 - MEMORY) * excess + MEMORY * last_excess[i]);
                last_excess[i] = excess;
            }
            self.step *= powf(LAST_STEP, 1.0 / all as f64);
        }
    }

    /// The cheapest taxed tree of the links (Kruskal): its cost, and how many links each tax is paid for.
    fn cheapest_tree(&self) -> (f64, Vec<i32>) {
        let tax = |point: u32| self.of_point[point as usize] as usize;
        let cost = |edge: &Edge| edge.length + self.tax[tax(edge.ends[0])] + self.tax[tax(edge.ends[1])];
        let mut sorted: Vec<(f32, u32)> =
            self.edges.iter().zip(0..).map(|(edge, i)| (cost(edge) as f32, i)).collect();
        sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let knots = self.knot.last().map_or(0, |&last| last as usize + 1);
        let mut forest = Forest::new(knots);
        let mut degree = vec![0; self.tax.len()];
        let (mut sum, mut joined) = (0.0, 1);
        for (_, i) in sorted {
            let edge = &self.edges[i as usize];
            if joined < knots
                && forest.unite(self.knot[edge.ends[0] as usize], self.knot[edge.ends[1] as usize])
            {
                sum += cost(edge);
                edge.ends.iter().for_each(|&point| degree[tax(point)] += 1);
                joined += 1;
            }
        }
        (sum, degree)
    }
}

/// What a route pays at most: every tax as often as it has links there, but the last end of the last stroke has one
/// link less than the others, and that may be the end with the lowest tax.
fn paid(tax: &[f64], degree: &[i32]) -> f64 {
    let all: f64 = tax.iter().zip(degree).map(|(tax, &degree)| tax * f64::from(degree)).sum();
    all - tax.iter().copied().fold(f64::INFINITY, f64::min)
}

/// From every point to the nearest ones of other knots.
fn short_links(tree: &KdTree<'_>, points: &[Point], knot: &[u32]) -> Vec<[u32; 2]> {
    let mut links = Vec::with_capacity(NEAREST * points.len());
    let shared = tree.fold(
        |points| {
            let first = points.first().map(|&p| knot[p as usize]);
            first.filter(|&first| points.iter().all(|&p| knot[p as usize] == first))
        },
        |a, b| a.filter(|_| a == b),
    );
    for (i, &at) in points.iter().enumerate() {
        let mut search =
            Nearest { knot, shared: &shared, own: knot[i], found: Vec::with_capacity(NEAREST + 1) };
        tree.search(at, &mut search);
        links.extend(search.found.iter().map(|&(_, to)| [i as u32, to]));
    }
    links
}

struct Nearest<'a> {
    knot: &'a [u32],
    /// Of every box the knot all its points belong to, if they do.
    shared: &'a [Option<u32>],
    own: u32,
    found: Vec<(f64, u32)>,
}

impl Nearest<'_> {
    fn reach_sq(&self) -> f64 {
        if self.found.len() < NEAREST { f64::INFINITY } else { self.found[NEAREST - 1].0 }
    }
}

impl Gather for Nearest<'_> {
    fn wants(&self, node: usize, _: &Rect, distance_sq: f64) -> bool {
        distance_sq < self.reach_sq() && self.shared[node] != Some(self.own)
    }

    fn offer(&mut self, point: u32, distance_sq: f64) {
        if self.knot[point as usize] == self.own || distance_sq >= self.reach_sq() {
            return;
        }
        let at = self.found.partition_point(|&known| known < (distance_sq, point));
        self.found.insert(at, (distance_sq, point));
        self.found.truncate(NEAREST);
    }
}
