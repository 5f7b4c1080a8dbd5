//! A sheet's sides where the full picture has their steps.

use tracelight_image::Plane;
use tracelight_image::border::area;
use tracelight_image::median::middle;
use tracelight_stroke::{Point, Vec2};

use crate::quad::{Quad, SIDES, inward};
use crate::rim::{self, Strip};
use crate::sheet::Sheet;
use crate::small::Small;
use crate::straight::straight;

/// Places along a side at which its step is looked for.
const PLACES: usize = 96;
/// A step counts from this share of the usual one on.
const LEAST_SHARE: f64 = 0.4;
/// Fewer places than this leave a side where the small picture has it.
const LEAST_PLACES: usize = 12;
/// So many neighbouring places tell where a bent side goes.
const WINDOW: usize = 9;
/// A side is straight whose steps are off a straight line by less, px of the full picture and of the small one.
const STRAIGHT_PX: f64 = 1.5;
const STRAIGHT_SMALL: f64 = 0.3;
/// From place to place a bent side goes on by less than this share of how far it is bent.
const MOST_JUMP: f64 = 0.4;
/// A smaller sheet holds no drawing, px².
const LEAST_PX2: f64 = 64.0 * 64.0;
/// A step is over where levels are the paper's within this share of it, at most of the places.
const OVER: f64 = 0.06;
const MOST_OVER: f64 = 0.75;

/// Along a sheet's sides this share of what levels differ by further out and in they do within a pixel of the small picture either way;
/// along some, on other sheets or in a book, it may be less.
const LEAST_AT_ONCE: f64 = 0.6;

/// A side in the full picture.
struct Line {
    from: Point,
    to: Point,
    /// How far inside the line its step is, share of the way and px; none of a straight one.
    bent: Vec<(f64, f64)>,
    /// How far inside the step it is over, px.
    blur: f64,
    /// Which share of it is over within a pixel of the small picture either way.
    at_once: f64,
}

impl Line {
    /// Where the small picture has it.
    fn in_small(by: f64, quad: &Quad, side: usize) -> Self {
        let (from, to) = quad.ends(side);
        let scaled = |p: Point| Point::new(p.x * by, p.y * by);
        Self { from: scaled(from), to: scaled(to), bent: Vec::new(), blur: 0.0, at_once: 1.0 }
    }

    fn inward(&self) -> Vec2 {
        inward(self.from, self.to)
    }

    fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    /// Further in, by so much at its beginning and at its end, px.
    fn move_in(&mut self, first: f64, last: f64) {
        let inward = self.inward();
        (self.from, self.to) = (self.from + inward * first, self.to + inward * last);
    }

    /// The levels some way outside.
    fn outside(&self, plane: &Plane<u8>, by: f64) -> impl Iterator<Item = f64> {
        let out = self.inward() * -(4.0 * by + 2.0);
        let places = (0..PLACES).map(move |k| (k as f64 + 0.5) / PLACES as f64);
        places
            .map(move |share| self.from.lerp(self.to, share) + out)
            .filter(|at| plane.holds(*at))
            .map(|at| plane.at(at))
    }
}

/// Where a sheet ends.
pub(crate) struct Edge {
    pub(crate) sheet: Sheet,
    /// The quadrilateral on whose lines its sides lie, px.
    pub(crate) square: Option<[Point; 4]>,
    /// How far inside its edge that is over, px.
    pub(crate) blur_px: f64,
}

/// The sheet, from where the small picture has it; `None` of what does not end at once.
pub(crate) fn sheet(plane: &Plane<u8>, small: &Small, quad: &Quad) -> Option<Edge> {
    let by = small.by as f64;
    let is_seen = |side: usize| quad.sides[side].is_some();
    let mut lines = SIDES.map(|side| match is_seen(side) {
        true => seen(plane, by, quad, side),
        false => border(plane, by, quad, side),
    });
    // paper ends at once, where light ends slowly
    let seen_sides = || SIDES.into_iter().filter(|&side| is_seen(side)).map(|side| &lines[side]);
    let length: f64 = seen_sides().map(Line::length).sum();
    let at_once: f64 = seen_sides().map(|line| line.at_once * line.length()).sum();
    if at_once < LEAST_AT_ONCE * length {
        return None;
    }
    let outside = seen_sides().flat_map(|line| line.outside(plane, by));
    let usual = middle(outside.collect());
    let strips = SIDES.map(|side| {
        let line = &lines[side];
        if is_seen(side) { None } else { Strip::along(plane, line.from, line.to, usual) }
    });
    for (line, strip) in lines.iter_mut().zip(rim::beside(strips)) {
        if let Some(Strip { first, last, .. }) = strip {
            line.move_in(first, last);
        }
    }
    let mut corners = [Point::ORIGIN; 4];
    for side in SIDES {
        let (line, next) = (&lines[side], &lines[(side + 1) % 4]);
        corners[side] = cross((line.from, line.to), (next.from, next.to))?;
    }
    // where sides are bent, their ends are not where the straight ones meet
    let shift = |line: &Line, end: Option<&(f64, f64)>| line.inward() * end.map_or(0.0, |end| end.1);
    for side in SIDES {
        let (before, after) = (&lines[side], &lines[(side + 1) % 4]);
        corners[side] += shift(before, before.bent.last()) + shift(after, after.bent.first());
    }
    let mut outline = Vec::new();
    for side in SIDES {
        // the side that begins at this corner
        let (line, from, to) = (&lines[(side + 1) % 4], corners[side], corners[(side + 1) % 4]);
        outline.push(from);
        let ends = |k: Option<&(f64, f64)>| k.map_or(0.0, |end| end.1);
        let (first, last) = (ends(line.bent.first()), ends(line.bent.last()));
        let inner = line.bent.iter().filter(|(share, _)| (0.02..0.98).contains(share));
        outline.extend(inner.map(|&(share, off)| {
            from.lerp(to, share) + line.inward() * (off - first - (last - first) * share)
        }));
    }
    let (width, height) = (plane.width as f64, plane.height as f64);
    let is_inside = |c: &Point| (-2.0..width + 2.0).contains(&c.x) && (-2.0..height + 2.0).contains(&c.y);
    let is_whole = quad.sides.iter().all(Option::is_some) && corners.iter().all(is_inside);
    let outline = within(outline, width, height);
    let beside = 1.0 - area(&outline) / (width * height);
    let blur_px = lines.iter().map(|line| line.blur).fold(0.0, f64::max);
    let square = square(&lines, is_seen, &outline);
    let corners = is_whole.then_some(corners);
    (beside > 0.0 && outline.len() > 2).then_some(Edge {
        sheet: Sheet { outline, corners, beside },
        square,
        blur_px,
    })
}

/// The quadrilateral on whose lines the sides of a sheet lie. A side that is not seen is parallel to the one across from it, or square to
/// those beside it, and as far out as the sheet is seen; `None` where no side is.
fn square(lines: &[Line; 4], is_seen: impl Fn(usize) -> bool, outline: &[Point]) -> Option<[Point; 4]> {
    let way = |side: usize| {
        let line = &lines[side % 4];
        is_seen(side % 4).then(|| (line.to - line.from).normalize())
    };
    let line = |side: usize| {
        let line = &lines[side];
        if is_seen(side) {
            return Some((line.from, line.to));
        }
        let beside = || {
            let (next, before) = (way(side + 1), way(side + 3));
            let sum =
                next.map_or(Vec2::ZERO, |way| -way.turn_90()) + before.map_or(Vec2::ZERO, Vec2::turn_90);
            (sum.hypot() > 0.0).then(|| sum.normalize())
        };
        let way = way(side + 2).map(|way| -way).or_else(beside)?;
        let out = -way.turn_90();
        let far = |p: &&Point| out.dot(p.to_vec2());
        let furthest = outline.iter().max_by(|a, b| far(a).total_cmp(&far(b)))?;
        Some((*furthest, *furthest + way))
    };
    let [left, top, right, bottom] = [line(0)?, line(1)?, line(2)?, line(3)?];
    Some([cross(left, top)?, cross(top, right)?, cross(right, bottom)?, cross(bottom, left)?])
}

/// The sheet between corners that someone gives; `None` where hardly any of it is in the picture.
pub(crate) fn between(plane: &Plane<u8>, corners: [Point; 4]) -> Option<Sheet> {
    let (width, height) = (plane.width as f64, plane.height as f64);
    let outline = within(corners.to_vec(), width, height);
    let area = if outline.len() > 2 { area(&outline) } else { 0.0 };
    (area > LEAST_PX2).then(|| Sheet {
        outline,
        corners: Some(corners),
        beside: 1.0 - area / (width * height),
    })
}

/// Where two lines meet, each through two places.
fn cross(a: (Point, Point), b: (Point, Point)) -> Option<Point> {
    let (along, other) = (a.1 - a.0, b.1 - b.0);
    let across = along.cross(other);
    let at = a.0 + along * ((b.0 - a.0).cross(other) / across);
    at.is_finite().then_some(at)
}

/// Where the picture ends.
fn border(plane: &Plane<u8>, by: f64, quad: &Quad, side: usize) -> Line {
    let mut line = Line::in_small(by, quad, side);
    // what was averaged may leave some px of the picture over at its right and lower border
    let (width, height) = (plane.width as f64, plane.height as f64);
    let on_border = |p: Point| match side {
        2 => Point::new(width, p.y),
        3 => Point::new(p.x, height),
        _ => p,
    };
    (line.from, line.to) = (on_border(line.from), on_border(line.to));
    line
}

/// A side that is seen.
fn seen(plane: &Plane<u8>, by: f64, quad: &Quad, side: usize) -> Line {
    let mut line = Line::in_small(by, quad, side);
    let Steps { at: steps, blur, at_once } = steps(plane, by, &line, quad.is_brighter);
    (line.blur, line.at_once) = (blur, at_once);
    if steps.len() < LEAST_PLACES {
        return line;
    }
    let (first, last) = straight(&steps);
    line.move_in(first, last);
    let off: Vec<(f64, f64)> = steps.iter().map(|&(s, off)| (s, off - first - (last - first) * s)).collect();
    let running: Vec<(f64, f64)> = off
        .windows(WINDOW)
        .filter_map(|near| Some((near[WINDOW / 2].0, middle(near.iter().map(|n| n.1).collect())?)))
        .collect();
    // where steps of something else begin they jump; a bent sheet's do not
    let jump = running.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).fold(0.0, f64::max);
    // the median of nine leaves half of what steps stray by
    let furthest = running.iter().map(|r| r.1.abs()).fold(0.0, f64::max);
    let strays = off.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).collect();
    let is_bent = furthest > STRAIGHT_PX.max(STRAIGHT_SMALL * by).max(2.0 * middle(strays).unwrap_or(0.0));
    if is_bent && jump < MOST_JUMP * furthest {
        line.bent = running;
    }
    line
}

/// The steps along a side.
struct Steps {
    /// Where along the line, as a share, and how far inside of it, px.
    at: Vec<(f64, f64)>,
    /// As a [`Line`] has them.
    blur: f64,
    at_once: f64,
}

/// The steps near a line.
fn steps(plane: &Plane<u8>, by: f64, line: &Line, is_brighter: bool) -> Steps {
    let reach = (2.5 * by + 3.0).ceil();
    let beside = by.max(2.0) as usize;
    let (inward, along) = (line.inward(), (line.to - line.from) / line.length());
    let count = 2 * reach as usize + 1;
    let mut levels = vec![0.0; count];
    let mut sums = vec![0.0; count];
    let (mut found, mut over, mut at_once) = (Vec::new(), Vec::new(), Vec::new());
    for k in 0..PLACES {
        let share = (k as f64 + 0.5) / PLACES as f64;
        let at = line.from.lerp(line.to, share);
        if !plane.holds(at) {
            continue;
        }
        sums.fill(0.0);
        for aside in [-1.0, 0.0, 1.0] {
            let from = at + along * (aside * (0.5 * by).max(1.0)) - inward * reach;
            plane.along(from, inward, &mut levels);
            sums.iter_mut().zip(&levels).for_each(|(sum, level)| *sum += level / 3.0);
        }
        if let Some((off, step)) = step(&sums, beside, is_brighter) {
            found.push((share, off - reach, step));
            over.push(blur(&sums, off, step));
            at_once.push(share_at_once(&sums, off, beside));
        }
    }
    let usual = middle(found.iter().map(|f| f.2).collect()).unwrap_or(0.0);
    let counted = found.iter().filter(|f| f.2 > LEAST_SHARE * usual);
    let at = counted.map(|&(share, off, _)| (share, off)).collect();
    over.sort_by(f64::total_cmp);
    // at some places a line of the drawing begins there
    let blur = over.get((MOST_OVER * over.len() as f64) as usize).copied().unwrap_or(0.0);
    Steps { at, blur, at_once: middle(at_once).unwrap_or(1.0) }
}

/// Which share of what levels differ by at both ends they do so far on either side of a place.
fn share_at_once(levels: &[f32], at: f64, beside: usize) -> f64 {
    let last = levels.len() - 1;
    let level = |at: f64| f64::from(levels[(at.round().max(0.0) as usize).min(last)]);
    let ends = |from: usize| levels[from..from + beside].iter().sum::<f32>() / beside as f32;
    let all = f64::from(ends(levels.len() - beside) - ends(0));
    let near = level(at + beside as f64) - level(at - beside as f64);
    if all == 0.0 { 1.0 } else { (near / all).clamp(0.0, 1.0) }
}

/// How far inside a step levels are as far in, px.
fn blur(levels: &[f32], at: f64, step: f64) -> f64 {
    let innermost = &levels[levels.len() * 3 / 4..];
    let paper = f64::from(innermost.iter().sum::<f32>()) / innermost.len() as f64;
    let first = at.ceil() as usize;
    let is_paper = |level: &f32| (f64::from(*level) - paper).abs() < OVER * step;
    let over = levels[first.min(levels.len())..].iter().position(is_paper);
    over.map_or(levels.len() as f64 - at, |over| (first + over) as f64 - at)
}

/// Where levels rise (or fall) most, and by how much.
fn step(levels: &[f32], beside: usize, rises: bool) -> Option<(f64, f64)> {
    let sign = if rises { 1.0 } else { -1.0 };
    let mean = |range: std::ops::Range<usize>| {
        let n = range.len() as f32;
        levels[range].iter().sum::<f32>() / n
    };
    let last = levels.len() - beside;
    let rise = |k: usize| f64::from(sign * (mean(k..k + beside) - mean(k - beside..k)));
    let best = (beside..=last).max_by(|&a, &b| rise(a).total_cmp(&rise(b)))?;
    let size = rise(best);
    let (mut sum, mut weight) = (0.0, 0.0);
    for k in best - beside..(best + beside - 1).min(levels.len() - 1) {
        let here = f64::from((sign * (levels[k + 1] - levels[k])).max(0.0));
        (sum, weight) = (sum + here * (k as f64 + 0.5), weight + here);
    }
    (size > 0.0 && weight > 0.0).then(|| (sum / weight, size))
}

/// What of a polygon lies in the picture (Sutherland & Hodgman, "Reentrant polygon clipping", 1974).
fn within(polygon: Vec<Point>, width: f64, height: f64) -> Vec<Point> {
    let sides: [&dyn Fn(Point) -> f64; 4] = [&|p| p.x, &|p| p.y, &|p| width - p.x, &|p| height - p.y];
    sides.iter().fold(polygon, |polygon, depth| {
        let mut kept = Vec::with_capacity(polygon.len() + 2);
        for (k, &here) in polygon.iter().enumerate() {
            let before = polygon[(k + polygon.len() - 1) % polygon.len()];
            let (a, b) = (depth(before), depth(here));
            if (a < 0.0) != (b < 0.0) {
                kept.push(before.lerp(here, a / (a - b)));
            }
            if b >= 0.0 {
                kept.push(here);
            }
        }
        kept
    })
}
