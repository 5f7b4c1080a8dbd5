//! Separates pen lines from filled shapes, each part of the ink by its own width.
//!
//! Where ink is much wider than the lines it hangs together with it was filled, and its outline is meant; what is long
//! for its own width is a line, and its middle is meant. A patch can hold both: a drawing of lines with hair filled in,
//! a disc with a stick that ends on its outline.

use tracelight_image::median::median;
use tracelight_image::{Mask, Plane, Region, mask_of, regions};

use crate::dust::{Dust, dusted};
use crate::felt;
use crate::graph::{Graph, Skeleton};
use crate::hub::hubs;
use crate::prune;
use crate::reading::{LONG_LINE, Patch, Reading, pen_of};
use crate::thin;

/// No pen's lines, nor two of them where they cross, hold an upright square of this share of the picture's shorter
/// side: what does was filled with something else than the picture's second ink.
pub(crate) const SOLID_SHARE: usize = 16;

/// Two lines where they cross at right angles hold a disc of 1.4 of their width, and one more px for blur.
const CROSSED_PENS: f64 = 1.6;
/// An octagon this many pens wide fits in no crossing of lines: where three cross at 60°, a disc of two pens fits, and
/// blur and noise fill corners.
const BULK_PENS: f64 = 3.0;
/// Width in pens of an octagon that counts as bulk if more than one fits side by side.
const WIDE_PENS: f64 = 2.2;
/// In a drawing of lines, what holds this much more than one octagon, as a share of its area, was filled.
const FILLED: f64 = 1.6;

/// Pixels by which a shape is larger than the octagons in it, and the share of their width: a disc just wider than them
/// leaves that much.
const RIM_PX: usize = 2;
const RIM_SHARE: usize = 12;

/// How far beyond octagons of some width their shape reaches, px.
const fn rim(width: usize) -> usize {
    RIM_PX + width / RIM_SHARE
}

/// The ink in two kinds of parts.
#[derive(Debug)]
pub(crate) struct Parts {
    /// All of it: that of the picture, and the slits that a felt pen left in what it filled.
    pub(crate) ink: Mask,
    /// Patches of lines, each with its skeleton's graph.
    pub(crate) lines: Vec<(Region, Graph)>,
    /// Filled shapes.
    pub(crate) shapes: Vec<Region>,
    /// The ink of all shapes.
    pub(crate) shape_mask: Mask,
    /// What was taken for dust and is neither.
    pub(crate) dust: Vec<Region>,
}

impl Parts {
    /// Every patch as lines.
    pub(crate) fn all_lines(dark: &Plane<u8>, ink: Mask, regions: Vec<Region>) -> Self {
        let lines = graphs(dark, &ink, regions);
        let shape_mask = Mask::empty(ink.width(), ink.height());
        Self { ink, lines, shapes: Vec::new(), shape_mask, dust: Vec::new() }
    }

    /// Each part by its width.
    pub(crate) fn of(dark: &Plane<u8>, mut ink: Mask, patches: Vec<Region>, dust: Dust<'_>) -> Self {
        let read = |ink: &Mask, patches| graphs(dark, ink, patches).into_iter().map(Patch::new).collect();
        let mut patches: Vec<Patch> = read(&ink, patches);
        // what a felt pen filled to and fro is broad, and of many lines
        let filling = usual_pen(&patches, |patch| patch.is_line_drawing() || patch.reading.many_lines);
        if let Some(filled) = felt::filled(&ink, filling) {
            ink = filled;
            patches = read(&ink, regions(&ink));
        }
        let pens = Pens::of(&patches, |reading| reading.is_drawn);
        patches.iter_mut().for_each(|patch| patch.reading.is_drawn |= pens.drew(patch));
        agree_on_letters(&mut patches);
        let pen = usual_pen(&patches, Patch::is_line_drawing);
        let (patches, dust) = match dust {
            Dust::Kept => (patches, Vec::new()),
            Dust::Dropped => dusted(dark, &ink, patches, pen, None),
            Dust::DroppedOnRules(rules) => dusted(dark, &ink, patches, pen, Some(rules)),
        };
        let shape_mask = Mask::empty(ink.width(), ink.height());
        let mut sorter = Sorter { dark, pen, lines: Vec::new(), shape_mask };
        sorter.sort(patches);
        let Sorter { lines, mut shape_mask, .. } = sorter;
        for slit in felt::slits(&shape_mask) {
            slit.fill_into(&mut shape_mask);
            slit.fill_into(&mut ink);
        }
        Self { ink, lines, shapes: regions(&shape_mask), shape_mask, dust }
    }
}

impl Patch {
    /// Whether no part of it is wider than two lines of the picture's pen where they cross; or, if it may be one pen's, of its own.
    fn is_pure_line(&self, pen: f64) -> bool {
        let is_within = |pen: f64| self.reading.widest <= CROSSED_PENS * pen + 1.0;
        is_within(pen) || self.reading.is_even && is_within(self.reading.pen())
    }

    /// Whether it is a drawing of lines by itself.
    fn is_line_drawing(&self) -> bool {
        self.is_pure_line(0.0) || self.reading.is_drawn
    }
}

/// The widths of the lines that are certainly lines, from the narrowest, px.
struct Pens(Vec<f64>);

impl Pens {
    fn of(patches: &[Patch], is_sure: impl Fn(&Reading) -> bool) -> Self {
        let drawn = patches.iter().filter(|patch| is_sure(&patch.reading));
        let mut pens: Vec<f64> =
            drawn.flat_map(|patch| patch.reading.lines.iter().map(|l| l.width)).collect();
        pens.sort_unstable_by(f64::total_cmp);
        Self(pens)
    }

    /// One that is about as wide as this.
    fn alike(&self, width: f64) -> Option<f64> {
        let from = self.0.partition_point(|&pen| pen < width / SAME_PEN);
        self.0.get(from).copied().filter(|&pen| pen <= width * SAME_PEN)
    }

    /// Whether one of them drew a patch that by itself might as well be a shape: a fat letter beside others.
    fn drew(&self, patch: &Patch) -> bool {
        let Reading { usual, widest, long, .. } = patch.reading;
        long >= LONG_LETTER && self.alike(usual).is_some_and(|pen| widest <= CROSSED_PENS * pen + 1.0)
    }
}

/// A fat pen's letters are all lines, or none: so much of what is longer than wide is.
const LETTERS: f64 = 0.8;

/// Where much of the broad letters for which no long line vouches are no lines, none of them are.
fn agree_on_letters(patches: &mut [Patch]) {
    let sure = Pens::of(patches, |r| r.is_drawn && (r.many_lines || r.long >= LONG_LINE));
    let is_letter = |patch: &Patch| {
        let Reading { is_broad, is_lens, long, usual, .. } = patch.reading;
        is_broad && !is_lens && long >= LONG_LETTER && sure.alike(usual).is_none()
    };
    let area = |is_counted: &dyn Fn(&Patch) -> bool| {
        let counted = patches.iter().filter(|patch| is_letter(patch) && is_counted(patch));
        counted.map(|patch| patch.region.area()).sum::<usize>() as f64
    };
    let pen = usual_pen(patches, Patch::is_line_drawing);
    let is_line = |patch: &Patch| patch.reading.is_drawn || patch.is_pure_line(pen);
    if area(&is_line) < LETTERS * area(&|_| true) {
        for patch in patches.iter_mut().filter(|patch| is_letter(patch)) {
            (patch.reading.is_drawn, patch.reading.is_even) = (false, false);
        }
    }
}

/// A fat pen's letter is so many times as long as wide.
const LONG_LETTER: f64 = 2.4;
/// Two widths of one pen differ less than this, as a ratio.
const SAME_PEN: f64 = 1.25;

/// The usual width of all lines, px; 0 if there are none. Those of drawings, and only where there are no drawings a
/// shape's sticks.
fn usual_pen(patches: &[Patch], is_drawing: impl Fn(&Patch) -> bool) -> f64 {
    let drawn = patches.iter().filter(|patch| is_drawing(patch));
    let mut lines: Vec<_> = drawn.flat_map(|patch| patch.reading.lines.iter().copied()).collect();
    lines.sort_by(|a, b| a.width.total_cmp(&b.width));
    if lines.is_empty() {
        return patches.iter().filter_map(|patch| patch.reading.stick_pen()).fold(0.0, f64::max);
    }
    pen_of(&lines)
}

/// Whether a piece touches what it lies beside with its ends only. A sliver, which octagons leave along a slanted
/// edge, touches it all along.
fn leads_away(piece: &Patch, beside: &Mask) -> bool {
    let width = 2.0 * piece.graph.widest();
    let touching = piece.region.cells(beside).count() as f64;
    // two rows of pixels at either end
    touching <= 4.0 * width + 0.25 * piece.graph.length()
}

/// A crescent is filled if it is so much wider than the pen: a pen's own comma is hardly wider.
const LENS_PENS: f64 = 1.5;

/// Parts the patches that may hold both kinds.
struct Sorter<'a> {
    dark: &'a Plane<u8>,
    /// The picture's, px; 0 where none is known.
    pen: f64,
    lines: Vec<(Region, Graph)>,
    shape_mask: Mask,
}

impl Sorter<'_> {
    fn sort(&mut self, patches: Vec<Patch>) {
        let mut drawn: Vec<Patch> = Vec::new();
        let mut filled: Vec<Patch> = Vec::new();
        for patch in patches {
            if patch.reading.is_lens && patch.reading.widest > LENS_PENS * self.pen + 1.0 {
                patch.region.fill_into(&mut self.shape_mask);
            } else if patch.is_pure_line(self.pen) {
                self.lines.push((patch.region, patch.graph));
            } else if patch.reading.is_drawn {
                drawn.push(patch);
            } else {
                filled.push(patch);
            }
        }
        for (pen, alike) in by_pen(drawn, |patch| patch.reading.wide_pen()) {
            self.sort_drawn(alike, pen);
        }
        let usual = self.pen;
        for (pen, alike) in by_pen(filled, |patch| patch.reading.stick_pen().unwrap_or(usual)) {
            self.sort_filled(alike, pen);
        }
    }

    /// Drawings of lines of about one pen: what is filled in them is wider than lines that cross, somewhere much wider, and
    /// no line itself.
    fn sort_drawn(&mut self, group: Vec<Patch>, pen: f64) {
        let width = ((CROSSED_PENS * pen + 2.0).ceil() as usize).max(LEAST_BULK);
        let mask = mask_of(&self.shape_mask, group.iter().map(|patch| &patch.region));
        let mut inner = mask.clone().opened(width);
        let least = WIDE_PENS * pen + 2.0;
        let cores = regions(&inner);
        for core in graphs(self.dark, &inner, cores).into_iter().map(Patch::new) {
            let small = (core.region.area() as f64) < FILLED * least * least;
            if core.reading.widest < least || small || core.reading.is_drawn {
                core.region.erase_from(&mut inner);
            }
        }
        let wide = inner.clone().dilated_by(rim(width)).and(&mask);
        let parts = regions(&wide);
        let hubs = hubs(&parts, &wide, group.iter().map(|patch| &patch.graph));
        hubs.into_iter().for_each(|hub| hub.erase_from(&mut inner));
        self.part(group, inner, width, |piece, _| piece.reading.is_drawn || !piece.reading.lines.is_empty());
    }

    /// Filled shapes, which may have sticks of about one pen.
    fn sort_filled(&mut self, group: Vec<Patch>, pen: f64) {
        let blob = WIDE_PENS * self.pen + 1.0;
        let bulk = BULK_PENS * pen + 2.0;
        // no line is in it, nothing hangs on its bulk, or what does is as wide for it as limbs
        let is_whole = |patch: &Patch| {
            let Reading { lines, widest, is_even, .. } = &patch.reading;
            let has_sticks = patch.reading.stick_pen().is_some();
            let is_bare = if *widest >= bulk { !has_sticks } else { has_sticks && !is_even };
            pen == 0.0 || *widest > blob && (lines.is_empty() || is_bare)
        };
        let (whole, mixed): (Vec<_>, Vec<_>) = group.into_iter().partition(is_whole);
        whole.iter().for_each(|patch| patch.region.fill_into(&mut self.shape_mask));
        if mixed.is_empty() {
            return;
        }
        let width = (bulk.ceil() as usize).max(LEAST_BULK);
        let inner = mask_of(&self.shape_mask, mixed.iter().map(|patch| &patch.region)).opened(width);
        self.part(mixed, inner, width, |piece, beside| {
            let is_line = piece.is_pure_line(pen) && piece.graph.is_line_beside(pen);
            is_line && leads_away(piece, beside)
        });
    }

    /// Parts the patches that hold octagons of this width, which are `inner`; the others are lines.
    fn part(
        &mut self,
        group: Vec<Patch>,
        inner: Mask,
        width: usize,
        is_line: impl Fn(&Patch, &Mask) -> bool,
    ) {
        let (fits, rest): (Vec<_>, Vec<_>) =
            group.into_iter().partition(|patch| patch.region.cells(&inner).next().is_some());
        self.lines.extend(rest.into_iter().map(|patch| (patch.region, patch.graph)));
        if !fits.is_empty() {
            let mixed = mask_of(&self.shape_mask, fits.iter().map(|patch| &patch.region));
            self.split(mixed, inner.dilated_by(rim(width)), is_line);
        }
    }

    /// Lines that lead away from what octagons and their rims cover, and the shapes without them.
    fn split(&mut self, mixed: Mask, covered: Mask, is_line: impl Fn(&Patch, &Mask) -> bool) {
        let bulk = covered.and(&mixed);
        let mut rest = mixed.clone().without(&bulk);
        let beside = bulk.clone().dilated_by(2);
        self.shape_mask.add(&bulk);
        let (compact, long): (Vec<_>, Vec<_>) = {
            let squares = Squares::in_ink(&rest);
            regions(&rest).into_iter().partition(|piece| squares.fill(piece))
        };
        for corner in &compact {
            corner.fill_into(&mut self.shape_mask);
            corner.erase_from(&mut rest);
        }
        for piece in graphs(self.dark, &rest, long).into_iter().map(Patch::new) {
            match is_line(&piece, &beside) {
                true => self.lines.push((piece.region, piece.graph)),
                false => piece.region.fill_into(&mut self.shape_mask),
            }
        }
    }
}

/// Patches of nearly the same pen together, which is the widest of them: a whole mask is opened for each pen.
fn by_pen(mut left: Vec<Patch>, pen: impl Fn(&Patch) -> f64) -> Vec<(f64, Vec<Patch>)> {
    left.sort_by(|a, b| pen(a).total_cmp(&pen(b)));
    let mut groups = Vec::new();
    while let Some(first) = left.first() {
        let most = ALIKE * pen(first) + 0.5;
        let rest = left.split_off(left.partition_point(|patch| pen(patch) <= most));
        groups.push((left.last().map_or(0.0, &pen), std::mem::replace(&mut left, rest)));
    }
    groups
}

/// Pens that differ by less than this, as a ratio, are taken together.
const ALIKE: f64 = 1.2;

/// The squares of 8, 16, 32 … px that fit into a mask, by their upper left corners: thinning what holds a large one
/// takes long and shows no line.
struct Squares(Vec<Mask>);

impl Squares {
    fn in_ink(mask: &Mask) -> Self {
        let mut squares = vec![mask.clone().eroded(LEAST_BULK)];
        while squares.last().is_some_and(|mask| !mask.is_empty()) && squares.len() < 5 {
            let side = LEAST_BULK << squares.len();
            squares.push(mask.clone().eroded(side));
        }
        Self(squares)
    }

    /// Whether a piece holds a square of a third of its extent: a line is four times as long as wide, and a square in a
    /// slanted one has 0.7 of its width.
    fn fill(&self, piece: &Region) -> bool {
        let (width, height) = piece.extent();
        let third = width.max(height) / 3;
        let mut fitting = self.0.iter().enumerate().filter(|(k, _)| LEAST_BULK << k <= third);
        fitting.next_back().is_some_and(|(_, squares)| piece.cells(squares).next().is_some())
    }
}

/// Octagons smaller than this are pixels, px.
const LEAST_BULK: usize = 8;

/// The regions, which are all the ink of `mask`, with their skeletons' graphs.
pub(crate) fn graphs(dark: &Plane<u8>, mask: &Mask, regions: Vec<Region>) -> Vec<(Region, Graph)> {
    let mut skeleton = Skeleton::new(mask, thin::thinned(mask.clone()));
    let read = |region: Region| {
        let cells = skeleton.cells_of(&region);
        let mut graph = Graph::read(&mut skeleton, &cells);
        prune::prune(&mut graph, dark);
        (region, graph)
    };
    regions.into_iter().map(read).collect()
}

/// What this share of sorted values, %, are under; 0 of none.
fn at_share(sorted: &[f64], share: usize) -> f64 {
    sorted.get(sorted.len() * share / 100).copied().unwrap_or(0.0)
}

impl Graph {
    /// The half widths along all branches, px, from the narrowest.
    fn radii(&self) -> Vec<f64> {
        let mut radii: Vec<f64> = self.branches.iter().flat_map(|b| b.radii.iter().copied()).collect();
        radii.sort_unstable_by(f64::total_cmp);
        radii
    }

    /// The length of all branches, px.
    pub(crate) fn length(&self) -> f64 {
        self.branches.iter().map(|b| b.length()).sum()
    }

    /// How many ways round there are in a connected graph (its first Betti number).
    pub(crate) fn rounds(&self) -> usize {
        let rings = self.branches.iter().filter(|b| b.ring).count();
        // free ends are nodes of their own; some nodes have lost their branches
        let free = self.branches.iter().flat_map(|b| b.nodes).filter(Option::is_none).count() - 2 * rings;
        let nodes = self.ends_at_nodes().iter().filter(|ends| !ends.is_empty()).count();
        (self.branches.len() + usize::from(rings == 0)).saturating_sub(nodes + free)
    }

    /// Half of the width where it is widest, px.
    pub(crate) fn widest(&self) -> f64 {
        self.branches.iter().flat_map(|b| b.radii.iter().copied()).fold(0.0, f64::max)
    }

    /// What this share of its half widths, %, are under, px.
    pub(crate) fn radius_under(&self, share: usize) -> f64 {
        at_share(&self.radii(), share)
    }

    /// Whether a piece next to a shape is a line: as wide at both ends, and long for its width; the less so, the more its
    /// width is the pen's.
    fn is_line_beside(&self, pen: f64) -> bool {
        let radii = self.radii();
        let at = |share| at_share(&radii, share);
        let width = 2.0 * at(50);
        // distances to pixels go in steps of up to a pixel where they are small
        let even = at(80) - at(20) <= (0.25 * at(50)).max(1.05);
        let lengths = if (width - pen).abs() < 0.3 * pen { 2.0 } else { 4.0 };
        even && !self.tapers() && self.length() > (lengths * width).max(8.0)
    }

    /// Whether the longest branch gets thinner from one end to the other, as the corner of a shape does.
    fn tapers(&self) -> bool {
        let longest = self.branches.iter().max_by(|a, b| a.points.len().cmp(&b.points.len()));
        let Some(radii) = longest.map(|branch| &branch.radii) else { return true };
        let third = (radii.len() / 3).max(1);
        let (first, last) = (median(&radii[..third]), median(&radii[radii.len() - third..]));
        (first - last).abs() > 0.12 * (first + last) + 0.3
    }
}
