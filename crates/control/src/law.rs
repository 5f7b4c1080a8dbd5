use tracelight_rig::{Joint, PanTilt, Setpoint, TICK_S};

use crate::Config;
use crate::limit::within;

/// Reference speed over which Coulomb feedforward is faded in, rad/s: 1 mm/s on a target at 1 m. It only keeps the
/// torque from jumping on a reference at rest.
const FRICTION_FADE_RAD_S: f32 = 1e-3;

/// Integrators of the two loops, rad·s.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LawState {
    integral: PanTilt<f32>,
}

impl LawState {
    /// Forgets what was integrated: a push is not a load that stays.
    pub(crate) fn reset(&mut self) {
        self.integral = PanTilt::default();
    }
}

/// What the law looks at in one tick.
pub(crate) struct LawInput<'a> {
    /// Where the joints should be half a tick from now: what a command held for a whole tick has to achieve on
    /// average.
    pub(crate) ahead: &'a PanTilt<Setpoint>,
    /// Setpoint − estimate, rad.
    pub(crate) error_rad: PanTilt<f32>,
    /// Setpoint − estimate, rad/s.
    pub(crate) rate_error_rad_s: PanTilt<f32>,
}

/// PID on the error plus feedforward of inertia, Coriolis, gravity and friction: volts at the amplifiers.
///
/// Computed torque with the reference's model terms (Siciliano et al., *Robotics*, §8.5.2, with the inverse
/// dynamics taken on the desired motion). Anti-windup: an integrator rests while its axis is saturated and its
/// error would drive it further.
pub(crate) fn command(config: &Config, state: &mut LawState, input: &LawInput<'_>) -> PanTilt<f32> {
    let rate = input.ahead.map(|s| s.velocity_rad_s);
    let terms = config.model.terms(input.ahead.tilt.position_rad, rate);
    let wanted = PanTilt::from_fn(|j| {
        let gains = &config.axes[j].gains;
        input.ahead[j].acceleration_rad_s2
            + gains.kp * input.error_rad[j]
            + gains.ki * state.integral[j]
            + gains.kd * input.rate_error_rad_s[j]
    });
    let inertial = terms.inertial(wanted);
    PanTilt::from_fn(|j| {
        let axis = &config.axes[j];
        let friction = axis.friction.feedforward(rate[j], FRICTION_FADE_RAD_S);
        let volts = (inertial[j] + terms.bias_nm[j] + friction) / axis.torque_nm_per_v;
        // a number that is none must not become the amplifier's stop
        let limited = if volts.is_finite() { within(volts, axis.limit_v) } else { 0.0 };
        integrate(&mut state.integral, j, input.error_rad[j], volts - limited);
        limited
    })
}

fn integrate(integral: &mut PanTilt<f32>, joint: Joint, error_rad: f32, excess_v: f32) {
    if excess_v * error_rad <= 0.0 {
        integral[joint] += error_rad * TICK_S;
    }
}
