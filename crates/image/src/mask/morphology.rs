//! Erosion and dilation of masks by squares and octagons, 64 pixels at a time.

use super::{Mask, WORD, span};

impl Mask {
    /// The upper left pixels of the upright squares of `side` pixels (at most 192) that fit into the ink.
    ///
    /// A run of n in common is had from runs of n/2 in common by one more shift (van Herk's idea for words).
    pub fn eroded(mut self, side: usize) -> Self {
        let side = side.clamp(1, MOST_SIDE);
        for row in self.inked_rows() {
            each_shift(side, |by| and_right(row, by));
        }
        each_shift(side, |by| self.and_below(by));
        self
    }

    /// The squares of `side` pixels whose upper left pixels are ink: undoes [`Self::eroded`] for what survived it.
    pub fn dilated(mut self, side: usize) -> Self {
        let side = side.clamp(1, MOST_SIDE);
        let (last, mut was) = (self.last_word(), vec![0; self.stride]);
        for row in self.inked_rows() {
            each_shift(side, |by| or_left(row, by, &mut was));
            row[row.len() - 1] &= last;
        }
        each_shift(side, |by| self.or_above(by));
        self.clear_margins();
        self
    }

    /// Closed by upright squares of `side` pixels: what is narrower between its ink is filled.
    pub fn closed(self, side: usize) -> Self {
        self.dilated(side).eroded(side)
    }

    /// Four pixels for each of its own, on a mask of this size.
    pub fn doubled_to(&self, width: usize, height: usize) -> Self {
        let mut out = Self::empty(width, height);
        for y in 0..self.height.min(height.div_ceil(2)) {
            for (k, &word) in self.row(y).iter().enumerate().filter(|(_, word)| **word != 0) {
                let words = [spread(word as u32), spread((word >> 32) as u32)];
                for row in [2 * y, 2 * y + 1] {
                    if row < height {
                        let there = out.row_mut(row)[2 * k..].iter_mut();
                        there.zip(words).for_each(|(to, word)| *to = word | word << 1);
                    }
                }
            }
        }
        out
    }

    /// What upright octagons of this width (up to 400 px), which fit into the ink, cover.
    ///
    /// A regular octagon is four runs added up, level, upright and on both slants, and each is built by doubling: some
    /// thirty passes over the words, whatever the width.
    pub fn opened(mut self, width: usize) -> Self {
        let slant = ((0.293 * width as f64).round() as usize).min(MOST_SIDE);
        let side = width.saturating_sub(2 * slant).clamp(1, MOST_SIDE);
        let slants = [Slant::Right, Slant::Left];
        self = self.eroded(side);
        slants.iter().for_each(|&way| each_shift(slant + 1, |by| self.and_slanted(by, way)));
        if self.is_empty() {
            return self;
        }
        slants.iter().for_each(|&way| each_shift(slant + 1, |by| self.or_slanted(by, way)));
        self.dilated(side)
    }

    /// Dilates by an upright square of `reach` px either way.
    pub fn dilated_by(self, reach: usize) -> Self {
        let mut grown = self.dilated(reach + 1);
        for row in grown.inked_rows() {
            each_shift(reach + 1, |by| or_right(row, by));
        }
        each_shift(reach + 1, |by| grown.or_below(by));
        grown.clear_margins();
        grown
    }

    /// Whether there is no ink.
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// The rows that hold ink, each with the margin word on its left.
    fn inked_rows(&mut self) -> impl Iterator<Item = &mut [u64]> {
        let rows = self.words.chunks_exact_mut(self.stride).skip(1).take(self.height);
        rows.filter(|row| row.iter().any(|&word| word != 0))
    }

    /// The bits of a row's last word that are in the image.
    fn last_word(&self) -> u64 {
        span(self.stride - 2, 0, self.width)
    }

    /// Clears what is not in the image.
    fn clear_margins(&mut self) {
        let (stride, last, rows) = (self.stride, self.last_word(), self.height + 1);
        self.words[..stride].fill(0);
        self.words[rows * stride..].fill(0);
        for row in self.words[..rows * stride].chunks_exact_mut(stride) {
            row[0] = 0;
            row[stride - 1] &= last;
        }
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
        self.clear_margins();
    }

    /// Each pixel and the one `by` rows below it.
    fn and_below(&mut self, by: usize) {
        let (reach, all) = (by * self.stride, self.words.len());
        for from in (0..all).step_by(reach) {
            let (stretch, below) = self.words.split_at_mut((from + reach).min(all));
            let (read, beyond) = stretch[from..].split_at_mut(below.len().min(reach));
            read.iter_mut().zip(below).for_each(|(w, b)| *w &= *b);
            beyond.fill(0);
        }
    }

    /// Each pixel or the one `by` rows below it.
    fn or_below(&mut self, by: usize) {
        let (reach, all) = (by * self.stride, self.words.len());
        for from in (0..all.saturating_sub(reach)).step_by(reach) {
            let (stretch, below) = self.words.split_at_mut(from + reach);
            stretch[from..].iter_mut().zip(below).for_each(|(w, b)| *w |= *b);
        }
    }

    /// Each pixel or the one `by` rows above it.
    fn or_above(&mut self, by: usize) {
        let reach = by * self.stride;
        for from in (1..self.words.len().div_ceil(reach)).rev().map(|k| k * reach) {
            let (above, stretch) = self.words.split_at_mut(from);
            stretch.iter_mut().zip(&above[from - reach..]).for_each(|(w, a)| *w |= *a);
        }
    }
}

/// Each pixel of a row and the one `by` (up to 64) right of it.
fn and_right(row: &mut [u64], by: usize) {
    for i in 0..row.len() - 1 {
        row[i] &= shifted_down(row[i], row[i + 1], by);
    }
    let last = row.len() - 1;
    row[last] &= shifted_down(row[last], 0, by);
}

/// Each pixel of a row or the one `by` right of it; the margin word stays as it is.
fn or_right(row: &mut [u64], by: usize) {
    for i in 1..row.len() - 1 {
        row[i] |= shifted_down(row[i], row[i + 1], by);
    }
    let last = row.len() - 1;
    row[last] |= shifted_down(row[last], 0, by);
}

/// Each pixel of a row or the one `by` left of it; `was` is room for the row.
fn or_left(row: &mut [u64], by: usize, was: &mut [u64]) {
    was.copy_from_slice(row);
    let pairs = was.iter().zip(&was[1..]);
    row[1..].iter_mut().zip(pairs).for_each(|(w, (low, high))| *w |= shifted_up(*low, *high, by));
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

    /// Shifts the middle word's row by `by` bits against the slant.
    fn moved_back(self, three: &[u64], by: usize) -> u64 {
        match self {
            Slant::Right => shifted_down(three[1], three[2], by),
            Slant::Left => shifted_up(three[0], three[1], by),
        }
    }
}

/// Word `high` with the bits of `low` before it, moved up by `by` (1 to 64) bits.
fn shifted_up(low: u64, high: u64, by: usize) -> u64 {
    // a shift by 64 is none: hence the two steps
    high << 1 << (by - 1) | low >> (WORD - by)
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
    low >> 1 >> (by - 1) | high << (WORD - by)
}

/// The bits of a word at every other place (Warren, *Hacker's Delight*, 2012, §7-2).
fn spread(word: u32) -> u64 {
    const MASKS: [(u32, u64); 5] = [
        (16, 0x0000_FFFF_0000_FFFF),
        (8, 0x00FF_00FF_00FF_00FF),
        (4, 0x0F0F_0F0F_0F0F_0F0F),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ];
    MASKS.iter().fold(u64::from(word), |word, (by, mask)| (word | word << by) & mask)
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
