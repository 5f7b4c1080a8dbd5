//! Pseudo-random numbers that depend only on a position and a seed.

/// 2⁶⁴ by the golden ratio: numbers that follow each other are far apart.
pub(super) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Bits that look drawn: the finalizer of SplitMix64 (Steele, Lea & Flood, *Fast splittable pseudorandom number generators*, 2014, fig. 16).
pub(super) const fn mixed(mut z: u64) -> u64 {
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}
