//! Parametrization of the steps of a survey.
//!
//! Of a plane seen from straight ahead nothing tells the focal length: with a longer one, from further away, leaning more, all places stay
//! where they are in the image. A step along the focal length's coordinate therefore takes along what keeps them there, so that this valley
//! is straight, however long, and no other coordinate needs to move in it.

use nalgebra::{Rotation3, SMatrix, Unit, Vector3};
use tracelight_maths::{atan2, cos, exp, powi, sin};

use crate::camera::{CAMERA_PARAMETERS, CameraPose, POSE_PARAMETERS};
use crate::lens::LENS_PARAMETERS;

/// How a lens's parameters go with its focal lengths where the image does not change: by which power. A direction is a pixel over the focal
/// length, so that distortion by its n-th power goes with the n-th.
const POWERS: [i32; LENS_PARAMETERS] = [1, 1, 0, 0, 2, 4, 1, 1, 6];

/// Coordinate of the focal lengths' logarithm, and of the second's over the first's.
const FOCAL: usize = 0;
const ASPECT: usize = 1;

/// A lens's parameters after a step of its coordinates.
pub(super) fn stepped_lens(lens: &[f64; LENS_PARAMETERS], step: &[f64]) -> [f64; LENS_PARAMETERS] {
    let longer = exp(step[FOCAL]);
    std::array::from_fn(|k| {
        let moved = match k {
            FOCAL => lens[k],
            ASPECT => lens[k] * exp(step[ASPECT]),
            k => lens[k] + step[k],
        };
        moved * powi(longer, POWERS[k])
    })
}

/// The derivatives of a lens's parameters by its coordinates, of focal lengths' logarithms instead of themselves.
pub(super) fn lens_by_coordinates(
    lens: &[f64; LENS_PARAMETERS],
) -> SMatrix<f64, LENS_PARAMETERS, LENS_PARAMETERS> {
    let mut by = SMatrix::identity();
    for (k, value) in lens.iter().enumerate() {
        by[(k, FOCAL)] = if k <= ASPECT { 1.0 } else { f64::from(POWERS[k]) * value };
    }
    by
}

/// A pose after a step of its own coordinates, a small turn and a change of the translation, and of the focal length's.
pub(super) fn stepped_pose(pose: &CameraPose, step: [f64; POSE_PARAMETERS], lens_step: &[f64]) -> CameraPose {
    let longer = exp(lens_step[FOCAL]);
    let (axis, lean) = leans(pose);
    // what an image has of a lean is its tangent over the focal length
    let more = atan2(longer * sin(lean), cos(lean)) - lean;
    let turn = axis.map_or_else(Rotation3::identity, |axis| Rotation3::from_axis_angle(&axis, more));
    let moved = pose.stepped(step);
    let further = Vector3::new(1.0, 1.0, longer);
    CameraPose { rotation: turn * moved.rotation, translation_m: moved.translation_m.component_mul(&further) }
}

/// About which axis the target's plane is turned out of the image's, and by how much, rad.
fn leans(pose: &CameraPose) -> (Option<Unit<Vector3<f64>>>, f64) {
    let normal = pose.rotation * Vector3::z();
    // towards the camera is behind the image
    let normal = if normal.z > 0.0 { normal } else { -normal };
    let axis = Vector3::z().cross(&normal);
    (Unit::try_new(axis, 1e-12), atan2(axis.norm(), normal.z))
}

/// The derivatives of a camera's parameters by these coordinates: pose, then lens.
pub(super) struct Slopes {
    /// Of the pose by the focal length's coordinate.
    pose_by_focal: [f64; POSE_PARAMETERS],
    lens: [f64; LENS_PARAMETERS],
}

impl Slopes {
    pub(super) fn of(pose: &CameraPose, lens: &[f64; LENS_PARAMETERS]) -> Self {
        let (axis, lean) = leans(pose);
        let turn = axis.map_or_else(Vector3::zeros, |axis| axis.into_inner() * (sin(lean) * cos(lean)));
        Self { pose_by_focal: [turn.x, turn.y, turn.z, 0.0, 0.0, pose.translation_m.z], lens: *lens }
    }

    /// What something's derivatives by a camera's parameters, at the front, are by the coordinates; others behind stay.
    pub(super) fn carry<const N: usize>(&self, by: &[f64; N]) -> [f64; N] {
        let mut out = *by;
        let focal = POSE_PARAMETERS + FOCAL;
        let along_pose: f64 = self.pose_by_focal.iter().zip(by).map(|(slope, by)| slope * by).sum();
        let of_lens = POWERS.iter().zip(&self.lens).zip(&by[POSE_PARAMETERS..CAMERA_PARAMETERS]);
        let along_lens: f64 = of_lens.map(|((power, value), by)| f64::from(*power) * value * by).sum();
        out[focal] = along_pose + along_lens;
        out[POSE_PARAMETERS + ASPECT] *= self.lens[ASPECT];
        out
    }

    /// The derivatives themselves.
    pub(super) fn matrix(&self) -> SMatrix<f64, CAMERA_PARAMETERS, CAMERA_PARAMETERS> {
        let mut all = SMatrix::zeros();
        for row in 0..CAMERA_PARAMETERS {
            let own: [f64; CAMERA_PARAMETERS] = std::array::from_fn(|k| f64::from(u8::from(k == row)));
            for (k, by) in self.carry(&own).into_iter().enumerate() {
                all[(row, k)] = by;
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use crate::lens::Lens;
    use tracelight_stroke::Point;

    fn camera() -> Camera {
        let pose = CameraPose::looking_at([0.3, -0.2, 1.3], [0.02, 0.03, 0.0]).unwrap();
        let lens =
            Lens { radial: [-0.1, 0.02, 0.003], tangential: [3e-4, 2e-4], ..Lens::ideal(1280, 720, 1000.0) };
        Camera { lens, pose }
    }

    fn stepped(camera: &Camera, step: &[f64; CAMERA_PARAMETERS]) -> Camera {
        let (pose, lens) = step.split_at(POSE_PARAMETERS);
        Camera {
            lens: camera.lens.with(stepped_lens(&camera.lens.parameters(), lens)),
            pose: stepped_pose(&camera.pose, std::array::from_fn(|k| pose[k]), lens),
        }
    }

    #[test]
    fn derivatives_by_the_coordinates_match_differences() {
        let camera = camera();
        let slopes = Slopes::of(&camera.pose, &camera.lens.parameters());
        let at = Point::new(0.21, -0.13);
        let (_, _, [u, v]) = camera.derivatives(at).unwrap();
        let [u, v] = [u, v].map(|by| slopes.carry(&by));
        let h = 1e-6;
        for k in 0..CAMERA_PARAMETERS {
            let moved = |by: f64| {
                let step = std::array::from_fn(|j| if j == k { by } else { 0.0 });
                stepped(&camera, &step).pixel(at).unwrap()
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            let off = (slope.x - u[k]).hypot(slope.y - v[k]);
            assert!(off < 1e-4 * (1.0 + slope.hypot()), "{k}: {off}");
        }
    }

    #[test]
    fn a_longer_lens_from_further_away_sees_a_plane_ahead_as_before() {
        let pose = CameraPose::looking_at([0.02, -0.02, 1.3], [0.0, 0.0, 0.0]).unwrap();
        let camera = Camera { pose, ..camera() };
        let mut step = [0.0; CAMERA_PARAMETERS];
        step[POSE_PARAMETERS + FOCAL] = 0.3;
        let longer = stepped(&camera, &step);
        assert!((longer.lens.focal_px[0] / 1000.0 - f64::exp(0.3)).abs() < 1e-12);
        for at in [(0.0, 0.0), (0.5, 0.3), (-0.5, 0.2), (0.4, -0.3)].map(Point::from) {
            let off = camera.pixel(at).unwrap().distance(longer.pixel(at).unwrap());
            // a lean of 1.2° shortens by 2e-4, one of 1.6° by 4e-4
            assert!(off < 0.2, "{off} px");
        }
    }
}
