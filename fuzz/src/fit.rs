//! Points to a path.

use std::f64::consts::PI;

use tracelight_stroke::{FitOptions, Path, Point, fit, simplify};

use crate::bytes::Bytes;
use crate::sound::check_path;

/// More points than this are no other case.
const MOST_POINTS: usize = 300;

/// Small ones only make many samples, 200 000 at most, and the fuzzer slow.
const TOLERANCES: [f64; 6] = [0.35, 0.35, 0.1, 1.0, 4.0, 100.0];
const CORNERS_RAD: [f64; 5] = [0.436, 0.436, 0.0, 1.5, PI];
const REACHES: [f64; 6] = [1.4, 1.4, 0.0, 0.2, 6.0, 100.0];

/// Layout: bit 0 of the first byte closed, bit 1 wild; tolerance, corner, reach; then the points, of two bytes a
/// coordinate, or of eight where they are wild.
///
/// # Panics
/// When the path goes where no point is, or loses an end.
pub fn check(data: &[u8]) {
    let mut bytes = Bytes::of(data);
    let flags = bytes.byte();
    let (closed, wild) = (flags & 1 == 1, flags & 2 == 2);
    let options = FitOptions {
        tolerance: bytes.one_of(&TOLERANCES),
        corner_rad: bytes.one_of(&CORNERS_RAD),
        reach: bytes.one_of(&REACHES),
    };
    let mut points = Vec::new();
    while points.len() < MOST_POINTS && !bytes.is_empty() {
        points.push(match wild {
            true => Point::new(bytes.any_number(), bytes.any_number()),
            false => Point::new(bytes.coordinate(), bytes.coordinate()),
        });
    }
    let path = fit(&points, closed, &options);
    let simple = simplify(&points, closed, options.tolerance);
    assert!(simple.len() <= points.len());
    if !wild {
        check_fit(path.as_ref(), &points, closed, &options);
    } else if let Some(path) = path {
        assert!(path.start().is_finite());
    }
}

fn check_fit(path: Option<&Path>, points: &[Point], closed: bool, options: &FitOptions) {
    let distinct = points.windows(2).any(|w| w[0] != w[1]);
    assert_eq!(path.is_some(), distinct, "{} points", points.len());
    let Some(path) = path else { return };
    check_path(path);
    if let (false, Some(first), Some(last)) = (closed, points.first(), points.last()) {
        assert!(path.start().distance(*first) < 1e-9, "starts at {:?}, not {first:?}", path.start());
        assert!(path.end().distance(*last) < 1e-9, "ends at {:?}, not {last:?}", path.end());
    }
    let margin = margin(points, options);
    let (low, high) = bounds(points);
    for p in path.flatten(0.1) {
        let near = (low.x - margin..=high.x + margin).contains(&p.x)
            && (low.y - margin..=high.y + margin).contains(&p.y);
        assert!(near, "{p:?} is further than {margin} from the box {low:?} {high:?}");
    }
}

/// How far a path may leave the box of its points. Corners are put where their sides meet, some way outside the
/// points; points that are all noise turn a cubic's tangents anywhere.
fn margin(points: &[Point], options: &FitOptions) -> f64 {
    let (low, high) = bounds(points);
    low.distance(high) + 10.0 * (options.reach + options.tolerance)
}

fn bounds(points: &[Point]) -> (Point, Point) {
    let of = |f: fn(f64, f64) -> f64| {
        points.iter().copied().reduce(|a, b| Point::new(f(a.x, b.x), f(a.y, b.y))).unwrap_or_default()
    };
    (of(f64::min), of(f64::max))
}
