//! What a head is made of, told from what its motors were given and its encoders saw.
//!
//! Between two reversals a joint slides, and its equation of motion is linear in all that is unknown:
//!
//! ```text
//! q̈ = θᵤ u − θᵥ q̇ ∓ θc ∓ θb s(q̇) + θg cos q + θh sin q + what is known of Coriolis and the other joint
//! ```
//!
//! with the amplifier's volts u exactly known. Integrated twice from the start of a stretch of motion it says where the joint
//! was at every edge the encoder counted: position and speed at the start, and a sum of terms that are linear in θ. So one
//! linear least squares over all stretches, with two free numbers a stretch, gives θ and, because every edge of a kind
//! is as far beside its place, the edges' places too. Nothing is differentiated. (Identification by the integrated
//! equation: Gautier, Janot & Vandanjon, *A new closed-loop output error method*, IEEE Trans. Control Systems Technology 21,
//! 2013, §II; free initial states a stretch: multiple shooting, Bock 1983.)
//!
//! Counts and volts alone tell ratios: twice the inertia, friction and weight with twice the torque per volt move alike.
//! `Equations::tell` says how that is settled.

mod equations;
mod fit;
mod routine;
mod standstill;
mod stretch;

use tracelight_rig::{Joint, PanTilt, Telemetry};
use tracelight_sim::RigConfig;

use equations::Equations;
use fit::{fit, residual_counts, ripple_gains};
pub use routine::routine;
use standstill::{Stand, broken_away, stands};
use stretch::{Stretch, stretches};

/// Of every so many stretches one judges a fit that it has no part in.
const JUDGE_EVERY: usize = 3;
/// Ripples of friction that are looked for, periods a turn.
const LEAST_PERIODS: u32 = 8;
const MOST_PERIODS: u32 = 160;
const PERIODS_STEP: usize = 4;
/// Rounds of fitting what slides and what breaks away.
const ROUNDS: u32 = 2;
/// One is believed that leaves so little of what is left without, where it is judged.
const RIPPLE_WORTH: f64 = 0.9;
/// What is off by less is nothing that could be seen, counts.
const LEAST_COUNTS: f64 = 5e-4;
/// Fewest stretches to identify a joint from.
const FEWEST_STRETCHES: usize = 9;
/// A fit must leave at most this share of what the present model leaves.
const BETTER: f64 = 0.98;

/// One joint's identification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointFit {
    /// Stretches of motion it was identified from.
    pub stretches: usize,
    /// Edges in them.
    pub edges: usize,
    /// How far the model that was believed is off on stretches that judge, root mean square, counts.
    pub before_counts: f64,
    /// How far the one that was found is.
    pub after_counts: f64,
    /// The found one is the better one, and was taken.
    pub taken: bool,
}

/// What an identification found.
#[derive(Clone, Debug, PartialEq)]
pub struct Identification {
    /// The rig with what was found; what was refused stays as it was.
    pub rig: RigConfig,
    /// How it came about.
    pub joints: PanTilt<JointFit>,
}

/// Why nothing could be identified.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// The joint hardly moved.
    #[error(
        "{joint} moved on {found} stretches of at least 8 counts one way, {FEWEST_STRETCHES} are needed: give a longer record"
    )]
    TooLittleMotion {
        /// Which joint.
        joint: Joint,
        /// How many stretches there were.
        found: usize,
    },
}

/// Identifies a rig from what it did: each record holds consecutive ticks from power-up on. A joint whose fit is worse than
/// what is believed already keeps it.
pub fn identify(rig: &RigConfig, records: &[&[Telemetry]]) -> Result<Identification, IdentifyError> {
    let found = PanTilt::new(joint(rig, records, Joint::Pan)?, joint(rig, records, Joint::Tilt)?);
    let mut changed = rig.clone();
    for j in Joint::BOTH {
        let (equations, fit) = &found[j];
        if fit.taken {
            equations.tell(&mut changed, j, fit.after_counts);
        }
    }
    Ok(Identification { rig: changed, joints: found.map(|(_, fit)| fit) })
}

/// One joint's equations as they fit best, and whether they are better than those that are believed.
fn joint(
    rig: &RigConfig,
    records: &[&[Telemetry]],
    joint: Joint,
) -> Result<(Equations, JointFit), IdentifyError> {
    let believed = Equations::of(rig, joint);
    let cut = |equations: &Equations| -> Vec<Stretch> {
        records.iter().flat_map(|record| stretches(rig, record, joint, equations)).collect()
    };
    let stands: Vec<Stand<'_>> = records.iter().flat_map(|record| stands(record, joint)).collect();
    let seen = cut(&believed);
    if seen.len() < FEWEST_STRETCHES {
        return Err(IdentifyError::TooLittleMotion { joint, found: seen.len() });
    }
    let before_counts = residual_counts(&believed, &part(&seen, true));
    let (rippling, after_counts) = rippled(&believed, &seen);
    // all stretches know more than those that taught, and each round knows better where edges lie and what breaks away
    let mut last = fit(&rippling, &part(&seen, false));
    for _ in 0..ROUNDS {
        let seen = cut(&last);
        last = fit(&rippling.breaking_away(&last), &seen.iter().collect::<Vec<_>>());
        last = broken_away(rig, joint, &last, &stands);
    }
    let found = JointFit {
        stretches: seen.len(),
        edges: seen.iter().map(|s| s.rows.len()).sum(),
        before_counts,
        after_counts,
        taken: after_counts <= BETTER * before_counts && last.is_possible(),
    };
    Ok((last, found))
}

/// What is believed, with the ripple of friction that most of the stretches show, if those that judge agree; and how
/// far off what these teach is there, counts.
fn rippled(believed: &Equations, seen: &[Stretch]) -> (Equations, f64) {
    let teachers = part(seen, false);
    let most = |periods: Vec<f64>| {
        let gains = ripple_gains(believed, &teachers, &periods);
        let best = periods.iter().zip(gains).max_by(|a, b| a.1.total_cmp(&b.1));
        best.map_or(0.0, |(periods, _)| *periods)
    };
    let coarse = most((LEAST_PERIODS..=MOST_PERIODS).step_by(PERIODS_STEP).map(f64::from).collect());
    let reach = PERIODS_STEP as i32 - 1;
    let periods = most((-reach..=reach).map(|k| coarse + f64::from(k)).collect());
    let judged = |periods: f64| {
        let believed = believed.rippling(periods);
        let seen: Vec<Stretch> = seen.iter().map(|s| s.rippling(periods)).collect();
        let taught = fit(&believed, &part(&seen, false));
        (believed, residual_counts(&taught, &part(&seen, true)))
    };
    let (plain, rippling) = (judged(0.0), judged(periods));
    if rippling.1 < RIPPLE_WORTH * plain.1 - LEAST_COUNTS { rippling } else { plain }
}

/// The stretches that judge, or those that teach.
fn part(all: &[Stretch], judges: bool) -> Vec<&Stretch> {
    let chosen = |number: &usize| number.is_multiple_of(JUDGE_EVERY) == judges;
    all.iter().enumerate().filter(|(number, _)| chosen(number)).map(|(_, s)| s).collect()
}
