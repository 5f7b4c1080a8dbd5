use clap::Args;
use tracelight_experiment::nyquist::{Chart, Request};
use tracelight_task::{Failure, Stop};

use super::bode::FrequencyArgs;
use super::bounds::reach;
use super::command::{self, LabCommand};
use crate::cli::answer::{Answer, Voice};

/// Nyquist plot of the open loop: encirclements of −1, margins
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab nyquist \"K11 G11\" -o nyquist.svg\n\n\
                  Arrows point to higher frequencies. Beyond all that is finite the curve is cut; dashed arcs show how it turns at \
                  infinity, so that its turns round −1 can be counted.")]
pub(crate) struct NyquistArgs {
    #[command(flatten)]
    over: FrequencyArgs,
    /// Show so far from zero [default: −1 and all that is finite; a close-up of −1 as well where that is far]
    #[arg(long, value_name = "REACH", value_parser = reach)]
    reach: Option<f64>,
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
        on(Chart::Nyquist, (&self.over, self.reach), stop)
    }
}

impl LabCommand for NicholsArgs {
    fn voice(&self) -> Voice {
        self.over.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        on(Chart::Nichols, (&self.over, None), stop)
    }
}

fn on(chart: Chart, (over, reach): (&FrequencyArgs, Option<f64>), stop: &Stop) -> Result<Answer, Failure> {
    command::plotted(Request { over: over.frequencies()?, chart, reach }, &over.out, over.voice, stop)
}
