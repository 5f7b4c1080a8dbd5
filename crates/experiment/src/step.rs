//! One joint sent from rest to an angle: overshoot, settling, what stays, on the head as it is and linearized.

mod view;

use tracelight_lab::StepFigures;
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{
    BenchTick, LawName, ObserverName, RigConfig, StepReference, StepResponse, step_response,
};
use tracelight_task::{Failure, Task};

use crate::by_hand::ByHand;
use crate::finding::Experiment;

/// A joint that is sent somewhere, by laws.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig.
    pub rig: RigConfig,
    /// Which joint.
    pub joint: Joint,
    /// How far, rad.
    pub to_rad: f64,
    /// By these laws, the first of them in the table; if none, by the rig's.
    pub laws: Vec<LawName>,
    /// How counts become position and speed; if not given, as each law is meant.
    pub observer: Option<ObserverName>,
    /// How the joint is told; if not given, as each law is meant.
    pub reference: Option<StepReference>,
    /// A PID that is set by hand.
    pub by_hand: ByHand,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// Each law's response.
pub struct Finding {
    of: Request,
    entries: Vec<Entry>,
}

/// One law's responses and what they are like.
struct Entry {
    law: LawName,
    response: StepResponse,
    nonlinear: StepFigures,
    linear: StepFigures,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(mut self, _: Task<'_>) -> Result<Finding, Failure> {
        let mut laws = self.by_hand.apply(&mut self.rig, &[self.joint], &self.laws)?;
        if laws.is_empty() {
            laws.push(self.rig.control.law);
        }
        let entries = laws.iter().map(|&law| self.respond(law)).collect::<Result<Vec<Entry>, Failure>>()?;
        Ok(Finding { of: self, entries })
    }
}

impl Request {
    fn respond(&self, law: LawName) -> Result<Entry, Failure> {
        let mut rig = self.rig.clone();
        rig.set_law(law, self.observer);
        let reference = self.reference.unwrap_or_else(|| law.reference());
        let response = step_response(&rig, self.joint, self.to_rad, reference, self.seed)
            .ok_or_else(|| unreachable(self.joint, self.to_rad))?;
        let figures = |ticks: &[BenchTick]| figures(ticks, self.joint, self.to_rad);
        let (nonlinear, linear) = (figures(&response.nonlinear), figures(&response.linear));
        Ok(Entry { law, response, nonlinear, linear })
    }
}

/// What a response is like.
pub(crate) fn figures(ticks: &[BenchTick], joint: Joint, to_rad: f64) -> StepFigures {
    let angles: Vec<f64> = ticks.iter().map(|tick| tick.angle_rad[joint]).collect();
    StepFigures::of(&angles, to_rad, TICK_F64_S)
}

/// Why there is no response.
pub(crate) fn unreachable(joint: Joint, to_rad: f64) -> Failure {
    let message = format!(
        "{joint} cannot be sent to {:.4} rad: that is out of its range, or its motor is too weak to hold or move it; see \
         `tracelight rigs show`",
        to_rad
    );
    Failure::failed("unreachable", message)
}
