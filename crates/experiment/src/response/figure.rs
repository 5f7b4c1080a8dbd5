//! The plot of answers.

use tracelight_chart::{Band, Curve, Figure, Key, Label, Mark, Panel, Pen, Sign};
use tracelight_linear::{Extreme, StepInfo, Time};

use super::view::words;
use super::{BAND, Entry, Finding, Input};
use crate::numbers::four;
use crate::panels::over_time;

/// Of more than this the marks have no words.
const MOST_NAMED: usize = 3;

impl Finding {
    pub(super) fn plot(&self) -> Figure {
        let goals = self.entries.iter().filter_map(|entry| entry.info).filter_map(|info| info.ending.value());
        let mut levels: Vec<f64> = goals.collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * b.abs());
        let bands = levels.iter().filter(|goal| **goal != 0.0).map(|goal| band(*goal)).collect();
        let mut panel =
            Panel { bands, ..over_time("output", levels, self.entries.iter().map(Entry::curve).collect()) };
        // what matters most first: words for which there is no room are left out
        self.entries.iter().for_each(|entry| entry.mark_peak(&mut panel));
        let stepped = || self.entries.iter().filter_map(|entry| Some((entry, entry.info?)));
        stepped().for_each(|(entry, info)| entry.mark_settling(&info, &mut panel));
        stepped().for_each(|(entry, info)| entry.mark_rise(&info, &mut panel));
        // of many there would be more words than curves
        if self.entries.len() > MOST_NAMED {
            panel.labels.clear();
        }
        Figure {
            title: match self.of.input {
                Input::Step if panel.bands.is_empty() => "Step responses".into(),
                Input::Step => "Step responses; shaded: within 2 % of the final value".into(),
                other => format!("Answers to {}", words(other)),
            },
            legend: self.entries.iter().map(key).collect(),
            panels: vec![panel],
            columns: 1,
            panel: (820, 460),
            theme: self.of.systems.theme,
        }
    }
}

fn band(goal: f64) -> Band {
    let [a, b] = [(1.0 - BAND) * goal, (1.0 + BAND) * goal];
    Band { low: a.min(b), high: a.max(b) }
}

fn key(entry: &Entry) -> Key {
    // all figures stand here: not all have room beside their curve
    let more = entry.info.and_then(|info| Some((info.overshoot_percent?, info.rise_s?, info.settle_s?)));
    let more = more.map_or(String::new(), |(over, rise_s, s)| {
        format!(": {} % over, rise {} s, settled after {} s", four(over), four(rise_s), four(s))
    });
    Key { colour: entry.named.colour, name: format!("{}{more}", entry.named.name) }
}

impl Entry {
    fn curve(&self) -> Curve {
        let times = (0..).map(|k| f64::from(k) * self.response.step_s);
        let values = &self.response.values;
        let points: Vec<(f64, f64)> = match self.named.system.time() {
            Time::Continuous => {
                let mut points: Vec<(f64, f64)> = times.zip(values.iter().copied()).collect();
                points.extend(&self.early);
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                points
            }
            // a sample holds until the next
            Time::Sampled(period_s) => {
                times.zip(values).flat_map(|(t, &y)| [(t, y), (t + period_s, y)]).collect()
            }
        };
        Curve { colour: self.named.colour, pen: Pen::Solid, points }
    }

    /// The value at a time, between its neighbours on a straight line; none beyond what is shown.
    fn at(&self, time_s: f64) -> Option<f64> {
        let place = time_s / self.response.step_s;
        let values = &self.response.values;
        match self.named.system.time() {
            Time::Continuous => {
                let (before, share) = (place.floor() as usize, place - place.floor());
                let (a, b) = (values.get(before)?, values.get(before + 1)?);
                Some(a + share * (b - a))
            }
            Time::Sampled(_) => values.get(place.round() as usize).copied(),
        }
    }

    fn mark_peak(&self, panel: &mut Panel) {
        let colour = self.named.colour;
        let end_s = self.response.step_s * self.response.values.len() as f64;
        if let Some(Extreme { value, time_s: Some(at_s) }) = self.peak
            && at_s < end_s
        {
            let over = self.info.and_then(|info| info.overshoot_percent).filter(|over| *over > 0.0);
            let over = over.map_or(String::new(), |over| format!(" ({} % over)", four(over)));
            panel.marks.push(Mark { colour, sign: Sign::Dot, at: (at_s, value) });
            panel
                .labels
                .push(Label::new((at_s, value), format!("peak {}{over} at {} s", four(value), four(at_s))));
        }
    }

    /// A line down to the time from which on it stays within the band.
    fn mark_settling(&self, info: &StepInfo, panel: &mut Panel) {
        let Some((goal, s)) = info.ending.value().zip(info.settle_s).filter(|(_, s)| *s > 0.0) else {
            return;
        };
        let colour = self.named.colour;
        let Some(value) = self.at(s) else { return };
        panel.curves.push(Curve { colour, pen: Pen::FaintDashed, points: vec![(s, 0.0), (s, goal)] });
        panel.marks.push(Mark { colour, sign: Sign::Dot, at: (s, value) });
        panel.labels.push(Label::new((s, value), format!("settled (2 %) at {} s", four(s))));
    }

    /// Where it first is at a tenth and at nine tenths of its final value, and the time from the one to the other.
    fn mark_rise(&self, info: &StepInfo, panel: &mut Panel) {
        let all = info.ending.value().zip(info.rise_s).zip(info.rise_from_s);
        let Some(((goal, rise_s), from_s)) = all.filter(|((_, rise_s), _)| *rise_s > 0.0) else { return };
        let colour = self.named.colour;
        let ends = [(from_s, 0.1 * goal), (from_s + rise_s, 0.9 * goal)];
        let words = format!("rise (10–90 %) {} s", four(rise_s));
        match self.named.system.time() {
            Time::Continuous => {
                panel.marks.extend(ends.map(|at| Mark { colour, sign: Sign::Point, at }));
                panel.labels.push(Label::new(ends[1], words));
            }
            // the line that joins samples is not drawn
            Time::Sampled(period_s) => {
                let after_s = (ends[1].0 / period_s - 1e-9).ceil() * period_s;
                panel.labels.extend(self.at(after_s).map(|value| Label::new((after_s, value), words)));
            }
        }
    }
}
