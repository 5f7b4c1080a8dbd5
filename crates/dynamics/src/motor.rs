/// A current amplifier with its geared motor, as felt at the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Joint torque per volt at the amplifier's input, N m/V.
    pub torque_nm_per_v: f64,
    /// Largest command the amplifier takes, V, either sign.
    pub limit_v: f64,
}

impl Motor {
    /// Largest torque, N m.
    pub fn torque_limit_nm(&self) -> f64 {
        self.torque_nm_per_v * self.limit_v
    }

    /// Command that makes a torque, V; not limited.
    pub fn volts_for(&self, torque_nm: f64) -> f64 {
        torque_nm / self.torque_nm_per_v
    }
}
