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
const SOLID_SHARE: usize = 16;

/// An octagon this many pens wide fits in no crossing of lines: where three cross at 60°, a disc of two pens fits, and
/// blur and noise fill corners.
const BULK_PENS: f64 = 3.0;

/// Pixels by which a shape is larger than the octagons in it: what is left of a disc by them is thinner.
const RIM: usize = 2;

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
    pub(crate) fn of(mask: &Mask, patches: Vec<Region>) -> Self {
        let solid = mask.clone().eroded(mask.width.min(mask.height) / SOLID_SHARE);
        let (bulky, thin): (Vec<Region>, Vec<Region>) =
            patches.into_iter().partition(|region| region.cells(&solid).next().is_some());
        let thin = graphs(&mask.clone().without(&mask_of(mask, &bulky)), thin);
        let pen = pen_width(thin.iter().map(|(_, graph)| graph));
        let (mut lines, wide): (Vec<_>, Vec<_>) =
            thin.into_iter().partition(|(_, graph)| graph.is_pure_line(pen));
        let doubtful = mask_of(mask, wide.iter().map(|(region, _)| region).chain(&bulky));
        let inner = doubtful.clone().opened(bulk_width(&doubtful, pen));
        // what holds no octagon is a small shape, or lines of a wider pen, and is judged whole
        let (mixed, whole): (Vec<_>, Vec<_>) =
            wide.into_iter().partition(|(region, _)| region.cells(&inner).next().is_some());
        let (small, lines_too): (Vec<_>, Vec<_>) =
            whole.into_iter().partition(|(_, graph)| graph.is_shape(pen));
        lines.extend(lines_too);
        let mut shape_mask = mask_of(mask, small.iter().map(|(region, _)| region));
        let mixed = mask_of(mask, mixed.iter().map(|(region, _)| region).chain(&bulky));
        let (sticks, shapes) = split(mixed, inner, pen);
        lines.extend(sticks);
        shape_mask = shape_mask.or(&shapes);
        Self { lines, shapes: regions(&shape_mask), shape_mask }
    }
}

/// Width of an octagon that fits into no line, px: some pens, and two pixels for how coarsely thin ones are measured;
/// where no pen is known, half of the widest place.
fn bulk_width(mask: &Mask, pen: f64) -> usize {
    if pen > 0.0 { (BULK_PENS * pen + 2.0).ceil() as usize } else { (widest_square(mask) / 2).max(3) }
}

/// Lines that lead away from what is wider than the pen, and the shapes without them. `inner` is what octagons cover.
fn split(mixed: Mask, inner: Mask, pen: f64) -> (Vec<(Region, Graph)>, Mask) {
    let bulk = inner.dilated_by(RIM).and(&mixed);
    let rest = mixed.clone().without(&bulk);
    let pieces = graphs(&rest, regions(&rest));
    let (lines, corners): (Vec<_>, Vec<_>) =
        pieces.into_iter().partition(|(_, graph)| graph.is_line_beside(pen));
    let mut shapes = bulk;
    corners.iter().for_each(|(corner, _)| corner.fill_into(&mut shapes));
    (lines, shapes)
}

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

/// The side of the largest upright square in the ink, px, to an eighth.
fn widest_square(mask: &Mask) -> usize {
    let (mut fits, mut side) = (1, 2);
    while side < mask.width.min(mask.height) && !mask.clone().eroded(side).is_empty() {
        fits = side;
        side = side + (side / 8).max(1);
    }
    fits
}

/// The picture's pen: the median width along all of its lines, px; 0 if there are none.
fn pen_width<'a>(graphs: impl Iterator<Item = &'a Graph>) -> f64 {
    let lines = graphs.filter(|g| !g.is_uneven() && !g.is_blob());
    2.0 * median(
        &lines.flat_map(|g| g.branches.iter().flat_map(|b| b.radii.iter().copied())).collect::<Vec<_>>(),
    )
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
        let at = |share: usize| radii.get(radii.len() * share / 100).copied().unwrap_or(0.0);
        at(90) > 1.5 * at(50) + 0.7
    }

    /// Whether the ink is hardly longer than wide.
    fn is_blob(&self) -> bool {
        self.length() < 2.5 * 2.0 * self.widest()
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
        let large = 2.0 * self.widest() > 1.6 * pen;
        large && (self.is_uneven() || self.is_blob() || (pen > 0.0 && 2.0 * self.widest() > 3.0 * pen))
    }

    /// Whether a piece next to a shape is a line: as wide all along, and long for its width; the less so, the more its
    /// width is the pen's.
    fn is_line_beside(&self, pen: f64) -> bool {
        let radii = self.radii();
        let at = |share: usize| radii.get(radii.len() * share / 100).copied().unwrap_or(0.0);
        let width = 2.0 * at(50);
        let even = at(80) - at(20) <= (0.2 * at(50)).max(0.75);
        let pens = if (width - pen).abs() < 0.3 * pen { 1.5 } else { 4.0 };
        even && self.length() > (pens * width).max(4.0)
    }
}
