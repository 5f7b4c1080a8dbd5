use clap::{ArgAction, Args};
use tracelight_experiment::by_hand::{ByHand, Gains};
use tracelight_rigfile::{FEEDFORWARDS, HIGHEST_GAIN};
use tracelight_sim::Feedforward;

use super::shape::switch;
use super::velocity::interval;

/// A PID that is set on the command line.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Law hand-tuned")]
pub(super) struct ByHandArgs {
    /// Gains: kp, N m/rad; ki, N m/(rad s); kd, N m s/rad; b and c, the shares of the setpoint and of its speed that kp and kd see
    /// [default: the rig's, and c=1, b=1, ki=0 or kd=0 for what is not named]
    #[arg(long, value_name = "kp=20,ki=0,kd=1", value_parser = gains)]
    gains: Option<Gains>,
    /// Whether the integral waits while the amplifier is at its limit
    #[arg(long, value_name = "on|off", value_parser = switch, action = ArgAction::Set)]
    anti_windup: Option<bool>,
    /// What the model adds
    #[arg(long, value_name = "none|gravity|model", value_parser = feedforward)]
    feedforward: Option<Feedforward>,
    /// How long an observer looks back that has such a time
    #[arg(long, value_name = "TIME", value_parser = interval)]
    interval: Option<usize>,
}

fn gains(text: &str) -> Result<Gains, String> {
    let mut gains = Gains { kp: f64::NAN, ki: 0.0, kd: 0.0, b: 1.0, c: 1.0 };
    for (name, value) in settings(text)? {
        let (field, most) = match name {
            "kp" => (&mut gains.kp, HIGHEST_GAIN),
            "ki" => (&mut gains.ki, HIGHEST_GAIN),
            "kd" => (&mut gains.kd, HIGHEST_GAIN),
            "b" => (&mut gains.b, 1.0),
            "c" => (&mut gains.c, 1.0),
            _ => return Err(format!("{name} is none of kp, ki, kd, b, c")),
        };
        *field = number(name, value, 0.0, most)?;
    }
    if gains.kp.is_nan() { Err("kp is missing: --gains kp=20,kd=1".into()) } else { Ok(gains) }
}

/// Names and what is said of each: `kp=20,kd=1`.
pub(super) fn settings(text: &str) -> Result<Vec<(&str, &str)>, String> {
    let mut pairs: Vec<(&str, &str)> = Vec::new();
    for part in text.split(',') {
        let (name, value) = part.split_once('=').ok_or_else(|| format!("{part} is no name=value"))?;
        let (name, value) = (name.trim(), value.trim());
        if pairs.iter().any(|(known, _)| *known == name) {
            return Err(format!("{name} is given twice"));
        }
        pairs.push((name, value));
    }
    Ok(pairs)
}

/// A pure number within bounds.
pub(super) fn number(name: &str, value: &str, least: f64, most: f64) -> Result<f64, String> {
    let number: f64 = value.parse().map_err(|_| format!("{name}: {value} is no number"))?;
    if (least..=most).contains(&number) {
        Ok(number)
    } else {
        Err(format!("{name}: {value} is not between {least} and {most}"))
    }
}

fn feedforward(text: &str) -> Result<Feedforward, String> {
    let known = FEEDFORWARDS.iter().find(|(name, _)| *name == text);
    known
        .map(|(_, is)| *is)
        .ok_or_else(|| format!("{text} is none of {}", FEEDFORWARDS.map(|(name, _)| name).join(", ")))
}

impl ByHandArgs {
    pub(super) const fn by_hand(&self) -> ByHand {
        ByHand {
            gains: self.gains,
            anti_windup: self.anti_windup,
            feedforward: self.feedforward,
            interval_ticks: self.interval,
        }
    }
}
