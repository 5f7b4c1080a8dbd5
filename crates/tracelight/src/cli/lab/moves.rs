//! What the 2006 report did in LabVIEW: a line or an arc, from rest to rest, by every profile.

mod figure;
mod table;

use std::ops::ControlFlow;

use clap::{Args, Subcommand};
use tracelight_aim::HeadPose;
use tracelight_pipeline::{DEFAULT_DISTANCE_M, request_of};
use tracelight_rig::PanTilt;
use tracelight_sim::{RigConfig, Run, SimulatedRig, Tracking, score};
use tracelight_stroke::{Element, Piece, Point, Vec2};
use tracelight_task::{Failure, Stop};
use tracelight_trajectory::{Course, CourseError, Machine, MoveLimits, Pace, PlanError, Ramps};
use tracelight_units::{
    ACCELERATIONS, ANGULAR_ACCELERATIONS, ANGULAR_SPEEDS, Angle, Length, Offset, Rate, SPEEDS, Unit,
};

use super::{OutFile, out_file, within, write_all};
use crate::cli::placing::positive_length;
use crate::cli::shapes::{ProfileName, ramps};
use crate::cli::{Answer, Voice};
use crate::named;

/// Follow a line or an arc of the target from rest to rest: every profile as asked, and as the motors can
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab move arc --start 10in,0in --angle 90deg -o arc.svg")]
pub(crate) struct MoveArgs {
    #[command(subcommand)]
    course: CourseArgs,
}

#[derive(Subcommand, Debug)]
enum CourseArgs {
    Line(LineArgs),
    Arc(ArcArgs),
}

/// A straight line
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab move line --start=-10in,0in --to 10in,0in -o line.svg\n\n\
                        Speeds and accelerations in rad are the beam's: at 3 ft a radian is 3 ft of the line.")]
struct LineArgs {
    /// Where it begins, right and up of the target's centre
    #[arg(long, value_name = "X,Y", default_value = "0m,0m", allow_hyphen_values = true, value_parser = place)]
    start: Offset,
    /// Where it ends
    #[arg(long, value_name = "X,Y", conflicts_with_all = ["angle", "length"], allow_hyphen_values = true, value_parser = place)]
    to: Option<Offset>,
    /// Which way it goes, anticlockwise from the right
    #[arg(long, value_name = "ANGLE", default_value = "0deg", allow_hyphen_values = true, value_parser = turn)]
    angle: Angle,
    /// How long it is
    #[arg(long, value_name = "LENGTH", default_value = "12in", allow_hyphen_values = true, value_parser = positive_length)]
    length: Length,
    #[command(flatten)]
    pace: PaceArgs,
}

/// Part of a circle
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab move arc --start 10in,0in --angle 90deg -o arc.svg\n\n\
                        Speeds and accelerations in rad are about the arc's centre.")]
struct ArcArgs {
    /// Where it begins, right and up of the target's centre
    #[arg(long, value_name = "X,Y", default_value = "10in,0in", allow_hyphen_values = true, value_parser = place)]
    start: Offset,
    /// The circle's centre
    #[arg(long, visible_alias = "center", value_name = "X,Y", default_value = "0m,0m", allow_hyphen_values = true, value_parser = place)]
    centre: Offset,
    /// How far round, anticlockwise
    #[arg(long, value_name = "ANGLE", default_value = "90deg", allow_hyphen_values = true, value_parser = turn)]
    angle: Angle,
    #[command(flatten)]
    pace: PaceArgs,
}

/// How it is followed.
#[derive(Args, Debug)]
struct PaceArgs {
    /// Highest speed, of the spot or of the angle
    #[arg(long, value_name = "SPEED", default_value = "24rad/s", allow_hyphen_values = true, value_parser = speed)]
    vmax: Rate,
    /// Highest acceleration
    #[arg(long, value_name = "ACCELERATION", default_value = "100rad/s2", allow_hyphen_values = true, value_parser = acceleration)]
    amax: Rate,
    /// Highest deceleration [default: as --amax]
    #[arg(long, value_name = "ACCELERATION", allow_hyphen_values = true, value_parser = acceleration)]
    dmax: Option<Rate>,
    /// The S-curve's ramps: shares of the acceleration phase over which acceleration builds up and fades, then the same of
    /// the deceleration phase
    #[arg(long, value_name = "PA1,PA2,PB1,PB2", default_value = "0.2,0.2,0.15,0.15", allow_hyphen_values = true, value_parser = ramps)]
    ramps: Ramps,
    /// Which to plot; the first of them goes into the CSV
    #[arg(long, value_enum, value_delimiter = ',', default_value = "trapezoid,s-curve")]
    profile: Vec<ProfileName>,
    /// Take the limits as they are, whatever that asks of the motors, and run nothing: what the 2006 report simulated
    #[arg(long)]
    as_asked: bool,
    /// From the head to the target [default: 3ft]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    distance: Option<Length>,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// Seed of what differs from head to head
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Plot the moves into an SVG or PNG, or write one, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

impl MoveArgs {
    pub(super) const fn voice(&self) -> Voice {
        self.pace().voice
    }

    const fn pace(&self) -> &PaceArgs {
        match &self.course {
            CourseArgs::Line(args) => &args.pace,
            CourseArgs::Arc(args) => &args.pace,
        }
    }
}

fn place(text: &str) -> Result<Offset, String> {
    const FURTHEST_M: f64 = 1e3;
    let at: Offset = text.parse().map_err(|e| format!("{e}"))?;
    if at.0.0.abs() <= FURTHEST_M && at.1.0.abs() <= FURTHEST_M {
        Ok(at)
    } else {
        Err(format!("{text} is further than {FURTHEST_M} m from the target's centre"))
    }
}

fn turn(text: &str) -> Result<Angle, String> {
    const MOST_RAD: f64 = 100.0 * std::f64::consts::TAU;
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    if angle.0.abs() <= MOST_RAD { Ok(angle) } else { Err(format!("{text} is more than a hundred turns")) }
}

fn speed(text: &str) -> Result<Rate, String> {
    rate(text, SPEEDS, ANGULAR_SPEEDS)
}

fn acceleration(text: &str) -> Result<Rate, String> {
    rate(text, ACCELERATIONS, ANGULAR_ACCELERATIONS)
}

fn rate(text: &str, linear: &'static [Unit], angular: &'static [Unit]) -> Result<Rate, String> {
    let rate = Rate::parse(text, linear, angular)?;
    within(text, rate, rate.value(), if let Rate::Linear(_) = rate { linear } else { angular })
}

/// What is to be followed.
struct Wish {
    /// In words.
    title: String,
    piece: Piece,
    limits: MoveLimits,
}

/// One profile's moves.
struct Entry {
    name: ProfileName,
    /// By the limits as they were asked for, and the torque that takes; none for the optimum, which is the motors'.
    asked: Option<(Pace, PanTilt<f64>)>,
    /// What the motors can do of it, and how the simulated rig follows that.
    on_rig: Option<OnRig>,
}

struct OnRig {
    pace: Pace,
    run: Run,
    tracking: Tracking,
    /// The tick of the plan at which the move begins.
    start_tick: u32,
    /// The rig left the course and held, or did not get to the end.
    held: bool,
}

pub(crate) fn run(args: &MoveArgs, stop: &Stop) -> Result<Answer, Failure> {
    let pace = args.pace();
    let rig = named::rig(&pace.rig)?;
    let pose = HeadPose::square_on(pace.distance.map_or(DEFAULT_DISTANCE_M, |d| d.0));
    let machine = rig.machine(pose);
    let wish = args.wish(&pose)?;
    let course = Course::new(&machine, wish.piece).map_err(failure)?;
    if pace.as_asked && pace.profile.contains(&ProfileName::Optimal) {
        let message =
            "--profile optimal is as fast as the motors can, and --as-asked leaves them out; leave one away";
        return Err(Failure::usage("usage", message));
    }
    let mut entries = Vec::new();
    for name in ProfileName::ALL {
        stop.check()?;
        let asked = asked(name, &course, (&wish, pace)).map_err(failure)?;
        entries.push(Entry { name, asked, on_rig: None });
    }
    if !pace.as_asked {
        run_all(&mut entries, &course, (&wish, pace), (&rig, &pose), stop)?;
    }
    let bench =
        Bench { args: pace, wish: &wish, rig: &rig, machine: &machine, course: &course, entries: &entries };
    write_all(&pace.out, || figure::figure(&bench), || table::csv(&bench))?;
    Ok(Answer::new(table::text(&bench), table::json(&bench)))
}

/// All that is shown.
struct Bench<'a> {
    args: &'a PaceArgs,
    wish: &'a Wish,
    rig: &'a RigConfig,
    machine: &'a Machine,
    course: &'a Course<'a>,
    entries: &'a [Entry],
}

impl Bench<'_> {
    /// The moves to be plotted, in the order they were named.
    fn chosen(&self) -> impl Iterator<Item = &Entry> {
        self.args.profile.iter().filter_map(|&name| self.entries.iter().find(|entry| entry.name == name))
    }

    /// The move of an entry that is wanted: on the rig, or as asked.
    fn pace<'e>(&self, entry: &'e Entry) -> Option<&'e Pace> {
        let asked = entry.asked.as_ref().map(|(pace, _)| pace);
        entry.on_rig.as_ref().map(|on_rig| &on_rig.pace).or(asked)
    }
}

impl MoveArgs {
    fn wish(&self, pose: &HeadPose) -> Result<Wish, Failure> {
        let (piece, metres_per_rad, title) = match &self.course {
            CourseArgs::Line(line) => line.course(pose),
            CourseArgs::Arc(arc) => arc.course()?,
        };
        let pace = self.pace();
        let limits = MoveLimits {
            speed: pace.vmax.linear(metres_per_rad),
            acceleration: pace.amax.linear(metres_per_rad),
            deceleration: pace.dmax.unwrap_or(pace.amax).linear(metres_per_rad),
        };
        Ok(Wish { title, piece, limits })
    }
}

fn point(at: Offset) -> Point {
    Point::new(at.0.0, at.1.0)
}

impl LineArgs {
    fn course(&self, pose: &HeadPose) -> (Piece, f64, String) {
        let from = point(self.start);
        let to = self.to.map_or_else(|| from + self.length.0 * Vec2::from_angle(self.angle.0), point);
        let title =
            format!("line of {:.1} mm from {} to {} mm", 1e3 * from.distance(to), in_mm(from), in_mm(to));
        (Piece { from, element: Element::Line { to } }, pose.distance_m, title)
    }
}

impl ArcArgs {
    fn course(&self) -> Result<(Piece, f64, String), Failure> {
        let (from, centre) = (point(self.start), point(self.centre));
        let radius_m = from.distance(centre);
        if radius_m < 1e-6 {
            let message = "--start is at --centre: such an arc has no radius; move one of them";
            return Err(Failure::usage("usage", message));
        }
        let title = format!(
            "arc of {:.4}° about {} from {} mm, radius {:.1} mm",
            self.angle.0.to_degrees(),
            in_mm(centre),
            in_mm(from),
            1e3 * radius_m
        );
        Ok((Piece { from, element: Element::Arc { centre, sweep: self.angle.0 } }, radius_m, title))
    }
}

fn in_mm(at: Point) -> String {
    format!("({:.1}, {:.1})", 1e3 * at.x, 1e3 * at.y)
}

/// A profile by the limits as they were asked for, and the torque that takes.
fn asked(
    name: ProfileName,
    course: &Course<'_>,
    (wish, args): (&Wish, &PaceArgs),
) -> Result<Option<(Pace, PanTilt<f64>)>, CourseError> {
    let Some(shape) = name.shape(args.ramps) else { return Ok(None) };
    let pace = course.shaped(shape, &wish.limits);
    let torque_nm = course.torque_peaks_nm(&pace)?;
    Ok(Some((pace, torque_nm)))
}

/// Longest move that is run, s: all seven are kept, tick by tick.
const LONGEST_S: f64 = 60.0;

/// Fits every profile to the motors, and if none takes too long runs them all.
fn run_all(
    entries: &mut [Entry],
    course: &Course<'_>,
    (wish, args): (&Wish, &PaceArgs),
    (rig, pose): (&RigConfig, &HeadPose),
    stop: &Stop,
) -> Result<(), Failure> {
    let mut paces = Vec::new();
    for entry in entries.iter() {
        let pace = match entry.name.shape(args.ramps) {
            None => course.optimal(&wish.limits),
            Some(shape) => course.shaped_for_motors(shape, &wish.limits),
        };
        let pace = pace.map_err(failure)?;
        if pace.duration_s() > LONGEST_S {
            let too_long = PlanError::TooLong { needed_s: pace.duration_s(), most_s: LONGEST_S };
            return Err(failure(too_long.into()));
        }
        paces.push(pace);
    }
    for (entry, pace) in entries.iter_mut().zip(paces) {
        entry.on_rig = Some(run_one(pace, course, (rig, pose), args.seed, stop).map_err(failure)?);
        stop.check()?;
    }
    Ok(())
}

fn run_one(
    pace: Pace,
    course: &Course<'_>,
    (rig, pose): (&RigConfig, &HeadPose),
    seed: u64,
    stop: &Stop,
) -> Result<OnRig, CourseError> {
    let plan = course.plan(&pace, &request_of(rig))?;
    let mut simulated = SimulatedRig::new(rig, *pose, seed);
    let run = tracelight_sim::run(&mut simulated, &plan, false, |_, _| {
        if stop.is_wanted() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    let tracking = score(&plan, &run, plan.set_speed_m_s);
    // a rig that holds takes longer than its plan
    let held = !run.is_done() || run.ticks.len() > plan.points.len() + 50;
    let start_tick = plan.leg_ends.first().map_or(0, |end| end.start_tick);
    Ok(OnRig { pace, run, tracking, start_tick, held })
}

fn failure(error: CourseError) -> Failure {
    match error {
        CourseError::NoLength => Failure::usage("usage", error),
        CourseError::Reach { .. } => {
            let message = format!("{error}; move it nearer to the centre, or step back (--distance)");
            Failure::failed("unreachable", message)
        }
        CourseError::Plan(PlanError::TooLong { needed_s, most_s }) => {
            let message = format!(
                "the move would take {needed_s:.0} s, and at most {most_s:.0} s are run; give it a higher --vmax or --amax"
            );
            Failure::failed("too-long", message)
        }
        CourseError::Plan(error) => Failure::failed("motor-too-weak", error),
    }
}
