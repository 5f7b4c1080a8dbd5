//! Adaptive threshold: separates dark from light by the local surroundings.

use tracelight_image::threshold::word_of;
use tracelight_image::{Mask, Plane};

/// Side of the squares in which the darkest and the brightest level are looked for, px.
const TILE: usize = 4;

/// By how much black and white about a place differ at least, levels.
const LEAST_RANGE: u8 = 16;
/// Noise never asks for more than this, levels: a picture full of texture is not noise.
const MOST_RANGE: u8 = 64;

/// How far above the darkest what is dark may be: two thirds of the range. Half of the light is there in what cameras store, and the
/// border of a small marker, which is hardly wider than its blur, is no darker.
const fn threshold(range: u8) -> u8 {
    (range as u16 * 2 / 3) as u8
}

/// What is darker than two thirds of the way from the darkest to the brightest of the 3 × 3 squares about it; nothing where these hardly differ.
pub(super) fn darker(plane: &Plane<u8>) -> Mask {
    let (low, high) = extremes(plane);
    let least_range = least_range(&low, &high);
    let (low, high) = (spread(&low, u8::min), spread(&high, u8::max));
    let mut mask = Mask::empty(plane.width, plane.height);
    let mut thresholds = vec![0; plane.width];
    for row in 0..low.height {
        for (column, some) in thresholds.chunks_mut(TILE).enumerate() {
            // the last squares are as many pixels larger as are left over
            let column = column.min(low.width - 1);
            let (low, high) = (low.row(row)[column], high.row(row)[column]);
            some.fill(if high - low < least_range { 0 } else { low + threshold(high - low) });
        }
        let last = row + 1 == low.height;
        for y in row * TILE..if last { plane.height } else { (row + 1) * TILE } {
            darker_row(plane.row(y), &thresholds, mask.row_mut(y));
        }
    }
    mask
}

fn darker_row(levels: &[u8], thresholds: &[u8], words: &mut [u64]) {
    let mut below = [0u8; 64];
    for (word, (levels, thresholds)) in words.iter_mut().zip(levels.chunks(64).zip(thresholds.chunks(64))) {
        below.fill(0);
        below.iter_mut().zip(levels.iter().zip(thresholds)).for_each(|(b, (&v, &t))| *b = u8::from(v < t));
        *word = word_of(&below);
    }
}

/// The darkest and the brightest level of each square.
fn extremes(plane: &Plane<u8>) -> (Plane<u8>, Plane<u8>) {
    let (columns, rows) = (plane.width / TILE, plane.height / TILE);
    let (mut low, mut high) = (Plane::filled(columns, rows, 0), Plane::filled(columns, rows, 0));
    let (mut lows, mut highs) = (vec![0u8; columns * TILE], vec![0u8; columns * TILE]);
    for row in 0..rows {
        lows.fill(u8::MAX);
        highs.fill(0);
        for y in row * TILE..(row + 1) * TILE {
            let levels = plane.row(y);
            lows.iter_mut().zip(levels).for_each(|(low, &v)| *low = v.min(*low));
            highs.iter_mut().zip(levels).for_each(|(high, &v)| *high = v.max(*high));
        }
        let least = |four: &[u8]| four.iter().copied().fold(u8::MAX, u8::min);
        let most = |four: &[u8]| four.iter().copied().fold(0, u8::max);
        low.row_mut(row).iter_mut().zip(lows.chunks_exact(TILE)).for_each(|(v, four)| *v = least(four));
        high.row_mut(row).iter_mut().zip(highs.chunks_exact(TILE)).for_each(|(v, four)| *v = most(four));
    }
    (low, high)
}

/// Half of all squares hold paper or wall and their noise alone: what nine of them range over by noise, and half as much again.
fn least_range(low: &Plane<u8>, high: &Plane<u8>) -> u8 {
    let mut counts = [0usize; 256];
    low.values.iter().zip(&high.values).for_each(|(&low, &high)| counts[usize::from(high - low)] += 1);
    let mut seen = 0;
    let middle = counts.iter().position(|&count| {
        seen += count;
        2 * seen > low.values.len()
    });
    // 16 levels of Gaussian noise range over 3.5 standard deviations, 144 of them over 5.4
    const SHARE: f64 = 1.5 * 5.4 / 3.5;
    let range = SHARE * middle.unwrap_or(0) as f64;
    (range as u8).clamp(LEAST_RANGE, MOST_RANGE)
}

/// Each value with its eight neighbours, as one.
fn spread(plane: &Plane<u8>, best: impl Fn(u8, u8) -> u8 + Copy) -> Plane<u8> {
    let three = |row: &[u8], into: &mut [u8]| {
        into.copy_from_slice(row);
        into.iter_mut().zip(&row[1..]).for_each(|(v, &after)| *v = best(*v, after));
        into[1..].iter_mut().zip(row).for_each(|(v, &before)| *v = best(*v, before));
    };
    let mut across = Plane::filled(plane.width, plane.height, 0);
    (0..plane.height).for_each(|y| three(plane.row(y), across.row_mut(y)));
    let mut all = across.clone();
    for y in 0..plane.height {
        for other in [y.saturating_sub(1), (y + 1).min(plane.height - 1)] {
            all.row_mut(y).iter_mut().zip(across.row(other)).for_each(|(v, &o)| *v = best(*v, o));
        }
    }
    all
}
