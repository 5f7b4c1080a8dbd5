use clap::Args;
use tracelight_experiment::linearize::Request;
use tracelight_task::{Failure, Stop};

use super::command::{self, LabCommand};
use super::head::HeadArgs;
use crate::cli::answer::{Answer, Voice};

/// The head near a pose as a linear system: state space, transfer functions G11 and G22 from torque to angle, poles
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab linearize --keep-cancellations\n\n\
                  Without flags it is the 2006 report's own linearization. Coulomb friction has no linear form and is left out. \
                  G11 and G22 go into other commands as they are: tracelight lab bode \"K11 G11\".")]
pub(crate) struct LinearizeArgs {
    #[command(flatten)]
    head: HeadArgs,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for LinearizeArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        command::told(Request(self.head.choice()?), self.voice, stop)
    }
}
