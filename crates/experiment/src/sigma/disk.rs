//! Disk margins of a system as an open loop.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_linear::{DiskMargin, DiskMargins, LinearError, StateSpace, decibels};

use crate::numbers::four;

/// What the system's loop may stand.
pub(super) enum Disk {
    /// So much.
    Margins(DiskMargins),
    /// Nothing: closed it is not stable.
    Unstable,
    /// Not a loop: the system has not as many outputs as inputs.
    NotSquare,
    /// Closed it is not defined.
    Undefined,
}

impl Disk {
    pub(super) fn of(system: &StateSpace) -> Result<Self, LinearError> {
        if system.d().nrows() != system.d().ncols() {
            return Ok(Self::NotSquare);
        }
        match system.disk_margins(0.0) {
            Ok(Some(margins)) => Ok(Self::Margins(margins)),
            Ok(None) => Ok(Self::Unstable),
            Err(LinearError::AlgebraicLoop) => Ok(Self::Undefined),
            Err(e) => Err(e),
        }
    }

    /// Where the margins are, rad/s.
    pub(super) fn rad_s(&self) -> impl Iterator<Item = f64> + '_ {
        let margins = if let Self::Margins(margins) = self { Some(margins) } else { None };
        margins.into_iter().flat_map(|m| m.each.iter().chain([&m.together]).map(|margin| margin.rad_s))
    }

    /// The margins, a line each, and what they promise.
    pub(super) fn lines(&self) -> String {
        let margins = match self {
            Self::Margins(margins) => margins,
            Self::Unstable => {
                return "as an open loop: closed by negative feedback it is not stable, and has no disk margins".to_owned();
            }
            Self::NotSquare => {
                return "disk margins: none, as a loop has as many outputs as inputs; give it with its controller, such as \"P*K\"".to_owned();
            }
            Self::Undefined => {
                return "as an open loop: closed by negative feedback it is not defined, as 1 + L has no inverse at infinite frequency".to_owned();
            }
        };
        let mut text = format!(
            "as an open loop, closed by negative feedback of each output to the input of its number, it is stable\n    \
             {:18} {:>7}  {:>18}  {:>9}  {:>10}\n",
            "disk margin", "α", "gain, dB", "phase, °", "at, rad/s"
        );
        let mut line = |name: String, margin: &DiskMargin| {
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "    {name:18} {:>7}  {:>18}  {:>9}  {:>10}",
                four(margin.alpha),
                gains(margin),
                phases(margin),
                four(margin.rad_s)
            );
        };
        if let [alone] = &margins.each[..] {
            line("the loop".to_owned(), alone);
            return text
                + "it stays stable for every gain in that range, and every phase, also for both together within the disk";
        }
        for (number, margin) in (1..).zip(&margins.each) {
            line(format!("channel {number} alone"), margin);
        }
        line("all at once".to_owned(), &margins.together);
        text + "it stays stable for every gain in that range, and every phase: of that channel, the others as they are, or of all channels at the \
                same time, each in its own way"
    }

    pub(super) fn json(&self) -> Value {
        let Self::Margins(margins) = self else { return Value::Null };
        json!({
            "each": margins.each.iter().map(one_json).collect::<Vec<_>>(),
            "together": one_json(&margins.together),
            "with_cross_talk": one_json(&margins.all),
        })
    }

    /// What the figure says of it.
    pub(super) fn summary(&self) -> String {
        match self {
            Self::Margins(margins) => {
                let margin = &margins.together;
                format!("; disk margin {}: {} dB, {}°", four(margin.alpha), gains(margin), phases(margin))
            }
            _ => String::new(),
        }
    }
}

fn gains(margin: &DiskMargin) -> String {
    /// Factors beyond this are rounding of none at all: margins are known to some ten digits.
    const BOUNDLESS: f64 = 1e9;
    let (low, high) = margin.gain;
    match (low > 1.0 / BOUNDLESS, high < BOUNDLESS) {
        (false, false) => "any".to_owned(),
        (false, true) => format!("up to {}", four(decibels(high))),
        (true, false) => format!("from {} up", four(decibels(low))),
        (true, true) => format!("{} … {}", four(decibels(low)), four(decibels(high))),
    }
}

fn phases(margin: &DiskMargin) -> String {
    if margin.phase_rad.is_finite() {
        format!("±{}", four(margin.phase_rad.to_degrees()))
    } else {
        "any".to_owned()
    }
}

fn one_json(margin: &DiskMargin) -> Value {
    // JSON has no infinity
    let finite = |value: f64| value.is_finite().then_some(value);
    let db = |factor: f64| finite(decibels(factor)).filter(|_| factor > 0.0);
    json!({
        "alpha": margin.alpha,
        "rad_s": finite(margin.rad_s),
        "gain": {"low": margin.gain.0, "high": finite(margin.gain.1)},
        "gain_db": {"low": db(margin.gain.0), "high": db(margin.gain.1)},
        "phase_deg": finite(margin.phase_rad.to_degrees()),
    })
}
