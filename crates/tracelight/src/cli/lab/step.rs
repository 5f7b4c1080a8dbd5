use clap::{Args, ValueEnum};
use tracelight_experiment::step::Request;
use tracelight_rig::Joint;
use tracelight_sim::{LawName, ObserverName, StepReference};
use tracelight_task::{Failure, Stop};
use tracelight_units::Angle;

use super::by_hand::ByHandArgs;
use super::command::{self, LabCommand, OutFile, out_file};
use super::rig::RigArgs;
use crate::cli::answer::{Answer, Voice};
use tracelight_flags::{law, observer};

/// Send one joint from rest at zero to an angle: overshoot, settling time and steady-state error, on the nonlinear head and linearized
#[derive(Args, Debug)]
#[command(
    after_help = "Example: tracelight lab step --axis tilt --to 15deg --law state,report-zpk -o steps.svg\n\
                  Example: tracelight lab step --gains kp=20,kd=1.5 -o mine.svg\n\n\
                  state and pid-ff shape their reference: they are given a move as fast as the rig's limits allow; the other \
                  laws a jump, unless --reference says which. The linear response is of the joint by itself, linearized where the step ends, without \
                  Coulomb friction, quantizer and amplifier's limit."
)]
pub(crate) struct StepArgs {
    /// Which joint
    #[arg(long, value_enum, default_value = "pan")]
    axis: Axis,
    /// How far
    #[arg(long, value_name = "ANGLE", default_value = "15deg", allow_hyphen_values = true, value_parser = step)]
    to: Angle,
    /// Laws, the first of them first in --json and alone in the CSV [default: the rig's]
    #[arg(long, value_name = "LAW", value_delimiter = ',', value_parser = law())]
    law: Vec<LawName>,
    /// How counts become position and speed [default: the observer each law was designed with]
    #[arg(long, value_name = "OBSERVER", value_parser = observer())]
    observer: Option<ObserverName>,
    /// How the joint is told [default: as each law is meant]
    #[arg(long, value_enum)]
    reference: Option<Told>,
    #[command(flatten)]
    by_hand: ByHandArgs,
    #[command(flatten)]
    rig: RigArgs,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot the responses into an SVG or PNG, or write the first, a row a millisecond, to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

/// How a joint is told to go somewhere else.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Told {
    /// The setpoint is there at once
    Jump,
    /// It goes there as fast as the rig's limits allow
    Move,
}

/// A joint on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Axis {
    /// About the vertical
    Pan,
    /// Up and down
    Tilt,
}

impl Axis {
    pub(super) const fn joint(self) -> Joint {
        match self {
            Axis::Pan => Joint::Pan,
            Axis::Tilt => Joint::Tilt,
        }
    }
}

pub(super) fn step(text: &str) -> Result<Angle, String> {
    // less than a count of the original rig shows nothing but where in its count the joint was
    const LEAST_RAD: f64 = 1.5e-3;
    let angle: Angle = text.parse().map_err(|e| format!("{e}"))?;
    if (LEAST_RAD..=std::f64::consts::PI).contains(&angle.0.abs()) {
        Ok(angle)
    } else {
        Err(format!("{text} is not between {LEAST_RAD} rad and half a turn, either way"))
    }
}

impl Told {
    const fn reference(self) -> StepReference {
        match self {
            Self::Jump => StepReference::Jump,
            Self::Move => StepReference::Move,
        }
    }
}

impl LabCommand for StepArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let request = Request {
            rig: self.rig.config()?,
            joint: self.axis.joint(),
            to_rad: self.to.0,
            laws: self.law.clone(),
            observer: self.observer,
            reference: self.reference.map(Told::reference),
            by_hand: self.by_hand.by_hand(),
            seed: self.seed,
        };
        command::plotted(request, &self.out, self.voice, stop)
    }
}
