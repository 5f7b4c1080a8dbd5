//! What reaches over a sheet from beside it: a finger, a weight; and what is seen of the table within its corners.
//!
//! Along a side of the sheet, some way inside, there is something else than its paper, and it goes on beyond the side. A
//! finger is followed from there to its tip; the table at a corner, where another sheet lies below, is all that is
//! joined to it.

use std::ops::Range;

use tracelight_stroke::{Point, Vec2};

use super::BESIDE;
use super::quad::{Quad, SIDES};
use crate::plane::Plane;
use crate::ridge::middle;

/// What reaches over a sheet differs from its paper by this share.
const FOREIGN: f64 = 0.08;
/// A stretch of a side that is hidden is at least so long: share of the picture's shorter side, and px.
const LEAST_HIDDEN: f64 = 0.035;
const LEAST_HIDDEN_PX: f64 = 4.0;
/// Paper is as bright as the middle of this share of a side to either way.
const USUAL: usize = 4;
/// What is darker than this share of the paper is ink that runs off the sheet.
const DARKEST: f64 = 0.4;
/// What lies over a sheet is at most so many times as long as it is wide where it comes in, and widens so much: a finger
/// is some three times as long as wide.
const MOST_LONG: f64 = 8.0;
const MOST_WIDENED: f64 = 3.0;
/// Further in it is no darker than this share of what it was, against the paper: what is, is ink behind it.
const LIKE_BEFORE: f64 = 0.75;
/// A tip is narrower than this share of it.
const TIP: f64 = 0.6;
/// It may lean by so much on its way in, px.
const LEANS: usize = 8;
/// Paper is seen so far from it, px.
const PAPER: Range<f64> = 6.0..16.0;
/// So far beyond what covers it the sheet is in its shadow, px.
const LEAST_WIDER: usize = 3;
const MOST_WIDER: usize = 8;
/// Most of a sheet that is table.
const MOST_CORNER: f64 = 0.15;

/// What reaches over a sheet from beside it: a finger, a weight. Where it does, there is the same on both sides of the
/// sheet's edge, and other than the paper along it.
pub(super) fn covered(calm: &Plane<u8>, quad: &Quad, depths: &[f64]) -> Plane<bool> {
    let mut covered = Plane::filled(calm.width, calm.height, false);
    for side in SIDES {
        let along = Along::of(calm, quad, side);
        for run in along.runs() {
            // a finger's nail and the shadow about it are about as wide as a part of it
            let wider = (run.len() / 3).clamp(LEAST_WIDER, MOST_WIDER);
            let points = along.over(&run).or_else(|| along.corner(&run, depths));
            for at in points.into_iter().flatten() {
                cover_near(&mut covered, at, wider);
            }
        }
    }
    covered
}

/// A side of a sheet, with what is seen along it.
struct Along<'a> {
    calm: &'a Plane<u8>,
    from: Point,
    way: Vec2,
    inward: Vec2,
    /// Whether nothing is seen beyond it.
    is_border: bool,
    /// Places along it that are clear of the sides next to it, px, and the levels just inside, without a shadow.
    places: Range<usize>,
    lit: Vec<f64>,
}

impl<'a> Along<'a> {
    fn of(calm: &'a Plane<u8>, quad: &Quad, side: usize) -> Self {
        let (from, to) = quad.ends(side);
        let (inward, length) = (quad.inward(side), from.distance(to));
        let way = (to - from) / length;
        let depth = quad.depths();
        let at = |k: usize| from + way * k as f64 + inward * BESIDE;
        let is_clear = |k: &usize| calm.holds(at(*k)) && depth(at(*k)) > 0.9 * BESIDE;
        let first = (0..length as usize).find(is_clear).unwrap_or(0);
        let last = (first..length as usize).rfind(is_clear).map_or(first, |last| last + 1);
        let lit = (first..last).map(|k| quad.lit(at(k), calm.at(at(k)))).collect();
        let is_border = quad.sides[side].is_none();
        Self { calm, from, way, inward, is_border, places: first..last, lit }
    }

    fn at(&self, along: f64, depth: f64) -> Point {
        self.from + self.way * along + self.inward * depth
    }

    fn level(&self, along: f64, depth: f64) -> Option<f64> {
        let at = self.at(along, depth);
        self.calm.holds(at).then(|| self.calm.at(at))
    }

    /// Where along it there is something else than its paper.
    fn runs(&self) -> Vec<Range<usize>> {
        let (first, count) = (self.places.start, self.lit.len());
        let reach = count / USUAL;
        let is_other = |k: &usize| {
            let near = &self.lit[k.saturating_sub(reach)..(k + reach + 1).min(count)];
            middle(near.to_vec()).is_some_and(|paper| (self.lit[*k] - paper).abs() > FOREIGN * paper)
        };
        let mut runs: Vec<Range<usize>> = Vec::new();
        for k in (0..count).filter(is_other).map(|k| first + k) {
            match runs.last_mut().filter(|run| run.end + 2 >= k) {
                Some(run) => run.end = k + 1,
                None => runs.push(k..k + 1),
            }
        }
        let shorter = self.calm.width.min(self.calm.height) as f64;
        let least = (LEAST_HIDDEN * shorter).max(LEAST_HIDDEN_PX);
        runs.retain(|run| run.len() as f64 >= least && 2 * run.len() < count);
        runs
    }

    /// The places of what lies on a run, followed into the sheet; `None` if it does not come from beside the sheet, or is no
    /// thing of that width.
    fn over(&self, run: &Range<usize>) -> Option<Vec<Point>> {
        let width = run.len() as f64;
        let mut over = Over::new(self, 0.5 * (run.start + run.end) as f64, width, BESIDE)?;
        let outermost = if self.is_border { 0.0 } else { -BESIDE };
        let outward = (1..).map(|step| BESIDE - f64::from(step)).take_while(|depth| *depth >= outermost);
        let near = (run.start.saturating_sub(LEANS)..run.end + LEANS).step_by(2);
        let comes_from = |depth: f64| {
            let mut levels = near.clone().filter_map(|k| self.level(k as f64, depth)).peekable();
            levels.peek().is_none() || levels.any(|level| over.holds(level))
        };
        if over.level < DARKEST * over.paper || !outward.into_iter().all(comes_from) {
            return None;
        }
        let mut points = Vec::new();
        let darkest = LIKE_BEFORE * over.level / over.paper;
        let mut widest: f64 = 0.0;
        for step in 0.. {
            let depth = BESIDE + f64::from(step);
            let Some((start, end)) = over.across(self, depth) else { break };
            if end - start > MOST_WIDENED * width || depth > MOST_LONG * width {
                return None;
            }
            // its tip is round; what is behind it is ink
            widest = widest.max(end - start);
            if end - start < TIP * widest {
                break;
            }
            points.extend((0..=(end - start) as usize).map(|k| self.at(start + k as f64, depth)));
            match Over::new(self, 0.5 * (start + end), end - start, depth) {
                Some(here) if here.level > darkest * here.paper => over = here,
                _ => break,
            }
        }
        // and what of it is nearer to the edge
        let edge: Vec<Point> =
            points.iter().take_while(|p| self.depth(**p) < BESIDE + 0.5).copied().collect();
        let steps = (0..BESIDE as usize).map(|k| k as f64 + 1.0);
        points.extend(steps.flat_map(|back| edge.iter().map(move |p| *p - self.inward * back)));
        Some(points)
    }

    /// The places of what is seen of the table at a corner, where a side of another sheet below is taken for one of its own:
    /// a run that begins at an end of the side, as bright as what lies beside it there, and all that is joined to it.
    fn corner(&self, run: &Range<usize>, depths: &[f64]) -> Option<Vec<Point>> {
        if run.start > self.places.start + 2 && run.end + 2 < self.places.end {
            return None;
        }
        let over = Over::new(self, 0.5 * (run.start + run.end) as f64, run.len() as f64, BESIDE)?;
        let outside = run.clone().filter_map(|k| self.level(k as f64, -BESIDE)).collect();
        if !self.is_border && !over.holds(middle(outside)?) {
            return None;
        }
        let calm = self.calm;
        let holds = |i: usize| depths[i] > 0.0 && over.holds(f64::from(calm.values[i]));
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
        let place = |i: usize| Point::new((i % calm.width) as f64 + 0.5, (i / calm.width) as f64 + 0.5);
        ((patch.len() as f64) < MOST_CORNER * sheet as f64).then(|| patch.into_iter().map(place).collect())
    }

    fn depth(&self, at: Point) -> f64 {
        (at - self.from).dot(self.inward)
    }
}

/// What lies over a sheet, at some depth in it: where along the side its middle is, its level, and the paper's beside it.
struct Over {
    middle: f64,
    width: f64,
    level: f64,
    paper: f64,
}

impl Over {
    /// `None` where there is nothing but paper.
    fn new(along: &Along, middle_at: f64, width: f64, depth: f64) -> Option<Self> {
        let levels = |from: f64, to: f64| {
            let places =
                (from.ceil() as i64..=to.floor() as i64).filter_map(|k| along.level(k as f64, depth));
            middle(places.collect())
        };
        let level = levels(middle_at - 0.25 * width - 1.0, middle_at + 0.25 * width + 1.0)?;
        // past the shadow of what lies there; one of both may be in another shadow
        let (first, last) = (middle_at - 0.5 * width, middle_at + 0.5 * width);
        let within = |at: f64| at.clamp(along.places.start as f64, along.places.end as f64);
        let beside = [
            (within(first - PAPER.end), first - PAPER.start),
            (last + PAPER.start, within(last + PAPER.end)),
        ];
        let papers = beside.into_iter().filter(|(a, b)| b - a > 3.0).filter_map(|(a, b)| levels(a, b));
        let papers: Vec<f64> = papers.collect();
        let differs = |share: f64, is_darker: bool| {
            let off = |paper: &f64| if is_darker { paper - level } else { level - paper };
            !papers.is_empty() && papers.iter().all(|paper| off(paper) > share * paper)
        };
        // light falls off on one way: what is seen from one side alone differs by more, what is seen from both from both
        let share = if papers.len() == 2 { FOREIGN } else { 2.0 * FOREIGN };
        let near = |a: &f64, b: &f64| (a - level).abs().total_cmp(&(b - level).abs());
        let paper = papers.iter().copied().min_by(near)?;
        if !differs(share, true) && !differs(share, false) {
            return None;
        }
        Some(Self { middle: middle_at, width, level, paper })
    }

    /// Whether a level is nearer to its own than to the paper's.
    fn holds(&self, level: f64) -> bool {
        let half = 0.5 * (self.level + self.paper);
        (level > half) == (self.level > half)
    }

    /// From where to where along the side it lies at a depth.
    fn across(&self, along: &Along, depth: f64) -> Option<(f64, f64)> {
        let holds = |at: f64| along.level(at, depth).is_some_and(|level| self.holds(level));
        let reach = (0.25 * self.width) as i64;
        let middle = self.middle.round();
        // it may lean, and end on one side
        let start = (0..=reach).flat_map(|k| [middle - k as f64, middle + k as f64]).find(|at| holds(*at))?;
        // past the sides next to it there is none of the sheet
        let (first, last) = (along.places.start as f64 - BESIDE, along.places.end as f64 + BESIDE);
        let until = |way: f64| {
            let on = (0..).map(|k| start + way * f64::from(k));
            on.take_while(|at| (first..last).contains(at) && holds(*at)).last().unwrap_or(start)
        };
        Some((until(-1.0), until(1.0)))
    }
}

/// With all so near, px.
fn cover_near(covered: &mut Plane<bool>, at: Point, by: usize) {
    let (x, y) = (at.x.max(0.0) as usize, at.y.max(0.0) as usize);
    let (x, y) = (x.min(covered.width - 1), y.min(covered.height - 1));
    let (from, to) = (x.saturating_sub(by), (x + by + 1).min(covered.width));
    for y in y.saturating_sub(by)..(y + by + 1).min(covered.height) {
        covered.row_mut(y)[from..to].fill(true);
    }
}
