//! A root locus, as it is shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::Figure;
use tracelight_task::Failure;

use super::{Chosen, Entry, Finding, Marked};
use crate::finding::{self, Plotted};
use crate::numbers::four;
use crate::system_json::pairs;
use crate::systems::{place, pole_lines};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", entry.named.name, entry.named.system.factored());
            text += &entry.named.approximated();
            text += &entry.course();
            match &entry.chosen {
                Chosen::Gain(gain, _) => {
                    let why = match self.of.marked {
                        Marked::Gain(_) => String::new(),
                        Marked::Damping(least) => format!(", the largest that leaves a damping of {least},"),
                    };
                    let _ = writeln!(text, "    with a factor of {}{why} the closed poles are", four(*gain));
                    let closed = entry.named.system.closed_at(*gain).distinct_roots();
                    let _ = writeln!(text, "{}", pole_lines(&closed, entry.named.system.time()));
                }
                Chosen::None(why) => {
                    let _ = writeln!(text, "    {why}\n");
                }
            }
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| {
            let mut object = entry.named.approximated_json();
            let (gain, closed) = match &entry.chosen {
                Chosen::Gain(gain, closed) => (Some(*gain), &closed[..]),
                Chosen::None(_) => (None, &[][..]),
            };
            object["gain"] = gain.into();
            object["closed_poles"] = pairs(closed).into_iter().map(|z| json!(z)).collect();
            object["breakaways"] = entry
                .breakaways
                .iter()
                .map(|b| json!({"pole": [b.pole.re, b.pole.im], "gain": b.gain, "branches": b.branches}))
                .collect();
            object["oscillating"] = entry
                .crossings
                .iter()
                .map(|c| json!({"gain": c.gain, "rad_s": c.rad_s, "leaves": c.leaves}))
                .collect();
            object["gains"] = entry.locus.gains.iter().copied().collect();
            object["branches"] = entry.locus.poles.iter().map(|poles| json!(pairs(poles))).collect();
            object
        };
        json!({"systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Entry {
    /// Where branches meet, pass the edge of stability and go.
    fn course(&self) -> String {
        let mut text = String::new();
        for apart in self.breakaways.iter().filter(|b| b.pole.im >= 0.0) {
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "    {} branches meet at {} for a factor of {}",
                apart.branches,
                place(apart.pole),
                four(apart.gain)
            );
        }
        for crossing in &self.crossings {
            let what = if crossing.leaves { "becomes unstable" } else { "becomes stable" };
            let _ = match crossing.rad_s {
                0.0 => {
                    writeln!(text, "    a branch {what} at 0 rad/s for a factor of {}", four(crossing.gain))
                }
                w => writeln!(
                    text,
                    "    it oscillates with {} rad/s for a factor of {}: a branch {what}",
                    four(w),
                    four(crossing.gain)
                ),
            };
        }
        if let Some(far) = self.named.system.asymptotes() {
            let angles: Vec<String> =
                far.angles_rad.iter().map(|a| format!("{}°", four(a.to_degrees()))).collect();
            let _ = writeln!(
                text,
                "    {} branches go far away from {} at {}",
                angles.len(),
                four(far.centre),
                angles.join(", ")
            );
        }
        text
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(self.plot())
    }

    fn csv(&self) -> Result<String, Failure> {
        let Some(Entry { locus, .. }) = self.entries.first() else { return Ok(String::new()) };
        let mut text = String::from("gain");
        for number in 1..=locus.poles.first().map_or(0, Vec::len) {
            let _ = write!(text, ",re_{number},im_{number}");
        }
        for (gain, poles) in locus.gains.iter().zip(&locus.poles) {
            let _ = write!(text, "\n{gain:.9e}");
            for pole in poles {
                // no number where a branch is infinitely far away
                let _ = match pole.re.is_finite() {
                    true => write!(text, ",{:.9e},{:.9e}", pole.re, pole.im),
                    false => write!(text, ",,"),
                };
            }
        }
        Ok(text + "\n")
    }
}
