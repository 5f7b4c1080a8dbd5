//! A sheet by itself: cut out of the picture, and what lies beside it there, or reaches over it, as bright as its paper.

use std::ops::Range;

use tracelight_stroke::Point;

use super::choice::{Quad, SIDES, is_upright};
use super::{Beside, Found, Small};
use crate::mask::Mask;
use crate::plane::Plane;
use crate::ridge::middle;

/// So far inside a sheet's edge its shadow ends: share of the picture's shorter side, and px beyond its blur.
const RIM: f64 = 0.005;
const LEAST_RIM: f64 = 1.0;
/// Paper is about as bright as the middle of its surroundings, so many px of the small picture either way.
const TILE: usize = 8;
/// What reaches over a sheet differs from its paper by this share.
const FOREIGN: f64 = 0.08;
/// So far inside a sheet there is nothing but its paper, px of the small picture.
const EDGE: f64 = 2.0;
/// So many pixels at the edge of what is seen tell what is not seen, of the small picture.
const AT_EDGE: usize = 6;
/// Levels on and beside it are taken so far from the sheet's edge, px of the small picture.
const NEAR: f64 = 4.0;
/// A stretch of a side that is hidden is at least so long, px.
const LEAST_HIDDEN: usize = 4;
/// Most of a sheet that something covers.
const MOST_COVERED: f64 = 0.15;
/// And most of what covers it in squares of its width at the sheet's edge: a finger is some three times as long as wide.
const MOST_SQUARES: f64 = 6.0;
/// So far beyond what covers it the sheet is in its shadow, px.
const LEAST_WIDER: usize = 3;
const MOST_WIDER: usize = 8;

/// The part of a picture that holds a sheet, and where its first pixel lies.
pub(super) struct Alone {
    pub(super) plane: Plane<u8>,
    pub(super) origin: (usize, usize),
    pub(super) beside: Beside,
}

/// Cuts a sheet out.
pub(super) fn alone(plane: &Plane<u8>, small: &Small, found: &Found) -> Alone {
    let outline = &found.sheet.outline;
    let extent = |of: fn(&Point) -> f64, most: usize| {
        let (low, high) =
            outline.iter().map(of).fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
        (low.max(0.0) as usize, (high.ceil() as usize).min(most))
    };
    let ((left, right), (top, bottom)) = (extent(|p| p.x, plane.width), extent(|p| p.y, plane.height));
    let over = Over::of(small, found);
    let rim = (RIM * plane.width.min(plane.height) as f64).max(LEAST_RIM + found.blur_px);
    let mut part = Plane::filled(right - left, bottom - top, 0);
    (top..bottom).for_each(|y| part.row_mut(y - top).copy_from_slice(&plane.row(y)[left..right]));
    let mut papered = part.clone();
    let mut mask = Mask::empty(part.width, part.height);
    let inside = inside(outline, (plane.width, plane.height), rim.ceil() as usize);
    for (y, inside) in inside.iter().enumerate().take(bottom).skip(top) {
        let row = papered.row_mut(y - top);
        let Range { start: from, end: to } = inside.clone();
        let (from, to) = if from < to { (from - left, to - left) } else { (right - left, right - left) };
        let mut parts = vec![0..from, to..right - left];
        parts.extend(
            over.covered_along(y, left + from..left + to)
                .into_iter()
                .map(|part| part.start - left..part.end - left),
        );
        for part in parts.into_iter().filter(|part| !part.is_empty()) {
            over.fill(&mut row[part.clone()], (left + part.start, y));
            mask.fill(y - top, part.start, part.end);
        }
    }
    Alone { plane: part, origin: (left, top), beside: Beside { mask, papered } }
}

/// Which pixels of each row of a picture are a sheet's and at least so far from what is beside it, px.
fn inside(outline: &[Point], (width, height): (usize, usize), rim: usize) -> Vec<Range<usize>> {
    let spans: Vec<Range<usize>> = (0..height).map(|y| span(outline, y as f64 + 0.5, width)).collect();
    // beyond the picture's border a sheet goes on
    let narrowed = |span: &Range<usize>| {
        let start = if span.start == 0 { 0 } else { span.start + rim };
        let end = if span.end == width { width } else { span.end.saturating_sub(rim) };
        start..end.max(start)
    };
    let row = |y: usize| {
        let (above, below) = (y.saturating_sub(rim), (y + rim).min(height - 1));
        let near = [above, y, below].map(|y| narrowed(&spans[y]));
        let start = near.iter().map(|span| span.start).max().unwrap_or(0);
        let end = near.iter().map(|span| span.end).min().unwrap_or(0);
        start..end.max(start)
    };
    (0..height).map(row).collect()
}

/// Which pixels of a row have their middles in a polygon that a row cuts in one piece.
fn span(outline: &[Point], y: f64, width: usize) -> Range<usize> {
    let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
    for (k, &a) in outline.iter().enumerate() {
        let b = outline[(k + 1) % outline.len()];
        if (a.y <= y) != (b.y <= y) {
            let x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            (from, to) = (from.min(x), to.max(x));
        }
    }
    let pixel = |x: f64| (x.round().max(0.0) as usize).min(width);
    if from < to { pixel(from)..pixel(to) } else { 0..0 }
}

/// What reaches over a sheet, and how bright its paper is.
struct Over {
    /// Pixels of the picture in one of the small one, either way.
    by: usize,
    /// Whether each pixel of the small picture is under something.
    covered: Plane<bool>,
    paper: Plane<u8>,
}

impl Over {
    fn of(small: &Small, found: &Found) -> Self {
        let calm = small.calm();
        let quad = &found.quad;
        let depth = quad.depths();
        let at = |i: usize| Point::new((i % calm.width) as f64 + 0.5, (i / calm.width) as f64 + 0.5);
        let depths: Vec<f64> = (0..calm.values.len()).map(|i| depth(at(i))).collect();
        let covered = covered(calm, quad, &depths);
        let paper = paper(calm, |i| depths[i] > EDGE && !covered.values[i]);
        Self { by: small.by, covered, paper }
    }

    /// Where along a row of the picture something covers the sheet.
    fn covered_along(&self, y: usize, within: Range<usize>) -> Vec<Range<usize>> {
        let row = self.covered.row((y / self.by).min(self.covered.height - 1));
        let covered = row.iter().enumerate().filter(|(_, covered)| **covered);
        let part = |(x, _): (usize, &bool)| {
            // what is left over at the right border belongs to the last pixel
            let end = if x + 1 == row.len() { within.end } else { (x + 1) * self.by };
            (x * self.by).max(within.start)..end.min(within.end)
        };
        covered.map(part).filter(|part| part.start < part.end).collect()
    }

    /// Gives some of a row the level that paper has there.
    fn fill(&self, row: &mut [u8], (left, y): (usize, usize)) {
        let by = 1.0 / self.by as f64;
        let at =
            |x: usize| self.paper.at(Point::new((x as f64 + 0.5) * by, (y as f64 + 0.5) * by)).round() as u8;
        row.iter_mut().enumerate().for_each(|(k, level)| *level = at(left + k));
    }
}

/// The paper of each pixel of the small picture: row by row, what is not seen of it is as bright as what is seen to its left and
/// right, so that a shadow's hard edge stays one.
fn paper(calm: &Plane<u8>, is_seen: impl Fn(usize) -> bool) -> Plane<u8> {
    let tiles = tiles(calm, &is_seen);
    let mut out = calm.clone();
    let mut filled = vec![false; calm.height];
    for (y, filled) in filled.iter_mut().enumerate() {
        let known: Vec<usize> = (0..calm.width).filter(|x| is_seen(y * calm.width + x)).collect();
        let usual = |x: usize| tiles.row(y / TILE)[x / TILE];
        // of some at the edge of what is seen the one most like paper: a filled shape may reach up to it
        let paper = |near: &[usize]| {
            let like = |x: &&usize| calm.row(y)[**x].abs_diff(usual(**x));
            near.iter().min_by_key(like).map(|&x| f64::from(calm.row(y)[x]))
        };
        let (Some(&first), Some(&last)) = (known.first(), known.last()) else { continue };
        *filled = true;
        let ends =
            (paper(&known[..known.len().min(AT_EDGE)]), paper(&known[known.len().saturating_sub(AT_EDGE)..]));
        let row = out.row_mut(y);
        row[..first].fill(ends.0.unwrap_or(255.0) as u8);
        row[last + 1..].fill(ends.1.unwrap_or(255.0) as u8);
        for (k, gap) in known.windows(2).enumerate().filter(|(_, pair)| pair[1] > pair[0] + 1) {
            let before = paper(&known[(k + 1).saturating_sub(AT_EDGE)..=k]).unwrap_or(255.0);
            let after = paper(&known[k + 1..(k + 1 + AT_EDGE).min(known.len())]).unwrap_or(255.0);
            let length = (gap[1] - gap[0]) as f64;
            for (k, level) in row[gap[0] + 1..gap[1]].iter_mut().enumerate() {
                *level = (before + (after - before) * (k + 1) as f64 / length) as u8;
            }
        }
    }
    // rows of which nothing is seen, above a corner and below one
    let (first, last) = (filled.iter().position(|f| *f), filled.iter().rposition(|f| *f));
    if let (Some(first), Some(last)) = (first, last) {
        let (above, below) = (out.row(first).to_vec(), out.row(last).to_vec());
        (0..first).for_each(|y| out.row_mut(y).copy_from_slice(&above));
        (last + 1..calm.height).for_each(|y| out.row_mut(y).copy_from_slice(&below));
    }
    out
}

/// The usual level of what is seen of each tile and its neighbours; 255 where that is hardly anything.
fn tiles(calm: &Plane<u8>, is_seen: &impl Fn(usize) -> bool) -> Plane<u8> {
    let (width, height) = (calm.width.div_ceil(TILE), calm.height.div_ceil(TILE));
    let level = |i: usize| {
        let (x, y) = (i % width, i / width);
        let rows = y.saturating_sub(1) * TILE..((y + 2) * TILE).min(calm.height);
        let columns = x.saturating_sub(1) * TILE..((x + 2) * TILE).min(calm.width);
        let places =
            rows.step_by(2).flat_map(|y| columns.clone().step_by(2).map(move |x| y * calm.width + x));
        let levels: Vec<f64> = places.filter(|&i| is_seen(i)).map(|i| f64::from(calm.values[i])).collect();
        middle(levels).map_or(255, |level| level as u8)
    };
    Plane { width, height, values: (0..width * height).map(level).collect() }
}

/// What reaches over a sheet from beside it: a finger, a weight. Where it does, a side is not seen, and there is the
/// same on both sides of it.
fn covered(calm: &Plane<u8>, quad: &Quad, depths: &[f64]) -> Plane<bool> {
    let mut covered = Plane::filled(calm.width, calm.height, false);
    for side in SIDES {
        for stretch in hidden(quad, side) {
            // a finger's nail and the shadow about it are about as wide as a part of it
            let wider = (stretch.len() / 3).clamp(LEAST_WIDER, MOST_WIDER);
            let patch = cover(calm, depths, &Stretch::of(calm, quad, side, stretch));
            patch.into_iter().for_each(|i| cover_near(&mut covered, i, wider));
        }
    }
    covered
}

/// Along a side the stretches in which it is not seen, as numbers of its places.
fn hidden(quad: &Quad, side: usize) -> Vec<Range<usize>> {
    let Some(seen) = &quad.sides[side] else { return Vec::new() };
    let (from, to) = quad.ends(side);
    let places = from.distance(to) as usize;
    let is_hidden = |k: usize| {
        let at = from.lerp(to, k as f64 / places as f64);
        !seen.is_seen_near(if is_upright(side) { at.y } else { at.x }.max(0.0) as usize)
    };
    let mut stretches: Vec<Range<usize>> = Vec::new();
    for k in (0..places).filter(|&k| is_hidden(k)) {
        match stretches.last_mut().filter(|stretch| stretch.end + 2 >= k) {
            Some(stretch) => stretch.end = k + 1,
            None => stretches.push(k..k + 1),
        }
    }
    stretches.retain(|stretch| stretch.len() >= LEAST_HIDDEN && 2 * stretch.len() < places);
    stretches
}

/// A stretch of a side on which something lies.
struct Stretch {
    /// Places in it just inside the sheet.
    inside: Vec<Point>,
    /// What lies there: its level, and that of the paper beside it.
    level: f64,
    paper: f64,
}

impl Stretch {
    fn of(calm: &Plane<u8>, quad: &Quad, side: usize, places: Range<usize>) -> Self {
        let (from, to) = quad.ends(side);
        let (inward, length) = (quad.inward(side), from.distance(to));
        let at = |k: f64| from.lerp(to, k / length) + inward * NEAR;
        let level = |at: Point| calm.at(at);
        let inside: Vec<Point> = places.clone().map(|k| at(k as f64)).collect();
        let inside_level = middle(inside.iter().map(|p| level(*p)).collect()).unwrap_or(0.0);
        // past the shadow of what lies there; one of both may be in another shadow
        let paper = |from: f64, way: f64| {
            let on = (6..16).map(|k| from + way * f64::from(k)).filter(|k| (0.0..length).contains(k));
            middle(on.map(|k| level(at(k))).collect())
        };
        let papers = [paper(places.start as f64, -1.0), paper(places.end as f64, 1.0)];
        let (a, b) = (papers[0].or(papers[1]).unwrap_or(255.0), papers[1].or(papers[0]).unwrap_or(255.0));
        let (near, far) = if (a - inside_level).abs() < (b - inside_level).abs() { (a, b) } else { (b, a) };
        let paper = if (near - inside_level).abs() > FOREIGN * near { near } else { far };
        Self { level: inside_level, paper, inside }
    }

    /// Whether a level is nearer to what lies there than to the paper.
    fn holds(&self, level: f64) -> bool {
        (level - self.level).abs() < (level - self.paper).abs()
    }
}

/// What lies on a stretch, and all that is joined to it.
fn cover(calm: &Plane<u8>, depths: &[f64], stretch: &Stretch) -> Vec<usize> {
    if (stretch.level - stretch.paper).abs() < FOREIGN * stretch.paper {
        return Vec::new();
    }
    let holds = |i: usize| depths[i] > 0.0 && stretch.holds(f64::from(calm.values[i]));
    let places = stretch
        .inside
        .iter()
        .filter(|at| calm.holds(**at))
        .map(|at| at.y as usize * calm.width + at.x as usize);
    let mut patch: Vec<usize> = Vec::new();
    let mut seen = vec![false; calm.values.len()];
    for i in places {
        if !seen[i] && holds(i) {
            seen[i] = true;
            patch.push(i);
        }
    }
    calm.flood(&mut patch, &mut seen, |_, k| holds(k));
    // what takes up much of the sheet is a shadow on it
    let sheet = depths.iter().filter(|depth| **depth > 0.0).count();
    let most = (MOST_COVERED * sheet as f64).min(MOST_SQUARES * (stretch.inside.len() as f64).powi(2));
    if (patch.len() as f64) < most { patch } else { Vec::new() }
}

/// With all so near, px.
fn cover_near(covered: &mut Plane<bool>, i: usize, by: usize) {
    let (x, y) = (i % covered.width, i / covered.width);
    let (from, to) = (x.saturating_sub(by), (x + by + 1).min(covered.width));
    for y in y.saturating_sub(by)..(y + by + 1).min(covered.height) {
        covered.row_mut(y)[from..to].fill(true);
    }
}
