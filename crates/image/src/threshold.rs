//! Thresholding.

use crate::mask::Mask;
use crate::plane::Plane;

/// Where a plane is over a threshold.
pub fn over(plane: &Plane<u8>, threshold: u8) -> Mask {
    let mut mask = Mask::empty(plane.width, plane.height);
    for y in 0..plane.height {
        let words = mask.row_mut(y).iter_mut();
        words.zip(plane.row(y).chunks(64)).for_each(|(word, levels)| *word = word_over(levels, threshold));
    }
    mask
}

/// Bit k: level k is over the threshold; up to 64 levels.
#[inline]
pub fn word_over(levels: &[u8], threshold: u8) -> u64 {
    let mut flags = [0u8; 64];
    flags.iter_mut().zip(levels).for_each(|(flag, &level)| *flag = u8::from(level > threshold));
    word_of(&flags)
}

/// Bit k: flag k is 1; all of them are 0 or 1.
#[inline]
pub fn word_of(flags: &[u8; 64]) -> u64 {
    // the product moves the lowest bits of eight bytes next to each other, into the highest byte
    let byte = |k: usize| {
        let eight: [u8; 8] = std::array::from_fn(|i| flags[8 * k + i]);
        (u64::from_le_bytes(eight).wrapping_mul(0x0102_0408_1020_4080) >> 56) << (8 * k)
    };
    (0..8).map(byte).fold(0, |word, bits| word | bits)
}
