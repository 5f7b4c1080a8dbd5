//! Joints under voltages: on the simulated head, or from a log.

use std::ops::ControlFlow;
use std::path::Path;

use clap::Args;
use tracelight_files as files;
use tracelight_lab::{Believed, Protocol, Shuttle, SteadyPoint, Travel, Trial, free_trial};
use tracelight_rig::Joint;
use tracelight_sim::{Mounting, RigConfig, head_alone};
use tracelight_task::{Failure, Stop, Task, on_all_cores};
use tracelight_units::TIMES;

use super::log::{self, Log};
use crate::bar::Bar;
use crate::cli::lab::parts::joints;
use crate::cli::lab::step::Axis;
use crate::cli::lab::{above_zero, make_folder, voltage};
use crate::named;

/// What joints are put through.
#[derive(Args, Clone, Debug)]
pub(in crate::cli::lab) struct TrialArgs {
    /// Logs of what a head did: axis,volt,time_s,count or axis,torque_nm,velocity_rad_s; given none, the simulated head is tried
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    pub(in crate::cli::lab) rig: String,
    /// Only this joint [default: both]
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// The head is in a fixture: the tested axis upright, so that gravity does not turn it, and free to turn on and on
    #[arg(long)]
    pub(in crate::cli::lab) fixture: bool,
    /// Highest voltage, either way
    #[arg(long, value_name = "VOLTAGE", default_value = "1V", value_parser = voltage)]
    most: f64,
    /// From one voltage to the next
    #[arg(long, value_name = "VOLTAGE", default_value = "0.05V", value_parser = voltage)]
    step: f64,
    /// How long each voltage is held, at most
    #[arg(long, value_name = "TIME", default_value = "30s", value_parser = time)]
    hold: f64,
    /// Voltage of the pulse before each, against stiction, with its sign
    #[arg(long, value_name = "VOLTAGE", default_value = "1V", value_parser = voltage)]
    pulse: f64,
    /// How long that is given
    #[arg(long, value_name = "TIME", default_value = "1s", value_parser = time)]
    pulse_time: f64,
    /// Seed of what differs from head to head
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
}

/// Longest hold, s: an hour.
const LONGEST_S: f64 = 3600.0;
/// Most voltages.
const MOST_VOLTAGES: f64 = 1000.0;
/// Longest that all trials of a joint may take, s: five hours of the head's time, half of what a log may have.
const LONGEST_ALL_S: f64 = 18_000.0;

fn time(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if time_s <= LONGEST_S { Ok(time_s) } else { Err(format!("{text} is more than {LONGEST_S} s")) }
}

/// A joint and what was seen of it.
pub(in crate::cli::lab) struct Subject {
    pub(in crate::cli::lab) joint: Joint,
    pub(in crate::cli::lab) believed: Believed,
    pub(in crate::cli::lab) trials: Vec<Trial>,
    /// Torques and speeds that somebody measured.
    pub(in crate::cli::lab) points: Vec<SteadyPoint>,
}

impl TrialArgs {
    /// Every joint that was asked and seen, in a log or on the simulated head.
    pub(in crate::cli::lab) fn subjects(
        &self,
        rig: &RigConfig,
        quiet: bool,
        stop: &Stop,
    ) -> Result<Vec<Subject>, Failure> {
        let mut asked: Vec<Subject> = joints(self.axis).map(|joint| self.subject(rig, joint)).collect();
        if self.logs.is_empty() {
            let bar = Bar::new(quiet);
            let task = Task { progress: &bar, stop };
            for subject in &mut asked {
                subject.trials = self.conduct(rig, subject, task)?;
                stop.check()?;
            }
            return Ok(asked);
        }
        let mut log = Log::default();
        self.logs.iter().try_for_each(|path| log.read(path))?;
        for subject in &mut asked {
            subject.trials = std::mem::take(&mut log.trials[subject.joint]);
            subject.points = std::mem::take(&mut log.points[subject.joint]);
        }
        asked.retain(|subject| !subject.trials.is_empty() || !subject.points.is_empty());
        let logs = self.logs.join(", ");
        if asked.is_empty() {
            let message = format!(
                "{logs}: no trial of two rows or more, and no torque, of the joint that is asked for"
            );
            return Err(Failure::usage("friction-log", message));
        }
        if let Some(both) =
            asked.iter().find(|subject| !subject.trials.is_empty() && !subject.points.is_empty())
        {
            let message = format!("{logs}: {} has motion and measured torques; give one kind", both.joint);
            return Err(Failure::usage("friction-log", message));
        }
        Ok(asked)
    }

    /// The same of one joint, if no other was asked for.
    pub(in crate::cli::lab) fn only(&self, joint: Joint) -> Result<Self, Failure> {
        if !joints(self.axis).any(|asked| asked == joint) {
            return Err(Failure::usage("usage", format!("this is of {joint} alone: leave --axis out")));
        }
        let axis = if joint == Joint::Pan { Axis::Pan } else { Axis::Tilt };
        Ok(Self { axis: Some(axis), ..self.clone() })
    }

    fn subject(&self, rig: &RigConfig, joint: Joint) -> Subject {
        let lumped = rig.model.bodies.lumped();
        let falls = joint == Joint::Tilt && !self.fixture;
        let believed = Believed {
            torque_nm_per_v: rig.model.motors[joint].torque_nm_per_v,
            count_rad: rig.model.encoder.count_rad(),
            inertia_kg_m2: rig.model.own_inertia_kg_m2()[joint],
            gravity_nm: falls.then_some([lumped.gravity_c, lumped.gravity_s]),
            cables: !self.fixture,
        };
        Subject { joint, believed, trials: Vec::new(), points: Vec::new() }
    }

    fn protocol(&self, limit_v: f64) -> Result<Protocol, Failure> {
        let steps = (self.most / self.step + 1e-9).floor();
        let strongest = self.most.max(self.pulse);
        if strongest > limit_v {
            let message = format!("{strongest} V is more than the {limit_v} V of the amplifier");
            return Err(Failure::usage("usage", message));
        }
        if steps < 1.0 {
            let message = format!("--step, {} V, is above --most, {} V", self.step, self.most);
            return Err(Failure::usage("usage", message));
        }
        if self.hold < 2.0 * self.pulse_time {
            let message = format!(
                "--hold must be twice --pulse-time at least, {} s, or what is seen is the pulse",
                2.0 * self.pulse_time
            );
            return Err(Failure::usage("usage", message));
        }
        let count = 2.0 * steps + 1.0;
        if count > MOST_VOLTAGES || count * (self.hold + self.pulse_time) > LONGEST_ALL_S {
            let message = format!(
                "{count} voltages, {} s each: give a longer --step; there may be {MOST_VOLTAGES}, and {LONGEST_ALL_S} s in all",
                self.hold + self.pulse_time
            );
            return Err(Failure::usage("usage", message));
        }
        let last = steps as i32;
        Ok(Protocol {
            volts: (-last..=last).map(|k| f64::from(k) * self.step).collect(),
            hold_s: self.hold,
            pulse_v: self.pulse,
            pulse_s: self.pulse_time,
        })
    }

    /// The trials of a joint on the simulated head.
    fn conduct(&self, rig: &RigConfig, subject: &Subject, task: Task<'_>) -> Result<Vec<Trial>, Failure> {
        let (joint, limit_v) = (subject.joint, rig.model.motors[subject.joint].limit_v);
        let protocol = self.protocol(limit_v)?;
        task.stage(joint.name(), protocol.volts.len() as u64);
        if self.fixture {
            let trial = |number: usize| {
                let mut head = head_alone(rig, joint, Mounting::Fixture, self.seed);
                free_trial(&mut head, joint, &protocol, protocol.volts[number])
            };
            return Ok(on_all_cores(protocol.volts.len(), task, trial));
        }
        let (lower_rad, upper_rad) = rig.model.geometry.range_rad[joint];
        let travel = Travel { lower_rad, upper_rad };
        let shuttle = Shuttle { protocol: &protocol, travel, believed: &subject.believed, limit_v };
        let mut head = head_alone(rig, joint, Mounting::Standing, self.seed);
        Ok(shuttle.trials(&mut head, joint, |number| {
            task.at(number as u64);
            if task.stop.is_wanted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }))
    }

    /// Whether voltages are held until their time is over: a joint that must brake before its end comes to no speed.
    pub(in crate::cli::lab) fn holds(&self) -> bool {
        self.fixture || !self.logs.is_empty()
    }

    /// What was done, in words.
    pub(in crate::cli::lab) fn in_words(&self, rig: &RigConfig) -> String {
        if !self.logs.is_empty() {
            return self.logs.join(", ");
        }
        let held = if self.fixture {
            "in a fixture, each axis upright and free".to_owned()
        } else {
            "as it stands, to and fro within its range, gravity balanced".to_owned()
        };
        format!(
            "rig {}, {held}: −{most} to {most} V in steps of {} V, held {} s at most, after {} s of {} V",
            rig.name,
            self.step,
            self.hold,
            self.pulse_time,
            self.pulse,
            most = (self.most / self.step + 1e-9).floor() * self.step,
        )
    }

    /// Writes log.csv into a folder, if the head was tried.
    pub(in crate::cli::lab) fn write_log(&self, out: &Path, subjects: &[Subject]) -> Result<(), Failure> {
        make_folder(out, "--out")?;
        if self.logs.is_empty() {
            let all = subjects.iter().flat_map(|subject| &subject.trials);
            files::write(&out.join("log.csv").display().to_string(), log::write(all))?;
        }
        Ok(())
    }

    /// The rig as it is believed to be.
    pub(in crate::cli::lab) fn load(&self) -> Result<RigConfig, Failure> {
        named::rig(&self.rig)
    }
}
