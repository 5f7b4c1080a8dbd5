use clap::Args;
use tracelight_experiment::nyquist::{Chart, Request};
use tracelight_task::{Failure, Stop};

use super::bode::FrequencyArgs;
use super::command::{self, LabCommand};
use crate::cli::answer::{Answer, Voice};

/// Nyquist plot of the open loop: encirclements of −1, margins
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab nyquist \"K11 G11\" -o nyquist.svg")]
pub(crate) struct NyquistArgs {
    #[command(flatten)]
    over: FrequencyArgs,
}

/// Nichols chart of the open loop, with contours of the closed loop
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab nichols \"K11 G11\" -o nichols.svg")]
pub(crate) struct NicholsArgs {
    #[command(flatten)]
    over: FrequencyArgs,
}

impl LabCommand for NyquistArgs {
    fn voice(&self) -> Voice {
        self.over.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        on(Chart::Nyquist, &self.over, stop)
    }
}

impl LabCommand for NicholsArgs {
    fn voice(&self) -> Voice {
        self.over.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        on(Chart::Nichols, &self.over, stop)
    }
}

fn on(chart: Chart, over: &FrequencyArgs, stop: &Stop) -> Result<Answer, Failure> {
    command::plotted(Request { over: over.frequencies()?, chart }, &over.out, over.voice, stop)
}
