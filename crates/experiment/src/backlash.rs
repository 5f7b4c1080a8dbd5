//! The play between encoder and beam, and whether the encoder slips, from where the spot rests on a ruler.

mod view;

use std::f64::consts::TAU;

use tracelight_lab::{Backlash, SpotPoint, backlash};
use tracelight_maths::{sin, tan};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{Between, LawName, MotionArray, RigConfig, follow_array};
use tracelight_task::{Failure, Task};

use crate::columns::{self, Columns, Kind, Quantity};
use crate::finding::Experiment;
use crate::parts::{self, tell_each};
use crate::table::{self, Log};

/// Where the spot rests after it came from either side: as logs have it, or tried with a simulated head.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig that the readings are of.
    pub rig: RigConfig,
    /// Logs with a row each reading: `axis,count,way,spot_m`; if none, the simulated head is tried.
    pub logs: Vec<Log>,
    /// Which columns of the logs hold what, where they are not this program's.
    pub columns: Columns,
    /// Only this joint, and the joint of logs that say none.
    pub only: Option<Joint>,
    /// From the head to the target, square-on, m.
    pub distance_m: f64,
    /// What the ruler is read to where the simulated head is tried, m.
    pub ruler_m: f64,
    /// How often each place is gone to from either side.
    pub cycles: u32,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// Play and slip of each joint.
pub struct Finding {
    of: Request,
    joints: Vec<Found>,
    /// What was taken for what in logs, a line each.
    said: Vec<String>,
}

/// What somebody else's log has.
const KIND: Kind = Kind {
    code: "backlash-log",
    must: &[&[Quantity::Count], &[Quantity::Way], &[Quantity::Spot]],
    may: &[],
    own: "axis,count,way,spot_m",
};

/// A reading: what a log's row says.
#[derive(Clone, Copy)]
struct Reading {
    count: i32,
    way: i32,
    spot_m: f64,
}

type Found = parts::Found<Reading, Backlash>;

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        if self.distance_m <= 0.0 {
            return Err(Failure::usage("usage", "--distance must be above zero"));
        }
        let (readings, said) = if self.logs.is_empty() {
            (PanTilt::from_fn(|joint| self.tried(joint)), Vec::new())
        } else {
            self.logged()?
        };
        let count_rad = self.rig.model.encoder.count_rad();
        let tell = |joint: Joint, readings: &[Reading]| {
            let points: Vec<SpotPoint> = readings.iter().map(|r| point(r, count_rad)).collect();
            backlash(&points, self.distance_m).ok_or_else(|| {
                let count = points.len();
                let message = format!(
                    "{joint}: {count} readings tell no play; give four at least, from both sides, in turns"
                );
                Failure::failed("backlash", message)
            })
        };
        let nothing = || {
            let message = format!("{}: no reading of the joint that is asked for", self.names());
            Failure::usage("backlash-log", message)
        };
        let joints = tell_each(self.only, readings, tell, nothing)?;
        Ok(Finding { of: self, joints, said })
    }
}

fn point(reading: &Reading, count_rad: f64) -> SpotPoint {
    SpotPoint {
        angle_rad: f64::from(reading.count) * count_rad,
        way: f64::from(reading.way),
        spot_m: reading.spot_m,
    }
}

impl Request {
    /// Readings of the simulated head, driven by the law that rests where it should: what rests a little before it, from either side, looks
    /// like play.
    fn tried(&self, joint: Joint) -> Vec<Reading> {
        let mut rig = self.rig.clone();
        rig.set_law(LawName::State, None);
        let rig = &rig;
        const PLACES: i32 = 9;
        const REACH_RAD: f64 = 0.3;
        /// How far off it goes before it comes from that side, rad.
        const RUN_RAD: f64 = 0.06;
        const MOVE_S: f64 = 0.5;
        const REST_S: f64 = 0.4;
        let (lower, upper) = rig.model.geometry.range_rad[joint];
        let reach = REACH_RAD.min(0.8 * upper).min(-0.8 * lower).max(0.0);
        let places = (0..PLACES).map(|k| reach * f64::from(2 * k - PLACES + 1) / f64::from(PLACES - 1));
        let visits = places.flat_map(|place| [(place, 1), (place, -1)]);
        // two counts further each time, so that the ruler's marks lie elsewhere
        let shifted = |cycle: u32| {
            let by = f64::from(2 * (cycle % 3)) * rig.model.encoder.count_rad();
            visits.clone().map(move |(place, way)| (place + by, way))
        };
        let visits: Vec<(f64, i32)> = (0..self.cycles).flat_map(shifted).collect();
        let mut rows = vec![(0.0, 0.0)];
        let mut rests = Vec::new();
        for &(place, way) in &visits {
            for to in [place - f64::from(way) * RUN_RAD, place] {
                travel(&mut rows, to, (MOVE_S, REST_S));
            }
            rests.push((rows.last().map_or(0.0, |row| row.0), way));
        }
        let with = |angle: f64| {
            let mut both = PanTilt::default();
            both[joint] = angle;
            both
        };
        let rows: Vec<(f64, PanTilt<f64>)> = rows.into_iter().map(|(t, angle)| (t, with(angle))).collect();
        // rows rise and are finite by how they are made
        let Ok(array) = MotionArray::new(&rows, Between::Spline) else { return Vec::new() };
        let ticks = follow_array(rig, &array, 0.1, self.seed);
        let read = |&(time_s, way): &(f64, i32)| {
            let tick = ticks.get((time_s / TICK_F64_S) as usize)?;
            let spot_m = -self.distance_m * tan(tick.beam_rad[joint]);
            let spot_m = (spot_m / self.ruler_m).round() * self.ruler_m;
            Some(Reading { count: tick.measured[joint].count, way, spot_m })
        };
        rests.iter().filter_map(read).collect()
    }

    /// Readings of each joint, and what was taken for what.
    fn logged(&self) -> Result<(PanTilt<Vec<Reading>>, Vec<String>), Failure> {
        const OWN: [&str; 4] = ["axis", "count", "way", "spot_m"];
        const MOST_M: f64 = 1e3;
        let mut readings: PanTilt<Vec<Reading>> = PanTilt::default();
        let mut said = Vec::new();
        for log in &self.logs {
            if !(self.columns.is_empty() && table::is_own(log, &OWN, |names| names.all(OWN).is_ok())) {
                said.push(self.told(log, &mut readings)?);
                continue;
            }
            table::read(
                log,
                "backlash-log",
                |names| names.all(OWN),
                |&[axis, count, way, spot], row| {
                    let came = row.whole(way)?;
                    if came.abs() != 1 {
                        return Err(format!(":{}: way {came} is neither 1 nor -1", row.line));
                    }
                    readings[row.joint(axis)?].push(Reading {
                        count: row.whole(count)?,
                        way: came,
                        spot_m: row.up_to(spot, MOST_M, "any target is wide")?,
                    });
                    Ok(())
                },
            )?;
        }
        Ok((readings, said))
    }

    /// Reads one of somebody else's logs; what was taken for what.
    fn told(&self, log: &Log, readings: &mut PanTilt<Vec<Reading>>) -> Result<String, Failure> {
        let found = columns::read(log, &self.columns, self.only, &KIND)?;
        for reading in &found.readings {
            let (count, way) = (reading.get(Quantity::Count), reading.get(Quantity::Way));
            if count.fract() != 0.0 || count.abs() > f64::from(i32::MAX) || way.abs() != 1.0 {
                let message = format!(
                    "{}:{}: count {count} and way {way} are not a whole number and 1 or -1",
                    log.name, reading.line
                );
                return Err(Failure::usage(KIND.code, message));
            }
            let spot_m = reading.get(Quantity::Spot);
            readings[reading.joint].push(Reading { count: count as i32, way: way as i32, spot_m });
        }
        Ok(format!("{}: {}", log.name, found.said))
    }

    /// The logs' names.
    fn names(&self) -> String {
        table::names(&self.logs)
    }
}

/// A move from where the rows end, from rest to rest, and a rest.
fn travel(rows: &mut Vec<(f64, f64)>, to: f64, (move_s, rest_s): (f64, f64)) {
    const STEPS: i32 = 20;
    let (start_s, from) = rows.last().copied().unwrap_or_default();
    for k in 1..=STEPS {
        let x = f64::from(k) / f64::from(STEPS);
        let share = x - sin(TAU * x) / TAU;
        rows.push((start_s + move_s * x, from + share * (to - from)));
    }
    // a rest that a spline keeps
    rows.extend([0.02, 0.5 * rest_s, rest_s].map(|s| (start_s + move_s + s, to)));
}
