use clap::Args;
use tracelight_experiment::montecarlo::Request;
use tracelight_task::{Failure, Stop};

use super::command::{self, LabCommand, OutFile, out_file};
use super::shape::ShapeArgs;
use crate::cli::answer::{Answer, Voice};

/// Draw the same on many heads with varied parameters: median, 95th percentile and worst error
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab montecarlo --plants 1000 --shape circle -o heads.svg\n\n\
                  What is believed of the rig stays; what each head truly is differs: Coulomb friction by up to 15 %, viscous \
                  30 %, inertia and gravity 5 %; break-away 1 to 1.3 times Coulomb friction, ripple of friction up to 10 %, \
                  edges misplaced by up to 0.1 counts.")]
pub(crate) struct MonteCarloArgs {
    /// How many heads
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    plants: u32,
    #[command(flatten)]
    shape: ShapeArgs,
    /// Laps each head draws, identified between them; the figures are the last lap's
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    laps: u32,
    /// Seed of the first head; the next have the seeds after it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..u64::MAX / 2))]
    seed: u64,
    /// Plot the heads' errors, sorted, into an SVG or PNG, or write a row a head to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

impl LabCommand for MonteCarloArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let request = Request {
            driving: self.shape.driving()?,
            shape: self.shape.shape()?,
            plants: self.plants,
            laps: self.laps,
            seed: self.seed,
        };
        let finding = command::tried(request, self.voice, stop)?;
        self.out.iter().try_for_each(|file| file.write(&finding))?;
        Ok(Answer { failure: finding.unfinished(), ..command::answer(&finding, self.voice) })
    }
}
