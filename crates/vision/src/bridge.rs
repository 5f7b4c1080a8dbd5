//! Connects two line ends across a part that is not visible.

use tracelight_image::Plane;
use tracelight_image::median::median;
use tracelight_maths::atan2;
use tracelight_stroke::{Parabola, Point, Vec2, polyline_length};

/// Points from a line's end on of which its direction there is taken: as many as lie on a parabola.
const WINDOWS: [usize; 6] = [6, 9, 13, 19, 28, 40];
/// How far points of one parabola are from it, px, root mean square, where they have no noise; or, over their noise.
const ON_PARABOLA_PX: f64 = 0.06;
const OVER_NOISE: f64 = 1.5;
/// Fewer points lead from the last to the first, if they are this far apart, px.
const LEAST_PAIR_PX: f64 = 0.5;
/// Sine of the least angle between two lines that are said to meet: 4°.
const LEAST_CROSS: f64 = 0.07;
/// A pair that turns more than this is a corner, less a bend, rad (25°).
const CORNER_RAD: f64 = 25.0 / 180.0 * std::f64::consts::PI;

/// The end of a row of points and the direction out of it (a unit vector, or zero for a single point).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tip {
    pub(crate) at: Point,
    pub(crate) along: Vec2,
    /// The row's curve; arc length from the tip grows into the row.
    curve: Option<Parabola>,
}

impl Tip {
    /// Of a row's first (`end` 0) or last point; `None` for no points.
    pub(crate) fn of(points: &[Point], end: usize) -> Option<Self> {
        let n = points.len();
        let at = |k: usize| points[if end == 0 { k } else { n - 1 - k }];
        let samples = measured(points, end);
        let rms = ON_PARABOLA_PX.max(OVER_NOISE * noise_near(points, end));
        let curve = (n > 0).then(|| Parabola::widest(samples, &WINDOWS, rms))?;
        let along = match (curve, points) {
            (Some(curve), _) => -curve.tangent(0.0),
            (None, [a, .., b]) if a.distance(*b) > LEAST_PAIR_PX => (at(0) - at(n - 1)).normalize(),
            _ => Vec2::ZERO,
        };
        Some(Self { at: at(0), along, curve })
    }

    /// A lone point, without direction.
    pub(crate) const fn single(at: Point) -> Self {
        Self { at, along: Vec2::ZERO, curve: None }
    }

    /// A lone point that leads to another place.
    pub(crate) fn towards(at: Point, place: Point) -> Self {
        Self { along: (place - at).normalize(), ..Self::single(at) }
    }

    /// Where the row's curve is, and where it leads, `ahead` of the tip.
    pub(crate) fn beyond(&self, ahead: f64) -> (Point, Vec2) {
        let on = |c: Parabola| (c.point(-ahead), -c.tangent(-ahead));
        self.curve.map_or((self.at + self.along * ahead, self.along), on)
    }

    /// Whether all is ink from this tip to a place so far ahead.
    pub(crate) fn is_inked_to(&self, dark: &Plane<u8>, ahead: f64) -> bool {
        let steps = ahead.max(0.0).ceil() as usize;
        (1..=steps).all(|k| is_inked(dark, self.at, self.beyond((k as f64).min(ahead)).0))
    }

    /// How far ahead of this tip and of another their curves meet; `None` where they run side by side.
    fn meets(&self, other: &Tip) -> Option<(f64, f64)> {
        let (mut s, mut t) = (0.0, 0.0);
        // tangents are intersected, and taken again at the meeting point
        for _ in 0..4 {
            let ((a, u), (b, v)) = (self.beyond(s), other.beyond(t));
            let cross = u.cross(v);
            if cross.abs() < LEAST_CROSS {
                return None;
            }
            s += (b - a).cross(v) / cross;
            t += (b - a).cross(u) / cross;
        }
        Some((s, t))
    }

    /// How much a line turns on its way from this tip to another: from this one's direction to the way over, and on
    /// to the other's, rad. For an offset pair that is more than the angle between the two.
    pub(crate) fn bend(&self, other: &Tip) -> f64 {
        let over = other.at - self.at;
        if over.hypot() < 0.5 {
            return self.turn(other).abs();
        }
        angle(self.along, over).abs() + angle(over, -other.along).abs()
    }

    /// By how much a line would have to leave its own curve to get from this tip to another, and from that one to this: off it as a
    /// share of the way, and turned from it, rad. A straight line that runs on has 0, and so has a bow that bends on.
    pub(crate) fn misfit(&self, other: &Tip) -> f64 {
        let way = self.at.distance(other.at);
        if way < 0.5 {
            return self.turn(other).abs();
        }
        let off = |from: &Tip, to: &Tip| {
            let (place, along) = from.beyond(way);
            place.distance(to.at) / way + 0.5 * angle(along, -to.along).abs()
        };
        0.5 * (off(self, other) + off(other, self))
    }

    /// Whether lines from here to `other` and from `across` to `beyond` are two that cross: neither bends by `most`
    /// and the ways over cut each other.
    pub(crate) fn crosses(&self, other: &Tip, across: &Tip, beyond: &Tip, most: f64) -> bool {
        let (way, cut) = (other.at - self.at, beyond.at - across.at);
        let side = |p: Point| way.cross(p - self.at);
        let flank = |p: Point| cut.cross(p - across.at);
        let parted = side(across.at) * side(beyond.at) < 0.0 && flank(self.at) * flank(other.at) < 0.0;
        parted && self.bend(other) < most && across.bend(beyond) < most
    }

    /// Angle between the direction out of here and the one into the other, rad.
    fn turn(&self, other: &Tip) -> f64 {
        angle(self.along, -other.along)
    }

    /// Points about 1 px apart from this tip to another, without the two: a smooth curve, or a corner where their
    /// lines meet, if there is ink. A corner within 1.5 px of one of the points `near` is put there.
    pub(crate) fn bridge(&self, other: &Tip, dark: &Plane<u8>, near: &[Point]) -> Vec<Point> {
        self.corner(other, dark, near).unwrap_or_else(|| self.smoothly_to(other))
    }

    /// Bridges two tips with a corner; `None` if their lines continue each other, or meet nowhere on ink.
    pub(crate) fn corner(&self, other: &Tip, dark: &Plane<u8>, near: &[Point]) -> Option<Vec<Point>> {
        let over = other.at - self.at;
        // lines an angle θ apart meet |over|/θ ahead; nearly parallel ones nowhere in particular
        let far = over.hypot() / LEAST_CROSS + 4.0;
        let ahead = |s: f64| (-1.0..far).contains(&s);
        let inked = |s: f64, t: f64| self.is_inked_to(dark, s) && other.is_inked_to(dark, t);
        let corner = self.meets(other).filter(|&(s, t)| ahead(s) && ahead(t) && inked(s, t));
        let (s, t) = corner.filter(|_| self.turn(other).abs() >= CORNER_RAD)?;
        let corner = self.beyond(s).0;
        let nearest = near.iter().copied().min_by(|p, q| p.distance(corner).total_cmp(&q.distance(corner)));
        let corner = nearest.filter(|p| p.distance(corner) < 1.5).unwrap_or(corner);
        let steps = |length: f64| 1..=(length - 0.5).max(0.0) as usize;
        let out = steps(s).map(|k| self.beyond(k as f64).0);
        let back = steps(t).rev().map(|k| other.beyond(k as f64).0);
        Some(out.chain([corner]).chain(back).collect())
    }

    /// Points about 1 px apart on a smooth curve from this tip to another, without the two.
    pub(crate) fn smoothly_to(&self, other: &Tip) -> Vec<Point> {
        let length = self.at.distance(other.at);
        let steps = length.round().max(1.0) as usize;
        let (from, to) = (self.along * length, -other.along * length);
        (1..steps).map(|k| hermite(self.at, from, other.at, to, k as f64 / steps as f64)).collect()
    }
}

/// Values from the first (`end` 0) or the last one on.
pub(crate) fn from_end<T>(
    values: &[T],
    end: usize,
) -> impl ExactSizeIterator<Item = &T> + DoubleEndedIterator {
    let n = values.len();
    (0..n).map(move |k| &values[if end == 0 { k } else { n - 1 - k }])
}

/// The points of a row from its first (`end` 0) or last one on, each with how far along the row it is.
pub(crate) fn measured(points: &[Point], end: usize) -> impl Iterator<Item = (f64, Point)> {
    let (mut length, mut before) = (0.0, None);
    from_end(points, end).map(move |&p| {
        length += before.map_or(0.0, |before| p.distance(before));
        before = Some(p);
        (length, p)
    })
}

/// Takes away the last points of a row that lie beyond a place, seen along a direction, as long as one of them and `stays` px are left.
pub(crate) fn drop_beyond(points: &mut Vec<Point>, at: Point, along: Vec2, stays: f64) {
    let mut left = polyline_length(points);
    while let [.., before, last] = points[..] {
        left -= last.distance(before);
        if (last - at).dot(along) <= -0.25 || left < stays {
            break;
        }
        points.pop();
    }
}

/// How far the points near a row's end scatter about their line, px.
fn noise_near(points: &[Point], end: usize) -> f64 {
    let reach = points.len().min(WINDOWS[WINDOWS.len() - 1]);
    scatter_px(if end == 0 { &points[..reach] } else { &points[points.len() - reach..] })
}

/// How far points scatter about their line, px, from third differences, which a bend leaves alone; 0 of few.
pub(crate) fn scatter_px(points: &[Point]) -> f64 {
    // across the line: √20 times the scatter, of which the median is 0.6745
    const TIMES: f64 = 3.016;
    // along it the points may lie as they like
    let third = |w: &[Point]| {
        let along = w[3] - w[0];
        (along - (w[2] - w[1]) * 3.0).cross(along / along.hypot().max(1e-9)).abs()
    };
    median(&points.windows(4).map(third).collect::<Vec<_>>()) / TIMES
}

/// How far a line of some width leads from its end towards a place: all the way if that is ink, or to half its width from
/// where the ink ends.
pub(crate) fn inked_towards(dark: &Plane<u8>, line: Point, place: Point, width: f64) -> Point {
    let steps = line.distance(place).ceil().max(1.0);
    let at = |k: f64| line.lerp(place, k / steps);
    let inked = (1..=steps as usize).take_while(|&k| is_inked(dark, line, at(k as f64))).count() as f64;
    if inked == steps { place } else { at((inked - 0.5 * width * steps / line.distance(place)).max(0.0)) }
}

/// Whether a place is at least a third as dark as one on the line.
fn is_inked(dark: &Plane<u8>, line: Point, place: Point) -> bool {
    3.0 * dark.at(place) >= dark.at(line)
}

/// From one direction to another, rad.
pub(crate) fn angle(a: Vec2, b: Vec2) -> f64 {
    atan2(a.cross(b), a.dot(b))
}

/// The place nearest to all tips' lines; `None` where they are nearly parallel.
pub(crate) fn meeting(tips: &[Tip]) -> Option<Point> {
    let (mut xx, mut xy, mut yy, mut x, mut y) = (0.0, 0.0, 0.0, 0.0, 0.0);
    let origin = tips.first()?.at;
    for tip in tips {
        // the projector across the line, 1 − u uᵀ
        let (u, p) = (tip.along, tip.at - origin);
        let (a, b, c) = (1.0 - u.x * u.x, -u.x * u.y, 1.0 - u.y * u.y);
        (xx, xy, yy) = (xx + a, xy + b, yy + c);
        (x, y) = (x + a * p.x + b * p.y, y + b * p.x + c * p.y);
    }
    // sin² of the angle between two lines: under 8° they meet nowhere in particular
    let determinant = xx * yy - xy * xy;
    let met = Vec2::new(x * yy - y * xy, xx * y - xy * x) / determinant;
    (determinant > 0.02).then(|| origin + met)
}

/// Cubic Hermite interpolation between two places with their derivatives.
fn hermite(p: Point, u: Vec2, q: Point, v: Vec2, t: f64) -> Point {
    let s = 1.0 - t;
    let at = p.to_vec2() * (s * s * (1.0 + 2.0 * t)) + q.to_vec2() * (t * t * (3.0 - 2.0 * t));
    (at + u * (t * s * s) - v * (t * t * s)).to_point()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(from: (f64, f64), to: (f64, f64)) -> Vec<Point> {
        (0..=20).map(|k| Point::from(from).lerp(to.into(), f64::from(k) / 20.0)).collect()
    }

    #[test]
    fn two_ends_that_meet_at_an_angle_make_a_corner() {
        let (a, b) = (row((0.0, 0.0), (20.0, 0.0)), row((25.0, 6.0), (25.0, 30.0)));
        let (tip, start) = (Tip::of(&a, 1).unwrap(), Tip::of(&b, 0).unwrap());
        let bridge = tip.bridge(&start, &Plane::filled(80, 80, 255), &[]);
        let off = |p: &Point| p.distance(Point::new(25.0, 0.0));
        assert!(bridge.iter().map(off).fold(f64::INFINITY, f64::min) < 1e-9, "{bridge:?}");
        assert!(bridge.iter().all(|p| p.x == 25.0 || p.y == 0.0));
    }

    #[test]
    fn two_ends_on_one_line_are_joined_straight() {
        let (a, b) = (row((0.0, 0.0), (20.0, 10.0)), row((30.0, 15.0), (60.0, 30.0)));
        let bridge =
            Tip::of(&a, 1).unwrap().bridge(&Tip::of(&b, 0).unwrap(), &Plane::filled(80, 80, 255), &[]);
        assert_eq!(bridge.len(), 10);
        assert!(bridge.iter().all(|p| (p.y - 0.5 * p.x).abs() < 1e-9));
    }
}
