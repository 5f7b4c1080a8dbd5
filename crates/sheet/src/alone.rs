//! A sheet by itself: cut out of the picture, and what lies beside it there, or reaches over it, as bright as its paper.

use std::ops::Range;

use tracelight_image::median::middle;
use tracelight_image::{Mask, Plane};
use tracelight_stroke::{Point, Vec2};

use crate::found::Found;
use crate::over::covered;
use crate::quad::{Quad, SIDES};
use crate::small::Small;

/// So far inside a sheet's edge its shadow ends: share of the picture's shorter side, and px beyond its blur.
const RIM: f64 = 0.005;
const LEAST_RIM: f64 = 1.0;
/// Paper is about as bright as the middle of its surroundings, so many px of the small picture either way.
const TILE: usize = 8;
/// So far inside a sheet there is nothing but its paper, px of the small picture.
const EDGE: f64 = 2.0;
/// So many pixels at the edge of what is seen tell what is not seen, of the small picture.
const AT_EDGE: usize = 6;

/// What of a page's picture is not its sheet's.
#[derive(Clone, Debug)]
pub struct Beside {
    /// Which pixels these are.
    pub mask: Mask,
    /// The picture with paper in its place.
    pub papered: Plane<u8>,
}

/// The part of a picture that holds a sheet, and where its first pixel lies.
pub(crate) struct Alone {
    pub(crate) plane: Plane<u8>,
    pub(crate) origin: (usize, usize),
    pub(crate) beside: Beside,
}

/// Cuts a sheet out.
pub(crate) fn alone(plane: &Plane<u8>, small: &Small, found: &Found) -> Alone {
    let outline = &found.sheet.outline;
    let extent = |of: fn(&Point) -> f64, most: usize| {
        let (low, high) =
            outline.iter().map(of).fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), v| (a.min(v), b.max(v)));
        (low.max(0.0) as usize, (high.ceil() as usize).min(most))
    };
    let ((left, right), (top, bottom)) = (extent(|p| p.x, plane.width), extent(|p| p.y, plane.height));
    let over = Cover::of(small, found);
    let rim = (RIM * plane.width.min(plane.height) as f64).max(LEAST_RIM + found.blur_px);
    let part = plane.part(left..right, top..bottom);
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
struct Cover {
    /// Pixels of the picture in one of the small one, either way.
    by: usize,
    /// Whether each pixel of the small picture is under something.
    covered: Plane<bool>,
    paper: Plane<u8>,
}

impl Cover {
    fn of(small: &Small, found: &Found) -> Self {
        let calm = small.calm();
        let quad = &found.quad;
        let depth = quad.depths();
        let at = |i: usize| Point::new((i % calm.width) as f64 + 0.5, (i / calm.width) as f64 + 0.5);
        let depths: Vec<f64> = (0..calm.values.len()).map(|i| depth(at(i))).collect();
        let covered = covered(calm, quad, &depths);
        let is_seen = |i: usize| depths[i] > EDGE && !covered.values[i];
        let tiles = tiles(calm, is_seen);
        let mut paper = paper(calm, &tiles, is_seen);
        go_on_outside(&mut paper, &tiles, quad, &depths);
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
fn paper(calm: &Plane<u8>, tiles: &Plane<u8>, is_seen: impl Fn(usize) -> bool) -> Plane<u8> {
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

/// Beside a sheet its paper goes on as it is at the nearest place inside, so that light falls off there as well.
fn go_on_outside(paper: &mut Plane<u8>, tiles: &Plane<u8>, quad: &Quad, depths: &[f64]) {
    let inside = paper.clone();
    let sides = SIDES.map(|side| (quad.ends(side).0, quad.inward(side)));
    let width = paper.width;
    for i in (0..depths.len()).filter(|&i| depths[i] <= EDGE) {
        let at = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let onto = |at: Point, (from, inward): &(Point, Vec2)| {
            at + *inward * (EDGE + 1.0 - (at - *from).dot(*inward)).max(0.0)
        };
        // twice, for that of one side may be outside another one
        let nearest = (0..2).fold(at, |at, _| sides.iter().fold(at, onto));
        let inward = (nearest - at) / nearest.distance(at).max(1e-9);
        let tile = Point::new(nearest.x / TILE as f64, nearest.y / TILE as f64);
        let usual = tiles.at(tile);
        // the one most like paper: a filled shape may reach up to the edge
        let levels = (0..AT_EDGE).map(|k| inside.at(nearest + inward * k as f64));
        let like = levels.min_by(|a, b| (a - usual).abs().total_cmp(&(b - usual).abs()));
        paper.values[i] = like.unwrap_or(usual).round() as u8;
    }
}

/// The usual level of what is seen of each tile and its neighbours; 255 where that is hardly anything.
fn tiles(calm: &Plane<u8>, is_seen: impl Fn(usize) -> bool) -> Plane<u8> {
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
