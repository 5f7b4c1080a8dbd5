use tracelight_rig::{Joint, PanTilt, Setpoint};

use super::Feedforward;
use crate::config::Config;
use crate::estimate::{Estimate, Learned};

/// Reference speed over which Coulomb feedforward is faded in, rad/s: half a mm/s on a target at 1 m. It only keeps the
/// torque from jumping on a reference at rest.
const FRICTION_FADE_RAD_S: f32 = 5e-4;

/// Torques the motion asks for whatever the error, N m: computed torque with the reference's model terms (Siciliano et
/// al., *Robotics*, §8.5.2, with the inverse dynamics taken on the desired motion). `ahead` is where the joints should
/// be half a tick from now: what a command held for a whole tick has to achieve on average.
pub(crate) fn feedforward(
    config: &Config,
    ahead: &PanTilt<Setpoint>,
    estimates: &PanTilt<Estimate>,
) -> PanTilt<f32> {
    let kinds = PanTilt::from_fn(|j| config.axes[j].law.feedforward);
    if kinds == PanTilt::new(Feedforward::None, Feedforward::None) {
        return PanTilt::default();
    }
    let moves = |j: Joint| matches!(kinds[j], Feedforward::Model | Feedforward::Learned);
    let rate = PanTilt::from_fn(|j| if moves(j) { ahead[j].velocity_rad_s } else { 0.0 });
    let terms = config.model.terms(ahead.tilt.position_rad, rate);
    let inertial = terms.inertial(ahead.map(|s| s.acceleration_rad_s2));
    PanTilt::from_fn(|j| {
        let learned = match kinds[j] {
            Feedforward::None => return 0.0,
            Feedforward::Gravity => return terms.bias_nm[j],
            Feedforward::Model => Learned::default(),
            Feedforward::Learned => estimates[j].learned,
        };
        let axis = &config.axes[j];
        let excess_nm = axis.quirks.excess_nm(&learned, ahead[j].position_rad, rate[j]);
        let friction = axis.friction.with_excess(excess_nm);
        let more = terms.own_inertia()[j] * learned.inertia_share * ahead[j].acceleration_rad_s2;
        inertial[j] + more + terms.bias_nm[j] + friction.feedforward(rate[j], FRICTION_FADE_RAD_S)
            - learned.load_nm
            - axis.quirks.cable.torque_nm(ahead[j].position_rad)
    })
}
