use tracelight_maths::{asin, atan2, sin_cos};
use tracelight_stroke::{Affine, Point};

/// Where the head stands in front of the target: target_from_head.
///
/// With the three angles zero the head is square-on: its +x (the beam at zero) meets the target at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadPose {
    /// From the crossing of the axes to the target plane, along its normal, m.
    pub distance_m: f64,
    /// Foot of that normal on the target: right of the picture's centre, m.
    pub right_m: f64,
    /// Foot of that normal on the target: above the picture's centre, m.
    pub up_m: f64,
    /// Head turned left about its z, rad.
    pub yaw_rad: f64,
    /// Then turned down about its y, rad.
    pub pitch_rad: f64,
    /// Then turned about its x, rad.
    pub roll_rad: f64,
}

impl HeadPose {
    /// Square-on in front of the picture's centre.
    pub const fn square_on(distance_m: f64) -> Self {
        Self { distance_m, right_m: 0.0, up_m: 0.0, yaw_rad: 0.0, pitch_rad: 0.0, roll_rad: 0.0 }
    }

    /// Expresses the pose in another frame on the target plane; `frame_from_target` is a rotation and a translation.
    #[must_use]
    pub fn in_frame(&self, frame_from_target: Affine) -> Self {
        let [a, b, _, _, _, _] = frame_from_target.as_coeffs();
        let (sin, cos) = sin_cos(atan2(b, a));
        let [x, y, z] = self.rotation();
        let turned = |k: usize| (cos * x[k] - sin * y[k], sin * x[k] + cos * y[k]);
        // by the square-on exchange of axes back to Rz(yaw) Ry(pitch) Rx(roll), whose first column and last row have the angles
        let (right, up) = turned(0);
        let last = [1, 2].map(|k| turned(k).1);
        let foot = frame_from_target * Point::new(self.right_m, self.up_m);
        Self {
            distance_m: self.distance_m,
            right_m: foot.x,
            up_m: foot.y,
            yaw_rad: atan2(-right, -z[0]),
            pitch_rad: -asin(up.clamp(-1.0, 1.0)),
            roll_rad: atan2(last[0], last[1]),
        }
    }

    /// Rotation part of target_from_head, by rows: the square-on exchange of axes (x_t = −y_h, y_t = z_h,
    /// z_t = −x_h) after Rz(yaw) Ry(pitch) Rx(roll).
    pub(crate) fn rotation(&self) -> [[f64; 3]; 3] {
        let (sy, cy) = sin_cos(self.yaw_rad);
        let (sp, cp) = sin_cos(self.pitch_rad);
        let (sr, cr) = sin_cos(self.roll_rad);
        let x = [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr];
        let y = [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr];
        let z = [-sp, cp * sr, cp * cr];
        [y.map(|v| -v), z, x.map(|v| -v)]
    }

    /// Translation part of target_from_head: the head's origin in the target frame, m.
    pub(crate) const fn translation(&self) -> [f64; 3] {
        [self.right_m, self.up_m, self.distance_m]
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use super::*;
    use crate::HeadGeometry;
    use tracelight_rig::PanTilt;
    use tracelight_stroke::Vec2;

    #[test]
    fn in_another_frame_the_spot_is_at_the_same_place() {
        let pose = HeadPose {
            distance_m: 1.1,
            right_m: 0.1,
            up_m: -0.05,
            yaw_rad: 0.2,
            pitch_rad: -0.1,
            roll_rad: 0.3,
        };
        let head = HeadGeometry {
            laser_offset_m: [0.02, 0.01, -0.03],
            ..HeadGeometry::centred(PanTilt::new((-2.0, 2.0), (-1.5, 1.5)))
        };
        for turn_rad in [0.0, 0.3, -1.6, 3.0] {
            let frame = planar::rotation(turn_rad).then_translate(Vec2::new(0.4, -0.2));
            let moved = pose.in_frame(frame);
            for angle in [PanTilt::new(0.0, 0.0), PanTilt::new(0.3, -0.2), PanTilt::new(-0.4, 0.25)] {
                let [a, b] = [frame * head.spot(&pose, angle).unwrap(), head.spot(&moved, angle).unwrap()];
                assert!(a.distance(b) < 1e-12, "{turn_rad}: {a} {b}");
            }
        }
    }
}
