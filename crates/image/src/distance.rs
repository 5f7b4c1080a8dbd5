//! Distance of an ink pixel to the paper.

use crate::mask::{Cell, Mask};

/// Distance from an ink pixel's centre to the nearest paper pixel's centre, px, exact up to `most`; `most` where
/// there is none nearer. Beyond the image is paper.
///
/// Rows are looked at outwards from the pixel's own until they are further away than the best found: for a pen's
/// skeleton that is a few words a pixel, where a transform of the whole image would touch each of its pixels.
pub fn to_paper(mask: &Mask, cell: Cell, most: f64) -> f64 {
    let (x, y) = mask.place(cell);
    let mut best = most * most;
    let mut rise = 0;
    while ((rise * rise) as f64) < best {
        for row in [y.checked_sub(rise), Some(y + rise)] {
            let aside = match row {
                Some(row) if row < mask.height() => along_row(mask, x, row, best),
                _ => 0,
            };
            best = best.min((rise * rise + aside * aside) as f64);
        }
        rise += 1;
    }
    best.sqrt()
}

/// Columns from `x` to the nearest paper in row `y`, either way, as far as it matters for squares under `best`.
fn along_row(mask: &Mask, x: usize, y: usize, best: f64) -> usize {
    let row = mask.row(y);
    let (word, bit) = (x / 64, x % 64);
    // the row's own word first: mostly the answer lies in it
    let paper = !row[word];
    let right = (paper >> bit).trailing_zeros() as usize;
    let left = (paper << (63 - bit)).leading_zeros() as usize;
    let near = right.min(left);
    if near <= bit.min(63 - bit) {
        return near;
    }
    let farther = |words: &mut dyn Iterator<Item = u64>, from: usize, first: fn(u64) -> u32| {
        let mut steps = from;
        for word in words {
            let ahead = first(!word) as usize;
            steps += ahead;
            if ahead < 64 || ((steps * steps) as f64) > best {
                break;
            }
        }
        steps
    };
    let ahead = match right < 64 - bit {
        true => right,
        false => farther(&mut row[word + 1..].iter().copied(), 64 - bit, u64::trailing_zeros),
    };
    let behind = match left <= bit {
        true => left,
        false => farther(&mut row[..word].iter().rev().copied(), bit + 1, u64::leading_zeros),
    };
    // bits past the width are paper, and so is what lies beyond the row
    ahead.min(behind)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_distance_is_the_shortest_there_is() {
        let (w, h) = (150isize, 30isize);
        let ink = |x: isize, y: isize| {
            (0..w).contains(&x)
                && (0..h).contains(&y)
                && ((x - 65).pow(2) + 4 * (y - 14).pow(2) < 900 || (x * y) % 7 > 2 || (y == 20 && x > 10))
        };
        let mut mask = Mask::empty(w as usize, h as usize);
        let places: Vec<(isize, isize)> =
            (0..h).flat_map(|v| (0..w).map(move |u| (u, v))).filter(|&(u, v)| ink(u, v)).collect();
        for &(x, y) in &places {
            let cell = mask.cell(x as usize, y as usize);
            mask.set(cell);
        }
        for (x, y) in places {
            let all = (-1..=h).flat_map(|v| (-1..=w).map(move |u| (u, v)));
            let paper = all.filter(|&(u, v)| !ink(u, v));
            let nearest = paper.map(|(u, v)| (u - x).pow(2) + (v - y).pow(2)).min().unwrap() as f64;
            let found = to_paper(&mask, mask.cell(x as usize, y as usize), 1e3);
            assert!((found - nearest.sqrt()).abs() < 1e-9, "({x}, {y}): {found}");
            let bounded = to_paper(&mask, mask.cell(x as usize, y as usize), 3.0);
            assert!((bounded - nearest.sqrt().min(3.0)).abs() < 1e-9, "({x}, {y}): {bounded}");
        }
    }
}
