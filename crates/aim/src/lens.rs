use tracelight_maths::hypot;
use tracelight_stroke::Point;

use crate::jet::Scalar;

/// What a camera's lens and sensor make of a direction: intrinsic parameters, and distortion after Brown (*Close-range camera
/// calibration*, Photogrammetric Engineering 37(8), 1971) and Conrady.
///
/// The camera frame has x right, y down, z ahead. A direction (x, y, 1) comes to lie at pixel `focal · x′ + centre`, where
/// x′ = x (1 + k₁r² + k₂r⁴ + k₃r⁶) + 2p₁xy + p₂(r² + 2x²) and y′ likewise, as in most other tools; the first pixel's centre is
/// (0.5, 0.5) here, half a pixel more than where many count from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Pixels in a row, rows.
    pub size_px: [usize; 2],
    /// Focal length across and down, px.
    pub focal_px: [f64; 2],
    /// Where the optical axis meets the image, px.
    pub centre_px: Point,
    /// Radial distortion k₁, k₂, k₃.
    pub radial: [f64; 3],
    /// Tangential distortion p₁, p₂.
    pub tangential: [f64; 2],
}

/// Number of a lens's parameters: focal lengths, centre, k₁, k₂, p₁, p₂, k₃.
pub(crate) const LENS_PARAMETERS: usize = 9;

impl Lens {
    /// Without distortion, its axis through the middle of the image.
    pub fn ideal(width_px: usize, height_px: usize, focal_px: f64) -> Self {
        Self {
            size_px: [width_px, height_px],
            focal_px: [focal_px; 2],
            centre_px: Point::new(width_px as f64 / 2.0, height_px as f64 / 2.0),
            radial: [0.0; 3],
            tangential: [0.0; 2],
        }
    }

    /// Where a direction (x, y, 1) comes to lie, px; `None` beyond where distortion turns back.
    pub fn pixel(&self, [x, y]: [f64; 2]) -> Option<Point> {
        let [u, v] = distorted(self.parameters(), [x, y]);
        let size = hypot(x, y);
        (self.within(size) == size).then(|| Point::new(u, v))
    }

    /// Returns the direction (x, y, 1) that is projected to a pixel; `None` if there is no such direction.
    ///
    /// Newton's method from the undistorted direction; within the image of a usual lens it takes four steps to 1e-15.
    pub fn direction(&self, pixel: Point) -> Option<[f64; 2]> {
        let [fx, fy] = self.focal_px;
        let wanted = [(pixel.x - self.centre_px.x) / fx, (pixel.y - self.centre_px.y) / fy];
        let within = |[x, y]: [f64; 2]| {
            let r = hypot(x, y);
            let most = self.within(r);
            // from beyond where distortion turns back, Newton's method would find the wrong branch
            let share = if r > most { most / r } else { 1.0 };
            [x * share, y * share]
        };
        let mut at = within(wanted);
        for _ in 0..30 {
            let ([u, v], [[ux, uy], [vx, vy]]) = self.image(at);
            let (du, dv) = (pixel.x - u, pixel.y - v);
            let det = ux * vy - uy * vx;
            let step = [(du * vy - uy * dv) / det, (ux * dv - du * vx) / det];
            if !(step[0].is_finite() && step[1].is_finite()) {
                return None;
            }
            at = within([at[0] + step[0], at[1] + step[1]]);
            if step[0].abs() + step[1].abs() < 1e-15 {
                break;
            }
        }
        let ([u, v], _) = self.image(at);
        (hypot(u - pixel.x, v - pixel.y) < 1e-6).then_some(at)
    }

    /// A pixel and its derivatives by the direction.
    pub(crate) fn image(&self, [x, y]: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        use crate::dual::Dual;
        let lens = self.parameters().map(Dual::<2>::constant);
        let [u, v] = distorted(lens, [Dual::parameter(x, 0), Dual::parameter(y, 1)]);
        ([u.value, v.value], [u.by, v.by])
    }

    /// A size of direction, or the one from which on larger ones lie no further out, if that is less; at most 80° off the axis.
    fn within(&self, size: f64) -> f64 {
        const MOST: f64 = 5.67;
        const STEP: f64 = MOST / 400.0;
        let [k1, k2, k3] = self.radial;
        let slope = |r2: f64| 1.0 + r2 * (3.0 * k1 + r2 * (5.0 * k2 + r2 * 7.0 * k3));
        // the slope's first zero: it is a cubic in r², so that steps of a hundredth of what matters miss none that lasts
        let size = size.min(MOST);
        let steps = (size / STEP) as usize;
        let turned = (1..=steps).map(|i| STEP * i as f64).find(|r| slope(r * r) <= 0.0);
        turned.map_or(size, |r| r - STEP)
    }

    /// As the surveys count them.
    pub(crate) fn parameters(&self) -> [f64; LENS_PARAMETERS] {
        let ([fx, fy], c) = (self.focal_px, self.centre_px);
        let ([k1, k2, k3], [p1, p2]) = (self.radial, self.tangential);
        [fx, fy, c.x, c.y, k1, k2, p1, p2, k3]
    }

    /// Returns the lens with other values of its fitted parameters.
    pub(crate) fn with(&self, [fx, fy, cx, cy, k1, k2, p1, p2, k3]: [f64; LENS_PARAMETERS]) -> Self {
        Self {
            focal_px: [fx, fy],
            centre_px: Point::new(cx, cy),
            radial: [k1, k2, k3],
            tangential: [p1, p2],
            ..*self
        }
    }
}

/// A direction's pixel by a lens's parameters.
pub(crate) fn distorted<S: Scalar>(
    [fx, fy, cx, cy, k1, k2, p1, p2, k3]: [S; LENS_PARAMETERS],
    [x, y]: [S; 2],
) -> [S; 2] {
    let two = S::constant(2.0);
    let (xx, yy, xy) = (x * x, y * y, x * y);
    let r2 = xx + yy;
    let radial = S::constant(1.0) + r2 * (k1 + r2 * (k2 + r2 * k3));
    let across = x * radial + two * p1 * xy + p2 * (r2 + two * xx);
    let down = y * radial + p1 * (r2 + two * yy) + two * p2 * xy;
    [fx * across + cx, fy * down + cy]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn webcam() -> Lens {
        Lens {
            radial: [-0.1, 0.02, 0.003],
            tangential: [5e-4, -3e-4],
            focal_px: [1000.0, 1002.0],
            ..Lens::ideal(1280, 720, 1000.0)
        }
    }

    #[test]
    fn a_pixels_direction_comes_to_lie_at_that_pixel() {
        for lens in [webcam(), Lens { radial: [-0.3, 0.1, 0.0], ..webcam() }, Lens::ideal(320, 240, 300.0)] {
            let [width, height] = lens.size_px.map(|n| n as f64);
            for i in 0..=10 {
                for j in 0..=10 {
                    let pixel = Point::new(width * f64::from(i) / 10.0, height * f64::from(j) / 10.0);
                    let direction = lens.direction(pixel).unwrap();
                    assert!(lens.pixel(direction).unwrap().distance(pixel) < 1e-9, "{pixel}");
                }
            }
        }
    }

    #[test]
    fn beyond_where_distortion_turns_back_nothing_is_seen() {
        let lens = Lens { radial: [-0.3, 0.0, 0.0], tangential: [0.0; 2], ..webcam() };
        // 1 − 0.9 r² = 0 at r = 1.054, where the image reaches to 703 px from its centre
        assert!(lens.pixel([1.0, 0.0]).is_some());
        assert_eq!(lens.pixel([1.1, 0.0]), None);
        assert_eq!(lens.direction(Point::new(640.0 + 720.0, 360.0)), None);
    }
}
