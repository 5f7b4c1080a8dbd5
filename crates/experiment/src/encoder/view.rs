//! Encoders, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Colour, Figure, Key, Mark, Panel, Sign, Theme};
use tracelight_lab::{EncoderTable, Lost};
use tracelight_task::{Failure, counted};

use super::{Finding, Found};
use crate::finding::{self, Filed, svg};
use crate::numbers::{HOW_SURE, lines, rounded};
use crate::parts::by_joint;
use crate::table::names;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = if self.of.logs.is_empty() {
            let stamps = if self.of.rig.model.encoder.edge_stamps { "" } else { ", edges not stamped" };
            format!(
                "rig {}, in a fixture, {} each way at about {} rad/s{stamps}",
                self.of.rig.name,
                counted(self.of.turns as usize, "turn"),
                self.of.speed_rad_s
            )
        } else {
            format!("{}, on rig {}", names(&self.of.logs), self.of.rig.name)
        };
        text += &lines(&self.said);
        for Found { joint, told: table, .. } in &self.joints {
            // writing to a String cannot fail
            let _ = write!(text, "\n\n{:44} {:>18}", joint.name(), "found, counts");
            for (kind, edge) in table.kinds_counts.iter().enumerate() {
                let what = format!("edges below counts {kind}, {}, {} … lie beyond", kind + 4, kind + 8);
                let _ = write!(
                    text,
                    "\n{what:44} {:>18}",
                    format!("{} ± {:.4}", rounded(edge.value, 4), edge.within)
                );
            }
            match table.eccentricity {
                Some((amplitude, at_rad)) => {
                    let cell = format!("{:.4} ± {:.4}", amplitude.value, amplitude.within);
                    let what = format!("disc beside its axis: most at {:.0}°", at_rad.to_degrees());
                    let _ = write!(text, "\n{what:44} {cell:>18}");
                }
                None => {
                    text += "\nthe joint did not turn evenly for two turns one way: nothing is known of a disc beside its axis"
                }
            }
            let _ =
                write!(text, "\n{} edges, {:.4} counts rms beside this. ", table.edges, table.left_counts);
            text += &lost(table);
        }
        text + HOW_SURE
    }

    fn json(&self) -> String {
        let one = |Found { joint, told: table, .. }: &Found| {
            let lost = |lost: &Lost| json!({"t_s": lost.time_s, "count": lost.count, "counts": lost.counts});
            let mut object = json!({
                "edges": table.edges,
                "kinds_counts": table.kinds_counts.map(|u| u.value),
                "eccentricity_counts": table.eccentricity.map(|(u, _)| u.value),
                "eccentricity_at_rad": table.eccentricity.map(|(_, at)| at),
                "lost": table.lost.iter().map(lost).collect::<Vec<_>>(),
                "left_counts": table.left_counts,
                "within": {
                    "kinds_counts": table.kinds_counts.map(|u| u.within),
                    "eccentricity_counts": table.eccentricity.map(|(u, _)| u.within),
                },
            });
            if !self.said.is_empty() {
                object["read_as"] = self.said.clone().into();
            }
            (*joint, object)
        };
        by_joint(self.joints.iter().map(one))
    }
}

impl Filed for Finding {
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        let mut files = vec![("encoder.svg", svg(&self.figure())?)];
        if self.of.logs.is_empty() {
            files.push(("edges.csv", self.csv()));
        }
        Ok(files)
    }
}

fn lost(table: &EncoderTable) -> String {
    const SHOWN: usize = 5;
    if table.lost.is_empty() {
        return "No count was lost on the way.".into();
    }
    let one = |lost: &Lost| {
        let (size, what) = (lost.counts.abs(), if lost.counts > 0 { "lost" } else { "too many" });
        format!("{size} {what} at {:.3} s (count {})", lost.time_s, lost.count)
    };
    let shown: Vec<String> = table.lost.iter().take(SHOWN).map(one).collect();
    let more = table.lost.len().saturating_sub(SHOWN);
    let more = if more > 0 { format!(", and {more} times more") } else { String::new() };
    format!("Counts: {}{more}.", shown.join("; "))
}

impl Finding {
    fn csv(&self) -> String {
        let mut text = String::from("axis,time_s,count\n");
        for Found { joint, seen: runs, .. } in &self.joints {
            for run in runs {
                let up = run.first().zip(run.last()).is_some_and(|(first, last)| last.edge >= first.edge);
                for edge in run {
                    let count = if up { edge.edge } else { edge.edge.wrapping_sub(1) };
                    let _ = writeln!(text, "{joint},{:.8},{count}", edge.time_s);
                }
            }
        }
        text
    }

    /// What each kind lies beyond its place.
    fn figure(&self) -> Figure {
        let panel = |Found { joint, told: table, .. }: &Found| {
            let marks = table.kinds_counts.iter().enumerate().flat_map(|(kind, edge)| {
                let at = |value: f64, sign| Mark { colour: Colour::Violet, sign, at: (kind as f64, value) };
                [
                    at(edge.value, Sign::Dot),
                    at(edge.value - edge.within, Sign::Cross),
                    at(edge.value + edge.within, Sign::Cross),
                ]
            });
            let widest = table.kinds_counts.iter().map(|k| k.value.abs() + k.within).fold(0.02, f64::max);
            Panel {
                x_title: format!("{joint}: count below which the edge lies, mod 4"),
                y_title: "beyond its place, counts".into(),
                marks: marks.collect(),
                levels: vec![0.0],
                view: Some([(-0.5, 3.5), (-1.2 * widest, 1.2 * widest)]),
                ..Panel::default()
            }
        };
        Figure {
            title: format!("Encoder edges of rig {}", self.of.rig.name),
            legend: vec![Key::new(Colour::Violet, "found (crosses: 95 of 100 cases)")],
            panels: self.joints.iter().map(panel).collect(),
            columns: self.joints.len(),
            panel: (520, 340),
            theme: Theme::Light,
        }
    }
}
