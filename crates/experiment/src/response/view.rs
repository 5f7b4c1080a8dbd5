//! Answers of systems, as they are shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::{Curve, Figure, Key, Mark, Panel, Pen, Sign};
use tracelight_linear::Time;
use tracelight_task::Failure;

use super::{Entry, Finding, Input};
use crate::finding::{self, Plotted};
use crate::numbers::{four, percent, seconds};
use crate::panels::over_time;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for Entry { named, response, info } in &self.entries {
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", named.name, named.system);
            if let Some(info) = info {
                let _ = writeln!(
                    text,
                    "    comes to {}, overshoots by {}, undershoots by {}, rises in {}, is within 2 % {}",
                    if info.final_value.is_nan() { "no value".to_owned() } else { four(info.final_value) },
                    percent(info.overshoot_percent),
                    percent(info.undershoot_percent),
                    seconds(info.rise_s),
                    info.settle_s.map_or("at no time shown".to_owned(), |s| format!("after {} s", four(s)))
                );
            }
            let (most, at_s) = response.peak();
            let last = response.values.last().copied().unwrap_or_default();
            let end_s = response.step_s * (response.values.len().saturating_sub(1)) as f64;
            let _ = writeln!(
                text,
                "    largest {} at {} s, {} at the end of {} s\n",
                four(most),
                four(at_s),
                four(last),
                four(end_s)
            );
        }
        if self.of.input != Input::Step {
            let _ = writeln!(text, "(answers to {})", words(self.of.input));
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |Entry { named, response, info }: &Entry| -> Value {
            let finite = |value: f64| value.is_finite().then_some(value);
            json!({
                "name": named.name,
                "step_s": response.step_s,
                "values": response.values,
                "final": info.and_then(|info| finite(info.final_value)),
                "overshoot_percent": info.and_then(|info| info.overshoot_percent),
                "undershoot_percent": info.and_then(|info| info.undershoot_percent),
                "rise_s": info.and_then(|info| info.rise_s),
                "settle_s": info.and_then(|info| info.settle_s),
                "peak": response.peak().0,
                "peak_s": response.peak().1,
            })
        };
        json!({"systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let curve = |Entry { named, response, .. }: &Entry| {
            let times = (0..).map(|k| f64::from(k) * response.step_s);
            let points: Vec<(f64, f64)> = match named.system.time() {
                Time::Continuous => times.zip(response.values.iter().copied()).collect(),
                // a sample holds until the next
                Time::Sampled(period_s) => {
                    times.zip(&response.values).flat_map(|(t, &y)| [(t, y), (t + period_s, y)]).collect()
                }
            };
            Curve { colour: named.colour, pen: Pen::Solid, points }
        };
        let settled = |Entry { named, response, info }: &Entry| {
            let at_s = info.and_then(|info| info.settle_s)?;
            let value = response.values.get((at_s / response.step_s).round() as usize)?;
            Some(Mark { colour: named.colour, sign: Sign::Dot, at: (at_s, *value) })
        };
        let key = |Entry { named, info, .. }: &Entry| {
            let more = info.and_then(|info| Some((info.overshoot_percent?, info.settle_s?)));
            let more = more.map_or(String::new(), |(over, s)| {
                format!(": {} % over, settled after {} s", four(over), four(s))
            });
            Key { colour: named.colour, name: format!("{}{more}", named.name) }
        };
        let goals = self
            .entries
            .iter()
            .filter_map(|e| e.info)
            .map(|info| info.final_value)
            .filter(|goal| goal.is_finite());
        let mut levels: Vec<f64> = goals.collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * b.abs());
        Ok(Figure {
            title: match self.of.input {
                Input::Step => "Step responses; dots: within 2 % from here on".into(),
                other => format!("Answers to {}", words(other)),
            },
            legend: self.entries.iter().map(key).collect(),
            panels: vec![Panel {
                marks: self.entries.iter().filter_map(settled).collect(),
                ..over_time("output", levels, self.entries.iter().map(curve).collect())
            }],
            columns: 1,
            panel: (820, 420),
            theme: self.of.systems.theme,
        })
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

const fn words(input: Input) -> &'static str {
    match input {
        Input::Step => "a step",
        Input::Impulse => "an impulse",
        Input::Ramp => "a ramp",
    }
}
