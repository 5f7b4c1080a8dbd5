//! What the head is made of: inertia, friction, weight, amplifier, where its encoders' edges lie.

mod one_joint;
mod view;

use std::ops::ControlFlow;

use tracelight_aim::HeadPose;
use tracelight_lab::{Identification, identify, identify_one, routine};
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_rig::{Joint, Telemetry};
use tracelight_sim::{RigConfig, SimulatedRig, run_segments};
use tracelight_task::{Failure, Task};

use self::one_joint::{OneJoint, one_joint};
use crate::columns::Columns;
use crate::finding::{Experiment, Improved};
use crate::numbers::why_unfinished;
use crate::record;
use crate::table::Log;

/// Least swing that tells anything: twenty counts of the original rig.
const LEAST_SWING_RAD: f64 = 0.05;

/// A rig to identify: from records, or from how the simulated rig moves.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig as it is believed to be, and the law that moves it.
    pub rig: RigConfig,
    /// Records of what the rig did, see [`crate::record`]; if none, the simulated rig moves in the dark.
    pub records: Vec<Log>,
    /// Which columns of the records hold what, where they are not this program's: then they are of one joint.
    pub columns: Columns,
    /// The joint of records that say none.
    pub axis: Option<Joint>,
    /// Of what differs from head to head.
    pub seed: u64,
    /// Which day it is, such as 2026-11-23: the better rig is of that day.
    pub day: String,
}

/// What the rig was believed to be made of, and what it is made of.
pub struct Finding {
    of: Request,
    records: Vec<Vec<Telemetry>>,
    found: Identification,
    /// The joints that were identified.
    joints: Vec<Joint>,
    /// What was taken for what in records, a line each.
    said: Vec<String>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, task: Task<'_>) -> Result<Finding, Failure> {
        let (records, one) = self.seen(task)?;
        let found = one.as_ref().map_or_else(
            || identify(&self.rig, &records),
            |one| identify_one(&self.rig, &one.records, one.joint),
        );
        let mut found = found.map_err(|e| Failure::failed("identify", e))?;
        if Joint::BOTH.iter().any(|&j| found.joints[j].taken)
            && let Some(identified) = &mut found.rig.identified
        {
            identified.date.clone_from(&self.day);
        }
        let Some(OneJoint { joint, records, said }) = one else {
            return Ok(Finding { of: self, records, found, joints: Joint::BOTH.into(), said: Vec::new() });
        };
        Ok(Finding { of: self, records, found, joints: vec![joint], said })
    }
}

impl Request {
    /// Records of both joints, or of one by somebody else's logs.
    fn seen(&self, task: Task<'_>) -> Result<(Vec<Vec<Telemetry>>, Option<OneJoint>), Failure> {
        if self.records.is_empty() {
            return Ok((vec![self.moved(task)?], None));
        }
        let own = |log: &Log| self.columns.is_empty() && record::is_own(log);
        if self.records.iter().all(own) {
            return Ok((self.recorded()?, None));
        }
        let count_rad = self.rig.model.encoder.count_rad();
        Ok((Vec::new(), Some(one_joint(&self.records, &self.columns, self.axis, count_rad)?)))
    }

    fn recorded(&self) -> Result<Vec<Vec<Telemetry>>, Failure> {
        let count_rad = self.rig.model.encoder.count_rad();
        let mut all = Vec::new();
        for log in &self.records {
            all.extend(record::read(log, count_rad)?);
        }
        Ok(all)
    }

    /// The routine on the simulated rig, dark.
    fn moved(&self, task: Task<'_>) -> Result<Vec<Telemetry>, Failure> {
        let rig = &self.rig;
        let narrow = Joint::BOTH.into_iter().find(|&j| {
            let (lower, upper) = rig.model.geometry.range_rad[j];
            upper.min(-lower) < LEAST_SWING_RAD
        });
        if let Some(joint) = narrow {
            let (lower, upper) = rig.model.geometry.range_rad[joint];
            let message = format!(
                "{joint} may turn from {lower} to {upper} rad, and has to swing {LEAST_SWING_RAD} rad to either side of zero to be \
                 identified; give a record of a motion it can make"
            );
            return Err(Failure::failed("identify", message));
        }
        let segments = routine(rig);
        task.stage("moves", segments.last().map_or(0, |s| u64::from(s.end_tick())));
        let pose = HeadPose::square_on(DEFAULT_DISTANCE_M);
        let mut simulated = SimulatedRig::new(&rig.following(), pose, self.seed);
        let run = run_segments(&mut simulated, &segments, true, |_, tick| {
            task.at(u64::from(tick.telemetry.tick));
            if task.stop.is_wanted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        task.check()?;
        if !run.is_done() {
            let message = format!(
                "the head did not finish its motion ({}): its model may be too far off; correct torque_per_volt and friction in \
                 the rig file, or give a record of a motion it can make",
                why_unfinished(run.fault())
            );
            return Err(Failure::failed("unfinished", message));
        }
        Ok(run.telemetry())
    }
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.of.rig
    }

    // the rig with what was found; what explains its motion no better than what was believed is left out
    fn better(&self) -> &RigConfig {
        &self.found.rig
    }
}
