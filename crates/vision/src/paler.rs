//! Finds ink that a single threshold misses: lines that fade, and pencil beside pen.
//!
//! A single threshold lies either between the darkest ink and all else, or between paper and all else. Then pencil beside pen is lost, or the
//! pen's blur becomes ink. A line is ink up to where it is half as dark as in its middle, as far as it is connected to ink. Beyond the blur of
//! the first ink, whatever stands out from the paper is the second ink.

use tracelight_image::levels::{histogram, percentile, sampled_blocks};
use tracelight_image::threshold::over;
use tracelight_image::{Cell, Mask, Plane, Region, any_spans, regions};

use crate::parts::SOLID_SHARE;

/// Ink is at least this much darker than the paper about it, as a share of the first ink: the middle of the edge of a
/// pencil of 28 %.
const LEAST_SHARE: f64 = 0.14;
/// And this many times the paper's own deviation, and levels.
const DEVIATIONS: f64 = 8.0;
const LEAST_LEVELS: f64 = 8.0;
/// Less than this share of the pixels that are looked at is no ink but specks.
const LEAST_INK: f64 = 1e-4;
/// A line is at least this long, px, and this share of the picture's rows.
const LEAST_PX: usize = 12;
const LEAST_ROWS: usize = 40;
/// A line that leaves the picture has less of its length on the border than this; what lies along it there is the end of the light.
const ALONG_BORDER: f64 = 0.3;
/// Just beyond a line's edge it is less dark than this share of the line.
const FADED: f64 = 0.35;
/// An edge's foot is this many of its widths from 10 to 90 % away from where it is cut.
const FOOT: f64 = 0.9;
/// Most pixels that are looked at.
const SAMPLED: usize = 130_000;
/// A line's edge is where it is this share as dark as the darkest about.
const EDGE: f64 = 0.5;
/// A patch that ink pales to has so many pixels: fewer are the edge's own.
const LEAST_PALING_PX: usize = 6;

/// Ink, and how it ends.
pub(crate) struct Inked<'a> {
    pub(crate) dark: &'a Plane<u8>,
    pub(crate) ink: Mask,
    /// How much darker than the paper it is, levels.
    pub(crate) strength: f64,
    /// How wide its edges are, px.
    pub(crate) edge_px: Option<f64>,
}

impl Inked<'_> {
    /// The ink with what is paler than it and drawn as well. Where a line `pales` along its way, that is so too.
    pub(crate) fn with_paler(mut self, pales: bool) -> Mask {
        let reach = (FOOT * self.edge_px.unwrap_or(1.0)).ceil().clamp(1.0, 16.0) as usize + 1;
        let looked_at = |ink: &Mask| {
            let near = ink.clone().dilated_by(reach);
            let beyond = Beyond::of(self.dark, &near);
            (near, beyond)
        };
        let (mut near, mut beyond) = looked_at(&self.ink);
        if pales && self.add_paling(&near, beyond.least(self.strength), reach) {
            (near, beyond) = looked_at(&self.ink);
        }
        if let Some(threshold) = beyond.threshold(self.strength) {
            self.add_second(&near, threshold, reach);
        }
        self.ink
    }

    /// Adds what the ink pales to along its way, where that is darker than `least`; whether there is any. `near` is what is within
    /// `reach` of the ink, px: as far as its blur does.
    fn add_paling(&mut self, near: &Mask, least: f64, reach: usize) -> bool {
        let pale = over(self.dark, least as u8).without(&self.ink);
        let drawn = half_as_dark(self.dark, pale, reach);
        if drawn.is_empty() {
            return false;
        }
        let beside = self.ink.clone().dilated_by(1);
        let edges = Edges { dark: self.dark, drawn, near, beyond: reach as isize + 1 };
        let is_joined = |region: &Region| {
            region.area() >= LEAST_PALING_PX
                && region.cells(&beside).next().is_some()
                && edges.are_sharp(region)
        };
        let mut found = regions(&edges.drawn);
        found.retain(is_joined);
        found.iter().for_each(|region| region.fill_into(&mut self.ink));
        !found.is_empty()
    }

    /// Adds what is over a threshold beyond the reach of the ink: a second one.
    fn add_second(&mut self, near: &Mask, threshold: u8, reach: usize) {
        let pale = over(self.dark, threshold);
        let mut drawn = pale.clone().without(near);
        // from border to border lead ruled paper's lines and the edges of shadows, unless the first ink does itself
        if any_spans(if any_spans(&self.ink) { &drawn } else { &pale }) {
            return;
        }
        let side = (self.dark.width.min(self.dark.height) / SOLID_SHARE).max(LEAST_PX);
        let solid = drawn.clone().eroded(side);
        let edges = Edges { dark: self.dark, drawn: drawn.clone(), near, beyond: reach as isize + 1 };
        let is_line = |region: &Region| is_drawn(region, &solid) && edges.are_sharp(region);
        regions(&drawn).iter().filter(|r| !is_line(r)).for_each(|region| region.erase_from(&mut drawn));
        // up to the first ink's own edge, through what its blur hides
        for _ in 0..reach {
            drawn = drawn.dilated_by(1).and(&pale);
        }
        self.ink.add(&drawn);
    }
}

/// What of some pixels is darker than half of what is darkest within so many px. Where blur reaches far, levels change slowly: some of
/// the pixels about tell.
fn half_as_dark(dark: &Plane<u8>, mut pale: Mask, reach: usize) -> Mask {
    let every = (reach / 3).max(1);
    let about = |middle: usize, most: usize| middle.saturating_sub(reach)..(middle + reach + 1).min(most);
    let is_blur = |x: usize, y: usize| {
        let level = EDGE.recip() * f64::from(dark.row(y)[x]);
        let columns = about(x, dark.width);
        let is_darker =
            |y: usize| dark.row(y)[columns.clone()].iter().step_by(every).any(|&v| f64::from(v) >= level);
        about(y, dark.height).step_by(every).any(is_darker)
    };
    for y in 0..dark.height {
        let first = pale.cell(0, y);
        let cells = pale.cells_in(y, 0, dark.width);
        let blur: Vec<Cell> = cells.filter(|&cell| is_blur((cell - first) as usize, y)).collect();
        blur.into_iter().for_each(|cell| pale.clear(cell));
    }
    pale
}

/// What is beyond the reach of ink: how many times each level occurs there.
struct Beyond {
    levels: [u32; 256],
    /// Of the paper, levels.
    paper: f64,
}

impl Beyond {
    fn of(dark: &Plane<u8>, near: &Mask) -> Self {
        let blocks = sampled_blocks(dark, SAMPLED);
        let levels = histogram(blocks.flat_map(|(y, number, levels)| clear(levels, near.row(y)[number])));
        Self { levels, paper: percentile(&levels, 0.5) }
    }

    /// What is paler is no ink beside one of this strength, levels.
    fn least(&self, strength: f64) -> f64 {
        // of a normal distribution a sixth is more than a deviation above the middle
        let deviation = (percentile(&self.levels, 0.841) - self.paper).max(0.5);
        self.paper + (LEAST_SHARE * strength).max(DEVIATIONS * deviation).max(LEAST_LEVELS)
    }

    /// Darkness from which on there is ink; `None` where there is nothing but paper.
    fn threshold(&self, strength: f64) -> Option<u8> {
        let least = self.least(strength);
        let class = |from: usize| {
            let counted = self.levels.iter().enumerate().skip(from);
            let weighed = counted.map(|(level, &n)| (f64::from(n), level as f64));
            weighed.fold((0.0, 0.0), |(all, sum), (n, level)| (all + n, sum + n * level))
        };
        let ((all, _), (count, sum)) = (class(0), class(least as usize + 1));
        let is_ink = count >= (LEAST_INK * all).max(LEAST_PX as f64);
        is_ink.then(|| least.max(0.5 * (self.paper + sum / count)) as u8)
    }
}

/// Of up to 64 levels those eights that have nothing in `near`.
fn clear(levels: &[u8], near: u64) -> impl Iterator<Item = &[u8]> {
    let eights = levels.chunks(8).zip(near.to_le_bytes());
    eights.filter(|(_, near)| *near == 0).map(|(levels, _)| levels)
}

/// Whether a patch is long enough for a line, and neither a shadow that falls into the picture nor what fades towards its border.
fn is_drawn(region: &Region, solid: &Mask) -> bool {
    let (width, height) = region.extent();
    let length = width.max(height);
    let at_border = region.at_border_px(solid);
    let is_shadow = || at_border > 0 && region.cells(solid).next().is_some();
    let fades = at_border as f64 > ALONG_BORDER * length as f64;
    length >= LEAST_PX.max(solid.height() / LEAST_ROWS) && !fades && !is_shadow()
}

/// How what may be a second ink ends.
struct Edges<'a> {
    dark: &'a Plane<u8>,
    drawn: Mask,
    near: &'a Mask,
    /// What is so far from ink is beyond its edge, if that is as sharp as the first ink's, px.
    beyond: isize,
}

impl Edges<'_> {
    /// Whether there is paper just beyond a patch's edge: what fades over longer is a smudge, or light that is not even.
    fn are_sharp(&self, region: &Region) -> bool {
        let (mut inside, mut outside) = ((0.0, 0.0), (0.0, 0.0));
        for (x, y) in region.places() {
            inside = (inside.0 + 1.0, inside.1 + f64::from(self.dark.row(y)[x]));
            let (x, y) = (x as isize, y as isize);
            for (right, down) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                let (x, y) = (x + right * self.beyond, y + down * self.beyond);
                let is_in =
                    (0..self.dark.width as isize).contains(&x) && (0..self.dark.height as isize).contains(&y);
                if is_in && !self.drawn.get(x, y) && !self.near.get(x, y) {
                    outside = (outside.0 + 1.0, outside.1 + f64::from(self.dark.row(y as usize)[x as usize]));
                }
            }
        }
        outside.1 * inside.0 <= FADED * inside.1 * outside.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A black line and a paler one across it, by darkness.
    fn crossed(second: f64) -> Plane<u8> {
        let level = |i: usize| {
            let (x, y) = ((i % 160) as f64 - 79.5, (i / 160) as f64 - 59.5);
            let line = |across: f64, along: f64| {
                (2.5 - across.abs()).clamp(0.0, 1.0) * f64::from(along.abs() < 50.0)
            };
            (220.0 * line(y, x).max(second * line(x + 0.4 * y, y)) + ((i * 7919) % 5) as f64) as u8
        };
        Plane { width: 160, height: 120, values: (0..160 * 120).map(level).collect() }
    }

    fn paler(dark: &Plane<u8>, ink: Mask) -> Mask {
        Inked { dark, ink, strength: 220.0, edge_px: Some(1.0) }.with_paler(false)
    }

    #[test]
    fn a_line_that_pales_is_ink_as_wide_as_it_was() {
        // from 220 to 50 levels over 140 px, 6 px wide, on paper with a pale smudge
        let level = |x: usize, y: usize| match (x, y) {
            (10..150, 57..63) => 220.0 - 170.0 * (x as f64 - 10.0) / 140.0,
            _ => 10.0 * (-((x as f64 - 80.0).powi(2) + (y as f64 - 20.0).powi(2)) / 200.0).exp(),
        };
        let values = (0..160 * 120).map(|i| level(i % 160, i / 160) as u8).collect();
        let dark = Plane { width: 160, height: 120, values };
        let ink = Inked { dark: &dark, ink: over(&dark, 110), strength: 170.0, edge_px: Some(1.0) };
        let found = ink.with_paler(true);
        assert_eq!(found.count(), 140 * 6);
        assert!((10..150).all(|x| found.get(x, 57) && found.get(x, 62)));
    }

    #[test]
    fn a_pencils_line_beside_a_pens_is_ink_up_to_the_pens_edge() {
        for share in [0.3, 0.45, 0.6] {
            let dark = crossed(share);
            let found = paler(&dark, over(&dark, 150));
            for y in [-45.0, -10.0, -4.0, 4.0, 20.0, 45.0] {
                let (x, y) = ((79.5 - 0.4 * y) as isize, (59.5 + y) as isize);
                assert!(found.get(x, y), "{share}: nothing at {x}, {y}");
            }
            assert_eq!(regions(&found).len(), 1, "{share}");
        }
    }

    #[test]
    fn a_level_line_is_found_at_any_height() {
        for top in 300..314 {
            let level = |i: usize| {
                let (x, y) = (i % 1280, i / 1280);
                let inside = (100..1100).contains(&x);
                u8::from(inside && (top..top + 3).contains(&y)) * 80
                    + u8::from(inside && (500..505).contains(&y)) * 220
            };
            let dark = Plane { width: 1280, height: 720, values: (0..1280 * 720).map(level).collect() };
            let found = paler(&dark, over(&dark, 150));
            assert!(found.get(600, top as isize + 1), "nothing at {top}");
        }
    }

    #[test]
    fn paper_beside_a_line_stays_paper() {
        let dark = crossed(0.0);
        let ink = over(&dark, 150);
        assert_eq!(paler(&dark, ink.clone()).count(), ink.count());
    }
}
