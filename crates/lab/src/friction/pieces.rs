//! Motion one way, and the equation of motion integrated along it.

use tracelight_maths::{powi, sin_cos};

use super::{Believed, Sample, Trial};

/// Unknowns: inertia, viscous and Coulomb friction each way, gravity with cos and sin, cables against the angle.
pub(super) const INERTIA: usize = 0;
pub(super) const VISCOUS: [usize; 2] = [1, 2];
pub(super) const COULOMB: [usize; 2] = [3, 4];
pub(super) const GRAVITY: [usize; 2] = [5, 6];
pub(super) const SPRING: usize = 7;
pub(super) const UNKNOWNS: usize = 8;

/// Speed below which friction is another: what sticks lets go slowly. rad/s.
pub(super) const LEAST_RAD_S: f64 = 0.05;
/// Time over which speed is judged, s.
const JUDGED_S: f64 = 0.1;
/// Counts in it at least.
const LEAST_COUNTS: f64 = 3.0;
/// Shortest stretch of motion, s.
pub(super) const SHORTEST_S: f64 = 0.2;
/// Motion one way, above the speed at which friction is another.
pub(super) struct Piece {
    /// Number of its trial.
    pub(super) trial: usize,
    /// 0 forwards, 1 backwards.
    pub(super) side: usize,
    /// Where the joint was in its middle, rad.
    pub(super) angle_rad: f64,
    /// Its mean speed, rad/s.
    pub(super) rate_rad_s: f64,
    /// One a sample.
    pub(super) rows: Vec<Row>,
}

/// The equation of motion integrated twice up to a sample, less what a straight line over time is of it.
#[derive(Clone, Copy, Default)]
pub(super) struct Row {
    /// What a unit of each unknown takes of it.
    pub(super) terms: [f64; UNKNOWNS],
    /// The motor's, N m s².
    pub(super) motor: f64,
}

/// How many trials pieces are of.
pub(super) fn trials_of<'a>(pieces: impl Iterator<Item = &'a Piece>) -> usize {
    pieces.map(|p| p.trial).collect::<std::collections::BTreeSet<_>>().len()
}

/// A trial's motion one way in pieces of equal length.
pub(super) fn pieces(number: usize, trial: &Trial, believed: &Believed, longest_s: f64) -> Vec<Piece> {
    let angles = trial.angles(believed.count_rad);
    let cut = stretches(trial, believed).into_iter().flat_map(|(from, to, side)| {
        let length_s = trial.samples[to - 1].time_s - trial.samples[from].time_s;
        let parts = (length_s / longest_s).ceil().max(1.0) as usize;
        let end = move |part: usize| from + (to - 1 - from) * part / parts;
        (0..parts).map(move |part| (end(part), end(part + 1) + 1, side))
    });
    let piece = |(from, to, side): (usize, usize, usize)| {
        let rows = rows(&trial.samples[from..to], &angles[from..to], believed, side);
        let lasts_s = trial.samples[to - 1].time_s - trial.samples[from].time_s;
        let rate_rad_s = (angles[to - 1] - angles[from]) / lasts_s;
        Piece { trial: number, side, angle_rad: angles[(from + to) / 2], rate_rad_s, rows }
    };
    cut.map(piece).collect()
}

/// From, to (not in it) and side of each stretch of motion.
fn stretches(trial: &Trial, believed: &Believed) -> Vec<(usize, usize, usize)> {
    let least = LEAST_RAD_S.max(LEAST_COUNTS * believed.step_rad / JUDGED_S);
    let way = |rate: f64| if rate.abs() < least { None } else { Some(usize::from(rate < 0.0)) };
    let ways: Vec<Option<usize>> =
        trial.speeds(believed.count_rad, JUDGED_S).into_iter().map(|(_, rate)| way(rate)).collect();
    let mut found = Vec::new();
    let mut from = 0;
    for run in ways.chunk_by(|a, b| a == b) {
        let to = from + run.len();
        let lasts_s = trial.samples[to - 1].time_s - trial.samples[from].time_s;
        if let (Some(side), true) = (run[0], lasts_s >= SHORTEST_S && run.len() >= 5) {
            found.push((from, to, side));
        }
        from = to;
    }
    found
}

/// Second integrals along a piece, and what a straight line over time leaves of them: where it was and how fast at its start is free.
fn rows(samples: &[Sample], angles: &[f64], believed: &Believed, side: usize) -> Vec<Row> {
    let start = (samples[0].time_s, angles[0]);
    let (mut torque, mut gravity, mut spring) = (Twice::default(), [Twice::default(); 2], Twice::default());
    let mut turned = 0.0;
    let mut rows = Vec::with_capacity(samples.len());
    for (i, sample) in samples.iter().enumerate() {
        if i > 0 {
            let step_s = sample.time_s - samples[i - 1].time_s;
            torque.hold(believed.torque_nm(samples[i - 1].volts), step_s);
            turned += 0.5 * step_s * (angles[i - 1] + angles[i] - 2.0 * start.1);
            let middle = 0.5 * (angles[i - 1] + angles[i]);
            let (sin, cos) = sin_cos(middle);
            spring.hold(middle, step_s);
            gravity[0].hold(cos, step_s);
            gravity[1].hold(sin, step_s);
        }
        let since = sample.time_s - start.0;
        let mut row = Row { motor: torque.twice, ..Row::default() };
        row.terms[INERTIA] = angles[i] - start.1;
        row.terms[VISCOUS[side]] = turned;
        row.terms[COULOMB[side]] = 0.5 * since * since;
        if believed.gravity_nm.is_some() {
            (row.terms[GRAVITY[0]], row.terms[GRAVITY[1]]) = (-gravity[0].twice, -gravity[1].twice);
        }
        if believed.cables {
            row.terms[SPRING] = spring.twice;
        }
        rows.push(row);
    }
    without_start(samples, rows)
}

/// An integral and its integral.
#[derive(Clone, Copy, Default)]
struct Twice {
    once: f64,
    twice: f64,
}

impl Twice {
    /// Goes on with a value that holds.
    fn hold(&mut self, value: f64, step_s: f64) {
        self.twice += step_s * (self.once + 0.5 * step_s * value);
        self.once += step_s * value;
    }
}

/// Takes the best straight line over time out of every column.
fn without_start(samples: &[Sample], mut rows: Vec<Row>) -> Vec<Row> {
    let count = rows.len() as f64;
    let mean_s = samples.iter().map(|s| s.time_s).sum::<f64>() / count;
    let since = |sample: &Sample| sample.time_s - mean_s;
    let spread = samples.iter().map(|s| powi(since(s), 2)).sum::<f64>().max(1e-12);
    for column in 0..=UNKNOWNS {
        let mean = rows.iter_mut().map(|row| *row.column(column)).sum::<f64>() / count;
        let slope =
            rows.iter_mut().zip(samples).map(|(row, s)| *row.column(column) * since(s)).sum::<f64>() / spread;
        for (row, sample) in rows.iter_mut().zip(samples) {
            *row.column(column) -= mean + slope * since(sample);
        }
    }
    rows
}

impl Row {
    /// What of the motor's is left once the terms have taken theirs.
    pub(super) fn less(&self, values: &[f64; UNKNOWNS]) -> f64 {
        self.motor - self.terms.iter().zip(values).map(|(term, value)| term * value).sum::<f64>()
    }

    /// The terms, then the motor's.
    fn column(&mut self, number: usize) -> &mut f64 {
        self.terms.get_mut(number).unwrap_or(&mut self.motor)
    }
}
