//! What a joint did under voltages, as a table: `axis,volt,time_s,count`, or torques and steady speeds, `axis,torque_nm,velocity_rad_s`.

use std::fmt::Write;

use tracelight_lab::{Sample, SteadyPoint, Trial};
use tracelight_rig::{Joint, PanTilt};
use tracelight_task::Failure;

use crate::columns::Columns as Told;
use crate::record::MOST_V;
use crate::table::{self, Log, Names, Row};

/// Most trials of a joint.
const MOST_TRIALS: usize = 10_000;
/// A longer time between two rows is a new trial, s.
const LONGEST_GAP_S: f64 = 10.0;

/// Whether a log has this program's columns.
pub(super) fn is_own(log: &Log) -> bool {
    const OWN: [&str; 6] = ["axis", "volt", "time_s", "count", "torque_nm", "velocity_rad_s"];
    table::is_own(log, &OWN, |names| columns(names).is_ok())
}

/// What logs have of each joint.
#[derive(Default)]
pub(super) struct Logged {
    pub(super) trials: PanTilt<Vec<Trial>>,
    pub(super) points: PanTilt<Vec<SteadyPoint>>,
    /// What is known of motion that others wrote down; `None` where there is none.
    pub(super) foreign: PanTilt<Option<Known>>,
    /// What was taken for what, and in which logs.
    said: Vec<(Vec<String>, String)>,
}

/// What is known of motion that others wrote down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known {
    /// How finely places are known, rad.
    pub(super) step_rad: f64,
    /// Speeds were seen, and no places: where the joint stood is not known.
    pub(super) speeds_alone: bool,
    /// Turned by more than a turn, so that no cable holds it.
    pub(super) free: bool,
}

impl Known {
    /// What is known of both.
    pub(super) const fn with(self, other: Self) -> Self {
        Self {
            step_rad: self.step_rad.max(other.step_rad),
            speeds_alone: self.speeds_alone || other.speeds_alone,
            free: self.free || other.free,
        }
    }
}

/// What is told of logs that are not this program's.
pub(super) struct How<'a> {
    pub(super) told: &'a Told,
    /// The joint that they are of, where no column says.
    pub(super) axis: Option<Joint>,
    /// Width of a count, rad, and torque a volt of each joint, N m.
    pub(super) count_rad: f64,
    pub(super) torque_nm_per_v: PanTilt<f64>,
}

/// Which columns hold what.
enum Columns {
    Counted { volt: usize, time_s: usize, count: usize },
    Measured { torque_nm: usize, rate_rad_s: usize },
}

/// Where the axis and the rest is.
fn columns(names: &Names) -> Result<(usize, Columns), String> {
    let find = |name: &str| names.find(name);
    let all = (find("volt"), find("time_s"), find("count"), find("torque_nm"), find("velocity_rad_s"));
    let columns = match all {
        (Some(volt), Some(time_s), Some(count), ..) => Columns::Counted { volt, time_s, count },
        (.., Some(torque_nm), Some(rate_rad_s)) => Columns::Measured { torque_nm, rate_rad_s },
        _ => {
            return Err(
                ": its columns must be axis,volt,time_s,count or axis,torque_nm,velocity_rad_s".into()
            );
        }
    };
    let axis = find("axis").ok_or(": it has no column axis, with pan or tilt in each row")?;
    Ok((axis, columns))
}

impl Logged {
    /// Reads one more log with this program's columns.
    pub(super) fn read(&mut self, log: &Log) -> Result<(), Failure> {
        self.parse(&log.bytes).map_err(|what| Failure::usage("friction-log", format!("{}{what}", log.name)))
    }

    /// Puts down what was taken for what in a log.
    pub(super) fn say(&mut self, name: &str, what: &str) {
        match self.said.iter_mut().find(|(_, said)| said == what) {
            Some((names, _)) => names.push(name.to_owned()),
            None => self.said.push((vec![name.to_owned()], what.to_owned())),
        }
    }

    /// What was taken for what, a line each.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> {
        self.said.iter().map(|(names, what)| format!("{}: {what}", table::few(names)))
    }

    fn parse(&mut self, bytes: &[u8]) -> Result<(), String> {
        table::parse(bytes, columns, |(axis, columns), row| self.take(*axis, columns, row))?;
        for trials in [&mut self.trials.pan, &mut self.trials.tilt] {
            trials.retain(|trial| trial.samples.len() > 1);
        }
        Ok(())
    }

    fn take(&mut self, axis: usize, columns: &Columns, row: &Row<'_>) -> Result<(), String> {
        let (joint, line) = (row.joint(axis)?, row.line);
        match *columns {
            Columns::Counted { volt, time_s, count } => {
                let volts = row.up_to(volt, MOST_V, "any amplifier takes, V")?;
                let sample =
                    Sample { time_s: row.number(time_s)?, volts, count: f64::from(row.whole(count)?) };
                self.put(joint, sample);
                if self.trials[joint].len() > MOST_TRIALS {
                    return Err(format!(
                        ":{line}: {joint} has more than {MOST_TRIALS} trials: a time that goes back, or stands still for {LONGEST_GAP_S} s, begins one"
                    ));
                }
            }
            Columns::Measured { torque_nm, rate_rad_s } => self.points[joint].push(SteadyPoint {
                volts: None,
                torque_nm: row.number(torque_nm)?,
                rate_rad_s: row.number(rate_rad_s)?,
            }),
        }
        Ok(())
    }

    /// Puts a sample to the joint's trial that it follows, or begins one. Of rows at one time the first counts.
    fn put(&mut self, joint: Joint, sample: Sample) {
        let trials = &mut self.trials[joint];
        let before = trials.last().and_then(|trial| trial.samples.last()).map(|before| before.time_s);
        match (trials.last_mut(), before) {
            (Some(_), Some(before_s)) if sample.time_s == before_s => {}
            (Some(trial), Some(before_s)) if (0.0..LONGEST_GAP_S).contains(&(sample.time_s - before_s)) => {
                trial.samples.push(sample);
            }
            _ => trials.push(Trial { joint, samples: vec![sample] }),
        }
    }
}

/// The table of some trials.
pub(super) fn write<'a>(trials: impl Iterator<Item = &'a Trial>) -> String {
    let mut text = String::from("axis,volt,time_s,count\n");
    for trial in trials {
        for sample in &trial.samples {
            // writing to a String cannot fail
            let _ =
                writeln!(text, "{},{:.6},{:.3},{}", trial.joint, sample.volts, sample.time_s, sample.count);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Logged, String> {
        let mut log = Logged::default();
        log.parse(text.as_bytes()).map(|()| log)
    }

    #[test]
    fn what_is_written_reads_back() {
        let sample = |k: i32| Sample { time_s: 0.01 * f64::from(k), volts: 0.75, count: f64::from(k * k) };
        let trial = |joint| Trial { joint, samples: (0..5).map(sample).collect() };
        let all = [trial(Joint::Pan), trial(Joint::Pan), trial(Joint::Tilt)];
        let log = parsed(&write(all.iter())).unwrap();
        assert_eq!(log.trials.pan, all[..2]);
        assert_eq!(log.trials.tilt, all[2..]);
    }

    #[test]
    fn time_that_goes_back_or_stops_begins_a_trial() {
        let head = "axis,volt,time_s,count\n";
        let text =
            format!("{head}pan,1,0,0\npan,1,0.1,4\npan,-1,0,0\npan,-1,0.1,-4\npan,-1,50,0\npan,-1,50.1,-4\n");
        assert_eq!(parsed(&text).unwrap().trials.pan.len(), 3);
    }

    #[test]
    fn rows_of_both_joints_may_take_turns_and_times_may_be_rounded() {
        let text = "axis,volt,time_s,count\npan,1,0,0\ntilt,1,0,0\npan,1,0.001,1\ntilt,1,0.001,1\npan,1,0.001,2\npan,1,0.002,2\n";
        let log = parsed(text).unwrap();
        assert_eq!((log.trials.pan.len(), log.trials.tilt.len()), (1, 1));
        assert_eq!((log.trials.pan[0].samples.len(), log.trials.tilt[0].samples.len()), (3, 2));
    }

    #[test]
    fn measured_torques_are_points() {
        let log = parsed("axis,torque_nm,velocity_rad_s\ntilt,0.06,1\n").unwrap();
        assert_eq!(log.points.tilt.len(), 1);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let error = |text: &str| parsed(text).err().unwrap();
        assert!(error("axis,volt\n").contains("axis,torque_nm,velocity_rad_s"));
        assert!(error("volt,time_s,count\n").contains("no column axis"));
        assert!(error("axis,volt,time_s,count\nyaw,1,0,0\n").contains(":2: axis \"yaw\""));
        assert!(
            error("axis,volt,time_s,count\npan,1,0,0.5\n").contains(":2: \"0.5\" in column 4 is no count")
        );
        assert!(error("axis,volt,time_s,count\npan,1e9,0,0\n").contains("any amplifier"));
        let backwards: String = (0..20_001).map(|k| format!("pan,1,{},0\n", -k)).collect();
        assert!(error(&format!("axis,volt,time_s,count\n{backwards}")).contains("trials"));
        assert!(error("axis,torque_nm,velocity_rad_s\npan,inf,0\n").contains("no number"));
    }
}
