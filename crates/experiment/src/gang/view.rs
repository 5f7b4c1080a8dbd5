//! The gang of four, as it is shown.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::Figure;
use tracelight_linear::{LoopMember, Norm, Stability};
use tracelight_task::Failure;

use super::{Entry, Finding, Highest, Member};
use crate::finding::{self, Plotted};
use crate::margins::{counted_lines, margin_lines, margins_json};
use crate::steady::{norm_json, norm_words, peak_json, peak_words};
use crate::system_json::stability_name;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let texts: Vec<String> = self.loops.iter().map(Entry::lines).collect();
        texts.join("\n").trim_end().to_owned()
    }

    fn json(&self) -> String {
        let rad_s =
            self.loops.iter().flat_map(|entry| &entry.members).map(|member| &member.response.rad_s).next();
        json!({"rad_s": rad_s, "loops": self.loops.iter().map(Entry::json).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(self.plot())
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("rad_s,hz");
        let columns: Vec<(String, Vec<f64>)> = (1..)
            .zip(&self.loops)
            .flat_map(|(number, entry)| {
                entry.members.iter().map(move |member| {
                    let name = short(member.which).to_lowercase();
                    (format!("{name}_db_{number}"), member.response.magnitudes_db().collect())
                })
            })
            .collect();
        for (name, _) in &columns {
            // writing to a String cannot fail
            let _ = write!(text, ",{name}");
        }
        let members = self.loops.iter().flat_map(|entry| &entry.members);
        let rad_s = members.map(|member| member.response.rad_s.as_slice()).next().unwrap_or_default();
        for (row, w) in rad_s.iter().enumerate() {
            let _ = write!(text, "\n{w:.9e},{:.9e}", w / TAU);
            for (_, values) in &columns {
                let _ = match values[row].is_finite() {
                    true => write!(text, ",{:.6}", values[row]),
                    false => write!(text, ","),
                };
            }
        }
        Ok(text + "\n")
    }
}

impl Entry {
    fn lines(&self) -> String {
        let [plant, controller] = &self.parts;
        let mut text = format!("{}\n    P = {plant}\n    C = {controller}\n", self.name);
        let margins = self.open.margins();
        if self.open.data.is_some() {
            text += &counted_lines(&self.open);
        } else {
            text += self.stability_line();
        }
        if !self.has_norms() {
            text += &margin_lines(self.open.delay_margin(&margins), &margins);
            text += "\n";
            return text;
        }
        for member in &self.members {
            // writing to a String cannot fail
            let _ = writeln!(text, "    {:15} {}", told(member.which), member.words());
        }
        text
    }

    /// Whether its peaks are told: not those of a loop that is known not to be stable.
    fn has_norms(&self) -> bool {
        self.members.iter().any(|member| {
            !matches!(member.peak, Highest::Unstable | Highest::Norm(Norm::Unstable | Norm::Edge))
        })
    }

    /// What the figures of the members are.
    fn stability_line(&self) -> &'static str {
        match self.open.closed_stability() {
            Some(Stability::Stable) => "    the closed loop is stable: each peak is an H∞ norm\n",
            Some(Stability::Marginal) => {
                "    the closed loop is at the edge of stability, or nearer to it than rounding lets tell: there is no finite H∞ norm\n"
            }
            Some(Stability::Growing) => "    the closed loop is not stable: there is no H∞ norm\n",
            None => "    the closed loop is not defined: 1 + PC is zero at infinite frequency\n",
        }
    }

    fn json(&self) -> Value {
        let margins = self.open.margins();
        let closed = self.open.closed_stability();
        let members: serde_json::Map<String, Value> = self
            .members
            .iter()
            .map(|member| (short(member.which).to_lowercase(), member.json(self.has_norms())))
            .collect();
        json!({
            "name": self.name,
            "closed_stable": closed.map(|closed| closed == Stability::Stable),
            "closed_stability": closed.map(stability_name),
            "margins": margins_json(self.open.delay_margin(&margins), &margins),
            "members": members,
        })
    }
}

impl Member {
    /// Its peak, in words.
    fn words(&self) -> String {
        match self.peak {
            Highest::Norm(norm) => norm_words(norm),
            Highest::Data(data) if data.is_at_end => {
                format!("{}: where the data end, it may be larger beyond", peak_words(data.peak))
            }
            Highest::Data(data) => format!("{}, inside the data", peak_words(data.peak)),
            Highest::Unstable => "none: the loop is not stable".to_owned(),
        }
    }

    fn json(&self, is_told: bool) -> Value {
        let peak = match self.peak {
            Highest::Norm(norm) => norm_json(norm),
            Highest::Data(data) if is_told => {
                let mut peak = peak_json(data.peak);
                peak["at_end_of_data"] = data.is_at_end.into();
                peak
            }
            Highest::Data(_) | Highest::Unstable => json!({"h_infinity": null, "none": "unstable"}),
        };
        let magnitudes: Vec<Option<f64>> =
            self.response.magnitudes_db().map(|db| db.is_finite().then_some(db)).collect();
        json!({"peak": peak, "magnitude_db": magnitudes})
    }
}

pub(super) const fn short(member: LoopMember) -> &'static str {
    match member {
        LoopMember::Sensitivity => "S",
        LoopMember::Complementary => "T",
        LoopMember::Load => "PS",
        LoopMember::Control => "CS",
    }
}

/// What is told of a member, with the name of its peak.
const fn told(member: LoopMember) -> &'static str {
    match member {
        LoopMember::Sensitivity => "S, peak Ms",
        LoopMember::Complementary => "T, peak Mt",
        LoopMember::Load => "PS",
        LoopMember::Control => "CS",
    }
}
