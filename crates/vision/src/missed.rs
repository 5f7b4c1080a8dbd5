//! How much of the pen's ink no stroke follows.

use tracelight_stroke::{Point, Stroke};

use crate::mask::Mask;
use crate::region::Region;
use crate::ridge::median;

/// How far ink may lie from its stroke, pen widths: half of one is its edge, the rest the blots of junctions.
const NEAR_PENS: f64 = 1.2;
/// The same for hair lines, px.
const LEAST_PX: f64 = 3.0;

/// How closely strokes are followed, px.
const FLAT_PX: f64 = 1.0;

/// For each region its pixels, and how many of them lie further from every stroke than the pen reaches.
pub(crate) fn counts(ink: &Mask, regions: &[&Region], strokes: &[Stroke]) -> Vec<(usize, usize)> {
    let usual = median(&strokes.iter().filter_map(|s| s.pen).collect::<Vec<_>>());
    let mut painted = Mask::empty(ink.width, ink.height);
    for stroke in strokes {
        let near = (NEAR_PENS * stroke.pen.unwrap_or(0.0).max(usual)).max(LEAST_PX);
        stroke.path.flatten(FLAT_PX).windows(2).for_each(|w| paint(&mut painted, w[0], w[1], near));
    }
    let count = |region: &&Region| (region.area(), region.area() - region.cells(&painted).count());
    regions.iter().map(count).collect()
}

/// Paints all pixels whose centres are within `radius` of the line from `a` to `b`, row by row.
fn paint(mask: &mut Mask, a: Point, b: Point, radius: f64) {
    let rows = |y: f64, last: usize| (y.max(0.0) as usize).min(last);
    let last = mask.height - 1;
    let (top, low) = (a.y.min(b.y) - radius, a.y.max(b.y) + radius);
    for y in rows(top, last)..=rows(low, last) {
        if let Some((from, to)) = chord(a, b, radius, y as f64 + 0.5) {
            let column = |x: f64| (x + 0.5).clamp(0.0, mask.width as f64) as usize;
            let (from, to) = (column(from), column(to));
            if to > from {
                mask.fill(y, from, to);
            }
        }
    }
}

/// What a level line at height `y` has in common with the stadium of `radius` about the line from `a` to `b`.
fn chord(a: Point, b: Point, radius: f64, y: f64) -> Option<(f64, f64)> {
    let disc = |c: Point| {
        let square = radius * radius - (y - c.y) * (y - c.y);
        (square >= 0.0).then(|| (c.x - square.sqrt(), c.x + square.sqrt()))
    };
    // between the discs: where the two sides, shifted by the radius, are crossed
    let along = b - a;
    let length = along.hypot();
    let side = |sign: f64| {
        let shift = tracelight_stroke::Vec2::new(-along.y, along.x) * (sign * radius / length.max(1e-9));
        let (p, q) = (a + shift, b + shift);
        let share = (y - p.y) / (q.y - p.y);
        (0.0..=1.0).contains(&share).then_some(p.x + (q.x - p.x) * share)
    };
    let sides = [side(1.0), side(-1.0)].into_iter().flatten().map(|x| (x, x));
    let parts = [disc(a), disc(b)].into_iter().flatten().chain(sides);
    parts.reduce(|x, y| (x.0.min(y.0), x.1.max(y.1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Path;

    use crate::region::regions;

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
        let [(all, missed)] = counts(&ink, &[&found[0]], &[stroke])[..] else { panic!("one region") };
        assert!((missed as f64 / all as f64 - 0.5).abs() < 0.03, "{missed} of {all}");
    }
}
