//! A joint's frequency response, measured with many sines at once, its coherence, and what the model says.

mod logged;
mod view;

use tracelight_lab::{
    Excitation, Excited, FrequencyPoint, Multisine, excite, frequency_response, frequency_response_of_speeds,
};
use tracelight_linear::{Discretization, FrequencyResponse, LinearError, Polynomial, Time, TransferFunction};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::{Mounting, RigConfig, head_alone};
use tracelight_task::{Failure, Task};

use self::logged::{How, Logged, logged};
use crate::columns::Columns;
use crate::finding::Experiment;
use crate::table::Log;

/// A joint that turns one way under a steady voltage, with sines on top: as a log has it, or tried with a simulated head.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig, whose model the response is held against.
    pub rig: RigConfig,
    /// Which joint.
    pub joint: Joint,
    /// The joint of a log that says none, if that was said.
    pub axis: Option<Joint>,
    /// Which columns of the log hold what, where they are not this program's.
    pub columns: Columns,
    /// What a head did: `axis,time_s,volt,count`, a row a millisecond; if not given, the simulated head is tried in a fixture.
    pub log: Option<Log>,
    /// Lowest frequency, rad/s.
    pub from_rad_s: f64,
    /// Highest frequency, rad/s.
    pub to_rad_s: f64,
    /// Most sines.
    pub sines: u32,
    /// All of them together are as strong as one of this amplitude, V.
    pub amplitude_v: f64,
    /// Speed at which the joint turns meanwhile, rad/s, either way.
    pub speed_rad_s: f64,
    /// Period of all, s.
    pub period_s: f64,
    /// Periods that are watched, after one that is not.
    pub periods: u32,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// The response that was measured, and what the model says.
pub struct Finding {
    of: Request,
    measured: Measured,
    points: Vec<FrequencyPoint>,
    model: FrequencyResponse,
}

/// What a joint did under which volts.
struct Measured {
    multisine: Multisine,
    seen: Excited,
    /// The voltage that held the speed, V.
    bias_v: f64,
    /// What was seen are speeds, rad/s, in place of angles.
    speeds: bool,
    /// From one row to the next, s.
    tick_s: f64,
    /// What was taken for what in a log, filled in and left out, a line each.
    said: Vec<String>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let measured = match &self.log {
            Some(log) => self.logged(log)?,
            None => self.measured()?,
        };
        let Measured { multisine, seen, bias_v, speeds, tick_s, .. } = &measured;
        let model = model(&self.rig, self.joint, self.speed_rad_s.copysign(*bias_v), *tick_s)
            .map_err(|e| Failure::failed("no-linear-model", format!("rig {}: {e}", self.rig.name)))?;
        let response = if *speeds { frequency_response_of_speeds } else { frequency_response };
        let points = response(multisine, &seen.angles_rad);
        let model = model.frequency_response(multisine.rad_s().collect());
        Ok(Finding { of: self, measured, points, model })
    }
}

impl Request {
    /// Sines that fit into the period.
    fn check_range(&self) -> Result<(), Failure> {
        if self.from_rad_s >= self.to_rad_s {
            return Err(Failure::usage("usage", "--from must be below --to"));
        }
        if self.from_rad_s < std::f64::consts::TAU / self.period_s {
            let least = std::f64::consts::TAU / self.period_s;
            let message = format!(
                "--from must be {least:.3} rad/s at least: one turn in a --period of {} s",
                self.period_s
            );
            return Err(Failure::usage("usage", message));
        }
        Ok(())
    }

    fn measured(&self) -> Result<Measured, Failure> {
        self.check_range()?;
        let rig = &self.rig;
        let joint = self.joint;
        let motor = rig.model.motors[joint];
        let bias_v = motor.volts_for(rig.model.felt_friction(joint).torque(self.speed_rad_s));
        if motor.dead_band_v > 0.0 && bias_v.abs() - self.amplitude_v <= motor.dead_band_v {
            let message = format!(
                "{} V of sines about {:.2} V come into the dead band of {joint}'s amplifier, {} V: give smaller ones, or a higher --speed",
                self.amplitude_v,
                bias_v.abs(),
                motor.dead_band_v
            );
            return Err(Failure::usage("usage", message));
        }
        if bias_v.abs() + self.amplitude_v > motor.limit_v {
            let message = format!(
                "{:.2} V to turn with {} rad/s and {} V of sines are more than the {} V of the amplifier",
                bias_v.abs(),
                self.speed_rad_s,
                self.amplitude_v,
                motor.limit_v
            );
            return Err(Failure::usage("usage", message));
        }
        let multisine = Multisine::new(
            (self.from_rad_s, self.to_rad_s),
            self.sines as usize,
            self.period_s,
            self.amplitude_v,
        );
        let how = Excitation {
            bias_v,
            start_v: 0.5 * motor.limit_v.copysign(self.speed_rad_s),
            rate_rad_s: self.speed_rad_s,
            count_rad: rig.model.encoder.count_rad(),
            settling: 1,
            watched: self.periods as usize,
        };
        let mut head = head_alone(rig, joint, Mounting::Fixture, self.seed);
        let seen = excite(&mut head, joint, &multisine, &how);
        Ok(Measured { multisine, seen, bias_v, speeds: false, tick_s: TICK_F64_S, said: Vec::new() })
    }

    /// What a log says.
    fn logged(&self, log: &Log) -> Result<Measured, Failure> {
        let how = How {
            joint: self.joint,
            axis: self.axis,
            columns: &self.columns,
            count_rad: self.rig.model.encoder.count_rad(),
            period_s: self.period_s,
        };
        let Logged { seen, speeds, tick_s, period_ticks, said } = logged(log, &how)?;
        let multisine = Multisine::in_record(period_ticks, &seen.volts).ok_or_else(|| {
            let message = format!(
                "{}: {} rows of {} hold no two periods of {} s of volts that change: give a longer log, or its own --period",
                log.name,
                seen.volts.len(),
                self.joint,
                self.period_s
            );
            Failure::usage("frequency-log", message)
        })?;
        let multisine = multisine.with_tick(tick_s);
        let bias_v = seen.volts.iter().sum::<f64>() / seen.volts.len() as f64;
        Ok(Measured { multisine, seen, bias_v, speeds, tick_s, said })
    }
}

/// From volts to the angle, as counts see it.
fn model(
    rig: &RigConfig,
    joint: Joint,
    speed_rad_s: f64,
    tick_s: f64,
) -> Result<TransferFunction, LinearError> {
    let friction = rig.model.felt_friction(joint);
    let viscous = if speed_rad_s > 0.0 { friction.viscous_pos } else { friction.viscous_neg };
    let above = Polynomial::new(vec![rig.model.motors[joint].torque_nm_per_v]);
    let below = Polynomial::new(vec![rig.model.own_inertia_kg_m2()[joint], viscous, 0.0]);
    TransferFunction::new(above, below, Time::Continuous)?.sampled(tick_s, Discretization::ZeroOrderHold)
}
