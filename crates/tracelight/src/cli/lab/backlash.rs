use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::backlash::Request;
use tracelight_task::{Failure, Stop};
use tracelight_units::{LENGTHS, Length};

use super::bounds::above_zero;
use super::columns::ColumnArgs;
use super::command::{self, LabCommand, logs};
use super::rig::RigArgs;
use super::step::Axis;
use crate::cli::answer::{Answer, Voice};

/// Identify the play between encoder and beam, and whether the encoder slips, from where the spot rests on a ruler
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab backlash --rig worn --axis pan\n\n\
                  An encoder does not see what lies behind it: play in gears and belts, a disc that slips on its axis, counts that get lost. The spot does. \
                  A joint goes to the same places from below and from above, the other one straight ahead, and each time it rests the spot is read \
                  off a ruler on the target. A log has a row each reading, in order: axis,count,way,spot_m: the encoder's count, 1 or -1 for where it \
                  came from (turning positively or negatively), and where the spot is, x for pan, y for tilt, as this program counts them (right \
                  and up). A joint must rest at its place to a small part of a count, from either side: what stops short looks like play. Given no log, the \
                  simulated head is tried, by law state. The folder gets backlash.svg, and readings.csv, if the head was tried.")]
pub(crate) struct BacklashArgs {
    /// Logs of readings: axis,count,way,spot_m
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    #[command(flatten)]
    columns: ColumnArgs,
    #[command(flatten)]
    rig: RigArgs,
    /// Only this joint [default: both]; the joint of a log that has no column axis
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// From the head to the target, square-on
    #[arg(long, value_name = "LENGTH", default_value = "3ft")]
    distance: Length,
    /// What the ruler is read to, where the simulated head is tried
    #[arg(long, value_name = "LENGTH", default_value = "0.5mm", value_parser = fine)]
    ruler: f64,
    /// How often each place is gone to from either side
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=50))]
    cycles: u32,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/backlash")]
    out: PathBuf,
    #[command(flatten)]
    voice: Voice,
}

fn fine(text: &str) -> Result<f64, String> {
    above_zero(text, LENGTHS)
}

impl LabCommand for BacklashArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        command::filed(self.request()?, &self.out, self.voice, stop)
    }
}

impl BacklashArgs {
    fn request(&self) -> Result<Request, Failure> {
        Ok(Request {
            rig: self.rig.config()?,
            logs: logs(&self.logs)?,
            columns: self.columns.columns(),
            only: self.axis.map(Axis::joint),
            distance_m: self.distance.0,
            ruler_m: self.ruler,
            cycles: self.cycles,
            seed: self.seed,
        })
    }
}
