//! What could be seen at each place of a page, found from the top down, so that what is hidden is never looked at.

use std::ops::Range;

use tracelight_stroke::{Point, Rect};

use super::coverage::{Coverage, Run, runs};
use super::crossings::{Edges, Owner};
use super::grid::{Grid, Listing};
use super::region::Region;
use super::scene::{GateKind, Number, Scene};

/// For each tile of a grid what touches it, the topmost first, down to what covers it all.
pub(crate) struct Tiles {
    grid: Grid,
    entries: Vec<Entry>,
    /// First entry of each tile, [`NONE`] for an empty one.
    first: Vec<u32>,
    /// Last entry of each tile.
    last: Vec<u32>,
    /// The item that covers each tile; what is below is not seen there.
    floor: Vec<Number>,
}

/// What touches a tile.
#[derive(Clone, Copy)]
struct Entry {
    item: Number,
    /// Whether it fills the tile.
    is_full: bool,
    next: u32,
}

const NONE: u32 = u32::MAX;

/// A scene laid out over tiles.
pub(crate) struct Layout {
    pub(crate) tiles: Tiles,
    /// The region of each item; none of one that is hidden everywhere.
    pub(crate) regions: Vec<Option<Region>>,
    pub(crate) edges: Edges,
}

/// Entries in all tiles at most, of items and of edges, for the memory they take.
const MAX_ENTRIES: usize = 3_000_000;
const MAX_EDGES: usize = 16_000_000;

/// Segments looked at, at most.
const MAX_WORK: usize = 30_000_000;

/// How many tiles there are.
const TILES: std::ops::RangeInclusive<usize> = 64..=262_144;

/// Tiles for each element of a path, about.
const TILES_OF_ONE: usize = 2;

/// Where a scene is laid out.
#[derive(Clone, Copy)]
pub(crate) struct Ground {
    pub(crate) page: Rect,
    /// What could be seen, the page and a margin.
    pub(crate) within: Rect,
    /// How close a line must come to an edge to meet it.
    pub(crate) slack: f64,
}

/// Lays a scene out. The function says of an item whether it hides all that is below it.
/// `None` if that takes more work than it may.
pub(crate) fn laid_out(scene: &Scene, ground: Ground, covers: impl Fn(Number) -> bool) -> Option<Layout> {
    let mut count = scene.elements.saturating_mul(TILES_OF_ONE).clamp(*TILES.start(), *TILES.end());
    let mut regions: Vec<Option<Region>> = scene.items.iter().map(|_| None).collect();
    let mut work = 0;
    while work < MAX_WORK {
        let is_last = count <= *TILES.start();
        let mut filling = Filling::new(scene, ground, count);
        filling.regions = regions;
        filling.most = if is_last { [usize::MAX; 2] } else { [MAX_ENTRIES, MAX_EDGES] };
        let is_done = (0..scene.items.len() as Number).rev().all(|item| filling.add(item, covers(item)));
        work += filling.work;
        if is_done {
            return Some(filling.done());
        }
        if is_last {
            return None;
        }
        regions = filling.regions;
        count /= 4;
    }
    None
}

/// Tiles being filled.
struct Filling<'a> {
    scene: &'a Scene<'a>,
    ground: Ground,
    regions: Vec<Option<Region>>,
    tiles: Tiles,
    open: Open,
    segments: Vec<[Point; 2]>,
    owners: Vec<Owner>,
    of_items: Vec<Range<u32>>,
    /// Tiles and numbers of segments in them.
    listed: Vec<(u32, u32)>,
    coverages: Vec<Option<Coverage>>,
    work: usize,
    /// Entries of items and of edges at most.
    most: [usize; 2],
}

impl<'a> Filling<'a> {
    fn new(scene: &'a Scene<'a>, ground: Ground, count: usize) -> Self {
        let grid = Grid::new(ground.within, count);
        let empty = vec![NONE; grid.len()];
        let (last, floor) = (empty.clone(), vec![0; grid.len()]);
        Self {
            scene,
            ground,
            regions: Vec::new(),
            tiles: Tiles { grid, entries: Vec::new(), first: empty, last, floor },
            open: Open::new(&grid),
            segments: Vec::new(),
            owners: Vec::new(),
            of_items: vec![0..0; scene.items.len()],
            listed: Vec::new(),
            coverages: scene.gates.iter().map(|_| None).collect(),
            work: 0,
            most: [0; 2],
        }
    }

    /// Adds the next item below; `false` if that makes more entries than allowed, or more work.
    fn add(&mut self, number: Number, is_cover: bool) -> bool {
        let scene = self.scene;
        let item = &scene.items[number as usize];
        let shown = item.gate.map_or(self.ground.within, |gate| scene.gates[gate as usize].bounds);
        if !self.is_open(item.shape.bounds().intersect(shown).intersect(self.ground.within)) {
            return true;
        }
        item.gate.into_iter().for_each(|gate| self.cover(gate));
        let begin = self.segments.len() as u32;
        let region = self.regions[number as usize].take().unwrap_or_else(|| item.shape.region());
        for run in self.runs(&region, number) {
            self.fill(run, number, is_cover);
        }
        self.regions[number as usize] = Some(region);
        self.of_items[number as usize] = begin..self.segments.len() as u32;
        self.tiles.entries.len() <= self.most[0] && self.listed.len() <= self.most[1] && self.work <= MAX_WORK
    }

    /// The tiles of an item; its edges are listed where they are not covered.
    fn runs(&mut self, region: &Region, number: Number) -> Vec<Run> {
        let grid = self.tiles.grid;
        let (open, listed, segments) = (&mut self.open, &mut self.listed, &mut self.segments);
        let mut before = None;
        let shown = self.ground.within.inflate(self.ground.slack, self.ground.slack);
        runs(region, &grid, self.ground.slack, &mut self.work, |segment, row, first, last| {
            let mut at = open.next(row, first);
            if at > last || !is_near(segment, shown) {
                return;
            }
            if before != Some(segment) {
                before = Some(segment);
                segments.push(segment);
                self.owners.push(Owner::Item(number));
            }
            while at <= last {
                listed.push(((row * grid.columns() + at) as u32, segments.len() as u32 - 1));
                at = open.next(row, at + 1);
            }
        })
    }

    fn fill(&mut self, run: Run, number: Number, is_cover: bool) {
        let gate = self.scene.items[number as usize].gate;
        let row = run.row * self.tiles.grid.columns();
        let mut at = self.open.next(run.row, run.first);
        while at <= run.last {
            let [passes, passes_all] = self.passes(gate, run.row, at);
            if passes {
                self.tiles.push(row + at, number, run.is_full);
            }
            if run.is_full && is_cover && passes_all {
                self.tiles.floor[row + at] = number;
                self.open.close(run.row, at);
            }
            at = self.open.next(run.row, at + 1);
        }
    }

    /// The layout, with the edges of gates and of the page.
    fn done(mut self) -> Layout {
        for gate in &self.scene.gates {
            match &gate.kind {
                GateKind::Clip(regions) => {
                    regions.iter().for_each(|(region, _)| self.add_edges(region.segments()));
                }
                GateKind::Mask { lights, .. } => {
                    lights.iter().for_each(|light| self.add_edges(light.region.segments()));
                    self.add_edges(&sides(gate.bounds));
                }
                GateKind::Unknown => {}
            }
        }
        self.add_edges(&sides(self.ground.page));
        let listing = Listing::new(self.tiles.grid, &self.listed);
        let edges = Edges {
            segments: self.segments,
            owners: self.owners,
            of_items: self.of_items,
            listing,
            slack: self.ground.slack,
        };
        Layout { tiles: self.tiles, regions: self.regions, edges }
    }

    fn add_edges(&mut self, segments: &[[Point; 2]]) {
        let (grid, slack) = (self.tiles.grid, self.ground.slack);
        let shown = self.ground.within.inflate(slack, slack);
        for &segment in segments.iter().filter(|&&segment| is_near(segment, shown)) {
            let number = self.segments.len() as u32;
            self.segments.push(segment);
            self.owners.push(Owner::Gate);
            grid.list(segment, slack, number, &mut self.listed);
        }
    }

    /// Whether something may be seen somewhere in a rectangle.
    fn is_open(&mut self, bounds: Rect) -> bool {
        if bounds.x1 < bounds.x0 || bounds.y1 < bounds.y0 {
            return false;
        }
        let grid = self.tiles.grid;
        let (first, last) = (grid.column(bounds.x0), grid.column(bounds.x1));
        (grid.row(bounds.y0)..=grid.row(bounds.y1)).any(|row| self.open.next(row, first) <= last)
    }

    /// Makes sure that it is known where a gate and those around it let pass.
    fn cover(&mut self, gate: Number) {
        let mut next = Some(gate);
        while let Some(number) = next.filter(|&gate| self.coverages[gate as usize].is_none()) {
            let gate = &self.scene.gates[number as usize];
            self.coverages[number as usize] =
                Some(Coverage::of(gate, &self.tiles.grid, self.ground.slack, &mut self.work));
            next = gate.around;
        }
    }

    /// Whether a gate and those around it may let pass in a tile, and whether they let pass in all of it.
    fn passes(&self, gate: Option<Number>, row: usize, column: usize) -> [bool; 2] {
        let mut passes = [true; 2];
        let mut next = gate;
        while let Some(number) = next.filter(|_| passes[0]) {
            let Some(coverage) = &self.coverages[number as usize] else { return [true, false] };
            let [some, all] = coverage.at(row, column);
            passes = [passes[0] && some, passes[1] && all];
            next = self.scene.gates[number as usize].around;
        }
        passes
    }
}

impl Tiles {
    fn push(&mut self, tile: usize, item: Number, is_full: bool) {
        let number = self.entries.len() as u32;
        self.entries.push(Entry { item, is_full, next: NONE });
        match std::mem::replace(&mut self.last[tile], number) {
            NONE => self.first[tile] = number,
            before => self.entries[before as usize].next = number,
        }
    }

    /// What may be seen at a point, the topmost first, and whether it is sure to be there.
    pub(crate) fn at(&self, p: Point) -> impl Iterator<Item = (Number, bool)> + '_ {
        let entry = |at: u32| self.entries.get(at as usize);
        let first = entry(self.first[self.tile(p)]);
        std::iter::successors(first, move |before| entry(before.next)).map(|e| (e.item, e.is_full))
    }

    fn tile(&self, p: Point) -> usize {
        self.grid.row(p.y) * self.grid.columns() + self.grid.column(p.x)
    }

    /// Something that covers an item at two points, of the items that count; which are asked of their regions only where
    /// they do not fill the tile.
    pub(crate) fn cover(
        &self,
        item: Number,
        [a, b]: [Point; 2],
        covers: impl Fn(Number, &[Point]) -> bool,
    ) -> Option<Number> {
        let is_one_tile = self.tile(a) == self.tile(b);
        let mut above = self.at(a).take_while(|&(number, _)| number > item);
        above
            .find(|&(number, is_full)| match (is_full, is_one_tile) {
                (true, true) => covers(number, &[]),
                (true, false) => covers(number, &[b]),
                _ => covers(number, &[a, b]),
            })
            .map(|(number, _)| number)
    }

    /// Whether something covers an item in every tile that a segment passes.
    pub(crate) fn is_hidden(&self, item: Number, segment: [Point; 2]) -> bool {
        self.all_passed(segment, |tile| item < self.floor[tile])
    }

    /// Whether something covers an item in a tile that a segment passes.
    pub(crate) fn is_somewhere_hidden(&self, item: Number, segment: [Point; 2]) -> bool {
        !self.all_passed(segment, |tile| item >= self.floor[tile])
    }

    fn all_passed(&self, [a, b]: [Point; 2], holds: impl Fn(usize) -> bool) -> bool {
        let [from, to] = [a, b].map(|p| self.tile(p));
        if from == to || !holds(from) || !holds(to) {
            return holds(from) && holds(to);
        }
        let mut hold = true;
        self.grid.passed([a, b], 0.0, |row, first, last| {
            let row = row * self.grid.columns();
            hold = hold && (row + first..=row + last).all(&holds);
        });
        hold
    }
}

/// The tiles of which more is to be seen, each pointing to the next of its row.
struct Open {
    next: Vec<u32>,
    row: usize,
}

impl Open {
    fn new(grid: &Grid) -> Self {
        let row = grid.columns() + 1;
        Self { next: (0..grid.rows() * row).map(|i| (i % row) as u32).collect(), row }
    }

    /// The first open column from one on; that past the last if there is none.
    fn next(&mut self, row: usize, column: usize) -> usize {
        let base = row * self.row;
        let mut at = column.min(self.row - 1);
        while self.next[base + at] as usize != at {
            let next = self.next[base + at] as usize;
            self.next[base + at] = self.next[base + next];
            at = next;
        }
        at
    }

    fn close(&mut self, row: usize, column: usize) {
        self.next[row * self.row + column] = column as u32 + 1;
    }
}

fn is_near([a, b]: [Point; 2], shown: Rect) -> bool {
    let bounds = Rect::from_points(a, b);
    bounds.x1 >= shown.x0 && bounds.x0 <= shown.x1 && bounds.y1 >= shown.y0 && bounds.y0 <= shown.y1
}

fn sides(r: Rect) -> [[Point; 2]; 4] {
    let [a, b, c, d] = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)].map(Point::from);
    [[a, b], [b, c], [c, d], [d, a]]
}
