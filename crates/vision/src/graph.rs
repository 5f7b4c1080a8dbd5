//! The skeleton as a graph: branches of pixels between nodes.

use tracelight_image::distance::to_paper;
use tracelight_image::median::median;
use tracelight_image::{Cell, Mask, Neighbours, Region};
use tracelight_stroke::{Point, Vec2, polyline_length};

/// Half widths beyond this are all one: no pen has them, px.
pub(crate) const WIDEST_RADIUS: f64 = 400.0;

/// A line of skeleton pixels between two nodes, or an end, or round in a ring.
#[derive(Clone, Debug)]
pub(crate) struct Branch {
    /// Centres of its pixels; without those of its nodes.
    pub(crate) points: Vec<Point>,
    /// Distance of each to the paper's edge, px.
    pub(crate) radii: Vec<f64>,
    /// Node at either end; `None` is a free end.
    pub(crate) nodes: [Option<usize>; 2],
    /// Whether it returns to its own first point.
    pub(crate) ring: bool,
    /// Where it turns back on itself at a place that the skeleton does not show.
    pub(crate) turns: Vec<Turn>,
}

/// The turn of a hairpin: both sides run together up to it, and the skeleton forks where their ink parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turn {
    /// The branch's point at the fork.
    pub(crate) index: usize,
    /// How far about the fork the sides' ink is one, px.
    pub(crate) reach: f64,
    pub(crate) tip: TurnTip,
}

/// Where a pen turned back, and what is known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TurnTip {
    pub(crate) at: Point,
    /// How far from there the corner of both sides may be, px; 0 where they meet nowhere in particular.
    pub(crate) corner_px: f64,
    /// Whether it is so near its fork that what is seen of the branch may tell where it turns.
    pub(crate) is_near: bool,
}

impl Branch {
    /// Length from first to last point, px.
    pub(crate) fn length(&self) -> f64 {
        polyline_length(&self.points)
    }

    /// Returns the branch in the opposite direction.
    fn reversed(mut self) -> Self {
        self.points.reverse();
        self.radii.reverse();
        self.nodes.reverse();
        let last = self.points.len().saturating_sub(1);
        self.turns.iter_mut().for_each(|turn| turn.index = last - turn.index);
        self.turns.reverse();
        self
    }

    /// The ring of a branch whose ends both are at `node`.
    fn closed_at(mut self, node: Node) -> Self {
        self.turns.extend(node.turn(self.points.len()));
        self.points.push(node.at);
        self.radii.push(node.radius);
        Self { nodes: [None; 2], ring: true, ..self }
    }

    /// This branch, which ends at `node`, and `tail`, which begins there.
    fn joined_at(mut self, node: Node, tail: Self) -> Self {
        let after = self.points.len() + 1;
        self.turns.extend(node.turn(self.points.len()));
        self.turns.extend(tail.turns.iter().map(|turn| Turn { index: turn.index + after, ..*turn }));
        self.points.push(node.at);
        self.radii.push(node.radius);
        self.points.extend(tail.points);
        self.radii.extend(tail.radii);
        Self { nodes: [self.nodes[0], tail.nodes[1]], ..self }
    }
}

/// Where branches meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) at: Point,
    /// Distance to the paper's edge, px.
    pub(crate) radius: f64,
    /// Where the pen turned back, if two sides of a hairpin part here.
    pub(crate) turn: Option<TurnTip>,
}

impl Node {
    /// The turn of a branch that passes here with one of its points.
    fn turn(&self, index: usize) -> Option<Turn> {
        self.turn.map(|tip| Turn { index, reach: 1.1 * self.radius + 0.5, tip })
    }
}

/// Branches and nodes of one patch of ink.
#[derive(Clone, Debug, Default)]
pub(crate) struct Graph {
    pub(crate) nodes: Vec<Node>,
    pub(crate) branches: Vec<Branch>,
}

/// A mask's ink and its skeleton, and which skeleton pixels have been read.
#[derive(Debug)]
pub(crate) struct Skeleton<'a> {
    ink: &'a Mask,
    line: Mask,
    seen: Mask,
}

impl<'a> Skeleton<'a> {
    /// `line` is `ink` thinned.
    pub(crate) fn new(ink: &'a Mask, line: Mask) -> Self {
        let seen = Mask::empty(ink.width(), ink.height());
        Self { ink, line, seen }
    }

    /// Its pixels in a region.
    pub(crate) fn cells_of(&self, region: &Region) -> Vec<Cell> {
        region.cells(&self.line).collect()
    }
}

/// Radii are measured this share of one apart.
const APART: f64 = 3.0;

/// Lines of a letter, and how long they are together, px.
const LETTER_LINES: usize = 8;
const LETTER_PX: f64 = 45.0;

impl Graph {
    /// Reads the graph of some pixels of a skeleton: whole patches of it.
    pub(crate) fn read(skeleton: &mut Skeleton<'_>, cells: &[Cell]) -> Self {
        let mut reader = Reader { skeleton, graph: Self::default(), node_of: Vec::new() };
        reader.nodes(cells);
        reader.branches(cells);
        reader.rings(cells);
        reader.graph.widen_nodes();
        reader.graph
    }

    /// Gives each node the widest ink near it: thinning sets forks at acute angles off the middle.
    fn widen_nodes(&mut self) {
        const NEAR: usize = 4;
        for branch in &self.branches {
            let first = branch.radii.iter().take(NEAR).copied().fold(0.0, f64::max);
            let last = branch.radii.iter().rev().take(NEAR).copied().fold(0.0, f64::max);
            for (node, radius) in branch.nodes.iter().zip([first, last]) {
                if let Some(node) = node {
                    self.nodes[*node].radius = self.nodes[*node].radius.max(radius);
                }
            }
        }
    }

    /// Whether all of it is no longer than a letter of some ten pixels: too short for its lines to tell their width and direction as
    /// longer ones do.
    pub(crate) fn is_letter(&self) -> bool {
        // most have more branches than a letter
        self.branches.len() <= LETTER_LINES && self.length() < LETTER_PX
    }

    /// The length of all branches with their ways to their nodes, px.
    pub(crate) fn reach(&self) -> f64 {
        let to_nodes = |branch: &Branch| {
            let ends = [branch.points.first(), branch.points.last()];
            let way = |(node, end): (&Option<usize>, Option<&Point>)| {
                node.zip(end).map_or(0.0, |(node, end)| self.nodes[node].at.distance(*end))
            };
            branch.nodes.iter().zip(ends).map(way).sum::<f64>()
        };
        self.length() + self.branches.iter().map(to_nodes).sum::<f64>()
    }

    /// Half the pen's width as the median along all branches, px.
    pub(crate) fn pen_radius(&self) -> f64 {
        median(&self.branches.iter().flat_map(|b| b.radii.iter().copied()).collect::<Vec<_>>())
    }

    /// The ends of branches at each node: (branch, which end).
    pub(crate) fn ends_at_nodes(&self) -> Vec<Vec<(usize, usize)>> {
        let mut at = vec![Vec::new(); self.nodes.len()];
        for (b, branch) in self.branches.iter().enumerate() {
            for (end, node) in branch.nodes.iter().enumerate() {
                node.iter().for_each(|&n| at[n].push((b, end)));
            }
        }
        at
    }

    /// Joins the branches at nodes where only two ends are left, through the node's own place.
    pub(crate) fn join_pairs(&mut self) {
        let mut at = self.ends_at_nodes();
        let mut slots: Vec<Option<Branch>> =
            std::mem::take(&mut self.branches).into_iter().map(Some).collect();
        for node in 0..self.nodes.len() {
            let [(a, end), (b, other)] = at[node][..] else { continue };
            let Some(first) = slots[a].take() else { continue };
            let first = if end == 1 { first } else { first.reversed() };
            let joined = match slots[b].take() {
                None => first.closed_at(self.nodes[node]),
                Some(second) => {
                    first.joined_at(self.nodes[node], if other == 0 { second } else { second.reversed() })
                }
            };
            for (k, far) in joined.nodes.iter().enumerate().filter_map(|(k, far)| Some((k, (*far)?))) {
                let old = if k == 0 { (a, 1 - end) } else { (b, 1 - other) };
                at[far].iter_mut().filter(|e| **e == old).for_each(|e| *e = (a, k));
            }
            slots[a] = Some(joined);
        }
        self.branches = slots.into_iter().flatten().collect();
    }
}

struct Reader<'a, 'b> {
    skeleton: &'a mut Skeleton<'b>,
    graph: Graph,
    /// Node pixels and their nodes, sorted by pixel.
    node_of: Vec<(Cell, usize)>,
}

impl Reader<'_, '_> {
    fn neighbours(&self, cell: Cell) -> Neighbours {
        self.skeleton.line.neighbours(cell)
    }

    fn is_node(&self, cell: Cell) -> bool {
        self.neighbours(cell).len() > 2
    }

    fn node(&self, cell: Cell) -> Option<usize> {
        let found = self.node_of.binary_search_by_key(&cell, |&(pixel, _)| pixel).ok()?;
        Some(self.node_of[found].1)
    }

    fn seen(&self, cell: Cell) -> bool {
        self.skeleton.seen.has(cell)
    }

    fn see(&mut self, cell: Cell) {
        self.skeleton.seen.set(cell);
    }

    fn centre(&self, cell: Cell) -> Point {
        self.skeleton.line.centre(cell)
    }

    /// Distance to the edge of the ink: half a pixel less than to the next pixel's centre.
    fn radius(&self, cell: Cell) -> f64 {
        to_paper(self.skeleton.ink, cell, WIDEST_RADIUS) - 0.5
    }

    /// The radius at each pixel of a chain: wide ink is as wide a few pixels on, and between two that are measured it is
    /// taken to change evenly.
    fn radii(&self, chain: &[Cell]) -> Vec<f64> {
        let mut radii: Vec<f64> = Vec::with_capacity(chain.len());
        radii.extend(chain.first().map(|&cell| self.radius(cell)));
        while radii.len() < chain.len() {
            let last = radii.len() - 1;
            let here = radii[last];
            let step = ((here / APART) as usize).clamp(1, chain.len() - radii.len());
            let rise = (self.radius(chain[last + step]) - here) / step as f64;
            radii.extend((1..=step).map(|k| here + rise * k as f64));
        }
        radii
    }

    /// Pixels with three neighbours and more, those that touch as one node.
    fn nodes(&mut self, cells: &[Cell]) {
        for &start in cells {
            if self.seen(start) || !self.is_node(start) {
                continue;
            }
            let mut cluster = vec![start];
            self.see(start);
            let mut next = 0;
            while let Some(&i) = cluster.get(next) {
                for k in self.neighbours(i) {
                    if !self.seen(k) && self.is_node(k) {
                        self.see(k);
                        cluster.push(k);
                    }
                }
                next += 1;
            }
            let node = self.graph.nodes.len();
            self.node_of.extend(cluster.iter().map(|&i| (i, node)));
            let middle =
                cluster.iter().map(|&i| self.centre(i).to_vec2()).sum::<Vec2>() / cluster.len() as f64;
            let radius = cluster.iter().map(|&i| self.radius(i)).fold(0.0, f64::max);
            self.graph.nodes.push(Node { at: middle.to_point(), radius, turn: None });
        }
        self.node_of.sort_unstable();
    }

    /// Walks from every node's and every free end's neighbours.
    fn branches(&mut self, cells: &[Cell]) {
        let node_pixels = self.node_of.clone();
        for (i, node) in node_pixels {
            for start in self.neighbours(i) {
                if !self.seen(start) {
                    self.walk(start, Some(node));
                }
            }
        }
        for &i in cells {
            if !self.seen(i) && self.neighbours(i).len() <= 1 {
                self.walk(i, None);
            }
        }
    }

    fn rings(&mut self, cells: &[Cell]) {
        for &i in cells {
            if !self.seen(i) {
                self.walk(i, None);
                if let Some(branch) = self.graph.branches.last_mut() {
                    branch.ring = branch.points.len() > 2;
                }
            }
        }
    }

    /// Follows unseen pixels from `start` until there is none; a node beside the last one ends the branch.
    fn walk(&mut self, start: Cell, from: Option<usize>) {
        let mut chain = vec![start];
        self.see(start);
        let mut at = start;
        let onward = |reader: &Self, at| reader.neighbours(at).find(|&k| !reader.seen(k));
        while let Some(next) = onward(self, at) {
            self.see(next);
            chain.push(next);
            at = next;
        }
        let beside: Vec<usize> = self.neighbours(at).filter_map(|k| self.node(k)).collect();
        // a single pixel between two nodes touches both: the one it came from is not its end too
        let end = if chain.len() == 1 {
            beside.iter().copied().find(|&n| Some(n) != from)
        } else {
            beside.first().copied()
        };
        self.graph.branches.push(Branch {
            points: chain.iter().map(|&i| self.centre(i)).collect(),
            radii: self.radii(&chain),
            nodes: [from, end],
            ring: false,
            turns: Vec::new(),
        });
    }
}
