use clap::{ArgAction, Args, ValueEnum};
use tracelight_experiment::simulate::{Followers, LONGEST_S, Motion, Request};
use tracelight_rig::PanTilt;
use tracelight_sim::{Between, LawName, ObserverName};
use tracelight_task::{Failure, Stop};
use tracelight_units::{TIMES, TORQUES};

use super::bounds::above_zero;
use super::by_hand::ByHandArgs;
use super::command::{self, LabCommand, OutFile, log, out_file};
use super::rig::RigArgs;
use super::shape::switch;
use crate::cli::answer::{Answer, Voice};
use tracelight_flags::{law, observer};

/// Run an array of times and angles through the nonlinear loop: desired, actual and error, as the 2006 report's simulation
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab simulate --random --law state,report-pd -o scopes.svg\n\
                  Example: tracelight lab simulate docs/simulate/nod.csv --controller '2 + 10 s/(1 + s/50)' '2 + 5 s/(1 + s/50)' --hold off --cap 500Nm\n\n\
                  A row of the array is t,pan,tilt: seconds and radians, with or without names above; pan_deg,tilt_deg are degrees, and a \
                  run's own trace.csv or a plan's CSV does as well. Between rows goes a spline, or lines. The head starts at rest where \
                  the array does.\n\n\
                  A law is the rig's controller as it would be flashed, every millisecond. A --controller is a transfer function for each \
                  joint, from error, rad, to torque, N m, in continuous time, as in the report's block diagram; K11, K22 and K11t, K22t \
                  are the report's own; the head is then new, without a rig's wear. --quantizer off lets it see angles as they are (a law: a million counts a turn), --hold off at \
                  once, not every millisecond.")]
pub(crate) struct SimulateArgs {
    /// Where the joints are to be: a row each t,pan,tilt
    #[arg(value_name = "TRAJ.csv", required_unless_present = "random")]
    array: Option<String>,
    /// Follow a random motion instead, within 15° of straight ahead, for so long
    #[arg(long, value_name = "TIME", num_args = 0..=1, default_missing_value = "10s", value_parser = time, conflicts_with = "array")]
    random: Option<f64>,
    /// What joins the rows
    #[arg(long, value_enum, default_value = "spline")]
    between: Join,
    /// Laws to follow it by, the first alone in the CSV [default: the rig's]
    #[arg(long, value_name = "LAW", value_delimiter = ',', value_parser = law())]
    law: Vec<LawName>,
    /// How counts become position and speed [default: as each law is meant]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    observer: Option<ObserverName>,
    #[command(flatten)]
    by_hand: ByHandArgs,
    /// Transfer functions to follow it by, for pan and for tilt
    #[arg(long, num_args = 2, value_names = ["PAN", "TILT"], allow_hyphen_values = true)]
    controller: Vec<String>,
    #[command(flatten)]
    rig: RigArgs,
    /// Whether angles are seen in counts
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = switch, action = ArgAction::Set)]
    quantizer: bool,
    /// Whether they are seen every millisecond only
    #[arg(long, value_name = "on|off", default_value = "on", value_parser = switch, action = ArgAction::Set)]
    hold: bool,
    /// Largest torque of the motors [default: as the rig's amplifiers allow]
    #[arg(long, value_name = "TORQUE", value_parser = torque)]
    cap: Option<f64>,
    /// Rest at the end
    #[arg(long, value_name = "TIME", default_value = "0.5s", value_parser = time)]
    rest: f64,
    /// Seed of what differs from head to head, and of a random motion
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot desired, actual, error and torque into an SVG or PNG, or write the first to a CSV, a row a millisecond; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

/// What joins rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Join {
    /// The smoothest curve through them
    Spline,
    /// Lines: the speed jumps at each
    Lines,
}

impl Join {
    const fn between(self) -> Between {
        match self {
            Self::Spline => Between::Spline,
            Self::Lines => Between::Lines,
        }
    }
}

fn time(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if time_s <= LONGEST_S { Ok(time_s) } else { Err(format!("{text} is more than {LONGEST_S} s")) }
}

fn torque(text: &str) -> Result<f64, String> {
    const MOST_NM: f64 = 1e6;
    let torque_nm = above_zero(text, TORQUES)?;
    if torque_nm <= MOST_NM { Ok(torque_nm) } else { Err(format!("{text} is more than {MOST_NM} Nm")) }
}

impl LabCommand for SimulateArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        command::plotted(self.request()?, &self.out, self.voice, stop)
    }
}

impl SimulateArgs {
    fn request(&self) -> Result<Request, Failure> {
        Ok(Request {
            rig: self.rig.config()?,
            motion: self.motion()?,
            followers: self.followers(),
            quantizer: self.quantizer,
            hold: self.hold,
            cap_nm: self.cap,
            rest_s: self.rest,
            seed: self.seed,
        })
    }

    fn motion(&self) -> Result<Motion, Failure> {
        Ok(match &self.array {
            Some(path) => Motion::Array(log(path)?, self.between.between()),
            None => Motion::Random(self.random.unwrap_or_default()),
        })
    }

    fn followers(&self) -> Followers {
        let controllers = match self.controller.as_slice() {
            [pan, tilt] => Some(PanTilt::new(pan.clone(), tilt.clone())),
            _ => None,
        };
        Followers {
            laws: self.law.clone(),
            observer: self.observer,
            by_hand: self.by_hand.by_hand(),
            controllers,
        }
    }
}
