use serde_json::Value;
use tracelight_chart::{Colour, Panel, Pen};
use tracelight_lab::StepFigures;
use tracelight_linear::Zpk;
use tracelight_rig::Joint;
use tracelight_sim::{BenchTick, CompensatorLaw, RigConfig, StepResponse, step_response_by};
use tracelight_task::Failure;
use tracelight_units::Angle;

use super::over_time;
use super::step::{curve, figures, figures_json, heading, row, unreachable};
use crate::named;

/// The controller on a rig.
pub(super) struct Trial {
    rig: RigConfig,
    joint: Joint,
    to: Angle,
    response: StepResponse,
    nonlinear: StepFigures,
    linear: StepFigures,
}

impl Trial {
    /// On that rig, or on preset `report`: one joint sent so far, the rig of that seed.
    pub(super) fn of(
        rig: Option<&str>,
        joint: Joint,
        (to, seed): (Angle, u64),
        controller: &Zpk,
    ) -> Result<Self, Failure> {
        let rig = named::rig(rig.unwrap_or("report"))?;
        let law = CompensatorLaw::new(controller).map_err(|e| {
            let message = format!("K = {controller} does not fit into the rig's controller: {e}");
            Failure::failed("no-such-design", message)
        })?;
        let response =
            step_response_by(&rig, joint, &law, to.0, seed).ok_or_else(|| unreachable(joint, to))?;
        let (nonlinear, linear) =
            (figures(&response.nonlinear, joint, to), figures(&response.linear, joint, to));
        Ok(Self { rig, joint, to, response, nonlinear, linear })
    }

    /// Angles, the head as it is and linearized, and what its motor is told.
    pub(super) fn panels(&self) -> [Panel; 2] {
        let angle = |tick: &BenchTick| tick.angle_rad[self.joint].to_degrees();
        let volts = |tick: &BenchTick| f64::from(tick.command_v[self.joint]);
        let curve = |ticks, pen, value| curve(Colour::Vermilion, ticks, pen, value);
        let angles = vec![
            curve(&self.response.nonlinear, Pen::Solid, &angle),
            curve(&self.response.linear, Pen::Dashed, &angle),
        ];
        let commands = vec![curve(&self.response.nonlinear, Pen::Solid, &volts)];
        [
            over_time(format!("{} on the rig, °", self.joint), vec![self.to.0.to_degrees()], angles),
            over_time("command, V", Vec::new(), commands),
        ]
    }

    /// What its curves are called.
    pub(super) fn name(&self) -> String {
        format!("{} of rig {}, dashed: linearized", self.joint, self.rig.name)
    }

    pub(super) fn text(&self) -> String {
        let heading = heading(&self.rig, self.joint, self.to);
        heading + &row("K", &self.nonlinear, &self.linear, &self.rig) + "\n\nmm on a target 3 ft away."
    }

    pub(super) fn json(&self) -> Value {
        let mut object = figures_json(&self.nonlinear, &self.rig);
        object["linear"] = figures_json(&self.linear, &self.rig);
        object["rig"] = self.rig.name.clone().into();
        object["axis"] = self.joint.name().into();
        object["to_rad"] = self.to.0.into();
        object
    }
}
