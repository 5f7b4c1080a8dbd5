//! Traces filled shapes along their edges, holes included.

use tracelight_image::border::{Edge, area, border};
use tracelight_image::levels::percentile;
use tracelight_image::{Mask, Plane, Region};
use tracelight_stroke::{Point, Stroke, StrokeKind, Vec2};

use crate::follow;
use crate::options::Options;

/// Around a corner the pixel's own size shows, not the shape: px either side.
const REACH_PX: f64 = 2.0;

/// Outlines smaller than this enclose dust, px².
const LEAST_AREA_PX2: f64 = 12.0;

/// Follows the edges of shapes.
#[derive(Debug)]
pub(crate) struct Outliner<'a> {
    dark: &'a Plane<u8>,
    shapes: &'a Mask,
    ink: &'a Mask,
    edge_px: f64,
    /// Ink pixels whose left edge has been walked.
    walked: Mask,
}

impl<'a> Outliner<'a> {
    /// `shapes` is what is followed, `ink` all the ink there is: where a line leaves a shape there is no edge.
    pub(crate) fn new(dark: &'a Plane<u8>, shapes: &'a Mask, ink: &'a Mask, edge_px: f64) -> Self {
        Self { dark, shapes, ink, edge_px, walked: Mask::empty(ink.width(), ink.height()) }
    }

    /// The closed outlines of a region: outer edge and holes.
    pub(crate) fn strokes(&mut self, region: &Region, options: &Options) -> Vec<Stroke> {
        let full = full_level(self.dark, region);
        let mut found = Vec::new();
        for run in &region.runs {
            if !self.walked.has(self.shapes.cell(run.from as usize, run.y as usize)) {
                let border = border(self.shapes, run.from as isize, run.y as isize, &mut self.walked);
                let points = self.places(&border, full);
                if area(&points).abs() >= LEAST_AREA_PX2 {
                    found.extend(stroke(&points, self.edge_px, options));
                }
            }
        }
        found
    }

    /// Where the shape's edge is along a border, but for where lines leave it.
    fn places(&self, border: &[Edge], full: f64) -> Vec<Point> {
        let n = border.len();
        let joined = |edge: &Edge| self.ink.get(edge.paper.0, edge.paper.1);
        let mut open = vec![false; n];
        for i in (0..n).filter(|&i| joined(&border[i])) {
            (0..=2 * BESIDE_LINES).for_each(|k| open[(i + n + k - BESIDE_LINES.min(n)) % n] = true);
        }
        let all = border.iter().zip(open).filter(|(_, open)| !open);
        all.filter_map(|(edge, _)| place(edge, self.dark, full)).collect()
    }
}

/// Edges either side of a line that leaves a shape which show the line and not the shape.
const BESIDE_LINES: usize = 6;

fn stroke(points: &[Point], edge_px: f64, options: &Options) -> Option<Stroke> {
    // where a line leaves the shape there are no places, and none in the middle of it
    let unbroken = points.chunk_by(|a, b| a.distance(*b) < 2.0);
    let together = if points.len() >= MANY || edge_px >= BLURRED_PX { 2 } else { 1 };
    let fewer: Vec<Point> = unbroken.flat_map(|row| row.chunks(together)).map(mean).collect();
    let path = follow::path(&fewer, true, follow::noise_px(points), REACH_PX, |_| 1.0, options)?;
    Some(Stroke { kind: StrokeKind::Outline, ..Stroke::new(path) })
}

/// Of so many places two are made one, for their noise to even out; also where edges are so wide that nothing on them is
/// as small as two pixels.
const MANY: usize = 1000;
const BLURRED_PX: f64 = 6.0;

fn mean(points: &[Point]) -> Point {
    (points.iter().map(|p| p.to_vec2()).sum::<Vec2>() / points.len() as f64).to_point()
}

/// The darkness of a pixel all inside a region.
fn full_level(dark: &Plane<u8>, region: &Region) -> f64 {
    percentile(&region.histogram(dark), 0.5).max(1.0)
}

/// Where the shape's edge crosses the line through the two pixels' centres; `None` where it runs along that
/// line and a neighbouring edge knows better.
///
/// Each pixel's darkness is the share of it that is inked, so the sum from a full pixel to an empty one is how
/// far the ink reaches: exact for a straight edge, where interpolation between two pixels is off by up to
/// 0.08 px.
fn place(edge: &Edge, dark: &Plane<u8>, full: f64) -> Option<Point> {
    let (dx, dy) = (edge.paper.0 - edge.ink.0, edge.paper.1 - edge.ink.1);
    let at = |k: isize, side: isize| {
        let (x, y) = (edge.ink.0 + k * dx - side * dy, edge.ink.1 + k * dy + side * dx);
        (f64::from(dark.get(x, y)) / full).min(1.0)
    };
    let fall = |side: isize| at(0, side) - at(1, side);
    let slant = |k: isize| at(k, 1) - at(k, -1);
    if 2.0 * (fall(-1) + 2.0 * fall(0) + fall(1)) < 1.2 * (slant(0) + slant(1)).abs() {
        return None;
    }
    // inside: WINDOW pixels that would all be full; outside: as many that would all be empty
    let inside = covered(true, |k| at(-k, 0));
    let outside = covered(false, |k| at(k + 1, 0));
    let reach = inside + outside - WINDOW as f64;
    let centre = Point::new(edge.ink.0 as f64 + 0.5, edge.ink.1 as f64 + 0.5);
    let share = reach.clamp(-1.5, 1.5) + 0.5;
    Some(Point::new(centre.x + share * dx as f64, centre.y + share * dy as f64))
}

/// Pixels either way of an edge whose darkness counts.
const WINDOW: isize = 3;

/// Sum of the shares of the pixels from an edge on, as far as they keep rising (into ink) or falling (into paper);
/// beyond, another edge begins, and they count as the last.
fn covered(rising: bool, share: impl Fn(isize) -> f64) -> f64 {
    let (mut last, mut sum) = (share(0), 0.0);
    for k in 0..WINDOW {
        let next = share(k);
        last = if rising { last.max(next) } else { last.min(next) };
        sum += last;
    }
    sum
}

#[cfg(test)]
mod tests {
    use tracelight_image::regions;
    use tracelight_image::threshold::over;

    use super::*;

    fn traced(width: usize, height: usize, darkness: impl Fn(f64, f64) -> f64) -> Vec<Stroke> {
        let level = |i: usize| {
            let (x, y) = ((i % width) as f64, (i / width) as f64);
            // exact enough an area: 8 × 8 samples
            let sample =
                |k: usize| darkness(x + ((k % 8) as f64 + 0.5) / 8.0, y + ((k / 8) as f64 + 0.5) / 8.0);
            (255.0 * (0..64).map(sample).sum::<f64>() / 64.0).round() as u8
        };
        let dark = Plane { width, height, values: (0..width * height).map(level).collect() };
        let mask = over(&dark, 127);
        let mut outliner = Outliner::new(&dark, &mask, &mask, 1.0);
        regions(&mask).iter().flat_map(|r| outliner.strokes(r, &Options::default())).collect()
    }

    #[test]
    fn an_outline_lies_on_the_edge_and_not_half_a_pixel_beside() {
        for (cx, cy) in [(50.0, 50.0), (50.5, 49.5), (50.3, 49.8)] {
            let found = traced(100, 100, |x, y| f64::from(u8::from((x - cx).hypot(y - cy) < 30.0)));
            assert_eq!(found.len(), 1);
            let line = found[0].path.flatten(0.01);
            let off = line.iter().map(|p| ((p.x - cx).hypot(p.y - cy) - 30.0).abs()).fold(0.0, f64::max);
            assert!(off < 0.06, "off by {off} about ({cx}, {cy})");
        }
    }

    #[test]
    fn a_ring_of_ink_has_an_outer_edge_and_a_hole() {
        let found = traced(100, 100, |x, y| {
            let r = (x - 50.0).hypot(y - 50.0);
            f64::from(u8::from(r < 40.0 && r > 20.0))
        });
        let mut lengths: Vec<f64> = found.iter().map(|s| s.path.length(1e-3)).collect();
        lengths.sort_by(f64::total_cmp);
        assert_eq!(lengths.len(), 2);
        assert!((lengths[0] / 20.0 - std::f64::consts::TAU).abs() < 0.02, "{lengths:?}");
        assert!((lengths[1] / 40.0 - std::f64::consts::TAU).abs() < 0.02, "{lengths:?}");
    }

    #[test]
    fn a_square_has_four_sharp_corners_where_they_are() {
        let found = traced(100, 100, |x, y| {
            f64::from(u8::from((20.25..70.5).contains(&x) && (30.5..80.75).contains(&y)))
        });
        let corners: Vec<Point> = found[0].path.pieces().map(|p| p.from).collect();
        assert_eq!(corners.len(), 4, "{:#?}", found[0].path.elements());
        for truth in [(20.25, 30.5), (70.5, 30.5), (70.5, 80.75), (20.25, 80.75)].map(Point::from) {
            let off = corners.iter().map(|c| c.distance(truth)).fold(f64::INFINITY, f64::min);
            assert!(off < 0.15, "{truth} is off by {off}");
        }
    }

    #[test]
    fn a_shape_cut_by_the_pictures_border_is_closed_along_it() {
        let found = traced(60, 60, |x, y| f64::from(u8::from(x.hypot(y) < 40.0)));
        assert_eq!(found.len(), 1);
        assert!(found[0].path.is_closed());
    }
}
