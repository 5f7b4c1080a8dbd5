use tracelight_stroke::{Affine, Drawing, Stroke};

use crate::centreline::{self, Row};
use crate::ink::Ink;
use crate::mask::Mask;
use crate::outline::Outliner;
use crate::parts::Parts;
use crate::region::{self, Region, pinholes, regions};
use crate::{Grey, Quality, VisionError, gap, missed, sweep};

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
    let largest_px = regions.iter().map(Region::area).max().unwrap_or(0);
    let (strokes, missed_ink) = match options.mode {
        Mode::Sweep => {
            let area = regions.iter().map(Region::area).sum();
            (vec![sweep::stroke(&mask, area)?], 0.0)
        }
        Mode::Outline => (outlines(&ink, &mask, &regions, options), 0.0),
        Mode::Auto | Mode::Centreline => lines_and_shapes(&ink, &mask, regions, options),
    };
    if strokes.is_empty() {
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

fn outlines(ink: &Ink, mask: &Mask, shapes: &[Region], options: &Options) -> Vec<Stroke> {
    let mut outliner = Outliner::new(&ink.darkness, mask, mask);
    shapes.iter().flat_map(|shape| outliner.strokes(shape, options)).collect()
}

/// The strokes, and the share of the lines' ink that they miss.
fn lines_and_shapes(ink: &Ink, mask: &Mask, regions: Vec<Region>, options: &Options) -> (Vec<Stroke>, f64) {
    let dark = &ink.darkness;
    let parts = match options.mode {
        Mode::Centreline => Parts::all_lines(mask, regions),
        _ => Parts::of(mask, regions),
    };
    let mut outliner = Outliner::new(dark, &parts.shape_mask, mask);
    let mut strokes: Vec<Stroke> =
        parts.shapes.iter().flat_map(|shape| outliner.strokes(shape, options)).collect();
    let rows: Vec<Row> = parts
        .lines
        .iter()
        .flat_map(|(region, graph)| centreline::rows(dark, &parts.shape_mask, region, graph))
        .collect();
    strokes.extend(gap::bridged(rows).iter().filter_map(|row| centreline::stroke(dark, row, options)));
    let lined: Vec<&Region> = parts.lines.iter().map(|(region, _)| region).collect();
    let counts = missed::counts(mask, &lined, &strokes);
    let (mut missed, mut all) = (0, 0);
    let mut lost_ink = Mask::empty(mask.width, mask.height);
    for (region, (area, lost)) in lined.iter().zip(counts) {
        all += area;
        match lost as f64 > LOST * area as f64 {
            true => region.fill_into(&mut lost_ink),
            false => missed += lost,
        }
    }
    // no lines, whatever they are: then their edges at least
    let mut outliner = Outliner::new(dark, &lost_ink, mask);
    strokes.extend(region::regions(&lost_ink).iter().flat_map(|region| outliner.strokes(region, options)));
    (strokes, missed as f64 / (all as f64).max(1.0))
}

/// A patch whose lines leave out more than this share of it is none of lines.
const LOST: f64 = 0.6;
