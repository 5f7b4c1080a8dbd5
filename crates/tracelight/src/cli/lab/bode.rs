use clap::Args;
use tracelight_experiment::bode::Request;
use tracelight_experiment::frequencies::Frequencies;
use tracelight_experiment::systems::Systems;
use tracelight_task::{Failure, Stop};

use super::bounds::frequency;
use super::command::{self, LabCommand, OutFile, out_file};
use super::systems::SystemArgs;
use crate::cli::answer::{Answer, Voice};

/// Bode plot, with gain, phase, delay and modulus margins
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab bode \"K11 G11\" \"K11t G11\" -o loop.svg\n\n\
                  The given system is the open loop; margins assume unity negative feedback. With --closed it is the closed loop, which has a \
                  bandwidth and may have a resonance, but no margins. Crossings are computed, not read from the curve; the plot marks them.")]
pub(crate) struct BodeArgs {
    #[command(flatten)]
    over: FrequencyArgs,
}

/// Systems over frequencies, and where that goes.
#[derive(Args, Debug)]
pub(super) struct FrequencyArgs {
    #[command(flatten)]
    systems: SystemArgs,
    #[command(flatten)]
    band: BandArgs,
    /// Number of unstable poles of a measured open loop, 0 for most. The Nyquist criterion then decides whether the closed loop is stable
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=100))]
    unstable: Option<u8>,
    /// Output file: a plot (.svg, .png) or one row per frequency (.csv); repeatable
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    pub(super) out: Vec<OutFile>,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Which frequencies.
#[derive(Args, Debug)]
pub(super) struct BandArgs {
    /// Lowest frequency [default: below every pole, zero and crossover]
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    pub(super) from: Option<f64>,
    /// Highest frequency [default: above every pole, zero and crossover]
    #[arg(long, value_name = "FREQUENCY", value_parser = frequency)]
    pub(super) to: Option<f64>,
    /// Number of frequencies, evenly spaced on a logarithmic scale
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub(super) points: u32,
}

impl FrequencyArgs {
    pub(super) fn frequencies(&self) -> Result<Frequencies, Failure> {
        Ok(Frequencies {
            systems: Systems { unstable: self.unstable.map(usize::from), ..self.systems.systems()? },
            from_rad_s: self.band.from,
            to_rad_s: self.band.to,
            points: self.band.points,
        })
    }
}

impl LabCommand for BodeArgs {
    fn voice(&self) -> Voice {
        self.over.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        command::plotted(Request(self.over.frequencies()?), &self.over.out, self.over.voice, stop)
    }
}
