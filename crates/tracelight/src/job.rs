//! A job as the command line has it: a request from flags, its results in a folder.

use std::path::{Path, PathBuf};

use tracelight_camera::{Opened, shown};
use tracelight_files::{self as files, ResultFolder};
use tracelight_job::{Prepared, Ran, Request, RunRequest, Scene, Wall, prepare, prepare_wall};
use tracelight_pipeline::Standing;
use tracelight_report::{Finished, LogMeta, Picture, Setting, Summary, Target, Timing};
use tracelight_rig::PanTilt;
use tracelight_rigfile as rigfile;
use tracelight_sim::{Tracking, score};
use tracelight_task::{Failure, Stop, Task};

use crate::at_wall::AtWall;
use crate::bar::Bar;
use crate::cli::driving::stand_by;
use crate::cli::eyes::SimulatedEyeName;
use crate::cli::request::TraceArgs;
use crate::named;
use crate::results::{self, RunLog};
use crate::settings;

/// How a job ended.
pub(crate) struct Outcome {
    pub(crate) summary: Summary,
    /// Where its results are.
    pub(crate) dir: PathBuf,
    /// Why it ended early: a rig's fault, or Ctrl-C.
    pub(crate) failure: Option<Failure>,
}

/// Picture → strokes → target → order → plan → run → results.
pub(crate) fn trace(args: &TraceArgs, stop: &Stop) -> Result<Outcome, Failure> {
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    args.check_camera()?;
    let prepared = prepared(args, task)?;
    let dir = args.out.clone().unwrap_or_else(|| default_dir(args));
    // from here on the laser may be lit, and results belong together
    let _kept = stop.keep();
    let folder = results::open(&dir, &args.driving.rig)?;
    let settings = settings::of(args, &prepared.driving, &prepared.placed);
    let name = shown(args.name());
    let meta = LogMeta { picture_path: &name, settings: &settings, seed: args.seed };
    let mut log = RunLog::open(&folder, &meta)?;
    let mut ran = match AtWall::of(&args.by_hand, task, stop) {
        Some(mut hands) => prepared.run_by_hand(&mut log, &mut hands, task)?,
        None => prepared.run(&mut log, task)?,
    };
    if let Some(remark) = log.finish()? {
        task.say(&format!("note: {remark}"));
        ran.notes.push(remark);
    }
    task.stage("report", 1);
    let summary = write(args, &prepared, &ran, &folder, &settings)?;
    folder.finish()?;
    // also who wants it to end while results are written is told so
    let failure = ran.failure.take().or_else(|| task.check().err());
    Ok(Outcome { summary, dir, failure })
}

fn prepared(args: &TraceArgs, task: Task<'_>) -> Result<Prepared, Failure> {
    let mut driving = args.driving.resolve()?;
    args.law.apply(&mut driving.rig);
    driving.order.sequence = args.sequence.sequence();
    let head = args.head.as_deref().map(|path| named::head(path, &driving.rig)).transpose()?;
    if args.eye.camera.is_none() {
        head.iter().for_each(|known| stand_by(&mut driving, known));
    }
    let area_m = head.as_ref().and_then(|known| known.area_m);
    let placing = args.wall.placing(args.placement.placing(), Some(&driving), area_m)?;
    let request = Request {
        name: args.name(),
        tracing: args.tracing.tracing(),
        placing,
        driving,
        run: RunRequest {
            laps: args.laps,
            seed: args.seed,
            dry: args.dry_run,
            powered_up: args.is_powered_up(),
        },
    };
    if args.eye.camera.is_none() {
        return prepare(
            &request,
            named::source(args.name(), &args.reading.options()?, &args.lettering)?,
            task,
        );
    }
    let mut opened = args.eye.open()?;
    let wall = Wall {
        scene: scene(args, &mut opened)?,
        camera: args.eye.known()?,
        head,
        home: args.home,
        retakes: args.retakes,
        open_loop: args.follow.open_loop,
        troubles: args.follow.sim_trouble.clone(),
        today: named::today(),
    };
    prepare_wall(&request, wall, task)
}

/// Where images of the wall come from.
fn scene<'a>(args: &TraceArgs, opened: &'a mut Opened<'_>) -> Result<Scene<'a>, Failure> {
    let picture = match opened {
        Opened::Camera(camera) => return Ok(Scene::Camera(&mut **camera)),
        Opened::Simulated(picture) => *picture,
    };
    let pages = args.eye.has_pages()?;
    if args.eye.sim_camera == SimulatedEyeName::Report && pages {
        let message = format!(
            "the report's camera does not see picture and pages at once: calibrate it first (tracelight calibrate markers --camera sim \
             --sim-camera report --seed {} -o camera.toml), then give --calibration camera.toml",
            args.seed
        );
        return Err(Failure::usage("usage", message));
    }
    let picture = picture.map(|path| Ok::<_, Failure>((path, named::pixels(path)?))).transpose()?;
    Ok(Scene::Room { picture, eye: args.eye.sim_camera.eye(), pages })
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

fn write(
    args: &TraceArgs,
    prepared: &Prepared,
    ran: &Ran,
    folder: &ResultFolder,
    settings: &[Setting],
) -> Result<Summary, Failure> {
    let Prepared { sketch, placed, driving, schedule, .. } = prepared;
    let drawing = &schedule.ordered.drawing;
    folder.put(results::STROKES, placed.svg(drawing))?;
    results::put_jpeg(folder, results::CAMERA, prepared.camera_image())?;
    write_rig(args, folder, ran)?;
    let plan = ran.plan(prepared);
    let tracking: Tracking = score(plan, &ran.last, plan.set_speed_m_s);
    let motors = &driving.rig.model.motors;
    let bent = sketch.picture.as_ref().and_then(|picture| placed.bent_picture(picture));
    let name = shown(args.name());
    let job = Finished {
        picture_path: &name,
        picture: sketch.picture.as_ref().map(|raster| match &bent {
            Some((raster, target_from_pixel)) => Picture { raster, target_from_pixel: *target_from_pixel },
            None => Picture { raster, target_from_pixel: placed.target_from_sheet },
        }),
        quality: sketch.quality.as_ref(),
        target: Target {
            width_m: placed.size_m.0,
            height_m: placed.size_m.1,
            middle: placed.centre(),
            distance_m: driving.pose.distance_m,
        },
        standing: Standing::of(drawing, driving),
        align: placed.align.as_ref(),
        left_out: placed.left_out,
        drawing,
        plan,
        run: &ran.last,
        earlier_laps: &ran.earlier,
        tracking,
        set_speed_m_s: plan.set_speed_m_s,
        command_limit_v: motors.map(|m| m.limit_v),
        torque_limit_nm: PanTilt::new(motors.pan.torque_limit_nm(), motors.tilt.torque_limit_nm()),
        tolerance_mm: driving.request.tolerance_m * 1e3,
        settings,
        notes: &ran.notes,
        timing: Timing {
            vision_ms: prepared.vision_ms,
            plan_ms: prepared.plan_ms,
            run_ms: ran.run_ms,
            report_ms: 0.0,
        },
        seed: args.seed,
        dry_run: args.dry_run,
        simulated: ran.simulated,
        eye: ran.eye.clone(),
        seen: ran.seen.as_ref(),
    };
    results::write_all(folder, &job)
}

/// Writes `rig.toml`, the rig as its laps identified it. A rig file that the job was given stays as it is.
fn write_rig(args: &TraceArgs, folder: &ResultFolder, ran: &Ran) -> Result<(), Failure> {
    let Some(mut rig) = ran.identified.clone() else { return Ok(()) };
    if files::is_same(&folder.path(results::RIG).to_string_lossy(), &args.driving.rig) {
        return Ok(());
    }
    named::date_rig(&mut rig);
    folder.put(results::RIG, rigfile::write(&rig))
}
