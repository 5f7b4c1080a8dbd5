//! Records of runs: what motors were given and encoders saw, tick by tick, read from and written to CSV.
//!
//! `trace.csv` is one. Columns are found by their names: `t_s`, `pan_count`, `tilt_count`, `pan_v`, `tilt_v` must be there;
//! `pan_edge_ms` (how long before the tick the last edge came), `pan_est_rad`, `pan_est_rad_s`, `pan_est_rad_s2`, the same of
//! tilt, `pan_lost` (counts to be added, because the encoder lost some) and `lap` may be.

use std::fmt::Write;

use tracelight_rig::{Actuation, Joint, Measurement, PanTilt, Setpoint, TICK_F64_S, Telemetry};
use tracelight_task::Failure;

use crate::table::{self, Log, Names, Row};

/// Most ticks of a record: half an hour.
const MOST_TICKS: usize = 1_800_000;
/// Most that an amplifier takes, V: as in rig files.
pub(crate) const MOST_V: f64 = 1e3;
/// Two rows are a tick apart to this much, s.
const SAME_S: f64 = 1e-5;

/// Reads a record; one for each lap. A count is `count_rad` rad.
///
/// # Errors
/// `record`: what is wrong, with the log's name and the line.
pub fn read(log: &Log, count_rad: f64) -> Result<Vec<Vec<Telemetry>>, Failure> {
    parse(&log.bytes, count_rad).map_err(|what| Failure::usage("record", format!("{}{what}", log.name)))
}

/// Whether a log has the columns of a record, or some of them.
pub(crate) fn is_own(log: &Log) -> bool {
    table::begins(log, |names| {
        names.find("t_s").is_some() && names.find("pan_count").or(names.find("tilt_count")).is_some()
    })
}

/// Where each column is.
struct Columns {
    time: usize,
    count: PanTilt<usize>,
    volts: PanTilt<usize>,
    edge: PanTilt<Option<usize>>,
    lost: PanTilt<Option<usize>>,
    /// Angle, speed, acceleration.
    estimate: PanTilt<[Option<usize>; 3]>,
    lap: Option<usize>,
}

impl Columns {
    fn of(names: &Names) -> Result<Self, String> {
        let find = |name: &str| names.find(name);
        let must = |name: &str| {
            let what = ": no column {name}; a record has t_s, pan_count, tilt_count, pan_v, tilt_v, as trace.csv does";
            find(name).ok_or_else(|| what.replace("{name}", name))
        };
        let name = |j: Joint, what: &str| format!("{}_{what}", if j == Joint::Pan { "pan" } else { "tilt" });
        let both = |what: &str| -> Result<PanTilt<usize>, String> {
            Ok(PanTilt::new(must(&name(Joint::Pan, what))?, must(&name(Joint::Tilt, what))?))
        };
        Ok(Self {
            time: must("t_s")?,
            count: both("count")?,
            volts: both("v")?,
            edge: PanTilt::from_fn(|j| find(&name(j, "edge_ms"))),
            lost: PanTilt::from_fn(|j| find(&name(j, "lost"))),
            estimate: PanTilt::from_fn(|j| {
                ["est_rad", "est_rad_s", "est_rad_s2"].map(|what| find(&name(j, what)))
            }),
            lap: find("lap"),
        })
    }
}

fn parse(bytes: &[u8], count_rad: f64) -> Result<Vec<Vec<Telemetry>>, String> {
    let mut laps: Vec<Vec<Telemetry>> = Vec::new();
    let (mut lap, mut last_s, mut ticks) = (None, f64::NEG_INFINITY, 0);
    table::parse(bytes, Columns::of, |columns, row| {
        let line = row.line;
        let time_s = row.number(columns.time)?;
        let number = columns.lap.map(|c| row.text(c).to_owned());
        if laps.is_empty() || number != lap {
            laps.push(Vec::new());
        } else if (time_s - last_s - TICK_F64_S).abs() > SAME_S {
            return Err(format!(
                ":{line}: {time_s} s comes {:.4} ms after the row before; rows must be {} ms apart, each a control tick",
                1e3 * (time_s - last_s),
                1e3 * TICK_F64_S
            ));
        }
        (lap, last_s, ticks) = (number, time_s, ticks + 1);
        if ticks > MOST_TICKS {
            return Err(format!(":{line}: a record has at most {MOST_TICKS} rows; give a part of it"));
        }
        let telemetry = telemetry(columns, row, count_rad)?;
        laps.last_mut().into_iter().for_each(|lap| lap.push(telemetry));
        Ok(())
    })?;
    Ok(laps)
}

fn telemetry(columns: &Columns, row: &Row<'_>, count_rad: f64) -> Result<Telemetry, String> {
    let mut told = Telemetry::default();
    let mut command_v = PanTilt::default();
    for j in Joint::BOTH {
        let count = row.whole(columns.count[j])?;
        let age = row.optional(columns.edge[j])?.map(|ms| 1e-3 * ms / TICK_F64_S);
        if let Some(age) = age.filter(|age| !(0.0..=1.0 + SAME_S).contains(age)) {
            let (at, most) = (1e3 * TICK_F64_S * age, 1e3 * TICK_F64_S);
            return Err(format!(":{}: an edge {at} ms before its tick; it must be 0 to {most} ms", row.line));
        }
        // what is all but a tick old may be written as one
        let edge_age_ticks = age.map(|age| (age as f32).min(1.0 - f32::EPSILON));
        told.measured[j] = Measurement { count, edge_age_ticks };
        told.lost_counts[j] = columns.lost[j].map_or(Ok(0), |column| row.whole(column))?;
        let volts = row.number(columns.volts[j])?;
        if volts.abs() > MOST_V {
            return Err(format!(":{}: {volts} V is more than the {MOST_V} V of any amplifier", row.line));
        }
        command_v[j] = volts as f32;
        let [angle, rate, acceleration] = columns.estimate[j];
        let angle_rad = row.optional(angle)?.unwrap_or(f64::from(count) * count_rad) as f32;
        told.position_rad[j] = angle_rad;
        // what the other joint did; where nobody says, it is left out
        told.setpoint[j] = Setpoint {
            position_rad: angle_rad,
            velocity_rad_s: row.optional(rate)?.unwrap_or_default() as f32,
            acceleration_rad_s2: row.optional(acceleration)?.unwrap_or_default() as f32,
        };
    }
    told.actuation = Actuation { command_v, ..Actuation::default() };
    Ok(told)
}

/// A record as CSV.
#[must_use]
pub fn write(record: &[Telemetry]) -> String {
    let mut text = String::from(
        "t_s,pan_count,tilt_count,pan_v,tilt_v,pan_edge_ms,tilt_edge_ms,pan_est_rad,tilt_est_rad,pan_est_rad_s,tilt_est_rad_s,\
         pan_est_rad_s2,tilt_est_rad_s2,pan_lost,tilt_lost\n",
    );
    let edge = |measured: Measurement| {
        measured
            .edge_age_ticks
            .map_or(String::new(), |age| format!("{:.6}", f64::from(age) * TICK_F64_S * 1e3))
    };
    for (number, told) in record.iter().enumerate() {
        let (seen, given) = (&told.measured, &told.actuation.command_v);
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "{:.3},{},{},{:.5},{:.5},{},{},{:.7},{:.7},{:.5},{:.5},{:.3},{:.3},{},{}",
            number as f64 * TICK_F64_S,
            seen.pan.count,
            seen.tilt.count,
            given.pan,
            given.tilt,
            edge(seen.pan),
            edge(seen.tilt),
            told.position_rad.pan,
            told.position_rad.tilt,
            told.velocity_rad_s.pan,
            told.velocity_rad_s.tilt,
            told.acceleration_rad_s2.pan,
            told.acceleration_rad_s2.tilt,
            told.lost_counts.pan,
            told.lost_counts.tilt,
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        parse(text.as_bytes(), 1e-3).unwrap_err()
    }

    #[test]
    fn what_is_written_reads_back() {
        let mut told = Telemetry::default();
        told.measured.pan = Measurement { count: -7, edge_age_ticks: Some(0.25) };
        told.actuation.command_v.tilt = -1.25;
        told.lost_counts.pan = 2;
        let laps = parse(write(&[Telemetry::default(), told]).as_bytes(), 1e-3).unwrap();
        assert_eq!(laps.len(), 1);
        assert_eq!(laps[0][1].measured, told.measured);
        assert_eq!(laps[0][1].actuation, told.actuation);
    }

    #[test]
    fn laps_are_records_of_their_own() {
        let text = "lap,t_s,pan_count,tilt_count,pan_v,tilt_v\n1,0,0,0,0,0\n1,0.001,1,0,0,0\n2,0,0,0,0,0\n";
        let laps = parse(text.as_bytes(), 0.5).unwrap();
        assert_eq!(laps.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        assert_eq!(laps[0][1].position_rad.pan, 0.5);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        assert!(error("t_s,pan_count\n").contains("no column tilt_count"));
        let head = "t_s,pan_count,tilt_count,pan_v,tilt_v\n";
        assert!(error(&format!("{head}0,0,0,0,x\n")).contains(":2: \"x\" in column 5 is no number"));
        assert!(error(&format!("{head}0,0,1.5,0,0\n")).contains("is no count"));
        assert!(error(&format!("{head}0,0,0,0,0\n0.002,0,0,0,0\n")).contains(":3:"));
        assert!(error(&format!("{head}0,0,0,nan,0\n")).contains("is no number"));
    }
}
