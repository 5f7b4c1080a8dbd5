//! A controller on a simulated rig, from a jump of its setpoint.

use serde_json::Value;
use tracelight_chart::{Colour, Panel, Pen};
use tracelight_lab::StepFigures;
use tracelight_linear::Zpk;
use tracelight_rig::Joint;
use tracelight_sim::{BenchTick, CompensatorLaw, RigConfig, StepResponse, step_response_by};
use tracelight_task::Failure;

use crate::panels::{curve, over_time};
use crate::step::{figures, unreachable};
use crate::step_words::{figures_json, heading, row};

/// The controller on a rig.
pub(crate) struct Trial {
    rig: RigConfig,
    joint: Joint,
    to_rad: f64,
    response: StepResponse,
    nonlinear: StepFigures,
    linear: StepFigures,
}

impl Trial {
    /// One joint of a rig sent so far, rad, the rig of that seed.
    pub(crate) fn of(
        rig: RigConfig,
        joint: Joint,
        (to_rad, seed): (f64, u64),
        controller: &Zpk,
    ) -> Result<Self, Failure> {
        let law = CompensatorLaw::new(controller).map_err(|e| {
            let message = format!("K = {controller} does not fit into the rig's controller: {e}");
            Failure::failed("no-such-design", message)
        })?;
        let response =
            step_response_by(&rig, joint, &law, to_rad, seed).ok_or_else(|| unreachable(joint, to_rad))?;
        let (nonlinear, linear) =
            (figures(&response.nonlinear, joint, to_rad), figures(&response.linear, joint, to_rad));
        Ok(Self { rig, joint, to_rad, response, nonlinear, linear })
    }

    /// Angles, the head as it is and linearized, and what its motor is told.
    pub(crate) fn panels(&self) -> [Panel; 2] {
        let angle = |tick: &BenchTick| tick.angle_rad[self.joint].to_degrees();
        let volts = |tick: &BenchTick| f64::from(tick.command_v[self.joint]);
        let curve = |ticks, pen, value| curve(Colour::Ochre, ticks, pen, value);
        let angles = vec![
            curve(&self.response.nonlinear, Pen::Solid, &angle),
            curve(&self.response.linear, Pen::Dashed, &angle),
        ];
        let commands = vec![curve(&self.response.nonlinear, Pen::Solid, &volts)];
        [
            over_time(format!("{} on the rig, °", self.joint), vec![self.to_rad.to_degrees()], angles),
            over_time("command, V", Vec::new(), commands),
        ]
    }

    /// What its curves are called.
    pub(crate) fn name(&self) -> String {
        format!("{} of rig {}, dashed: linearized", self.joint, self.rig.name)
    }

    pub(crate) fn text(&self) -> String {
        let heading = heading(&self.rig, self.joint, self.to_rad);
        heading + &row("K", &self.nonlinear, &self.linear, &self.rig) + "\n\nmm on a target 3 ft away."
    }

    pub(crate) fn json(&self) -> Value {
        let mut object = figures_json(&self.nonlinear, &self.rig);
        object["linear"] = figures_json(&self.linear, &self.rig);
        object["rig"] = self.rig.name.clone().into();
        object["axis"] = self.joint.name().into();
        object["to_rad"] = self.to_rad.into();
        object
    }
}
