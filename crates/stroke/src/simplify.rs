use kurbo::Point;

/// The fewest of `points` whose polyline stays within `tolerance` of all of them; first and last are kept.
///
/// Ramer, "An iterative procedure for the polygonal approximation of plane curves" (1972); Douglas & Peucker,
/// "Algorithms for the reduction of the number of points required to represent a digitized line" (1973). A closed
/// polyline need not repeat its first point; it is cut where it is furthest from that point, which is kept too.
pub fn simplify(points: &[Point], closed: bool, tolerance: f64) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut ring = points.to_vec();
    if closed {
        ring.push(points[0]);
    }
    let mut keep = vec![false; ring.len()];
    let last = ring.len() - 1;
    keep[0] = true;
    keep[last] = !closed;
    let mut spans = vec![(0, last)];
    while let Some((from, to)) = spans.pop() {
        if let Some((middle, _)) = furthest(&ring, from, to).filter(|&(_, far)| far > tolerance) {
            keep[middle] = true;
            spans.extend([(from, middle), (middle, to)]);
        }
    }
    ring.into_iter().zip(keep).filter_map(|(point, kept)| kept.then_some(point)).collect()
}

/// The point strictly between two of them that is furthest from their chord, and how far that is.
fn furthest(points: &[Point], from: usize, to: usize) -> Option<(usize, f64)> {
    let far = |i: usize| distance_to_segment(points[i], points[from], points[to]);
    (from + 1..to).map(|i| (i, far(i))).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Distance from `p` to the nearest point of the segment from `a` to `b`.
pub fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    let length2 = along.hypot2();
    if length2 == 0.0 {
        return p.distance(a);
    }
    let share = ((p - a).dot(along) / length2).clamp(0.0, 1.0);
    p.distance(a + along * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_run_keeps_its_ends_only() {
        let points: Vec<_> = (0..50).map(|i| Point::new(f64::from(i), 2.0)).collect();
        assert_eq!(simplify(&points, false, 0.1), [points[0], points[49]]);
    }

    #[test]
    fn no_point_is_left_further_away_than_the_tolerance() {
        let points: Vec<_> =
            (0..400).map(|i| 0.03 * f64::from(i)).map(|t| Point::new(9.0 * t, 20.0 * t.sin())).collect();
        for tolerance in [0.01, 0.1, 1.0] {
            let few = simplify(&points, false, tolerance);
            let off = |&p: &Point| {
                few.windows(2).map(|w| distance_to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min)
            };
            assert!(points.iter().map(off).fold(0.0, f64::max) <= tolerance);
            assert!(few.len() < points.len() / 2, "{} left at {tolerance}", few.len());
        }
    }

    #[test]
    fn a_ring_keeps_its_four_corners() {
        let side = |n: i32| (0..n).map(f64::from);
        let mut ring: Vec<_> = side(10).map(|x| Point::new(x, 0.0)).collect();
        ring.extend(side(10).map(|y| Point::new(10.0, y)));
        ring.extend(side(10).map(|x| Point::new(10.0 - x, 10.0)));
        ring.extend(side(10).map(|y| Point::new(0.0, 10.0 - y)));
        assert_eq!(simplify(&ring, true, 0.01).len(), 4);
    }
}
