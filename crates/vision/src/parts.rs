//! Pen lines or filled shapes: each part of the ink by its own width.
//!
//! Where ink is much wider than the pen it was filled, and its outline is meant; where it is as wide as the pen all
//! along, its middle is. A patch can hold both: the stick of a lollipop is a line that ends on the disc's outline.

use crate::graph::{Graph, Skeleton};
use crate::mask::Mask;
use crate::prune;
use crate::region::{Region, regions};
use crate::ridge::median;
use crate::thin;

/// No pen's lines, nor two of them where they cross, hold an upright square of this share of the picture's shorter
/// side.
pub(crate) const SOLID_SHARE: usize = 16;

/// An octagon this many pens wide fits in no crossing of lines: where three cross at 60°, a disc of two pens fits, and
/// blur and noise fill corners.
const BULK_PENS: f64 = 3.0;

/// Pixels by which a shape is larger than the octagons in it, and the share of their width: a disc just wider than them
/// leaves that much.
const RIM_PX: usize = 2;
const RIM_SHARE: usize = 12;

/// The ink in two kinds of parts.
#[derive(Debug)]
pub(crate) struct Parts {
    /// Patches of lines, each with its skeleton's graph.
    pub(crate) lines: Vec<(Region, Graph)>,
    /// Filled shapes.
    pub(crate) shapes: Vec<Region>,
    /// The ink of all shapes.
    pub(crate) shape_mask: Mask,
}

impl Parts {
    /// Every patch as lines.
    pub(crate) fn all_lines(mask: &Mask, regions: Vec<Region>) -> Self {
        let lines = graphs(mask, regions);
        Self { lines, shapes: Vec::new(), shape_mask: Mask::empty(mask.width, mask.height) }
    }

    /// Each part by its width.
    pub(crate) fn of(mask: &Mask, patches: Vec<Region>, keep_dust: bool) -> Self {
        let side = mask.width.min(mask.height) / SOLID_SHARE;
        let solid = mask.clone().eroded(side);
        let (bulky, thin): (Vec<Region>, Vec<Region>) =
            patches.into_iter().partition(|region| region.cells(&solid).next().is_some());
        let thin = graphs(&mask.clone().without(&mask_of(mask, &bulky)), thin);
        let pen = pen_width(thin.iter().map(|(_, graph)| graph));
        let thin = if keep_dust { thin } else { without_dust(mask, &bulky, thin, pen) };
        let pen = if pen > 0.0 { pen } else { stick_width(thin.iter().map(|(_, graph)| graph)) };
        let (lines, wide): (Vec<_>, Vec<_>) =
            thin.into_iter().partition(|(_, graph)| graph.is_pure_line(pen));
        let mut sorter = Sorter { pen, lines, shape_mask: Mask::empty(mask.width, mask.height) };
        sorter.sort(bulky, wide, 2 * side);
        let Sorter { lines, shape_mask, .. } = sorter;
        Self { lines, shapes: regions(&shape_mask), shape_mask }
    }
}

impl Region {
    /// Whether a piece touches what it lies beside with its ends only. A sliver, which octagons leave along a slanted
    /// edge, touches it all along.
    fn leads_away(&self, beside: &Mask, graph: &Graph) -> bool {
        let width = 2.0 * graph.widest();
        let touching = self.cells(beside).count() as f64;
        // two rows of pixels at either end
        touching <= 4.0 * width + 0.25 * graph.length()
    }
}

/// Specks of fewer pixels may be dust; so may those smaller than the pen's own dot, which covers π/4 of its width
/// squared.
const SPECK_PX: f64 = 10.0;
const SPECK_PENS: f64 = 0.6;
/// A speck this near to a line, pen widths, and not much smaller than the pen, squared, belongs to it: the dot of an i.
const BELONGS_PENS: f64 = 4.0;
const LEAST_DOT_PENS: f64 = 0.4;

/// Without the specks that lie by themselves.
fn without_dust(mask: &Mask, bulky: &[Region], thin: Vec<(Region, Graph)>, pen: f64) -> Vec<(Region, Graph)> {
    let speck = |region: &Region| (region.area() as f64) < SPECK_PX.max(SPECK_PENS * pen * pen);
    let drawn = thin.iter().map(|(region, _)| region).filter(|r| !speck(r)).chain(bulky);
    let drawn = mask_of(mask, drawn);
    // a picture of nothing but specks means them
    if drawn.is_empty() {
        return thin;
    }
    let reach = (BELONGS_PENS * pen).max(SPECK_PX) as usize;
    let dot =
        |region: &Region| region.area() as f64 >= LEAST_DOT_PENS * pen * pen && region.is_near(&drawn, reach);
    thin.into_iter().filter(|(region, _)| !speck(region) || dot(region)).collect()
}

/// Parts the patches that may hold both kinds.
struct Sorter {
    /// The picture's, px; 0 where none is known.
    pen: f64,
    lines: Vec<(Region, Graph)>,
    shape_mask: Mask,
}

impl Sorter {
    /// `bulky` patches are wider than any pen somewhere, `wide` ones wider than a line of the pen.
    ///
    /// Where the pen is known, octagons that fit into none of its lines tell shapes from lines. Where it is not,
    /// octagons of half a patch's own width or more do: each patch is parted by the first that fits, from the widest on.
    fn sort(&mut self, bulky: Vec<Region>, wide: Vec<(Region, Graph)>, widest: usize) {
        let mut left: Vec<(Region, Option<Graph>)> = bulky.into_iter().map(|region| (region, None)).collect();
        left.extend(wide.into_iter().map(|(region, graph)| (region, Some(graph))));
        let known = (BULK_PENS * self.pen + 2.0).ceil() as usize;
        let mut width = if self.pen > 0.0 { known } else { widest };
        while !left.is_empty() {
            let mask = mask_of(&self.shape_mask, left.iter().map(|(region, _)| region));
            let inner = mask.clone().opened(width.max(LEAST_BULK));
            let (fits, rest): (Vec<_>, Vec<_>) =
                left.into_iter().partition(|(region, _)| region.cells(&inner).next().is_some());
            let rim = RIM_PX + width / RIM_SHARE;
            self.split(mask_of(&mask, fits.iter().map(|(region, _)| region)), inner.dilated_by(rim));
            left = rest;
            if self.pen > 0.0 || width <= LEAST_BULK {
                break;
            }
            width /= 2;
        }
        for (region, graph) in left {
            match graph {
                Some(graph) if !graph.is_shape(self.pen) => self.lines.push((region, graph)),
                _ => region.fill_into(&mut self.shape_mask),
            }
        }
    }

    /// Lines that lead away from what octagons and their rims cover, and the shapes without them.
    fn split(&mut self, mixed: Mask, covered: Mask) {
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
        for (piece, graph) in graphs(&rest, long) {
            match graph.is_line_beside(self.pen) && piece.leads_away(&beside, &graph) {
                true => self.lines.push((piece, graph)),
                false => piece.fill_into(&mut self.shape_mask),
            }
        }
    }
}

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

/// The mask of these regions alone.
fn mask_of<'a>(like: &Mask, regions: impl IntoIterator<Item = &'a Region>) -> Mask {
    let mut mask = Mask::empty(like.width, like.height);
    regions.into_iter().for_each(|region| region.fill_into(&mut mask));
    mask
}

/// The regions, which are all the ink of `mask`, with their skeletons' graphs.
fn graphs(mask: &Mask, regions: Vec<Region>) -> Vec<(Region, Graph)> {
    let mut skeleton = Skeleton::new(mask, thin::thinned(mask.clone()));
    let read = |region: Region| {
        let cells = skeleton.cells_of(&region);
        let mut graph = Graph::read(&mut skeleton, &cells);
        prune::prune(&mut graph);
        (region, graph)
    };
    regions.into_iter().map(read).collect()
}

/// The median width along all lines of the picture, px; 0 if there are none.
fn pen_width<'a>(graphs: impl Iterator<Item = &'a Graph>) -> f64 {
    let lines = graphs.filter(|graph| !graph.is_uneven() && !graph.is_blob());
    2.0 * median(&lines.flat_map(Graph::radii).collect::<Vec<_>>())
}

/// The median width of lines that lead to shapes, px; 0 if there are none.
fn stick_width<'a>(graphs: impl Iterator<Item = &'a Graph>) -> f64 {
    let sticks = graphs.filter(|graph| graph.is_uneven());
    2.0 * median(&sticks.flat_map(Graph::narrow_radii).collect::<Vec<_>>())
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

    fn length(&self) -> f64 {
        self.branches.iter().map(|b| b.length()).sum()
    }

    /// Whether the ink's width varies along its skeleton as no pen's does: it runs out towards a shape's corners.
    fn is_uneven(&self) -> bool {
        let radii = self.radii();
        let at = |share| at_share(&radii, share);
        at(90) > 1.5 * at(50) + 0.7
    }

    /// Whether the ink is hardly longer than wide, or goes round holes that are smaller than it is wide.
    fn is_blob(&self) -> bool {
        let width = |share| 2.0 * at_share(&self.radii(), share);
        let least = match self.rounds() {
            0 => 2.5 * 2.0 * self.widest(),
            // squares whose holes are as wide as their sides; of more, each shares two of its sides with others
            rounds @ 1..=2 => 8.0 * rounds as f64 * width(75),
            rounds => 4.0 * (rounds + 1) as f64 * width(50),
        };
        self.length() < least
    }

    /// The half widths of the part that is about as narrow as the narrowest quarter, if that is long enough for a line.
    fn narrow_radii(&self) -> Vec<f64> {
        let mut radii = self.radii();
        let narrow = at_share(&radii, 25);
        radii.retain(|r| (0.8 * narrow..=1.25 * narrow + 0.5).contains(r));
        if radii.len() as f64 > 8.0 * narrow { radii } else { Vec::new() }
    }

    /// How many ways round there are in a connected graph (its first Betti number).
    fn rounds(&self) -> usize {
        let rings = self.branches.iter().filter(|b| b.ring).count();
        // free ends are nodes of their own; some nodes have lost their branches
        let free = self.branches.iter().flat_map(|b| b.nodes).filter(Option::is_none).count() - 2 * rings;
        let nodes = self.ends_at_nodes().iter().filter(|ends| !ends.is_empty()).count();
        (self.branches.len() + usize::from(rings == 0)).saturating_sub(nodes + free)
    }

    fn widest(&self) -> f64 {
        self.branches.iter().flat_map(|b| b.radii.iter().copied()).fold(0.0, f64::max)
    }

    /// Whether no part of it is wider than two lines of the pen where they cross.
    fn is_pure_line(&self, pen: f64) -> bool {
        2.0 * self.widest() <= 1.6 * pen + 1.0
    }

    /// Whether this was filled and not drawn with a pen of width `pen` (0: no line is known in this picture).
    fn is_shape(&self, pen: f64) -> bool {
        let wide = pen > 0.0 && 2.0 * at_share(&self.radii(), 50) > 2.2 * pen;
        2.0 * self.widest() > 1.6 * pen && (wide || self.is_uneven() || self.is_blob())
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
