//! A Bode plot and its margins, as they are shown.

use std::fmt::Write;

use serde_json::{Value, json};
use tracelight_chart::{Colour, Curve, Figure, Key, Label, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{Margins, Peak, Stability, decibels};
use tracelight_maths::complex;
use tracelight_task::Failure;

use super::{Entry, Finding, Kind};
use crate::finding::{self, Plotted};
use crate::margins::{counted_lines, margin_lines, margins_json, summary};
use crate::numbers::four;
use crate::plant_file::LEAST_COHERENCE;
use crate::steady::{error_lines, errors_json, norm_lines, norms_json};
use crate::system_json::stability_name;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for entry in &self.entries {
            let named = &entry.named;
            // writing to a String cannot fail
            let _ = writeln!(text, "{} = {}", named.name, named.text());
            if let Kind::Open { margins, .. } = &entry.kind {
                let _ = writeln!(text, "{}", margin_lines(named.delay_margin(margins), margins));
            }
            if let Some(rad_s) = entry.bandwidth_rad_s {
                let _ =
                    writeln!(text, "    bandwidth       {} rad/s: 3 dB below its gain at rest", four(rad_s));
            }
            if let Some(Peak { rad_s, gain }) = entry.resonance {
                let _ = writeln!(
                    text,
                    "    resonance       {} dB (factor {}) at {} rad/s",
                    four(decibels(gain)),
                    four(gain),
                    four(rad_s)
                );
            }
            text += &norm_lines(named);
            text += &entry.stability();
            text += "\n";
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let one = |entry: &Entry| {
            let named = &entry.named;
            let mut object = named.json();
            let (margins, closed) = match &entry.kind {
                Kind::Open { margins, closed } => {
                    (margins_json(named.delay_margin(margins), margins), *closed)
                }
                Kind::Closed(stability) => (Value::Null, *stability),
            };
            let open = if let Kind::Open { .. } = entry.kind { Some(named) } else { named.opened.as_deref() };
            object["error_constants"] = match open {
                Some(open) if !named.is_positive => errors_json(open),
                _ => Value::Null,
            };
            object["norms"] = norms_json(named);
            object["margins"] = margins;
            object["closed_stable"] = closed.map(|closed| closed == Stability::Stable).into();
            object["closed_stability"] = closed.map(stability_name).into();
            object["bandwidth_rad_s"] = entry.bandwidth_rad_s.into();
            object["resonance"] = entry
                .resonance
                .map(|peak| json!({"rad_s": peak.rad_s, "factor": peak.gain, "db": decibels(peak.gain)}))
                .into();
            object["magnitude_db"] = entry.response.magnitudes_db().collect();
            object["phase_deg"] = entry.response.phases_deg().collect();
            object
        };
        let rad_s = self.entries.first().map(|entry| &entry.response.rad_s);
        json!({"rad_s": rad_s, "systems": self.entries.iter().map(one).collect::<Vec<_>>()}).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let curve = |entry: &Entry, values: Vec<f64>| Curve {
            colour: entry.named.colour,
            pen: Pen::Solid,
            points: entry.response.rad_s.iter().copied().zip(values).collect(),
        };
        let panel = |title: &str, level: f64, step: f64, curves: Vec<Curve>| Panel {
            x_title: "frequency, rad/s".into(),
            y_title: title.into(),
            curves,
            levels: vec![level],
            scale: Scale::LogX,
            y_step: Some(step),
            ..Panel::default()
        };
        let mut magnitude = panel(
            "amplification, dB",
            0.0,
            20.0,
            self.entries.iter().map(|e| curve(e, e.response.magnitudes_db().collect())).collect(),
        );
        let mut phase = panel(
            "phase, °",
            -180.0,
            45.0,
            self.entries.iter().map(|e| curve(e, e.response.phases_deg().collect())).collect(),
        );
        for entry in &self.entries {
            mark_left_out(entry, &mut magnitude, &mut phase);
            mark(entry, &mut magnitude, &mut phase);
        }
        let mut legend: Vec<Key> = self.entries.iter().map(key).collect();
        if self.entries.iter().any(|entry| !entry.left_out.is_empty()) {
            let name = format!("rings: coherence below {LEAST_COHERENCE}, left out");
            legend.push(Key { colour: Colour::Grey, name });
        }
        Ok(Figure {
            title: "Bode plot".into(),
            legend,
            panels: vec![magnitude, phase],
            columns: 1,
            panel: (820, 300),
            theme: self.theme,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("rad_s");
        for number in 1..=self.entries.len() {
            let _ = write!(text, ",magnitude_db_{number},phase_deg_{number}");
        }
        let columns: Vec<(Vec<f64>, Vec<f64>)> = self
            .entries
            .iter()
            .map(|e| (e.response.magnitudes_db().collect(), e.response.phases_deg().collect()))
            .collect();
        let rad_s = self.entries.first().map(|entry| entry.response.rad_s.as_slice()).unwrap_or_default();
        for (row, w) in rad_s.iter().enumerate() {
            let _ = write!(text, "\n{w:.9e}");
            for (magnitudes, phases) in &columns {
                let _ = write!(text, ",{:.6},{:.6}", magnitudes[row], phases[row]);
            }
        }
        Ok(text + "\n")
    }
}

impl Entry {
    /// What becomes of the loop, a line or more.
    fn stability(&self) -> String {
        let named = &self.named;
        match self.kind {
            Kind::Open { .. } if named.data.is_some() => counted_lines(named),
            Kind::Closed(_) if named.data.is_some() => {
                named.opened.as_ref().map_or(String::new(), |open| counted_lines(open))
            }
            Kind::Open { closed: Some(closed), .. } => {
                let errors = if named.is_positive { String::new() } else { error_lines(named) };
                format!("{errors}    closed by {} feedback it {}\n", named.feedback(), is(closed))
            }
            Kind::Open { closed: None, .. } => format!(
                "    closed by {} feedback it is not defined: 1 + G is zero at infinite frequency\n",
                named.feedback()
            ),
            Kind::Closed(stability) => {
                stability.map_or(String::new(), |is_so| format!("    it {}\n", is(is_so)))
            }
        }
    }
}

const fn is(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "is stable",
        Stability::Marginal => "is at the edge of stability, or nearer to it than rounding lets tell",
        Stability::Growing => "is not stable",
    }
}

fn key(entry: &Entry) -> Key {
    let name = match &entry.kind {
        Kind::Open { margins, .. } => summary(&entry.named.name, margins),
        Kind::Closed(_) => entry.named.name.clone(),
    };
    Key { colour: entry.named.colour, name }
}

/// Rings where points were measured that are not trusted; their phase is on the turn that is nearest to the curve's.
fn mark_left_out(entry: &Entry, magnitude: &mut Panel, phase: &mut Panel) {
    let Some(data) = &entry.named.data else { return };
    let (low, high) = data.band();
    for &(w, value) in &entry.left_out {
        let own = complex::arg(value).to_degrees();
        let near = data.phase(w.clamp(low, high)).unwrap_or(0.0).to_degrees();
        let shown = own + 360.0 * ((near - own) / 360.0).round();
        for (panel, y) in [(&mut *magnitude, decibels(complex::norm(value))), (&mut *phase, shown)] {
            // nothing has no decibels
            if y.is_finite() && w > 0.0 {
                panel.marks.push(Mark { colour: Colour::Grey, sign: Sign::Ring, at: (w, y) });
            }
        }
    }
}

/// What stands out, at the curves where it is.
fn mark(entry: &Entry, magnitude: &mut Panel, phase: &mut Panel) {
    match &entry.kind {
        Kind::Open { margins, .. } => mark_margins(entry, margins, magnitude, phase),
        Kind::Closed(_) => mark_closed(entry, magnitude),
    }
}

/// Lines from the levels to the curves where the margins are.
fn mark_margins(entry: &Entry, margins: &Margins, magnitude: &mut Panel, phase: &mut Panel) {
    let colour = entry.named.colour;
    let rad_s = &entry.response.rad_s;
    // logarithms round at the ends
    let (low, high) = (rad_s.first().copied().unwrap_or(0.0), rad_s.last().copied().unwrap_or(0.0));
    let band = low * (1.0 - 1e-9)..=high * (1.0 + 1e-9);
    let line = |panel: &mut Panel, rad_s: f64, (from, to): (f64, f64), words: String| {
        if !band.contains(&rad_s) {
            return;
        }
        let rad_s = rad_s.clamp(low, high);
        panel.curves.push(Curve { colour, pen: Pen::Dashed, points: vec![(rad_s, from), (rad_s, to)] });
        panel.marks.push(Mark { colour, sign: Sign::Dot, at: (rad_s, to) });
        panel.labels.push(Label::new((rad_s, to), words));
    };
    if let Some(margin) = margins.least_gain().filter(|margin| margin.rad_s > 0.0 && margin.rad_s.is_finite())
    {
        let db = decibels(margin.factor);
        let words = format!("gain margin {} dB at {} rad/s", four(db), four(margin.rad_s));
        line(magnitude, margin.rad_s, (0.0, -db), words);
    }
    if let Some(margin) = margins.least_phase() {
        // −180°, or that a whole number of turns further
        let shown = entry.named.phase(margin.rad_s).to_degrees();
        let words = format!("phase margin {}° at {} rad/s", four(margin.degrees()), four(margin.rad_s));
        line(phase, margin.rad_s, (shown - margin.degrees(), shown), words);
    }
}

/// Bandwidth and resonance of a closed loop.
fn mark_closed(entry: &Entry, magnitude: &mut Panel) {
    let mut dot = |rad_s: f64, words: String| {
        let gain = complex::norm(entry.named.at(rad_s));
        let at = (rad_s, decibels(gain));
        magnitude.marks.push(Mark { colour: entry.named.colour, sign: Sign::Dot, at });
        magnitude.labels.push(Label::new(at, words));
    };
    if let Some(Peak { rad_s, gain }) = entry.resonance {
        dot(rad_s, format!("resonance {} dB at {} rad/s", four(decibels(gain)), four(rad_s)));
    }
    if let Some(rad_s) = entry.bandwidth_rad_s {
        dot(rad_s, format!("bandwidth {} rad/s", four(rad_s)));
    }
}
