//! `lab encoder`: its flags, and where what is found goes.

use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::encoder::Request;
use tracelight_task::{Failure, Stop};
use tracelight_units::{ANGULAR_SPEEDS, parse};

use super::columns::ColumnArgs;
use super::command::{self, LabCommand, logs};
use super::rig::RigArgs;
use super::step::Axis;
use crate::cli::answer::{Answer, Voice};

/// Identify encoder errors: positions of the four quadrature edges, disc eccentricity, lost counts
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab encoder examples/edges.csv\n\n\
                  A joint turns evenly, once each way, and every edge is stamped with its time; a smooth motion through the edges about an edge tells \
                  how far that one lies beside its place. Misplaced edges repeat every four counts, a disc that sits beside its axis every turn; counts \
                  that are lost shift all that follow. A log has a row each edge: axis,time_s,count: when it came, and what the counter said then; a \
                  time that goes back begins another run. Given no log, the simulated head is tried in a fixture, each axis upright and free; its ticks \
                  tell the last edge of each. Without stamps an edge is known to a tick: turn slowly. Counts lost between two runs no edge can tell: `tracelight lab backlash` can. \
                  The folder gets encoder.svg, and edges.csv, if the head was tried.")]
pub(crate) struct EncoderArgs {
    /// Logs of edges: axis,time_s,count
    #[arg(value_name = "LOG.csv")]
    logs: Vec<String>,
    #[command(flatten)]
    columns: ColumnArgs,
    #[command(flatten)]
    rig: RigArgs,
    /// Only this joint [default: both]; the joint of a log that has no column axis
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    /// How fast the simulated head turns
    #[arg(long, value_name = "SPEED", default_value = "3rad/s", value_parser = speed)]
    speed: f64,
    /// How many turns each way
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u32).range(1..=200))]
    turns: u32,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/encoder")]
    out: PathBuf,
    #[command(flatten)]
    voice: Voice,
}

fn speed(text: &str) -> Result<f64, String> {
    let rad_s = parse(text, ANGULAR_SPEEDS).map_err(|e| e.to_string())?;
    if (0.05..=50.0).contains(&rad_s) {
        Ok(rad_s)
    } else {
        Err(format!("{text} is not between 0.05 and 50 rad/s"))
    }
}

impl LabCommand for EncoderArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        command::filed(self.request()?, &self.out, self.voice, stop)
    }
}

impl EncoderArgs {
    fn request(&self) -> Result<Request, Failure> {
        Ok(Request {
            rig: self.rig.config()?,
            logs: logs(&self.logs)?,
            columns: self.columns.columns(),
            only: self.axis.map(Axis::joint),
            speed_rad_s: self.speed,
            turns: self.turns,
            seed: self.seed,
        })
    }
}
