//! A relay that swings a joint, and a PID tuned from how it swings: no model needed.

mod view;

use tracelight_dynamics::Motor;
use tracelight_lab::{Relay, RelayPid, StepFigures, Swing, swing};
use tracelight_rig::Joint;
use tracelight_sim::{
    HandTuned, LawName, Mounting, ObserverName, RigConfig, StepReference, StepResponse, head_alone,
    step_response,
};
use tracelight_task::{Failure, Task};

use crate::finding::{Experiment, Improved};
use crate::step::{figures, unreachable};

/// A joint to swing, what is tuned from that, and how it is tried.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig.
    pub rig: RigConfig,
    /// Which joint.
    pub joint: Joint,
    /// The relay, either way, V.
    pub level_v: f64,
    /// How far beyond its middle the joint turns the relay over, rad, whatever its sign; if not given, one and a half counts.
    pub hysteresis_rad: Option<f64>,
    /// How the joint stands.
    pub mounting: Mounting,
    /// Where the tuned loop's gain is 1, rad/s; if not given, where the joint swings.
    pub crossover_rad_s: Option<f64>,
    /// Phase margin of the tuned loop, rad.
    pub phase_margin_rad: f64,
    /// How many times as slowly as the derivative the integral acts.
    pub integral: f64,
    /// How counts become position and speed in the tuned loop; if not given, as the rig says, or as the law is meant.
    pub observer: Option<ObserverName>,
    /// How far the tuned joint is sent to try it, rad.
    pub to_rad: f64,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// A swing, the gains from it, and what they do.
pub struct Finding {
    of: Request,
    better: RigConfig,
    relay: Relay,
    swing: Swing,
    pid: RelayPid,
    response: StepResponse,
    nonlinear: StepFigures,
    linear: StepFigures,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let (rig, joint, to_rad) = (&self.rig, self.joint, self.to_rad);
        let (swing, relay) = self.swung()?;
        let torque_nm_per_v = relayed_nm_per_v(&rig.model.motors[joint], relay.level_v);
        let pid = swing
            .pid(&relay, torque_nm_per_v, self.crossover_rad_s, (self.phase_margin_rad, self.integral))
            .map_err(|e| Failure::failed("relay", e))?;
        let mut better = rig.clone();
        // an observer that the rig's file names stays
        better.control.law = LawName::HandTuned;
        better.control.observer = self.observer.or(rig.control.observer);
        let by_hand = &mut better.control.hand_tuned[joint];
        *by_hand = HandTuned { kp: pid.kp, ki: pid.ki, kd: pid.kd, ..*by_hand };
        let response = step_response(&better, joint, to_rad, StepReference::Jump, self.seed)
            .ok_or_else(|| unreachable(joint, to_rad))?;
        let (nonlinear, linear) =
            (figures(&response.nonlinear, joint, to_rad), figures(&response.linear, joint, to_rad));
        Ok(Finding { of: self, better, relay, swing, pid, response, nonlinear, linear })
    }
}

/// Torque that a relay's level makes beyond what holds the joint, for each volt of it, N m/V.
fn relayed_nm_per_v(motor: &Motor, level_v: f64) -> f64 {
    motor.torque_nm_per_v * (1.0 - motor.dead_band_v / level_v)
}

impl Request {
    fn swung(&self) -> Result<(Swing, Relay), Failure> {
        let Self { rig, joint, mounting, level_v, .. } = self;
        let (joint, mounting, level_v) = (*joint, *mounting, *level_v);
        let motor = rig.model.motors[joint];
        let pull_nm = match (joint, mounting) {
            (Joint::Tilt, Mounting::Standing) => rig.model.bodies.lumped().gravity(0.0).tilt,
            _ => 0.0,
        };
        let count_rad = rig.model.encoder.count_rad();
        let relay = Relay {
            level_v,
            hysteresis_rad: self.hysteresis_rad.map_or(1.5 * count_rad, f64::abs),
            // what holds it is between the relay's two levels, which are beyond the dead band
            hold_v: pull_nm / motor.torque_nm_per_v,
            limit_v: motor.limit_v,
            count_rad,
        };
        if level_v - relay.hold_v.abs() <= motor.dead_band_v {
            let message = format!(
                "--level {level_v} V is within the dead band of {joint}'s amplifier, {} V, once {:.2} V of it hold the joint: nothing would come of it",
                motor.dead_band_v,
                relay.hold_v.abs()
            );
            return Err(Failure::usage("usage", message));
        }
        if level_v + relay.hold_v.abs() > motor.limit_v {
            let message = format!(
                "--level {level_v} V and {:.2} V to hold {joint} are more than the {} V of its amplifier",
                relay.hold_v.abs(),
                motor.limit_v
            );
            return Err(Failure::usage("usage", message));
        }
        let mut head = head_alone(rig, joint, mounting, self.seed);
        let swing = swing(&mut head, joint, &relay).map_err(|e| Failure::failed("relay", e))?;
        Ok((swing, relay))
    }
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.of.rig
    }

    // the rig with the gains, and law hand-tuned
    fn better(&self) -> &RigConfig {
        &self.better
    }
}
