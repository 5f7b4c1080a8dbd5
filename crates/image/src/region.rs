//! Connected regions of ink.

use std::ops::Range;

use tracelight_maths::{atan2, planar};
use tracelight_stroke::{Point, Vec2};

use crate::levels::histogram;
use crate::mask::{Cell, Mask};
use crate::plane::Plane;

/// Ink pixels `from..to` of row `y`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Run {
    /// Its row.
    pub y: u32,
    /// Its first column.
    pub from: u32,
    /// The column behind its last.
    pub to: u32,
}

impl Run {
    /// Number of pixels.
    #[inline]
    pub fn length(&self) -> usize {
        (self.to - self.from) as usize
    }

    /// What a plane has there.
    #[inline]
    pub fn levels<'a>(&self, plane: &'a Plane<u8>) -> &'a [u8] {
        &plane.row(self.y as usize)[self.from as usize..self.to as usize]
    }
}

/// Ink that hangs together, corners touching included.
#[derive(Clone, Debug)]
pub struct Region {
    /// Row by row, left to right.
    pub runs: Vec<Run>,
}

impl Region {
    /// Number of pixels.
    pub fn area(&self) -> usize {
        self.runs.iter().map(Run::length).sum()
    }

    /// How often each level of a plane comes on it.
    pub fn histogram(&self, plane: &Plane<u8>) -> [u32; 256] {
        histogram(self.runs.iter().map(|run| run.levels(plane)))
    }

    /// Columns and rows of its pixels, row by row.
    pub fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.runs.iter().flat_map(|run| (run.from as usize..run.to as usize).map(|x| (x, run.y as usize)))
    }

    /// The middle of its pixels by their weights, and their variances across, of both, and down.
    pub fn moments(&self, weight: impl Fn(usize, usize) -> f64) -> (Point, [f64; 3]) {
        let weighted =
            || self.places().map(|(x, y)| (Vec2::new(x as f64 + 0.5, y as f64 + 0.5), weight(x, y)));
        let mass = weighted().map(|(_, w)| w).sum::<f64>().max(1e-9);
        let centre = weighted().map(|(p, w)| p * w).sum::<Vec2>() / mass;
        let moment = |f: fn(Vec2) -> f64| weighted().map(|(p, w)| w * f(p - centre)).sum::<f64>() / mass;
        (centre.to_point(), [moment(|v| v.x * v.x), moment(|v| v.x * v.y), moment(|v| v.y * v.y)])
    }

    /// Those of its pixels that are ink in `mask`.
    pub fn cells<'a>(&'a self, mask: &'a Mask) -> impl Iterator<Item = Cell> + 'a {
        self.runs.iter().flat_map(|run| mask.cells_in(run.y as usize, run.from as usize, run.to as usize))
    }

    /// Width and height of its bounding box, px.
    pub fn extent(&self) -> (usize, usize) {
        let any = (usize::MAX, usize::MAX);
        self.bounds(0, any).map_or((0, 0), |(columns, rows)| (columns.len(), rows.len()))
    }

    /// Columns and rows of the bounding box with `round` px on each side, within an image of this size; `None` without pixels.
    pub fn bounds(&self, round: usize, size: (usize, usize)) -> Option<(Range<usize>, Range<usize>)> {
        let (top, bottom) = (self.runs.first()?.y as usize, self.runs.last()?.y as usize + 1);
        let left = self.runs.iter().map(|run| run.from as usize).min()?;
        let right = self.runs.iter().map(|run| run.to as usize).max()?;
        let within = |from: usize, to: usize, most: usize| from.saturating_sub(round)..(to + round).min(most);
        Some((within(left, right, size.0), within(top, bottom, size.1)))
    }

    /// Whether it leads from one border of its image to the one across.
    pub fn spans(&self, mask: &Mask) -> bool {
        let rows = self.runs.first().is_some_and(|run| run.y == 0)
            && self.runs.last().is_some_and(|run| run.y as usize + 1 == mask.height());
        let columns = self.runs.iter().any(|run| run.from == 0)
            && self.runs.iter().any(|run| run.to as usize == mask.width());
        rows || columns
    }

    /// How many of its pixels are its image's outermost.
    pub fn at_border_px(&self, mask: &Mask) -> usize {
        let at_border = |run: &Run| match run.y == 0 || run.y as usize + 1 == mask.height() {
            true => run.length(),
            false => usize::from(run.from == 0) + usize::from(run.to as usize == mask.width()),
        };
        self.runs.iter().map(at_border).sum()
    }

    /// Whether there is ink of `mask` at most `reach` px beyond its bounding box.
    pub fn is_near(&self, mask: &Mask, reach: usize) -> bool {
        let bounds = self.bounds(reach, (mask.width(), mask.height()));
        bounds.is_some_and(|(columns, mut rows)| {
            rows.any(|y| mask.cells_in(y, columns.start, columns.end).next().is_some())
        })
    }

    /// Translates the region so that `left`, `top` becomes the origin; none of its pixels lies before that.
    pub fn seen_from(&self, left: usize, top: usize) -> Self {
        let (left, top) = (left as u32, top as u32);
        let moved = |run: &Run| Run { y: run.y - top, from: run.from - left, to: run.to - left };
        Self { runs: self.runs.iter().map(moved).collect() }
    }

    /// Makes all of it paper.
    pub fn erase_from(&self, mask: &mut Mask) {
        self.runs.iter().for_each(|run| mask.erase(run.y as usize, run.from as usize, run.to as usize));
    }

    /// Makes all of it ink.
    pub fn fill_into(&self, mask: &mut Mask) {
        self.runs.iter().for_each(|run| mask.fill(run.y as usize, run.from as usize, run.to as usize));
    }
}

/// The long axis of what has such variances.
pub fn long_axis([xx, xy, yy]: [f64; 3]) -> Vec2 {
    planar::direction(0.5 * atan2(2.0 * xy, xx - yy))
}

/// How pixels hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Joined {
    /// By sides and corners: ink.
    Corners = 1,
    /// By sides only: paper.
    Sides = 0,
}

/// Every region of a mask's ink, in the order of their first pixels.
pub fn regions(mask: &Mask) -> Vec<Region> {
    let mut runs = Runs::default();
    for y in 0..mask.height() {
        runs.row(y, Joined::Corners, |found| ink_runs(mask.row(y), y as u32, found));
    }
    runs.gathered(|_| true)
}

/// Whether some of a mask's ink leads from border to border.
pub fn any_spans(mask: &Mask) -> bool {
    regions(mask).iter().any(|region| region.spans(mask))
}

/// Patches of paper of fewer than `least` pixels.
pub fn pinholes(mask: &Mask, least: usize) -> Vec<Region> {
    let mut runs = Runs::default();
    let mut inks = Vec::new();
    for y in 0..mask.height() {
        inks.clear();
        ink_runs(mask.row(y), y as u32, &mut inks);
        runs.row(y, Joined::Sides, |found| paper_between(&inks, mask.width() as u32, y as u32, found));
    }
    runs.gathered(|area| area < least)
}

/// The paper before, between and behind the ink of a row.
fn paper_between(inks: &[Run], width: u32, y: u32, found: &mut Vec<Run>) {
    let mut from = 0;
    for (ink, next) in inks.iter().map(|run| (run.from, run.to)).chain([(width, width)]) {
        if ink > from {
            found.push(Run { y, from, to: ink });
        }
        from = next;
    }
}

/// Adds the runs of ink in the words of a row.
pub fn ink_runs(row: &[u64], y: u32, found: &mut Vec<Run>) {
    let (mut start, mut inside) = (0, false);
    for (i, &word) in row.iter().enumerate() {
        // bits that differ from the one before them: where runs begin and end
        let mut turns = word ^ (word << 1 | u64::from(inside));
        while turns != 0 {
            let at = i as u32 * u64::BITS + turns.trailing_zeros();
            if inside {
                found.push(Run { y, from: start, to: at });
            }
            (start, inside) = (at, !inside);
            turns &= turns - 1;
        }
    }
    if inside {
        found.push(Run { y, from: start, to: row.len() as u32 * u64::BITS });
    }
}

/// Runs joined where they touch (Rosenfeld & Pfaltz, "Sequential operations in digital picture processing", 1966).
#[derive(Default)]
struct Runs {
    all: Vec<Run>,
    /// An older run that each hangs together with; itself if there is none.
    parents: Vec<u32>,
    /// Where the row above begins.
    above: usize,
}

impl Runs {
    /// Adds a row and joins it to the one above.
    fn row(&mut self, y: usize, joined: Joined, read: impl FnOnce(&mut Vec<Run>)) {
        let (above, first) = (self.above, self.all.len());
        read(&mut self.all);
        self.parents.extend(first as u32..self.all.len() as u32);
        let reach = joined as u32;
        let mut candidate = if y == 0 { first } else { above };
        for i in first..self.all.len() {
            let Run { from, to, .. } = self.all[i];
            while candidate < first && self.all[candidate].to + reach <= from {
                candidate += 1;
            }
            let mut k = candidate;
            while k < first && self.all[k].from < to + reach {
                self.join(k as u32, i as u32);
                k += 1;
            }
        }
        self.above = first;
    }

    /// The oldest run of a run's tree, with the way there halved.
    fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let up = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = up;
            i = up;
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
    }

    /// The regions whose area is wanted.
    fn gathered(mut self, wanted: impl Fn(usize) -> bool) -> Vec<Region> {
        let mut areas = vec![0u32; self.all.len()];
        let mut counts = vec![0u32; self.all.len()];
        for i in 0..self.all.len() {
            let root = self.root(i as u32);
            self.parents[i] = root;
            areas[root as usize] += self.all[i].to - self.all[i].from;
            counts[root as usize] += 1;
        }
        let mut number = vec![u32::MAX; self.all.len()];
        let mut regions: Vec<Region> = Vec::new();
        for (i, &run) in self.all.iter().enumerate() {
            let root = self.parents[i] as usize;
            if !wanted(areas[root] as usize) {
                continue;
            }
            if number[root] == u32::MAX {
                number[root] = regions.len() as u32;
                regions.push(Region { runs: Vec::with_capacity(counts[root] as usize) });
            }
            regions[number[root] as usize].runs.push(run);
        }
        regions
    }
}

/// The mask of these regions alone.
pub fn mask_of<'a>(like: &Mask, regions: impl IntoIterator<Item = &'a Region>) -> Mask {
    let mut mask = Mask::empty(like.width(), like.height());
    regions.into_iter().for_each(|region| region.fill_into(&mut mask));
    mask
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mask::tests::drawn;

    fn of(picture: &str) -> Vec<usize> {
        regions(&drawn(picture)).iter().map(Region::area).collect()
    }

    #[test]
    fn touching_corners_join_and_gaps_part() {
        assert_eq!(of("#.#.. .#... ...## ...##"), [3, 4]);
        assert_eq!(of("#...# #...# ##### ....."), [9]);
        assert_eq!(of("##.## ..#.. ##.##"), [9]);
        assert_eq!(of("....."), []);
    }

    #[test]
    fn a_run_over_several_words_is_one() {
        let row = format!("{}{}{}", ".".repeat(60), "#".repeat(140), ".".repeat(3));
        assert_eq!(of(&row), [140]);
        assert_eq!(of(&"#".repeat(128)), [128]);
    }

    #[test]
    fn pinholes_are_paper_closed_in_by_sides() {
        let holes = |picture: &str| pinholes(&drawn(picture), 4).iter().map(Region::area).collect::<Vec<_>>();
        assert_eq!(holes("##### #.#.# ##### #...# #...# #####"), [1, 1]);
        assert_eq!(holes(".#### #.### #####"), [1, 1]);
    }
}
