//! A job as the command line has it: a request from flags, its results in a folder.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

use tracelight_camera::{Opened, shown};
use tracelight_eye::power::unhomed;
use tracelight_eye::trouble::emulate;
use tracelight_files::{self as files, ResultFolder};
use tracelight_job::{
    Hands, Head, Nobody, Prepared, Ran, Request, RunRequest, Scene, Wall, prepare, prepare_wall,
};
use tracelight_operator::{AtWall, Attending, Seat, nobody_arms};
use tracelight_pipeline::told_places;
use tracelight_port::{At, Connected, head};
use tracelight_report::{Film, LogMeta, Summary, film};
use tracelight_results::{self as results, Asked, Before, Records, Told, write};
use tracelight_sim::{ByEncoders, Observed as _};
use tracelight_stroke::Vec2;
use tracelight_task::{Failure, Task};

use crate::cli::driving::stand_by;
use crate::cli::eyes::SimulatedEyeName;
use crate::cli::request::TraceArgs;
use crate::named;
use crate::settings;
use tracelight_flags::FrameName;

/// How a job ended.
pub(crate) struct Outcome {
    pub(crate) summary: Summary,
    /// Where its results are.
    pub(crate) dir: PathBuf,
    /// Why it ended early: a rig's fault, or Ctrl-C.
    pub(crate) failure: Option<Failure>,
}

/// Picture → strokes → target → order → plan → run → results.
///
/// # Errors
/// What is wrong with the request, or what failed before there was anything to tell.
pub(crate) fn trace(args: &TraceArgs, seat: Option<&dyn Seat>, task: Task<'_>) -> Result<Outcome, Failure> {
    run(args, (None, seat), task)
}

/// What a camera sees, planned: a simulated head is found by its dots meanwhile, unless it is known where it stands.
///
/// # Errors
/// As of [`trace`].
pub(crate) fn seen(args: &TraceArgs, task: Task<'_>) -> Result<Prepared, Failure> {
    prepared(args, task).map(|(prepared, _)| prepared)
}

/// The rest of a run that ended on its way, as a run of its own.
pub(crate) fn resume(
    args: &TraceArgs,
    earlier: &Earlier<'_>,
    seat: Option<&dyn Seat>,
    task: Task<'_>,
) -> Result<Outcome, Failure> {
    run(args, (Some(earlier), seat), task)
}

/// A run that ended on its way.
pub(crate) struct Earlier<'a> {
    /// What it was asked.
    pub(crate) asked: &'a Asked,
    /// It, and those that it went on with itself, the first one first.
    pub(crate) runs: Vec<Before>,
    /// The folder beside which the results go unless another one is given.
    pub(crate) beside: &'a Path,
}

fn run(
    args: &TraceArgs,
    (earlier, seat): (Option<&Earlier<'_>>, Option<&dyn Seat>),
    task: Task<'_>,
) -> Result<Outcome, Failure> {
    args.check_camera()?;
    args.check_keys(seat.is_some())?;
    let (prepared, asked, at) = begun(args, earlier, task)?;
    let device = at.map(|at| connected(args, &at, (&prepared, seat), task)).transpose()?;
    let dir = match &args.out {
        Some(dir) => dir.clone(),
        None => {
            ResultFolder::unused(&earlier.map_or_else(|| default_dir(args), |run| run.beside.to_owned()))?
        }
    };
    // from here on the laser may be lit, and results belong together
    let _kept = task.stop.keep();
    let folder = results::open(&dir, &args.driving.rig)?;
    let settings = settings::of(args, &prepared.driving, &prepared.placed);
    let name = shown(args.name());
    let meta = LogMeta { picture_path: &name, settings: &settings, seed: args.seed };
    let strokes = prepared.schedule.ordered.drawing.strokes.len();
    let mut kept = Records::begin(&folder, &asked, strokes, &meta)?;
    let (prepared, mut ran) = ran(args, prepared, (device, seat), &mut kept, task)?;
    if let Some(remark) = kept.finish()? {
        task.say(&format!("note: {remark}"));
        ran.notes.push(remark);
    }
    task.stage("report", 1);
    let told = Told {
        name: &name,
        settings: &settings,
        seed: args.seed,
        dry_run: args.dry_run,
        rig_file: &args.driving.rig,
        today: named::today(),
    };
    let summary = write(&folder, &told, &prepared, &ran)?;
    folder.finish()?;
    put_film(args, &name, &prepared, &ran)?;
    // also who wants it to end while results are written is told so
    let failure = ran.failure.take().or_else(|| task.check().err());
    Ok(Outcome { summary, dir, failure })
}

/// Writes the moving picture, where one was asked for.
fn put_film(args: &TraceArgs, name: &str, prepared: &Prepared, ran: &Ran) -> Result<(), Failure> {
    let Some(path) = &args.film else { return Ok(()) };
    let target = results::target(prepared);
    let film = film(&Film { name, target, run: &ran.last, simulated: ran.origin.simulated });
    let none = || {
        let message = format!(
            "{path} is not written: the spot was nowhere on the wall. Everything else of the run is there"
        );
        Failure::failed("cannot-write", message)
    };
    files::write(path, film.ok_or_else(none)?)
}

/// The head at a port. A real one is armed by a person, who has to be there: at a terminal, or where he has a seat.
fn connected(
    args: &TraceArgs,
    at: &At,
    (prepared, seat): (&Prepared, Option<&dyn Seat>),
    task: Task<'_>,
) -> Result<ByEncoders<Connected>, Failure> {
    let mut device = head(at, &prepared.driving.rig, prepared.driving.pose, task.stop)?;
    // before anything is written of a run that cannot begin
    if !device.rig().is_homed() {
        return Err(unhomed());
    }
    let is_there = seat.is_some() || std::io::stdin().is_terminal();
    if device.rig().wants_a_person() && !args.dry_run && !is_there {
        return Err(nobody_arms("start it in one, or with --dry-run"));
    }
    if !device.origin().simulated && !args.dry_run {
        named::fit(&prepared.driving.rig)?;
    }
    if !args.dry_run {
        device.rig_mut().wait_for_light(task)?;
    }
    Ok(device)
}

/// Runs what is prepared, by the head at a port if there is one.
fn ran(
    args: &TraceArgs,
    prepared: Prepared,
    (mut device, seat): (Option<ByEncoders<Connected>>, Option<&dyn Seat>),
    kept: &mut Records<'_>,
    task: Task<'_>,
) -> Result<(Prepared, Ran), Failure> {
    let wants_a_person = device.as_ref().is_some_and(|device| device.rig().wants_a_person());
    if let Some((seat, _)) = seat.zip(device.as_ref()) {
        seat.tell(&serde_json::json!({ "event": "head", "real": wants_a_person }));
    }
    // whoever sits elsewhere is asked whatever the head is: it is he who sees that nobody stands in the light
    let arms = (wants_a_person || seat.is_some()) && !args.dry_run;
    let how = args.by_hand.attending(args.is_by_steps(), device.is_some());
    let mut at_wall = AtWall::of(Attending { arms, ..how }, seat, task, task.stop);
    at_wall.iter().for_each(|hands| hands.preflight(&prepared.preflight(&named::today())));
    let (head, mut nobody) = (device.as_mut().map_or(Head::Simulated, |device| Head::Given(device)), Nobody);
    let hands: &mut dyn Hands = at_wall.as_mut().map_or(&mut nobody, |hands| hands);
    let (prepared, mut ran) = if args.is_by_steps() {
        prepared.run_steps(head, (kept, hands), task)?
    } else {
        let ran = prepared.run_by_hand(head, (kept, hands), task)?;
        (prepared, ran)
    };
    if let Some(device) = &mut device {
        ran.notes.extend(device.rig_mut().remarks());
        // it knows why it is gone
        if let Some(why) = device.rig().failure() {
            ran.notes.push(why.message.clone());
            ran.failure = Some(why);
        }
    }
    Ok((prepared, ran))
}

/// What is to be run, and what is kept of what was asked: the whole of it, or the rest of earlier runs.
fn begun(
    args: &TraceArgs,
    earlier: Option<&Earlier<'_>>,
    task: Task<'_>,
) -> Result<(Prepared, Asked, Option<At>), Failure> {
    let (whole, at) = prepared(args, task)?;
    let whole = whole.from_stroke(args.from_stroke)?;
    let whole = if args.is_by_steps() { whole.by_steps(args.pace.map(|pace| pace.0))? } else { whole };
    let Some(Earlier { asked, runs, .. }) = earlier else {
        let asked = Asked::of(&args.typed, named::now(), args.cannot_resume().is_none(), &whole)?;
        return Ok((whole, asked, at));
    };
    let (rest, asked) = asked.rest(whole, runs, named::now())?;
    rest.notes.last().iter().for_each(|note| task.say(&format!("note: {note}")));
    Ok((rest, asked, at))
}

fn prepared(args: &TraceArgs, task: Task<'_>) -> Result<(Prepared, Option<At>), Failure> {
    let (mut driving, at) = args.driving.resolve_head(task)?;
    at.iter().try_for_each(|_| args.check_port())?;
    args.law.apply(&mut driving.rig)?;
    emulate(&mut driving.rig, &args.follow.sim_trouble, args.eye.camera.is_some())?;
    driving.order.sequence = args.sequence.sequence();
    let head = args.head.as_deref().map(|path| named::head(path, &driving.rig)).transpose()?;
    if args.eye.camera.is_none() {
        head.iter().for_each(|known| stand_by(&mut driving, known));
    }
    let area_m = head.as_ref().and_then(|known| known.area_m);
    let mut placing = args.wall.placing(args.placement.placing(), Some(&driving), area_m)?;
    placing.points = args.points();
    placing.choice.places = args.points.is_some();
    let told: Vec<Vec2> = args.at.iter().map(|at| Vec2::new(at.0.0, at.1.0)).collect();
    let told = (!told.is_empty()).then(|| told_places(&told, &mut placing));
    placing.frame = args.by_hand.frame.map(FrameName::frame);
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
        let mut reading = args.reading.options()?;
        // an end of a dash is no place that anybody marks
        reading.dashes &= args.points.is_none();
        let source = match told {
            Some(told) => told,
            None => named::source(args.name(), &reading, &args.lettering)?,
        };
        return Ok((prepare(&request, source, task)?, at));
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
    Ok((prepare_wall(&request, wall, task)?, at))
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
