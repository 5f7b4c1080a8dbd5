//! Thins a region of ink to a line one pixel wide.

use tracelight_image::{Cell, Mask};

/// Thins ink to lines one pixel wide that hang together as the ink did.
///
/// Guo & Hall, "Parallel thinning with two-subiteration algorithms" (1989), algorithm A1, on 64 pixels at a time. Only
/// words next to one that changed in the last round are looked at again, so that the work is that of the ink, not of
/// the image times its thickness.
pub(crate) fn thinned(mut ink: Mask) -> Mask {
    let mut active: Vec<u32> = ink.inked_words().collect();
    let mut gone: Vec<u64> = Vec::new();
    let mut seen = vec![0u32; ink.words().len()];
    for round in 1.. {
        gone.clear();
        gone.resize(active.len(), 0);
        for half in [Half::First, Half::Second] {
            let going: Vec<u64> = active.iter().map(|&i| removable(&ink, i as usize, half)).collect();
            for ((&i, &bits), all) in active.iter().zip(&going).zip(&mut gone) {
                ink.words_mut()[i as usize] &= !bits;
                *all |= bits;
            }
        }
        active = beside(&ink, &active, &gone, &mut seen, round);
        if active.is_empty() {
            break;
        }
    }
    straightened(ink)
}

/// The words that hold ink next to pixels that went, each once.
fn beside(ink: &Mask, active: &[u32], gone: &[u64], seen: &mut [u32], round: u32) -> Vec<u32> {
    let mut next = Vec::with_capacity(active.len());
    let stride = ink.stride() as u32;
    for (&i, &bits) in active.iter().zip(gone).filter(|(_, bits)| **bits != 0) {
        let (left, right) = (u32::from(bits & 1 != 0), u32::from(bits >> 63 != 0));
        for row in [i - stride, i, i + stride] {
            for word in row - left..=row + right {
                if seen[word as usize] != round && ink.words()[word as usize] != 0 {
                    seen[word as usize] = round;
                    next.push(word);
                }
            }
        }
    }
    next
}

/// The two halves of a round: they take away the lower right and the upper left edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    First,
    Second,
}

/// The pixels of a word that go in one half of a round: the paper's p2 to p9 are the neighbours clockwise from above.
fn removable(ink: &Mask, i: usize, half: Half) -> u64 {
    let (words, stride) = (ink.words(), ink.stride());
    let row = |i: usize| {
        let (left, here, right) = (words[i - 1], words[i], words[i + 1]);
        (here << 1 | left >> 63, here, here >> 1 | right << 63)
    };
    let ((p9, p2, p3), (p8, p1, p4), (p7, p6, p5)) = (row(i - stride), row(i), row(i + stride));
    let branches = [!p2 & (p3 | p4), !p4 & (p5 | p6), !p6 & (p7 | p8), !p8 & (p9 | p2)];
    let (first, second) = ([p9 | p2, p3 | p4, p5 | p6, p7 | p8], [p2 | p3, p4 | p5, p6 | p7, p8 | p9]);
    let edge = match half {
        Half::First => (p6 | p7 | !p9) & p8,
        Half::Second => (p2 | p3 | !p5) & p4,
    };
    let one_branch = any(branches) & !two(branches);
    let two_or_three = two(first) & two(second) & !(all(first) & all(second));
    p1 & one_branch & two_or_three & !edge
}

/// Bits that are set in any of four words.
fn any([a, b, c, d]: [u64; 4]) -> u64 {
    a | b | c | d
}

/// Bits that are set in at least two of four words.
fn two([a, b, c, d]: [u64; 4]) -> u64 {
    a & b | c & d | (a | b) & (c | d)
}

/// Bits that are set in all of four words.
fn all([a, b, c, d]: [u64; 4]) -> u64 {
    a & b & c & d
}

/// Takes away the inner pixels of steps, which the parallel rule leaves: then each pixel of a line has two
/// neighbours and each end one.
fn straightened(mut line: Mask) -> Mask {
    let cells: Vec<Cell> = line.cells().collect();
    for cell in cells {
        let around = ring(line.around(cell));
        if around.count_ones() >= 2 && crossings(around) == 1 && around & 0b0101_0101 != 0 {
            line.clear(cell);
        }
    }
    line
}

/// The eight neighbours of [`Mask::around`], clockwise from above.
fn ring(around: usize) -> u8 {
    [1, 2, 5, 8, 7, 6, 3, 0].iter().rev().fold(0, |ring, &bit| ring << 1 | (around >> bit & 1) as u8)
}

/// How many separate branches of ink meet in the middle pixel (Hilditch's crossing number for ink joined at
/// corners): the pixel may go without parting them when it is 1.
fn crossings(ring: u8) -> u32 {
    let bit = |k: u32| u32::from(ring >> (k % 8) & 1);
    [0, 2, 4, 6].into_iter().map(|k| (1 - bit(k)) * (bit(k + 1) | bit(k + 2))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn skeleton(width: usize, height: usize, ink: impl Fn(f64, f64) -> bool) -> (Mask, Vec<Cell>) {
        let mut mask = Mask::empty(width, height);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            if ink(x as f64 + 0.5, y as f64 + 0.5) {
                let cell = mask.cell(x, y);
                mask.set(cell);
            }
        }
        let line = thinned(mask);
        let left = line.cells().collect();
        (line, left)
    }

    #[test]
    fn a_ring_becomes_one_closed_line_of_single_pixels() {
        for (radius, half) in [(30.0, 2.0), (25.0, 4.5), (12.0, 1.2), (33.0, 0.8)] {
            let (line, left) = skeleton(80, 80, |x, y| ((x - 40.0).hypot(y - 40.0) - radius).abs() < half);
            assert!(left.iter().all(|&i| line.neighbours(i).len() == 2), "radius {radius}");
            let length = left.len() as f64;
            assert!((5.0 * radius..6.3 * radius).contains(&length), "{length} pixels of radius {radius}");
        }
    }

    #[test]
    fn a_bar_becomes_a_line_with_two_ends() {
        for slope in [0.0, 0.3, 1.0, -0.7, 3.0] {
            let (line, left) = skeleton(90, 90, |x, y| {
                let along = ((x - 45.0) + slope * (y - 45.0)) / f64::hypot(1.0, slope);
                let across = ((y - 45.0) - slope * (x - 45.0)) / f64::hypot(1.0, slope);
                along.abs() < 30.0 && across.abs() < 3.0
            });
            let ends = left.iter().filter(|&&i| line.neighbours(i).len() == 1).count();
            assert_eq!(ends, 2, "slope {slope}");
            assert!(left.iter().all(|&i| line.neighbours(i).len() <= 2));
        }
    }

    #[test]
    fn a_filled_disc_leaves_something_and_takes_a_moment_only() {
        let (_, left) = skeleton(1000, 1000, |x, y| (x - 500.0).hypot(y - 500.0) < 480.0);
        assert!(!left.is_empty() && left.len() < 60);
    }
}
