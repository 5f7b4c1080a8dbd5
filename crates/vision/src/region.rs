//! Connected patches of ink.

use crate::plane::Plane;

/// Pixels `from..to` of row `y`, all ink.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) y: u32,
    pub(crate) from: u32,
    pub(crate) to: u32,
}

impl Run {
    fn length(self) -> usize {
        (self.to - self.from) as usize
    }

    /// Indices of its pixels in a plane of this width.
    pub(crate) fn indices(self, width: usize) -> std::ops::Range<usize> {
        let row = self.y as usize * width;
        row + self.from as usize..row + self.to as usize
    }
}

/// Ink that hangs together, corners touching included.
#[derive(Clone, Debug)]
pub(crate) struct Region {
    /// Row by row, left to right.
    pub(crate) runs: Vec<Run>,
}

impl Region {
    /// Number of pixels.
    pub(crate) fn area(&self) -> usize {
        self.runs.iter().map(|r| r.length()).sum()
    }

    /// Indices of its pixels in a plane of this width, row by row.
    pub(crate) fn pixels(&self, width: usize) -> impl Iterator<Item = usize> + '_ {
        self.runs.iter().flat_map(move |run| run.indices(width))
    }
}

/// Every region of a mask, in the order of their first pixels, by joining runs that touch (Rosenfeld & Pfaltz,
/// "Sequential operations in digital picture processing", 1966, on runs).
pub(crate) fn regions(mask: &Plane<u8>) -> Vec<Region> {
    let mut runs: Vec<Run> = Vec::new();
    let mut parents: Vec<u32> = Vec::new();
    let mut above = 0..0;
    for y in 0..mask.height {
        let first = runs.len();
        runs_of(mask.row(y), y as u32, &mut runs);
        parents.extend(first as u32..runs.len() as u32);
        let mut candidate = above.start;
        for i in first..runs.len() {
            while candidate < above.end && runs[candidate].to < runs[i].from {
                candidate += 1;
            }
            let touching = (candidate..above.end).take_while(|&k| runs[k].from <= runs[i].to);
            touching.for_each(|k| join(&mut parents, k as u32, i as u32));
        }
        above = first..runs.len();
    }
    gathered(&runs, &mut parents)
}

fn runs_of(row: &[u8], y: u32, runs: &mut Vec<Run>) {
    let mut x = 0;
    while let Some(from) = row[x..].iter().position(|&m| m != 0).map(|k| x + k) {
        let to = row[from..].iter().position(|&m| m == 0).map_or(row.len(), |k| from + k);
        runs.push(Run { y, from: from as u32, to: to as u32 });
        x = to;
    }
}

/// The oldest run of a run's tree, with the way there halved.
fn root(parents: &mut [u32], mut i: u32) -> u32 {
    while parents[i as usize] != i {
        let up = parents[parents[i as usize] as usize];
        parents[i as usize] = up;
        i = up;
    }
    i
}

fn join(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}

fn gathered(runs: &[Run], parents: &mut [u32]) -> Vec<Region> {
    let mut number = vec![u32::MAX; runs.len()];
    let mut regions: Vec<Region> = Vec::new();
    for (i, &run) in runs.iter().enumerate() {
        let root = root(parents, i as u32) as usize;
        if number[root] == u32::MAX {
            number[root] = regions.len() as u32;
            regions.push(Region { runs: Vec::new() });
        }
        regions[number[root] as usize].runs.push(run);
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(picture: &str) -> Vec<usize> {
        let rows: Vec<&str> = picture.split_whitespace().collect();
        let values = rows.iter().flat_map(|r| r.bytes()).map(|b| u8::from(b == b'#')).collect();
        regions(&Plane { width: rows[0].len(), height: rows.len(), values })
            .iter()
            .map(Region::area)
            .collect()
    }

    #[test]
    fn touching_corners_join_and_gaps_part() {
        assert_eq!(of("#.#.. .#... ...## ...##"), [3, 4]);
        assert_eq!(of("#...# #...# ##### ....."), [9]);
        assert_eq!(of("##.## ..#.. ##.##"), [9]);
        assert_eq!(of("....."), []);
    }
}
