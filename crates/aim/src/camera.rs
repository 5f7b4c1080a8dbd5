use nalgebra::{Matrix2, Matrix3, Rotation3, Vector3};
use tracelight_maths::atan2;
use tracelight_stroke::{Affine, Point, Vec2};

use crate::jet::Scalar;
use crate::lens::{LENS_PARAMETERS, Lens, distorted};

/// Where a camera stands in front of the target: camera_from_target. The camera frame has x right, y down, z ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    pub(crate) rotation: Rotation3<f64>,
    pub(crate) translation_m: Vector3<f64>,
}

/// Number of a pose's parameters: a small turn, and the translation.
pub(crate) const POSE_PARAMETERS: usize = 6;

impl CameraPose {
    /// At a place in the target frame, m, its axis on another, no side of the image leaning: its x is level with the target's.
    /// `None` if it looks along the target's y, or at where it stands.
    pub fn looking_at(from_m: [f64; 3], at_m: [f64; 3]) -> Option<Self> {
        let (from, at) = (Vector3::from(from_m), Vector3::from(at_m));
        let ahead = (at - from).try_normalize(1e-9)?;
        let right = ahead.cross(&Vector3::y()).try_normalize(1e-9)?;
        let down = ahead.cross(&right);
        let rows = Matrix3::from_rows(&[right.transpose(), down.transpose(), ahead.transpose()]);
        let rotation = Rotation3::from_matrix_unchecked(rows);
        Some(Self { rotation, translation_m: -(rotation * from) })
    }

    /// From a turn about an axis, rad along it, after which the translation follows, m.
    pub fn new(turn_rad: [f64; 3], translation_m: [f64; 3]) -> Self {
        Self { rotation: Rotation3::new(Vector3::from(turn_rad)), translation_m: translation_m.into() }
    }

    /// The turn about an axis, rad along it.
    pub fn turn_rad(&self) -> [f64; 3] {
        self.rotation.scaled_axis().into()
    }

    /// The translation that follows, m.
    pub fn translation_m(&self) -> [f64; 3] {
        self.translation_m.into()
    }

    /// Where the camera is, target frame, m.
    pub fn place_m(&self) -> [f64; 3] {
        (-(self.rotation.inverse() * self.translation_m)).into()
    }

    /// Expresses the camera in another frame on the target plane; `frame_from_target` is a rotation and a translation.
    #[must_use]
    pub fn in_frame(&self, frame_from_target: Affine) -> Self {
        let [a, b, _, _, x, y] = frame_from_target.as_coeffs();
        let rotation = self.rotation * Rotation3::from_axis_angle(&Vector3::z_axis(), -atan2(b, a));
        Self { rotation, translation_m: self.translation_m - rotation * Vector3::new(x, y, 0.0) }
    }

    /// Turned about the camera's own axes by rad, then moved along them by m.
    #[must_use]
    pub fn moved(&self, turn_rad: [f64; 3], by_m: [f64; 3]) -> Self {
        let turn = Rotation3::new(Vector3::from(turn_rad));
        Self {
            rotation: turn * self.rotation,
            translation_m: turn * self.translation_m + Vector3::from(by_m),
        }
    }

    /// Applies a step of the survey: a rotation, rad, and a change of the translation, m.
    pub(crate) fn stepped(&self, step: [f64; POSE_PARAMETERS]) -> Self {
        let [a, b, c, x, y, z] = step;
        Self {
            rotation: Rotation3::new(Vector3::new(a, b, c)) * self.rotation,
            translation_m: self.translation_m + Vector3::new(x, y, z),
        }
    }

    /// A place in the target frame as the camera has it, m, after such a step.
    pub(crate) fn seen<S: Scalar>(&self, step: [S; POSE_PARAMETERS], place_m: [S; 3]) -> [S; 3] {
        let rows = self.rotation.matrix();
        let turned: [S; 3] = std::array::from_fn(|i| {
            S::constant(rows[(i, 0)]) * place_m[0]
                + S::constant(rows[(i, 1)]) * place_m[1]
                + S::constant(rows[(i, 2)]) * place_m[2]
        });
        let [a, b, c, x, y, z] = step;
        // to first order in the turn: its derivatives at zero are exact
        let [p, q, r] = turned;
        let t = self.translation_m;
        [
            p + b * r - c * q + x + S::constant(t.x),
            q + c * p - a * r + y + S::constant(t.y),
            r + a * q - b * p + z + S::constant(t.z),
        ]
    }
}

/// A camera in front of the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Its lens and sensor.
    pub lens: Lens,
    /// Where it stands.
    pub pose: CameraPose,
}

/// Number of a camera's parameters: those of its pose, then those of its lens.
pub(crate) const CAMERA_PARAMETERS: usize = POSE_PARAMETERS + LENS_PARAMETERS;

/// A place with its covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uncertain {
    /// Where.
    pub at: Point,
    /// Covariance of x and y, in the square of the place's unit.
    pub covariance: Matrix2<f64>,
}

impl Uncertain {
    /// Root of the mean squared distance.
    pub fn deviation(&self) -> f64 {
        self.covariance.trace().max(0.0).sqrt()
    }
}

impl Camera {
    /// Projects a point of the target to the pixel frame, px, inside the image or not; `None` for a point behind the camera.
    pub fn pixel(&self, on_target: Point) -> Option<Point> {
        self.pixel_of([on_target.x, on_target.y, 0.0])
    }

    /// Where a place in the target frame is seen, px; `None` of what is behind the camera.
    pub fn pixel_of(&self, place_m: [f64; 3]) -> Option<Point> {
        let [x, y, z] = self.pose.seen([0.0; POSE_PARAMETERS], place_m);
        (z > 1e-9).then(|| self.lens.pixel([x / z, y / z]))?
    }

    /// The point of the target that is seen at a pixel, m; `None` where no target is.
    pub fn target(&self, pixel: Point) -> Option<Point> {
        let [x, y] = self.lens.direction(pixel)?;
        let back = self.pose.rotation.inverse();
        let (from, ray) = (-(back * self.pose.translation_m), back * Vector3::new(x, y, 1.0));
        let range = -from.z / ray.z;
        (range.is_finite() && range > 0.0).then(|| Point::new(from.x + range * ray.x, from.y + range * ray.y))
    }

    /// Derivatives of a pixel by the point of the target that is seen there, px/m: columns by x and y.
    pub fn pixels_per_metre(&self, on_target: Point) -> Option<[Vec2; 2]> {
        let (_, by_point, _) = self.derivatives(on_target)?;
        Some([0, 1].map(|k| Vec2::new(by_point[(0, k)], by_point[(1, k)])))
    }

    /// How large the target is seen at a point of it, px/m: the root of by how much areas are.
    pub fn scale(&self, on_target: Point) -> Option<f64> {
        let [x, y] = self.pixels_per_metre(on_target)?;
        Some(x.cross(y).abs().sqrt())
    }

    /// Whether a pixel is within the image.
    pub fn is_in_sight(&self, pixel: Point) -> bool {
        let [width, height] = self.lens.size_px.map(|n| n as f64);
        (0.0..=width).contains(&pixel.x) && (0.0..=height).contains(&pixel.y)
    }

    /// The pixel of a point of the target, its derivatives by the point, px/m, and by the camera's parameters.
    pub(crate) fn derivatives(
        &self,
        on_target: Point,
    ) -> Option<(Point, Matrix2<f64>, [[f64; CAMERA_PARAMETERS]; 2])> {
        use crate::dual::Dual;
        const ALL: usize = CAMERA_PARAMETERS + 2;
        self.pixel(on_target)?;
        let step = std::array::from_fn(|k| Dual::<ALL>::parameter(0.0, k));
        let lens = self.lens.parameters();
        let lens = std::array::from_fn(|k| Dual::<ALL>::parameter(lens[k], POSE_PARAMETERS + k));
        let place = [
            Dual::parameter(on_target.x, CAMERA_PARAMETERS),
            Dual::parameter(on_target.y, CAMERA_PARAMETERS + 1),
            Dual::constant(0.0),
        ];
        let [x, y, z] = self.pose.seen(step, place);
        let [u, v] = distorted(lens, [x / z, y / z]);
        let by = |d: &[f64; ALL]| std::array::from_fn(|k| d[k]);
        let point = |d: &[f64; ALL]| [d[CAMERA_PARAMETERS], d[CAMERA_PARAMETERS + 1]];
        let ([ux, uy], [vx, vy]) = (point(&u.by), point(&v.by));
        Some((Point::new(u.value, v.value), Matrix2::new(ux, uy, vx, vy), [by(&u.by), by(&v.by)]))
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use super::*;

    fn skew() -> Camera {
        let pose = CameraPose::looking_at([0.4, -0.2, 1.3], [0.02, 0.03, 0.0]).unwrap();
        let lens =
            Lens { radial: [-0.1, 0.01, 0.0], tangential: [3e-4, 2e-4], ..Lens::ideal(1280, 720, 1000.0) };
        Camera { lens, pose: pose.moved([0.0, 0.0, 0.1], [0.0; 3]) }
    }

    #[test]
    fn a_camera_in_front_of_the_target_sees_its_right_on_the_right_and_its_top_above() {
        let pose = CameraPose::looking_at([0.0, 0.0, 1.0], [0.0; 3]).unwrap();
        let camera = Camera { lens: Lens::ideal(640, 480, 500.0), pose };
        assert!(camera.pixel(Point::ORIGIN).unwrap().distance(Point::new(320.0, 240.0)) < 1e-9);
        assert!(camera.pixel(Point::new(0.1, 0.2)).unwrap().distance(Point::new(370.0, 140.0)) < 1e-9);
        assert_eq!(camera.pixel_of([0.0, 0.0, 2.0]), None);
    }

    #[test]
    fn pixel_to_target_and_back_agree() {
        let camera = skew();
        for i in 0..=8 {
            for j in 0..=8 {
                let pixel = Point::new(160.0 * f64::from(i), 90.0 * f64::from(j));
                let on_target = camera.target(pixel).unwrap();
                assert!(camera.pixel(on_target).unwrap().distance(pixel) < 1e-9);
            }
        }
    }

    #[test]
    fn derivatives_match_differences() {
        let camera = skew();
        let at = Point::new(0.21, -0.13);
        let (_, by_point, by_camera) = camera.derivatives(at).unwrap();
        let h = 1e-6;
        for (k, e) in [Vec2::new(h, 0.0), Vec2::new(0.0, h)].into_iter().enumerate() {
            let slope = (camera.pixel(at + e).unwrap() - camera.pixel(at - e).unwrap()) / (2.0 * h);
            assert!((slope - Vec2::new(by_point[(0, k)], by_point[(1, k)])).hypot() < 1e-4);
            assert!((slope - camera.pixels_per_metre(at).unwrap()[k]).hypot() < 1e-4);
        }
        for k in 0..CAMERA_PARAMETERS {
            let moved = |by: f64| {
                let mut pose = [0.0; POSE_PARAMETERS];
                let mut lens = camera.lens.parameters();
                if k < POSE_PARAMETERS {
                    pose[k] = by
                } else {
                    lens[k - POSE_PARAMETERS] += by
                }
                let camera = Camera { lens: camera.lens.with(lens), pose: camera.pose.stepped(pose) };
                camera.pixel(at).unwrap()
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            let off = (slope - Vec2::new(by_camera[0][k], by_camera[1][k])).hypot();
            assert!(off < 1e-4 * (1.0 + slope.hypot()), "{k}: {off}");
        }
    }

    #[test]
    fn in_another_frame_a_place_is_seen_at_the_same_pixel() {
        let frame = planar::rotation(0.7).then_translate(Vec2::new(0.3, -0.1));
        let moved = Camera { pose: skew().pose.in_frame(frame), ..skew() };
        for at in [Point::ORIGIN, Point::new(0.2, -0.1)] {
            assert!(skew().pixel(at).unwrap().distance(moved.pixel(frame * at).unwrap()) < 1e-9);
        }
    }

    #[test]
    fn a_pose_is_told_by_six_numbers() {
        let pose = skew().pose;
        let again = CameraPose::new(pose.turn_rad(), pose.translation_m());
        assert!((again.rotation.matrix() - pose.rotation.matrix()).norm() < 1e-12);
        let [x, y, z] = pose.place_m();
        assert!((x - 0.4).hypot(y + 0.2).hypot(z - 1.3) < 1e-12);
    }
}
