//! A mask of one bit a pixel: 64 pixels a word, so that a whole picture of them stays in the cache.

use tracelight_stroke::Point;

/// Number of a pixel's bit in its mask: its neighbours are at ±1, at ± [`Mask::line`] and between.
pub(crate) type Cell = u32;

/// Which pixels are ink. Beyond its borders, by one pixel, there is paper, so that every pixel has eight neighbours.
#[derive(Clone)]
pub(crate) struct Mask {
    pub(crate) width: usize,
    pub(crate) height: usize,
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
    pub(crate) fn empty(width: usize, height: usize) -> Self {
        let stride = width.div_ceil(WORD) + 1;
        Self { width, height, stride, words: vec![0; (height + 2) * stride + 1] }
    }

    /// Bits from a row to the next.
    pub(crate) fn line(&self) -> Cell {
        (self.stride * WORD) as Cell
    }

    /// The bit of a pixel.
    pub(crate) fn cell(&self, x: usize, y: usize) -> Cell {
        (((y + 1) * self.stride + 1) * WORD + x) as Cell
    }

    /// Column and row of a bit.
    pub(crate) fn place(&self, cell: Cell) -> (usize, usize) {
        let (line, bit) = (self.stride * WORD, cell as usize);
        (bit % line - WORD, bit / line - 1)
    }

    /// Centre of a bit's pixel.
    pub(crate) fn centre(&self, cell: Cell) -> Point {
        let (x, y) = self.place(cell);
        Point::new(x as f64 + 0.5, y as f64 + 0.5)
    }

    pub(crate) fn has(&self, cell: Cell) -> bool {
        self.words[cell as usize / WORD] >> (cell as usize % WORD) & 1 != 0
    }

    pub(crate) fn set(&mut self, cell: Cell) {
        self.words[cell as usize / WORD] |= 1 << (cell as usize % WORD);
    }

    pub(crate) fn clear(&mut self, cell: Cell) {
        self.words[cell as usize / WORD] &= !(1 << (cell as usize % WORD));
    }

    /// Whether a pixel is ink; outside there is none.
    pub(crate) fn get(&self, x: isize, y: isize) -> bool {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.has(self.cell(x, y)),
            _ => false,
        }
    }

    /// The words of a row, lowest bit leftmost; bits past the width are 0.
    pub(crate) fn row(&self, y: usize) -> &[u64] {
        &self.words[(y + 1) * self.stride + 1..][..self.stride - 1]
    }

    /// The same, to be written; bits past the width must stay 0.
    pub(crate) fn row_mut(&mut self, y: usize) -> &mut [u64] {
        &mut self.words[(y + 1) * self.stride + 1..][..self.stride - 1]
    }

    /// The bits left of a cell, of itself and right of it, as the lowest three.
    fn three(&self, cell: usize) -> usize {
        let (word, shift) = ((cell - 1) / WORD, (cell - 1) % WORD);
        // a shift by 64 is none: hence the two steps
        let bits = self.words[word] >> shift | self.words[word + 1] << 1 << (WORD - 1 - shift);
        bits as usize & 7
    }

    /// The 3 × 3 pixels about one: the row above in the lowest three bits, left to right, its own, the row below.
    pub(crate) fn around(&self, cell: Cell) -> usize {
        let (cell, line) = (cell as usize, self.stride * WORD);
        self.three(cell - line) | self.three(cell) << 3 | self.three(cell + line) << 6
    }

    /// Bits of the pixels about one that are ink; itself is not among them.
    pub(crate) fn neighbours(&self, cell: Cell) -> Neighbours {
        Neighbours { around: self.around(cell) & !MIDDLE, cell, line: self.line() }
    }

    /// Number of ink pixels.
    #[cfg(test)]
    pub(crate) fn count(&self) -> usize {
        self.words.iter().map(|w| w.count_ones() as usize).sum()
    }

    /// All words, with those of the margins.
    pub(crate) fn words(&self) -> &[u64] {
        &self.words
    }

    /// The same, to be written; margins must stay 0.
    pub(crate) fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// Words from a row to the next.
    pub(crate) fn stride(&self) -> usize {
        self.stride
    }

    /// Numbers of the words that hold ink.
    pub(crate) fn inked_words(&self) -> impl Iterator<Item = u32> + '_ {
        self.words.iter().enumerate().filter(|(_, word)| **word != 0).map(|(i, _)| i as u32)
    }

    /// All ink pixels, row by row.
    pub(crate) fn cells(&self) -> impl Iterator<Item = Cell> + '_ {
        let of = |(i, &word): (usize, &u64)| Ones(word).map(move |bit| (i * WORD) as Cell + bit);
        self.words.iter().enumerate().filter(|(_, w)| **w != 0).flat_map(of)
    }

    /// Ink pixels among `from..to` of row `y`.
    pub(crate) fn cells_in(&self, y: usize, from: usize, to: usize) -> impl Iterator<Item = Cell> + '_ {
        let first = self.cell(0, y);
        let row = self.row(y);
        (from / WORD..to.div_ceil(WORD)).flat_map(move |i| {
            let word = row[i] & span(i, from, to);
            Ones(word).map(move |bit| first + (i * WORD) as Cell + bit)
        })
    }

    /// Makes `from..to` of row `y` ink.
    pub(crate) fn fill(&mut self, y: usize, from: usize, to: usize) {
        let row = self.row_mut(y);
        (from / WORD..to.div_ceil(WORD)).for_each(|i| row[i] |= span(i, from, to));
    }

    /// Makes `from..to` of row `y` paper.
    pub(crate) fn erase(&mut self, y: usize, from: usize, to: usize) {
        let row = self.row_mut(y);
        (from / WORD..to.div_ceil(WORD)).for_each(|i| row[i] &= !span(i, from, to));
    }

    /// What is ink here and in `other`, which has the same size.
    pub(crate) fn and(mut self, other: &Self) -> Self {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a &= b);
        self
    }

    /// What is ink here and not in `other`, which has the same size.
    pub(crate) fn without(mut self, other: &Self) -> Self {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a &= !b);
        self
    }

    /// Makes ink what is ink in `other`, which has the same size.
    pub(crate) fn add(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(a, b)| *a |= b);
    }
}

impl Mask {
    /// The upper left pixels of the upright squares of `side` pixels (at most 192) that fit into the ink.
    ///
    /// A run of n in common is had from runs of n/2 in common by one more shift (van Herk's idea for words).
    pub(crate) fn eroded(mut self, side: usize) -> Self {
        let side = side.clamp(1, MOST_SIDE);
        each_shift(side, |by| self.and_shifted(by));
        each_shift(side, |by| self.and_below(by));
        self
    }

    /// The squares of `side` pixels whose upper left pixels are ink: undoes [`Self::eroded`] for what survived it.
    pub(crate) fn dilated(mut self, side: usize) -> Self {
        let side = side.clamp(1, MOST_SIDE);
        each_shift(side, |by| self.or_shifted(by));
        each_shift(side, |by| self.or_above(by));
        self.trim();
        self
    }

    /// What upright octagons of this width (up to 400 px), which fit into the ink, cover.
    ///
    /// A regular octagon is four runs added up, level, upright and on both slants, and each is built by doubling: some
    /// thirty passes over the words, whatever the width.
    pub(crate) fn opened(mut self, width: usize) -> Self {
        let slant = ((0.293 * width as f64).round() as usize).min(MOST_SIDE);
        let side = width.saturating_sub(2 * slant).clamp(1, MOST_SIDE);
        let slants = [Slant::Right, Slant::Left];
        self = self.eroded(side);
        slants.iter().for_each(|&way| each_shift(slant + 1, |by| self.and_slanted(by, way)));
        slants.iter().for_each(|&way| each_shift(slant + 1, |by| self.or_slanted(by, way)));
        self.dilated(side)
    }

    /// All within the upright squares of `reach` px either way about each ink pixel.
    pub(crate) fn dilated_by(self, reach: usize) -> Self {
        let mut grown = self.dilated(reach + 1);
        each_shift(reach + 1, |by| grown.or_shifted_back(by));
        each_shift(reach + 1, |by| grown.or_below(by));
        grown.trim();
        grown
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// Each pixel and the one `by` rows below and `by` columns aside. Stretches as long as the way are done at once: what
    /// a stretch reads lies behind it, and is still as it was. Each begins with a margin, which stays empty.
    fn and_slanted(&mut self, by: usize, way: Slant) {
        let reach = by * self.stride;
        let all = self.words.len();
        for from in (0..all).step_by(reach) {
            let (stretch, behind) = self.words.split_at_mut((from + reach).min(all));
            let stretch = &mut stretch[from..];
            let threes = behind.windows(3);
            let read = (threes.len() + 1).min(stretch.len());
            stretch[1..read.max(1)]
                .iter_mut()
                .zip(threes)
                .for_each(|(w, three)| *w &= way.moved_back(three, by));
            stretch[read..].fill(0);
        }
    }

    /// Each pixel or the one `by` rows above and `by` columns aside: undoes [`Self::and_slanted`].
    fn or_slanted(&mut self, by: usize, way: Slant) {
        let reach = by * self.stride;
        let count = self.words.len().div_ceil(reach);
        for from in (1..count).rev().map(|k| k * reach) {
            let (above, stretch) = self.words.split_at_mut(from);
            let above = &above[from - reach..];
            let threes = above.windows(3);
            stretch[1..].iter_mut().zip(threes).for_each(|(w, three)| *w |= way.moved_on(three, by));
            // the last word's right neighbour is margin
            let last = [above[reach - 2], above[reach - 1], 0];
            stretch.iter_mut().skip(reach - 1).take(1).for_each(|w| *w |= way.moved_on(&last, by));
        }
        self.trim();
    }

    /// Each pixel and the one `by` (up to 64) right of it; the margin keeps rows apart.
    fn and_shifted(&mut self, by: usize) {
        for i in 0..self.words.len() - 1 {
            self.words[i] &= shifted_down(self.words[i], self.words[i + 1], by);
        }
    }

    fn and_below(&mut self, by: usize) {
        let reach = by * self.stride;
        for i in 0..self.words.len() {
            self.words[i] &= self.words.get(i + reach).copied().unwrap_or(0);
        }
    }

    fn or_shifted(&mut self, by: usize) {
        for i in (1..self.words.len()).rev() {
            let up = if by == WORD { 0 } else { self.words[i] << by };
            self.words[i] |= up | self.words[i - 1] >> (WORD - by);
        }
        // what ran over into the margin would come back in the next row
        self.trim();
    }

    /// Each pixel or the one `by` (up to 64) right of it.
    fn or_shifted_back(&mut self, by: usize) {
        for i in 0..self.words.len() - 1 {
            self.words[i] |= shifted_down(self.words[i], self.words[i + 1], by);
        }
        self.trim();
    }

    fn or_below(&mut self, by: usize) {
        let reach = by * self.stride;
        for i in 0..self.words.len().saturating_sub(reach) {
            self.words[i] |= self.words[i + reach];
        }
    }

    fn or_above(&mut self, by: usize) {
        let reach = by * self.stride;
        for i in (reach..self.words.len()).rev() {
            self.words[i] |= self.words[i - reach];
        }
    }

    /// Clears what is not in the image.
    fn trim(&mut self) {
        let (stride, width, height) = (self.stride, self.width, self.height);
        for (i, word) in self.words.iter_mut().enumerate() {
            let inside = (1..=height).contains(&(i / stride)) && i % stride > 0;
            *word &= if inside { span(i % stride - 1, 0, width) } else { 0 };
        }
    }
}

/// Which way a slant leads downwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slant {
    Right,
    Left,
}

impl Slant {
    /// The middle of three words with its row moved `by` bits along the slant.
    fn moved_on(self, three: &[u64], by: usize) -> u64 {
        match self {
            Slant::Right => shifted_up(three[0], three[1], by),
            Slant::Left => shifted_down(three[1], three[2], by),
        }
    }

    /// The same, moved against it.
    fn moved_back(self, three: &[u64], by: usize) -> u64 {
        match self {
            Slant::Right => shifted_down(three[1], three[2], by),
            Slant::Left => shifted_up(three[0], three[1], by),
        }
    }
}

/// Word `high` with the bits of `low` before it, moved up by `by` (1 to 64) bits.
fn shifted_up(low: u64, high: u64, by: usize) -> u64 {
    if by == WORD { low } else { high << by | low >> (WORD - by) }
}

/// The widest square that [`Mask::eroded`] looks for, px: three words.
const MOST_SIDE: usize = 3 * WORD;

/// Shifts by which a run of `side` is built up: 1, 2, 4 … 64, 64 and what is left.
fn each_shift(side: usize, mut shift: impl FnMut(usize)) {
    let mut reached = 1;
    while reached < side {
        let by = reached.min(side - reached).min(WORD);
        shift(by);
        reached += by;
    }
}

/// Word `low` with the bits of `high` behind it, moved down by `by` (1 to 64) bits.
fn shifted_down(low: u64, high: u64, by: usize) -> u64 {
    if by == WORD { high } else { low >> by | high << (WORD - by) }
}

/// The middle bit of [`Mask::around`].
const MIDDLE: usize = 1 << 4;

/// The bits of word number `i` that lie in `from..to`.
fn span(i: usize, from: usize, to: usize) -> u64 {
    let (low, high) = (from.saturating_sub(i * WORD).min(WORD), to.saturating_sub(i * WORD).min(WORD));
    let below = |n: usize| if n == WORD { u64::MAX } else { (1 << n) - 1 };
    below(high) & !below(low)
}

/// Numbers of the bits that are set, lowest first.
struct Ones(u64);

impl Iterator for Ones {
    type Item = Cell;

    fn next(&mut self) -> Option<Cell> {
        let bit = (self.0 != 0).then(|| self.0.trailing_zeros())?;
        self.0 &= self.0 - 1;
        Some(bit)
    }
}

/// Neighbours of a pixel that are ink, row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Neighbours {
    around: usize,
    cell: Cell,
    line: Cell,
}

impl Neighbours {
    pub(crate) fn len(&self) -> usize {
        self.around.count_ones() as usize
    }
}

impl Iterator for Neighbours {
    type Item = Cell;

    fn next(&mut self) -> Option<Cell> {
        let bit = (self.around != 0).then(|| self.around.trailing_zeros())?;
        self.around &= self.around - 1;
        Some(self.cell - self.line - 1 + bit / 3 * self.line + bit % 3)
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
    fn squares_that_fit_are_found_and_grow_back() {
        let mut mask = Mask::empty(300, 160);
        (10..150).for_each(|y| mask.fill(y, 30, 170)); // 140 × 140
        (0..160).for_each(|y| mask.fill(y, 250, 290)); // 40 wide
        for (side, left) in [(30, 111 * 111 + 11 * 131), (100, 41 * 41), (140, 1), (141, 0), (192, 0)] {
            assert_eq!(mask.clone().eroded(side).count(), left, "side {side}");
        }
        let opened = mask.clone().eroded(77).dilated(77);
        assert_eq!(opened.count(), 140 * 140);
        assert_eq!(opened.without(&mask).count(), 0);
    }

    #[test]
    fn squares_about_a_pixel_reach_as_far_either_way() {
        for reach in [1, 2, 5, 24] {
            let mut mask = Mask::empty(200, 80);
            for (x, y) in [(64, 40), (0, 0), (199, 79)] {
                let cell = mask.cell(x, y);
                mask.set(cell);
            }
            let side = 2 * reach + 1;
            let grown = mask.dilated_by(reach);
            assert_eq!(grown.count(), side * side + 2 * (reach + 1) * (reach + 1), "reach {reach}");
            assert!(grown.get(64 - reach as isize, 40 + reach as isize));
        }
    }

    #[test]
    fn octagons_that_fit_cover_a_disc_and_leave_a_stick_alone() {
        let mut mask = Mask::empty(300, 300);
        for y in 0..300 {
            let half = (100.0_f64 * 100.0 - (y as f64 + 0.5 - 150.0).powi(2)).max(0.0).sqrt();
            if half >= 1.0 {
                mask.fill(y, (150.0 - half).round() as usize, (150.0 + half).round() as usize);
            }
        }
        let disc = mask.count();
        (145..155).for_each(|y| mask.fill(y, 240, 300));
        for width in [14, 30, 77, 150] {
            let opened = mask.clone().opened(width);
            let covered = opened.count() as f64 / disc as f64;
            assert!((0.94..1.002).contains(&covered), "{width}: {covered}");
            assert_eq!(opened.clone().without(&mask).count(), 0, "{width}: covers paper");
            assert!(!opened.get(270, 150), "{width}: covers the stick");
        }
        assert_eq!(mask.opened(230).count(), 0);
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
