use nalgebra::Vector3;
use tracelight_maths::{atan2, hypot, sin_cos};
use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::{Point, Vec2};

use crate::jet::{Jet, Scalar};
use crate::pose::HeadPose;

/// The head as the beam sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadGeometry {
    /// Where the beam leaves, in the tilt body's frame, m: forward, left, up of the crossing of the axes.
    pub laser_offset_m: [f64; 3],
    /// How far the beam points to the left of the tilt body's x, and below it, rad.
    pub beam_off_rad: [f64; 2],
    /// How far the axes are from square, rad: with pan at zero the left end of the tilt axis is that much higher.
    pub axis_skew_rad: f64,
    /// Angles each joint can take, rad: lowest and highest.
    pub range_rad: PanTilt<(f64, f64)>,
}

/// Why a point of the target cannot be lit.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum AimError {
    /// The beam never meets the point.
    #[error("no pan and tilt bring the beam to ({:.4} m, {:.4} m): it is beside or behind the head", .0.x, .0.y)]
    Unreachable(Point),
    /// The beam would graze the target.
    #[error(
        "the beam would meet ({:.4} m, {:.4} m) at {:.1}° from the target's normal, more than {:.0}°: the spot would \
         be a streak", .point.x, .point.y, .incidence_rad.to_degrees(), GRAZING_RAD.to_degrees()
    )]
    Grazing {
        /// The point asked for, target frame, m.
        point: Point,
        /// Angle between the beam and the target's normal.
        incidence_rad: f64,
    },
    /// A joint would have to leave its range.
    #[error(
        "({:.4} m, {:.4} m) needs {joint} at {:.2}°, its range is {:.2}° to {:.2}°",
        .point.x, .point.y, .angle_rad.to_degrees(), .lower_rad.to_degrees(), .upper_rad.to_degrees()
    )]
    BeyondLimit {
        /// The point asked for, target frame, m.
        point: Point,
        /// Which joint.
        joint: Joint,
        /// Angle it would need.
        angle_rad: f64,
        /// Its lowest angle.
        lower_rad: f64,
        /// Its highest angle.
        upper_rad: f64,
    },
}

/// A place on the target with the motion of the spot there, by some parameter (time, or arc length).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotMotion {
    /// Where, m.
    pub point: Point,
    /// First derivative.
    pub velocity: Vec2,
    /// Second derivative.
    pub acceleration: Vec2,
}

/// Steepest angle to the target's normal at which a spot is still a spot: 80°, where it is six times as long as wide.
const GRAZING_RAD: f64 = 80.0 * std::f64::consts::PI / 180.0;

/// Joint angles and their derivatives by the same parameter as the [`SpotMotion`] they come from.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointPath {
    /// Angles, rad.
    pub angle_rad: PanTilt<f64>,
    /// First derivative.
    pub first: PanTilt<f64>,
    /// Second derivative.
    pub second: PanTilt<f64>,
}

impl HeadGeometry {
    /// The beam from the crossing of the axes, along x; the axes at right angles.
    pub const fn centred(range_rad: PanTilt<(f64, f64)>) -> Self {
        Self { laser_offset_m: [0.0; 3], beam_off_rad: [0.0; 2], axis_skew_rad: 0.0, range_rad }
    }

    fn is_centred(&self) -> bool {
        *self == Self::centred(self.range_rad)
    }

    /// Where the beam meets the target plane, m; `None` when it points away from it or along it.
    pub fn spot(&self, pose: &HeadPose, angle_rad: PanTilt<f64>) -> Option<Point> {
        let [x, y] = self.meet(pose, angle_rad)?;
        Some(Point::new(x, y))
    }

    /// Joint angles that bring the beam to `point`, within the joints' ranges.
    ///
    /// Closed form for a centred laser; Newton's method from there with exact derivatives otherwise.
    pub fn angles(&self, pose: &HeadPose, point: Point) -> Result<PanTilt<f64>, AimError> {
        let mut angle = first_guess(pose, point).ok_or(AimError::Unreachable(point))?;
        check_incidence(pose, point)?;
        if !self.is_centred() {
            angle = self.refine(pose, point, angle).ok_or(AimError::Unreachable(point))?;
        }
        self.check_range(point, angle)?;
        Ok(angle)
    }

    /// Joint angles for a spot in motion, with exact first and second derivatives.
    ///
    /// J q′ = p′ and J q″ = p″ − J′q′: the Jacobian's columns and J′q′ come from forward kinematics on jets.
    pub fn motion(&self, pose: &HeadPose, spot: &SpotMotion) -> Result<JointPath, AimError> {
        let angle_rad = self.angles(pose, spot.point)?;
        let lost = AimError::Unreachable(spot.point);
        let jacobian = self.jacobian(pose, angle_rad).ok_or(lost)?;
        let first = solve(jacobian, spot.velocity).ok_or(lost)?;
        let along = self.meet(pose, jets(angle_rad, first)).ok_or(lost)?;
        let turning = Vec2::new(along[0].second, along[1].second);
        let second = solve(jacobian, spot.acceleration - turning).ok_or(lost)?;
        Ok(JointPath { angle_rad, first, second })
    }

    /// Columns ∂p/∂pan and ∂p/∂tilt of the spot, m/rad.
    pub fn jacobian(&self, pose: &HeadPose, angle_rad: PanTilt<f64>) -> Option<[Vec2; 2]> {
        let pan = self.meet(pose, jets(angle_rad, PanTilt::new(1.0, 0.0)))?;
        let tilt = self.meet(pose, jets(angle_rad, PanTilt::new(0.0, 1.0)))?;
        Some([Vec2::new(pan[0].first, pan[1].first), Vec2::new(tilt[0].first, tilt[1].first)])
    }

    /// The beam in the tilt body's frame.
    fn beam(&self) -> [f64; 3] {
        let [(sl, cl), (sd, cd)] = self.beam_off_rad.map(sin_cos);
        [cl * cd, sl * cd, -sd]
    }

    /// Which way the beam goes in the head's frame.
    pub(crate) fn ray(&self, angle: PanTilt<f64>) -> Vector3<f64> {
        Vector3::from(self.turns(angle)(self.beam()))
    }

    /// From the tilt body's frame to the head's: Rz(pan) Rx(skew) Ry(tilt).
    fn turns<S: Scalar + Value>(&self, angle: PanTilt<S>) -> impl Fn([f64; 3]) -> [S; 3] {
        let (s1, c1) = angle.pan.sin_cos();
        let (s2, c2) = angle.tilt.sin_cos();
        let square = self.axis_skew_rad == 0.0;
        let (skew_sin, skew_cos) = sin_cos(self.axis_skew_rad);
        let (skew_sin, skew_cos) = (S::constant(skew_sin), S::constant(skew_cos));
        move |[x, y, z]: [f64; 3]| {
            let (x, y, z) = (S::constant(x), S::constant(y), S::constant(z));
            let (forward, up) = (c2 * x + s2 * z, c2 * z - s2 * x);
            let (left, up) =
                if square { (y, up) } else { (skew_cos * y - skew_sin * up, skew_sin * y + skew_cos * up) };
            [c1 * forward - s1 * left, s1 * forward + c1 * left, up]
        }
    }

    /// Forward kinematics: the ray from the laser, cut with the target plane z = 0.
    fn meet<S: Scalar + Value>(&self, pose: &HeadPose, angle: PanTilt<S>) -> Option<[S; 2]> {
        let [direction, origin] = [self.beam(), self.laser_offset_m].map(self.turns(angle));
        let rows = pose.rotation().map(|r| r.map(S::constant));
        let across = |v: [S; 3]| rows.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2]);
        let (direction, origin) = (across(direction), across(origin));
        let [x0, y0, z0] = pose.translation().map(S::constant);
        let range = -(origin[2] + z0) / direction[2];
        // a beam nearly along the plane would light a point kilometres away: that is away from it
        let forward = direction[2].value() < -1e-6 && range.value() > 0.0;
        forward.then(|| [origin[0] + x0 + range * direction[0], origin[1] + y0 + range * direction[1]])
    }

    fn refine(&self, pose: &HeadPose, point: Point, from: PanTilt<f64>) -> Option<PanTilt<f64>> {
        let mut angle = from;
        // converges quadratically: four steps from centimetres to 1e-16 rad, the rest is margin
        for _ in 0..12 {
            let miss = point - self.spot(pose, angle)?;
            let step = solve(self.jacobian(pose, angle)?, miss)?;
            angle = PanTilt::new(angle.pan + step.pan, angle.tilt + step.tilt);
            if step.pan.abs() + step.tilt.abs() < 1e-15 {
                break;
            }
        }
        let close = (self.spot(pose, angle)? - point).hypot() < 1e-9 * (1.0 + point.to_vec2().hypot());
        close.then_some(angle)
    }

    fn check_range(&self, point: Point, angle: PanTilt<f64>) -> Result<(), AimError> {
        for joint in Joint::BOTH {
            let (lower_rad, upper_rad) = self.range_rad[joint];
            if !(lower_rad <= angle[joint] && angle[joint] <= upper_rad) {
                return Err(AimError::BeyondLimit {
                    point,
                    joint,
                    angle_rad: angle[joint],
                    lower_rad,
                    upper_rad,
                });
            }
        }
        Ok(())
    }
}

/// The number without its derivatives.
trait Value {
    fn value(&self) -> f64;
}

impl Value for f64 {
    fn value(&self) -> f64 {
        *self
    }
}

impl Value for Jet {
    fn value(&self) -> f64 {
        self.value
    }
}

fn jets(angle: PanTilt<f64>, rate: PanTilt<f64>) -> PanTilt<Jet> {
    PanTilt::new(Jet::new(angle.pan, rate.pan, 0.0), Jet::new(angle.tilt, rate.tilt, 0.0))
}

/// From the crossing of the axes: the laser's own offset changes this by the angle it is seen under.
fn check_incidence(pose: &HeadPose, point: Point) -> Result<(), AimError> {
    let [x, y, z] = pose.translation();
    let incidence_rad = atan2(hypot(point.x - x, point.y - y), z);
    if incidence_rad <= GRAZING_RAD { Ok(()) } else { Err(AimError::Grazing { point, incidence_rad }) }
}

/// Exact angles for a laser on the crossing of the axes.
fn first_guess(pose: &HeadPose, point: Point) -> Option<PanTilt<f64>> {
    let [x0, y0, z0] = pose.translation();
    let to = [point.x - x0, point.y - y0, -z0];
    let rows = pose.rotation();
    let [x, y, z] = [0, 1, 2].map(|i| rows[0][i] * to[0] + rows[1][i] * to[1] + rows[2][i] * to[2]);
    let level = hypot(x, y);
    (z0 > 0.0 && level > 0.0 && level.is_finite()).then(|| PanTilt::new(atan2(y, x), atan2(-z, level)))
}

/// Solves [a b] q = v for the two columns a, b.
fn solve([a, b]: [Vec2; 2], v: Vec2) -> Option<PanTilt<f64>> {
    let det = a.cross(b);
    let q = PanTilt::new(v.cross(b) / det, a.cross(v) / det);
    (q.pan.is_finite() && q.tilt.is_finite()).then_some(q)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: PanTilt<(f64, f64)> = PanTilt::new((-3.1, 3.1), (-1.6, 1.6));

    fn heads() -> [(HeadGeometry, HeadPose); 4] {
        let skew = HeadPose {
            distance_m: 1.3,
            right_m: 0.1,
            up_m: -0.2,
            yaw_rad: 0.1,
            pitch_rad: -0.07,
            roll_rad: 0.05,
        };
        let centred = HeadGeometry::centred(WIDE);
        let offset = HeadGeometry { laser_offset_m: [0.03, 0.01, 0.025], ..centred };
        let crooked = HeadGeometry { beam_off_rad: [0.02, -0.03], axis_skew_rad: 0.015, ..offset };
        [
            (centred, HeadPose::square_on(0.9144)),
            (offset, HeadPose::square_on(0.9144)),
            (offset, skew),
            (crooked, skew),
        ]
    }

    #[test]
    fn square_on_the_signs_are_those_of_the_contract() {
        let (head, pose) = heads()[0];
        let (pan, tilt) = (0.2_f64, 0.3_f64);
        let spot = head.spot(&pose, PanTilt::new(pan, tilt)).unwrap();
        assert!((spot.x + 0.9144 * pan.tan()).abs() < 1e-15);
        assert!((spot.y + 0.9144 * tilt.tan() / pan.cos()).abs() < 1e-15);
    }

    #[test]
    fn angles_to_spot_and_back_agree_to_a_picoradian() {
        for (head, pose) in heads() {
            for i in -19..=19 {
                for j in -19..=19 {
                    let asked = PanTilt::new(f64::from(i) * 0.05, f64::from(j) * 0.05);
                    let Some(point) = head.spot(&pose, asked) else { continue };
                    let got = head.angles(&pose, point).unwrap();
                    let off = (got.pan - asked.pan).abs().max((got.tilt - asked.tilt).abs());
                    assert!(off <= 1e-12, "{asked:?}: {off:e}");
                }
            }
        }
    }

    #[test]
    fn joint_derivatives_match_differences_of_the_inverse() {
        for (head, pose) in heads() {
            let at = |t: f64| Point::new(0.2 + 0.3 * t - 0.4 * t * t, -0.1 + 0.25 * t + 0.7 * t * t);
            let spot = SpotMotion {
                point: at(0.0),
                velocity: Vec2::new(0.3, 0.25),
                acceleration: Vec2::new(-0.8, 1.4),
            };
            let joints = head.motion(&pose, &spot).unwrap();
            let h = 1e-4;
            let [m, z, p] = [-h, 0.0, h].map(|t| head.angles(&pose, at(t)).unwrap());
            for j in Joint::BOTH {
                let first = (p[j] - m[j]) / (2.0 * h);
                let second = (p[j] - 2.0 * z[j] + m[j]) / (h * h);
                assert!((first - joints.first[j]).abs() < 1e-7, "{j}");
                assert!((second - joints.second[j]).abs() < 1e-6, "{j}");
            }
        }
    }

    #[test]
    fn a_point_beyond_a_limit_names_the_joint() {
        let (mut head, pose) = heads()[0];
        head.range_rad.pan = (-0.3, 0.3);
        let error = head.angles(&pose, Point::new(-0.5, 0.0)).unwrap_err();
        assert!(matches!(error, AimError::BeyondLimit { joint: Joint::Pan, .. }));
        assert!(error.to_string().contains("pan at 28.67°"), "{error}");
    }

    #[test]
    fn a_grazing_beam_is_refused() {
        let (head, pose) = heads()[0];
        let error = head.angles(&pose, Point::new(100.0, 0.0)).unwrap_err();
        assert!(error.to_string().contains("at 89.5° from the target's normal"), "{error}");
    }

    #[test]
    fn nothing_behind_the_head_is_reachable() {
        let (head, _) = heads()[0];
        let behind = HeadPose::square_on(-1.0);
        assert!(head.angles(&behind, Point::new(0.1, 0.1)).is_err());
        assert!(head.spot(&HeadPose::square_on(1.0), PanTilt::new(2.0, 0.0)).is_none());
    }
}
