//! Detects whole circles.

use kurbo::{Point, Vec2};

use super::window::turn;
use crate::{Element, Path};

/// The circle through closed `points`, as two arcs, if none of them is further from it than `tolerance`.
///
/// Algebraic fit (Kåsa, "A circle fitting procedure and its error analysis", 1976): unbiased for a whole turn.
pub(super) fn through(points: &[Point], tolerance: f64) -> Option<Path> {
    let n = points.len() as f64;
    let middle = (points.iter().map(|p| p.to_vec2()).sum::<Vec2>() / n).to_point();
    let (mut xx, mut xy, mut yy, mut x, mut y) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for v in points.iter().map(|&p| p - middle) {
        let squared = v.hypot2();
        (xx, xy, yy) = (xx + v.x * v.x, xy + v.x * v.y, yy + v.y * v.y);
        (x, y) = (x + 0.5 * squared * v.x, y + 0.5 * squared * v.y);
    }
    let determinant = xx * yy - xy * xy;
    if determinant <= 1e-9 * xx * yy {
        return None;
    }
    let centre = middle + Vec2::new(x * yy - y * xy, y * xx - x * xy) / determinant;
    let radius = points.iter().map(|p| p.distance(centre)).sum::<f64>() / n;
    let round = points.iter().all(|p| (p.distance(centre) - radius).abs() <= tolerance);
    (round && once_round(points, centre)).then(|| path(centre, radius, points))
}

/// Whether the points go round the centre exactly once.
fn once_round(points: &[Point], centre: Point) -> bool {
    (swept(points, centre).abs() - std::f64::consts::TAU).abs() < 1e-6
}

fn swept(points: &[Point], centre: Point) -> f64 {
    let next = points.iter().skip(1).chain(points.first());
    points.iter().zip(next).map(|(&a, &b)| turn(a - centre, b - centre)).sum()
}

fn path(centre: Point, radius: f64, points: &[Point]) -> Path {
    let sweep = std::f64::consts::PI.copysign(swept(points, centre));
    let arm = (points[0] - centre).normalize() * radius;
    let mut path = Path::new(centre + arm);
    path.push(Element::Arc { centre, sweep });
    path.push(Element::Arc { centre, sweep });
    path.close();
    path
}
