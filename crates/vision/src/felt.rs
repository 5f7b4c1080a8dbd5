//! What a broad pen filled to and fro: areas of ways side by side with slits of paper between them.
//!
//! Each way is a line by its width, and nobody means them. Where ways lie so close that less than half a pen's width of paper
//! shows between them, and many of them do, the area is what was drawn: its slits are ink. Hatching leaves more paper than that.

use crate::mask::Mask;
use crate::region::{Region, regions};

/// Widest slit, pen widths; of slanted ones half as much more.
const SLIT_PENS: f64 = 0.5;
/// Of a narrower pen, px, a single pixel of paper may be what parts two lines.
const LEAST_PX: f64 = 4.0;
/// Such an area holds a regular octagon of so many pens: four ways at least lie beside each other.
const ACROSS_PENS: f64 = 4.5;
/// So much of it is ink, and so much at least is slits; what is larger than a square of so many pens may have a single slit, with
/// ink all round.
const INK_SHARE: f64 = 0.76;
const LEAST_SLITS: f64 = 0.04;
const BROAD_PENS: f64 = 6.5;
/// A hand that goes to and fro meets its last way here and there: this share of the ink hangs together. Lines side by side do not.
const TOGETHER: f64 = 0.5;
/// An area goes beyond the octagons in it by so many pens.
const RIM_PENS: f64 = 0.5;

/// The ink with the slits of such areas; `None` where there are none. `pen` is the usual width of its lines, px; 0 where that is not
/// known.
pub(crate) fn filled(ink: &Mask, pen: f64) -> Option<Mask> {
    if pen < LEAST_PX {
        return None;
    }
    let slit = (SLIT_PENS * pen).round() as usize;
    let mut closed = ink.clone().dilated(slit + 1).eroded(slit + 1);
    closed.add(ink);
    let slits = closed.clone().without(ink);
    if slits.is_empty() {
        return None;
    }
    let mut areas = closed.clone().opened((ACROSS_PENS * pen).ceil() as usize);
    if areas.is_empty() {
        return None;
    }
    let mut broad = areas.clone();
    let found = regions(&areas);
    let inked = Inked::of(&found, regions(&areas.clone().and(ink)));
    for (area, (all, largest)) in found.iter().zip(inked.0) {
        let share = all as f64 / area.area() as f64;
        let is_filled = largest as f64 >= TOGETHER * all as f64 && share >= INK_SHARE;
        if !is_filled || share > 1.0 - LEAST_SLITS {
            area.erase_from(&mut areas);
        }
        if !is_filled || (area.area() as f64) < (BROAD_PENS * pen).powi(2) {
            area.erase_from(&mut broad);
        }
    }
    let mut filled = areas.dilated_by((RIM_PENS * pen).ceil() as usize).and(&closed);
    if !broad.is_empty() {
        let is_single = |slit: &&Region| slit.cells(&broad).next().is_some() && is_enclosed(slit, &closed);
        regions(&slits).iter().filter(is_single).for_each(|slit| slit.fill_into(&mut filled));
    }
    filled.add(ink);
    (filled.count() > ink.count()).then_some(filled)
}

/// Whether a slit has nothing but ink round it: `closed` is all ink and all slits.
fn is_enclosed(slit: &Region, closed: &Mask) -> bool {
    slit.runs.iter().all(|run| {
        let (y, from, to) = (run.y as isize, run.from as isize, run.to as isize);
        (y - 1..=y + 1).all(|y| (from - 1..=to).all(|x| closed.get(x, y)))
    })
}

/// Of each area the pixels of ink in it, and those of the largest piece that hangs together there.
struct Inked(Vec<(usize, usize)>);

impl Inked {
    /// `pieces` are all the ink of the areas.
    fn of(areas: &[Region], pieces: Vec<Region>) -> Self {
        let numbered = areas.iter().enumerate();
        let mut runs: Vec<(u32, u32, usize)> =
            numbered.flat_map(|(k, area)| area.runs.iter().map(move |run| (run.y, run.from, k))).collect();
        runs.sort_unstable();
        let mut inked = vec![(0, 0); areas.len()];
        for piece in pieces {
            let Some(first) = piece.runs.first() else { continue };
            // the run that it begins in
            let behind = runs.partition_point(|&(y, from, _)| (y, from) <= (first.y, first.from));
            if let Some(&(.., area)) = behind.checked_sub(1).and_then(|k| runs.get(k)) {
                let (all, largest): &mut (usize, usize) = &mut inked[area];
                *all += piece.area();
                *largest = (*largest).max(piece.area());
            }
        }
        Self(inked)
    }
}
