//! Thinning: from a patch of ink to a line one pixel wide.

use crate::mask::{Cell, Mask};

/// Thins ink to lines one pixel wide that hang together as the ink did.
///
/// Guo & Hall, "Parallel thinning with two-subiteration algorithms" (1989), algorithm A1. Only pixels next to one that
/// went in the last round are looked at again, so that the work is that of the ink, not of the image times its
/// thickness.
pub(crate) fn thinned(ink: Mask) -> Mask {
    let mut thinning = Thinning::new(ink);
    while !thinning.front.is_empty() {
        thinning.round();
    }
    straightened(thinning.ink)
}

struct Thinning {
    ink: Mask,
    /// Pixels to be looked at.
    front: Vec<Cell>,
    /// Pixels already in the next front.
    queued: Mask,
    /// What goes in each half of a round.
    tables: [[bool; 512]; 2],
}

impl Thinning {
    fn new(ink: Mask) -> Self {
        let front = ink.cells().filter(|&cell| ink.around(cell) != 0x1ff).collect();
        let queued = Mask::empty(ink.width, ink.height);
        Self { ink, front, queued, tables: [removable(0), removable(1)] }
    }

    fn round(&mut self) {
        let mut gone: Vec<Cell> = Vec::with_capacity(self.front.len());
        for table in &self.tables {
            let from = gone.len();
            let ink = &self.ink;
            gone.extend(self.front.iter().filter(|&&cell| table[ink.around(cell)]));
            gone[from..].iter().for_each(|&cell| self.ink.clear(cell));
        }
        self.front.clear();
        for &cell in &gone {
            for near in self.ink.neighbours(cell) {
                if !self.queued.has(near) {
                    self.queued.set(near);
                    self.front.push(near);
                }
            }
        }
        self.front.iter().for_each(|&cell| self.queued.clear(cell));
    }
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

/// Which neighbourhoods let their middle pixel go in one half of a round.
fn removable(half: usize) -> [bool; 512] {
    std::array::from_fn(|around| {
        let ring = ring(around);
        let p = |k: usize| ring >> ((k + 6) % 8) & 1 == 1; // the paper's p2 is the neighbour above: k counts from 2
        let pairs = |first: usize| (0..4).filter(|j| p(first + 2 * j) || p(first + 2 * j + 1)).count();
        let fewest = pairs(1).min(pairs(2));
        let edge = match half {
            0 => (p(6) || p(7) || !p(1)) && p(8),
            _ => (p(2) || p(3) || !p(5)) && p(4),
        };
        around & 1 << 4 != 0 && crossings(ring) == 1 && (2..=3).contains(&fewest) && !edge
    })
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
