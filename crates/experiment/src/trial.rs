//! A controller on a simulated rig, from a jump of its setpoint.

use serde_json::{Value, json};
use tracelight_chart::{Colour, Panel, Pen};
use tracelight_lab::StepFigures;
use tracelight_linear::{Discretization, Time, TransferFunction, Zpk};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{
    BenchTick, CompensatorLaw, PidLaw, RigConfig, StepResponse, step_response_by, step_response_by_pid,
};
use tracelight_task::Failure;

use crate::design::pid::PidDesign;
use crate::numbers::four;
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
    /// What is particular to a PID.
    pid: Option<PidTrial>,
}

/// What keeps a PID's integral, what it would do without, and what sampling does to it.
struct PidTrial {
    tracking_s: Option<f64>,
    /// Without anti-windup.
    wound: Option<StepFigures>,
    /// Least phase margin, rad, and distance from −1 of the design's loop at the rig's ticks.
    sampled: Option<(f64, f64)>,
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
        Ok(Self::found(rig, joint, to_rad, response))
    }

    /// One joint of a rig sent so far by a PID with its setpoint weights and anti-windup, designed for that plant.
    pub(crate) fn by_pid(
        rig: RigConfig,
        joint: Joint,
        (to_rad, seed): (f64, u64),
        (design, plant): (&PidDesign, &TransferFunction),
    ) -> Result<Self, Failure> {
        if let Time::Sampled(period_s) = plant.time()
            && (period_s / TICK_F64_S - 1.0).abs() > 1e-9
        {
            let message = format!(
                "the rig's controller runs every {} ms, not every {} ms: design it with --sample {0}ms, or without --try",
                1e3 * TICK_F64_S,
                1e3 * period_s
            );
            return Err(Failure::failed("no-such-design", message));
        }
        let law = |tracking_s: Option<f64>| PidLaw {
            pid: design.pid,
            proportional_weight: design.weights.proportional,
            derivative_weight: design.weights.derivative,
            tracking_s,
        };
        let respond = |tracking_s: Option<f64>| {
            step_response_by_pid(&rig, joint, &law(tracking_s), to_rad, seed)
                .ok_or_else(|| unreachable(joint, to_rad))
        };
        let response = respond(design.tracking_s)?;
        let wound = match design.tracking_s {
            Some(_) => Some(figures(&respond(None)?.nonlinear, joint, to_rad)),
            None => None,
        };
        let pid = PidTrial { tracking_s: design.tracking_s, wound, sampled: sampled_margins(design, plant) };
        Ok(Self { pid: Some(pid), ..Self::found(rig, joint, to_rad, response) })
    }

    fn found(rig: RigConfig, joint: Joint, to_rad: f64, response: StepResponse) -> Self {
        let (nonlinear, linear) =
            (figures(&response.nonlinear, joint, to_rad), figures(&response.linear, joint, to_rad));
        Self { rig, joint, to_rad, response, nonlinear, linear, pid: None }
    }

    /// Share of the time that the amplifier was at its limit.
    fn limited_share(&self) -> f64 {
        let limit_v = (1.0 - 1e-6) * self.rig.model.motors[self.joint].limit_v;
        let ticks = &self.response.nonlinear;
        let limited = ticks.iter().filter(|tick| f64::from(tick.command_v[self.joint]).abs() >= limit_v);
        limited.count() as f64 / ticks.len().max(1) as f64
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
        let limited = format!(
            "the amplifier is at its limit for {} ms of the {} s",
            four(1e3 * self.limited_share() * StepResponse::LENGTH_S),
            StepResponse::LENGTH_S
        );
        let pid = self.pid.as_ref().map_or(String::new(), PidTrial::text);
        let row = row("K", &self.nonlinear, &self.linear, &self.rig);
        format!("{heading}{row}\n\nmm on a target 3 ft away. Over the jump {limited}.{pid}")
    }

    pub(crate) fn json(&self) -> Value {
        let mut object = figures_json(&self.nonlinear, &self.rig);
        object["linear"] = figures_json(&self.linear, &self.rig);
        object["rig"] = self.rig.name.clone().into();
        object["axis"] = self.joint.name().into();
        object["to_rad"] = self.to_rad.into();
        object["limited_share"] = self.limited_share().into();
        if let Some(pid) = &self.pid {
            object["tracking_s"] = pid.tracking_s.into();
            object["without_anti_windup"] =
                pid.wound.as_ref().map_or(Value::Null, |wound| figures_json(wound, &self.rig));
            object["sampled"] = pid.sampled.map_or(Value::Null, |(phase_rad, modulus)| {
                json!({"phase_margin_deg": phase_rad.to_degrees(), "modulus": modulus})
            });
        }
        object
    }
}

impl PidTrial {
    fn text(&self) -> String {
        let mut text = match (self.tracking_s, &self.wound) {
            (Some(tracking_s), Some(wound)) => format!(
                "\nAnti-windup by back-calculation, time constant {} s; without it: overshoot {} %, settles {}.",
                four(tracking_s),
                four(wound.overshoot_percent),
                wound.settle_s.map_or_else(|| "never".to_owned(), |s| format!("after {} s", four(s)))
            ),
            _ => String::new(),
        };
        if let Some((phase_rad, modulus)) = self.sampled {
            text += &format!(
                "\nRun every {} ms, the design keeps a phase margin of {}° and a modulus margin of {}.",
                four(1e3 * TICK_F64_S),
                four(phase_rad.to_degrees()),
                four(modulus)
            );
        }
        text
    }
}

/// Margins of a design in continuous time once plant and controller are sampled every tick; none of what does not close stable then.
fn sampled_margins(design: &PidDesign, plant: &TransferFunction) -> Option<(f64, f64)> {
    if plant.time() != Time::Continuous {
        return None;
    }
    let plant = plant.sampled(TICK_F64_S, Discretization::ZeroOrderHold).ok()?;
    let open = plant.series(&design.pid.transfer_in(plant.time()).ok()?).ok()?;
    let margins = open.margins();
    let stable = open.closes_stable();
    let found = margins.least_phase().zip(margins.modulus).filter(|_| stable);
    found.map(|(phase, modulus)| (phase.phase_rad, modulus.distance))
}
