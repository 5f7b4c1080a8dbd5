use clap::Args;
use tracelight_experiment::velocity::Request;
use tracelight_rig::TICK_F64_S;
use tracelight_sim::LONGEST_INTERVAL_TICKS;
use tracelight_task::{Failure, Stop};
use tracelight_units as units;
use tracelight_units::{Speed, TIMES};

use super::command::{self, LabCommand, OutFile, out_file};
use super::shape::ShapeArgs;
use crate::cli::answer::{Answer, Voice};
use crate::cli::driving::positive_speed;

/// Compare the errors of velocity and acceleration estimators from encoder counts, by interval and speed
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab velocity --speeds 0.1ft/s,1ft/s,3ft/s -o velocity.svg\n\n\
                  The head draws the shape once at each speed; its counts, edges and volts are then played to every observer, and \
                  what it says is compared with the truth. The interval is the time over which counts or edges are compared; \
                  washout and tracking-loop have a corner at its reciprocal.")]
pub(crate) struct VelocityArgs {
    #[command(flatten)]
    shape: ShapeArgs,
    /// Speeds of the lit spot
    #[arg(long, value_name = "SPEED,…", value_delimiter = ',', default_value = "0.03ft/s,0.1ft/s,0.3ft/s,1ft/s,3ft/s", value_parser = positive_speed)]
    speeds: Vec<Speed>,
    /// Intervals, whole milliseconds
    #[arg(long, value_name = "TIME,…", value_delimiter = ',', default_value = "1ms,2ms,5ms,10ms,20ms,40ms,64ms", value_parser = interval)]
    intervals: Vec<usize>,
    /// Random seed for the differences between simulated heads
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Plot the errors over interval and speed into an SVG or PNG, or write a row each to a CSV; may be given again
    #[arg(short, long, value_name = "FILE.svg|FILE.png|FILE.csv", value_parser = out_file)]
    out: Vec<OutFile>,
    #[command(flatten)]
    voice: Voice,
}

/// An interval in ticks.
pub(super) fn interval(text: &str) -> Result<usize, String> {
    let time_s = units::parse(text, TIMES).map_err(|e| e.to_string())?;
    let ticks = (time_s / TICK_F64_S).round();
    if (ticks * TICK_F64_S - time_s).abs() < 1e-9 && (1.0..=LONGEST_INTERVAL_TICKS as f64).contains(&ticks) {
        Ok(ticks as usize)
    } else {
        Err(format!("{text} is not a whole number of milliseconds from 1ms to {LONGEST_INTERVAL_TICKS}ms"))
    }
}

impl LabCommand for VelocityArgs {
    fn voice(&self) -> Voice {
        self.voice
    }

    fn run(&self, stop: &Stop) -> Result<Answer, Failure> {
        let request = Request {
            driving: self.shape.driving()?,
            shape: self.shape.shape()?,
            speeds_m_s: self.speeds.iter().map(|speed| speed.0).collect(),
            intervals_ticks: self.intervals.clone(),
            seed: self.seed,
        };
        command::plotted(request, &self.out, self.voice, stop)
    }
}
