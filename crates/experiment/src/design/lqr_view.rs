//! State feedback and its loop, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Figure, Key};
use tracelight_linear::{DistinctRoot, Root, Stability};
use tracelight_task::Failure;

use super::lqr::{Allowed, Finding};
use crate::design::panels::step_panels;
use crate::finding::{self, Plotted};
use crate::margins::{margin_lines, margins_json};
use crate::numbers::{four, percent, seconds};
use crate::system_json::{pairs, stability_name, system_json};
use crate::systems::pole_lines;

impl Finding {
    fn feedback(&self) -> String {
        let term = |(gain, name): (&f64, &String)| format!("{} {name}", four(*gain));
        self.gain.iter().zip(&self.names).map(term).collect::<Vec<_>>().join(" + ").replace("+ −", "− ")
    }
}

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let costs = self.q.iter().zip(&self.names).map(|(q, name)| format!("{} {name}²", four(*q)));
        let mut text = format!(
            "{} = {}\n\nu = {}({})\n    costs least by {} + {} u²\n",
            self.name,
            self.plant,
            self.prefilter.map_or("−".to_owned(), |factor| format!("{} r − ", four(factor))),
            self.feedback(),
            costs.collect::<Vec<_>>().join(" + "),
            four(self.r)
        );
        if self.prefilter.is_none() {
            text += "    integral: of y − r over time\n";
        }
        // writing to a String cannot fail
        let _ = writeln!(
            text,
            "\nthe loop, cut at the input\n{}",
            margin_lines(self.open.delay_margin(&self.margins), &self.margins)
        );
        if let Some(value) = self.info.ending.value() {
            let _ = writeln!(
                text,
                "\na step has final value {}, overshoot {}, rise time {}, settling time (2 %) {}",
                four(value),
                percent(self.info.overshoot_percent),
                seconds(self.info.rise_s),
                seconds(self.info.settle_s)
            );
        }
        if let Some(allowed) = &self.allowed {
            text += &format!("\n{}", allowed.text(&self.names, (&self.q[..], self.prefilter.is_none())));
        }
        let poles = self.poles.iter().map(|&value| DistinctRoot::from(Root { value, radius: 0.0 }));
        let _ = write!(text, "\nclosed\n{}", pole_lines(&poles.collect::<Vec<_>>(), self.time));
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let stable = self.stability == Stability::Stable;
        json!({
            "system": system_json(&self.name, &self.plant),
            "states": self.names,
            "q": self.q,
            "r": self.r,
            "gain": self.gain,
            "prefilter": self.prefilter,
            "margins": margins_json(self.open.delay_margin(&self.margins), &self.margins),
            "closed_poles": pairs(&self.poles),
            "closed_stable": stable,
            "closed_stability": stability_name(self.stability),
            "step": self.info.ending.value().map(|value| json!({
                "final": value,
                "overshoot_percent": self.info.overshoot_percent,
                "rise_s": self.info.rise_s,
                "settle_s": self.info.settle_s,
            })),
            "allowed": self.allowed.as_ref().map(|allowed| json!({
                "most": allowed.most,
                "reached": allowed.reached,
                "nearest_r": allowed.nearest_r,
            })),
        })
        .to_string()
    }
}

impl Allowed {
    /// What is reached beside what is allowed, a line each.
    fn text(&self, names: &[String], (q, integrates): (&[f64], bool)) -> String {
        let first = self.most.iter().position(|most| *most != 0.0).unwrap_or(0);
        let mut text = format!("from rest at {} = {}:\n", names[first], four(self.most[first]));
        let all = names.iter().map(String::as_str).chain(["u"]).zip(self.most.iter().zip(&self.reached));
        for (name, (most, reached)) in all.filter(|(_, (most, _))| **most != 0.0) {
            let beyond = if *reached > most * (1.0 + 1e-9) { ", MORE than allowed" } else { "" };
            let _ =
                writeln!(text, "    {name} is {} at most; allowed {}{beyond}", four(*reached), four(*most));
        }
        if let Some(r) = self.nearest_r {
            let (of_states, of_integral) = q.split_at(q.len() - usize::from(integrates));
            let weights: Vec<String> = of_states.iter().map(|q| four(*q)).collect();
            let integral = of_integral.iter().map(|q| format!(" --integral {}", four(*q)));
            let _ = writeln!(
                text,
                "    the nearest that keeps the input: --q {} --r {}{}",
                weights.join(","),
                four(r),
                integral.collect::<String>()
            );
        }
        text
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(Figure {
            title: format!("{} with its state fed back", self.name),
            legend: vec![Key { colour: Colour::Violet, name: "a step of 1".to_owned() }],
            columns: 1,
            panel: (820, 280),
            panels: step_panels(&self.step, &self.input).into(),
            theme: self.theme,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("t_s,output,input\n");
        for (row, (output, input)) in self.step.values.iter().zip(&self.input.values).enumerate() {
            let _ = writeln!(text, "{:.9e},{output:.9e},{input:.9e}", row as f64 * self.step.step_s);
        }
        Ok(text)
    }
}
