//! A root locus, as it is shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Curve, Figure, Key, Mark, Pen, Sign};
use tracelight_task::Failure;

use super::{Entry, Finding, Marked};
use crate::finding::{self, Plotted};
use crate::numbers::four;
use crate::plane::{draw, plane, signs};
use crate::systems::{pairs, place, pole_lines, system_json};

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for Entry { named, gain, .. } in &self.entries {
            let system = &named.system;
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", named.name, system.factored());
            for apart in system.breakaways().iter().filter(|b| b.pole.im >= 0.0) {
                let _ = writeln!(
                    text,
                    "    {} branches meet at {} for a factor of {}",
                    apart.branches,
                    place(apart.pole),
                    four(apart.gain)
                );
            }
            for (factor, rad_s) in system.oscillating_gains().iter().filter(|(_, w)| *w > 0.0) {
                let _ = writeln!(
                    text,
                    "    it oscillates with {} rad/s for a factor of {}",
                    four(*rad_s),
                    four(*factor)
                );
            }
            if let Some(far) = system.asymptotes() {
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
            let why = match self.of.marked {
                Marked::Gain(_) => String::new(),
                Marked::Damping(least) => format!(", the largest that leaves a damping of {least},"),
            };
            let _ = writeln!(text, "    with a factor of {}{why} the closed poles are", four(*gain));
            let _ =
                writeln!(text, "{}", pole_lines(&system.closed_at(*gain).distinct_roots(), system.time()));
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| {
            let system = &entry.named.system;
            let mut object = system_json(&entry.named.name, system);
            object["gain"] = entry.gain.into();
            object["closed_poles"] = pairs(&entry.closed).into_iter().map(|z| json!(z)).collect();
            object["breakaways"] = system
                .breakaways()
                .iter()
                .map(|b| json!({"pole": [b.pole.re, b.pole.im], "gain": b.gain, "branches": b.branches}))
                .collect();
            object["oscillating"] = system
                .oscillating_gains()
                .iter()
                .map(|(gain, w)| json!({"gain": gain, "rad_s": w}))
                .collect();
            object["gains"] = entry.locus.gains.iter().copied().collect();
            object["branches"] = entry.locus.poles.iter().map(|poles| json!(pairs(poles))).collect();
            object
        };
        json!({"systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let mut panel =
            plane(self.entries.iter().map(|e| (&e.named.system, &e.closed[..])), self.of.plane.reach);
        for entry in &self.entries {
            let colour = entry.named.colour;
            let branches = entry.locus.poles.first().map_or(0, Vec::len);
            for branch in 0..branches {
                let points = entry.locus.poles.iter().map(|poles| (poles[branch].re, poles[branch].im));
                panel.curves.push(Curve { colour, pen: Pen::Solid, points: points.collect() });
            }
            panel.marks.extend(signs(&entry.named));
            panel.marks.extend(entry.closed.iter().map(|z| Mark {
                colour,
                sign: Sign::Dot,
                at: (z.re, z.im),
            }));
        }
        let key = |e: &Entry| Key {
            colour: e.named.colour,
            name: format!("{}, dots: gain times {}", e.named.name, four(e.gain)),
        };
        Ok(draw("Root locus", self.entries.iter().map(key).collect(), panel, self.of.plane.systems.theme))
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
