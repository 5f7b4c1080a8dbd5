use clap::Args;
use tracelight_experiment::frequencies::Frequencies;
use tracelight_experiment::gang::Request;
use tracelight_experiment::systems::Systems;
use tracelight_task::{Failure, Stop};

use super::bode::BandArgs;
use super::command::{self, LabCommand, OutFile, out_file};
use super::systems::PlantArgs;
use crate::cli::answer::{Answer, Voice};

/// Gang of four of a plant and a controller: sensitivity functions S, T, PS, CS with their peaks (Ms, Mt, H∞ norms)
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab gang G11 --controller K11 --controller K11t -o gang.svg\n\n\
                  With P and C in a loop of negative feedback, S = 1/(1 + PC) is what a disturbance at the plant's output becomes at the output, \
                  T = PC/(1 + PC) what the setpoint does, PS = P/(1 + PC) what a disturbance at the plant's input does, and CS = C/(1 + PC) what \
                  setpoint or noise become at the controller's output. Peaks are computed, not read from the curves; of a stable loop they \
                  are H∞ norms.")]
pub(crate) struct GangArgs {
    #[command(flatten)]
    plants: PlantArgs,
    /// Controller, a formula or a file as plants are; given again, each is put into a loop with each plant. With --sample it is
    /// sampled by Tustin's rule
    #[arg(long, value_name = "CONTROLLER", required = true, allow_hyphen_values = true)]
    controller: Vec<String>,
    #[command(flatten)]
    band: BandArgs,
    /// Of a measured loop: so many unstable poles plant and controller have together (0 for most)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=100))]
    unstable: Option<u8>,
    /// Plot into an SVG or PNG, or write a CSV with one row per frequency; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for GangArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let systems = self.plants.systems(&self.controller)?;
        let plants = Frequencies {
            systems: Systems { unstable: self.unstable.map(usize::from), ..systems },
            from_rad_s: self.band.from,
            to_rad_s: self.band.to,
            points: self.band.points,
        };
        command::plotted(
            Request { plants, controllers: self.controller.clone() },
            &self.out,
            self.voice,
            stop,
        )
    }
}
