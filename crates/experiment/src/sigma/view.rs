//! Singular values and norms, as they are shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_linear::{Complex, Hidden, Time, decibels};

use super::Finding;
use crate::finding;
use crate::numbers::four;
use crate::system_json::pairs;
use crate::systems::{place, pole_lines};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = format!(
            "{} has {}, {} and {}\n{}",
            self.name,
            count(self.system.d().ncols(), "input"),
            count(self.system.d().nrows(), "output"),
            count(self.system.order(), "state"),
            self.note
        );
        // writing to a String cannot fail
        let _ = writeln!(text, "    H∞ norm         {}", self.peak_words());
        let _ = writeln!(text, "    H2 norm         {}", self.h2_words());
        let _ = writeln!(text, "    zeros           {}", zeros_words(&self.zeros));
        let _ = writeln!(text, "    {}", self.minimal_words());
        if !self.poles.is_empty() {
            let _ = writeln!(text, "{}", pole_lines(&self.poles, self.system.time()));
        }
        text += &self.disk.lines();
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let poles: Vec<Complex> =
            self.poles.iter().flat_map(|pole| std::iter::repeat_n(pole.value, pole.count)).collect();
        json!({
            "name": self.name,
            "period_s": match self.system.time() {
                Time::Continuous => None,
                Time::Sampled(period_s) => Some(period_s),
            },
            "inputs": self.system.d().ncols(),
            "outputs": self.system.d().nrows(),
            "states": self.system.order(),
            "h_infinity": self.peak.map(|peak| json!({
                "factor": peak.gain,
                "db": decibels(peak.gain),
                "rad_s": peak.rad_s.is_finite().then_some(peak.rad_s),
            })),
            "h2": self.h2,
            "poles": pairs(&poles),
            "zeros": pairs(&self.zeros),
            "minimal": self.minimal == self.system.order(),
            "minimal_states": self.minimal,
            "uncontrollable": hidden_json(&self.unmoved),
            "unobservable": hidden_json(&self.unseen),
            "disk_margins": self.disk.json(),
            "rad_s": self.rad_s,
            "singular_values_db": self.values_db,
        })
        .to_string()
    }
}

impl Finding {
    fn peak_words(&self) -> String {
        match self.peak {
            None => "none: it is not stable".to_owned(),
            Some(peak) if peak.gain == 0.0 => "0".to_owned(),
            Some(peak) => format!(
                "{} dB (factor {}) at {} rad/s",
                four(decibels(peak.gain)),
                four(peak.gain),
                four(peak.rad_s)
            ),
        }
    }

    fn h2_words(&self) -> String {
        match (self.h2, self.peak) {
            (Some(norm), _) => four(norm),
            (None, None) => "none: it is not stable".to_owned(),
            (None, Some(_)) => "none: D lets an impulse straight through".to_owned(),
        }
    }

    fn minimal_words(&self) -> String {
        let order = self.system.order();
        if self.minimal == order {
            return "its realization is minimal: every state is controllable and observable".to_owned();
        }
        let mut text = format!("its realization is not minimal: {} would do", count(self.minimal, "state"));
        for (hidden, what) in [(&self.unmoved, "uncontrollable"), (&self.unseen, "unobservable")] {
            if !hidden.poles.is_empty() {
                text += &format!("\n    {what:15} {}", hidden_words(hidden));
            }
        }
        text
    }
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn zeros_words(zeros: &[Complex]) -> String {
    // the other of a pair is said by ±
    let shown: Vec<String> = zeros.iter().filter(|z| z.im >= 0.0).map(|z| place(*z)).collect();
    if shown.is_empty() { "none".to_owned() } else { shown.join(", ") }
}

/// Which states, and their poles.
fn hidden_words(hidden: &Hidden) -> String {
    let Hidden { poles, states } = hidden;
    let names: Vec<String> = states.iter().map(|i| format!("x{}", i + 1)).collect();
    let names = names.join(", ");
    let what = match states.len() > poles.len() {
        true if poles.len() == 1 => format!("a combination of {names}"),
        true => format!("{} combinations of {names}", poles.len()),
        false => names,
    };
    let shown: Vec<String> = poles.iter().filter(|z| z.im >= 0.0).map(|z| place(*z)).collect();
    format!("{what}; {} {}", if poles.len() == 1 { "pole" } else { "poles" }, shown.join(", "))
}

fn hidden_json(hidden: &Hidden) -> Value {
    json!({
        "states": hidden.states.iter().map(|i| i + 1).collect::<Vec<_>>(),
        "poles": pairs(&hidden.poles),
    })
}
