//! The law of a rig and how fast its loops are, picked: the smallest error on heads that differ, of all that bear what is asked.

mod view;

use std::ops::ControlFlow;

use tracelight_lab::{Demand, Quantiles, Setting, around, coarse};
use tracelight_pipeline::Driving;
use tracelight_rig::Phase;
use tracelight_sim::{LawName, RigConfig, SimulatedRig, Spread, score};
use tracelight_task::{Failure, Task, on_all_cores};
use tracelight_trajectory::Plan;

use crate::finding::{Experiment, Improved};
use crate::shape::Shape;

/// A shape that a rig is to draw, and what its loops must bear.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is drawn.
    pub shape: Shape,
    /// By what, and how.
    pub driving: Driving,
    /// What there is to choose from, and by what it is chosen.
    pub choice: Choice,
}

/// What there is to choose from, and by what it is chosen.
#[derive(Clone, Debug)]
pub struct Choice {
    /// Laws.
    pub laws: Vec<LawName>,
    /// By how much motors may be stronger, and weaker, than what is believed: a factor.
    pub gain_margin: f64,
    /// By how much currents may lag, s.
    pub lag_s: f64,
    /// Slowest loop, rad/s,
    pub slowest_rad_s: f64,
    /// and fastest, rad/s.
    pub fastest_rad_s: f64,
    /// How many heads that differ.
    pub plants: u32,
    /// Of the first head; the others have the numbers after it.
    pub seed: u64,
}

/// What was picked, beside all that was tried.
pub struct Finding {
    shape: String,
    choice: Choice,
    rig: RigConfig,
    better: RigConfig,
    /// Slowest first.
    tried: Vec<Tried>,
    /// What the rig had.
    had: Tried,
    picked: Tried,
}

/// A setting, and how it did.
#[derive(Clone, Copy)]
struct Tried {
    setting: Setting,
    /// How many of the demands it bore,
    borne: usize,
    /// and, if it bore all, its largest error on 95 of 100 heads, mm, and rms on the middle one.
    errors_mm: Option<Errors>,
}

#[derive(Clone, Copy)]
struct Errors {
    max_p95: f64,
    rms_median: f64,
}

impl Tried {
    fn worst_mm(&self) -> f64 {
        self.errors_mm.map_or(f64::INFINITY, |errors| errors.max_p95)
    }
}

/// Bandwidths of each law that are tried first.
const BANDWIDTHS: usize = 12;

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, task: Task<'_>) -> Result<Finding, Failure> {
        let Self { shape, driving, choice } = self;
        let (slowest, fastest) = (choice.slowest_rad_s, choice.fastest_rad_s);
        if slowest >= fastest {
            return Err(Failure::usage("usage", "--slowest must be below --fastest"));
        }
        let name = shape.name().to_owned();
        let bench = Bench { choice: &choice, driving: &driving, plan: shape.on_target()?.plan(&driving)? };
        task.stage("laws", 1);
        let mut tried = bench.try_all(coarse(&choice.laws, (slowest, fastest), BANDWIDTHS), task)?;
        let had = bench.try_all(vec![Setting::of(&driving.rig)], task)?.remove(0);
        task.stage("joints", 1);
        let middle = best(&tried).ok_or_else(|| nothing_bears(&choice))?.setting;
        let mut near = around(middle);
        let within = slowest..=fastest;
        near.retain(|s| within.contains(&s.bandwidth_rad_s.pan) && within.contains(&s.bandwidth_rad_s.tilt));
        tried.extend(bench.try_all(near, task)?);
        tried.sort_by(|a, b| a.setting.bandwidth_rad_s.pan.total_cmp(&b.setting.bandwidth_rad_s.pan));
        let picked = *best(&tried).ok_or_else(|| nothing_bears(&choice))?;
        let better = picked.setting.apply(&driving.rig);
        Ok(Finding { shape: name, choice, rig: driving.rig, better, tried, had, picked })
    }
}

impl Improved for Finding {
    fn rig(&self) -> &RigConfig {
        &self.rig
    }

    fn better(&self) -> &RigConfig {
        &self.better
    }
}

/// Where settings are tried.
struct Bench<'a> {
    choice: &'a Choice,
    driving: &'a Driving,
    plan: Plan,
}

impl Bench<'_> {
    fn demand(&self) -> Demand {
        Demand { gain: self.choice.gain_margin, lag_s: self.choice.lag_s }
    }

    /// Tries settings, on all cores.
    fn try_all(&self, settings: Vec<Setting>, task: Task<'_>) -> Result<Vec<Tried>, Failure> {
        task.stage("settings", settings.len() as u64);
        let tried = on_all_cores(settings.len(), task, |number| self.tried(settings[number]));
        task.check()?;
        Ok(tried)
    }

    fn tried(&self, setting: Setting) -> Tried {
        let rig = setting.apply(&self.driving.rig);
        let demands = self.demand().heads(&rig);
        // the first that is not borne is enough to know
        let borne = demands.iter().take_while(|head| self.bears(head)).count();
        if borne < demands.len() {
            return Tried { setting, borne, errors_mm: None };
        }
        let heads = u64::from(self.choice.plants);
        let on_head = |number: u64| {
            self.errors_mm(&Spread::USUAL.draw(&rig, self.choice.seed.wrapping_add(number)), number)
        };
        let all: Option<Vec<(f64, f64)>> = (0..heads).map(on_head).collect();
        let errors_mm = all.map(|all| Errors {
            max_p95: Quantiles::of(all.iter().map(|e| e.0)).p95,
            rms_median: Quantiles::of(all.iter().map(|e| e.1)).median,
        });
        Tried { setting, borne, errors_mm }
    }

    /// Whether a head draws the shape without ever leaving its way.
    fn bears(&self, head: &RigConfig) -> bool {
        let mut simulated = SimulatedRig::new(&head.trusting(), self.driving.pose, self.choice.seed);
        let run = tracelight_sim::run(&mut simulated, &self.plan, false, |_, tick| {
            let lost = matches!(tick.telemetry.phase, Phase::Holding | Phase::Testing | Phase::Faulted);
            if lost { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        run.is_done()
    }

    /// Largest and rms error on a head, mm; `None` if it does not finish.
    fn errors_mm(&self, head: &RigConfig, number: u64) -> Option<(f64, f64)> {
        let seed = self.choice.seed.wrapping_add(number);
        let mut simulated = SimulatedRig::new(&head.trusting(), self.driving.pose, seed);
        let run = tracelight_sim::run(&mut simulated, &self.plan, false, |_, _| ControlFlow::Continue(()));
        let tracking = score(&self.plan, &run, self.plan.set_speed_m_s);
        run.is_done().then_some((tracking.max_mm, tracking.rms_mm))
    }
}

/// The one with the smallest error of those that bear the demand.
fn best(tried: &[Tried]) -> Option<&Tried> {
    let bear = tried.iter().filter(|t| t.errors_mm.is_some());
    bear.min_by(|a, b| a.worst_mm().total_cmp(&b.worst_mm()))
}

fn nothing_bears(choice: &Choice) -> Failure {
    let message = format!(
        "no law at any bandwidth draws the shape with motors {0} times as strong and as weak as believed and currents {1} ms late; \
         ask for a smaller --gain-margin or --lag, or draw more slowly",
        choice.gain_margin,
        1e3 * choice.lag_s
    );
    Failure::failed("no-such-design", message)
}
