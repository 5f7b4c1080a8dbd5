//! One job from picture to results: the stages in their order.

mod recovery;
mod remainder;
mod seen;
mod watched;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use tracelight_eye::figures::EyeFigures;
use tracelight_eye::homing::{check_homed, lost_power};
use tracelight_eye::room::{Furnished, left};
use tracelight_files as files;
use tracelight_lab::{LAPS_WORTH, identify};
use tracelight_pipeline::{Driving, OrderBy, Placed, Schedule, Sketch, place, schedule, sketch};
use tracelight_rig::{Command, Joint, PanTilt, Rig};
use tracelight_rigfile as rigfile;
use tracelight_sim::{RigConfig, Run, SimulatedRig, Tick, Tracking, score};
use tracelight_stroke::Effort;
use tracelight_task::{Failure, Stop, Task};
use tracelight_trajectory::Plan;

use crate::bar::Bar;
use crate::cli::request::TraceArgs;
use crate::named;
use crate::output::{self, Job, LogMeta, LogWriter, OutputError, Picture, Setting, Summary, Target, Timing};
use crate::settings;
use seen::Seen;
use watched::{WatchedJob, WatchedRun, run_watched};

/// A job that ran to an end, its own or another.
pub(crate) struct Outcome {
    pub(crate) summary: Summary,
    /// Where its results are.
    pub(crate) dir: PathBuf,
    /// Why it ended early: a rig's fault, or Ctrl-C.
    pub(crate) failure: Option<Failure>,
}

/// What the stages before the run made.
struct Prepared {
    sketch: Sketch,
    placed: Placed,
    driving: Driving,
    schedule: Schedule,
    /// Remarks for the user.
    notes: Vec<String>,
    vision_ms: f64,
    plan_ms: f64,
    /// What a camera saw.
    seen: Option<Seen>,
}

/// Every lap that was run.
struct Laps {
    earlier: Vec<Run>,
    last: Run,
    /// The rig as it was identified between laps, if it was.
    identified: Option<RigConfig>,
    /// What a camera saw of the last one, and the plan that it came to.
    watched: Option<WatchedRun>,
    /// Why the last one ended before its time, if neither the rig's fault nor the user ended it.
    failure: Option<Failure>,
    notes: Vec<String>,
    run_ms: f64,
}

/// Picture → strokes → target → order → plan → run → results.
pub(crate) fn trace(args: &TraceArgs, stop: &Stop) -> Result<Outcome, Failure> {
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    let prepared = prepare(args, task)?;
    check_laps(args.laps, &prepared.schedule.plan)?;
    let dir = args.out.clone().unwrap_or_else(|| default_dir(args));
    std::fs::create_dir_all(&dir).map_err(|e| cannot_write(&dir, &e))?;
    let settings = settings::of(args, &prepared.driving, &prepared.placed);
    let laps = run_laps(args, &prepared, &dir, &settings, task)?;
    task.stage("report", 1);
    let summary = write(args, &prepared, &laps, &dir, &settings)?;
    let failure = laps.failure.or_else(|| ending(&laps.last, stop));
    Ok(Outcome { summary, dir, failure })
}

fn prepare(args: &TraceArgs, task: Task<'_>) -> Result<Prepared, Failure> {
    args.check_camera()?;
    if args.eye.camera.is_some() {
        return seen::prepare(args, task);
    }
    let mut driving = args.driving.resolve()?;
    args.law.apply(&mut driving.rig);
    task.stage("strokes", 1);
    let (source, placing) = (named::picture(args.name())?, args.placement.placing());
    let (sketch, vision_ms) = task.timed(|| sketch(args.name(), source, &args.tracing.tracing(), &placing));
    let sketch = sketch?;
    task.check()?;
    let placed = place(&sketch, &placing);
    planned((sketch.shown(), vision_ms), placed, driving, None, task)
}

/// A drawing on the target, in order and in time.
fn planned(
    (sketch, vision_ms): (Sketch, f64),
    placed: Placed,
    driving: Driving,
    seen: Option<Seen>,
    task: Task<'_>,
) -> Result<Prepared, Failure> {
    task.stage("plan", 1);
    let (schedule, plan_ms) = task.timed(|| schedule(&placed, &driving, OrderBy::default(), Effort::Normal));
    let schedule = schedule?;
    task.check()?;
    let notes: Vec<String> = sketch.notes().into_iter().chain(driving.remarks(&schedule.plan)).collect();
    notes.iter().for_each(|n| task.say(&format!("note: {n}")));
    Ok(Prepared { sketch, placed, driving, schedule, notes, vision_ms, plan_ms, seen })
}

impl Prepared {
    /// The simulated room that a camera looks at while the laser draws.
    fn watched(&self) -> Option<(&Seen, &Furnished)> {
        self.seen.as_ref().and_then(|seen| Some((seen, seen.room.as_ref()?)))
    }
}

/// `out/<the picture's stem>/`; `out/<stem>-camera/` of what a camera sees.
fn default_dir(args: &TraceArgs) -> PathBuf {
    let name = args.name();
    let picture = name.strip_prefix("sim:").unwrap_or(name);
    let stem =
        Path::new(picture).file_stem().filter(|_| picture != "-").unwrap_or_else(|| "picture".as_ref());
    let seen = if args.eye.camera.is_some() { "-camera" } else { "" };
    Path::new("out").join(format!("{}{seen}", stem.to_string_lossy()))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::failed(
        "cannot-write",
        format!("cannot write {}: {error}; choose another with --out", path.display()),
    )
}

/// Longest run of all laps together, s: every tick is kept for the results, at some 200 bytes.
const LONGEST_S: f64 = 1800.0;

/// Refuses more laps than can be kept.
fn check_laps(laps: u32, plan: &Plan) -> Result<(), Failure> {
    let needed_s = f64::from(laps) * plan.duration_s();
    if needed_s <= LONGEST_S {
        return Ok(());
    }
    let message = format!(
        "--laps {laps} would take {needed_s:.0} s together, at most {LONGEST_S:.0} s are run at once"
    );
    Err(Failure::failed("too-long", message))
}

/// Runs the laps, each from power-up on the same head, and logs them all. Between two of them the head is identified from
/// those before, and the controller is told.
fn run_laps(
    args: &TraceArgs,
    prepared: &Prepared,
    dir: &Path,
    settings: &[Setting],
    task: Task<'_>,
) -> Result<Laps, Failure> {
    let began = Instant::now();
    let plan = &prepared.schedule.plan;
    let meta = LogMeta { picture_path: args.name(), settings, seed: args.seed };
    let mut laps: Vec<Run> = Vec::new();
    let mut learned = Learned { rig: prepared.driving.rig.clone(), taken: false, notes: Vec::new() };
    let mut log = LogWriter::open(&dir.join("run.mcap"), &meta)?;
    let (mut watched, mut failure) = (None, None);
    while laps.len() < args.laps as usize && !task.stop.is_wanted() && failure.is_none() {
        if !laps.is_empty() {
            task.stage("identify", 1);
            learned = learn(&prepared.driving.rig, &laps);
        }
        task.stage("run", plan.points.len() as u64);
        let Some(looks) = prepared.watched() else {
            let put_up = if args.is_powered_up() { left } else { SimulatedRig::new };
            let rig = put_up(&learned.rig, prepared.driving.pose, args.seed);
            let (lap, why) = run_lap(rig, plan, args.dry_run, &mut log, task)?;
            laps.push(lap);
            failure = why;
            continue;
        };
        let mut done = watched_lap(args, prepared, looks, &learned.rig, &mut log, task)?;
        laps.push(std::mem::take(&mut done.run));
        failure = done.failure.take();
        watched = Some(done);
    }
    log.finish()?;
    let last = laps.pop().unwrap_or_default();
    learned.notes.iter().for_each(|note| task.say(&format!("note: {note}")));
    let identified = learned.taken.then_some(learned.rig);
    Ok(Laps {
        earlier: laps,
        last,
        identified,
        watched,
        failure,
        notes: learned.notes,
        run_ms: began.elapsed().as_secs_f64() * 1e3,
    })
}

/// One lap that a camera follows, of a rig that is believed to be this.
fn watched_lap(
    args: &TraceArgs,
    prepared: &Prepared,
    (seen, room): (&Seen, &Furnished),
    believed: &RigConfig,
    log: &mut LogWriter,
    task: Task<'_>,
) -> Result<WatchedRun, Failure> {
    let mut driving = prepared.driving.clone();
    driving.rig = believed.clone();
    let job = WatchedJob {
        plan: &prepared.schedule.plan,
        drawing: &prepared.schedule.ordered.drawing,
        driving: &driving,
        seen,
        troubles: &args.follow.sim_trouble,
        dry: args.dry_run,
        open: args.follow.open_loop,
    };
    run_watched(&job, room.watched(believed, driving.pose), log, task)
}

/// What the laps so far tell of a rig.
struct Learned {
    rig: RigConfig,
    /// Some of it was better than what was believed.
    taken: bool,
    notes: Vec<String>,
}

fn learn(rig: &RigConfig, laps: &[Run]) -> Learned {
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

/// One lap, every tick in the log as it happens, and why it ended if its rig lost power. Ctrl-C darkens first and then ends the lap.
fn run_lap(
    mut rig: SimulatedRig,
    plan: &Plan,
    dry: bool,
    log: &mut LogWriter,
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
        if let Err(error) = log_tick(log, plan, tick) {
            failed = Some(error.into());
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

fn log_tick(log: &mut LogWriter, plan: &Plan, tick: &Tick) -> Result<(), OutputError> {
    output::planned(plan, tick.telemetry.plan_tick).map_or(Ok(()), |planned| log.tick(tick, planned))
}

fn write(
    args: &TraceArgs,
    prepared: &Prepared,
    laps: &Laps,
    dir: &Path,
    settings: &[Setting],
) -> Result<Summary, Failure> {
    let Prepared { sketch, placed, driving, schedule, .. } = prepared;
    let drawing = &schedule.ordered.drawing;
    let strokes = placed.svg(drawing);
    let path = dir.join("strokes.svg");
    std::fs::write(&path, strokes).map_err(|e| cannot_write(&path, &e))?;
    let path = dir.join("camera.jpg");
    match &prepared.seen {
        Some(seen) => output::write_jpeg(&path, &seen.image)?,
        None => output::forget(&path).map_err(|e| cannot_write(&path, &e))?,
    }
    write_rig(args, dir, laps)?;
    let follow = laps.watched.as_ref().map(|watched| watched.figures.clone());
    let eye = prepared.seen.as_ref().map(|seen| seen.after(&laps.last, follow));
    let plan = laps.watched.as_ref().map_or(&schedule.plan, |watched| &watched.plan);
    let seen = eye.iter().flat_map(EyeFigures::words);
    let notes: Vec<String> = prepared.notes.iter().chain(&laps.notes).cloned().chain(seen).collect();
    let tracking: Tracking = score(plan, &laps.last, plan.set_speed_m_s);
    let motors = &driving.rig.model.motors;
    let job = Job {
        picture_path: args.name(),
        picture: sketch
            .picture
            .as_ref()
            .map(|raster| Picture { raster, target_from_pixel: placed.target_from_sheet }),
        quality: sketch.quality.as_ref(),
        target: Target {
            width_m: placed.size_m.0,
            height_m: placed.size_m.1,
            distance_m: driving.pose.distance_m,
        },
        drawing,
        plan,
        run: &laps.last,
        earlier_laps: &laps.earlier,
        tracking,
        set_speed_m_s: plan.set_speed_m_s,
        command_limit_v: motors.map(|m| m.limit_v),
        torque_limit_nm: PanTilt::new(motors.pan.torque_limit_nm(), motors.tilt.torque_limit_nm()),
        tolerance_mm: driving.request.tolerance_m * 1e3,
        settings,
        notes: &notes,
        timing: Timing {
            vision_ms: prepared.vision_ms,
            plan_ms: prepared.plan_ms,
            run_ms: laps.run_ms,
            report_ms: 0.0,
        },
        seed: args.seed,
        dry_run: args.dry_run,
        eye,
        seen: laps.watched.as_ref().map(|watched| &watched.seen),
    };
    Ok(output::write_all(dir, &job)?)
}

/// Writes `rig.toml`, the rig as its laps identified it; where they did not, one that an earlier job left under this name is
/// removed. A rig file that the job was given stays as it is.
fn write_rig(args: &TraceArgs, dir: &Path, laps: &Laps) -> Result<(), Failure> {
    let path = dir.join("rig.toml");
    if files::is_same(&path.to_string_lossy(), &args.driving.rig) {
        return Ok(());
    }
    let Some(rig) = &laps.identified else {
        return output::forget(&path).map_err(|e| cannot_write(&path, &e));
    };
    let mut rig = rig.clone();
    named::date_rig(&mut rig);
    std::fs::write(&path, rigfile::write(&rig)).map_err(|e| cannot_write(&path, &e))
}

/// Whether the last lap ended as it should.
fn ending(run: &Run, stop: &Stop) -> Option<Failure> {
    if let Some(fault) = run.fault() {
        return Some(Failure::fault(fault));
    }
    if stop.is_wanted() {
        return Some(Failure::interrupted());
    }
    (!run.is_done()).then(|| {
        let message = "the run was given up: the head left its stroke again and again, and the laser was dark most of \
                       the time. One encoder count is more on a target that is further away: step nearer \
                       (--distance), or allow more (control.tolerance in the rig file)";
        Failure::failed("unfinished", message)
    })
}
