//! Histograms of grey levels, of all pixels or of a sample.

use crate::plane::Plane;

/// A histogram in the making: four tables, for a level that repeats need not wait for itself.
pub(crate) struct Counts([[u32; 256]; 4]);

impl Default for Counts {
    fn default() -> Self {
        Self([[0; 256]; 4])
    }
}

impl Counts {
    pub(crate) fn add(&mut self, levels: &[u8]) {
        let fours = levels.chunks_exact(4);
        fours.remainder().iter().for_each(|&v| self.0[0][usize::from(v)] += 1);
        for four in fours {
            four.iter().zip(&mut self.0).for_each(|(&v, table)| table[usize::from(v)] += 1);
        }
    }

    pub(crate) fn sum(&self) -> [u32; 256] {
        std::array::from_fn(|level| self.0.iter().map(|table| table[level]).sum())
    }
}

/// How many times each level occurs.
pub fn histogram<'a>(levels: impl Iterator<Item = &'a [u8]>) -> [u32; 256] {
    let mut counts = Counts::default();
    levels.for_each(|levels| counts.add(levels));
    counts.sum()
}

/// The level below which `share` of a histogram lies.
#[inline]
pub fn percentile(histogram: &[u32; 256], share: f64) -> f64 {
    let all = histogram.iter().sum::<u32>();
    // counted from above: paper is bright, and its levels are few
    let above = ((1.0 - share) * f64::from(all)) as u32;
    let mut passed = 0;
    let level = histogram.iter().rposition(|&n| {
        passed += n;
        passed > above
    });
    level.unwrap_or(0) as f64
}

/// Pixels that are looked at together: as many as a mask has in a word.
const BLOCK: usize = 64;
/// Number of pixels sampled for a histogram: all the others would move a share by a thousandth at most.
pub const SAMPLED: usize = 250_000;

/// The histogram of about [`SAMPLED`] pixels.
pub fn sampled_histogram(plane: &Plane<u8>) -> [u32; 256] {
    histogram(sampled_blocks(plane, SAMPLED).map(|(.., levels)| levels))
}

/// Every k-th block of 64 pixels, about `sampled` in all, with its row and its number there: without a pattern, so that no
/// line falls between them all along, whatever its direction (Knuth's multiplicative hash, *Sorting and Searching*, §6.4).
pub fn sampled_blocks(plane: &Plane<u8>, sampled: usize) -> impl Iterator<Item = (usize, usize, &[u8])> {
    let every = (plane.values.len() / sampled).max(1);
    let row = move |y: usize| {
        let first = ((y as u32).wrapping_mul(2_654_435_769) >> 12) as usize % every;
        let blocks = plane.row(y).chunks(BLOCK).enumerate().skip(first).step_by(every);
        blocks.map(move |(number, levels)| (y, number, levels))
    };
    (0..plane.height).flat_map(row)
}
