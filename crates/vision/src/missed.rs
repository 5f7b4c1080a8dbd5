//! Measures the pen's ink that no stroke follows.

use tracelight_image::median::median;
use tracelight_image::{Mask, Region};
use tracelight_stroke::{Point, Stroke, Vec2};

/// How far ink may lie from its stroke, pen widths: half of one is its edge, the rest the blots of junctions.
const NEAR_PENS: f64 = 1.2;
/// Lower limit of that distance, for hair lines, px.
const LEAST_PX: f64 = 3.0;

/// How closely strokes are followed, px, and as a share of how far their ink reaches.
const FLAT_PX: f64 = 1.0;
const FLAT_SHARE: f64 = 0.1;

/// For each region its pixels, and how many of them lie further from every stroke than the pen reaches.
pub(crate) fn counts<'a>(
    ink: &Mask,
    regions: &[&Region],
    strokes: impl Iterator<Item = &'a Stroke> + Clone,
) -> Vec<(usize, usize)> {
    let usual = median(&strokes.clone().filter_map(|s| s.pen).collect::<Vec<_>>());
    let mut painted = Mask::empty(ink.width(), ink.height());
    for stroke in strokes {
        let near = reach(stroke.pen.unwrap_or(0.0), usual);
        let flat = FLAT_PX.max(FLAT_SHARE * near);
        stroke.path.flatten(flat).windows(2).for_each(|w| paint(&mut painted, w[0], w[1], near));
    }
    let count = |region: &&Region| (region.area(), region.area() - region.cells(&painted).count());
    regions.iter().map(count).collect()
}

/// How far ink may lie from a line of its pen's width, px, where a pen is `usual`.
pub(crate) fn reach(width: f64, usual: f64) -> f64 {
    (NEAR_PENS * width.max(usual)).max(LEAST_PX)
}

/// A patch whose lines leave out more than this share of it is none of lines.
const LOST: f64 = 0.6;

/// Whether a patch of so many pixels, of which so many are followed by no line, is none of lines.
pub(crate) fn is_none_of_lines(missed: usize, area: usize) -> bool {
    missed as f64 > LOST * area as f64
}

/// Paints all pixels whose centres are within `radius` of the line from `a` to `b`, row by row.
pub(crate) fn paint(mask: &mut Mask, a: Point, b: Point, radius: f64) {
    let rows = |y: f64, last: usize| (y.max(0.0) as usize).min(last);
    let last = mask.height() - 1;
    let (top, low) = (a.y.min(b.y) - radius, a.y.max(b.y) + radius);
    let stadium = Stadium::about(a, b, radius);
    for y in rows(top, last)..=rows(low, last) {
        let (from, to) = stadium.chord(y as f64 + 0.5);
        let column = |x: f64| (x + 0.5).clamp(0.0, mask.width() as f64) as usize;
        let (from, to) = (column(from), column(to));
        if to > from {
            mask.fill(y, from, to);
        }
    }
}

/// All that is within a radius of a line.
struct Stadium {
    ends: [Point; 2],
    radius_sq: f64,
    /// One end of either side, and the other from there.
    sides: [(Point, Vec2); 2],
}

impl Stadium {
    fn about(a: Point, b: Point, radius: f64) -> Self {
        let along = b - a;
        let across = along.turn_90() * (radius / along.hypot().max(1e-9));
        Self { ends: [a, b], radius_sq: radius * radius, sides: [(a + across, along), (a - across, along)] }
    }

    /// What a level line at height `y` has in common with it, from and to; the other way round where it has nothing.
    fn chord(&self, y: f64) -> (f64, f64) {
        let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
        for end in self.ends {
            let square = self.radius_sq - (y - end.y) * (y - end.y);
            if square >= 0.0 {
                let half = square.sqrt();
                (from, to) = (from.min(end.x - half), to.max(end.x + half));
            }
        }
        // between the discs: where the two sides are crossed
        for (at, along) in self.sides {
            let share = (y - at.y) / along.y;
            if (0.0..=1.0).contains(&share) {
                let x = at.x + along.x * share;
                (from, to) = (from.min(x), to.max(x));
            }
        }
        (from, to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_image::regions;
    use tracelight_stroke::Path;

    #[test]
    fn a_painted_line_is_all_that_is_near_it() {
        for (a, b) in
            [((20.0, 20.0), (70.0, 43.0)), ((50.0, 10.0), (50.0, 60.0)), ((30.0, 30.0), (30.0, 30.0))]
        {
            let (a, b) = (Point::from(a), Point::from(b));
            let mut mask = Mask::empty(100, 80);
            paint(&mut mask, a, b, 7.3);
            for (x, y) in (0..80).flat_map(|y| (0..100).map(move |x| (x, y))) {
                let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                let share = ((p - a).dot(b - a) / (b - a).hypot2().max(1e-9)).clamp(0.0, 1.0);
                let distance = p.distance(a.lerp(b, share));
                let found = mask.get(x, y);
                assert!((distance - 7.3).abs() < 0.51 || found == (distance < 7.3), "({x}, {y}): {distance}");
            }
        }
    }

    #[test]
    fn half_of_a_line_left_out_is_half_missed() {
        let mut ink = Mask::empty(300, 40);
        (18..22).for_each(|y| ink.fill(y, 20, 280));
        let found = regions(&ink);
        let path = Path::polyline(&[Point::new(20.0, 20.0), Point::new(150.0, 20.0)], false).unwrap();
        let mut stroke = Stroke::new(path);
        stroke.pen = Some(4.0);
        let [(all, missed)] = counts(&ink, &[&found[0]], [stroke].iter())[..] else { panic!("one region") };
        assert!((missed as f64 / all as f64 - 0.5).abs() < 0.03, "{missed} of {all}");
    }
}
