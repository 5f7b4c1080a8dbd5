//! A designed PID on the bench, with setpoint weights and back-calculation.

use tracelight_linear::Pid;
use tracelight_rig::TICK_F64_S;

/// A PID that was designed, from angle, rad, to torque, N m, and what holds the head against gravity.
///
/// Every tick, by Tustin's rule; without a limit and with weights of 1 it is [`Pid::transfer_in`] of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PidLaw {
    /// Its gains, N m/rad, N m/(rad s), N m s/rad.
    pub pid: Pid,
    /// Share of the setpoint that the proportional term sees.
    pub proportional_weight: f64,
    /// Share of the setpoint that the derivative sees.
    pub derivative_weight: f64,
    /// How fast the integral is brought back while the amplifier is at its limit, s; none: it winds up (Åström & Hägglund, *Advanced PID
    /// Control*, 2006, §3.5).
    pub tracking_s: Option<f64>,
}

/// What it remembers from tick to tick.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PidMemory {
    /// N m.
    integral_nm: f64,
    /// N m.
    derivative_nm: f64,
    /// Error and what the derivative saw, rad, of the tick before.
    before_rad: (f64, f64),
}

impl PidLaw {
    /// Torque of this tick, N m, not limited.
    pub(crate) fn torque_nm(&self, memory: &mut PidMemory, setpoint_rad: f64, angle_rad: f64) -> f64 {
        let Pid { kp, ki, kd, filter_rad_s } = self.pid;
        let error_rad = setpoint_rad - angle_rad;
        let seen_rad = self.derivative_weight * setpoint_rad - angle_rad;
        let (error_before, seen_before) = memory.before_rad;
        memory.integral_nm += ki * 0.5 * TICK_F64_S * (error_rad + error_before);
        let turn = filter_rad_s * TICK_F64_S;
        let kept = (2.0 - turn) * memory.derivative_nm;
        memory.derivative_nm = (kept + 2.0 * kd * filter_rad_s * (seen_rad - seen_before)) / (2.0 + turn);
        memory.before_rad = (error_rad, seen_rad);
        let proportional_nm = kp * (self.proportional_weight * setpoint_rad - angle_rad);
        proportional_nm + memory.integral_nm + memory.derivative_nm
    }

    /// Back-calculation: told how much more the amplifier gives, N m, than was asked for.
    pub(crate) fn settle(&self, memory: &mut PidMemory, beyond_nm: f64) {
        if let Some(tracking_s) = self.tracking_s.filter(|_| self.pid.ki != 0.0) {
            // faster than a tick would swing
            memory.integral_nm += TICK_F64_S / tracking_s.max(TICK_F64_S) * beyond_nm;
        }
    }
}

#[cfg(test)]
mod tests {
    use tracelight_linear::Time;

    use super::*;

    const PID: Pid = Pid { kp: 60.0, ki: 300.0, kd: 2.5, filter_rad_s: 400.0 };
    const LAW: PidLaw =
        PidLaw { pid: PID, proportional_weight: 1.0, derivative_weight: 1.0, tracking_s: Some(0.1) };

    #[test]
    fn without_a_limit_it_is_the_sampled_transfer_function() {
        let errors: Vec<f64> = (0..400).map(|k| 0.02 * (0.05 * f64::from(k)).sin() + 0.01).collect();
        let sampled = PID.transfer_in(Time::Sampled(TICK_F64_S)).unwrap();
        let wanted = sampled.response(TICK_F64_S, &errors).unwrap();
        let mut memory = PidMemory::default();
        for (error, wanted) in errors.iter().zip(&wanted.values) {
            let is = LAW.torque_nm(&mut memory, *error, 0.0);
            assert!((is - wanted).abs() < 1e-9 * wanted.abs().max(1.0), "{is} {wanted}");
        }
    }

    #[test]
    fn an_integral_comes_back_while_it_is_limited_and_only_with_a_tracking_time() {
        for tracking_s in [Some(0.05), None] {
            let law = PidLaw { tracking_s, ..LAW };
            let mut memory = PidMemory::default();
            for _ in 0..2000 {
                let wanted = law.torque_nm(&mut memory, 0.5, 0.0);
                law.settle(&mut memory, wanted.clamp(-1.0, 1.0) - wanted);
            }
            match tracking_s {
                // ki e = (asked − limit) / Tt; what is told after the tick takes half a tick's integral more
                Some(tracking_s) => {
                    let expected = 1.0 - PID.kp * 0.5 + PID.ki * 0.5 * tracking_s;
                    assert!((memory.integral_nm - expected).abs() < 0.2, "{memory:?} {expected}");
                }
                None => assert!(memory.integral_nm > 250.0, "{memory:?}"),
            }
        }
    }
}
