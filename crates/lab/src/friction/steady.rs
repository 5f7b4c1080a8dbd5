use super::{Line, Trial};

/// What a voltage came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyPoint {
    /// Held, V; none where torque was measured.
    pub volts: Option<f64>,
    /// N m.
    pub torque_nm: f64,
    /// Speed at its end, rad/s.
    pub rate_rad_s: f64,
}

/// Friction as the 2006 report identified it: the speeds that voltages come to are taken for steady.
#[derive(Clone, Debug, PartialEq)]
pub struct Steady {
    /// Every voltage that was held.
    pub points: Vec<SteadyPoint>,
    /// The line of those that turned it forwards.
    pub pos: Option<Line>,
    /// Backwards.
    pub neg: Option<Line>,
}

/// Speed of a joint that may as well stand, rad/s.
const STANDS_RAD_S: f64 = 1e-3;
/// The end of a voltage that its speed is taken over, s at most.
const END_S: f64 = 1.0;
/// A voltage counts as held that lasts so much of the longest one; the pulses against stiction do not.
const HELD: f64 = 0.5;

/// The report's way with trials of one joint, whose motor makes a torque of volts, N m.
pub fn steady(trials: &[&Trial], torque_nm: impl Fn(f64) -> f64, count_rad: f64) -> Steady {
    let holds: Vec<&[super::Sample]> = trials.iter().flat_map(|trial| holds(&trial.samples)).collect();
    let length = |hold: &[super::Sample]| hold[hold.len() - 1].time_s - hold[0].time_s;
    let longest = holds.iter().map(|hold| length(hold)).fold(0.0, f64::max);
    let held = holds.into_iter().filter(|hold| length(hold) > HELD * longest);
    let points = held.map(|hold| {
        let last = hold[hold.len() - 1];
        let span_s = END_S.min(0.5 * length(hold));
        let from = hold.partition_point(|s| s.time_s < last.time_s - span_s - 1e-9).min(hold.len() - 2);
        let turned = (last.count - hold[from].count) * count_rad;
        SteadyPoint {
            volts: Some(hold[0].volts),
            torque_nm: torque_nm(hold[0].volts),
            rate_rad_s: turned / (last.time_s - hold[from].time_s),
        }
    });
    steady_of(points.collect())
}

/// The same of torques and speeds that somebody measured.
pub fn steady_of(points: Vec<SteadyPoint>) -> Steady {
    let side = |way: f64| {
        let turning = points.iter().filter(|p| way * p.rate_rad_s > STANDS_RAD_S);
        Line::through(&turning.map(|p| (p.rate_rad_s, p.torque_nm)).collect::<Vec<_>>())
    };
    let (pos, neg) = (side(1.0), side(-1.0));
    Steady { points, pos, neg }
}

/// Stretches of one voltage, of two samples or more.
fn holds(samples: &[super::Sample]) -> impl Iterator<Item = &[super::Sample]> {
    samples.chunk_by(|a, b| a.volts == b.volts).filter(|hold| hold.len() > 1)
}
