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

    /// Rotation part of target_from_head, by rows: the square-on exchange of axes (x_t = −y_h, y_t = z_h,
    /// z_t = −x_h) after Rz(yaw) Ry(pitch) Rx(roll).
    pub(crate) fn rotation(&self) -> [[f64; 3]; 3] {
        let (sy, cy) = self.yaw_rad.sin_cos();
        let (sp, cp) = self.pitch_rad.sin_cos();
        let (sr, cr) = self.roll_rad.sin_cos();
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
