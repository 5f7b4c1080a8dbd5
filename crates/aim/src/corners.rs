//! Where a head stands, from the joint angles at which its beam meets the corners of a rectangle.

use nalgebra::{DMatrix, Matrix3, Rotation3, Vector3};
use tracelight_maths::{asin, atan2, powi};
use tracelight_rig::PanTilt;
use tracelight_stroke::{Point, Vec2};

use crate::head::HeadGeometry;
use crate::homography::Homography;
use crate::least_squares::{Normal, Problem, solve};
use crate::pose::HeadPose;

/// How far from a corner somebody points the dot by eye, standard deviation of a coordinate, m.
pub const POINTED_M: f64 = 5e-4;

/// Furthest that corners may be from where the head as found has them, root mean square in deviations of a coordinate.
const MOST_MISFIT: f64 = 6.0;

/// Corners nearer together than that, as a share of the largest distance between two, are one, or lie on one line.
const LEAST_SPREAD: f64 = 0.02;

/// Furthest that a head is looked for, m.
const FURTHEST_M: f64 = 1e3;

/// Why corners do not say where a head stands.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CornersError {
    /// They lie in one place or on one line.
    #[error(
        "seen from the head two of the corners are one, or three lie on one line: point the dot at all four corners again"
    )]
    Degenerate,
    /// They go round the other way.
    #[error(
        "the corners go round the other way than a rectangle's on a wall in front of the head: look whether left and right, or top and bottom, are exchanged"
    )]
    Mirrored,
    /// They cross over.
    #[error("the corners cross over: two that lie side by side are exchanged")]
    Crossed,
    /// No wall has them.
    #[error(
        "the corners fit no rectangle of this size: the nearest leaves them {:.1} mm off, rms; point again, or measure the rectangle: is it {}?",
        1e3 * .rms_m, .hint
    )]
    NoFit {
        /// How far the best is off, m.
        rms_m: f64,
        /// What to look for.
        hint: &'static str,
    },
}

/// A head that was found by the corners of a rectangle.
#[derive(Clone, Debug)]
pub struct CorneredHead {
    /// Where it stands before the middle of the rectangle.
    pub pose: HeadPose,
    /// How far each corner lies from where the head has it, m.
    pub residual_m: [f64; 4],
    /// How unsure distance, place right and up, yaw, pitch and roll are: standard deviations, m and rad.
    pub deviation: [f64; 6],
}

impl CorneredHead {
    /// Root mean square of the residuals, m.
    #[must_use]
    pub fn rms_m(&self) -> f64 {
        rms(&self.residual_m)
    }
}

/// The corners of a rectangle about the target's middle: bottom left, bottom right, top right, top left, m.
#[must_use]
pub fn corners_of((width, height): (f64, f64)) -> [Point; 4] {
    [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| Point::new(x * width, y * height))
}

/// Where a head of known build stands, from the angles at which its beam meets the corners of a rectangle of known size, in the order of [`corners_of`]; their
/// counts are told to `count_rad`. The rectangle's middle is the target's.
///
/// # Errors
/// See [`CornersError`].
pub fn cornered(
    geometry: &HeadGeometry,
    size_m: (f64, f64),
    angles: &[PanTilt<f64>; 4],
    count_rad: f64,
) -> Result<CorneredHead, CornersError> {
    let corners = corners_of(size_m);
    let rays = angles.map(|angle| geometry.ray(angle));
    check_order(&rays)?;
    let start = start(&corners, &rays).ok_or(CornersError::Degenerate)?;
    let far_m = start.distance_m;
    // what somebody points by eye, and what an encoder's count is there
    let deviation_m = (powi(POINTED_M, 2) + powi(far_m * count_rad, 2) / 12.0).sqrt();
    let fit = Fit { geometry, corners: &corners, angles, deviation_m };
    let no_fit = |rms_m: f64| CornersError::NoFit { rms_m, hint: hint(geometry, size_m, angles, rms_m) };
    let (pose, normal) = solve(&fit, start, MOST_STEPS).ok_or_else(|| no_fit(f64::INFINITY))?;
    let residual_m = fit.residual_m(&pose);
    let covariance = normal.covariance().ok_or(CornersError::Degenerate)?;
    let found =
        CorneredHead { pose, residual_m, deviation: deviations(&covariance, &residual_m, deviation_m) };
    let is_sound = (0.0..FURTHEST_M).contains(&pose.distance_m) && found.rms_m().is_finite();
    match is_sound && found.rms_m() <= MOST_MISFIT * deviation_m {
        true => Ok(found),
        false => Err(no_fit(found.rms_m())),
    }
}

fn rms(residual_m: &[f64; 4]) -> f64 {
    (residual_m.iter().map(|r| r * r).sum::<f64>() / 4.0).sqrt()
}

/// Standard deviations of what was found, larger where corners are further off than was taken: they have two equations to spare.
fn deviations(covariance: &DMatrix<f64>, residual_m: &[f64; 4], deviation_m: f64) -> [f64; 6] {
    let squares: f64 = residual_m.iter().map(|r| powi(r / deviation_m, 2)).sum();
    let scatter = (squares / 2.0).sqrt().max(1.0);
    std::array::from_fn(|k| covariance[(k, k)].max(0.0).sqrt() * scatter)
}

/// What may be wrong with corners that do not fit: a rectangle that lies the other way would, or not.
fn hint(
    geometry: &HeadGeometry,
    (width, height): (f64, f64),
    angles: &[PanTilt<f64>; 4],
    rms_m: f64,
) -> &'static str {
    let corners = corners_of((height, width));
    let fit = Fit { geometry, corners: &corners, angles, deviation_m: POINTED_M };
    let lies = start(&corners, &angles.map(|angle| geometry.ray(angle)))
        .and_then(|from| solve(&fit, from, MOST_STEPS));
    let off = lies.map_or(f64::INFINITY, |(pose, _)| rms(&fit.residual_m(&pose)));
    if off < 0.3 * rms_m {
        "as high as you say it is wide, and the other way round"
    } else {
        "square at its corners"
    }
}

/// Refuses rays that go round the wrong way, cross, or lie together.
fn check_order(rays: &[Vector3<f64>; 4]) -> Result<(), CornersError> {
    let far = |a: usize, b: usize| (rays[a] - rays[b]).norm();
    let mut all = (0..4).flat_map(|a| (0..a).map(move |b| (a, b)));
    let largest = all.clone().map(|(a, b)| far(a, b)).fold(0.0, f64::max);
    if largest.is_nan() || largest <= 0.0 || all.any(|(a, b)| far(a, b) < LEAST_SPREAD * largest) {
        return Err(CornersError::Degenerate);
    }
    // the solid angle of three corners, by its sign; seen from the head a wall's corners go round to the left
    let turns: [f64; 4] = std::array::from_fn(|k| {
        let [a, b, c] = [k, (k + 1) % 4, (k + 2) % 4].map(|k| rays[k]);
        a.dot(&b.cross(&c)) / ((b - a).norm() * (c - b).norm())
    });
    match turns.iter().filter(|turn| **turn > 0.0).count() {
        _ if turns.iter().any(|turn| turn.abs() < LEAST_SPREAD) => Err(CornersError::Degenerate),
        0 => Ok(()),
        4 => Err(CornersError::Mirrored),
        _ => Err(CornersError::Crossed),
    }
}

/// About where the head stands: its rays cut by a plane are an image of the rectangle, as a camera's would be (Zhang, *A flexible new technique for camera
/// calibration*, 2000, §3.1).
fn start(corners: &[Point; 4], rays: &[Vector3<f64>; 4]) -> Option<HeadPose> {
    let ahead = rays.iter().sum::<Vector3<f64>>().try_normalize(1e-9)?;
    let turned = Rotation3::rotation_between(&ahead, &Vector3::z())?;
    let mut pairs = [(Point::ORIGIN, Point::ORIGIN); 4];
    for (slot, (corner, ray)) in pairs.iter_mut().zip(corners.iter().zip(rays)) {
        let ray = turned * ray;
        if ray.z < 1e-3 {
            return None;
        }
        *slot = (*corner, Point::new(ray.x / ray.z, ray.y / ray.z));
    }
    let map = *Homography::through(&pairs, 1.0)?.matrix();
    let scale = 0.5 * (map.column(0).norm() + map.column(1).norm());
    let (x, y, at) = (map.column(0) / scale, map.column(1) / scale, map.column(2) / scale);
    // head_from_target, as near to a rotation as can be
    let near = Matrix3::from_columns(&[x, y, x.cross(&y)]).svd(true, true);
    let rotation = near.u? * near.v_t?;
    let back = turned.inverse();
    let head_from_target = back.matrix() * rotation;
    let target = -(head_from_target.transpose() * (back * at.into_owned()));
    Some(pose(&head_from_target.transpose(), target))
}

/// A pose by the rotation and the shift of target_from_head.
fn pose(rotation: &Matrix3<f64>, at: Vector3<f64>) -> HeadPose {
    // back from the square-on exchange of axes, as in `HeadPose::rotation`
    let [y, z, x] = [-rotation.row(0), rotation.row(1).into_owned(), -rotation.row(2)];
    HeadPose {
        distance_m: at.z,
        right_m: at.x,
        up_m: at.y,
        yaw_rad: atan2(y[0], x[0]),
        pitch_rad: -asin(z[0].clamp(-1.0, 1.0)),
        roll_rad: atan2(z[1], z[2]),
    }
}

/// Most steps of the fit.
const MOST_STEPS: usize = 100;

struct Fit<'a> {
    geometry: &'a HeadGeometry,
    corners: &'a [Point; 4],
    angles: &'a [PanTilt<f64>; 4],
    deviation_m: f64,
}

impl Fit<'_> {
    /// How far each corner lies from where a head that stands so has it, m.
    fn residual_m(&self, pose: &HeadPose) -> [f64; 4] {
        std::array::from_fn(|k| {
            let at = self.geometry.spot(pose, self.angles[k]);
            at.map_or(f64::INFINITY, |at| at.distance(self.corners[k]))
        })
    }

    /// How far the beam misses a corner, m, and the derivatives of that by the pose: central differences, whose error is next to nothing.
    fn misses(&self, pose: &HeadPose, k: usize) -> Option<(Vec2, [Vec2; 6])> {
        const STEP: f64 = 1e-6;
        let at = |pose: &HeadPose| self.geometry.spot(pose, self.angles[k]);
        let own = numbers(pose);
        let mut by = [Vec2::ZERO; 6];
        for (i, slot) in by.iter_mut().enumerate() {
            let moved = |step: f64| {
                let mut moved = own;
                moved[i] += step;
                at(&with(moved))
            };
            *slot = (moved(STEP)? - moved(-STEP)?) / (2.0 * STEP);
        }
        Some((self.corners[k] - at(pose)?, by))
    }
}

impl Problem for Fit<'_> {
    type State = HeadPose;

    fn normal(&self, pose: &HeadPose) -> Option<Normal> {
        let mut normal = Normal::zero(6);
        for k in 0..4 {
            let (off, by) = self.misses(pose, k)?;
            let scale = 1.0 / self.deviation_m;
            // there are too few to do without one of them: none counts less for being far off
            normal.add_belief(off.x * scale, by.iter().map(|d| d.x * scale).enumerate());
            normal.add_belief(off.y * scale, by.iter().map(|d| d.y * scale).enumerate());
        }
        Some(normal)
    }

    fn stepped(&self, pose: &HeadPose, step: &[f64]) -> HeadPose {
        let own = numbers(pose);
        with(std::array::from_fn(|k| own[k] + step[k]))
    }
}

const fn numbers(pose: &HeadPose) -> [f64; 6] {
    let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = *pose;
    [distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad]
}

const fn with([distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad]: [f64; 6]) -> HeadPose {
    HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: PanTilt<(f64, f64)> = PanTilt::new((-3.1, 3.1), (-1.6, 1.6));
    const SIZE: (f64, f64) = (2.4, 1.2);
    const COUNT_RAD: f64 = std::f64::consts::TAU / 4096.0;

    fn geometry() -> HeadGeometry {
        HeadGeometry { laser_offset_m: [0.0, 0.02, 0.035], ..HeadGeometry::centred(WIDE) }
    }

    fn dice(seed: u128) -> impl FnMut(f64) -> f64 {
        let mut dice = oorandom::Rand64::new(seed);
        move |most| most * (2.0 * dice.rand_float() - 1.0)
    }

    fn drawn(seed: u128) -> HeadPose {
        let mut even = dice(seed);
        HeadPose {
            distance_m: 2.6 + even(0.8),
            right_m: even(0.9),
            up_m: even(0.5),
            yaw_rad: even(0.3),
            pitch_rad: even(0.2),
            roll_rad: even(0.1),
        }
    }

    fn pointed(pose: &HeadPose, off_m: impl FnMut() -> f64) -> [PanTilt<f64>; 4] {
        let mut off_m = off_m;
        corners_of(SIZE).map(|corner| {
            let at = corner + Vec2::new(off_m(), off_m());
            geometry().angles(pose, at).unwrap()
        })
    }

    #[test]
    fn exact_angles_give_the_pose_back() {
        for seed in 0..200 {
            let truth = drawn(seed);
            let found = cornered(&geometry(), SIZE, &pointed(&truth, || 0.0), COUNT_RAD).unwrap();
            for (a, b) in numbers(&found.pose).into_iter().zip(numbers(&truth)) {
                assert!((a - b).abs() < 1e-6, "{seed}: {:?} {truth:?}", found.pose);
            }
            assert!(found.rms_m() < 1e-6);
        }
    }

    #[test]
    fn what_is_told_of_the_pose_is_how_far_it_is_off() {
        let runs = 400;
        let (mut off, mut told) = ([0.0; 6], [0.0; 6]);
        let mut spots = Vec::new();
        for seed in 0..runs {
            let truth = drawn(seed);
            let mut even = dice(seed + 1000);
            let angles = pointed(&truth, || even(3_f64.sqrt() * POINTED_M))
                .map(|angle| PanTilt::from_fn(|joint| (angle[joint] / COUNT_RAD).round() * COUNT_RAD));
            let found = cornered(&geometry(), SIZE, &angles, COUNT_RAD).unwrap();
            let (a, b) = (numbers(&found.pose), numbers(&truth));
            for k in 0..6 {
                off[k] += powi(a[k] - b[k], 2);
                told[k] += powi(found.deviation[k], 2);
            }
            // a figure drawn within the rectangle
            for (x, y) in [(0.0, 0.0), (-1.0, 0.4), (0.8, -0.5), (0.3, 0.2)] {
                let angle = geometry().angles(&found.pose, Point::new(x, y)).unwrap();
                spots.push(1e3 * geometry().spot(&truth, angle).unwrap().distance(Point::new(x, y)));
            }
        }
        for k in 0..6 {
            let ratio = (told[k] / off[k]).sqrt();
            println!("parameter {k}: off by {:.2e}", (off[k] / runs as f64).sqrt());
            assert!((0.8..1.5).contains(&ratio), "{k}: told/off {ratio}");
        }
        spots.sort_by(f64::total_cmp);
        let (median, worst) = (spots[spots.len() / 2], spots[spots.len() - 1]);
        println!("spots within the rectangle: median {median:.2} mm, worst {worst:.2} mm off");
        // a count is 4 mm long at this distance: that is most of it
        assert!(median < 1.5 && worst < 6.0, "{median} {worst}");
    }

    #[test]
    fn corners_that_are_no_rectangle_are_refused() {
        let good = pointed(&drawn(3), || 0.0);
        let refused =
            |order: [usize; 4]| cornered(&geometry(), SIZE, &order.map(|k| good[k]), COUNT_RAD).unwrap_err();
        assert_eq!(refused([1, 0, 3, 2]), CornersError::Mirrored);
        assert_eq!(refused([3, 2, 1, 0]), CornersError::Mirrored);
        assert_eq!(refused([0, 2, 1, 3]), CornersError::Crossed);
        assert_eq!(refused([0, 0, 2, 3]), CornersError::Degenerate);
        let mut line = good;
        line[1] = PanTilt::from_fn(|joint| 0.5 * (good[0][joint] + good[2][joint]));
        assert!(cornered(&geometry(), SIZE, &line, COUNT_RAD).is_err());
        // as wide as it is high
        let error = cornered(&geometry(), (SIZE.1, SIZE.0), &good, COUNT_RAD).unwrap_err();
        assert!(
            matches!(error, CornersError::NoFit { hint, .. } if hint.contains("other way round")),
            "{error}"
        );
        let mut off = good;
        off[2].pan += 0.05;
        assert!(matches!(
            cornered(&geometry(), SIZE, &off, COUNT_RAD).unwrap_err(),
            CornersError::NoFit { .. }
        ));
    }
}
