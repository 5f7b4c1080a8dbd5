//! Whoever stands at the wall while the job runs.

use clap::{Args, ValueEnum};
use tracelight_operator::Attending;
use tracelight_pipeline::Frame;
use tracelight_units::{TIMES, parse};

/// Whoever stands at the wall while the job runs.
#[derive(Args, Clone, Debug, Default)]
pub struct ByHandArgs {
    /// Run the simulated rig in real time, or FACTOR times as fast, from 0.25 to 8. In a terminal keys pause, stop and change the speed; ? lists
    /// them
    #[arg(long, value_name = "FACTOR", num_args = 0..=1, default_missing_value = "1", value_parser = factor,
          allow_hyphen_values = true)]
    pub real_time: Option<f64>,
    /// First show where the drawing will be: by the box round it, its hull, or the box's corners, again and again until Space or Enter; in real time
    #[arg(long, value_enum, value_name = "box|hull|corners")]
    pub frame: Option<FrameName>,
    /// With --step and --points: go on to the next by itself after this long on one, such as 5s, without a key; without --real-time as fast as the
    /// simulation runs
    #[arg(long, value_name = "TIME", value_parser = each, allow_hyphen_values = true)]
    pub each: Option<f64>,
    /// Print one JSON object per line while the job runs: states, strokes, faults, progress
    #[arg(long, conflicts_with = "json")]
    pub events: bool,
}

impl ByHandArgs {
    /// How somebody attends a job that goes stroke by stroke or not, of a rig that may keep time by itself.
    pub fn attending(&self, steps: bool, keeps_time: bool) -> Attending {
        let waits = steps && self.each.is_none() || self.frame.is_some();
        Attending {
            real_time: self.real_time.or(waits.then_some(1.0)),
            keeps_time,
            arms: false,
            each_s: self.each,
            framing: self.frame.is_some(),
            steps,
            events: self.events,
        }
    }
}

/// Frames of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FrameName {
    /// The upright rectangle that just holds it
    Box,
    /// The shortest line round it
    Hull,
    /// The corners of that rectangle
    Corners,
}

impl FrameName {
    /// What it means.
    pub const fn frame(self) -> Frame {
        match self {
            Self::Box => Frame::Box,
            Self::Hull => Frame::Hull,
            Self::Corners => Frame::Corners,
        }
    }
}

/// A time on one stroke or point, s.
pub fn each(text: &str) -> Result<f64, String> {
    time_up_to(text, 300.0)
}

/// How long a server is there, s: a day at most.
///
/// # Errors
/// What is none, in words.
pub fn served(text: &str) -> Result<f64, String> {
    time_up_to(text, 86_400.0)
}

fn time_up_to(text: &str, most_s: f64) -> Result<f64, String> {
    const LEAST_S: f64 = 0.1;
    let time_s = parse(text, TIMES).map_err(|e| e.to_string())?;
    let is_one = (LEAST_S..=most_s).contains(&time_s);
    is_one.then_some(time_s).ok_or_else(|| format!("{text} is not between {LEAST_S} s and {most_s} s"))
}

/// How many times as fast as real time, from 0.25 to 8.
///
/// # Errors
/// What is none, in words.
pub fn factor(text: &str) -> Result<f64, String> {
    const RANGE: std::ops::RangeInclusive<f64> = 0.25..=8.0;
    let factor = text.parse().map_err(|_| format!("{text} is not a number; give one such as 2"))?;
    if RANGE.contains(&factor) {
        Ok(factor)
    } else {
        Err(format!("{text} is not between {} and {}; 1 is real time", RANGE.start(), RANGE.end()))
    }
}
