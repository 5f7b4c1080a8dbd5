//! Lines that are drawn as the middle of a pen's band, and stand for it.

use tracelight_stroke::{Path, Point, Rect, Vec2};

use super::flat::chords;
use super::grid::{Grid, Listing};

/// Bands wider than so many times a line are areas that it lies on.
pub(crate) const WIDE: f64 = 4.0;

/// Drawn middles of bands, to be found by where they are.
pub(crate) struct Middles {
    listing: Listing,
    segments: Vec<Segment>,
}

struct Segment {
    ends: [Point; 2],
    /// Width of its band.
    pen: f64,
    /// Number of the path that it is of.
    source: u32,
}

/// A drawn middle, with the width of its band and the path that it is of.
pub(crate) struct Middle {
    pub(crate) path: Path,
    pub(crate) pen: f64,
    pub(crate) source: u32,
}

/// Segments in all cells at most, for the memory that they take.
const MAX_PAIRS: usize = 4_000_000;

/// The corner of a square end lies so many widths of the band from the end of its middle, and a little.
const REACH: f64 = 0.72;

impl Middles {
    /// Middles within a rectangle, as chords of that tolerance; `None` where they take more memory than they may.
    pub(crate) fn new(middles: &[Middle], within: Rect, tolerance: f64) -> Option<Self> {
        let mut segments = Vec::new();
        for middle in middles {
            let corners = chords(&middle.path, tolerance);
            let ends = corners.windows(2).map(|pair| [pair[0].point, pair[1].point]);
            segments.extend(ends.map(|ends| Segment { ends, pen: middle.pen, source: middle.source }));
        }
        let grid = Grid::new(within, segments.len().max(1));
        let mut pairs = Vec::new();
        for (number, segment) in segments.iter().enumerate() {
            grid.list(segment.ends, 0.0, number as u32, &mut pairs);
            if pairs.len() > MAX_PAIRS {
                return None;
            }
        }
        Some(Self { listing: Listing::new(grid, &pairs), segments })
    }

    /// Whether one of them stands for the side of a band at a point: one of the same path, or a line on it that is not so
    /// much thinner that the band is an area for it. Returns how many were looked at, too.
    pub(crate) fn stand_for(&self, p: Point, pen: f64, source: u32) -> (bool, usize) {
        self.any(p, REACH * pen, |segment| segment.source == source || WIDE * segment.pen >= pen)
    }

    /// Whether the line of another path, not so much thinner that the band is an area for it, crosses the way of a band's side near a point of it.
    pub(crate) fn cross(&self, p: Point, way: Vec2, (pen, source): (f64, u32)) -> bool {
        const LEAST_SINE: f64 = 0.1;
        let is_slanted =
            |[a, b]: [Point; 2]| way.cross(b - a).abs() > LEAST_SINE * way.hypot() * (b - a).hypot();
        let is_other = |s: &Segment| s.source != source && WIDE * s.pen >= pen;
        self.any(p, pen, |segment| is_other(segment) && is_slanted(segment.ends)).0
    }

    fn any(&self, p: Point, reach: f64, counts: impl Fn(&Segment) -> bool) -> (bool, usize) {
        let (mut found, mut work) = (false, 1);
        self.listing.around(p, reach, |number| {
            work += 1;
            let segment = &self.segments[number as usize];
            found = found || (counts(segment) && distance2(p, segment.ends) <= reach * reach);
        });
        (found, work)
    }
}

/// Square of the distance of a point from a segment.
fn distance2(p: Point, [a, b]: [Point; 2]) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.hypot2().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (p - a.lerp(b, t)).hypot2()
}
