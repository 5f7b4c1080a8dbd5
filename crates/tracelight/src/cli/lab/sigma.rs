use clap::Args;
use tracelight_experiment::sigma::Request;
use tracelight_task::{Failure, Stop};

use super::bode::BandArgs;
use super::command::{self, LabCommand, OutFile, out_file};
use super::systems::OneSystemArgs;
use crate::cli::answer::{Answer, Voice};

/// Singular values of a system with several inputs and outputs, H∞ and H2 norm, zeros, hidden states, disk margins
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab sigma docs/linear/satellite.toml -o sigma.svg\n\
                  Example: tracelight lab sigma P*K --with P=docs/linear/satellite.toml --with K=docs/linear/mixing.toml\n\n\
                  The H∞ norm is the largest singular value over all frequencies, computed, not read from the curve. Zeros are transmission zeros. A \
                  system with as many outputs as inputs is taken as an open loop L closed by negative feedback: its disk margins say by which \
                  gain and phase each channel alone, and all at the same time, may change. In a product such as P*K of systems from files, the \
                  last comes first: K drives P.")]
pub(crate) struct SigmaArgs {
    #[command(flatten)]
    system: OneSystemArgs,
    #[command(flatten)]
    band: BandArgs,
    /// Plot into an SVG or PNG, or write a CSV with one row per frequency; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for SigmaArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let request = Request {
            system: self.system.system()?,
            from_rad_s: self.band.from,
            to_rad_s: self.band.to,
            points: self.band.points,
        };
        command::plotted(request, &self.out, self.voice, stop)
    }
}
