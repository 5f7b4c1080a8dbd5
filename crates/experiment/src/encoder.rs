//! What an encoder reads wrong: where its four kinds of edges lie, a disc beside its axis, counts it lost.

mod view;

use tracelight_lab::{EdgeTime, EncoderTable, Spin, encoder_table, spin};
use tracelight_rig::{Joint, PanTilt};
use tracelight_sim::{Mounting, RigConfig, head_alone};
use tracelight_task::{Failure, Task};

use crate::columns::{self, Columns, Kind, Quantity};
use crate::finding::Experiment;
use crate::parts::{self, tell_each};
use crate::table::{self, Log};

/// When edges came while a joint turned evenly: as logs have it, or tried with a simulated head.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig that the edges are of.
    pub rig: RigConfig,
    /// Logs with a row each edge: `axis,time_s,count`; if none, the simulated head is tried in a fixture.
    pub logs: Vec<Log>,
    /// Which columns of the logs hold what, where they are not this program's.
    pub columns: Columns,
    /// Only this joint, and the joint of logs that say none.
    pub only: Option<Joint>,
    /// How fast the simulated head turns, rad/s.
    pub speed_rad_s: f64,
    /// How many turns each way.
    pub turns: u32,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// What each joint's encoder reads wrong.
pub struct Finding {
    of: Request,
    joints: Vec<Found>,
    /// What was taken for what in logs, a line each.
    said: Vec<String>,
}

/// What somebody else's log has.
const KIND: Kind = Kind {
    code: "encoder-log",
    must: &[&[Quantity::Time], &[Quantity::Count]],
    may: &[],
    own: "axis,time_s,count",
};

/// A joint's runs one way, and what they say.
type Found = parts::Found<Vec<EdgeTime>, EncoderTable>;

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let (runs, said) = if self.logs.is_empty() {
            (PanTilt::from_fn(|joint| self.tried(joint)), Vec::new())
        } else {
            self.logged()?
        };
        let count_rad = self.rig.model.encoder.count_rad();
        let tell = |joint: Joint, runs: &[Vec<EdgeTime>]| {
            encoder_table(runs, count_rad).ok_or_else(|| {
                let most = runs.iter().map(Vec::len).max().unwrap_or_default();
                let message = format!(
                    "{joint}: the longest run one way has {most} edges; 192 are needed, at times that rise, of all four kinds: turn it further"
                );
                Failure::failed("encoder", message)
            })
        };
        let nothing = || {
            let message = format!("{}: no edge of the joint that is asked for", table::names(&self.logs));
            Failure::usage("encoder-log", message)
        };
        let joints = tell_each(self.only, runs, tell, nothing)?;
        Ok(Finding { of: self, joints, said })
    }
}

/// Where a log's last row of a joint was.
#[derive(Clone, Copy)]
struct Last {
    time_s: f64,
    count: i32,
    /// Which way it had come there; 0 if nobody knows.
    way: i32,
}

impl Request {
    /// The simulated head turned one way and the other.
    fn tried(&self, joint: Joint) -> Vec<Vec<EdgeTime>> {
        let rig = &self.rig;
        let motor = rig.model.motors[joint];
        let mut head = head_alone(rig, joint, Mounting::Fixture, self.seed);
        let mut turn = |rate_rad_s: f64| {
            let hold_v = motor.volts_for(rig.model.felt_friction(joint).torque(rate_rad_s));
            // gently, where it is to turn slowly
            let start_v = (2.0 + rate_rad_s.abs()) * hold_v.abs().max(0.01 * motor.limit_v);
            let how = Spin {
                start_v: start_v.min(0.5 * motor.limit_v).copysign(rate_rad_s),
                hold_v,
                rate_rad_s,
                count_rad: rig.model.encoder.count_rad(),
                turns: f64::from(self.turns),
            };
            spin(&mut head, joint, &how)
        };
        vec![turn(self.speed_rad_s), turn(-self.speed_rad_s)]
    }

    /// Runs of each joint, and what was taken for what.
    fn logged(&self) -> Result<(RunsOfEach, Vec<String>), Failure> {
        const OWN: [&str; 3] = ["axis", "time_s", "count"];
        let mut runs = Runs::default();
        let mut said = Vec::new();
        for log in &self.logs {
            runs.before = PanTilt::default();
            if !(self.columns.is_empty() && table::is_own(log, &OWN, |names| names.all(OWN).is_ok())) {
                said.push(self.told(log, &mut runs)?);
                continue;
            }
            table::read(
                log,
                "encoder-log",
                |names| names.all(OWN),
                |&[axis, time, count], row| {
                    let joint = row.joint(axis)?;
                    runs.take(joint, row.number(time)?, row.whole(count)?);
                    Ok(())
                },
            )?;
        }
        let mut runs = runs.all;
        for joint in Joint::BOTH {
            runs[joint].retain(|run| !run.is_empty());
        }
        Ok((runs, said))
    }

    /// Reads one of somebody else's logs; what was taken for what.
    fn told(&self, log: &Log, runs: &mut Runs) -> Result<String, Failure> {
        let fails = |what: String| Failure::usage(KIND.code, format!("{}{what}", log.name));
        let tells = |quantity| columns::tells(log, &self.columns, quantity);
        if tells(Quantity::Speed) && !tells(Quantity::Count) {
            return Err(fails(": an encoder is told by its counts, and a log of speeds has none".into()));
        }
        let found = columns::read(log, &self.columns, self.only, &KIND)?;
        for reading in &found.readings {
            let count = reading.get(Quantity::Count);
            if count.fract() != 0.0 || count.abs() > f64::from(i32::MAX) {
                return Err(fails(format!(":{}: {count} is no count", reading.line)));
            }
            if reading.fresh {
                runs.before[reading.joint] = None;
            }
            runs.take(reading.joint, reading.get(Quantity::Time), count as i32);
        }
        Ok(format!("{}: {}", log.name, found.said))
    }
}

/// Runs one way of each joint.
type RunsOfEach = PanTilt<Vec<Vec<EdgeTime>>>;

/// Runs of each joint, as rows come.
#[derive(Default)]
struct Runs {
    all: RunsOfEach,
    before: PanTilt<Option<Last>>,
}

impl Runs {
    /// Takes in a row.
    fn take(&mut self, joint: Joint, time_s: f64, count: i32) {
        let runs = &mut self.all[joint];
        let last = self.before[joint].replace(Last { time_s, count, way: 0 });
        // a time that goes back begins a run, of which the first row tells no way
        let Some(last) = last.filter(|last| last.time_s <= time_s) else {
            runs.push(Vec::new());
            return;
        };
        let way = (i64::from(count) - i64::from(last.count)).signum() as i32;
        self.before[joint] = Some(Last { time_s, count, way: if way == 0 { last.way } else { way } });
        if way == 0 {
            return;
        }
        if way == -last.way {
            runs.push(Vec::new());
        }
        // the edge that was crossed last is on the side it came from
        let edge = EdgeTime { time_s, edge: if way > 0 { count } else { count.wrapping_add(1) } };
        runs.last_mut().into_iter().for_each(|run| run.push(edge));
    }
}
