//! One lap that nobody looks at, and what laps tell of a rig.

use std::ops::ControlFlow;

use tracelight_eye::power::{check_homed, lost_power};
use tracelight_lab::{LAPS_WORTH, identify};
use tracelight_rig::{Command, Joint, Rig};
use tracelight_sim::{RigConfig, Run, SimulatedRig};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::keep::Keep;

/// What the laps so far tell of a rig.
pub(crate) struct Learned {
    pub(crate) rig: RigConfig,
    /// Some of it was better than what was believed.
    pub(crate) taken: bool,
    pub(crate) notes: Vec<String>,
}

pub(crate) fn learn(rig: &RigConfig, laps: &[Run]) -> Learned {
    // a lap in which the head was found again has a gap
    let is_whole = |lap: &&Run| lap.ticks.windows(2).all(|t| t[1].telemetry.tick == t[0].telemetry.tick + 1);
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

/// Ticks the head is watched after the user stopped it: longer than any relay of a rig file takes to open.
const GOODBYE_TICKS: u32 = 80;

/// One lap, every tick kept as it happens, and why it ended if its rig lost power. Ctrl-C darkens first and then ends the lap.
pub(crate) fn run_lap(
    mut rig: SimulatedRig,
    plan: &Plan,
    dry: bool,
    keep: &mut dyn Keep,
    task: Task<'_>,
) -> Result<(Run, Option<Failure>), Failure> {
    let mut failed: Option<Failure> = None;
    let (mut goodbye, mut begun, mut unpowered) = (0, false, None);
    let mut run = tracelight_sim::run(&mut rig, plan, dry, |rig, tick| {
        if let Err(unhomed) = check_homed(&tick.telemetry) {
            match begun {
                true => unpowered = Some(lost_power()),
                false => failed = Some(unhomed),
            }
            return ControlFlow::Break(());
        }
        begun = true;
        if let Err(error) = keep.tick(plan, tick) {
            failed = Some(error);
            return ControlFlow::Break(());
        }
        let number = tick.telemetry.tick;
        if number.is_multiple_of(256) {
            task.at(u64::from(number));
        }
        if !task.stop.is_wanted() {
            return ControlFlow::Continue(());
        }
        // a simulated rig takes every command but a segment for a full queue
        let _ = rig.send(Command::Disarm);
        goodbye += 1;
        if goodbye > GOODBYE_TICKS { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    // that tick's clock is another
    run.ticks.retain(|tick| tick.telemetry.homed);
    failed.map_or(Ok((run, unpowered)), Err)
}
