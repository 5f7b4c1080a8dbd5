//! A PID that is set by hand, of some joints of a rig.

use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{Feedforward, HandTuned, LawName, RigConfig};
use tracelight_task::Failure;

/// What is set by hand; what is not given is the rig's.
#[derive(Clone, Copy, Debug, Default)]
pub struct ByHand {
    /// Gains and weights.
    pub gains: Option<Gains>,
    /// Whether the integral waits while the amplifier is at its limit.
    pub anti_windup: Option<bool>,
    /// What the model adds.
    pub feedforward: Option<Feedforward>,
    /// How long an observer looks back that has such a time, ticks.
    pub interval_ticks: Option<usize>,
}

/// A PID's gains and setpoint weights.
#[derive(Clone, Copy, Debug)]
pub struct Gains {
    /// N m/rad.
    pub kp: f64,
    /// N m/(rad s).
    pub ki: f64,
    /// N m s/rad.
    pub kd: f64,
    /// Share of the setpoint that kp sees.
    pub b: f64,
    /// Share of its speed that kd sees.
    pub c: f64,
}

impl ByHand {
    /// Sets these joints of a rig, and says which laws are meant: `laws`, or hand-tuned where only gains are given.
    pub(crate) fn apply(
        &self,
        rig: &mut RigConfig,
        joints: &[Joint],
        laws: &[LawName],
    ) -> Result<Vec<LawName>, Failure> {
        if let Some(ticks) = self.interval_ticks {
            rig.control.observer_interval_s = ticks as f64 * TICK_F64_S;
        }
        for &joint in joints {
            let by_hand = &mut rig.control.hand_tuned[joint];
            if let Some(Gains { kp, ki, kd, b, c }) = self.gains {
                *by_hand = HandTuned { kp, ki, kd, position_weight: b, velocity_weight: c, ..*by_hand };
            }
            by_hand.anti_windup = self.anti_windup.unwrap_or(by_hand.anti_windup);
            by_hand.feedforward = self.feedforward.unwrap_or(by_hand.feedforward);
        }
        let meant = self.gains.is_some() || self.anti_windup.is_some() || self.feedforward.is_some();
        if !meant {
            return Ok(laws.to_vec());
        }
        if laws.is_empty() {
            return Ok(vec![LawName::HandTuned]);
        }
        if laws.contains(&LawName::HandTuned) {
            return Ok(laws.to_vec());
        }
        let message = "--gains, --anti-windup and --feedforward set law hand-tuned, which --law does not name: add it there";
        Err(Failure::usage("usage", message))
    }
}
