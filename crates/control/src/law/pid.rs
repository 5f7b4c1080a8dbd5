use tracelight_rig::TICK_S;

use super::input::LawInput;

/// PID with two degrees of freedom (Åström & Hägglund, *Advanced PID Control*, §3.4): N m at the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid {
    /// Proportional, N m/rad.
    pub kp: f32,
    /// Integral, N m/(rad·s).
    pub ki: f32,
    /// Derivative, N m·s/rad.
    pub kd: f32,
    /// Share of the setpoint that the proportional part sees, 0 to 1.
    pub position_weight: f32,
    /// Share of the setpoint's velocity that the derivative part sees, 0 to 1.
    pub velocity_weight: f32,
    /// Corner of the derivative's low-pass, rad/s; infinite for none.
    pub filter_rad_s: f32,
    /// Whether the integrator rests while its axis is saturated and its error would drive it further.
    pub anti_windup: bool,
}

impl Pid {
    /// All three closed-loop poles of a double integrator of this inertia at −ω:
    /// (s + ω)³ = s³ + 3ω s² + 3ω² s + ω³.
    pub const fn triple_pole(bandwidth_rad_s: f32, inertia_kg_m2: f32) -> Self {
        let (w, j) = (bandwidth_rad_s, inertia_kg_m2);
        Self { kp: 3.0 * w * w * j, ki: w * w * w * j, kd: 3.0 * w * j, ..Self::proportional(0.0) }
    }

    /// Nothing but a proportional part.
    pub const fn proportional(kp: f32) -> Self {
        Self {
            kp,
            ki: 0.0,
            kd: 0.0,
            position_weight: 1.0,
            velocity_weight: 1.0,
            filter_rad_s: f32::INFINITY,
            anti_windup: true,
        }
    }

    pub(super) fn torque_nm(&self, state: &mut PidState, input: &LawInput<'_>) -> f32 {
        let (wanted, is) = (input.setpoint, input.estimate);
        let proportional = self.position_weight * wanted.position_rad - is.position_rad;
        let derivative = self.velocity_weight * wanted.velocity_rad_s - is.velocity_rad_s;
        let turn = self.filter_rad_s * TICK_S;
        let share = if turn.is_finite() { turn / (1.0 + turn) } else { 1.0 };
        state.derivative += share * (derivative - state.derivative);
        self.kp * proportional + self.ki * state.integral + self.kd * state.derivative
    }

    /// Told how much more was asked for than the amplifier gives.
    pub(super) fn integrate(&self, state: &mut PidState, error_rad: f32, excess_v: f32) {
        if excess_v * error_rad <= 0.0 || !self.anti_windup {
            state.integral += error_rad * TICK_S;
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PidState {
    /// rad·s.
    integral: f32,
    /// Smoothed, rad/s.
    derivative: f32,
}
