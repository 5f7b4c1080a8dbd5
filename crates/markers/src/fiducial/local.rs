//! Adaptive threshold: separates dark from light by the local surroundings.

use std::ops::Range;

use tracelight_image::threshold::word_of;
use tracelight_image::{Mask, Plane};

/// Side of the squares in which the darkest and the brightest level are looked for, px.
const TILE: usize = 4;

/// By how much black and white about a place differ at least, levels.
const LEAST_RANGE: u8 = 16;
/// Noise never asks for more than this, levels: a picture full of texture is not noise.
const MOST_RANGE: u8 = 64;

/// Columns and rows of an image.
pub(super) type Part = (Range<usize>, Range<usize>);

/// The darkest and the brightest level about each place.
pub(super) struct Surroundings {
    /// Of the 3 × 3 squares about each square.
    low: Plane<u8>,
    high: Plane<u8>,
    /// Where these differ by less there is nothing but noise.
    least_range: u8,
}

/// How far above the darkest what is dark may be, in sixths of the range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Darkness {
    /// Two thirds: half of the light is there in what cameras store, and the border of a small marker, which is hardly wider than its blur,
    /// is no darker.
    Most = 4,
    /// Half: a thin white edge between a marker and something grey, or white in the shade beside something bright, is no brighter than two
    /// thirds.
    Half = 3,
}

impl Darkness {
    /// The next one down.
    pub(super) const fn less(self) -> Option<Self> {
        match self {
            Self::Most => Some(Self::Half),
            Self::Half => None,
        }
    }
}

impl Surroundings {
    pub(super) fn of(plane: &Plane<u8>) -> Self {
        let (low, high) = extremes(plane);
        let least_range = least_range(&low, &high);
        Self { low: spread(&low, u8::min), high: spread(&high, u8::max), least_range }
    }

    /// What is darker than that share of the way from the darkest to the brightest about it, in some columns and rows of the image; nothing
    /// where these hardly differ.
    pub(super) fn darker(&self, plane: &Plane<u8>, darkness: Darkness, part: &Part) -> Mask {
        let (columns, rows) = part;
        let mut mask = Mask::empty(columns.len(), rows.len());
        let mut thresholds = vec![0; columns.len()];
        let mut of_row = None;
        for y in rows.clone() {
            // the last squares are as many pixels larger as are left over
            let row = (y / TILE).min(self.low.height - 1);
            if of_row.replace(row) != Some(row) {
                self.thresholds(row, columns, darkness, &mut thresholds);
            }
            let levels = &plane.row(y)[columns.clone()];
            darker_row(levels, &thresholds, mask.row_mut(y - rows.start));
        }
        mask
    }

    /// Of some columns in a row of squares.
    fn thresholds(&self, row: usize, columns: &Range<usize>, darkness: Darkness, thresholds: &mut [u8]) {
        let (low, high) = (self.low.row(row), self.high.row(row));
        let mut left = thresholds;
        let mut x = columns.start;
        while !left.is_empty() {
            let column = (x / TILE).min(low.len() - 1);
            let count = (TILE - x % TILE).min(left.len());
            let (some, others) = left.split_at_mut(count);
            let range = high[column] - low[column];
            let dark = (u16::from(range) * darkness as u16 / 6) as u8;
            some.fill(if range < self.least_range { 0 } else { low[column] + dark });
            (left, x) = (others, x + count);
        }
    }
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
