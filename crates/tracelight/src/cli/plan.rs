use std::path::Path;

use clap::{Args, ValueEnum};
use tracelight_files as files;
use tracelight_grbl::BoardAxis;
use tracelight_job::Prepared;
use tracelight_pipeline::{
    Driving, OrderBy, OrderRequest, Placed, Schedule, SheetFigures, Sketch, Standing, place, schedule, sketch,
};
use tracelight_report::{ColourBy, HeadGcode, drawing, head_gcode, plan_csv, plan_json, plan_words, preview};
use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::Effort;
use tracelight_task::{Failure, Task, counted};
use tracelight_trajectory::{LitSpeed, Plan};

use crate::cli::answer::{Answer, Voice};
use crate::cli::driving::{DrivingArgs, stand_by};
use crate::cli::ending::ends_in;
use crate::cli::eyes::EyeArgs;
use crate::cli::gcode::PowerArgs;
use crate::cli::request::TraceArgs;
use crate::job;
use crate::named;
use tracelight_flags::LetteringArgs;
use tracelight_flags::PlacementArgs;
use tracelight_flags::ReadingArgs;
use tracelight_flags::SequenceArgs;
use tracelight_flags::TracingArgs;
use tracelight_flags::WallArgs;

/// Order a drawing and time it within what the motors can do
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight plan examples/star.png -o star.csv --order-by time\n\
                  What a camera sees, before any of it is drawn: tracelight plan --camera sim:examples/house.png")]
pub(crate) struct PlanArgs {
    /// A drawing (SVG, DXF, JSON, CSV) or a picture; - is standard input
    #[arg(required_unless_present_any = ["camera", "text"], conflicts_with_all = ["camera", "text"])]
    drawing: Option<String>,
    /// Write the plan: .csv, one row per millisecond; or .gcode (.gc, .nc, .ngc) for a head on a GRBL board, with --axes
    #[arg(help_heading = "Output", short, long, value_name = "FILE.csv|FILE.gcode", value_parser = table)]
    out: Option<String>,
    /// Which axis of a GRBL board turns which joint, a minus where the motor turns the other way: X=pan,Y=-tilt. Angles are in degrees,
    /// or in radians with --unit rad
    #[arg(help_heading = "Output", long, value_name = "LETTER=JOINT,…", value_parser = axes, requires = "out")]
    axes: Option<PanTilt<BoardAxis>>,
    #[command(flatten, next_help_heading = "Output")]
    power: PowerArgs,
    /// Write a preview of the plan as SVG, its lit path coloured
    #[arg(help_heading = "Output", long, value_name = "FILE.svg", value_parser = picture)]
    preview: Option<String>,
    /// What the colours of the preview say
    #[arg(help_heading = "Output", long, value_enum, default_value_t, requires = "preview")]
    colour_by: ColourByName,
    #[command(flatten, next_help_heading = "Time and order")]
    sequence: SequenceArgs,
    /// What the drawing order minimizes
    #[arg(help_heading = "Time and order", long, value_enum, default_value_t)]
    order_by: OrderByName,
    /// How much work goes into the order; the same amount gives the same order
    #[arg(help_heading = "Time and order", long, value_enum, default_value_t)]
    order_effort: OrderEffortName,
    #[command(flatten, next_help_heading = "Picture")]
    tracing: TracingArgs,
    #[command(flatten, next_help_heading = "Picture")]
    reading: ReadingArgs,
    #[command(flatten, next_help_heading = "Picture")]
    lettering: LetteringArgs,
    #[command(flatten, next_help_heading = "Size and place")]
    placement: PlacementArgs,
    #[command(flatten, next_help_heading = "Size and place")]
    wall: WallArgs,
    #[command(flatten)]
    driving: DrivingArgs,
    /// Where the head stands, as `calibrate corners` or `calibrate head` has found it
    #[arg(help_heading = "Size and place", long, value_name = "FILE.toml", conflicts_with = "distance")]
    head: Option<String>,
    #[command(flatten, next_help_heading = "Camera")]
    eye: EyeArgs,
    /// Random seed for the simulated room
    #[arg(
        help_heading = "Simulation",
        long,
        value_name = "N",
        default_value_t = 0,
        allow_hyphen_values = true,
        requires = "camera"
    )]
    seed: u64,
    #[command(flatten, next_help_heading = "Output")]
    pub(crate) voice: Voice,
}

/// What the colours of a preview say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ColourByName {
    /// How fast the spot is
    #[default]
    Speed,
    /// When a stroke is drawn
    Order,
    /// Which limit holds the spot back
    Limit,
}

impl ColourByName {
    const fn colour_by(self) -> ColourBy {
        match self {
            ColourByName::Speed => ColourBy::Speed,
            ColourByName::Order => ColourBy::Order,
            ColourByName::Limit => ColourBy::Limit,
        }
    }
}

/// What the drawing order minimizes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum OrderByName {
    /// Seconds of dark moves
    #[default]
    Time,
    /// Metres of dark moves
    Distance,
}

/// How much work goes into the order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum OrderEffortName {
    /// Stop at the first local optimum
    Quick,
    /// About a second for 5000 strokes
    #[default]
    Normal,
    /// Ten times that
    Best,
}

impl OrderByName {
    const fn order_by(self) -> OrderBy {
        match self {
            OrderByName::Time => OrderBy::Time,
            OrderByName::Distance => OrderBy::Distance,
        }
    }
}

impl OrderEffortName {
    const fn effort(self) -> Effort {
        match self {
            OrderEffortName::Quick => Effort::Quick,
            OrderEffortName::Normal => Effort::Normal,
            OrderEffortName::Best => Effort::Best,
        }
    }
}

fn table(text: &str) -> Result<String, String> {
    if drawing::is_gcode(Path::new(text)) {
        return Ok(text.to_owned());
    }
    let way = "a plan is a table (.csv), or with --axes G-code of the joints (.gcode); the strokes as SVG, DXF or other files: \
               `tracelight strokes DRAWING -o FILE`";
    ends_in(text, "csv", way)
}

/// Both joints, each on an axis of its own.
fn axes(text: &str) -> Result<PanTilt<BoardAxis>, String> {
    let example = "such as X=pan,Y=tilt, or X=pan,Y=-tilt where a motor turns the other way";
    let mut found: PanTilt<Option<BoardAxis>> = PanTilt::default();
    for part in text.split(',') {
        let (letter, joint) =
            part.split_once('=').ok_or_else(|| format!("{part} is no LETTER=JOINT, {example}"))?;
        let letter = match letter.trim().to_ascii_uppercase().chars().collect::<Vec<_>>()[..] {
            [letter @ ('X' | 'Y' | 'Z' | 'A' | 'B' | 'C')] => letter,
            _ => return Err(format!("{letter} is no axis: X, Y, Z, A, B or C, {example}")),
        };
        let joint = joint.trim();
        let (reversed, name) = joint.strip_prefix('-').map_or((false, joint), |name| (true, name));
        let joint = Joint::BOTH
            .into_iter()
            .find(|known| known.name().eq_ignore_ascii_case(name))
            .ok_or_else(|| format!("{name} is no joint: pan or tilt, {example}"))?;
        if found[joint].replace(BoardAxis { letter, reversed }).is_some() {
            return Err(format!("{joint} has two axes: give each joint one, {example}"));
        }
    }
    match (found.pan, found.tilt) {
        (Some(pan), Some(tilt)) if pan.letter != tilt.letter => Ok(PanTilt::new(pan, tilt)),
        (Some(_), Some(_)) => Err(format!("both joints cannot be on one axis: {example}")),
        _ => Err(format!("give both joints, {example}")),
    }
}

fn picture(text: &str) -> Result<String, String> {
    ends_in(text, "svg", "a preview is an SVG: end it in .svg")
}

/// Plans the drawing, or what a camera sees: as a command line of `trace`, which the function reads, would.
pub(crate) fn run(
    args: &PlanArgs,
    traced: impl Fn(&[String]) -> Result<TraceArgs, Failure>,
    task: Task<'_>,
) -> Result<Answer, Failure> {
    check_out(args)?;
    if let Some(camera) = &args.eye.camera {
        let asked = seen(args, traced(&["trace".to_owned(), format!("--camera={camera}")])?)?;
        let Prepared { sketch, placed, driving, schedule, vision_ms, plan_ms, .. } = job::seen(&asked, task)?;
        schedule
            .notes
            .iter()
            .chain(&driving.remarks(&schedule.plan))
            .for_each(|n| task.say(&format!("note: {n}")));
        return answered(args, &Planned { sketch, placed, driving, schedule, vision_ms, plan_ms }, task);
    }
    let mut driving = args.driving.resolve()?;
    let known = args.head.as_deref().map(|path| named::head(path, &driving.rig)).transpose()?;
    known.iter().for_each(|known| stand_by(&mut driving, known));
    driving.order = OrderRequest {
        sequence: args.sequence.sequence(),
        by: args.order_by.order_by(),
        effort: args.order_effort.effort(),
    };
    task.stage("strokes", 1);
    let name = args.drawing.as_deref().or(args.lettering.name()).unwrap_or_default();
    let source = named::source(name, &args.reading.options()?, &args.lettering)?;
    let area_m = known.as_ref().and_then(|known| known.area_m);
    let placing = args.wall.placing(args.placement.placing(), Some(&driving), area_m)?;
    let (sketch, vision_ms) = task.timed(|| sketch(name, source, &args.tracing.tracing(), &placing));
    let sketch = sketch?;
    let placed = place(&sketch, &placing)?;
    task.check()?;
    task.stage("plan", 1);
    let (schedule, plan_ms) = task.timed(|| schedule(&placed, &driving));
    let schedule = schedule?;
    sketch
        .notes()
        .iter()
        .chain(&placed.notes)
        .chain(&schedule.notes)
        .chain(&driving.remarks(&schedule.plan))
        .for_each(|n| task.say(&format!("note: {n}")));
    answered(args, &Planned { sketch, placed, driving, schedule, vision_ms, plan_ms }, task)
}

/// What was planned.
struct Planned {
    sketch: Sketch,
    placed: Placed,
    driving: Driving,
    schedule: Schedule,
    vision_ms: f64,
    plan_ms: f64,
}

/// The flags as those of `trace`, which has what a camera sees drawn.
fn seen(args: &PlanArgs, mut asked: TraceArgs) -> Result<TraceArgs, Failure> {
    if args.order_by != OrderByName::default() || args.order_effort != OrderEffortName::default() {
        let message = "--order-by and --order-effort are for drawings: leave them or --camera out";
        return Err(Failure::usage("usage", message));
    }
    asked.eye.clone_from(&args.eye);
    (asked.tracing, asked.reading) = (args.tracing.clone(), args.reading.clone());
    (asked.placement, asked.wall) = (args.placement.clone(), args.wall.clone());
    (asked.driving, asked.head) = (args.driving.clone(), args.head.clone());
    (asked.sequence, asked.seed) = (args.sequence.clone(), args.seed);
    asked.check_camera()?;
    Ok(asked)
}

/// Writes what is asked for of a plan, and answers.
fn answered(args: &PlanArgs, planned: &Planned, task: Task<'_>) -> Result<Answer, Failure> {
    let Planned { sketch, placed, driving, schedule, vision_ms, plan_ms } = planned;
    if let Some(path) = &args.out {
        let (bytes, note) = file(args, path, &schedule.plan, driving)?;
        files::write(path, bytes)?;
        note.iter().for_each(|note| task.say(&format!("note: {note}")));
    }
    if let Some(path) = &args.preview {
        files::write(path, preview(&schedule.plan, args.colour_by.colour_by(), schedule.plan.set_speed_m_s))?;
    }
    let timing = serde_json::json!({ "vision": vision_ms, "plan": plan_ms });
    let shortest = args.order_by == OrderByName::Distance || driving.request.lit_speed == LitSpeed::Stops;
    let standing = Standing::of(&placed.drawing, driving);
    let text = format!("{}\nhead: {}", plan_words(schedule, shortest), standing.words());
    Ok(Answer::new(
        text,
        plan_json((placed, SheetFigures::of(sketch, placed).as_ref()), &standing, schedule, &timing),
    ))
}

/// Whether what the flags ask for goes together, before any work.
fn check_out(args: &PlanArgs) -> Result<(), Failure> {
    let is_gcode = args.out.as_deref().is_some_and(|path| drawing::is_gcode(Path::new(path)));
    let unit = args.reading.axis_unit()?;
    let wrong = match (is_gcode, args.axes) {
        (true, None) => {
            "G-code of a plan is in joint angles: say which axis is which joint, --axes X=pan,Y=tilt; for a flat machine, `tracelight \
             strokes DRAWING -o FILE.gcode`"
        }
        (false, Some(_)) => "--axes is for G-code: end --out in .gcode",
        (false, None) if args.power.is_given() => {
            "--power is for G-code: end --out in .gcode, and give --axes"
        }
        (false, None) if unit.is_some() => {
            "deg and rad are units of a board's axes: give --axes and --out FILE.gcode"
        }
        _ => return Ok(()),
    };
    Err(Failure::usage("usage", wrong))
}

/// Lines that a board takes a second at 115 200 baud, as GRBL's are some 35 characters long.
const MOST_LINES_A_SECOND: usize = 300;

/// Furthest that the spot of a board's head may be from the plan at the same time, m.
const BOARD_TOLERANCE_M: f64 = 5e-5;

/// A plan as the file that its name says, and what to know of it.
fn file(
    args: &PlanArgs,
    path: &str,
    plan: &Plan,
    driving: &Driving,
) -> Result<(String, Option<String>), Failure> {
    let Some(axes) = args.axes else { return Ok((plan_csv(plan), None)) };
    let unit = args.reading.axis_unit()?.unwrap_or_default();
    let how = HeadGcode { axes, unit, power: args.power.s_word(), tolerance_m: BOARD_TOLERANCE_M };
    let program = head_gcode(plan, &|angle| driving.machine.geometry.spot(&driving.pose, angle), &how);
    let (moves, most) = (counted(program.moves, "move"), program.most_moves_a_second);
    let doubt = if most > MOST_LINES_A_SECOND {
        "; a board at 115 200 baud takes some 300 and would stutter: draw slower (--speed), or larger"
    } else {
        ""
    };
    let note = format!(
        "{path}: {moves}, at most {most} in a second{doubt}; open loop, as the board does not measure where the head is"
    );
    Ok((program.text, Some(note)))
}
