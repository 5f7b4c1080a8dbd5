//! Thinning: from a patch of ink to a line one pixel wide.

use crate::plane::Plane;

/// Neighbours of a pixel, clockwise from above: (x, y) steps.
pub(crate) const NEIGHBOURS: [(isize, isize); 8] =
    [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1)];

/// A mask with a margin of one pixel of paper, so that every ink pixel has eight neighbours.
#[derive(Clone, Debug)]
pub(crate) struct Skeleton {
    pub(crate) ink: Plane<u8>,
    steps: [isize; 8],
}

impl Skeleton {
    /// Thins the ink at these indices (of a plane `width` × `height`); ink elsewhere is not there.
    pub(crate) fn of(width: usize, height: usize, pixels: impl Iterator<Item = usize>) -> Self {
        let mut ink = Plane::filled(width + 2, height + 2, 0u8);
        let margin = |i: usize| (i / width + 1) * (width + 2) + i % width + 1;
        let all: Vec<u32> = pixels.map(|i| margin(i) as u32).collect();
        all.iter().for_each(|&i| ink.values[i as usize] = 1);
        let stride = (width + 2) as isize;
        let mut skeleton = Self { ink, steps: NEIGHBOURS.map(|(x, y)| y * stride + x) };
        skeleton.thin(&all);
        skeleton.straighten(&all);
        skeleton
    }

    /// Index in the plane without margin.
    pub(crate) fn without_margin(&self, i: usize) -> usize {
        let stride = self.ink.width;
        (i / stride - 1) * (stride - 2) + i % stride - 1
    }

    /// Index in the plane with margin.
    pub(crate) fn with_margin(&self, i: usize) -> usize {
        let width = self.ink.width - 2;
        (i / width + 1) * self.ink.width + i % width + 1
    }

    /// Neighbours of pixel `i` that are ink.
    pub(crate) fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        let all = self.steps.iter().map(move |step| (i as isize + step) as usize);
        all.filter(|&k| self.ink.values[k] != 0)
    }

    /// Bit k: neighbour k is ink.
    fn around(&self, i: usize) -> u8 {
        let bit = |(k, step): (usize, &isize)| self.ink.values[(i as isize + step) as usize] << k;
        self.steps.iter().enumerate().map(bit).fold(0, |bits, bit| bits | bit)
    }

    /// Guo & Hall, "Parallel thinning with two-subiteration algorithms" (1989), algorithm A1. Only pixels next to
    /// one that went in the last round are looked at again, so that the work is that of the ink, not of the image
    /// times its thickness.
    fn thin(&mut self, all: &[u32]) {
        let tables = [removable(0), removable(1)];
        let mut front: Vec<u32> = all.iter().copied().filter(|&i| self.around(i as usize) != 0xff).collect();
        let mut queued = Plane::filled(self.ink.width, self.ink.height, 0u8);
        while !front.is_empty() {
            let mut next = Vec::new();
            for table in &tables {
                let goes = |i: &u32| {
                    let i = *i as usize;
                    self.ink.values[i] != 0 && table[usize::from(self.around(i))]
                };
                let gone: Vec<u32> = front.iter().copied().filter(goes).collect();
                gone.iter().for_each(|&i| self.ink.values[i as usize] = 0);
                next.extend(gone);
            }
            front = self.beside(&next, &mut queued);
        }
    }

    /// Ink next to pixels that went, each once, in order.
    fn beside(&self, gone: &[u32], queued: &mut Plane<u8>) -> Vec<u32> {
        let mut found = Vec::new();
        for &i in gone {
            for k in self.neighbours(i as usize) {
                if queued.values[k] == 0 {
                    queued.values[k] = 1;
                    found.push(k as u32);
                }
            }
        }
        found.iter().for_each(|&k| queued.values[k as usize] = 0);
        found.sort_unstable();
        found
    }

    /// Takes away the inner pixels of steps, which the parallel rule leaves: then each pixel of a line has two
    /// neighbours and each end one.
    fn straighten(&mut self, all: &[u32]) {
        for &i in all {
            let i = i as usize;
            if self.ink.values[i] != 0 {
                let around = self.around(i);
                if around.count_ones() >= 2 && crossings(around) == 1 && around & 0b0101_0101 != 0 {
                    self.ink.values[i] = 0;
                }
            }
        }
    }
}

/// How many separate branches of ink meet in the middle pixel (Hilditch's crossing number for ink joined at
/// corners): the pixel may go without parting them when it is 1.
pub(crate) fn crossings(around: u8) -> u32 {
    let bit = |k: u32| u32::from(around >> (k % 8) & 1);
    [0, 2, 4, 6].into_iter().map(|k| (1 - bit(k)) * (bit(k + 1) | bit(k + 2))).sum()
}

/// Which neighbourhoods let their middle pixel go in one half of a round.
fn removable(half: usize) -> [bool; 256] {
    let mut table = [false; 256];
    for (around, entry) in (0..=255u8).zip(&mut table) {
        let p = |k: usize| around >> ((k + 6) % 8) & 1 == 1; // the paper's p2 is the neighbour above: k counts from 2
        let pairs = |first: usize| (0..4).filter(|j| p(first + 2 * j) || p(first + 2 * j + 1)).count();
        let fewest = pairs(1).min(pairs(2));
        let edge = match half {
            0 => (p(6) || p(7) || !p(1)) && p(8),
            _ => (p(2) || p(3) || !p(5)) && p(4),
        };
        *entry = crossings(around) == 1 && (2..=3).contains(&fewest) && !edge;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thinned(width: usize, height: usize, ink: impl Fn(f64, f64) -> bool) -> (Skeleton, Vec<usize>) {
        let at = |i: &usize| ink((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let skeleton = Skeleton::of(width, height, (0..width * height).filter(at));
        let left = (0..skeleton.ink.values.len()).filter(|&i| skeleton.ink.values[i] != 0).collect();
        (skeleton, left)
    }

    #[test]
    fn a_ring_becomes_one_closed_line_of_single_pixels() {
        for (radius, half) in [(30.0, 2.0), (25.0, 4.5), (12.0, 1.2), (33.0, 0.8)] {
            let (skeleton, left) = thinned(80, 80, |x, y| ((x - 40.0).hypot(y - 40.0) - radius).abs() < half);
            assert!(left.iter().all(|&i| skeleton.neighbours(i).count() == 2), "radius {radius}");
            let length = left.len() as f64;
            assert!((5.0 * radius..6.3 * radius).contains(&length), "{length} pixels of radius {radius}");
        }
    }

    #[test]
    fn a_bar_becomes_a_line_with_two_ends() {
        for slope in [0.0, 0.3, 1.0, -0.7, 3.0] {
            let (skeleton, left) = thinned(90, 90, |x, y| {
                let along = ((x - 45.0) + slope * (y - 45.0)) / f64::hypot(1.0, slope);
                let across = ((y - 45.0) - slope * (x - 45.0)) / f64::hypot(1.0, slope);
                along.abs() < 30.0 && across.abs() < 3.0
            });
            let ends = left.iter().filter(|&&i| skeleton.neighbours(i).count() == 1).count();
            assert_eq!(ends, 2, "slope {slope}");
            assert!(left.iter().all(|&i| skeleton.neighbours(i).count() <= 2));
        }
    }

    #[test]
    fn a_filled_disc_leaves_something_and_takes_a_moment_only() {
        let (_, left) = thinned(1000, 1000, |x, y| (x - 500.0).hypot(y - 500.0) < 480.0);
        assert!(!left.is_empty() && left.len() < 60);
    }
}
