/// An amplifier with its geared motor, as felt at the joint.
///
/// One that gives a current has no back-EMF here: its torque follows its command whatever the speed. One that gives a voltage, such as an
/// H-bridge, has less the faster the motor turns. With τ at the joint, N m, u the command, V, beyond the dead band, and ω, rad/s:
/// τ = `torque_nm_per_v` (u − `back_emf_v_s_per_rad` ω).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Joint torque per volt at the amplifier's input at standstill, N m/V.
    pub torque_nm_per_v: f64,
    /// Largest command the amplifier takes, V, either sign.
    pub limit_v: f64,
    /// Voltage of the turning motor against its amplifier's, as volts of command for each rad/s of the joint, V s/rad; 0 for an amplifier that gives a
    /// current.
    pub back_emf_v_s_per_rad: f64,
    /// Command of which nothing comes, either sign, V: the dead time of a bridge's switches. Less than the limit.
    pub dead_band_v: f64,
}

impl Motor {
    /// With an amplifier that gives a current, and all of it.
    pub const fn by_current(torque_nm_per_v: f64, limit_v: f64) -> Self {
        Self { torque_nm_per_v, limit_v, back_emf_v_s_per_rad: 0.0, dead_band_v: 0.0 }
    }

    /// What is left of the largest command beyond the dead band, V.
    pub const fn most_v(&self) -> f64 {
        self.limit_v - self.dead_band_v
    }

    /// Largest torque at standstill, N m.
    pub fn torque_limit_nm(&self) -> f64 {
        self.torque_nm_per_v * self.most_v()
    }

    /// Command that makes a torque at standstill, V; not limited.
    pub fn volts_for(&self, torque_nm: f64) -> f64 {
        let beyond_v = torque_nm / self.torque_nm_per_v;
        if beyond_v == 0.0 { 0.0 } else { beyond_v + self.dead_band_v.copysign(beyond_v) }
    }

    /// What comes of a command, V: what it is beyond the dead band, up to the limit.
    pub const fn beyond_v(&self, command_v: f64) -> f64 {
        let given_v = command_v.abs().min(self.limit_v) - self.dead_band_v;
        given_v.max(0.0).copysign(command_v)
    }

    /// Torque that a command makes at standstill, N m.
    pub const fn torque_nm(&self, command_v: f64) -> f64 {
        self.torque_nm_per_v * self.beyond_v(command_v)
    }

    /// What the motor's own voltage takes from its torque for each rad/s, N m s/rad: it acts as viscous friction does.
    pub const fn back_emf_nm_s_per_rad(&self) -> f64 {
        self.torque_nm_per_v * self.back_emf_v_s_per_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_within_the_dead_band_makes_nothing_and_what_makes_a_torque_makes_it() {
        let motor = Motor { dead_band_v: 0.5, ..Motor::by_current(0.1, 10.0) };
        assert_eq!([0.0, 0.4, -0.5].map(|v| motor.torque_nm(v).abs()), [0.0; 3]);
        for torque_nm in [-0.95, -0.01, 0.0, 0.003, 0.4] {
            let made = motor.torque_nm(motor.volts_for(torque_nm));
            assert!((made - torque_nm).abs() < 1e-12, "{torque_nm}: {made}");
        }
        assert_eq!(motor.torque_nm(99.0), motor.torque_limit_nm());
        assert_eq!(motor.torque_nm(-99.0), -motor.torque_limit_nm());
    }

    #[test]
    fn without_a_dead_band_a_command_is_what_comes_of_it_to_the_bit() {
        let motor = Motor::by_current(0.077, 10.0);
        for command_v in [-10.0, -0.3, 0.0, 1e-9, 7.7] {
            assert_eq!(motor.beyond_v(command_v).to_bits(), f64::to_bits(command_v));
        }
    }
}
