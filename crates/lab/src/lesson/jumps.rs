//! Several jumps of the setpoint, judged by the worst of them: where in a count of the encoder a joint comes to rest is chance.

use tracelight_rig::Joint;
use tracelight_sim::RigConfig;

use super::experiment::{Experiment, mm};
use super::rigs::jump;
use crate::step::StepFigures;

/// Small jumps and large ones, as many of each; the first of each is the one that plots show.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jumps<const N: usize> {
    /// Degrees.
    pub(super) small_deg: [f64; N],
    /// Degrees.
    pub(super) large_deg: [f64; N],
}

/// The worst figures of several jumps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worst {
    pub(super) overshoot_percent: f64,
    /// NaN where one never settles.
    pub(super) settle_s: f64,
    /// On a target 3 ft away.
    pub(super) left_mm: f64,
}

impl<const N: usize> Jumps<N> {
    /// Runs all of them: a small one, a large one, and so on.
    pub(super) fn run(&self, rig: &RigConfig, joint: Joint) -> Vec<Experiment> {
        let pairs = self.small_deg.into_iter().zip(self.large_deg);
        pairs.flat_map(|(small, large)| [jump(rig, joint, small), jump(rig, joint, large)]).collect()
    }

    /// Returns the worst of the small ones and of the large ones.
    pub(super) fn worst(&self, experiments: &[Experiment]) -> [Worst; 2] {
        let of = |first: usize, degrees: [f64; N]| {
            let jumps = experiments.iter().skip(first).step_by(2).zip(degrees);
            Worst::of(jumps.map(|(experiment, degrees)| experiment.figures(degrees.to_radians())))
        };
        [of(0, self.small_deg), of(1, self.large_deg)]
    }
}

impl Worst {
    fn of(figures: impl Iterator<Item = StepFigures>) -> Self {
        let none = Self { overshoot_percent: 0.0, settle_s: 0.0, left_mm: 0.0 };
        figures.fold(none, |worst, one| Self {
            overshoot_percent: worst.overshoot_percent.max(one.overshoot_percent),
            // a jump that never settles is the worst there is
            settle_s: match one.settle_s {
                Some(settle_s) if settle_s > worst.settle_s => settle_s,
                Some(_) => worst.settle_s,
                None => f64::NAN,
            },
            left_mm: worst.left_mm.max(mm(one.final_error)),
        })
    }
}
