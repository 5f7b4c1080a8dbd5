//! Fits one arc to many points.

use kurbo::Point;

use super::window::turn;
use crate::Element;

/// Fewer points than this have no curvature.
const LEAST_POINTS: usize = 4;
/// What an arc sweeps, rad: what bends by less than 6° is as good a cubic; nearly all round, the ends do not tell the
/// centre.
pub(super) const SWEEPS: std::ops::Range<f64> = 0.1..6.0;

/// The arc through a row's first and last point that none of the others is further off than `tolerance`; `None` where
/// there is none.
///
/// Its centre lies on the bisector of the ends, at the height h where the sum of (|p − c|² − r²)² is least: that is
/// linear in h (Kåsa's circle fit, 1976, with both ends held).
pub(super) fn through(row: &[Point], tolerance: f64) -> Option<Element> {
    let [from, points @ .., to] = row else { return None };
    let chord = *to - *from;
    if points.len() < LEAST_POINTS || chord.hypot() < tolerance {
        return None;
    }
    let (middle, normal) = (from.midpoint(*to), chord.turn_90() / chord.hypot());
    let quarter = 0.25 * chord.hypot2();
    let (mut weighted, mut weights) = (0.0, 0.0);
    for v in points.iter().map(|&p| p - middle) {
        let y = v.dot(normal);
        (weighted, weights) = (weighted + y * (v.hypot2() - quarter), weights + y * y);
    }
    let centre = middle + normal * (0.5 * weighted / weights.max(1e-300));
    let radius = centre.distance(*from);
    let on = points.iter().all(|p| (p.distance(centre) - radius).abs() <= tolerance);
    let sweep = if on { swept(row, centre)? } else { return None };
    Some(Element::Arc { centre, sweep })
}

/// Signed angle from end to end about the centre; `None` where the points turn back or round too little or too far.
fn swept(row: &[Point], centre: Point) -> Option<f64> {
    let turns = row.windows(2).map(|w| turn(w[0] - centre, w[1] - centre));
    let (sum, all) = turns.fold((0.0_f64, 0.0), |(sum, all), t| (sum + t, all + t.abs()));
    (SWEEPS.contains(&sum.abs()) && all < 1.05 * sum.abs() + 0.02).then_some(sum)
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use kurbo::Vec2;

    use super::*;

    #[test]
    fn points_on_a_circle_are_one_arc_and_points_on_an_ellipse_are_none() {
        let centre = Point::new(12.0, -5.0);
        for (sweep, squash) in [(0.6, 1.0), (-2.0, 1.0), (4.4, 1.0), (1.5, 0.9)] {
            let at = |k: u32| {
                let v = planar::direction(0.3 + sweep * f64::from(k) / 60.0) * 40.0;
                centre + Vec2::new(v.x, squash * v.y)
            };
            let row: Vec<Point> = (0..=60).map(at).collect();
            match (through(&row, 0.2), squash == 1.0) {
                (Some(Element::Arc { centre: c, sweep: s }), true) => {
                    assert!(c.distance(centre) < 1e-6 && (s - sweep).abs() < 1e-8, "{c} {s}");
                }
                (None, false) => {}
                other => panic!("{other:?} for a sweep of {sweep}"),
            }
        }
    }

    #[test]
    fn a_spiral_and_a_straight_row_are_no_arcs() {
        let spiral =
            |k: u32| Point::ORIGIN + planar::direction(f64::from(k) / 20.0) * (30.0 + 0.2 * f64::from(k));
        assert!(through(&(0..=60).map(spiral).collect::<Vec<_>>(), 0.2).is_none());
        assert!(through(&(0..=60).map(|k| Point::new(f64::from(k), 1.0)).collect::<Vec<_>>(), 0.2).is_none());
    }
}
