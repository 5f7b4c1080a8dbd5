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
//! is as far beside its place, the edges' places too. Nothing is differentiated. (Identification by the integrated equation:
//! Young, *Parameter estimation for continuous-time models: a survey*, Automatica 17, 1981; a state of its own for every
//! stretch: Bock's multiple shooting, 1983.)
//!
//! Counts and volts alone tell ratios: twice the inertia, friction and weight with twice the torque per volt move alike.
//! `Equations::tell` says how that is settled.

mod edge;
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

/// Laps that are worth keeping to identify a head from: what the last of them do not tell, more do not.
pub const LAPS_WORTH: usize = 3;

/// One joint's identification; all zero of a joint that was not asked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointFit {
    /// Stretches of motion it was identified from.
    pub stretches: usize,
    /// Edges in them.
    pub edges: usize,
    /// How far the model that was believed is off on the stretches that judge, root mean square of the better nine tenths of
    /// them, counts.
    pub before_counts: f64,
    /// How far one is that the others teach.
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
pub fn identify<R: AsRef<[Telemetry]>>(
    rig: &RigConfig,
    records: &[R],
) -> Result<Identification, IdentifyError> {
    let records: &[&[Telemetry]] = &records.iter().map(AsRef::as_ref).collect::<Vec<_>>();
    let found = PanTilt::new(joint(rig, records, Joint::Pan)?, joint(rig, records, Joint::Tilt)?);
    Ok(told(rig, found.map(Some)))
}

/// Identifies one joint of a rig alone; the other stood at zero.
pub fn identify_one<R: AsRef<[Telemetry]>>(
    rig: &RigConfig,
    records: &[R],
    only: Joint,
) -> Result<Identification, IdentifyError> {
    let records: &[&[Telemetry]] = &records.iter().map(AsRef::as_ref).collect::<Vec<_>>();
    let mut found = PanTilt::new(None, None);
    found[only] = Some(joint(rig, records, only)?);
    Ok(told(rig, found))
}

/// The rig with what is better of what was found.
fn told(rig: &RigConfig, found: PanTilt<Option<(Equations, JointFit)>>) -> Identification {
    let mut joints = found.map(|one| one.map_or_else(JointFit::default, |(_, fit)| fit));
    let mut changed = rig.clone();
    // tilt first: where its body's weight sits is part of what pan turns
    for j in [Joint::Tilt, Joint::Pan] {
        let Some((equations, _)) = &found[j] else { continue };
        let mut told = changed.clone();
        equations.tell(&mut told, j, joints[j].after_counts);
        joints[j].taken &= told.model.bodies.rotor_kg_m2[j] >= 0.0;
        if joints[j].taken {
            changed = told;
        }
    }
    Identification { rig: changed, joints }
}

/// One joint's equations as they fit best, and whether they are better than those that are believed.
fn joint(
    rig: &RigConfig,
    records: &[&[Telemetry]],
    joint: Joint,
) -> Result<(Equations, JointFit), IdentifyError> {
    let believed = Equations::of(rig, joint);
    let taken_from = Seen { rig, records, joint };
    let plain = taken_from.cut(&believed.rippling(0.0));
    if plain.len() < FEWEST_STRETCHES {
        return Err(IdentifyError::TooLittleMotion { joint, found: plain.len() });
    }
    let before_counts = residual_counts(&believed, &part(&rippling(&plain, believed.periods), true));
    let believed = rippled(&believed, &plain);
    // those that teach are judged by the others; then all of them teach
    let taught = taken_from.taught(&believed, |seen| part(seen, false));
    let after_counts = residual_counts(&taught, &part(&taken_from.cut(&taught), true));
    let last = taken_from.taught(&believed, |seen| seen.iter().collect());
    let found = JointFit {
        stretches: plain.len(),
        edges: plain.iter().map(|s| s.rows.len()).sum(),
        before_counts,
        after_counts,
        taken: after_counts <= BETTER * before_counts && last.is_possible(),
    };
    Ok((last, found))
}

/// What was seen of one joint.
struct Seen<'a> {
    rig: &'a RigConfig,
    records: &'a [&'a [Telemetry]],
    joint: Joint,
}

impl Seen<'_> {
    /// Its stretches, with edges where these equations have them, and their ripple among the unknowns.
    fn cut(&self, equations: &Equations) -> Vec<Stretch> {
        let records = self.records.iter();
        let plain = records.flat_map(|record| stretches(self.rig, record, self.joint, equations));
        rippling(&plain.collect::<Vec<_>>(), equations.periods)
    }

    /// Equations that some of the stretches teach: each round knows better where edges lie and what breaks away.
    fn taught(&self, believed: &Equations, some: impl Fn(&[Stretch]) -> Vec<&Stretch>) -> Equations {
        let stands: Vec<Stand<'_>> =
            self.records.iter().flat_map(|record| stands(record, self.joint)).collect();
        let mut last = fit(believed, &some(&self.cut(believed)));
        for _ in 0..ROUNDS {
            last = fit(&believed.breaking_away(&last), &some(&self.cut(&last)));
            last = broken_away(self.rig, self.joint, &last, &stands);
        }
        last
    }
}

/// What is believed, with the ripple of friction that most of the stretches show, if those that judge agree. The stretches
/// are cut without one.
fn rippled(believed: &Equations, seen: &[Stretch]) -> Equations {
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
        let seen = rippling(seen, periods);
        let taught = fit(&believed, &part(&seen, false));
        (believed, residual_counts(&taught, &part(&seen, true)))
    };
    let ((without, left), (with, less)) = (judged(0.0), judged(periods));
    if less < RIPPLE_WORTH * left - LEAST_COUNTS { with } else { without }
}

/// Stretches with a ripple of so many periods a turn among the unknowns.
fn rippling(plain: &[Stretch], periods: f64) -> Vec<Stretch> {
    plain.iter().map(|stretch| stretch.rippling(periods)).collect()
}

/// The stretches that judge, or those that teach.
fn part(all: &[Stretch], judges: bool) -> Vec<&Stretch> {
    let chosen = |number: &usize| number.is_multiple_of(JUDGE_EVERY) == judges;
    all.iter().enumerate().filter(|(number, _)| chosen(number)).map(|(_, s)| s).collect()
}
