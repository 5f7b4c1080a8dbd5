use std::fmt::Write;
use std::ops::ControlFlow;

use clap::Args;
use tracelight_chart::{Colour, Curve, Figure, Key, Panel, Pen, Scale, Theme};
use tracelight_lab::{LAPS_WORTH, Quantiles, identify};
use tracelight_pipeline::Driving;
use tracelight_rig::{Fault, Telemetry};
use tracelight_sim::{RigConfig, SimulatedRig, Spread, Tracking, score};
use tracelight_task::{Failure, Stop, Task, on_all_cores};
use tracelight_trajectory::Plan;

use super::shape::ShapeArgs;
use super::{OutFile, out_file, why_unfinished, write_all};
use crate::bar::Bar;
use crate::cli::{Answer, Voice};

/// Draw the same on many heads that differ: how exact it is on the middle one, on 95 of 100, on the worst
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab montecarlo --plants 1000 --shape circle -o heads.svg\n\n\
                  What is believed of the rig stays; what each head truly is differs: Coulomb friction by up to 15 %, viscous \
                  30 %, inertia and gravity 5 %; break-away 1 to 1.3 times Coulomb friction, ripple of friction up to 10 %, \
                  edges misplaced by up to 0.1 counts.")]
pub(crate) struct MonteCarloArgs {
    /// How many heads
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    plants: u32,
    #[command(flatten)]
    shape: ShapeArgs,
    /// Laps each head draws, identified between them; the figures are the last lap's
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    laps: u32,
    /// Seed of the first head; the next have the seeds after it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..u64::MAX / 2))]
    seed: u64,
    /// Plot the heads' errors, sorted, into an SVG or PNG, or write a row a head to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// What became of one head.
#[derive(Clone, Copy, Debug)]
struct Trial {
    finished: bool,
    fault: Option<Fault>,
    /// Ticks it took beyond its plan: it left its stroke and came back.
    late_ticks: usize,
    tracking: Tracking,
}

pub(crate) fn run(args: &MonteCarloArgs, stop: &Stop) -> Result<Answer, Failure> {
    let driving = args.shape.resolve()?;
    let plan = args.shape.plan(&driving)?;
    let trials = run_all(args, &driving, &plan, stop);
    stop.check()?;
    write_all(&args.out, || figure(args, &trials), || Ok(csv(args, &trials)))?;
    let answer = Answer::new(table(args, &driving, &trials), json(&trials));
    Ok(Answer { failure: failure(&trials), ..answer })
}

/// Every head, on all cores; what comes out does not depend on how many there are.
fn run_all(args: &MonteCarloArgs, driving: &Driving, plan: &Plan, stop: &Stop) -> Vec<Trial> {
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    task.stage("heads", u64::from(args.plants));
    let work = |number: usize| trial(driving, plan, args.laps, args.seed + number as u64);
    on_all_cores(args.plants as usize, task, work)
}

fn trial(driving: &Driving, plan: &Plan, laps: u32, seed: u64) -> Trial {
    let head = Spread::USUAL.draw(&driving.rig, seed);
    let draw = |rig: &RigConfig| {
        let mut simulated = SimulatedRig::new(rig, driving.pose, seed);
        tracelight_sim::run(&mut simulated, plan, false, |_, _| ControlFlow::Continue(()))
    };
    let mut run = draw(&head);
    let mut records: Vec<Vec<Telemetry>> = Vec::new();
    for _ in 1..laps {
        records.push(run.telemetry());
        if records.len() > LAPS_WORTH {
            records.remove(0);
        }
        // a head that shows too little goes on as it is believed to be
        let rig = identify(&head, &records).map_or_else(|_| head.clone(), |found| found.rig);
        run = draw(&rig);
    }
    Trial {
        finished: run.is_done(),
        fault: run.fault(),
        late_ticks: run.ticks.len().saturating_sub(plan.points.len()),
        tracking: score(plan, &run, plan.set_speed_m_s),
    }
}

/// A figure of a trial that is shown.
type Value = fn(&Trial) -> f64;

/// Their names in JSON and in the table.
const FIGURES: [(&str, &str, Value); 6] = [
    ("rms_mm", "error rms, mm", |t| t.tracking.rms_mm),
    ("max_mm", "error at most, mm", |t| t.tracking.max_mm),
    ("off_stroke_rms_mm", "off its stroke rms, mm", |t| t.tracking.off_stroke_rms_mm),
    ("off_stroke_max_mm", "off its stroke at most, mm", |t| t.tracking.off_stroke_max_mm),
    ("overshoot_percent", "overshoot, %", |t| t.tracking.overshoot_percent),
    ("final_error_mm", "error at rest, mm", |t| t.tracking.final_error_mm),
];

/// Those that drew all of it: the others have no error to speak of.
fn finished(trials: &[Trial]) -> impl Iterator<Item = &Trial> {
    trials.iter().filter(|trial| trial.finished)
}

fn held(trials: &[Trial]) -> usize {
    finished(trials).filter(|trial| trial.late_ticks > 0).count()
}

/// What to say of heads that did not finish.
fn failure(trials: &[Trial]) -> Option<Failure> {
    let missing = trials.len() - finished(trials).count();
    let mut names: Vec<&str> =
        trials.iter().filter(|trial| !trial.finished).map(|trial| why_unfinished(trial.fault)).collect();
    names.sort_unstable();
    names.dedup();
    let message = format!(
        "{missing} of {} heads did not finish ({}); their errors are not in the figures",
        trials.len(),
        names.join(", ")
    );
    (missing > 0).then(|| Failure::failed("unfinished", message))
}

fn table(args: &MonteCarloArgs, driving: &Driving, trials: &[Trial]) -> String {
    let law = driving.rig.control.law;
    let mut text = format!(
        "{}{} on {} heads like {}, law {}: {} finished, {} left the stroke and came back\n\n{:28} {:>8} {:>8} {:>8}",
        args.shape.shape,
        if args.laps > 1 { format!(", lap {},", args.laps) } else { String::new() },
        trials.len(),
        driving.rig.name,
        law.name(),
        finished(trials).count(),
        held(trials),
        "",
        "median",
        "95 %",
        "worst"
    );
    for (_, words, value) in FIGURES {
        let Quantiles { median, p95, worst } = Quantiles::of(finished(trials).map(value));
        // writing to a String cannot fail
        let _ = write!(text, "\n{words:28} {median:8.3} {p95:8.3} {worst:8.3}");
    }
    text
}

fn json(trials: &[Trial]) -> String {
    let mut object = serde_json::json!({
        "plants": trials.len(),
        "finished": finished(trials).count(),
        "held": held(trials),
    });
    for (name, _, value) in FIGURES {
        if finished(trials).next().is_none() {
            object[name] = serde_json::Value::Null;
            continue;
        }
        let Quantiles { median, p95, worst } = Quantiles::of(finished(trials).map(value));
        object[name] = serde_json::json!({ "median": median, "p95": p95, "worst": worst });
    }
    object.to_string()
}

fn csv(args: &MonteCarloArgs, trials: &[Trial]) -> String {
    let names: Vec<&str> = FIGURES.iter().map(|(name, _, _)| *name).collect();
    let mut text = format!("seed,finished,late_ticks,{}\n", names.join(","));
    for (number, trial) in trials.iter().enumerate() {
        let _ =
            write!(text, "{},{},{}", args.seed + number as u64, u8::from(trial.finished), trial.late_ticks);
        for (_, _, value) in FIGURES {
            let figure = if trial.finished { format!("{:.6}", value(trial)) } else { String::new() };
            text += &format!(",{figure}");
        }
        text.push('\n');
    }
    text
}

fn figure(args: &MonteCarloArgs, trials: &[Trial]) -> Result<String, Failure> {
    let sorted = |colour: Colour, value: Value| {
        let mut values: Vec<f64> = finished(trials).map(value).collect();
        values.sort_by(f64::total_cmp);
        let share = |k: usize| 100.0 * (k + 1) as f64 / values.len() as f64;
        let points = values.iter().enumerate().map(|(k, &v)| (share(k), v)).collect();
        Curve { colour, pen: Pen::Solid, points }
    };
    let figure = Figure {
        title: format!("{} on {} heads that differ", args.shape.shape, trials.len()),
        legend: vec![
            Key { colour: Colour::Blue, name: "at most".into() },
            Key { colour: Colour::Vermilion, name: "rms".into() },
        ],
        panels: vec![Panel {
            x_title: "share of the heads, %".into(),
            y_title: "error not above, mm".into(),
            curves: vec![sorted(Colour::Blue, FIGURES[1].2), sorted(Colour::Vermilion, FIGURES[0].2)],
            levels: vec![0.0],
            scale: Scale::Free,
            ..Panel::default()
        }],
        columns: 1,
        panel: (680, 380),
        theme: Theme::Light,
    };
    figure.svg().map_err(|e| Failure::failed("internal", e))
}
