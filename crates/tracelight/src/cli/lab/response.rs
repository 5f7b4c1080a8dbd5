use clap::{Args, ValueEnum};
use tracelight_experiment::response::{self, Enters, Request};
use tracelight_task::{Failure, Stop};
use tracelight_units::TIMES;

use super::bounds::above_zero;
use super::command::{self, LabCommand, OutFile, out_file};
use super::systems::SystemArgs;
use crate::cli::answer::{Answer, Voice};

/// Response of transfer functions to a step, an impulse or a ramp: overshoot, rise time, settling time
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab response \"K11 G11\" \"K11t G11\" --closed -o steps.svg\n\n\
                  With --controller, or --closed, the response is that of the loop: to its setpoint, or to a --disturbance. A closed loop's error constants and \
                  steady-state errors are told.\n\n\
                  This is of systems on paper; lab step is of a rig, with friction, counts and limits.")]
pub(crate) struct ResponseArgs {
    #[command(flatten)]
    systems: SystemArgs,
    /// Input, from rest at time 0
    #[arg(long, value_enum, default_value = "step")]
    input: Input,
    /// A controller C, a formula as the systems are: each system is a plant in a loop with it
    #[arg(long, value_name = "CONTROLLER", allow_hyphen_values = true)]
    controller: Option<String>,
    /// The input is a disturbance of the loop: at the plant's input (a load, P/(1 + PC)), or at its output (1/(1 + PC))
    #[arg(long, value_enum)]
    disturbance: Option<Disturbance>,
    /// For how long [default: until all have settled, and a third longer]
    #[arg(long, value_name = "TIME", value_parser = duration)]
    duration: Option<f64>,
    /// Number of values, evenly over that time; discrete systems show every sample instead
    #[arg(long, value_name = "N", default_value_t = 2001, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    points: u32,
    /// Plot into an SVG or PNG, or write a CSV with one row per time step; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

/// What comes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Input {
    /// Unit step
    Step,
    /// Unit impulse (area 1); for discrete systems one sample of 1
    Impulse,
    /// Unit ramp: rises by 1 per second
    Ramp,
}

/// Where a disturbance acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Disturbance {
    /// Added to the plant's input: a load
    Input,
    /// Added to the plant's output
    Output,
}

fn duration(text: &str) -> Result<f64, String> {
    above_zero(text, TIMES)
}

impl Input {
    const fn input(self) -> response::Input {
        match self {
            Self::Step => response::Input::Step,
            Self::Impulse => response::Input::Impulse,
            Self::Ramp => response::Input::Ramp,
        }
    }
}

impl LabCommand for ResponseArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let request = Request {
            systems: self.systems.systems_beside(self.controller.as_slice())?,
            input: self.input.input(),
            controller: self.controller.clone(),
            enters: match self.disturbance {
                None => Enters::Setpoint,
                Some(Disturbance::Input) => Enters::PlantInput,
                Some(Disturbance::Output) => Enters::PlantOutput,
            },
            duration_s: self.duration,
            points: self.points,
        };
        command::plotted(request, &self.out, self.voice, stop)
    }
}
