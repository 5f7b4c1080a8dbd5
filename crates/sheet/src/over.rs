//! What reaches over a sheet from beside it: a finger, a weight; and what is seen of the table within its corners.
//!
//! Along a side of the sheet, some way inside, there is something else than its paper, and it goes on beyond the side. A
//! finger is followed from there to its tip; the table at a corner, where another sheet lies below, is all that is
//! joined to it.

use std::ops::Range;
use std::slice;

use tracelight_image::Plane;
use tracelight_image::median::middle;
use tracelight_stroke::{Point, Vec2};

use crate::quad::{Quad, SIDES};
use crate::small::BESIDE;

/// What is seen along a side differs from its paper by this share.
const FOREIGN: f64 = 0.08;
/// And where it is followed by this one: its shadow on the paper, which goes on beyond it.
const SHADED: f64 = 0.035;
/// Where the step from the sheet to what lies beside it is less than this share of the usual one, it is hidden.
const HIDDEN: f64 = 0.5;
/// A stretch of a side that is hidden is at least so long: share of the picture's shorter side, and px.
const LEAST_HIDDEN: f64 = 0.035;
const LEAST_HIDDEN_PX: f64 = 4.0;
/// Paper is as bright as the middle of this share of a side to either way.
const USUAL: usize = 4;
/// What is darker than this share of the paper is ink that runs off the sheet, unless it is seen to go on beyond it.
const DARKEST: f64 = 0.4;
/// What lies over a sheet is at most so many times as long as it is wide where it comes in, and widens so much, with its
/// shadow: a finger is some three times as long as wide.
const MOST_LONG: f64 = 8.0;
const MOST_WIDENED: f64 = 3.0;
/// Further in it is no darker than this share of what it was, against the paper: what is, is ink behind it.
const LIKE_BEFORE: f64 = 0.75;
/// A tip begins where it is narrower than this share of what it was, and is over within half of that.
const TIP: f64 = 0.6;
/// On its way in it leans by at most so much from row to row, px.
const LEANS: f64 = 2.0;
/// And on its way to the edge, px.
const LEANING: f64 = 8.0;
/// What is nearer to each other belongs together, px.
const GAP: f64 = 3.0;
/// Paper is seen half as far from it as it is wide, for so many px.
const PAPER: f64 = 10.0;
/// So far beyond what covers it the sheet is in its shadow, px.
const WIDER: usize = 3;
/// A corner begins so near to an end of a side, px.
const AT_END: usize = 4;
/// Most of a sheet that something lies on, and that is table.
const MOST_OVER: f64 = 0.1;
const MOST_CORNER: f64 = 0.15;

/// What reaches over a sheet from beside it: a finger, a weight. Where it does, the sheet's edge is hidden.
pub(crate) fn covered(calm: &Plane<u8>, quad: &Quad, depths: &[f64]) -> Plane<bool> {
    let mut covered = Plane::filled(calm.width, calm.height, false);
    for side in SIDES {
        let along = Along::of(calm, quad, side);
        for run in along.runs() {
            let points = along.over(&run).or_else(|| along.corner(&run, depths));
            for at in points.into_iter().flatten() {
                cover_near(&mut covered, at);
            }
        }
    }
    covered
}

/// A side of a sheet, with what is seen along it.
struct Along<'a> {
    calm: &'a Plane<u8>,
    quad: &'a Quad,
    from: Point,
    way: Vec2,
    inward: Vec2,
    /// Whether nothing is seen beyond it.
    is_border: bool,
    /// Places along it that are clear of the sides next to it, px.
    places: Range<usize>,
}

impl<'a> Along<'a> {
    fn of(calm: &'a Plane<u8>, quad: &'a Quad, side: usize) -> Self {
        let (from, to) = quad.ends(side);
        let (inward, length) = (quad.inward(side), from.distance(to));
        let way = (to - from) / length;
        let depth = quad.depths();
        let at = |k: usize| from + way * k as f64 + inward * BESIDE;
        let is_clear = |k: &usize| calm.holds(at(*k)) && depth(at(*k)) > 0.9 * BESIDE;
        let first = (0..length as usize).find(is_clear).unwrap_or(0);
        let last = (first..length as usize).rfind(is_clear).map_or(first, |last| last + 1);
        let is_border = quad.sides[side].is_none();
        Self { calm, quad, from, way, inward, is_border, places: first..last }
    }

    fn at(&self, along: f64, depth: f64) -> Point {
        self.from + self.way * along + self.inward * depth
    }

    /// The level at a place, without a shadow.
    fn level(&self, along: f64, depth: f64) -> Option<f64> {
        let at = self.at(along, depth);
        self.calm.holds(at).then(|| self.quad.lit(at, self.calm.at(at)))
    }

    /// The levels of some places.
    fn levels(&self, places: Range<f64>, depth: f64) -> Vec<f64> {
        let places = places.start.ceil() as i64..places.end.floor() as i64 + 1;
        places.filter_map(|k| self.level(k as f64, depth)).collect()
    }

    /// Where along it there is something else than its paper; where something is seen beyond it, where its step is hidden.
    fn runs(&self) -> Vec<Range<usize>> {
        let row = |depth: f64| -> Vec<Option<f64>> {
            self.places.clone().map(|k| self.level(k as f64, depth)).collect()
        };
        let (inner, outer) = (row(BESIDE), row(-BESIDE));
        let (first, count) = (self.places.start, inner.len());
        let reach = count / USUAL;
        let usual =
            |row: &[Option<f64>], near: Range<usize>| middle(row[near].iter().flatten().copied().collect());
        let is_other = |k: &usize| {
            let near = k.saturating_sub(reach)..(k + reach + 1).min(count);
            let sides = [near.start..*k, k + 1..near.end];
            // at an end what lies there is a part of what is usual
            let sides = if sides.iter().all(|side| 2 * side.len() > reach) {
                &sides[..]
            } else {
                slice::from_ref(&near)
            };
            let papers: Vec<f64> = sides.iter().filter_map(|side| usual(&inner, side.clone())).collect();
            let Some(inside) = inner[*k] else { return false };
            let step =
                || Some((inside - outer[*k]?, usual(&inner, near.clone())? - usual(&outer, near.clone())?));
            differs(inside, &papers, FOREIGN)
                || !self.is_border && step().is_some_and(|(step, usual)| step.abs() < HIDDEN * usual.abs())
        };
        let runs = stretches((0..count).filter(is_other).map(|k| (first + k) as f64));
        let mut runs: Vec<Range<usize>> =
            runs.into_iter().map(|(start, end)| start as usize..end as usize + 1).collect();
        let shorter = self.calm.width.min(self.calm.height) as f64;
        let least = (LEAST_HIDDEN * shorter).max(LEAST_HIDDEN_PX);
        runs.retain(|run| run.len() as f64 >= least);
        // its middle may be as bright as the paper
        let mut joined: Vec<Range<usize>> = Vec::new();
        for run in runs {
            let near = |last: &&mut Range<usize>| run.start - last.end < run.len().min(last.len());
            match joined.last_mut().filter(near) {
                Some(last) => last.end = run.end,
                None => joined.push(run),
            }
        }
        joined.retain(|run| 2 * run.len() < count);
        joined
    }

    /// The places of what lies on a run, with its shadow on the paper, followed into the sheet; `None` if it does not come
    /// from beside the sheet, or is no thing of that width.
    fn over(&self, run: &Range<usize>) -> Option<Vec<Point>> {
        let width = run.len() as f64;
        let reach = 0.5 * width;
        let mut row = Row::of(run).next(self, BESIDE, (width, width), 0.0)?;
        if !self.comes_from_beside(run, &row) {
            return None;
        }
        let darkest = LIKE_BEFORE * row.level / row.paper;
        let first = row.width();
        let most = MOST_OVER * self.quad.area();
        let mut area = 0.0;
        let (mut rows, mut widest, mut last) = (vec![row.clone()], first, f64::INFINITY);
        for step in 1.. {
            let depth = BESIDE + f64::from(step);
            let Some(next) = row.next(self, depth, (reach, LEANS), darkest) else { break };
            area += next.width();
            if next.width() > MOST_WIDENED * first || depth > MOST_LONG * first || area > most {
                return None;
            }
            widest = widest.max(next.width());
            // its tip is round; what is behind it is ink
            if next.width() < TIP * widest {
                last = last.min(depth + 0.5 * widest);
            }
            let is_behind = last.is_finite() && next.width() > row.width() + LEANS;
            if is_behind || next.level < darkest * next.paper || depth > last {
                break;
            }
            row = next;
            rows.push(row.clone());
        }
        // and what of it is nearer to the edge
        let nearer = (-(BESIDE as i64)..BESIDE as i64).map(|depth| (depth as f64, &rows[0]));
        let further = rows.iter().enumerate().map(|(k, row)| (BESIDE + k as f64, row));
        let places = |(depth, row): (f64, &Row)| {
            let start = row.start();
            (0..=row.width() as usize).map(move |k| self.at(start + k as f64, depth)).collect::<Vec<_>>()
        };
        Some(nearer.chain(further).flat_map(places).collect())
    }

    /// Whether what is seen in a row reaches over the sheet's edge: what is as dark as ink only if it differs from what lies
    /// beside the sheet.
    fn comes_from_beside(&self, run: &Range<usize>, row: &Row) -> bool {
        let near = run.start as f64 - LEANING..run.end as f64 + LEANING;
        let outermost = if self.is_border { 0 } else { -(BESIDE as i64) };
        let goes_on = |depth: i64| {
            let levels = self.levels(near.clone(), depth as f64);
            levels.is_empty() || levels.into_iter().any(|level| row.holds(level))
        };
        let is_ink = row.level < DARKEST * row.paper;
        let share = if row.papers.len() < 2 { 2.0 * FOREIGN } else { FOREIGN };
        if !is_ink && differs(row.level, &row.papers, share) && (outermost..BESIDE as i64).all(goes_on) {
            return true;
        }
        let of =
            |range: &Range<usize>| middle(self.levels(range.start as f64..range.end as f64 - 1.0, -BESIDE));
        let Some((beyond, table)) = of(run).zip(of(&self.places)) else { return false };
        (beyond - row.level).abs() < HIDDEN * (beyond - table).abs()
    }

    /// The places of what is seen of the table at a corner, where a side of another sheet below is taken for one of its own:
    /// a run that begins at an end of the side, as bright as what lies beside it there, and all that is joined to it.
    fn corner(&self, run: &Range<usize>, depths: &[f64]) -> Option<Vec<Point>> {
        if run.start > self.places.start + AT_END && run.end + AT_END < self.places.end {
            return None;
        }
        let row = Row::of(run).next(self, BESIDE, (0.5 * run.len() as f64, 0.0), 0.0)?;
        let outside = run.clone().filter_map(|k| self.level(k as f64, -BESIDE)).collect();
        if !self.is_border && !row.holds(middle(outside)?) {
            return None;
        }
        let calm = self.calm;
        let place = |i: usize| Point::new((i % calm.width) as f64 + 0.5, (i / calm.width) as f64 + 0.5);
        let lit = |i: usize| self.quad.lit(place(i), f64::from(calm.values[i]));
        let holds = |i: usize| depths[i] > 0.0 && row.holds(lit(i));
        let mut seen = vec![false; calm.values.len()];
        let mut patch: Vec<usize> = Vec::new();
        for at in run.clone().map(|k| self.at(k as f64, BESIDE)) {
            let i = at.y as usize * calm.width + at.x as usize;
            if !seen[i] && holds(i) {
                seen[i] = true;
                patch.push(i);
            }
        }
        calm.flood(&mut patch, &mut seen, |_, k| holds(k));
        let sheet = depths.iter().filter(|depth| **depth > 0.0).count();
        ((patch.len() as f64) < MOST_CORNER * sheet as f64).then(|| patch.into_iter().map(place).collect())
    }
}

/// What lies over a sheet at some depth in it: its level in the middle, and the paper's beside it.
#[derive(Clone, Debug)]
struct Row {
    /// From where to where along the side it is seen to differ from the paper, at least once.
    patches: Vec<(f64, f64)>,
    /// The same a row before.
    before: Vec<(f64, f64)>,
    level: f64,
    paper: f64,
    /// The paper's before it and after it, where they are seen.
    papers: Vec<f64>,
}

impl Row {
    fn of(run: &Range<usize>) -> Self {
        let patches = vec![(run.start as f64, run.end as f64 - 1.0)];
        Self { patches, before: Vec::new(), level: 0.0, paper: 0.0, papers: Vec::new() }
    }

    fn start(&self) -> f64 {
        self.patches[0].0
    }

    fn end(&self) -> f64 {
        self.patches[self.patches.len() - 1].1
    }

    fn width(&self) -> f64 {
        self.end() - self.start()
    }

    /// Whether a level is nearer to its own than to the paper's.
    fn holds(&self, level: f64) -> bool {
        let half = 0.5 * (self.level + self.paper);
        (level > half) == (self.level > half)
    }

    /// What of it is seen at a depth, past which it may reach on either side by so much; paper is seen further out. What is
    /// darker than some share of the paper is none of it. `None` where there is nothing but paper.
    fn next(&self, along: &Along, depth: f64, (off, reach): (f64, f64), darkest: f64) -> Option<Self> {
        let places = along.places.start as f64..along.places.end as f64 - 1.0;
        let window = |from: f64, to: f64| {
            let (from, to) = (from.max(places.start), to.min(places.end));
            let levels = if to - from > 3.0 { along.levels(from..to, depth) } else { Vec::new() };
            Some((0.5 * (from + to), middle(levels)?))
        };
        let before = window(self.start() - off - PAPER, self.start() - off);
        let after = window(self.end() + off, self.end() + off + PAPER);
        // light falls off from one to the other
        let paper = move |k: f64| match (before, after) {
            (Some((a, from)), Some((b, to))) => {
                Some(from + (to - from) * ((k - a) / (b - a)).clamp(0.0, 1.0))
            }
            (one, other) => one.or(other).map(|(_, level)| level),
        };
        let share = if before.is_some() && after.is_some() { SHADED } else { 2.0 * FOREIGN };
        let is_over = |k: f64| {
            let Some((level, paper)) = along.level(k, depth).zip(paper(k)) else { return false };
            (level - paper).abs() > share * paper && level > darkest * paper
        };
        let near = (0..=(self.width() + 2.0 * reach) as usize).map(|k| self.start() - reach + k as f64);
        let mut patches = stretches(near.filter(|k| is_over(*k)));
        // what is joined to it, and not only behind it
        let own = || self.patches.iter().chain(&self.before);
        let is_joined = |patch: &(f64, f64)| own().any(|own| patch.1 >= own.0 && patch.0 <= own.1);
        patches.retain(is_joined);
        let (start, end) = (patches.first()?.0, patches.last()?.1);
        let (middle_at, quarter) = (0.5 * (start + end), 0.125 * (end - start) + 1.0);
        let level = middle(along.levels(middle_at - quarter..middle_at + quarter, depth))?;
        let papers = [before, after].into_iter().flatten().map(|(_, level)| level).collect();
        let before = self.patches.clone();
        Some(Self { patches, before, level, paper: paper(middle_at)?, papers })
    }
}

/// From the first to the last of places that are near each other.
fn stretches(places: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for k in places {
        match found.last_mut().filter(|last| last.1 + GAP >= k) {
            Some(last) => last.1 = k,
            None => found.push((k, k)),
        }
    }
    found
}

/// Whether a level is none of the papers that are seen, by some share: light falls off on one way, and what is seen from both
/// sides differs from both.
fn differs(level: f64, papers: &[f64], share: f64) -> bool {
    let off = |paper: &f64| (level - paper) / paper;
    !papers.is_empty() && (papers.iter().all(|p| off(p) > share) || papers.iter().all(|p| off(p) < -share))
}

/// With all so near, px.
fn cover_near(covered: &mut Plane<bool>, at: Point) {
    let (x, y) = (at.x.max(0.0) as usize, at.y.max(0.0) as usize);
    let (x, y) = (x.min(covered.width - 1), y.min(covered.height - 1));
    let (from, to) = (x.saturating_sub(WIDER), (x + WIDER + 1).min(covered.width));
    for y in y.saturating_sub(WIDER)..(y + WIDER + 1).min(covered.height) {
        covered.row_mut(y)[from..to].fill(true);
    }
}
