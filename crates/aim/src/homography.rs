use nalgebra::{DMatrix, Matrix2, Matrix3, SMatrix, SVector, Vector3};
use tracelight_stroke::{Affine, Point, Vec2};

use crate::camera::Uncertain;

/// A map from one plane to another that keeps straight lines straight: between target and pixel where the lens does not bend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homography {
    matrix: Matrix3<f64>,
    /// Covariance of the first eight entries, row by row, the ninth being one.
    covariance: SMatrix<f64, 8, 8>,
}

impl Homography {
    /// The map of least squared distances of four or more pairs, each of which is seen with `deviation`; `None` if they leave it open: three
    /// on a line, two in one place.
    ///
    /// Hartley & Zisserman, *Multiple View Geometry*, 2nd ed., algorithm 4.2 (normalized DLT), then Gauss and Newton's method on the
    /// distances; covariance after §5.2.
    pub fn through(pairs: &[(Point, Point)], deviation: f64) -> Option<Self> {
        let (from, to): (Vec<Point>, Vec<Point>) = pairs.iter().copied().unzip();
        let (from_scale, to_scale) = (Scale::of(&from)?, Scale::of(&to)?);
        let scaled: Vec<(Point, Point)> =
            pairs.iter().map(|&(a, b)| (from_scale.apply(a), to_scale.apply(b))).collect();
        let found = linear(&scaled)?;
        let matrix = to_scale.matrix().try_inverse()? * found * from_scale.matrix();
        let mut map = Self { matrix: matrix / matrix[(2, 2)], covariance: SMatrix::zeros() };
        for _ in 0..5 {
            map = map.nearer(pairs, deviation)?;
        }
        map.matrix.iter().all(|v| v.is_finite()).then_some(map)
    }

    /// Where a point comes to lie; `None` of one at infinity.
    pub fn apply(&self, p: Point) -> Option<Point> {
        let v = self.matrix * Vector3::new(p.x, p.y, 1.0);
        let at = Point::new(v.x / v.z, v.y / v.z);
        (at.x.is_finite() && at.y.is_finite()).then_some(at)
    }

    /// Maps a point, with the covariance that the map's own uncertainty causes.
    pub fn apply_with(&self, p: Point) -> Option<Uncertain> {
        let (at, _, by) = self.derivatives(p)?;
        Some(Uncertain { at, covariance: by * self.covariance * by.transpose() })
    }

    /// Where a direction at a point points to: the derivative along it.
    pub fn carry(&self, p: Point, along: Vec2) -> Option<Vec2> {
        let (_, by_point, _) = self.derivatives(p)?;
        Some(Vec2::new(
            by_point[(0, 0)] * along.x + by_point[(0, 1)] * along.y,
            by_point[(1, 0)] * along.x + by_point[(1, 1)] * along.y,
        ))
    }

    /// How many times as far as the origin a point lies from whoever sees the map as a plane at a slant: what the map shrinks lengths by, about, and
    /// negative beyond the horizon.
    pub(crate) fn depth(&self, p: Point) -> f64 {
        (self.matrix * Vector3::new(p.x, p.y, 1.0)).z
    }

    /// Whether a point lies on the origin's side of the horizon.
    pub(crate) fn is_before_horizon(&self, p: Point) -> bool {
        self.depth(p) > 0.0
    }

    /// Returns the inverse; `None` for a singular map. Its covariance is propagated to first order.
    pub fn inverse(&self) -> Option<Self> {
        let inverse = self.matrix.try_inverse()?;
        let scale = inverse[(2, 2)];
        let matrix = inverse / scale;
        let mut by = SMatrix::<f64, 8, 8>::zeros();
        for k in 0..8 {
            let mut unit = Matrix3::zeros();
            unit[(k / 3, k % 3)] = 1.0;
            let change = -(inverse * unit * inverse);
            let change = (change - matrix * change[(2, 2)]) / scale;
            (0..8).for_each(|i| by[(i, k)] = change[(i / 3, i % 3)]);
        }
        (scale.abs() > 1e-300).then(|| Self { matrix, covariance: by * self.covariance * by.transpose() })
    }

    /// Another map first, and then this one; without what is known of its uncertainty.
    pub(crate) fn after(&self, first: Affine) -> Option<Self> {
        let [a, b, c, d, e, f] = first.as_coeffs();
        let matrix = self.matrix * Matrix3::new(a, c, e, b, d, f, 0.0, 0.0, 1.0);
        let matrix = matrix / matrix[(2, 2)];
        matrix.iter().all(|v| v.is_finite()).then(|| Self { matrix, covariance: SMatrix::zeros() })
    }

    /// The nine entries, row by row, the last of them one.
    pub(crate) const fn matrix(&self) -> &Matrix3<f64> {
        &self.matrix
    }

    /// A point's image, its derivatives by the point and by the map's first eight entries.
    fn derivatives(&self, p: Point) -> Option<(Point, Matrix2<f64>, SMatrix<f64, 2, 8>)> {
        let at = self.apply(p)?;
        let w = (self.matrix * Vector3::new(p.x, p.y, 1.0)).z;
        let m = &self.matrix;
        let slope = |row: usize, column: usize, v: f64| (m[(row, column)] - v * m[(2, column)]) / w;
        let by_point =
            Matrix2::new(slope(0, 0, at.x), slope(0, 1, at.x), slope(1, 0, at.y), slope(1, 1, at.y));
        let (x, y, one) = (p.x / w, p.y / w, 1.0 / w);
        let mut by_map = SMatrix::<f64, 2, 8>::zeros();
        by_map.row_mut(0).copy_from_slice(&[x, y, one, 0.0, 0.0, 0.0, -at.x * x, -at.x * y]);
        by_map.row_mut(1).copy_from_slice(&[0.0, 0.0, 0.0, x, y, one, -at.y * x, -at.y * y]);
        Some((at, by_point, by_map))
    }

    /// A step of Gauss and Newton's method.
    fn nearer(&self, pairs: &[(Point, Point)], deviation: f64) -> Option<Self> {
        let (mut normal, mut gradient) = (SMatrix::<f64, 8, 8>::zeros(), SVector::<f64, 8>::zeros());
        for &(from, to) in pairs {
            let (at, _, by) = self.derivatives(from)?;
            let off = to - at;
            normal += by.transpose() * by;
            gradient += by.transpose() * SVector::<f64, 2>::new(off.x, off.y);
        }
        let inverse = normal.cholesky()?.inverse();
        let step = inverse * gradient;
        let mut matrix = self.matrix;
        (0..8).for_each(|k| matrix[(k / 3, k % 3)] += step[k]);
        Some(Self { matrix, covariance: inverse * (deviation * deviation) })
    }
}

/// Moves and scales points to lie about the origin, √2 from it on average.
struct Scale {
    centre: Vec2,
    factor: f64,
}

impl Scale {
    fn of(points: &[Point]) -> Option<Self> {
        let n = points.len() as f64;
        let centre = points.iter().map(|p| p.to_vec2()).sum::<Vec2>() / n;
        let mean = points.iter().map(|p| (p.to_vec2() - centre).hypot()).sum::<f64>() / n;
        (points.len() >= 4 && mean > 0.0 && mean.is_finite())
            .then(|| Self { centre, factor: std::f64::consts::SQRT_2 / mean })
    }

    fn apply(&self, p: Point) -> Point {
        ((p.to_vec2() - self.centre) * self.factor).to_point()
    }

    fn matrix(&self) -> Matrix3<f64> {
        let (s, c) = (self.factor, self.centre);
        Matrix3::new(s, 0.0, -s * c.x, 0.0, s, -s * c.y, 0.0, 0.0, 1.0)
    }
}

/// The map whose nine entries fit best as they stand, of points that are scaled; `None` if two do.
fn linear(pairs: &[(Point, Point)]) -> Option<Matrix3<f64>> {
    let mut normal = DMatrix::<f64>::zeros(9, 9);
    for &(from, to) in pairs {
        let (x, y) = (from.x, from.y);
        for row in [
            [x, y, 1.0, 0.0, 0.0, 0.0, -to.x * x, -to.x * y, -to.x],
            [0.0, 0.0, 0.0, x, y, 1.0, -to.y * x, -to.y * y, -to.y],
        ] {
            let row = SVector::<f64, 9>::from(row);
            normal += row * row.transpose();
        }
    }
    let eigen = normal.symmetric_eigen();
    let mut order: Vec<usize> = (0..9).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let (least, next, most) = (order[0], order[1], order[8]);
    if eigen.eigenvalues[next] < 1e-9 * eigen.eigenvalues[most] {
        return None;
    }
    let entries = eigen.eigenvectors.column(least);
    Some(Matrix3::from_row_slice(entries.as_slice()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> Homography {
        let matrix = Matrix3::new(900.0, 40.0, 640.0, -30.0, -950.0, 360.0, 0.1, -0.2, 1.0);
        Homography { matrix, covariance: SMatrix::zeros() }
    }

    fn pairs(noise_px: f64, seed: u128) -> Vec<(Point, Point)> {
        let mut dice = oorandom::Rand64::new(seed);
        let mut noise = || {
            noise_px
                * (-2.0 * dice.rand_float().max(1e-12).ln()).sqrt()
                * (std::f64::consts::TAU * dice.rand_float()).cos()
        };
        let places = (0..25).map(|k| Point::new(0.12 * f64::from(k % 5 - 2), 0.07 * f64::from(k / 5 - 2)));
        places.map(|p| (p, map().apply(p).unwrap() + Vec2::new(noise(), noise()))).collect()
    }

    #[test]
    fn exact_pairs_give_the_map_back() {
        for count in [4, 25] {
            // corners first
            let mut exact = pairs(0.0, 1);
            exact.sort_by(|a, b| b.0.to_vec2().hypot().total_cmp(&a.0.to_vec2().hypot()));
            let found = Homography::through(&exact[..count], 1.0).unwrap();
            assert!((found.matrix - map().matrix).norm() < 1e-6);
        }
    }

    #[test]
    fn what_is_known_of_the_map_is_how_far_it_is_off() {
        let (at, runs, deviation) = (Point::new(0.3, 0.2), 400, 0.3);
        let truth = map().apply(at).unwrap();
        let mut ratio = 0.0;
        for seed in 0..runs {
            let found = Homography::through(&pairs(deviation, seed), deviation).unwrap();
            let told = found.apply_with(at).unwrap();
            ratio += (told.at - truth).hypot2() / told.covariance.trace() / runs as f64;
            let back = found.inverse().unwrap();
            assert!(back.apply(told.at).unwrap().distance(at) < 1e-9);
            // back and forth, the covariance is that of a map that stays
            let forth = back.inverse().unwrap().apply_with(at).unwrap();
            assert!((forth.covariance - told.covariance).norm() < 1e-6 * told.covariance.norm());
        }
        assert!((0.85..1.15).contains(&ratio), "{ratio}");
    }

    #[test]
    fn points_on_a_line_leave_it_open() {
        let line: Vec<_> = (0..9)
            .map(|k| (Point::new(f64::from(k), 2.0 * f64::from(k)), Point::new(f64::from(k), 1.0)))
            .collect();
        assert!(Homography::through(&line, 1.0).is_none());
        assert!(Homography::through(&line[..3], 1.0).is_none());
    }
}
