//! `lab frequency`: its flags, and where what is found goes.

use clap::Args;
use tracelight_experiment::frequency::Request;
use tracelight_files as files;
use tracelight_rig::Joint;
use tracelight_task::{Failure, Stop};
use tracelight_units::{ANGULAR_SPEEDS, FREQUENCIES, TIMES};

use super::bounds::{above_zero, voltage};
use super::columns::ColumnArgs;
use super::command::{self, LabCommand, OutFile, log, out_file};
use super::rig::RigArgs;
use super::step::Axis;
use crate::cli::answer::{Answer, Voice};

/// Measure a joint's frequency response and coherence with a multisine, and compare them with the model
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab frequency --axis tilt -o tilt.svg\n\n\
                  The joint stands in a fixture, its axis upright and free, and turns one way under a steady voltage: friction that does not change \
                  sides is a constant, and what is left of the joint is linear. On top come sines, whole periods of each in a period of all, at \
                  phases that keep their sum low. What the voltage does to the angle is told from the drift by which the joint \
                  turns meanwhile; coherence, from how periods differ, says how much of it is so. The model is the rig file's inertia, friction and torque \
                  per volt, sampled behind a hold as the counts are.\n\n\
                  A real head is measured by --volts: a period of the sines on top of the steady voltage, to be played again and again while the \
                  head turns; its log, axis,time_s,volt,count, a row a millisecond from when it turns evenly, is then given here, with the same --period. Any \
                  volts that repeat with the period do. Rows may be missing here and there; a log of other columns may have a row each so much time, \
                  and speeds in place of counts.")]
pub(crate) struct FrequencyTrialArgs {
    /// Log of what a head did: axis,time_s,volt,count; given none, the simulated head is tried
    #[arg(value_name = "LOG.csv")]
    log: Option<String>,
    #[command(flatten)]
    columns: ColumnArgs,
    /// Which joint [default: pan]; to be given for a log that has no column axis
    #[arg(long, value_enum)]
    axis: Option<Axis>,
    #[command(flatten)]
    rig: RigArgs,
    /// Lowest frequency
    #[arg(long, value_name = "FREQUENCY", default_value = "0.7rad/s", value_parser = frequency)]
    from: f64,
    /// Highest frequency
    #[arg(long, value_name = "FREQUENCY", default_value = "600rad/s", value_parser = frequency)]
    to: f64,
    /// Most sines
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u32).range(1..=1000))]
    sines: u32,
    /// All of them together are as strong as one of this amplitude
    #[arg(long, value_name = "VOLTAGE", default_value = "2V", value_parser = voltage)]
    amplitude: f64,
    /// Speed at which the joint turns meanwhile; the steady voltage is what holds it by the model
    #[arg(long, value_name = "SPEED", default_value = "10rad/s", allow_hyphen_values = true, value_parser = speed)]
    speed: f64,
    /// Period of all
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = period)]
    period: f64,
    /// Periods that are watched, after one that is not
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(2..=200))]
    periods: u32,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Write a period of the volts, t_s,volt, to be played to a head
    #[arg(long, value_name = "FILE.csv", conflicts_with = "log")]
    volts: Option<String>,
    /// Write what the simulated head did, as a log
    #[arg(long, value_name = "FILE.csv", conflicts_with = "log")]
    record: Option<String>,
    /// Plot amplification, phase and coherence into an SVG or PNG, or write them to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

fn frequency(text: &str) -> Result<f64, String> {
    const MOST_RAD_S: f64 = 1500.0; // four ticks a period
    let rad_s = above_zero(text, FREQUENCIES)?;
    if rad_s <= MOST_RAD_S {
        Ok(rad_s)
    } else {
        Err(format!("{text} is more than {MOST_RAD_S} rad/s, which a tick a millisecond can carry"))
    }
}

fn speed(text: &str) -> Result<f64, String> {
    let rad_s = tracelight_units::parse(text, ANGULAR_SPEEDS).map_err(|e| e.to_string())?;
    if (0.5..=100.0).contains(&rad_s.abs()) {
        Ok(rad_s)
    } else {
        Err(format!("{text} is not between 0.5 and 100 rad/s, either way"))
    }
}

fn period(text: &str) -> Result<f64, String> {
    let time_s = above_zero(text, TIMES)?;
    if (0.1..=100.0).contains(&time_s) {
        Ok(time_s)
    } else {
        Err(format!("{text} is not between 0.1 and 100 s"))
    }
}

impl LabCommand for FrequencyTrialArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let finding = command::tried(self.request()?, self.voice, stop)?;
        if let Some(path) = &self.volts {
            files::write(path, finding.volts())?;
        }
        if let Some(path) = &self.record {
            files::write(path, finding.record())?;
        }
        self.out.iter().try_for_each(|file| file.write(&finding))?;
        Ok(command::answer(&finding, self.voice))
    }
}

impl FrequencyTrialArgs {
    fn request(&self) -> Result<Request, Failure> {
        Ok(Request {
            joint: self.axis.map_or(Joint::Pan, Axis::joint),
            axis: self.axis.map(Axis::joint),
            columns: self.columns.columns(),
            rig: self.rig.config()?,
            log: self.log.as_deref().map(log).transpose()?,
            from_rad_s: self.from,
            to_rad_s: self.to,
            sines: self.sines,
            amplitude_v: self.amplitude,
            speed_rad_s: self.speed,
            period_s: self.period,
            periods: self.periods,
            seed: self.seed,
        })
    }
}
