//! Fills the pale streak along the middle of a ballpoint line.
//!
//! It lies between two edges as dark as ink that are no further apart than a line of the picture is wide, and it is no paper. Two lines
//! beside each other are wider together than each of them.

use tracelight_image::distance::to_paper;
use tracelight_image::threshold::over;
use tracelight_image::{Mask, Plane, Region, regions};

/// A streak is darker than this share of the ink.
const LEAST_DARK: f64 = 0.2;
/// Largest width of a streak, relative to the dark ink on either side.
const WIDEST: f64 = 1.5;
/// With it a line is at most so many times as wide as the picture's lines are in the mean.
const MOST_WIDE: f64 = 1.35;
/// And it is at least this share of that: what is left of paper between two lines that touch is less.
const HOLLOW: f64 = 0.1;
/// This share of its pixels at most lies at paper: it ends between its edges, or opens where they do.
const MOST_OPEN: f64 = 0.15;
/// Lines thinner than this show none, px.
const LEAST_PX: f64 = 1.4;
/// Where the ink's edges are wider than this share of its lines, what is between two of them is as dark.
const MOST_BLURRED: f64 = 0.5;

/// Makes the streaks in lines ink, as dark as what lies beside them; `strength` is how much darker ink is than paper, levels, and its
/// edges are so wide, px.
pub(crate) fn fill(dark: &mut Plane<u8>, ink: &mut Mask, strength: f64, edge_px: f64) {
    let mean_width = |mask: &Mask| mask.count() as f64 / mask.line_length().max(1.0);
    let dark_width = mean_width(ink);
    if dark_width < LEAST_PX {
        return;
    }
    let closed = ink.clone().closed((WIDEST * dark_width).round() as usize + 1);
    let pale = over(dark, (LEAST_DARK * strength) as u8).and(&closed).without(ink);
    if pale.is_empty() {
        return;
    }
    let mut filled = ink.clone();
    filled.add(&pale);
    let width = mean_width(&filled);
    if edge_px > MOST_BLURRED * width {
        return;
    }
    let most = MOST_WIDE * width;
    let found = regions(&pale);
    for streak in found.iter().filter(|patch| is_within(patch, &pale, &filled, most)) {
        darken(dark, ink, streak);
        streak.fill_into(ink);
    }
}

/// Whether a patch of `pale` lies within a line, at most so wide, with what is dark on both of its sides: all of it is `filled`.
fn is_within(patch: &Region, pale: &Mask, filled: &Mask, most: f64) -> bool {
    let is_open = |x: usize, y: usize| {
        let (x, y) = (x as isize, y as isize);
        [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(right, down)| !filled.get(x + right, y + down))
    };
    let open = patch.places().filter(|&(x, y)| is_open(x, y)).count();
    if open as f64 > MOST_OPEN * patch.area() as f64 {
        return false;
    }
    let across = |mask: &Mask| {
        let radii = patch.cells(mask).map(|cell| to_paper(mask, cell, most));
        2.0 * radii.fold(0.0, f64::max) - 1.0
    };
    let (line, streak) = (across(filled), across(pale));
    line <= most && streak >= HOLLOW * line
}

/// Gives a streak the darkness of the ink beside it.
fn darken(dark: &mut Plane<u8>, ink: &Mask, streak: &Region) {
    let beside = |x: usize, y: usize| {
        let around =
            (-2..=2).flat_map(move |down| (-2..=2).map(move |right| (x as isize + right, y as isize + down)));
        around.filter(|&(x, y)| ink.get(x, y)).map(|(x, y)| dark.row(y as usize)[x as usize]).max()
    };
    let darkest: Vec<(usize, usize, Option<u8>)> =
        streak.places().map(|(x, y)| (x, y, beside(x, y))).collect();
    let usual = darkest.iter().filter_map(|place| place.2).max();
    for (x, y, level) in darkest {
        if let Some(level) = level.or(usual) {
            dark.row_mut(y)[x] = level;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of rings about one middle: radius, width and darkness of each.
    fn rings(of: &[(f64, f64, f64)]) -> Plane<u8> {
        let level = |i: usize| {
            let off = ((i % 200) as f64 - 99.5).hypot((i / 200) as f64 - 99.5);
            let cover = |&(radius, width, dark): &(f64, f64, f64)| {
                dark * (0.5 * width + 0.5 - (off - radius).abs()).clamp(0.0, 1.0)
            };
            of.iter().map(cover).fold(0.0, f64::max) as u8
        };
        Plane { width: 200, height: 200, values: (0..200 * 200).map(level).collect() }
    }

    /// How many pixels become ink.
    fn filled_px(mut dark: Plane<u8>, edge_px: f64) -> usize {
        let mut ink = over(&dark, 100);
        let before = ink.count();
        fill(&mut dark, &mut ink, 200.0, edge_px);
        assert_eq!(over(&dark, 100).count(), ink.count());
        ink.count() - before
    }

    #[test]
    fn what_is_pale_in_the_middle_of_a_line_is_ink_and_paper_between_two_lines_is_none() {
        // edges of 3 px and a streak of 4 between them, in one ring of two
        let with =
            |pale: f64| [(60.0, 4.0, pale), (56.5, 3.0, 200.0), (63.5, 3.0, 200.0), (90.0, 10.0, 200.0)];
        let round = 2.0 * std::f64::consts::PI * 60.0;
        let streak = filled_px(rings(&with(70.0)), 1.0) as f64;
        assert!((streak / (3.0 * round) - 1.0).abs() < 0.35, "{streak}");
        assert_eq!(filled_px(rings(&with(0.0)), 1.0), 0, "bare paper");
        assert_eq!(filled_px(rings(&with(70.0)), 6.0), 0, "in a blurred picture");
        // as wide as each of them is what parts two lines
        let two = [(52.0, 8.0, 200.0), (64.0, 8.0, 200.0), (58.0, 4.0, 70.0), (90.0, 8.0, 200.0)];
        assert_eq!(filled_px(rings(&two), 1.0), 0);
    }
}
