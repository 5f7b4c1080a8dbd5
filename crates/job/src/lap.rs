//! One lap that nobody looks at, and what laps tell of a rig.

use std::ops::ControlFlow;

use tracelight_eye::power::{PowerWatch, check_homed, lost_power};
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

/// Ticks the head is watched after the user stopped it: longer than any relay of a rig file takes to open.
pub(crate) const GOODBYE_TICKS: u32 = 80;

/// One lap, every tick kept as it happens, and why it ended if its rig lost power. Whatever ends it darkens first; Ctrl-C has the head watched for a moment.
pub(crate) fn run_lap(
    rig: &mut SimulatedRig,
    plan: &Plan,
    dry: bool,
    keep: &mut dyn Keep,
    task: Task<'_>,
) -> Result<(Run, Option<Failure>), Failure> {
    let mut failed: Option<Failure> = None;
    let (mut goodbye, mut begun, mut unpowered) = (0, false, None);
    let mut power = PowerWatch::default();
    let mut run = tracelight_sim::run(rig, plan, dry, |rig, tick| {
        if power.is_lost(&tick.telemetry) {
            match begun {
                true => unpowered = Some(lost_power()),
                false => failed = check_homed(&tick.telemetry).err(),
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
    if unpowered.is_some() {
        // that tick's clock is another
        run.ticks.pop();
    }
    failed.map_or(Ok((run, unpowered)), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::HeadPose;
    use tracelight_rig::Joint;
    use tracelight_sim::{Simulated, Tick, Trouble};
    use tracelight_stroke::{Drawing, Element, Path, Point, Stroke};
    use tracelight_task::{NoProgress, Stop};
    use tracelight_trajectory::plan;

    const POSE: HeadPose = HeadPose::square_on(0.9144);

    /// Keeps ticks up to one that it cannot keep, or at which the user stops the job.
    struct Until<'a> {
        tick: u32,
        stop: Option<&'a Stop>,
        gates: Vec<bool>,
    }

    impl Keep for Until<'_> {
        fn tick(&mut self, _: &Plan, tick: &Tick) -> Result<(), Failure> {
            self.gates.push(tick.telemetry.actuation.lights());
            match self.stop {
                _ if tick.telemetry.tick != self.tick => Ok(()),
                Some(stop) => {
                    stop.want();
                    Ok(())
                }
                None => Err(Failure::failed("log", "the disk is full")),
            }
        }
    }

    fn circle(config: &RigConfig) -> Plan {
        let mut path = Path::new(Point::new(0.2, 0.0));
        path.push(Element::Arc { centre: Point::ORIGIN, sweep: std::f64::consts::TAU });
        path.close();
        let request = tracelight_pipeline::request_of(config);
        plan(&Drawing { strokes: vec![Stroke::new(path)] }, &config.machine(POSE), &request).unwrap()
    }

    /// Twenty ticks of the plan in which it is lit, from one end of it to the other.
    fn lit(plan: &Plan) -> Vec<u32> {
        let lit: Vec<u32> = (0..plan.points.len() as u32).filter(|&i| plan.points[i as usize].lit).collect();
        (1..=20).map(|k| lit[k * (lit.len() - 1) / 21]).collect()
    }

    #[test]
    fn whatever_ends_a_lap_leaves_its_gate_open_for_a_tick_at_most() {
        let config = RigConfig::report();
        let plan = circle(&config);
        for (seed, tick) in lit(&plan).into_iter().enumerate() {
            for stopped in [false, true] {
                let stop = Stop::default();
                let task = Task { progress: &NoProgress, stop: &stop };
                let mut rig = SimulatedRig::new(&config, POSE, seed as u64);
                let mut keep = Until { tick, stop: stopped.then_some(&stop), gates: Vec::new() };
                let lap = run_lap(&mut rig, &plan, false, &mut keep, task);
                assert!(keep.gates[tick as usize], "{tick}: nothing to see");
                assert!(keep.gates[tick as usize + 1..].iter().all(|gate| !gate), "{tick}: open after it");
                match lap {
                    Ok((run, why)) => assert!(stopped && why.is_none() && !run.is_done()),
                    Err(why) => {
                        assert!(!stopped && why.code == "log");
                        assert_eq!(rig.told().tick, tick + 1, "a tick more, and its gate is shut");
                    }
                }
                assert!(!rig.told().actuation.lights());
                assert!((0..300).all(|_| !rig.step().telemetry.actuation.lights()), "{tick}: open again");
            }
        }
    }

    #[test]
    fn a_lap_whose_rig_lost_counts_ends_by_its_fault_and_not_as_if_power_were_lost() {
        struct Jumps(u32);
        impl Keep for Jumps {
            fn tick(&mut self, _: &Plan, tick: &Tick) -> Result<(), Failure> {
                self.0 += u32::from(tick.telemetry.fault.is_some());
                Ok(())
            }
        }
        let config = RigConfig::report();
        let plan = circle(&config);
        let stop = Stop::default();
        let task = Task { progress: &NoProgress, stop: &stop };
        let mut rig = SimulatedRig::new(&config, POSE, 0);
        // its first edges tell of a disc that stands still
        rig.suffer(Trouble::EncoderCut(Joint::Pan));
        let mut keep = Jumps(0);
        let (run, why) = run_lap(&mut rig, &plan, false, &mut keep, task).unwrap();
        assert!(
            why.is_none() && run.fault().is_some_and(tracelight_rig::Fault::loses_counts),
            "{:?}",
            run.fault()
        );
        // and what followed it is kept
        assert_eq!(keep.0, 200);
    }
}
