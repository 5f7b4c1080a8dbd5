//! Detects dust: isolated or scattered patches smaller than the pen.

use std::cell::OnceCell;

use tracelight_image::{Mask, Plane, Region, mask_of};
use tracelight_maths::powi;

use crate::comb::TakenOff;
use crate::reading::Patch;

/// What becomes of specks that are no marks.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Dust<'a> {
    Kept,
    Dropped,
    /// Where rules were taken off: what they left looks like marks, and lies where they lay.
    DroppedOnRules(&'a TakenOff),
}

/// Specks of fewer pixels may be dust; so may those smaller than the pen's own dot, which covers π/4 of its width
/// squared.
const SPECK_PX: f64 = 10.0;
const SPECK_PENS: f64 = 0.6;
/// What is narrower than this share of the pen, and no longer than so many of its widths, is a speck whatever it covers.
const HAIR_PENS: f64 = 0.6;
const HAIR_LONG: f64 = 1.6;
/// A speck this near to a line, pen widths, and not much smaller than the pen, squared, belongs to it: the dot of an i.
const BELONGS_PENS: f64 = 4.0;
const LEAST_DOT_PENS: f64 = 0.4;
/// A speck whose skeleton is so many times as long as its ink is wide in the mean was drawn line by line.
const MARK_LONG: f64 = 3.5;
/// Unless at least so many, and this many times those near lines, lie far from all that are as large but for this ratio.
const FEWEST_STREWN: usize = 12;
const STREWN: usize = 2;
const STREWN_ALIKE: f64 = 1.6;
/// Narrow ones are believed only where half of their pixels have this share of the darkness of half of the lines': hairs
/// and grit are paler, an eye is drawn with the same pen.
const AS_DARK: f64 = 0.75;

/// One that goes round, or of so many lines, so many times as long as wide, may be drawn with a thinner pen: blur leaves it paler.
const FIGURE_LINES: usize = 4;
const FIGURE_LONG: f64 = 8.0;
const FIGURE_DARK: f64 = 0.5;

/// The level that one in so many of some pixels reaches.
fn level_of(dark: &Plane<u8>, places: impl Iterator<Item = (usize, usize)>, one_in: usize) -> u8 {
    let mut counts = [0_usize; 256];
    places.for_each(|(x, y)| counts[usize::from(dark.row(y)[x])] += 1);
    let mut left = counts.iter().sum::<usize>().div_ceil(one_in);
    let reached = |level: &u8| {
        left = left.saturating_sub(counts[usize::from(*level)]);
        left == 0
    };
    (0..=255).rev().find(reached).unwrap_or(0)
}

/// The patches without the specks that lie by themselves, and those.
pub(crate) fn dusted(
    dark: &Plane<u8>,
    mask: &Mask,
    patches: Vec<Patch>,
    pen: f64,
    rules: Option<&TakenOff>,
) -> (Vec<Patch>, Vec<Region>) {
    let speck = |patch: &Patch| {
        let (width, height) = patch.region.extent();
        let is_hair = patch.reading.widest < HAIR_PENS * pen && (width.max(height) as f64) < HAIR_LONG * pen;
        is_hair || (patch.region.area() as f64) < SPECK_PX.max(SPECK_PENS * pen * pen)
    };
    let drawn = mask_of(mask, patches.iter().filter(|patch| !speck(patch)).map(|patch| &patch.region));
    // a picture of nothing but specks means them
    if drawn.is_empty() {
        return (patches, Vec::new());
    }
    let reach = (BELONGS_PENS * pen).max(SPECK_PX) as usize;
    let usual = OnceCell::new();
    let is_dark = |region: &Region, one_in: usize, least: f64| {
        let drawn = usual.get_or_init(|| level_of(dark, drawn.cells().map(|cell| drawn.place(cell)), 2));
        f64::from(level_of(dark, region.places(), one_in)) >= least * f64::from(*drawn)
    };
    let dot = |patch: &Patch| {
        let is_large = patch.region.area() as f64 >= LEAST_DOT_PENS * pen * pen;
        let is_round = patch.reading.widest >= HAIR_PENS * pen;
        is_large && (is_round || is_dark(&patch.region, 2, AS_DARK))
    };
    let is_near = |patch: &Patch| patch.region.is_near(&drawn, reach);
    let (near, far): (Vec<&Patch>, Vec<&Patch>) =
        patches.iter().filter(|patch| speck(patch)).partition(|patch| is_near(patch));
    let strewn = Strewn { near: areas(&near), far: areas(&far) };
    let belongs = |patch: &Patch| dot(patch) && is_near(patch) && !strewn.has(patch.region.area());
    // a cross, a ring, a tick, wherever it is: drawn line by line, and somewhere as dark as the others, for most of it may be edge
    let is_mark = |patch: &Patch| {
        let Patch { region, graph, reading } = patch;
        if rules.is_some_and(|rules| rules.left_patch(region)) {
            let is_large = region.area() as f64 >= SPECK_PX;
            return is_large && reading.long >= MARK_LONG && is_dark(region, 8, AS_DARK);
        }
        let long = powi(graph.reach(), 2) / region.area() as f64;
        // no hair crosses itself or goes round
        let is_figure = graph.branches.iter().any(|b| b.ring) || graph.branches.len() >= FIGURE_LINES;
        let least = if is_figure && long >= FIGURE_LONG { FIGURE_DARK } else { AS_DARK };
        long >= MARK_LONG && is_dark(region, 8, least)
    };
    let (kept, dust): (Vec<_>, Vec<_>) =
        patches.into_iter().partition(|patch| !speck(patch) || belongs(patch) || is_mark(patch));
    (kept, dust.into_iter().map(|patch| patch.region).collect())
}

/// The areas of patches, from the least, px².
fn areas(patches: &[&Patch]) -> Vec<usize> {
    let mut areas: Vec<usize> = patches.iter().map(|patch| patch.region.area()).collect();
    areas.sort_unstable();
    areas
}

/// The areas of the specks near lines and far from all, from the least.
struct Strewn {
    near: Vec<usize>,
    far: Vec<usize>,
}

impl Strewn {
    /// Whether specks about as large lie all over, with lines beside them or not: the dots of dotted paper.
    fn has(&self, area: usize) -> bool {
        let alike = |areas: &[usize]| {
            let under = |bound: f64| areas.partition_point(|&other| (other as f64) < bound);
            under(STREWN_ALIKE * area as f64) - under(area as f64 / STREWN_ALIKE)
        };
        let (near, far) = (alike(&self.near), alike(&self.far));
        far >= FEWEST_STREWN && far >= STREWN * near
    }
}
