//! Trials from logs as people have them: positions or speeds over time under volts, or speeds that volts come to.

use tracelight_lab::{Sample, SteadyPoint, Trial};
use tracelight_rig::Joint;
use tracelight_task::Failure;

use super::cut::{cut, largest};
use super::log::{How, Known, Logged};
use crate::columns::{self, Found, Kind, Quantity, Reading};
use crate::table::Log;

/// Motion under volts.
const MOTION: Kind = Kind {
    code: "friction-log",
    must: &[&[Quantity::Time], &[Quantity::Volt], &[Quantity::Count, Quantity::Angle, Quantity::Speed]],
    may: &[],
    own: "axis,volt,time_s,count or axis,torque_nm,velocity_rad_s",
};
/// Speeds that volts or torques come to.
const STEADY: Kind = Kind {
    code: "friction-log",
    must: &[&[Quantity::Torque, Quantity::Volt], &[Quantity::Speed]],
    may: &[],
    own: "axis,volt,time_s,count or axis,torque_nm,velocity_rad_s",
};
/// Rows that are further apart tell speeds, but not how they change, s.
const SPARSE_S: f64 = 0.25;
/// A pause is longer than so many times what rows are usually apart, and than that, s.
const PAUSE_ROWS: f64 = 25.0;
const PAUSE_S: f64 = 0.5;
/// Time over which a speed's steps blur a place, s: half of that over which motion is judged.
const BLUR_S: f64 = 0.05;

/// Reads one more log into what logs have.
pub(super) fn read(all: &mut Logged, log: &Log, how: &How<'_>) -> Result<(), Failure> {
    let tells = |quantity| columns::tells(log, how.told, quantity);
    let over_time = tells(Quantity::Time) && !how.told.has(Quantity::Torque);
    let kind = if over_time { &MOTION } else { &STEADY };
    let found = columns::read(log, how.told, how.axis, kind)?;
    let mut said = found.said.clone();
    for joint in Joint::BOTH {
        let readings: Vec<&Reading> = found.of(joint).collect();
        if readings.is_empty() {
            continue;
        }
        if !over_time || are_sparse(&found, &readings) {
            if over_time {
                said += "; rows are seconds apart, each at another voltage: speeds are taken for steady";
            }
            all.points[joint].extend(readings.iter().map(|reading| point(&found, reading, joint, how)));
            continue;
        }
        let mut motion = Motion::of(&found, &readings, how.count_rad);
        if found.unsigned {
            motion.sign();
        } else if motion.has_no_sign() {
            let message = format!(
                "{}: its volts are never negative, and drive {joint} both ways: whose sign nobody wrote down is given as volt=|COLUMN|, \
                 and is then that of the motion",
                log.name
            );
            return Err(Failure::usage(MOTION.code, message));
        }
        let known = all.foreign[joint].get_or_insert(motion.known);
        *known = known.with(motion.known);
        all.trials[joint].extend(motion.trials(joint));
    }
    all.say(&log.name, &said);
    Ok(())
}

fn point(found: &Found, reading: &Reading, joint: Joint, how: &How<'_>) -> SteadyPoint {
    let rate_rad_s = reading.get(Quantity::Speed);
    if found.has(Quantity::Torque) {
        return SteadyPoint { volts: None, torque_nm: reading.get(Quantity::Torque), rate_rad_s };
    }
    let volts = reading.get(Quantity::Volt);
    SteadyPoint { volts: Some(volts), torque_nm: how.torque_nm_per_v[joint] * volts, rate_rad_s }
}

/// Speeds of which each was seen at another voltage than the one before, long after it.
fn are_sparse(found: &Found, readings: &[&Reading]) -> bool {
    let volts = |reading: &Reading| reading.get(Quantity::Volt);
    let alike = ALIKE * largest(readings.iter().map(|reading| volts(reading)));
    let changes = readings.windows(2).filter(|pair| (volts(pair[1]) - volts(pair[0])).abs() > alike).count();
    found.has(Quantity::Speed) && usual_step(readings) > SPARSE_S && 2 * changes > readings.len()
}

/// Share of the largest voltage by which volts differ that are the same.
const ALIKE: f64 = 1e-3;

/// What rows are apart, half of them at most, s.
fn usual_step(readings: &[&Reading]) -> f64 {
    let mut steps: Vec<f64> = readings
        .windows(2)
        .filter(|pair| !pair[1].fresh)
        .map(|pair| pair[1].get(Quantity::Time) - pair[0].get(Quantity::Time))
        .collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or_default()
}

/// Motion of one joint, in parts without a pause.
struct Motion {
    runs: Vec<Vec<Sample>>,
    known: Known,
    /// Width of a count, rad.
    count_rad: f64,
}

/// Time after a sample by which its drive is seen to turn the joint, s.
const WAY_S: f64 = 0.06;

impl Motion {
    fn of(found: &Found, readings: &[&Reading], count_rad: f64) -> Self {
        let (usual_s, speeds_alone) = (usual_step(readings), found.has(Quantity::Speed));
        let pause_s = PAUSE_S.max(PAUSE_ROWS * usual_s);
        let time = |reading: &Reading| reading.get(Quantity::Time);
        let parts = readings.chunk_by(|a, b| !b.fresh && time(b) - time(a) < pause_s);
        let places = |part: &[&Reading]| {
            let values = |of: Quantity| part.iter().map(|reading| reading.get(of)).collect::<Vec<f64>>();
            if speeds_alone {
                travelled(&values(Quantity::Time), &values(Quantity::Speed))
            } else if found.has(Quantity::Count) {
                unwound(values(Quantity::Count), COUNTER).into_iter().map(|count| count * count_rad).collect()
            } else {
                unwound(values(Quantity::Angle), std::f64::consts::TAU)
            }
        };
        let mut runs = Vec::new();
        let (mut step_rad, mut most_rad) = (f64::INFINITY, 0.0_f64);
        for part in parts.filter(|part| part.len() > 1) {
            let angles = places(part);
            let least = |numbers: &mut dyn Iterator<Item = f64>| smallest_step(&numbers.collect::<Vec<_>>());
            let own = if speeds_alone {
                BLUR_S.max(usual_s) * least(&mut part.iter().map(|r| r.get(Quantity::Speed)))
            } else {
                least(&mut angles.iter().copied())
            };
            step_rad = step_rad.min(own);
            let ends =
                angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(*a), h.max(*a)));
            most_rad = most_rad.max(ends.1 - ends.0);
            let sample = |(reading, angle): (&&Reading, f64)| Sample {
                time_s: reading.get(Quantity::Time) - part[0].get(Quantity::Time),
                volts: reading.get(Quantity::Volt),
                count: angle / count_rad,
            };
            runs.push(part.iter().zip(angles).map(sample).collect());
        }
        let step_rad = if step_rad.is_finite() { step_rad } else { 0.0 };
        let known = Known { step_rad, speeds_alone, free: most_rad > std::f64::consts::TAU };
        Self { runs, known, count_rad }
    }

    /// Ways that the joint goes at each sample over a while about it: 1, −1, or 0 where it stands.
    fn ways(run: &[Sample], still: f64) -> Vec<f64> {
        let at = |time_s: f64| run.partition_point(|sample| sample.time_s < time_s).min(run.len() - 1);
        let way = |sample: &Sample| {
            // what drives it now is seen a moment later
            let gone = run[at(sample.time_s + WAY_S)].count - run[at(sample.time_s)].count;
            if gone.abs() > still { gone.signum() } else { 0.0 }
        };
        run.iter().map(way).collect()
    }

    /// Volts that are never negative and turn the joint both ways.
    fn has_no_sign(&self) -> bool {
        /// Least share of driven motion either way.
        const SHARE: f64 = 0.1;
        let volts = || self.runs.iter().flatten().map(|sample| sample.volts);
        let least = ALIKE * largest(volts());
        if volts().any(|volts| volts < -least) {
            return false;
        }
        let still = self.known.step_rad / self.count_rad;
        let mut driven = [0_usize; 2];
        for run in &self.runs {
            for (sample, way) in run.iter().zip(Self::ways(run, still)).filter(|(s, _)| s.volts > least) {
                driven[usize::from(way < 0.0)] += usize::from(way != 0.0 && sample.volts > 0.0);
            }
        }
        let all = (driven[0] + driven[1]) as f64;
        driven.iter().all(|&count| count as f64 > SHARE * all)
    }

    /// Gives volts the sign of the motion that they make; what makes none keeps the last.
    fn sign(&mut self) {
        let still = self.known.step_rad / self.count_rad;
        for run in &mut self.runs {
            let mut last = 1.0;
            let ways = Self::ways(run, still);
            for (sample, way) in run.iter_mut().zip(ways) {
                last = if way == 0.0 { last } else { way };
                sample.volts *= last;
            }
        }
    }

    fn trials(self, joint: Joint) -> impl Iterator<Item = Trial> {
        let still = self.known.step_rad / self.count_rad;
        let runs = self.runs.into_iter().flat_map(move |run| cut(&run, still));
        runs.map(move |samples| Trial { joint, samples })
    }
}

/// Counters of 16 bits begin again beyond their end.
const COUNTER: f64 = 65_536.0;

/// Values that fall back by nearly a period between two rows go on.
fn unwound(mut values: Vec<f64>, period: f64) -> Vec<f64> {
    /// What is left of a period when it fell back.
    const NEARLY: f64 = 0.75;
    let (mut ahead, mut last) = (0.0, values.first().copied().unwrap_or_default());
    for value in &mut values {
        let raw = *value;
        if (raw - last).abs() > NEARLY * period && (raw - last).abs() <= period {
            ahead -= period * (raw - last).signum();
        }
        last = raw;
        *value = raw + ahead;
    }
    values
}

/// Where speeds lead, from 0: each pair's mean until the next.
fn travelled(times_s: &[f64], rates_rad_s: &[f64]) -> Vec<f64> {
    let mut angle = 0.0;
    let mut all = vec![0.0];
    for (times, rates) in times_s.windows(2).zip(rates_rad_s.windows(2)) {
        angle += 0.5 * (rates[0] + rates[1]) * (times[1] - times[0]);
        all.push(angle);
    }
    all
}

/// The least by which numbers differ, but for rounding.
fn smallest_step(numbers: &[f64]) -> f64 {
    /// Share of the largest that is rounding.
    const ROUNDING: f64 = 1e-9;
    let least = ROUNDING * largest(numbers.iter().copied());
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let steps = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > least);
    steps.fold(f64::INFINITY, f64::min)
}
