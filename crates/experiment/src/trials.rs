//! Joints under voltages: on the simulated head, or from a log. Friction, inertia and gravity are told from what they do.

mod cut;
mod foreign;
mod log;

use std::ops::ControlFlow;

use tracelight_lab::{
    Believed, Curves, Plateau, Protocol, Shuttle, SteadyPoint, Travel, Trial, curves, free_trial, plateau,
    replayed, saturated,
};
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{Mounting, RigConfig, head_alone};
use tracelight_task::{Failure, Task, counted, on_all_cores};

use self::log::{How, Known, Logged};
use crate::columns::Columns;
use crate::parts::joints;
use crate::table::{self, Log};

/// Most voltages.
const MOST_VOLTAGES: f64 = 1000.0;
/// Longest that all trials of a joint may take, s: five hours of the head's time, half of what a log may have.
const LONGEST_ALL_S: f64 = 18_000.0;

/// What joints are put through.
#[derive(Clone, Debug)]
pub struct Trials {
    /// The rig as it is believed to be.
    pub rig: RigConfig,
    /// Logs of what a head did: `axis,volt,time_s,count` or `axis,torque_nm,velocity_rad_s`; if none, the simulated head is tried.
    pub logs: Vec<Log>,
    /// Which columns of the logs hold what, where they are not this program's.
    pub columns: Columns,
    /// Only this joint, and the joint of logs that say none.
    pub only: Option<Joint>,
    /// The head is in a fixture: the tested axis upright, so that gravity does not turn it, and free to turn on and on.
    pub fixture: bool,
    /// Highest voltage, either way, V.
    pub most_v: f64,
    /// From one voltage to the next, V.
    pub step_v: f64,
    /// How long each voltage is held, at most, s.
    pub hold_s: f64,
    /// Voltage of the pulse before each, against stiction, with its sign, V.
    pub pulse_v: f64,
    /// How long that is given, s.
    pub pulse_s: f64,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// Drops all that lie on some plateau.
fn drop_all<T>(all: &mut Vec<T>, plateaus: &[Plateau]) {
    let on = |k: usize| plateaus.iter().any(|plateau| plateau.points.contains(&k));
    let mut number = 0;
    all.retain(|_| {
        number += 1;
        !on(number - 1)
    });
}

/// What joints did that were put through it.
pub struct Seen {
    pub(crate) of: Trials,
    pub(crate) subjects: Vec<Subject>,
    /// What was taken for what in logs that are not this program's, a line each.
    pub(crate) said: Vec<String>,
}

/// A joint and what was seen of it.
pub(crate) struct Subject {
    pub(crate) joint: Joint,
    pub(crate) believed: Believed,
    pub(crate) trials: Vec<Trial>,
    /// Torques and speeds that somebody measured.
    pub(crate) points: Vec<SteadyPoint>,
    /// Whether somebody else measured it, perhaps on another motor.
    pub(crate) foreign: bool,
    /// Trials, or points, that were left out: their speed stands at the amplifier's limit.
    pub(crate) plateaus: Vec<Plateau>,
}

impl Trials {
    /// Every joint that was asked and seen, in a log or on the simulated head.
    ///
    /// # Errors
    /// `friction-log`: a log that cannot be read, or holds nothing of the joint; voltages that are too many or more than the
    /// amplifier's; or [`Failure::interrupted`].
    pub fn seen(self, task: Task<'_>) -> Result<Seen, Failure> {
        let (subjects, said) =
            if self.logs.is_empty() { (self.conducted(task)?, Vec::new()) } else { self.logged()? };
        Ok(Seen { of: self, subjects, said })
    }

    /// The same of one joint, if no other was asked for.
    pub(crate) fn of_joint(self, joint: Joint) -> Result<Self, Failure> {
        if !joints(self.only).any(|asked| asked == joint) {
            return Err(Failure::usage("usage", format!("this is of {joint} alone: leave --axis out")));
        }
        Ok(Self { only: Some(joint), ..self })
    }

    /// The joints that are asked for, nothing seen of them yet.
    fn asked(&self) -> Vec<Subject> {
        joints(self.only).map(|joint| self.subject(joint)).collect()
    }

    fn conducted(&self, task: Task<'_>) -> Result<Vec<Subject>, Failure> {
        let mut asked = self.asked();
        for subject in &mut asked {
            subject.trials = self.conduct(subject, task)?;
            task.check()?;
        }
        Ok(asked)
    }

    /// What logs have of each joint that is asked for, and what was taken for what.
    fn logged(&self) -> Result<(Vec<Subject>, Vec<String>), Failure> {
        let mut asked = self.asked();
        let mut all = Logged::default();
        let model = &self.rig.model;
        let how = How {
            told: &self.columns,
            axis: self.only,
            count_rad: model.encoder.count_rad(),
            torque_nm_per_v: PanTilt::from_fn(|joint| model.motors[joint].torque_nm_per_v),
        };
        for one in &self.logs {
            if self.columns.is_empty() && log::is_own(one) {
                all.read(one)?;
            } else {
                foreign::read(&mut all, one, &how)?;
            }
        }
        for subject in &mut asked {
            subject.trials = std::mem::take(&mut all.trials[subject.joint]);
            subject.points = std::mem::take(&mut all.points[subject.joint]);
            subject.foreign(all.foreign[subject.joint])?;
            subject.leave_out_saturated();
            subject.divide();
        }
        asked.retain(|subject| !subject.trials.is_empty() || !subject.points.is_empty());
        let logs = table::names(&self.logs);
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
        Ok((asked, all.lines().collect()))
    }

    fn subject(&self, joint: Joint) -> Subject {
        let rig = &self.rig;
        let lumped = rig.model.bodies.lumped();
        let falls = joint == Joint::Tilt && !self.fixture;
        let believed = Believed {
            torque_nm_per_v: rig.model.motors[joint].torque_nm_per_v,
            dead_band_v: rig.model.motors[joint].dead_band_v,
            count_rad: rig.model.encoder.count_rad(),
            step_rad: rig.model.encoder.count_rad(),
            inertia_kg_m2: rig.model.own_inertia_kg_m2()[joint],
            another: false,
            gravity_nm: falls.then_some([lumped.gravity_c, lumped.gravity_s]),
            cables: !self.fixture,
        };
        let (trials, points, plateaus) = (Vec::new(), Vec::new(), Vec::new());
        Subject { joint, believed, trials, points, foreign: false, plateaus }
    }

    fn protocol(&self, limit_v: f64) -> Result<Protocol, Failure> {
        let steps = (self.most_v / self.step_v + 1e-9).floor();
        let strongest = self.most_v.max(self.pulse_v);
        if strongest > limit_v {
            let message = format!("{strongest} V is more than the {limit_v} V of the amplifier");
            return Err(Failure::usage("usage", message));
        }
        if steps < 1.0 {
            let message = format!("--step, {} V, is above --most, {} V", self.step_v, self.most_v);
            return Err(Failure::usage("usage", message));
        }
        if self.hold_s < 2.0 * self.pulse_s {
            let message = format!(
                "--hold must be twice --pulse-time at least, {} s, or what is seen is the pulse",
                2.0 * self.pulse_s
            );
            return Err(Failure::usage("usage", message));
        }
        let count = 2.0 * steps + 1.0;
        if count > MOST_VOLTAGES || count * (self.hold_s + self.pulse_s) > LONGEST_ALL_S {
            let message = format!(
                "{count} voltages, {} s each: give a longer --step; there may be {MOST_VOLTAGES}, and {LONGEST_ALL_S} s in all",
                self.hold_s + self.pulse_s
            );
            return Err(Failure::usage("usage", message));
        }
        let last = steps as i32;
        Ok(Protocol {
            volts: (-last..=last).map(|k| f64::from(k) * self.step_v).collect(),
            hold_s: self.hold_s,
            pulse_v: self.pulse_v,
            pulse_s: self.pulse_s,
        })
    }

    /// The trials of a joint on the simulated head.
    fn conduct(&self, subject: &Subject, task: Task<'_>) -> Result<Vec<Trial>, Failure> {
        let rig = &self.rig;
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
    pub(crate) const fn holds(&self) -> bool {
        self.fixture || !self.logs.is_empty()
    }

    /// The logs' names; of many that somebody else wrote the first.
    fn log_names(&self) -> String {
        if self.columns.is_empty() {
            return table::names(&self.logs);
        }
        table::few(&self.logs.iter().map(|log| log.name.clone()).collect::<Vec<_>>())
    }

    /// What was done, in words.
    pub(crate) fn in_words(&self) -> String {
        if !self.logs.is_empty() {
            return self.log_names();
        }
        let held = if self.fixture {
            "in a fixture, each axis upright and free"
        } else {
            "as it stands, to and fro within its range, gravity balanced"
        };
        format!(
            "rig {}, {held}: −{most} to {most} V in steps of {} V, held {} s at most, after {} s of {} V",
            self.rig.name,
            self.step_v,
            self.hold_s,
            self.pulse_s,
            self.pulse_v,
            most = (self.most_v / self.step_v + 1e-9).floor() * self.step_v,
        )
    }
}

impl Seen {
    /// What the simulated head did, as a log that can be given back: CSV, `axis,volt,time_s,count`; `None` where logs were read.
    #[must_use]
    pub fn log(&self) -> Option<String> {
        let all = self.subjects.iter().flat_map(|subject| &subject.trials);
        self.of.logs.is_empty().then(|| log::write(all))
    }
}

impl Subject {
    /// Takes in what is known of motion that somebody else wrote down.
    fn foreign(&mut self, known: Option<Known>) -> Result<(), Failure> {
        let Some(known) = known else { return Ok(()) };
        self.foreign = true;
        self.believed.another = true;
        self.believed.step_rad = known.step_rad;
        if known.speeds_alone && self.believed.gravity_nm.is_some() {
            let message = format!(
                "{}: weight turns it by its angle, and a log of speeds tells no angle: give positions (count= or angle= in --columns), \
                 or --fixture if its axis stood upright",
                self.joint
            );
            return Err(Failure::usage("friction-log", message));
        }
        // cables act by the angle, and hold nothing that turns on and on
        self.believed.cables &= !known.speeds_alone && !known.free;
        Ok(())
    }

    /// Leaves out trials and points whose speed stands at one value whatever the volts.
    fn leave_out_saturated(&mut self) {
        let by_motion = saturated(&self.trials, self.believed.count_rad, self.believed.step_rad);
        let volts: Vec<(f64, f64)> =
            self.points.iter().map(|p| (p.volts.unwrap_or_default(), p.rate_rad_s)).collect();
        let by_points = plateau(&volts, 0.0);
        drop_all(&mut self.trials, &by_motion);
        drop_all(&mut self.points, &by_points);
        self.plateaus = by_motion.into_iter().chain(by_points).collect();
    }

    /// Divides trials of somebody else's motor of which there are too few to tell how sure they are.
    fn divide(&mut self) {
        const FEW: usize = 6;
        const PARTS: usize = 4;
        if self.foreign && self.trials.len() < FEW {
            let joint = self.joint;
            let parts = self.trials.iter().flat_map(|trial| cut::divided(&trial.samples, PARTS));
            self.trials = parts.map(|samples| Trial { joint, samples }).collect();
        }
    }

    /// What was left out and why, a sentence each, after a line's end.
    pub(crate) fn left_out(&self) -> String {
        let one = |plateau: &Plateau| {
            let (count, from) = (plateau.points.len(), plateau.from_v);
            format!(
                "\n{} left out: {} stands at {:.1} rad/s from {from:.2} V on, whatever the volts: the amplifier's limit.",
                counted(count, "trial"),
                if count == 1 { "its speed" } else { "their speed" },
                plateau.value
            )
        };
        self.plateaus.iter().map(one).collect()
    }

    /// Share of the speeds' variance that what was found makes of the volts alone; of motors that somebody else measured.
    pub(crate) fn replayed(&self, found: &Curves) -> Option<f64> {
        replayed(&self.trials, &self.believed, found).filter(|_| self.foreign)
    }

    /// What the whole of its motion tells.
    pub(crate) fn curves(&self) -> Result<Curves, Failure> {
        if self.trials.is_empty() {
            let message = format!(
                "{}: torques and speeds do not tell this: give motion, axis,volt,time_s,count",
                self.joint
            );
            return Err(Failure::failed("friction", message));
        }
        let trials: Vec<_> = self.trials.iter().collect();
        curves(self.joint, &trials, &self.believed).map_err(|e| Failure::failed("friction", e))
    }
}
