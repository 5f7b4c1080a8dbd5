//! Shadows: paper whose brightness has steps, or falls off in places, as no smooth surface does.
//!
//! Whether there are any is seen on the tiles: by the steps of hard ones, and by what is darker than the surface of soft ones. If so, the paper is the picture closed (Serra, "Image Analysis and
//! Mathematical Morphology", 1982) by a square that is wider than any pen: lines are filled up, the edges of shadows
//! stay where they are to a pixel. What is dark and wider than that is a shadow if it reaches the picture's border, else it was filled.

use tracelight_image::Plane;

/// Neighbouring tiles of one paper differ less than this in brightness, as a ratio.
const SAME: f64 = 0.9;
/// A patch of tiles that is paper has at least this share of all of them and reaches the picture's border.
const LEAST_SHARE: f64 = 0.03;
/// Shadows let through this much of the light; what is darker is ink, what is brighter is no matter.
pub(crate) const SHADE: std::ops::Range<f64> = 0.42..0.88;

/// Whether the tiles' paper falls into patches of different brightness.
pub(crate) fn is_cast(bright: &Plane<f64>) -> bool {
    let levels: Vec<f64> = patches(bright);
    let brightest = levels.iter().copied().fold(0.0, f64::max);
    levels.iter().any(|level| SHADE.contains(&(level / brightest)))
}

/// Whether a part of the paper that reaches the picture's border is darker than a smooth surface has it, however slowly it becomes so;
/// `ratio` is of the tiles' brightness to that surface.
pub(crate) fn is_soft(ratio: &Plane<f64>) -> bool {
    let mut seen: Vec<bool> = ratio.values.iter().map(|level| !SHADE.contains(level)).collect();
    for start in 0..seen.len() {
        if !seen[start] {
            let mut patch = vec![start];
            seen[start] = true;
            ratio.flood(&mut patch, &mut seen, |_, _| true);
            if is_of_paper(ratio, &patch) {
                return true;
            }
        }
    }
    false
}

/// Whether a patch of tiles is so large, and so much of it at the picture's border, that it is paper.
fn is_of_paper(tiles: &Plane<f64>, patch: &[usize]) -> bool {
    let is_large = patch.len() as f64 >= LEAST_SHARE * tiles.values.len() as f64;
    is_large && patch.iter().filter(|&&i| tiles.is_at_border(i)).count() > 2
}

/// Mean brightness of each patch of paper.
fn patches(bright: &Plane<f64>) -> Vec<f64> {
    // a shadow's edge that runs along a row of tiles makes them all shades between two papers: none of them leads across
    let mut seen: Vec<bool> = (0..bright.values.len()).map(|i| is_steep(bright, i)).collect();
    let mut found = Vec::new();
    for start in 0..seen.len() {
        if !seen[start] {
            let patch = flooded(bright, start, SAME, &mut seen);
            if is_of_paper(bright, &patch) {
                found.push(patch.iter().map(|&i| bright.values[i]).sum::<f64>() / patch.len() as f64);
            }
        }
    }
    found
}

/// Whether the tiles on two opposite sides of one differ more than one paper's do from a tile to the next but one.
fn is_steep(bright: &Plane<f64>, i: usize) -> bool {
    let (x, y) = (i % bright.width, i / bright.width);
    let differ = |a: usize, b: usize| {
        let (a, b) = (bright.values[a], bright.values[b]);
        a.min(b) < SAME * SAME * a.max(b)
    };
    let across = x > 0 && x + 1 < bright.width && differ(i - 1, i + 1);
    across || y > 0 && y + 1 < bright.height && differ(i - bright.width, i + bright.width)
}

/// The tiles that can be reached from one over neighbours whose brightness differs by no more than the ratio `same`.
pub(crate) fn flooded(bright: &Plane<f64>, start: usize, same: f64, seen: &mut [bool]) -> Vec<usize> {
    let mut patch = vec![start];
    seen[start] = true;
    bright.flood(&mut patch, seen, |i, k| {
        let (a, b) = (bright.values[i], bright.values[k]);
        a.min(b) > same * a.max(b)
    });
    patch
}

/// The picture's paper, pixel by pixel: closed by squares of `side` px, and where that is darker than any shadow on
/// the paper expected there, `instead`, both by tile of `tile` px.
pub(crate) fn paper(
    image: &Plane<u8>,
    side: usize,
    tile: usize,
    expected: &[f64],
    instead: impl Fn(&Plane<u8>) -> Plane<f64>,
) -> Plane<u8> {
    let mut closed = closed(image, side);
    fill_islands(&mut closed, (tile / CELLS).max(1));
    let instead = instead(&closed);
    for y in 0..closed.height {
        for (x, level) in closed.row_mut(y).iter_mut().enumerate() {
            let k = y / tile * instead.width + x / tile;
            if f64::from(*level) < SHADE.start * expected[k] {
                *level = instead.values[k] as u8;
            }
        }
    }
    closed
}

/// Cells along a tile's side in which patches that reach no border are looked for.
const CELLS: usize = 4;
/// A cell of such a patch is darker than what encloses it by this share, and the patch no larger than this share of the picture.
const ISLAND: f64 = 0.9;
const LARGEST_ISLAND: f64 = 0.1;

/// Makes dark patches that reach no border of the picture as bright as the way out of them where that is darkest, cells of so many px
/// either way at a time (Barnes et al., "Priority-flood", 2014).
fn fill_islands(paper: &mut Plane<u8>, side: usize) {
    let cells = paper.reduced(side);
    let mut filled = cells.clone();
    let mut seen: Vec<bool> = (0..cells.values.len()).map(|i| cells.is_at_border(i)).collect();
    // cells by the level at which they are reached, from the darkest
    let mut reached: Vec<Vec<usize>> = vec![Vec::new(); 256];
    (0..seen.len()).filter(|&i| seen[i]).for_each(|i| reached[usize::from(cells.values[i])].push(i));
    for level in 0..256 {
        while let Some(i) = reached[level].pop() {
            let mut next = vec![i];
            cells.flood(&mut next, &mut seen, |from, _| from == i);
            for &k in &next[1..] {
                filled.values[k] = cells.values[k].max(level as u8);
                reached[usize::from(filled.values[k])].push(k);
            }
        }
    }
    let is_dark = |i: usize| f64::from(cells.values[i]) < ISLAND * f64::from(filled.values[i]);
    let mut seen: Vec<bool> = (0..cells.values.len()).map(|i| !is_dark(i)).collect();
    let most = (LARGEST_ISLAND * seen.len() as f64) as usize;
    for start in 0..seen.len() {
        if seen[start] {
            continue;
        }
        let mut island = vec![start];
        seen[start] = true;
        cells.flood(&mut island, &mut seen, |_, _| true);
        if island.len() <= most {
            island
                .iter()
                .for_each(|&i| brighten(paper, side, (i % cells.width, i / cells.width), filled.values[i]));
        }
    }
}

/// Makes a cell and those round it at least as bright as this.
fn brighten(paper: &mut Plane<u8>, side: usize, (x, y): (usize, usize), level: u8) {
    let rows = y.saturating_sub(1) * side..((y + 2) * side).min(paper.height);
    let columns = x.saturating_sub(1) * side..((x + 2) * side).min(paper.width);
    for y in rows {
        paper.row_mut(y)[columns.clone()].iter_mut().for_each(|v| *v = level.max(*v));
    }
}

/// Whether a level is ink on the paper expected, not a shadow.
pub(crate) fn is_ink(level: f64, expected: f64) -> bool {
    level < SHADE.start * expected
}

/// The least of the greatest: what is darker than its surroundings and narrower than `side` px is filled up. The
/// picture's outermost pixels go on beyond it, so that a shadow's tip at the border is as wide there as the shadow.
fn closed(image: &Plane<u8>, side: usize) -> Plane<u8> {
    let reach = side / 2;
    let wide = widened(image, reach);
    // rows as columns once: the order of the two sides of a square does not matter
    let rows = along_columns(along_columns(wide, reach, u8::max).transposed(), reach, u8::max);
    let closed = along_columns(along_columns(rows, reach, u8::min).transposed(), reach, u8::min);
    let mut out = Plane::filled(image.width, image.height, 0);
    for y in 0..image.height {
        out.row_mut(y).copy_from_slice(&closed.row(y + reach)[reach..][..image.width]);
    }
    out
}

/// The image with its outermost pixels repeated on all sides.
fn widened(image: &Plane<u8>, by: usize) -> Plane<u8> {
    let mut wide = Plane::filled(image.width + 2 * by, image.height + 2 * by, 0);
    for y in 0..wide.height {
        let row = image.row(y.saturating_sub(by).min(image.height - 1));
        let (left, right) = (row[0], row[image.width - 1]);
        let out = wide.row_mut(y);
        out[..by].fill(left);
        out[by..][..row.len()].copy_from_slice(row);
        out[by + row.len()..].fill(right);
    }
    wide
}

/// For each pixel the most of those up to `reach` above and below (van Herk, "A fast algorithm for local minimum and
/// maximum filters", 1992): most of a block of rows up to a row, most of a block from a row on.
fn along_columns(plane: Plane<u8>, reach: usize, most: impl Fn(u8, u8) -> u8) -> Plane<u8> {
    let (w, h, block) = (plane.width, plane.height, 2 * reach + 1);
    let (mut before, mut after) = (plane.clone(), plane);
    for y in (1..h).filter(|y| y % block != 0) {
        let (above, here) = before.values.split_at_mut(y * w);
        here[..w].iter_mut().zip(&above[(y - 1) * w..]).for_each(|(v, &a)| *v = most(*v, a));
    }
    for y in (0..h - 1).rev().filter(|y| (y + 1) % block != 0) {
        let (here, below) = after.values.split_at_mut((y + 1) * w);
        here[y * w..].iter_mut().zip(&below[..w]).for_each(|(v, &b)| *v = most(*v, b));
    }
    let mut out = Plane::filled(w, h, 0);
    for y in 0..h {
        let (first, last) = (y.saturating_sub(reach), (y + reach).min(h - 1));
        let (before, after, out) = (before.row(last), after.row(first), out.row_mut(y));
        // at the borders the window may lie within one block: then one of the two reaches beyond it
        match (first / block == last / block, first) {
            (true, 0) => out.copy_from_slice(before),
            (true, _) => out.copy_from_slice(after),
            _ => out.iter_mut().zip(before.iter().zip(after)).for_each(|(v, (&b, &a))| *v = most(a, b)),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_takes_the_least_of_the_greatest_in_each_window() {
        let (w, h) = (37usize, 29usize);
        let values = (0..w * h).map(|i| ((i * 7919 + i * i * 31) % 251) as u8).collect();
        let plane = Plane { width: w, height: h, values };
        let filter = |plane: &Plane<u8>, reach: usize, most: fn(u8, u8) -> u8| {
            let (w, h) = (plane.width, plane.height);
            let at = |i: usize| {
                let (x, y) = (i % w, i / w);
                let rows = y.saturating_sub(reach)..(y + reach + 1).min(h);
                let columns = x.saturating_sub(reach)..(x + reach + 1).min(w);
                rows.flat_map(|y| columns.clone().map(move |x| (x, y)))
                    .map(|(x, y)| plane.row(y)[x])
                    .reduce(most)
                    .unwrap()
            };
            Plane { width: w, height: h, values: (0..w * h).map(at).collect() }
        };
        for side in [3, 5, 9] {
            let reach = side / 2;
            let expected = filter(&filter(&widened(&plane, reach), reach, u8::max), reach, u8::min);
            let found = closed(&plane, side);
            for y in 0..h {
                let row = &expected.row(y + reach)[reach..][..w];
                assert_eq!(found.row(y), row, "side {side}, row {y}");
            }
        }
    }

    #[test]
    fn what_reaches_no_border_is_filled_and_a_shadow_stays() {
        let (w, h) = (180, 120);
        let shadow = |x: usize, y: usize| x + y > 200;
        let disc = |x: usize, y: usize, cx: f64, cy: f64| (x as f64 - cx).hypot(y as f64 - cy) < 18.0;
        // one in the light, one in the shadow, one at the border
        let inks = |x: usize, y: usize| disc(x, y, 50.0, 40.0) || disc(x, y, 148.0, 90.0);
        let level = |i: usize| {
            let (x, y) = (i % w, i / w);
            let lit = if shadow(x, y) { 150.0 } else { 240.0 };
            (lit * if inks(x, y) || disc(x, y, 0.0, 80.0) { 0.6 } else { 1.0 }) as u8
        };
        let mut paper = Plane { width: w, height: h, values: (0..w * h).map(level).collect() };
        let before = paper.clone();
        fill_islands(&mut paper, 4);
        for (i, (&now, &was)) in paper.values.iter().zip(&before.values).enumerate() {
            let (x, y) = (i % w, i / w);
            let expected = match inks(x, y) {
                true if shadow(x, y) => 150,
                true => 240,
                false => was,
            };
            assert_eq!(now, expected, "{x}, {y}");
        }
    }

    fn tiles(level: &dyn Fn(usize, usize) -> f64) -> Plane<f64> {
        Plane { width: 32, height: 24, values: (0..768).map(|i| level(i % 32, i / 32)).collect() }
    }

    #[test]
    fn a_part_at_the_border_that_is_darker_than_light_falls_off_is_a_soft_shadow() {
        let slowly = |x: usize| (1.0 - 0.04 * x.saturating_sub(12) as f64).max(0.6);
        assert!(is_soft(&tiles(&|x, _| slowly(x))));
        assert!(!is_soft(&tiles(&|x, _| slowly(x).max(0.9))));
        // what is drawn in the middle, and ink at the border
        assert!(!is_soft(&tiles(&|x, y| if x.abs_diff(16) < 8 && y.abs_diff(12) < 6 { 0.6 } else { 1.0 })));
        assert!(!is_soft(&tiles(&|x, _| if x < 9 { 0.2 } else { 1.0 })));
    }

    #[test]
    fn a_slope_is_no_shadow_and_a_step_is() {
        assert!(!is_cast(&tiles(&|x, _| 240.0 - 5.0 * x as f64)));
        assert!(is_cast(&tiles(&|x, y| if x + y > 30 { 140.0 } else { 235.0 })));
        // a filled shape inside the picture, and one of dark ink at its border
        assert!(!is_cast(&tiles(&|x, y| if x.abs_diff(16) < 8 && y.abs_diff(12) < 6 {
            140.0
        } else {
            235.0
        })));
        assert!(!is_cast(&tiles(&|x, _| if x < 9 { 40.0 } else { 235.0 })));
        // an edge within a row of tiles, a little slanted
        let slanted = |x: usize| 140.0 + 95.0 * (x as f64 / 31.0);
        assert!(is_cast(&tiles(&|x, y| match y {
            ..12 => 140.0,
            12 => slanted(x),
            _ => 235.0,
        })));
    }
}
