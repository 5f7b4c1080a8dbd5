use tracelight_image::{Grey, Mask, Region, pinholes, regions};
use tracelight_sheet::Page;
use tracelight_stroke::{Affine, Drawing, Stroke, StrokeKind, polyline_length};

use crate::centreline;
use crate::comb::Rules;
use crate::contrast::{Edge, is_cut_off, stands_out};
use crate::crumbs::Usual;
use crate::dots::{self, Dots, Dotted};
use crate::dust::Dust;
use crate::graph::Graph;
use crate::ink::Ink;
use crate::inside::inside;
use crate::options::{Mode, Options};
use crate::outline::Outliner;
use crate::parts::Parts;
use crate::row::Row;
use crate::seen::Seen;
use crate::twice::{self, Once};
use crate::{Quality, VisionError, closer, gap, missed, on_ink, rest, screen, sweep, tone};

/// What an image draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// Pixels in a row of the image.
    pub width_px: usize,
    /// Rows of the image.
    pub height_px: usize,
    /// The tracer used.
    pub mode: Mode,
    /// The strokes, pixel frame.
    pub strokes: Drawing,
    /// Figures of the image.
    pub quality: Quality,
    /// Share of the pen lines' ink that lies further from every stroke than the pen reaches: lost, or run together.
    pub missed_ink: f64,
    /// What was left out on purpose.
    pub left_out: LeftOut,
    /// Rules of ruled or squared paper, which are excluded from the strokes.
    pub rules: Option<Rules>,
}

/// What of an image's ink, and of the ways between it, is in no stroke on purpose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LeftOut {
    /// Patches of six pixels or more that were taken for dust: smaller than the pen, and by themselves; and the crumbs of a pencil.
    pub specks: usize,
    /// The largest of them, px².
    pub largest_speck_px2: usize,
    /// The dots of dotted paper.
    pub dots: Option<Dots>,
    /// Length of the ways over paper that were cut out of strokes, px.
    pub over_paper_px: f64,
    /// Length of repeated pencil lines that were merged, px.
    pub again_px: f64,
    /// Lines that are the edge of a sheet, of a table or of a shadow.
    pub edges: usize,
    /// Areas that were coloured in paler than the lines about them, which alone are drawn.
    pub areas: usize,
}

/// Finds the strokes of an image: of the sheet of paper in it, if it shows one with something beside it.
///
/// # Errors
/// As [`trace_page`].
pub fn trace(image: &Grey, options: &Options) -> Result<Traced, VisionError> {
    trace_page(&Page::of(image), options)
}

/// Finds the strokes of a page, in the pixel frame of the whole image.
///
/// # Errors
/// When the page has no ink, no contrast, nothing but noise, looks like no drawing, or (sweep) is no single closed
/// figure; when an option is out of its bounds, or leaves nothing.
pub fn trace_page(page: &Page<'_>, options: &Options) -> Result<Traced, VisionError> {
    options.check()?;
    let Seen { mut ink, mut mask, tone_percent, areas } = Seen::of(page, options)?;
    tone_percent.map_or(Ok(()), tone::check)?;
    if ink.is_thin(&mask) {
        ink = ink.doubled();
        mask = ink.mask();
    }
    // it is told in the image's pixels, however close the look
    let options = &Options { tolerance_px: options.tolerance_px / ink.scale.min(1.0), ..*options };
    let patches = Patches::of(&mut mask, &ink, options)?;
    if options.judges() {
        screen::check(page.given(), patches.drawn.len())?;
    }
    let regions = &patches.drawn;
    let largest_px = regions.iter().map(Region::area).max().unwrap_or(0);
    let only = |strokes: Vec<Stroke>| Found { strokes, missed_ink: 0.0, left_out: LeftOut::default() };
    let Found { strokes, missed_ink, left_out } = match options.mode {
        Mode::Sweep => {
            let area = regions.iter().map(Region::area).sum();
            only(vec![sweep::stroke(&mask, area)?])
        }
        Mode::Outline => only(outlines(&ink, &mask, &mask, regions, options)),
        Mode::Auto | Mode::Centreline => lines_and_shapes(&ink, mask, patches, options),
    };
    let (width, height) = (ink.darkness.width as f64, ink.darkness.height as f64);
    if strokes.is_empty() && areas.outlines.is_empty() {
        return Err(VisionError::NoInk { largest_px, least_px: largest_px + 1 });
    }
    let strokes = strokes.iter().map(|s| s.along(inside(&s.path, width, height))).collect();
    let strokes = Drawing { strokes };
    let mut strokes = strokes.transformed(Affine::scale(ink.scale));
    let edges = drop_edges(&mut strokes, page, ink.quality.light_on_dark);
    strokes.strokes.extend(areas.outlines);
    if options.sheets {
        strokes = ink_only(&strokes, &page.picture, ink.quality.light_on_dark);
    }
    let (right, down) = page.origin;
    let strokes = strokes.transformed(Affine::translate((right as f64, down as f64)));
    let strokes = long_enough(strokes, options.min_length_px)?;
    Ok(Traced {
        width_px: page.size.0,
        height_px: page.size.1,
        mode: options.mode,
        quality: Quality { pen_px: usual_pen(&strokes), tone_percent, ..ink.quality },
        strokes,
        missed_ink,
        left_out: LeftOut { edges, areas: areas.lined, ..left_out.scaled(ink.scale) },
        rules: ink.rules.map(|off| off.rules.scaled(ink.scale)),
    })
}

/// Strokes in px of the ink's plane, and what is in none.
struct Found {
    strokes: Vec<Stroke>,
    missed_ink: f64,
    left_out: LeftOut,
}

impl LeftOut {
    /// In px of an image that has so many along one of these.
    fn scaled(self, by: f64) -> Self {
        Self {
            largest_speck_px2: (self.largest_speck_px2 as f64 * by * by).round() as usize,
            dots: self.dots.map(|dots| Dots { spacing_px: dots.spacing_px * by, ..dots }),
            over_paper_px: self.over_paper_px * by,
            again_px: self.again_px * by,
            ..self
        }
    }
}

/// What stands out less than this share of what stands out most is an edge of paper or of a shadow: a pencil beside a pen keeps more.
const LEAST_CONTRAST: f64 = 0.25;

/// Strokes that are ink.
fn ink_only(drawing: &Drawing, image: &Grey, light_on_dark: bool) -> Drawing {
    let contrast = |stroke: &Stroke| stands_out(image, stroke, light_on_dark);
    let contrasts: Vec<f64> = drawing.strokes.iter().map(contrast).collect();
    let least = LEAST_CONTRAST * contrasts.iter().copied().fold(0.0, f64::max);
    let kept = drawing.strokes.iter().zip(&contrasts).filter(|(_, contrast)| **contrast >= least);
    Drawing { strokes: kept.map(|(stroke, _)| stroke.clone()).collect() }
}

/// At more of the picture's borders than this a line is a frame that they cut.
const MOST_CUT: usize = 2;

/// Takes away the lines that are edges of paper or of shadows, and the shapes that are what is left of the table, unless there is
/// nothing else; how many they were.
fn drop_edges(drawing: &mut Drawing, page: &Page<'_>, light_on_dark: bool) -> usize {
    let is_table =
        |stroke: &Stroke| page.beside.as_ref().is_some_and(|beside| is_cut_off(stroke, &beside.mask));
    let of = |stroke: &Stroke| match is_table(stroke) {
        true => Some(Edge::Seen),
        false => Edge::of(&page.picture, stroke, light_on_dark),
    };
    let edges = drawing.strokes.iter().map(of);
    let edges: Vec<Option<Edge>> = edges.collect();
    let cut = (0..4).filter(|&border| edges.contains(&Some(Edge::AtBorder(border)))).count();
    let is_none = |edge: &Option<Edge>| match edge {
        Some(Edge::Seen) => false,
        Some(Edge::AtBorder(_)) => cut > MOST_CUT,
        None => true,
    };
    let kept = edges.iter().filter(|edge| is_none(edge)).count();
    if kept == 0 {
        return 0;
    }
    let mut left = edges.iter();
    drawing.strokes.retain(|_| left.next().is_some_and(is_none));
    edges.len() - kept
}

/// Chords that measure a length or a pen's share of it stay this close to their path, px.
const LENGTH_TOLERANCE_PX: f64 = 0.1;

/// Without the strokes that are shorter than asked for.
fn long_enough(mut drawing: Drawing, least_px: f64) -> Result<Drawing, VisionError> {
    if least_px > 0.0 {
        let mut longest_px = 0.0_f64;
        drawing.strokes.retain(|stroke| {
            let length = stroke.path.length(LENGTH_TOLERANCE_PX);
            longest_px = longest_px.max(length);
            length >= least_px
        });
        if drawing.strokes.is_empty() {
            return Err(VisionError::TooShort { longest_px, least_px });
        }
    }
    Ok(drawing)
}

/// The median width of the pen over the length of the lines, px.
fn usual_pen(drawing: &Drawing) -> Option<f64> {
    let of = |stroke: &Stroke| {
        // of a curve its joints' distances: a weight needs no more
        let places = stroke.path.pieces().map(|piece| piece.from).chain([stroke.path.end()]);
        let places: Vec<_> = places.collect();
        let length = polyline_length(&places);
        stroke.pen.filter(|_| stroke.kind == StrokeKind::Centreline).map(|pen| (pen, length))
    };
    let mut pens: Vec<(f64, f64)> = drawing.strokes.iter().filter_map(of).collect();
    pens.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * pens.iter().map(|(_, length)| length).sum::<f64>();
    let mut passed = 0.0;
    let reached = |(_, length): &&(f64, f64)| {
        passed += length;
        passed >= half
    };
    pens.iter().find(reached).map(|&(pen, _)| pen)
}

/// Pixels a patch must have: six, or as many as asked for. Where no pen is looked for that could tell dust, a speck of a
/// 120th of the picture's shorter side either way is dust too.
fn least_patch(ink: &Ink, options: &Options) -> usize {
    let averaged = ink.scale * ink.scale;
    let asked = options.despeckle_px2.map(|area| (area / averaged).ceil() as usize);
    let side = ink.darkness.width.min(ink.darkness.height) / 120;
    asked.unwrap_or(match options.mode {
        Mode::Auto | Mode::Centreline => ink.px2(LEAST_PX),
        Mode::Outline | Mode::Sweep => (side * side).max(ink.px2(LEAST_PX)),
    })
}

/// The patches of a mask.
struct Patches {
    drawn: Vec<Region>,
    /// Too small to be drawn on purpose; no longer in the mask.
    specks: Vec<Region>,
}

impl Patches {
    /// Those that are large enough, their pinholes filled, and the others, which are taken out.
    fn of(mask: &mut Mask, ink: &Ink, options: &Options) -> Result<Self, VisionError> {
        let least_px = least_patch(ink, options);
        pinholes(mask, ink.px2(LEAST_HOLE_PX)).iter().for_each(|hole| hole.fill_into(mask));
        let (drawn, specks): (Vec<Region>, Vec<Region>) =
            regions(mask).into_iter().partition(|r| r.area() >= least_px);
        specks.iter().for_each(|speck| speck.erase_from(mask));
        if drawn.is_empty() {
            let largest_px = specks.iter().map(Region::area).max().unwrap_or(0);
            return Err(VisionError::NoInk { largest_px, least_px });
        }
        Ok(Self { drawn, specks })
    }

    /// Takes the dots of dotted paper out; a picture of nothing else means them.
    fn take_dots(&mut self, mask: &mut Mask) -> Option<Dotted> {
        let dotted = dots::of_paper(&self.drawn, &self.specks, (mask.width(), mask.height()));
        let dotted = dotted.filter(|dotted| dotted.is_dot.contains(&false))?;
        let mut is_dot = dotted.is_dot.iter();
        self.drawn.retain(|region| {
            let is_dot = is_dot.next() == Some(&true);
            if is_dot {
                region.erase_from(mask);
            }
            !is_dot
        });
        Some(dotted)
    }
}

/// Fewer pixels of paper than this were never left out on purpose.
const LEAST_HOLE_PX: usize = 3;

/// Fewer pixels of ink than this were never drawn on purpose.
const LEAST_PX: usize = 6;

/// The outlines of some shapes, which are all the ink of `filled`; `mask` is all there is.
fn outlines(ink: &Ink, filled: &Mask, mask: &Mask, shapes: &[Region], options: &Options) -> Vec<Stroke> {
    let mut outliner = Outliner::new(&ink.darkness, filled, mask, ink.edge_px().unwrap_or(1.0));
    shapes.iter().flat_map(|shape| outliner.strokes(shape, options)).collect()
}

/// The rows of all lines.
fn rows_of(ink: &Ink, parts: &Parts) -> Vec<Row> {
    let (dark, shapes) = (&ink.darkness, &parts.shape_mask);
    let of = |(region, graph): &(Region, Graph)| {
        let closer = closer::rows(dark, ink.threshold, (&parts.ink, shapes), (region, graph));
        closer.unwrap_or_else(|| centreline::rows(dark, shapes, region, graph))
    };
    parts.lines.iter().flat_map(of).collect()
}

/// What is a line and what a shape, and the rows of the lines; looked at again with the ink that lines go on in where it is paler.
fn parts_and_rows(ink: &Ink, mask: Mask, patches: Patches, options: &Options) -> (Parts, Vec<Row>) {
    let parts_of = |mask: Mask, patches: Patches| {
        let dust = match (options.despeckle_px2, &ink.rules) {
            (Some(_), _) => Dust::Kept,
            (None, None) => Dust::Dropped,
            (None, Some(off)) => Dust::DroppedOnRules(off),
        };
        match options.mode {
            Mode::Centreline => Parts::all_lines(&ink.darkness, mask, patches.drawn),
            _ => Parts::of(&ink.darkness, mask, patches.drawn, dust),
        }
    };
    let mut parts = parts_of(mask, patches);
    let mut rows = rows_of(ink, &parts);
    // no patch is smaller with more ink: nothing is refused that was not before
    if let Some(mut more) = ink.goes_on(&parts.ink, &rows)
        && let Ok(patches) = Patches::of(&mut more, ink, options)
    {
        parts = parts_of(more, patches);
        rows = rows_of(ink, &parts);
    }
    (parts, rows)
}

fn lines_and_shapes(ink: &Ink, mut mask: Mask, mut patches: Patches, options: &Options) -> Found {
    let dark = &ink.darkness;
    let dotted = options.despeckle_px2.is_none().then(|| patches.take_dots(&mut mask)).flatten();
    let (mut parts, rows) = parts_and_rows(ink, mask, patches, options);
    let mask = &parts.ink;
    let lined: Vec<&Region> = parts.lines.iter().map(|(region, _)| region).collect();
    let rows = rest::with_rest(dark, &lined, rows);
    let rows = match &dotted {
        Some(dotted) => dotted.off(rows),
        None => rows,
    };
    let (rows, over_paper_px) = on_ink::only(mask, gap::bridged(dark, rows));
    // what is made of two passes lies between them, no further than a pen and a half from its ink
    let Once { rows, before, again_px } = match options.despeckle_px2 {
        None => twice::once(dark, rows),
        Some(_) => Once { rows, ..Once::default() },
    };
    let is_left = |row: &Row| ink.rules.as_ref().is_some_and(|off| off.left_line(&row.points, row.width));
    let (left, rows): (Vec<Row>, Vec<Row>) = rows.into_iter().partition(is_left);
    let is_sketch = !before.is_empty();
    // a pen leaves none
    let leaves_crumbs = options.despeckle_px2.is_none() && (ink.pencil.is_some() || is_sketch);
    let usual = leaves_crumbs.then(|| Usual::of(dark, &rows));
    let (crumbs, rows): (Vec<Row>, Vec<Row>) =
        rows.into_iter().partition(|row| usual.is_some_and(|usual| usual.is_crumb(dark, row)));
    let of_shapes = |shapes: Vec<Region>| -> (Vec<Region>, Vec<Region>) {
        shapes.into_iter().partition(|shape| usual.is_some_and(|usual| usual.is_smudge(dark, shape)))
    };
    let (mut smudges, shapes) = of_shapes(std::mem::take(&mut parts.shapes));
    let mut strokes = outlines(ink, &parts.shape_mask, mask, &shapes, options);
    strokes.extend(rows.iter().filter_map(|row| centreline::stroke(dark, row, options)));
    // crumbs, what rules left and passes that are one line now are left out on purpose, not missed
    let known = crumbs.iter().chain(&left).chain(&before);
    let known: Vec<Stroke> = known.filter_map(centreline::unfitted).collect();
    let counts = missed::counts(mask, &lined, strokes.iter().chain(&known));
    let (mut missed, mut all) = (0, 0);
    let mut lost_ink = Mask::empty(mask.width(), mask.height());
    for (region, (area, lost)) in lined.iter().zip(counts) {
        all += area;
        match missed::is_none_of_lines(lost, area) {
            true => region.fill_into(&mut lost_ink),
            false => missed += lost,
        }
    }
    // no lines, whatever they are: then their edges at least
    if !lost_ink.is_empty() {
        let (more, lost) = of_shapes(regions(&lost_ink));
        smudges.extend(more);
        strokes.extend(outlines(ink, &lost_ink, mask, &lost, options));
    }
    let specks = parts.dust.iter().chain(&smudges).map(Region::area).chain(crumbs.iter().map(Row::area_px2));
    let left_out = LeftOut {
        specks: specks.clone().count(),
        largest_speck_px2: specks.max().unwrap_or(0),
        dots: dotted.map(|dotted| dotted.told),
        over_paper_px,
        again_px,
        ..LeftOut::default()
    };
    Found { strokes, missed_ink: missed as f64 / (all as f64).max(1.0), left_out }
}
