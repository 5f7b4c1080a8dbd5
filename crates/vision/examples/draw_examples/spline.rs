use tracelight_maths::{atan2, planar, sin_cos};
use tracelight_stroke::{Element, Path, Point, Vec2};

/// Sweeps of the Gauss–Seidel iteration. Its matrix is diagonally dominant by two, an error at least halves in each,
/// and 2⁻⁶⁰ is below the last bit.
const SWEEPS: usize = 60;

/// A smooth curve through points, as a hand would draw it.
///
/// Hobby, "Smooth, easy to compute interpolating splines" (1986), with tension and end curl 1.
pub(crate) fn through(points: &[Point], closed: bool) -> Path {
    let mut path = Path::new(points[0]);
    extend(&mut path, points, closed);
    if closed {
        path.close();
    }
    path
}

/// A closed outline of smooth spans, a corner where one ends and the next begins at the same point.
pub(crate) fn cornered(spans: &[&[(f64, f64)]]) -> Path {
    let mut path = Path::new(Point::from(spans[0][0]));
    for span in spans {
        extend(&mut path, &points(span), false);
    }
    path.close();
    path
}

/// Points from pairs.
pub(crate) fn points(pairs: &[(f64, f64)]) -> Vec<Point> {
    pairs.iter().map(|&pair| Point::from(pair)).collect()
}

fn extend(path: &mut Path, points: &[Point], closed: bool) {
    let chords = chords(points, closed);
    let turns = turns(&chords, closed);
    let leave = departures(&chords, &turns, closed);
    for (k, &chord) in chords.iter().enumerate() {
        let next = (k + 1) % leave.len();
        path.push(piece(points[k], chord, leave[k], -turns[next] - leave[next]));
    }
}

fn chords(points: &[Point], closed: bool) -> Vec<Vec2> {
    let ring = points.iter().chain(closed.then_some(&points[0]));
    ring.clone().zip(ring.skip(1)).map(|(&a, &b)| b - a).collect()
}

/// Angle by which the polygon turns at each point; zero at open ends.
fn turns(chords: &[Vec2], closed: bool) -> Vec<f64> {
    let turn = |a: Vec2, b: Vec2| atan2(a.cross(b), a.dot(b));
    let mut turns: Vec<_> = chords.windows(2).map(|pair| turn(pair[0], pair[1])).collect();
    let last = chords.len() - 1;
    turns.insert(0, if closed { turn(chords[last], chords[0]) } else { 0.0 });
    if !closed {
        turns.push(0.0);
    }
    turns
}

/// Angle θ at each point from its chord to the curve that leaves it: equal mock curvature on both sides.
fn departures(chords: &[Vec2], turns: &[f64], closed: bool) -> Vec<f64> {
    let count = turns.len();
    let mut theta = vec![0.0; count];
    for _ in 0..SWEEPS {
        for k in 0..count {
            let (before, after) = ((k + count - 1) % count, (k + 1) % count);
            theta[k] = match (closed, k) {
                (false, 0) => -theta[after] - turns[after],
                (false, k) if k == count - 1 => -theta[before],
                _ => {
                    let (a, d) = (1.0 / chords[before].hypot(), 1.0 / chords[k].hypot());
                    let known = 2.0 * a * turns[k] + d * turns[after];
                    -(known + a * theta[before] + d * theta[after]) / (2.0 * (a + d))
                }
            };
        }
    }
    theta
}

/// The cubic over a chord that leaves it by θ and arrives by φ.
fn piece(from: Point, chord: Vec2, theta: f64, phi: f64) -> Element {
    let to = from + chord;
    let c1 =
        from + planar::direction(planar::heading(chord) + theta) * (chord.hypot() * velocity(theta, phi));
    let c2 = to - planar::direction(planar::heading(chord) - phi) * (chord.hypot() * velocity(phi, theta));
    Element::Cubic { c1, c2, to }
}

/// Length of a handle as a share of its chord: Hobby's ρ(θ, φ)/3.
fn velocity(theta: f64, phi: f64) -> f64 {
    let (st, ct) = sin_cos(theta);
    let (sp, cp) = sin_cos(phi);
    let over = 2.0 + 2_f64.sqrt() * (st - sp / 16.0) * (sp - st / 16.0) * (ct - cp);
    let under = 1.0 + 0.5 * (5_f64.sqrt() - 1.0) * ct + 0.5 * (3.0 - 5_f64.sqrt()) * cp;
    over / (3.0 * under)
}
