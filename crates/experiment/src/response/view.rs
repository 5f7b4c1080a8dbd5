//! Answers of systems, as they are shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::Figure;
use tracelight_linear::{Complex, Ending, Extreme, Stability};
use tracelight_task::Failure;

use super::{Enters, Entry, Finding, Input, Request};
use crate::finding::{self, Plotted};
use crate::named::Named;
use crate::numbers::{four, percent};
use crate::steady::{error_lines, errors_json};
use crate::system_json::pairs;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", entry.named.name, entry.named.text());
            text += &entry.lines(self.of.input);
            if let Some(open) = entry.tracking(&self.of) {
                text += &error_lines(open);
            }
            text += "\n";
        }
        if self.of.input != Input::Step {
            let _ = writeln!(text, "(answers to {})", words(self.of.input));
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| -> Value {
            let Entry { named, response, ending, peak, info, impulse, hidden, .. } = entry;
            let open = entry.tracking(&self.of);
            json!({
                "name": named.name,
                "step_s": response.step_s,
                "values": response.values,
                "ending": ending.map(ending_name),
                "final": ending.and_then(Ending::value),
                "overshoot_percent": info.and_then(|info| info.overshoot_percent),
                "undershoot_percent": info.and_then(|info| info.undershoot_percent),
                "rise_s": info.and_then(|info| info.rise_s),
                "rise_from_s": info.and_then(|info| info.rise_from_s),
                "settle_s": info.and_then(|info| info.settle_s),
                "peak": peak.map(|peak| peak.value),
                "peak_s": peak.and_then(|peak| peak.time_s),
                "impulse": impulse,
                "hidden_poles": pairs(hidden),
                "error_constants": open.map_or(Value::Null, errors_json),
            })
        };
        json!({"systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(self.plot())
    }

    /// A time and a value for each, since samples have their own times.
    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::new();
        for number in 1..=self.entries.len() {
            let comma = if number > 1 { "," } else { "" };
            let _ = write!(text, "{comma}t_s_{number},output_{number}");
        }
        let rows = self.entries.iter().map(|e| e.response.values.len()).max().unwrap_or(0);
        for row in 0..rows {
            text += "\n";
            for (i, Entry { response, .. }) in self.entries.iter().enumerate() {
                let comma = if i > 0 { "," } else { "" };
                let _ = match response.values.get(row) {
                    Some(value) => write!(text, "{comma}{:.9e},{value:.9e}", row as f64 * response.step_s),
                    None => write!(text, "{comma},"),
                };
            }
        }
        Ok(text + "\n")
    }
}

impl Entry {
    /// The open loop whose errors are told: of a loop that negative feedback closes, and that follows its setpoint.
    fn tracking(&self, of: &Request) -> Option<&Named> {
        let open = self.named.opened.as_deref()?;
        let is_asked = of.enters == Enters::Setpoint && of.input != Input::Impulse;
        (is_asked && !open.is_positive).then_some(open)
    }

    /// What there is to say of it.
    fn lines(&self, input: Input) -> String {
        let mut text = format!("    {}\n", self.ending_line(input));
        if let Some(info) = self.info.filter(|info| info.ending.value().is_some()) {
            let settled = |s: f64| format!(", settling time (2 %) {} s", four(s));
            // writing to a String cannot fail
            let _ = match info.rise_s {
                Some(rise_s) => writeln!(
                    text,
                    "    overshoot {}, undershoot {}, rise time (10–90 %) {} s{}",
                    percent(info.overshoot_percent),
                    percent(info.undershoot_percent),
                    four(rise_s),
                    info.settle_s.map_or(String::new(), settled)
                ),
                None => writeln!(text, "    a final value of 0 has no overshoot, rise or settling time"),
            };
        }
        if let Some(Extreme { value, time_s: Some(at_s) }) = self.peak {
            text += &format!("    peak {} at {} s\n", four(value), four(at_s));
        }
        if self.impulse != 0.0 {
            text += &format!(
                "    an impulse of area {} at time 0 goes straight through; it is not drawn\n",
                four(self.impulse)
            );
        }
        for pole in self.hidden.iter().filter(|pole| pole.im >= 0.0) {
            text += &format!(
                "    note: a zero cancels the pole {}; that mode is in the system, but not in this output\n",
                complex(*pole)
            );
        }
        text
    }

    fn ending_line(&self, input: Input) -> String {
        match (self.ending, self.response.values.last()) {
            (Some(Ending::Converges(value)), _) => format!("final value {}", four(value)),
            (Some(Ending::Diverges), _)
                if input == Input::Ramp && self.named.stability() == Stability::Stable =>
            {
                "grows without bounds, as the ramp does: no final value".to_owned()
            }
            (Some(Ending::Diverges), _) => "grows without bounds: no final value".to_owned(),
            (Some(Ending::Oscillates { about, by }), _) => {
                format!("oscillates for ever about {}, by {} at most: no final value", four(about), four(by))
            }
            (Some(Ending::Undecided), _) => {
                "a pole is nearer to the edge of stability than rounding lets tell: no final value".to_owned()
            }
            (None, last) => {
                format!("{} at the end of what is shown", four(last.copied().unwrap_or_default()))
            }
        }
    }
}

/// A place in the complex plane.
fn complex(place: Complex) -> String {
    let name = if place.im == 0.0 { String::new() } else { format!(" ± {}j", four(place.im.abs())) };
    format!("at {}{name}", four(place.re))
}

const fn ending_name(ending: Ending) -> &'static str {
    match ending {
        Ending::Converges(_) => "converges",
        Ending::Diverges => "diverges",
        Ending::Oscillates { .. } => "oscillates",
        Ending::Undecided => "undecided",
    }
}

pub(super) const fn words(input: Input) -> &'static str {
    match input {
        Input::Step => "a step",
        Input::Impulse => "an impulse",
        Input::Ramp => "a ramp",
    }
}
