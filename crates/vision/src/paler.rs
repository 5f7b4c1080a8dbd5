//! A second ink: a pencil's lines beside a pen's.
//!
//! One threshold for the whole picture goes between the darkest ink and all else, or between paper and all else; a pencil
//! beside a pen is lost, or the pen's blur is ink. So what is beyond the reach of the first ink's blur is looked at by
//! itself: what stands out from the paper there is the second ink.

use crate::ink::{histogram, over, sampled_blocks};
use crate::light::percentile;
use crate::mask::Mask;
use crate::parts::SOLID_SHARE;
use crate::plane::Plane;
use crate::region::{Region, any_spans, regions};

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

/// The ink with what is paler than it and drawn as well. `strength` is how much darker than the paper it is, levels;
/// `edge_px` how wide its edges are.
pub(crate) fn with_paler(dark: &Plane<u8>, mut ink: Mask, strength: f64, edge_px: Option<f64>) -> Mask {
    let reach = (FOOT * edge_px.unwrap_or(1.0)).ceil().clamp(1.0, 16.0) as usize + 1;
    let near = ink.clone().dilated_by(reach);
    let Some(threshold) = threshold(dark, &near, strength) else { return ink };
    let pale = over(dark, threshold);
    let mut drawn = pale.clone().without(&near);
    // from border to border lead ruled paper's lines and the edges of shadows, unless the first ink does itself
    if any_spans(if any_spans(&ink) { &drawn } else { &pale }) {
        return ink;
    }
    let side = (dark.width.min(dark.height) / SOLID_SHARE).max(LEAST_PX);
    let solid = drawn.clone().eroded(side);
    let edges = Edges { dark, drawn: drawn.clone(), near: &near, beyond: reach as isize + 1 };
    let is_line = |region: &Region| is_drawn(region, &solid) && edges.are_sharp(region);
    regions(&drawn).iter().filter(|r| !is_line(r)).for_each(|region| region.erase_from(&mut drawn));
    // up to the first ink's own edge, through what its blur hides
    for _ in 0..reach {
        drawn = drawn.dilated_by(1).and(&pale);
    }
    ink.add(&drawn);
    ink
}

/// Darkness from which on there is ink beyond `near`; `None` where there is nothing but paper.
fn threshold(dark: &Plane<u8>, near: &Mask, strength: f64) -> Option<u8> {
    let blocks = sampled_blocks(dark, SAMPLED);
    let levels = histogram(blocks.flat_map(|(y, number, levels)| clear(levels, near.row(y)[number])));
    let paper = percentile(&levels, 0.5);
    // of a normal distribution a sixth is more than a deviation above the middle
    let deviation = (percentile(&levels, 0.841) - paper).max(0.5);
    let least = paper + (LEAST_SHARE * strength).max(DEVIATIONS * deviation).max(LEAST_LEVELS);
    let class = |from: usize| {
        let counted = levels.iter().enumerate().skip(from).map(|(level, &n)| (f64::from(n), level as f64));
        counted.fold((0.0, 0.0), |(all, sum), (n, level)| (all + n, sum + n * level))
    };
    let ((all, _), (count, sum)) = (class(0), class(least as usize + 1));
    let is_ink = count >= (LEAST_INK * all).max(LEAST_PX as f64);
    is_ink.then(|| least.max(0.5 * (paper + sum / count)) as u8)
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
    length >= LEAST_PX.max(solid.height / LEAST_ROWS) && !fades && !is_shadow()
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

    #[test]
    fn a_pencils_line_beside_a_pens_is_ink_up_to_the_pens_edge() {
        for share in [0.3, 0.45, 0.6] {
            let dark = crossed(share);
            let found = with_paler(&dark, over(&dark, 150), 220.0, Some(1.0));
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
            let found = with_paler(&dark, over(&dark, 150), 220.0, Some(1.0));
            assert!(found.get(600, top as isize + 1), "nothing at {top}");
        }
    }

    #[test]
    fn paper_beside_a_line_stays_paper() {
        let dark = crossed(0.0);
        let ink = over(&dark, 150);
        assert_eq!(with_paler(&dark, ink.clone(), 220.0, Some(1.0)).count(), ink.count());
    }
}
