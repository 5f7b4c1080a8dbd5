//! Records of one joint from logs as people have them: volts and counts, a row each millisecond.

use tracelight_lab::standing;
use tracelight_rig::{Actuation, Joint, Measurement, PanTilt, TICK_F64_S, Telemetry};
use tracelight_task::{Failure, counted};

use crate::columns::{self, Columns, Kind, Quantity, Reading};
use crate::table::Log;

/// What somebody else's log has.
const KIND: Kind = Kind {
    code: "record",
    must: &[&[Quantity::Time], &[Quantity::Volt], &[Quantity::Count]],
    may: &[],
    own: "t_s,pan_count,tilt_count,pan_v,tilt_v, as trace.csv has",
};
/// A row is in its tick within that share of it.
const IN_TICK: f64 = 0.3;
/// Most ticks without a row that are filled in: an edge among them is known a little worse.
const MOST_FILLED: usize = 3;
/// Rows of which half are further apart than that, s, tell no edges.
const COARSE_S: f64 = 1.5e-3;
/// Speeds are told over so many ticks, and stand where they do so for so many.
const OVER_TICKS: usize = 50;
const STANDS_TICKS: usize = 100;

/// A joint's records, in which ticks follow each other without a gap.
pub(super) struct OneJoint {
    pub(super) joint: Joint,
    pub(super) records: Vec<Vec<Telemetry>>,
    /// What was taken for what, filled in and left out, a line each.
    pub(super) said: Vec<String>,
}

/// Reads logs of one joint.
pub(super) fn one_joint(
    logs: &[Log],
    columns: &Columns,
    axis: Option<Joint>,
    count_rad: f64,
) -> Result<OneJoint, Failure> {
    let mut all = OneJoint { joint: axis.unwrap_or(Joint::Pan), records: Vec::new(), said: Vec::new() };
    for (number, log) in logs.iter().enumerate() {
        let fails = |what: &str| Failure::usage(KIND.code, format!("{}: {what}", log.name));
        if columns::tells(log, columns, Quantity::Speed) && !columns::tells(log, columns, Quantity::Count) {
            return Err(fails(
                "edges of an encoder are asked here, and a log of speeds has none: tracelight lab friction and lab inertia take it",
            ));
        }
        let found = columns::read(log, columns, axis, &KIND)?;
        let of = axis.or_else(|| found.readings.first().map(|reading| reading.joint));
        let joint = of.ok_or_else(|| fails("it has no row"))?;
        if number > 0 && joint != all.joint
            || axis.is_none() && found.readings.iter().any(|r| r.joint != joint)
        {
            return Err(fails("rows of both joints: say with --axis which one is to be identified"));
        }
        all.joint = joint;
        let readings: Vec<&Reading> = found.of(joint).collect();
        all.said.push(format!("{}: {}", log.name, found.said));
        all.take(&readings, count_rad).map_err(|what| fails(&what))?;
    }
    Ok(all)
}

impl OneJoint {
    fn take(&mut self, readings: &[&Reading], count_rad: f64) -> Result<(), String> {
        let time = |reading: &Reading| reading.get(Quantity::Time);
        let mut steps: Vec<f64> = readings.windows(2).map(|pair| time(pair[1]) - time(pair[0])).collect();
        steps.sort_by(f64::total_cmp);
        let usual_s = steps.get(steps.len() / 2).copied().unwrap_or_default();
        if usual_s > COARSE_S {
            return Err(format!(
                "its rows are {:.4} ms apart, and edges are told by a row each millisecond: tracelight lab friction and lab inertia \
                 take it as it is",
                1e3 * usual_s
            ));
        }
        let (mut filled, mut record, mut first) = (0, Vec::new(), None::<f64>);
        for reading in readings {
            let count = reading.get(Quantity::Count);
            if count.fract() != 0.0 || count.abs() > f64::from(i32::MAX) {
                return Err(format!("line {}: {count} is no count", reading.line));
            }
            let place = first.map_or(0.0, |first| (time(reading) - first) / TICK_F64_S);
            let missing = (place - record.len() as f64).round();
            let in_tick = (place - place.round()).abs() <= IN_TICK;
            if reading.fresh || !in_tick || !(0.0..=MOST_FILLED as f64).contains(&missing) {
                self.put(std::mem::take(&mut record), count_rad);
                first = Some(time(reading));
            } else {
                filled += missing as usize;
                fill(&mut record, count as i32, missing as usize);
            }
            record.push((reading.get(Quantity::Volt), count as i32));
        }
        self.put(record, count_rad);
        if filled > 0 {
            self.said.push(format!(
                "{} that are missing are filled in from those beside them",
                counted(filled, "row")
            ));
        }
        Ok(())
    }

    /// Puts down volts and counts, without stretches whose speed stands at the amplifier's limit.
    fn put(&mut self, record: Vec<(f64, i32)>, count_rad: f64) {
        let volts: Vec<f64> = record.iter().map(|(volts, _)| *volts).collect();
        let over_s = OVER_TICKS as f64 * TICK_F64_S;
        let rate =
            |span: &[(f64, i32)]| f64::from(span[OVER_TICKS].1.wrapping_sub(span[0].1)) * count_rad / over_s;
        let rates: Vec<f64> = record.windows(OVER_TICKS + 1).map(rate).collect();
        let limits = standing(&volts[..rates.len()], &rates, STANDS_TICKS, count_rad / over_s);
        let limited: usize = limits.iter().map(|range| range.len() + OVER_TICKS).sum();
        if limited > 0 {
            let limited = counted(limited, "row");
            self.said.push(format!("{limited} left out: its speed stands at the same value there whatever the volts, the amplifier's limit"));
        }
        let out = |k: usize| limits.iter().any(|range| (range.start..range.end + OVER_TICKS).contains(&k));
        let mut part = Vec::new();
        for (k, row) in record.iter().enumerate() {
            if out(k) {
                self.records.push(std::mem::take(&mut part));
            } else {
                part.push(self.telemetry(row, count_rad));
            }
        }
        self.records.push(part);
        self.records.retain(|record| record.len() > 1);
    }

    fn telemetry(&self, &(volts, count): &(f64, i32), count_rad: f64) -> Telemetry {
        let mut told = Telemetry::default();
        let mut command_v = PanTilt::default();
        told.measured[self.joint] = Measurement { count, edge_age_ticks: None };
        told.position_rad[self.joint] = (f64::from(count) * count_rad) as f32;
        command_v[self.joint] = volts as f32;
        told.actuation = Actuation { command_v, ..Actuation::default() };
        told
    }
}

/// Ticks without a row: the volts hold, the counts go on evenly.
fn fill(record: &mut Vec<(f64, i32)>, to: i32, missing: usize) {
    let Some(&(volts, from)) = record.last() else { return };
    for k in 1..=missing {
        let share = k as f64 / (missing + 1) as f64;
        let way = f64::from(to.wrapping_sub(from)) * share;
        record.push((volts, from.wrapping_add(way.floor() as i32)));
    }
}
