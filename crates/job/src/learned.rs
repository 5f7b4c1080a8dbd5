//! What laps tell of a rig.

use tracelight_lab::{LAPS_WORTH, identify};
use tracelight_rig::Joint;
use tracelight_sim::{RigConfig, Run};

/// What the laps so far tell of a rig.
pub(crate) struct Learned {
    pub(crate) rig: RigConfig,
    /// Some of it was better than what was believed.
    pub(crate) taken: bool,
    pub(crate) notes: Vec<String>,
}

pub(crate) fn learn(rig: &RigConfig, laps: &[Run]) -> Learned {
    // a lap in which the head was found again has a gap
    let is_whole =
        |lap: &&Run| lap.ticks.windows(2).all(|t| t[1].telemetry.tick == t[0].telemetry.tick.wrapping_add(1));
    let last = laps.iter().rev().filter(is_whole).take(LAPS_WORTH);
    let mut last: Vec<_> = last.map(Run::telemetry).collect();
    last.reverse();
    let found = match identify(rig, &last) {
        Ok(found) => found,
        Err(error) => {
            let notes = vec![format!("nothing identified between laps: {error}")];
            return Learned { rig: rig.clone(), taken: false, notes };
        }
    };
    let notes = Joint::BOTH.map(|j| {
        let fit = &found.joints[j];
        let verdict = if fit.taken { "" } else { ", no better: what was believed is kept" };
        format!(
            "{j} identified from the laps before: edges off the model by {:.3} counts rms, before {:.3}{verdict}",
            fit.after_counts, fit.before_counts
        )
    });
    let taken = Joint::BOTH.iter().any(|&j| found.joints[j].taken);
    Learned { rig: found.rig, taken, notes: notes.to_vec() }
}
