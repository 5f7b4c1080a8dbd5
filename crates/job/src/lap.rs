//! A lap that no camera follows. Somebody at the wall may pause, stop, hurry or slow it, and let it go on.

use tracelight_session::{Event, Job, Refused, Request, Snapshot};
use tracelight_sim::{Observed, Run, Tick, job_of};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::Plan;

use crate::course::{Course, Wall};
use crate::diary::Diary;
use crate::frame::drive_framed;
use crate::hands::{Ask, Hands};
use crate::keep::{Keep, Memory};
use crate::looped::Looped;

/// A lap, and what became of it.
pub(crate) struct RanLap {
    pub(crate) run: Run,
    /// Why it ended, if not at its end or by the user: a fault, or lost power.
    pub(crate) failure: Option<Failure>,
    /// Pauses and other speeds.
    pub(crate) notes: Vec<String>,
}

/// One lap, after the frame where there is one, every tick kept as it happens. Whatever ends it darkens first.
pub(crate) fn run_lap(
    rig: &mut dyn Observed,
    (plan, frame): (&Plan, Option<&Looped>),
    (dry, slowest): (bool, f32),
    (keep, hands): (&mut dyn Keep, &mut dyn Hands),
    task: Task<'_>,
) -> Result<RanLap, Failure> {
    let mut lap = Lap {
        plan,
        dry,
        slowest,
        task,
        run: Run::default(),
        memory: Memory::default(),
        diary: Diary::default(),
    };
    let ended = drive_framed(rig, (lap.job(), &mut lap), frame, (keep, hands), task)?;
    lap.diary.end(&ended.now);
    Ok(RanLap {
        run: lap.run,
        failure: ended.failure.or(ended.fault.map(Failure::fault)),
        notes: lap.diary.notes,
    })
}

struct Lap<'a> {
    plan: &'a Plan,
    dry: bool,
    /// Lowest speed that it may be slowed to.
    slowest: f32,
    task: Task<'a>,
    run: Run,
    memory: Memory,
    diary: Diary,
}

impl Lap<'_> {
    fn job(&self) -> Job {
        Job { slowest: self.slowest, ..job_of(self.plan, self.dry) }
    }
}

impl Course for Lap<'_> {
    fn keep(&mut self, keep: &mut dyn Keep, tick: Tick, now: &Snapshot, _: u32) -> Result<(), Failure> {
        keep.tick(self.plan, &tick)?;
        self.memory.keep(&mut self.run.ticks, tick, now.state);
        self.diary.watch(now);
        if tick.telemetry.tick.is_multiple_of(256) {
            self.task.at(u64::from(tick.telemetry.plan_tick));
        }
        Ok(())
    }

    fn see(&mut self, event: &Event, now: &Snapshot) -> bool {
        self.diary.write(event, now);
        true
    }

    fn ask(&mut self, ask: Ask, wall: &mut Wall<'_>, _: &mut dyn Hands, _: Task<'_>) -> Result<(), Refused> {
        match ask {
            Ask::Request(Request::Resume) if wall.awaits_job() => wall.request(Request::Next(self.job())),
            Ask::Request(request) => wall.request(request),
            // strokes come one after the other by themselves
            Ask::Step(_) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hands::Nobody;
    use tracelight_aim::HeadPose;
    use tracelight_rig::Joint;
    use tracelight_sim::{RigConfig, Simulated, SimulatedRig, Tick, Trouble};

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
                let lap = run_lap(&mut rig, (&plan, None), (false, 0.0), (&mut keep, &mut Nobody), task);
                assert!(keep.gates[tick as usize], "{tick}: nothing to see");
                assert!(keep.gates[tick as usize + 1..].iter().all(|gate| !gate), "{tick}: open after it");
                match lap {
                    Ok(lap) => assert!(stopped && lap.failure.is_none() && !lap.run.is_done()),
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
                self.0 += u32::from(tick.telemetry.fault().is_some());
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
        let lap = run_lap(&mut rig, (&plan, None), (false, 0.0), (&mut keep, &mut Nobody), task).unwrap();
        let (run, why) = (lap.run, lap.failure);
        assert!(
            why.is_some_and(|why| why.code != "unhomed")
                && run.fault().is_some_and(tracelight_rig::Fault::loses_counts),
            "{:?}",
            run.fault()
        );
        // and what followed it is kept
        assert_eq!(keep.0, 200);
    }
}
