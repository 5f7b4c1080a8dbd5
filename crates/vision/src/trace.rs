use tracelight_stroke::{Affine, Drawing, Stroke};

use crate::graph::{Graph, Skeleton};
use crate::ink::Ink;
use crate::mask::Mask;
use crate::missed;
use crate::outline::Walked;
use crate::region::{Region, pinholes, regions};
use crate::ridge::median;
use crate::{Grey, Quality, VisionError, centreline, outline, prune, solid, sweep, thin};

/// Which tracer follows the ink.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Centrelines of pen lines, outlines of filled shapes, patch by patch.
    #[default]
    Auto,
    /// The middle of every line.
    Centreline,
    /// The edge of every patch.
    Outline,
    /// The original report's walk round one closed figure.
    Sweep,
}

impl Mode {
    /// `auto`, `centreline`, `outline` or `sweep`.
    pub const fn name(self) -> &'static str {
        match self {
            Mode::Auto => "auto",
            Mode::Centreline => "centreline",
            Mode::Outline => "outline",
            Mode::Sweep => "sweep",
        }
    }
}

/// How an image is traced. The default works on any clean drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Which tracer.
    pub mode: Mode,
    /// Furthest a path may be from the points found, px.
    pub tolerance_px: f64,
    /// Change of direction from which on a break is a corner, rad.
    pub corner_rad: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { mode: Mode::Auto, tolerance_px: 0.35, corner_rad: 25f64.to_radians() }
    }
}

/// What an image draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// Pixels in a row of the image.
    pub width_px: usize,
    /// Rows of the image.
    pub height_px: usize,
    /// The tracer that was asked for.
    pub mode: Mode,
    /// The strokes, pixel frame.
    pub strokes: Drawing,
    /// Figures of the image.
    pub quality: Quality,
    /// Share of the pen lines' ink that lies further from every stroke than the pen reaches: lost, or run together.
    pub missed_ink: f64,
}

/// Finds the strokes of an image.
///
/// # Errors
/// When the image has no ink, no contrast, nothing but noise, or (sweep) is no single closed figure.
pub fn trace(image: &Grey, options: &Options) -> Result<Traced, VisionError> {
    let ink = Ink::of(image)?;
    let mut mask = ink.mask();
    let regions = drawn(&mut mask)?;
    let (strokes, missed_ink) = match options.mode {
        Mode::Sweep => {
            let area = regions.iter().map(Region::area).sum();
            (vec![sweep::stroke(&mask, area)?], 0.0)
        }
        Mode::Outline => (outlines(&ink, &mask, &regions, options), 0.0),
        Mode::Auto | Mode::Centreline => lines_and_shapes(&ink, &mask, &regions, options),
    };
    if strokes.is_empty() {
        let largest_px = regions.iter().map(Region::area).max().unwrap_or(0);
        return Err(VisionError::NoInk { largest_px, least_px: largest_px + 1 });
    }
    let scale = Affine::scale(ink.reduction as f64);
    Ok(Traced {
        width_px: image.width(),
        height_px: image.height(),
        mode: options.mode,
        strokes: Drawing { strokes }.transformed(scale),
        quality: ink.quality,
        missed_ink,
    })
}

/// The regions that are large enough to have been drawn, their pinholes filled: a speck of a 120th of the picture's
/// height either way is dust, and one of fewer than 6 px always.
fn drawn(mask: &mut Mask) -> Result<Vec<Region>, VisionError> {
    let side = mask.width.min(mask.height) / 120;
    let least_px = (side * side).max(LEAST_PX);
    pinholes(mask, LEAST_PX).iter().for_each(|hole| hole.fill_into(mask));
    let (found, dust): (Vec<Region>, Vec<Region>) =
        regions(mask).into_iter().partition(|r| r.area() >= least_px);
    dust.iter().for_each(|speck| speck.erase_from(mask));
    if found.is_empty() {
        let largest_px = dust.iter().map(Region::area).max().unwrap_or(0);
        return Err(VisionError::NoInk { largest_px, least_px });
    }
    Ok(found)
}

/// Fewer pixels than this were never drawn, nor left out, on purpose.
const LEAST_PX: usize = 6;

fn outlines(ink: &Ink, mask: &Mask, regions: &[Region], options: &Options) -> Vec<Stroke> {
    let mut walked = Walked::none(mask.width, mask.height);
    let each = |r: &Region| outline::strokes(&ink.darkness, mask, r, &mut walked, options);
    regions.iter().flat_map(each).collect()
}

/// What became of a region: lines, or a shape whose outline is to be followed.
enum Kind {
    Lines(Graph),
    Shape,
}

/// The strokes, and the share of the lines' ink that they miss.
fn lines_and_shapes(ink: &Ink, mask: &Mask, regions: &[Region], options: &Options) -> (Vec<Stroke>, f64) {
    let mut walked = Walked::none(mask.width, mask.height);
    let (mut strokes, mut lined) = (Vec::new(), Vec::new());
    for (region, kind) in regions.iter().zip(kinds(mask, regions, options.mode)) {
        strokes.extend(match kind {
            Kind::Lines(graph) => {
                lined.push(region);
                centreline::strokes(&ink.darkness, region, &graph, options)
            }
            Kind::Shape => outline::strokes(&ink.darkness, mask, region, &mut walked, options),
        });
    }
    let missed = missed::share(mask, &lined, &strokes);
    (strokes, missed)
}

/// Lines or shape, for each region.
fn kinds(mask: &Mask, regions: &[Region], mode: Mode) -> Vec<Kind> {
    // no pen's lines, nor two of them where they cross, hold a square of a 16th of the picture
    let side = mask.width.min(mask.height) / 16;
    let solid: Vec<bool> = match mode {
        Mode::Auto => solid::hold_a_square(mask, regions, side),
        _ => vec![false; regions.len()],
    };
    let mut thick = Mask::empty(mask.width, mask.height);
    regions.iter().zip(&solid).filter(|(_, solid)| **solid).for_each(|(r, _)| r.fill_into(&mut thick));
    let mut skeleton = Skeleton::new(mask, thin::thinned(mask.clone().without(&thick)));
    let mut graph = |region: &Region| {
        let cells = skeleton.cells_of(region);
        let mut graph = Graph::read(&mut skeleton, &cells);
        prune::prune(&mut graph);
        graph
    };
    let graphs: Vec<Option<Graph>> =
        regions.iter().zip(&solid).map(|(r, &solid)| (!solid).then(|| graph(r))).collect();
    let pen = pen_width(graphs.iter().flatten());
    let kind = |graph: Option<Graph>| match graph {
        Some(graph) if mode == Mode::Centreline || !graph.is_shape(pen) => Kind::Lines(graph),
        _ => Kind::Shape,
    };
    graphs.into_iter().map(kind).collect()
}

/// The picture's pen: the median width along all of its lines, px.
fn pen_width<'a>(graphs: impl Iterator<Item = &'a Graph>) -> f64 {
    let lines = graphs.filter(|g| !g.is_uneven() && !g.is_blob());
    2.0 * median(
        &lines.flat_map(|g| g.branches.iter().flat_map(|b| b.radii.iter().copied())).collect::<Vec<_>>(),
    )
}

impl Graph {
    fn radii(&self) -> Vec<f64> {
        let mut radii: Vec<f64> = self.branches.iter().flat_map(|b| b.radii.iter().copied()).collect();
        radii.sort_by(f64::total_cmp);
        radii
    }

    /// Whether the ink's width varies along its skeleton as no pen's does: it runs out towards a shape's corners.
    fn is_uneven(&self) -> bool {
        let radii = self.radii();
        let at = |share: usize| radii.get(radii.len() * share / 100).copied().unwrap_or(0.0);
        at(90) > 1.5 * at(50) + 0.7
    }

    /// Whether the ink is hardly longer than wide.
    fn is_blob(&self) -> bool {
        let length: f64 = self.branches.iter().map(|b| b.length()).sum();
        length < 2.5 * 2.0 * self.widest()
    }

    fn widest(&self) -> f64 {
        self.radii().last().copied().unwrap_or(0.0)
    }

    /// Whether this was filled and not drawn with a pen of width `pen` (0: no line is known in this picture).
    fn is_shape(&self, pen: f64) -> bool {
        let large = 2.0 * self.widest() > 1.6 * pen;
        large && (self.is_uneven() || self.is_blob() || (pen > 0.0 && 2.0 * self.widest() > 3.0 * pen))
    }
}
