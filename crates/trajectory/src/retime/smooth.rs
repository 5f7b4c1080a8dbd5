//! Time-optimal motion along a path with bounded jerk.

mod band;
mod cells;
pub(crate) mod limits;

use tracelight_rig::{Joint, PanTilt};

use super::limits::PathSample;
use crate::move_point::MovePoint;
use band::Band;
use cells::{Cells, Path, ROWS, dot, row};
use limits::JointLimits;

/// Why a path has no such motion.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SmoothError {
    /// Too few samples, or samples whose parameter does not grow.
    #[error(
        "sample {sample} of the path is at {s}, which is not beyond the one before; give three or more that grow"
    )]
    Order {
        /// Number of the sample.
        sample: usize,
        /// Its parameter.
        s: f64,
    },
    /// A number that is none, or a limit that is not above zero.
    #[error("{what} is {value}; it must be {asked}")]
    Number {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        asked: &'static str,
    },
}

/// The fastest motion along a path from rest to rest, with bounded jerk.
#[derive(Clone, Debug)]
pub struct Smooth {
    path: Path,
    /// At every node x = σ̇² and dx/dσ, one after the other.
    z: Vec<f64>,
    /// When each node is passed, s, before stretching.
    times_s: Vec<f64>,
    /// What all times are stretched by, for limits to hold between nodes too.
    stretch: f64,
}

/// Fewest cells: what a coarser path is interpolated to.
const FEWEST: usize = 500;

/// The fastest motion from rest to rest along sampled places that keeps to each joint's speed, acceleration and jerk and to
/// the samples' caps. The path is a quintic between samples; its curvature must not jump.
///
/// Arc length is a smooth step of a parameter σ, s = 10σ³ − 15σ⁴ + 6σ⁵ of the way: from rest under bounded jerk s goes with t³,
/// so σ̇ neither vanishes nor turns steep at the ends. With x = σ̇² speeds and accelerations are linear in x and its
/// derivative, and jerk is √x times what is linear in x and its first two. x is a cubic in each of many cells, continuous with its
/// derivative; limits hold at five places of a cell, jerk at three, and a dense check stretches time by what is left between
/// them. Solved by a primal-dual interior-point method, the concave part of the jerk's bound 1/√x taken by its tangent
/// (sequential convex programming as in Debrouwere et al., "Time-optimal path following for robots with convex-concave
/// constraints", IEEE T-RO 2013, but for one Newton step each).
///
/// # Errors
/// [`SmoothError`] names the sample or the number.
pub fn retime_smooth(samples: &[PathSample], limits: &PanTilt<JointLimits>) -> Result<Smooth, SmoothError> {
    check(samples, limits)?;
    let path = Path::new(samples);
    let cells = Cells::new(&path, (samples.len() - 1).max(FEWEST), limits);
    let z = solve(&cells);
    let mut times_s = vec![0.0];
    for cell in z.windows(4).step_by(2) {
        let before = times_s[times_s.len() - 1];
        times_s.push(before + cells::crossing_s(cell, cells.h, 1.0));
    }
    let stretch = cells::excess(&path, &z, cells.h, limits);
    Ok(Smooth { path, z, times_s, stretch })
}

impl Smooth {
    /// How long it takes, s.
    pub fn duration_s(&self) -> f64 {
        self.stretch * self.times_s.last().copied().unwrap_or(0.0)
    }

    /// Arc length, speed and acceleration along the path at a time; at rest before and after.
    pub fn at(&self, t_s: f64) -> MovePoint {
        let t = t_s / self.stretch;
        let cells = self.times_s.len() - 1;
        let h = 1.0 / cells as f64;
        if t_s <= 0.0 || t_s >= self.duration_s() {
            let position = if t_s <= 0.0 { self.path.start() } else { self.path.end() };
            return MovePoint { position, ..MovePoint::default() };
        }
        let i = self.times_s.partition_point(|&start| start <= t).clamp(1, cells) - 1;
        let cell = &self.z[2 * i..2 * i + 4];
        let since = t - self.times_s[i];
        // Newton: the time to a place of the cell grows with 1/√x
        let mut u = since / (self.times_s[i + 1] - self.times_s[i]);
        for _ in 0..6 {
            let rate = dot(&row(u, h).0, cell).max(f64::MIN_POSITIVE).sqrt();
            u = (u - (cells::crossing_s(cell, h, u) - since) * rate / h).clamp(0.0, 1.0);
        }
        let (values, slopes, _) = row(u, h);
        let (x, slope) = (dot(&values, cell), dot(&slopes, cell));
        let [s, s1, s2, _] = self.path.step((i as f64 + u) * h);
        let rate = x.max(0.0).sqrt();
        MovePoint {
            position: s,
            velocity: s1 * rate / self.stretch,
            acceleration: (s2 * x + 0.5 * s1 * slope) / (self.stretch * self.stretch),
        }
    }
}

/// Relative duality gap at which it is done.
const GAP: f64 = 1e-6;

/// More steps than any path was seen to need: 25 to 75.
const STEPS: usize = 150;

fn solve(cells: &Cells) -> Vec<f64> {
    let mut z = cells.interior();
    let mut slack = cells.slacks(&z);
    let rows = (ROWS * slack.len()) as f64;
    let first = cells.duration_s(&z) / rows;
    let mut duals: Vec<[f64; ROWS]> = slack.iter().map(|cell| cell.map(|c| first / c)).collect();
    // how much of the gap the next step aims at: much where limits stand in the way, little where none does
    let mut centring = 0.1f64;
    for _ in 0..STEPS {
        let pairs = || slack.iter().flatten().zip(duals.iter().flatten());
        let gap: f64 = pairs().map(|(c, l)| c * l).sum();
        if gap <= GAP * cells.duration_s(&z) {
            break;
        }
        let barrier = centring * gap / rows;
        let mut system = Band::new(z.len());
        for (i, (c, l)) in slack.iter().zip(&duals).enumerate() {
            system.add(2 * i, &cells.newton(i, &z[2 * i..2 * i + 4], c, l, barrier));
        }
        let step = system.solve();
        let mut dual_share = 1.0f64;
        let mut dual_steps = Vec::with_capacity(duals.len());
        for (i, (c, l)) in slack.iter().zip(&duals).enumerate() {
            let along = cells.slopes(i, &z[2 * i..2 * i + 4], &step[2 * i..2 * i + 4]);
            let change: [f64; ROWS] = core::array::from_fn(|k| (barrier - l[k] * (c[k] + along[k])) / c[k]);
            for (l, change) in l.iter().zip(change).filter(|(_, change)| *change < 0.0) {
                dual_share = dual_share.min(-0.995 * l / change);
            }
            dual_steps.push(change);
        }
        let Some((next, next_slack, share)) = advance(cells, &z, &step, &slack) else { break };
        centring =
            if share.min(dual_share) < 0.5 { (2.0 * centring).min(0.8) } else { (0.5 * centring).max(0.05) };
        (z, slack) = (next, next_slack);
        for (l, change) in duals.iter_mut().flatten().zip(dual_steps.iter().flatten()) {
            *l += dual_share * change;
        }
    }
    z
}

/// As far along a step as all limits allow, and what share of it that is.
fn advance(
    cells: &Cells,
    z: &[f64],
    step: &[f64],
    slack: &[[f64; ROWS]],
) -> Option<(Vec<f64>, Vec<[f64; ROWS]>, f64)> {
    const LEFT: f64 = 0.005;
    let mut share = 1.0;
    while share > 1e-10 {
        let next: Vec<f64> = z.iter().zip(step).map(|(z, step)| z + share * step).collect();
        if cells.is_positive(&next) {
            let next_slack = cells.slacks(&next);
            let fine =
                next_slack.iter().flatten().zip(slack.iter().flatten()).all(|(next, now)| *next > LEFT * now);
            if fine {
                return Some((next, next_slack, share));
            }
        }
        share *= 0.7;
    }
    None
}

fn check(samples: &[PathSample], limits: &PanTilt<JointLimits>) -> Result<(), SmoothError> {
    let number = |what, value: f64, fine: bool, asked| {
        if fine { Ok(()) } else { Err(SmoothError::Number { what, value, asked }) }
    };
    for joint in Joint::BOTH {
        let of = &limits[joint];
        for (what, value) in [
            ("the highest speed", of.speed_rad_s),
            ("the highest acceleration", of.acceleration_rad_s2),
            ("the highest jerk", of.jerk_rad_s3),
        ] {
            number(what, value, value > 0.0 && value.is_finite(), "above zero and finite")?;
        }
    }
    for (sample, at) in samples.iter().enumerate() {
        let before = if sample == 0 { f64::NEG_INFINITY } else { samples[sample - 1].s };
        if !at.s.is_finite() || at.s <= before {
            return Err(SmoothError::Order { sample, s: at.s });
        }
        let joints = &at.joints;
        for value in
            Joint::BOTH.into_iter().flat_map(|j| [joints.angle_rad[j], joints.first[j], joints.second[j]])
        {
            number("an angle of the path", value, value.is_finite(), "finite")?;
        }
        number("a cap", at.cap, at.cap > 0.0, "above zero")?;
    }
    match samples.len() {
        0..3 => Err(SmoothError::Order { sample: samples.len(), s: f64::NAN }),
        _ => Ok(()),
    }
}
