//! What a painted shape covers.

use tracelight_stroke::{Point, Rect};

/// The inside of closed polygons.
#[derive(Clone, Debug, Default)]
pub(crate) struct Region {
    segments: Vec<[Point; 2]>,
    even_odd: bool,
    bounds: Rect,
    /// Strips are upright: fewer segments pass each of them than of those that lie.
    upright: bool,
    /// Segments by strips: those of strip i are `listed[begins[i]..begins[i + 1]]`.
    begins: Vec<u32>,
    listed: Vec<u32>,
    strip: f64,
}

/// Entries in strips at most, for each segment.
const LISTED: f64 = 6.0;

impl Region {
    /// The inside of polygons, each closed from its last point to its first, by the even-odd or the non-zero rule.
    pub(crate) fn new(polygons: &[Vec<Point>], even_odd: bool) -> Self {
        let mut segments = Vec::with_capacity(polygons.iter().map(Vec::len).sum());
        for polygon in polygons {
            let next = polygon.iter().skip(1).chain(polygon.first());
            segments.extend(polygon.iter().zip(next).filter(|(a, b)| a != b).map(|(&a, &b)| [a, b]));
        }
        let boxes = segments.iter().map(|&[a, b]| Rect::from_points(a, b));
        let bounds = boxes.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
        let mut region = Self { segments, even_odd, bounds, ..Self::default() };
        region.list();
        region
    }

    fn list(&mut self) {
        let count = self.segments.len() as f64;
        let passes = |along: fn(Point) -> f64, extent: f64| {
            let climbed: f64 = self.segments.iter().map(|&[a, b]| (along(a) - along(b)).abs()).sum();
            climbed / extent.max(f64::MIN_POSITIVE)
        };
        let [lying, upright] = [passes(|p| p.y, self.bounds.height()), passes(|p| p.x, self.bounds.width())];
        self.upright = upright < lying;
        let (extent, passes) =
            if self.upright { (self.bounds.width(), upright) } else { (self.bounds.height(), lying) };
        // a segment is listed in each strip that it passes
        let strips = (0.5 * count).min(LISTED * count / passes.max(1.0)).clamp(1.0, 65_536.0) as usize;
        self.strip = (extent / strips as f64).max(f64::MIN_POSITIVE);
        let mut begins = vec![0_u32; strips + 1];
        let passed = |region: &Self, [a, b]: [Point; 2]| {
            let [a, b] = [a, b].map(|p| region.strip_of(p, strips));
            a.min(b)..=a.max(b)
        };
        for &segment in &self.segments {
            passed(self, segment).for_each(|i| begins[i + 1] += 1);
        }
        for i in 0..strips {
            begins[i + 1] += begins[i];
        }
        let mut listed = vec![0; begins[strips] as usize];
        let mut at = begins.clone();
        for (number, &segment) in self.segments.iter().enumerate() {
            for i in passed(self, segment) {
                listed[at[i] as usize] = number as u32;
                at[i] += 1;
            }
        }
        (self.begins, self.listed) = (begins, listed);
    }

    fn strip_of(&self, p: Point, strips: usize) -> usize {
        let from = if self.upright { p.x - self.bounds.x0 } else { p.y - self.bounds.y0 };
        ((from / self.strip).max(0.0) as usize).min(strips - 1)
    }

    /// The segments of its edge.
    pub(crate) fn segments(&self) -> &[[Point; 2]] {
        &self.segments
    }

    /// The smallest upright rectangle round it.
    pub(crate) fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Whether a point lies inside, and how many segments had to be looked at.
    pub(crate) fn contains(&self, p: Point) -> (bool, usize) {
        let outside =
            p.x < self.bounds.x0 || p.x > self.bounds.x1 || p.y < self.bounds.y0 || p.y > self.bounds.y1;
        if outside || self.segments.is_empty() {
            return (false, 1);
        }
        let strip = self.strip_of(p, self.begins.len() - 1);
        let listed = &self.listed[self.begins[strip] as usize..self.begins[strip + 1] as usize];
        // a ray across the strips' direction; turned, the rule is the same
        let turned = |p: Point| if self.upright { Point::new(p.y, p.x) } else { p };
        let p = turned(p);
        let mut winding = 0_i32;
        for &number in listed {
            let [a, b] = self.segments[number as usize].map(turned);
            if (a.y <= p.y) != (b.y <= p.y) {
                let x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
                winding += if x >= p.x {
                    0
                } else if b.y > a.y {
                    1
                } else {
                    -1
                };
            }
        }
        (if self.even_odd { winding % 2 != 0 } else { winding != 0 }, 1 + listed.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rules_say_what_is_inside() {
        let square = |low: f64, high: f64| {
            [(low, low), (high, low), (high, high), (low, high)].map(Point::from).to_vec()
        };
        let both = [square(0.0, 9.0), square(3.0, 6.0)];
        let inside =
            |even_odd: bool, x: f64, y: f64| Region::new(&both, even_odd).contains(Point::new(x, y)).0;
        assert!(inside(true, 1.0, 1.0) && inside(false, 1.0, 1.0));
        assert!(!inside(true, 4.0, 4.0) && inside(false, 4.0, 4.0));
        assert!(!inside(true, 9.5, 4.0) && !inside(false, -0.5, 4.0));
        assert!(!Region::default().contains(Point::ORIGIN).0);
    }

    #[test]
    fn a_point_is_inside_whichever_way_the_strips_lie() {
        for is_wide in [true, false] {
            // a comb of a thousand teeth, each half a unit wide and one high
            let at = |x: f64, y: f64| if is_wide { Point::new(x, y) } else { Point::new(y, x) };
            let tooth = |i: i32| {
                [(0.0, 0.0), (0.0, 1.0), (0.5, 1.0), (0.5, 0.0)].map(|(x, y)| at(f64::from(i) + x, y))
            };
            let mut comb: Vec<Point> = (0..1000).flat_map(tooth).collect();
            comb.extend([at(1000.0, 0.0), at(1000.0, -1.0), at(0.0, -1.0)]);
            let region = Region::new(&[comb], false);
            for i in [0, 1, 499, 999] {
                let inside = |x: f64, y: f64| region.contains(at(f64::from(i) + x, y));
                assert!(inside(0.25, 0.5).0 && !inside(0.75, 0.5).0 && inside(0.75, -0.5).0);
                assert!(inside(0.25, 0.5).1 < 50, "{} segments looked at", inside(0.25, 0.5).1);
            }
        }
    }
}
