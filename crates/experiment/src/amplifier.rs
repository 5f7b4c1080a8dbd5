//! What an amplifier makes of a volt, and what the turning motor's own voltage takes away.

mod view;

use tracelight_lab::{Amplifier, CurrentPoint, Plateau, amplifier, plateau};
use tracelight_rig::{Joint, PanTilt, TICK_F64_S};
use tracelight_sim::{MotorReading, Mounting, READ_TICKS, RigConfig, motor_readings};
use tracelight_task::{Failure, Task};

use crate::columns::{self, Columns, Kind, Quantity};
use crate::finding::{Experiment, Improved};
use crate::parts::{self, tell_each};
use crate::record::MOST_V;
use crate::table::{self, Log, Names};

/// Volts at amplifiers and amperes through motors: as logs have them, or tried with a simulated head.
#[derive(Clone, Debug)]
pub struct Request {
    /// The rig that the readings are of.
    pub rig: RigConfig,
    /// Logs with a row each reading: `axis,volt,ampere`, and `velocity_rad_s` if somebody looked at the speed; if none, the simulated
    /// head is tried in a fixture.
    pub logs: Vec<Log>,
    /// Which columns of the logs hold what, where they are not this program's.
    pub columns: Columns,
    /// Only this joint, and the joint of logs that say none.
    pub only: Option<Joint>,
    /// Torque at the joint for each ampere: the motor's constant times its gears and belt, N m/A.
    pub torque_nm_per_a: f64,
    /// Highest voltage, either way, that the simulated head is tried with, V.
    pub most_v: f64,
    /// The last digit of what the ammeter shows, A.
    pub ammeter_a: f64,
    /// Of what differs from head to head.
    pub seed: u64,
}

/// The amplifier of each joint.
pub struct Finding {
    of: Request,
    joints: Vec<Found>,
    better: RigConfig,
    /// What was taken for what in logs, a line each.
    said: Vec<String>,
    /// Readings of each joint that were left out: its current or its speed stands at a limit.
    left_out: PanTilt<Vec<Plateau>>,
}

/// What somebody else's log has.
const KIND: Kind = Kind {
    code: "amplifier-log",
    must: &[&[Quantity::Volt], &[Quantity::Ampere]],
    may: &[Quantity::Speed],
    own: "axis,volt,ampere[,velocity_rad_s]",
};
/// What this program's has.
const OWN: [&str; 4] = ["axis", "volt", "ampere", "velocity_rad_s"];

/// A joint's readings and what they say.
type Found = parts::Found<CurrentPoint, Amplifier>;

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let (mut readings, said) =
            if self.logs.is_empty() { (self.tried(), Vec::new()) } else { self.logged()? };
        let left_out = PanTilt::from_fn(|joint| limited(&mut readings[joint]));
        let tell = |joint: Joint, points: &[CurrentPoint]| {
            // of what lies within the dead band nothing comes, whatever the gain
            let motor = &self.rig.model.motors[joint];
            let beyond =
                points.iter().map(|point| CurrentPoint { volts: motor.beyond_v(point.volts), ..*point });
            let points: Vec<CurrentPoint> =
                beyond.filter(|point| motor.dead_band_v == 0.0 || point.volts != 0.0).collect();
            amplifier(&points).ok_or_else(|| {
                let count = points.len();
                let message = format!(
                    "{joint}: {count} readings tell no amplifier; give three at least, at different volts"
                );
                Failure::failed("amplifier", message)
            })
        };
        let nothing = || {
            let message = format!("{}: no reading of the joint that is asked for", table::names(&self.logs));
            Failure::usage("amplifier-log", message)
        };
        let joints = tell_each(self.only, readings, tell, nothing)?;
        let mut better = self.rig.clone();
        for Found { joint, told: amplifier, .. } in &joints {
            better.model.motors[*joint].torque_nm_per_v = amplifier.gain.value * self.torque_nm_per_a;
        }
        Ok(Finding { of: self, joints, better, said, left_out })
    }
}

impl Request {
    /// Readings of the simulated head: each voltage held for three seconds, up and down.
    fn tried(&self) -> PanTilt<Vec<CurrentPoint>> {
        const VOLTAGES: i32 = 8;
        const READINGS: usize = 30;
        let rig = &self.rig;
        let count_rad = rig.model.encoder.count_rad();
        PanTilt::from_fn(|joint| {
            let most = self.most_v.min(rig.model.motors[joint].limit_v);
            let volts: Vec<f64> = (1..=VOLTAGES)
                .flat_map(|k| [1.0, -1.0].map(|way| way * most * f64::from(k) / f64::from(VOLTAGES)))
                .collect();
            let seen = motor_readings(rig, joint, Mounting::Fixture, &volts, (READINGS, self.seed));
            let read = |reading: &MotorReading| CurrentPoint {
                volts: reading.volts,
                amperes: (reading.motor_nm / self.torque_nm_per_a / self.ammeter_a).round() * self.ammeter_a,
                rate_rad_s: Some(f64::from(reading.counts) * count_rad / (READ_TICKS as f64 * TICK_F64_S)),
            };
            // each second: readings beside each other are rounded alike, and tell no more than one of them
            seen.chunks(READINGS).flat_map(|held| held.iter().skip(4).step_by(10)).map(read).collect()
        })
    }

    /// What logs have of each joint, and what was taken for what.
    fn logged(&self) -> Result<(PanTilt<Vec<CurrentPoint>>, Vec<String>), Failure> {
        /// More than any motor of such a head takes, A, and turns with, rad/s.
        const MOST: f64 = 1e4;
        let mut points: PanTilt<Vec<CurrentPoint>> = PanTilt::default();
        let mut said = Vec::new();
        for log in &self.logs {
            let fits = |names: &Names| names.all(["axis", "volt", "ampere"]).is_ok();
            if !(self.columns.is_empty() && table::is_own(log, &OWN, fits)) {
                said.push(self.told(log, &mut points)?);
                continue;
            }
            table::read(
                log,
                "amplifier-log",
                |names| Ok((names.all(["axis", "volt", "ampere"])?, names.find("velocity_rad_s"))),
                |&([axis, volt, ampere], rate), row| {
                    let rate_rad_s = rate.filter(|&column| !row.text(column).is_empty());
                    points[row.joint(axis)?].push(CurrentPoint {
                        volts: row.up_to(volt, MOST_V, "any amplifier takes")?,
                        amperes: row.up_to(ampere, MOST, "any motor takes")?,
                        rate_rad_s: rate_rad_s
                            .map(|column| row.up_to(column, MOST, "any joint turns with"))
                            .transpose()?,
                    });
                    Ok(())
                },
            )?;
        }
        for joint in Joint::BOTH {
            let blind = points[joint].iter().filter(|point| point.rate_rad_s.is_none()).count();
            if blind > 0 && blind < points[joint].len() {
                let message = format!(
                    "{}: {blind} of {} readings of {joint} have no velocity_rad_s: give it in each, or leave the column out",
                    table::names(&self.logs),
                    points[joint].len()
                );
                return Err(Failure::usage("amplifier-log", message));
            }
        }
        Ok((points, said))
    }

    /// Reads one of somebody else's logs; what was taken for what.
    fn told(&self, log: &Log, points: &mut PanTilt<Vec<CurrentPoint>>) -> Result<String, Failure> {
        let found = columns::read(log, &self.columns, self.only, &KIND)?;
        for reading in &found.readings {
            points[reading.joint].push(CurrentPoint {
                volts: reading.get(Quantity::Volt),
                amperes: reading.get(Quantity::Ampere),
                rate_rad_s: found.has(Quantity::Speed).then(|| reading.get(Quantity::Speed)),
            });
        }
        Ok(format!("{}: {}", log.name, found.said))
    }
}

/// Leaves out readings at a limit: of those with the highest volts all have the same current, or the same speed.
fn limited(points: &mut Vec<CurrentPoint>) -> Vec<Plateau> {
    let of = |value: &dyn Fn(&CurrentPoint) -> f64| {
        plateau(&points.iter().map(|point| (point.volts, value(point))).collect::<Vec<_>>(), 0.0)
    };
    let currents = of(&|point| point.amperes);
    let found =
        if currents.is_empty() { of(&|point| point.rate_rad_s.unwrap_or_default()) } else { currents };
    let on = |number: usize| found.iter().any(|plateau| plateau.points.contains(&number));
    *points = points.iter().enumerate().filter(|(number, _)| !on(*number)).map(|(_, point)| *point).collect();
    found
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.of.rig
    }

    // the rig with the torque per volt of the amperes that were read
    fn better(&self) -> &RigConfig {
        &self.better
    }
}
