//! Where the middle of a pen line is between the pixels.
//!
//! The centroid of the darkness along a cut across the line is the middle of the pen, whatever the pixels' grid does to
//! its edges (sampling by pixel areas keeps first moments; Steger, "An unbiased detector of curvilinear structures",
//! 1998, discusses the others). That needs neither the threshold nor the skeleton to be right to a pixel.

use tracelight_stroke::{Point, Vec2};

use crate::plane::Plane;

/// Distance of the samples across a line, px.
const STEP: f64 = 0.5;
/// How far beyond the expected edge the line's edge is looked for, px.
const BEYOND: f64 = 2.5;

/// The line's cross-section at one place.
#[derive(Clone, Copy, Debug)]
struct Section {
    /// From the place to the line's middle along the normal, px.
    offset: f64,
    width: f64,
}

/// Points either side with whose median width a point's is compared: a pen's width changes slowly.
const LOCAL: usize = 15;

/// More points than this left out in a row are a gap: the line cannot be seen there.
const GAP: usize = 2;

/// A row of points moved on to the middle of their line.
#[derive(Clone, Debug)]
pub(crate) struct Ridge {
    /// Stretches of points; between two of them the line cannot be seen.
    pub(crate) stretches: Vec<Vec<Point>>,
    /// The line's width in the median, px.
    pub(crate) width: f64,
}

/// Moves points on to the middle of their line; those whose cross-section is not that of one line are left out.
/// `radius` is about half the line's width. A ring's first stretch may go on after its last.
pub(crate) fn centred(dark: &Plane<u8>, points: &[Point], radius: f64, ring: bool) -> Ridge {
    let mut rows: Vec<(usize, Point)> = points.iter().copied().enumerate().collect();
    let mut width = 2.0 * radius;
    for reach in [5, 3] {
        let places: Vec<Point> = rows.iter().map(|r| r.1).collect();
        let of = |i: usize| {
            let normal = normal(&places, i, reach, ring)?;
            let section = section(dark, places[i], normal, 0.5 * width)?;
            Some((rows[i].0, places[i] + normal * section.offset, section.width))
        };
        let found: Vec<(usize, Point, f64)> = (0..rows.len()).filter_map(of).collect();
        let widths: Vec<f64> = found.iter().map(|f| f.2).collect();
        if widths.is_empty() {
            break;
        }
        width = median(&widths);
        let like = |i: usize| {
            let near = &widths[i.saturating_sub(LOCAL)..(i + LOCAL + 1).min(widths.len())];
            let usual = median(near);
            (widths[i] - usual).abs() <= (0.15 * usual).max(0.5)
        };
        rows = (0..found.len()).filter(|&i| like(i)).map(|i| (found[i].0, found[i].1)).collect();
    }
    let mut stretches: Vec<Vec<Point>> = Vec::new();
    let mut before = None;
    for (k, p) in rows {
        match (before, stretches.last_mut()) {
            (Some(b), Some(stretch)) if k - b <= GAP => stretch.push(p),
            _ => stretches.push(vec![p]),
        }
        before = Some(k);
    }
    Ridge { stretches, width }
}

/// The middle value; 0 of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// Unit normal of a row of points at one of them, from means of up to `reach` points either side.
fn normal(points: &[Point], i: usize, reach: usize, ring: bool) -> Option<Vec2> {
    let n = points.len();
    let mean = |side: isize| {
        let at = |k: usize| {
            let j = i as isize + side * k as isize;
            if ring {
                Some(points[j.rem_euclid(n as isize) as usize])
            } else {
                points.get(usize::try_from(j).ok()?).copied()
            }
        };
        let near: Vec<Vec2> = (1..=reach).map_while(at).map(Point::to_vec2).collect();
        (!near.is_empty()).then(|| near.iter().copied().sum::<Vec2>() / near.len() as f64)
    };
    let here = points[i].to_vec2();
    let along = mean(1).unwrap_or(here) - mean(-1).unwrap_or(here);
    (along.hypot() > 1e-9).then(|| Vec2::new(-along.y, along.x) / along.hypot())
}

/// The cross-section through `at`; `None` where the line has no two edges near the expected ones or lies elsewhere.
fn section(dark: &Plane<u8>, at: Point, normal: Vec2, radius: f64) -> Option<Section> {
    let half = ((radius + BEYOND) / STEP).ceil() as isize;
    let profile: Vec<f64> = (-half..=half).map(|k| dark.at(at + normal * (k as f64 * STEP))).collect();
    let inner = ((0.7 * radius).max(1.0) / STEP).round() as usize;
    let middle = half as usize;
    let core = &profile[middle - inner..=middle + inner];
    let (top, peak) = core
        .iter()
        .copied()
        .enumerate()
        .fold((0, 0.0), |best, (i, v)| if v > best.1 { (i, v) } else { best });
    let level = 0.5 * peak;
    let start = if profile[middle] >= level { middle } else { middle - inner + top };
    let right = foot(profile[start..].iter(), level)?;
    let left = foot(profile[..=start].iter().rev(), level)?;
    let inside = start - left..=start + right;
    let mass: f64 = profile[inside.clone()].iter().sum();
    let moment: f64 = inside.map(|k| (k as f64 - half as f64) * profile[k]).sum();
    let section = Section { offset: moment / mass * STEP, width: mass / peak * STEP };
    (section.offset.abs() <= radius + 1.0).then_some(section)
}

/// Samples from the first one to where the line's darkness has run out: the profile fell through `level` and falls
/// no further, 2 px on at most. `None` where it never falls through.
fn foot<'a>(profile: impl Iterator<Item = &'a f64>, level: f64) -> Option<usize> {
    let mut through = None;
    let mut before = f64::INFINITY;
    for (i, &v) in profile.enumerate() {
        if let Some(first) = through
            && (v > before || i > first + (2.0 / STEP) as usize)
        {
            return Some(i - 1);
        }
        if through.is_none() && v < level {
            through = Some(i);
        }
        before = v;
    }
    through
}

/// How far from the first sample the profile falls through `level`, px.
fn edge<'a>(profile: impl Iterator<Item = &'a f64>, level: f64) -> Option<f64> {
    let mut before: Option<f64> = None;
    for (i, &v) in profile.enumerate() {
        match before {
            Some(b) if v < level => return Some((i as f64 - 1.0 + (b - level) / (b - v)) * STEP),
            _ => before = Some(v),
        }
    }
    None
}

/// How far a line runs on along `way` (a place for each distance ahead, px) before its pen is lifted: half its width
/// less than the ink does, for a pen's end is round. `None` when there is no end within `reach`; beyond the picture
/// is paper.
pub(crate) fn pen_end(dark: &Plane<u8>, way: impl Fn(f64) -> Point, width: f64, reach: f64) -> Option<f64> {
    let steps = (reach / STEP).ceil() as usize;
    let level = |p: Point| if dark.clamp(p) == p { dark.at(p) } else { 0.0 };
    let profile: Vec<f64> = (0..=steps).map(|k| level(way(k as f64 * STEP))).collect();
    Some(edge(profile.iter(), 0.5 * profile[0])? - 0.5 * width)
}
