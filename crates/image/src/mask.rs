//! A mask of one bit a pixel, 64 pixels a word, so that a whole picture stays in the cache.

mod morphology;

use std::f64::consts::FRAC_PI_4;
use std::ops::Range;

use tracelight_stroke::Point;

/// Number of a pixel's bit in its mask: its neighbours are at ±1, at ± [`Mask::line`] and between.
pub type Cell = u32;

/// Which pixels are ink. Beyond its borders, by one pixel, there is paper, so that every pixel has eight neighbours.
#[derive(Clone)]
pub struct Mask {
    width: usize,
    height: usize,
    /// Words from one row to the next: those of the row and one of margin, which serves the row above on its right.
    stride: usize,
    words: Vec<u64>,
}

/// Its size; a picture's worth of bits helps nobody.
impl std::fmt::Debug for Mask {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Mask({} × {})", self.width, self.height)
    }
}

const WORD: usize = u64::BITS as usize;

impl Mask {
    /// All paper.
    pub fn empty(width: usize, height: usize) -> Self {
        let stride = width.div_ceil(WORD) + 1;
        Self { width, height, stride, words: vec![0; (height + 2) * stride + 1] }
    }

    /// Pixels in a row.
    #[inline]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[inline]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Bits from a row to the next.
    #[inline]
    pub fn line(&self) -> Cell {
        (self.stride * WORD) as Cell
    }

    /// The bit of a pixel.
    #[inline]
    pub fn cell(&self, x: usize, y: usize) -> Cell {
        (((y + 1) * self.stride + 1) * WORD + x) as Cell
    }

    /// Column and row of a bit.
    #[inline]
    pub fn place(&self, cell: Cell) -> (usize, usize) {
        let (line, bit) = (self.stride * WORD, cell as usize);
        (bit % line - WORD, bit / line - 1)
    }

    /// Centre of a bit's pixel.
    #[inline]
    pub fn centre(&self, cell: Cell) -> Point {
        let (x, y) = self.place(cell);
        Point::new(x as f64 + 0.5, y as f64 + 0.5)
    }

    /// Whether a cell is ink.
    #[inline]
    pub fn has(&self, cell: Cell) -> bool {
        self.words[cell as usize / WORD] >> (cell as usize % WORD) & 1 != 0
    }

    /// Makes a cell ink.
    #[inline]
    pub fn set(&mut self, cell: Cell) {
        self.words[cell as usize / WORD] |= 1 << (cell as usize % WORD);
    }

    /// Makes a cell paper.
    #[inline]
    pub fn clear(&mut self, cell: Cell) {
        self.words[cell as usize / WORD] &= !(1 << (cell as usize % WORD));
    }

    /// Whether a pixel is ink; pixels outside the mask are not.
    #[inline]
    pub fn get(&self, x: isize, y: isize) -> bool {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.has(self.cell(x, y)),
            _ => false,
        }
    }

    /// The words of a row, lowest bit leftmost; bits past the width are 0.
    #[inline]
    pub fn row(&self, y: usize) -> &[u64] {
        &self.words[(y + 1) * self.stride + 1..][..self.stride - 1]
    }

    /// Returns the words of a row for writing; bits past the width must stay 0.
    #[inline]
    pub fn row_mut(&mut self, y: usize) -> &mut [u64] {
        &mut self.words[(y + 1) * self.stride + 1..][..self.stride - 1]
    }

    /// The bits left of a cell, of itself and right of it, as the lowest three.
    #[inline]
    fn three(&self, cell: usize) -> usize {
        let (word, shift) = ((cell - 1) / WORD, (cell - 1) % WORD);
        // a shift by 64 is none: hence the two steps
        let bits = self.words[word] >> shift | self.words[word + 1] << 1 << (WORD - 1 - shift);
        bits as usize & 7
    }

    /// The 3 × 3 pixels about one: the row above in the lowest three bits, left to right, its own, the row below.
    #[inline]
    pub fn around(&self, cell: Cell) -> usize {
        let (cell, line) = (cell as usize, self.stride * WORD);
        self.three(cell - line) | self.three(cell) << 3 | self.three(cell + line) << 6
    }

    /// Bits of the pixels about one that are ink; itself is not among them.
    #[inline]
    pub fn neighbours(&self, cell: Cell) -> Neighbours {
        Neighbours { around: self.around(cell) & !MIDDLE, cell, line: self.line() }
    }

    /// The pixels all of whose eight neighbours are ink.
    pub fn inside(&self) -> Self {
        let mut out = Self::empty(self.width, self.height);
        for y in 1..self.height.saturating_sub(1) {
            let threes = self.row(y - 1).iter().zip(self.row(y)).zip(self.row(y + 1));
            let columns: Vec<u64> = threes.map(|((above, here), below)| above & here & below).collect();
            let at = |k: usize| columns.get(k).copied().unwrap_or(0);
            for (k, word) in out.row_mut(y).iter_mut().enumerate() {
                let (before, after) = (k.checked_sub(1).map_or(0, at), at(k + 1));
                *word = at(k) & (at(k) << 1 | before >> 63) & (at(k) >> 1 | after << 63);
            }
        }
        out
    }

    /// Length of the lines that have this ink's border on either side, px: half of the border. Rows and columns of pixels cross a
    /// border 4/π times as often as it is long, whichever way it runs (Cauchy and Crofton).
    pub fn line_length(&self) -> f64 {
        let changes = |(one, other): (u64, u64)| (one ^ other).count_ones() as usize;
        let crossed = |y: usize| {
            let row = self.row(y);
            let carried = std::iter::once(0).chain(row.iter().map(|word| word >> 63));
            let across = row.iter().zip(carried).map(|(&word, carried)| changes((word, word << 1 | carried)));
            let below = if y + 1 < self.height { self.row(y + 1) } else { row };
            across.sum::<usize>()
                + row.iter().zip(below).map(|(&one, &other)| changes((one, other))).sum::<usize>()
        };
        let crossings: usize = (0..self.height).map(crossed).sum();
        0.5 * FRAC_PI_4 * crossings as f64
    }

    /// Number of ink pixels.
    pub fn count(&self) -> usize {
        self.words.iter().map(|w| w.count_ones() as usize).sum()
    }

    /// All words, with those of the margins.
    #[inline]
    pub fn words(&self) -> &[u64] {
        &self.words
    }

    /// Returns all words for writing; margins must stay 0.
    #[inline]
    pub fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// Words from a row to the next.
    #[inline]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Numbers of the words that hold ink.
    pub fn inked_words(&self) -> impl Iterator<Item = u32> + '_ {
        self.words.iter().enumerate().filter(|(_, word)| **word != 0).map(|(i, _)| i as u32)
    }

    /// All ink pixels, row by row.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + '_ {
        let of = |(i, &word): (usize, &u64)| Ones(word).map(move |bit| (i * WORD) as Cell + bit);
        self.words.iter().enumerate().filter(|(_, w)| **w != 0).flat_map(of)
    }

    /// Ink pixels among `from..to` of row `y`.
    #[inline]
    pub fn cells_in(&self, y: usize, from: usize, to: usize) -> impl Iterator<Item = Cell> + '_ {
        let first = self.cell(0, y);
        let row = self.row(y);
        (from / WORD..to.div_ceil(WORD)).flat_map(move |i| {
            let word = row[i] & span(i, from, to);
            Ones(word).map(move |bit| first + (i * WORD) as Cell + bit)
        })
    }

    /// Makes `from..to` of row `y` ink.
    #[inline]
    pub fn fill(&mut self, y: usize, from: usize, to: usize) {
        let row = self.row_mut(y);
        (from / WORD..to.div_ceil(WORD)).for_each(|i| row[i] |= span(i, from, to));
    }

    /// Makes `from..to` of row `y` paper.
    #[inline]
    pub(crate) fn erase(&mut self, y: usize, from: usize, to: usize) {
        let row = self.row_mut(y);
        (from / WORD..to.div_ceil(WORD)).for_each(|i| row[i] &= !span(i, from, to));
    }

    /// Its pixels in some columns and rows.
    pub fn part(&self, columns: &Range<usize>, rows: &Range<usize>) -> Self {
        let mut part = Self::empty(columns.len(), rows.len());
        for y in rows.clone() {
            for cell in self.cells_in(y, columns.start, columns.end) {
                let (x, y) = self.place(cell);
                part.set(part.cell(x - columns.start, y - rows.start));
            }
        }
        part
    }

    /// What is ink here and in `other`, which has the same size.
    pub fn and(mut self, other: &Self) -> Self {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a &= b);
        self
    }

    /// What is ink here and not in `other`, which has the same size.
    pub fn without(mut self, other: &Self) -> Self {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a &= !b);
        self
    }

    /// Makes ink what is ink in `other`, which has the same size.
    pub fn add(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a |= b);
    }
}

/// The middle bit of [`Mask::around`].
const MIDDLE: usize = 1 << 4;

/// The bits of word number `i` that lie in `from..to`.
#[inline]
fn span(i: usize, from: usize, to: usize) -> u64 {
    let (low, high) = (from.saturating_sub(i * WORD).min(WORD), to.saturating_sub(i * WORD).min(WORD));
    let below = |n: usize| if n == WORD { u64::MAX } else { (1 << n) - 1 };
    below(high) & !below(low)
}

/// Numbers of the bits that are set, lowest first.
struct Ones(u64);

impl Iterator for Ones {
    type Item = Cell;

    #[inline]
    fn next(&mut self) -> Option<Cell> {
        let bit = (self.0 != 0).then(|| self.0.trailing_zeros())?;
        self.0 &= self.0 - 1;
        Some(bit)
    }
}

/// Neighbours of a pixel that are ink, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Neighbours {
    around: usize,
    cell: Cell,
    line: Cell,
}

impl Iterator for Neighbours {
    type Item = Cell;

    #[inline]
    fn next(&mut self) -> Option<Cell> {
        let bit = (self.around != 0).then(|| self.around.trailing_zeros())?;
        self.around &= self.around - 1;
        Some(self.cell - self.line - 1 + bit / 3 * self.line + bit % 3)
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.len(), Some(self.len()))
    }
}

impl ExactSizeIterator for Neighbours {
    #[inline]
    fn len(&self) -> usize {
        self.around.count_ones() as usize
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A mask from a picture in words: `#` is ink.
    pub(crate) fn drawn(picture: &str) -> Mask {
        let rows: Vec<&str> = picture.split_whitespace().collect();
        let mut mask = Mask::empty(rows[0].len(), rows.len());
        for (y, row) in rows.iter().enumerate() {
            for (x, _) in row.bytes().enumerate().filter(|(_, b)| *b == b'#') {
                let cell = mask.cell(x, y);
                mask.set(cell);
            }
        }
        mask
    }

    #[test]
    fn a_bit_knows_its_place_and_its_neighbours() {
        let mut mask = Mask::empty(130, 5);
        for (x, y) in [(0, 0), (63, 2), (64, 2), (65, 3), (129, 4)] {
            let cell = mask.cell(x, y);
            mask.set(cell);
            assert_eq!(mask.place(cell), (x, y));
        }
        let at = mask.cell(64, 2);
        let near: Vec<_> = mask.neighbours(at).map(|c| mask.place(c)).collect();
        assert_eq!(near, [(63, 2), (65, 3)]);
        assert_eq!(mask.around(mask.cell(0, 0)), MIDDLE);
        assert_eq!(mask.around(mask.cell(0, 1)), 0b10);
        assert_eq!(mask.count(), 5);
        assert!(!mask.get(-1, 0) && !mask.get(130, 4) && mask.get(129, 4));
    }

    #[test]
    fn what_is_inside_has_ink_all_around() {
        let mut mask = Mask::empty(200, 9);
        (1..8).for_each(|y| mask.fill(y, 60, 140));
        mask.clear(mask.cell(100, 4));
        let inside = mask.inside();
        for (x, y) in (0..200).flat_map(|x| (0..9).map(move |y| (x, y))) {
            let around = (-1..2).flat_map(|i| (-1..2).map(move |j| (x + i, y + j)));
            let is_inside = around.into_iter().all(|(x, y)| mask.get(x, y));
            assert_eq!(inside.get(x, y), is_inside, "{x}, {y}");
        }
    }

    #[test]
    fn spans_are_filled_and_erased_to_the_bit() {
        let mut mask = Mask::empty(200, 2);
        mask.fill(1, 60, 130);
        assert_eq!(mask.count(), 70);
        assert_eq!(mask.cells_in(1, 0, 70).count(), 10);
        mask.erase(1, 64, 128);
        let left: Vec<_> = mask.cells().map(|c| mask.place(c).0).collect();
        assert_eq!(left, [60, 61, 62, 63, 128, 129]);
    }
}
