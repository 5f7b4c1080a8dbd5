use std::path::PathBuf;

use clap::Args;
use tracelight_experiment::tune::{Choice, Request};
use tracelight_sim::LawName;
use tracelight_task::{Failure, Stop};
use tracelight_units::{FREQUENCIES, TIMES};

use super::bounds::above_zero;
use super::command::{self, LabCommand};
use super::rig_out;
use super::shape::ShapeArgs;
use crate::cli::answer::{Answer, Voice};
use tracelight_flags::law;

/// Choose a rig's control law and bandwidth: the smallest error over varied heads among those that meet the robustness requirement
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab tune --laws state,pid-ff --gain-margin 1.3\n\n\
                  Every law at every bandwidth must first bear the demand: draw the shape, without once stopping to find its way back, \
                  with motors that give --gain-margin times what is believed of them, and with motors that give as much less; and with \
                  currents that come --lag late. Those that do draw it on --plants heads that differ as heads of one kind do \
                  (see `tracelight lab montecarlo`); the one whose largest error, on 95 of 100 of them (of fewer than 20, on all), is smallest is picked, and \
                  tried with each joint a quarter faster and slower.\n\n\
                  The folder gets tune.svg and rig.toml; --save writes law and bandwidths into one's own rig file, comments kept.")]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    shape: ShapeArgs,
    /// Laws to choose from
    #[arg(long, value_name = "LAW,…", value_delimiter = ',', default_value = "state,pid-ff,pid,lead-lag", value_parser = law())]
    laws: Vec<LawName>,
    /// By how much motors may be stronger, and weaker, than what is believed
    #[arg(long, value_name = "FACTOR", default_value_t = 1.5, value_parser = factor)]
    gain_margin: f64,
    /// By how much currents may lag
    #[arg(long, value_name = "TIME", default_value = "1ms", value_parser = lag)]
    lag: f64,
    /// Slowest loop
    #[arg(long, value_name = "SPEED", default_value = "10rad/s", value_parser = bandwidth)]
    slowest: f64,
    /// Fastest loop
    #[arg(long, value_name = "SPEED", default_value = "240rad/s", value_parser = bandwidth)]
    fastest: f64,
    /// How many heads that differ
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    plants: u32,
    /// Seed of the first head; the others have the numbers after it
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Folder for what is found
    #[arg(long, value_name = "DIR", default_value = "out/tune")]
    out: PathBuf,
    /// Write what was picked into the rig file itself, comments kept
    #[arg(long)]
    save: bool,
    #[command(flatten)]
    voice: Voice,
}

fn factor(text: &str) -> Result<f64, String> {
    let factor: f64 = text.parse().map_err(|_| format!("{text} is no number"))?;
    if (1.0..=5.0).contains(&factor) { Ok(factor) } else { Err(format!("{text} is not between 1 and 5")) }
}

fn lag(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if time_s <= 0.1 {
        Ok(time_s)
    } else {
        Err(format!("{text} is more than 0.1s, the most that a rig file takes"))
    }
}

fn bandwidth(text: &str) -> Result<f64, String> {
    let rad_s = above_zero(text, FREQUENCIES)?;
    if (0.1..=500.0).contains(&rad_s) {
        Ok(rad_s)
    } else {
        Err(format!("{text} is not between 0.1 and 500 rad/s"))
    }
}

impl LabCommand for TuneArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let (driving, rig) = (self.shape.driving()?, self.shape.rig());
        self.shape.may_save(self.save)?;
        let request = Request { shape: self.shape.shape()?, driving, choice: self.choice() };
        let finding = command::tried(request, self.voice, stop)?;
        command::leave(&finding, &self.out)?;
        rig_out::written(&finding, &self.out, rig, self.save, self.voice)
    }
}

impl TuneArgs {
    fn choice(&self) -> Choice {
        Choice {
            laws: self.laws.clone(),
            gain_margin: self.gain_margin,
            lag_s: self.lag,
            slowest_rad_s: self.slowest,
            fastest_rad_s: self.fastest,
            plants: self.plants,
            seed: self.seed,
        }
    }
}
