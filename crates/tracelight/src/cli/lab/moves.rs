//! What the 2006 report did in LabVIEW: a line or an arc, from rest to rest, by every profile.

use clap::{Args, Subcommand};
use tracelight_aim::HeadPose;
use tracelight_experiment::moves::{Request, Way};
use tracelight_experiment::profile_name::ProfileName;
use tracelight_maths::planar;
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_stroke::Point;
use tracelight_task::{Failure, Stop};
use tracelight_trajectory::Ramps;
use tracelight_units::{
    ACCELERATIONS, ANGULAR_ACCELERATIONS, ANGULAR_SPEEDS, Angle, Length, Offset, Rate, SPEEDS, Unit,
};

use super::bounds::within;
use super::command::{self, LabCommand, OutFile, out_file};
use super::rig::RigArgs;
use crate::cli::answer::{Answer, Voice};
use tracelight_flags::positive_length;
use tracelight_flags::{profile, ramps};

/// Follow a line or an arc on the target from rest to rest: each profile as requested, and as limited by the motors
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
    #[arg(long, value_delimiter = ',', default_value = "trapezoid,s-curve", value_parser = profile())]
    profile: Vec<ProfileName>,
    /// Take the limits as they are, whatever that asks of the motors, and run nothing: what the 2006 report simulated
    #[arg(long)]
    as_asked: bool,
    /// From the head to the target [default: 3ft]
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true, value_parser = positive_length)]
    distance: Option<Length>,
    #[command(flatten)]
    rig: RigArgs,
    /// Random seed for the differences between simulated heads
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Plot the moves into an SVG or PNG, or write one, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
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

impl LabCommand for MoveArgs {
    fn voice(&self) -> Voice {
        self.pace().voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let (way, pace) = (self.way(), self.pace());
        let request = Request {
            rig: pace.rig.config()?,
            pose: HeadPose::square_on(pace.distance.map_or(DEFAULT_DISTANCE_M, |d| d.0)),
            way,
            speed: pace.vmax,
            acceleration: pace.amax,
            deceleration: pace.dmax.unwrap_or(pace.amax),
            ramps: pace.ramps,
            profiles: pace.profile.clone(),
            as_asked: pace.as_asked,
            seed: pace.seed,
        };
        command::plotted(request, &pace.out, pace.voice, stop)
    }
}

impl MoveArgs {
    const fn pace(&self) -> &PaceArgs {
        match &self.course {
            CourseArgs::Line(args) => &args.pace,
            CourseArgs::Arc(args) => &args.pace,
        }
    }

    fn way(&self) -> Way {
        match &self.course {
            CourseArgs::Line(line) => {
                let from = point(line.start);
                let to = || from + line.length.0 * planar::direction(line.angle.0);
                Way::Line { from, to: line.to.map_or_else(to, point) }
            }
            CourseArgs::Arc(arc) => {
                Way::Arc { from: point(arc.start), centre: point(arc.centre), sweep_rad: arc.angle.0 }
            }
        }
    }
}

fn point(at: Offset) -> Point {
    Point::new(at.0.0, at.1.0)
}
