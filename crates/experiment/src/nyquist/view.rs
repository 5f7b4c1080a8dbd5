//! Nyquist's plot and Nichols's chart, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::Figure;
use tracelight_linear::{InfiniteArc, NyquistPart};
use tracelight_task::Failure;

use super::{Chart, Entry, Finding};
use crate::finding::{self, Plotted};
use crate::margins::{counted_lines, margin_lines, margins_json};
use crate::numbers::four;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            let (named, open) = (&entry.named, entry.open());
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", named.name, named.text());
            if entry.is_closed() {
                let _ = writeln!(
                    text,
                    "    the curve is the closed loop's; the margins are those of the loop it closes, {}",
                    open.name
                );
            }
            let _ = writeln!(text, "{}", margin_lines(open.delay_margin(&entry.margins), &entry.margins));
            if !entry.is_closed() {
                text += &entry.course();
            }
            if entry.margins.modulus.is_some_and(|margin| margin.distance <= THROUGH) {
                let _ = writeln!(text, "    it goes through −1: closed it is at the edge of stability");
            }
            text += &entry.growing();
            text += "\n";
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| {
            let mut object = entry.named.json();
            object["margins"] = margins_json(entry.open().delay_margin(&entry.margins), &entry.margins);
            // how many a measured loop has is known if it was said
            let is_known = entry.open().data.is_none() || entry.open().unstable.is_some();
            object["open_unstable"] = is_known.then_some(entry.open_unstable).into();
            object["closed_unstable"] = entry.closed_unstable.into();
            object["real_crossings"] =
                entry.crossings.iter().map(|c| json!({"rad_s": c.rad_s, "value": c.value})).collect();
            object["arcs"] = entry
                .curve(entry.level())
                .parts
                .iter()
                .filter_map(|part| match part {
                    NyquistPart::Arc(arc) => Some(json!({
                        // JSON has no infinity
                        "rad_s": arc.rad_s.is_finite().then_some(arc.rad_s),
                        "order": arc.order,
                        "turns_clockwise": 0.5 * arc.order as f64,
                    })),
                    NyquistPart::Finite { .. } => None,
                })
                .collect();
            object["values"] = entry.values.iter().map(|z| json!([z.re, z.im])).collect();
            object
        };
        let rad_s = self.entries.first().map(|entry| &entry.rad_s);
        json!({"rad_s": rad_s, "systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        Ok(match self.chart {
            Chart::Nyquist => self.nyquist(),
            Chart::Nichols => self.nichols(),
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("rad_s");
        for number in 1..=self.entries.len() {
            let _ = write!(text, ",re_{number},im_{number}");
        }
        let rad_s = self.entries.first().map(|entry| entry.rad_s.as_slice()).unwrap_or_default();
        for (row, w) in rad_s.iter().enumerate() {
            let _ = write!(text, "\n{w:.9e}");
            for entry in &self.entries {
                let _ = write!(text, ",{:.9e},{:.9e}", entry.values[row].re, entry.values[row].im);
            }
        }
        Ok(text + "\n")
    }
}

/// Nearer to −1 than this it goes through it, as far as rounding lets tell.
const THROUGH: f64 = 1e-9;

impl Entry {
    /// How many poles grow, and how often the curve turns round −1, a line.
    fn growing(&self) -> String {
        let (open, growing) = (self.open(), self.open_unstable);
        if open.data.is_some() && open.unstable.is_none() {
            return "    how many poles grow, measured data do not tell: if none of the open loop does, the closed loop is stable where the curve \
                    does not turn round −1; --unstable says how many do\n"
                .to_owned();
        }
        if open.data.is_some() {
            return counted_lines(open);
        }
        match self.closed_unstable {
            Some(closed) if self.is_closed() => {
                format!("    growing poles: {growing} open, {closed} closed\n")
            }
            Some(closed) => format!(
                "    growing poles: {growing} open, {closed} closed: it turns {} times {}clockwise round −1\n",
                closed.abs_diff(growing),
                if closed < growing { "counter" } else { "" }
            ),
            None => format!("    growing poles: {growing} open; closed it is not defined\n"),
        }
    }

    /// Where it crosses the negative real axis, and how it turns at infinity.
    fn course(&self) -> String {
        const MOST: usize = 6;
        let mut text = String::new();
        let negative: Vec<String> = self
            .negative_crossings()
            .map(|c| format!("{} at {} rad/s", four(c.value), four(c.rad_s)))
            .collect();
        if !negative.is_empty() {
            let more = if negative.len() > MOST { ", …" } else { "" };
            // writing to a String cannot fail
            let _ = writeln!(
                text,
                "    crosses the negative real axis: {}{more}",
                negative[..negative.len().min(MOST)].join(", ")
            );
        }
        for part in &self.curve(self.level()).parts {
            if let NyquistPart::Arc(arc) = part {
                let _ = writeln!(text, "    at infinity {} clockwise: {}", half_turns(arc.order), why(arc));
            }
        }
        text
    }
}

/// So many half turns.
pub(super) fn half_turns(count: usize) -> String {
    let half = if count.is_multiple_of(2) { "" } else { "½" };
    match count / 2 {
        0 => format!("{half} turn"),
        1 if half.is_empty() => "1 turn".to_owned(),
        whole => format!("{whole}{half} turns"),
    }
}

/// What makes the curve pass infinity.
fn why(arc: &InfiniteArc) -> String {
    match (arc.rad_s.is_finite(), arc.order) {
        (false, order) => format!("{order} more zeros than poles"),
        (true, 1) => format!("a pole on the edge of stability, at {} rad/s", four(arc.rad_s)),
        (true, order) => format!("{order} poles on the edge of stability, at {} rad/s", four(arc.rad_s)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_turns_are_counted_in_words() {
        let words: Vec<String> = (1..=5).map(half_turns).collect();
        assert_eq!(words, ["½ turn", "1 turn", "1½ turns", "2 turns", "2½ turns"]);
    }
}
