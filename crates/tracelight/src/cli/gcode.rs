//! How G-code lights a drawing: the flags of every command that writes some.

use clap::Args;
use tracelight_formats::gcode::GcodeOptions;
use tracelight_units::{self as units, FEEDS};

/// `$30` of a GRBL board, unless it was changed.
const FULL_POWER: f64 = 1000.0;

/// How fast and how bright.
#[derive(Args, Clone, Debug)]
pub(crate) struct GcodeArgs {
    /// Speed of the lit spot in G-code, such as 300mm/min or 50mm/s [default: 1ft/s]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, value_parser = feed)]
    feed: Option<f64>,
    #[command(flatten)]
    power: PowerArgs,
}

/// How bright.
#[derive(Args, Clone, Debug)]
pub(crate) struct PowerArgs {
    /// Power of the laser in G-code: a share, such as 40%, or the S word, such as 400 [default: 100%]
    #[arg(long, value_name = "PERCENT%|S", allow_hyphen_values = true, value_parser = power)]
    power: Option<f64>,
}

impl GcodeArgs {
    /// What they mean, if any was given.
    pub(crate) fn options(&self) -> Option<GcodeOptions> {
        let usual = GcodeOptions::default();
        (self.feed.is_some() || self.power.power.is_some()).then(|| GcodeOptions {
            feed_mm_min: self.feed.unwrap_or(usual.feed_mm_min),
            power: self.power.s_word(),
            ..usual
        })
    }
}

impl PowerArgs {
    /// The S word of full light.
    pub(crate) fn s_word(&self) -> f64 {
        self.power.unwrap_or(FULL_POWER)
    }

    /// Whether one was asked for.
    pub(crate) const fn is_given(&self) -> bool {
        self.power.is_some()
    }
}

/// A speed, mm/min.
fn feed(text: &str) -> Result<f64, String> {
    const LEAST_M_S: f64 = 1e-5;
    const MOST_M_S: f64 = 100.0;
    let speed = units::parse(text, FEEDS).map_err(|e| e.to_string())?;
    match (LEAST_M_S..=MOST_M_S).contains(&speed) {
        true => Ok(speed * 60e3),
        false => Err(format!("{text} is not between {LEAST_M_S} and {MOST_M_S} m/s")),
    }
}

/// An S word: itself, or a share of full power.
fn power(text: &str) -> Result<f64, String> {
    /// `$30` at most, as GRBL takes numbers.
    const MOST: f64 = 1e6;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    let (value, most, unit) = match text.trim().strip_suffix('%') {
        Some(percent) => (number(percent), 100.0, " %"),
        None => (number(text), MOST, ""),
    };
    match value {
        Some(value) if (0.0..=most).contains(&value) => {
            Ok(if unit.is_empty() { value } else { value / 100.0 * FULL_POWER })
        }
        Some(_) => Err(format!("{text} is not between 0 and {most}{unit}")),
        None => {
            Err(format!("{text} is neither a share of the power, such as 40%, nor an S word, such as 400"))
        }
    }
}
