//! What was picked, as it is shown.

use serde_json::json;
use tracelight_chart::{Colour, Curve, Figure, Key, Mark, Panel, Pen, Scale, Sign, Theme};
use tracelight_lab::Setting;
use tracelight_rig::PanTilt;
use tracelight_sim::LawName;
use tracelight_task::Failure;

use super::{Errors, Finding, Tried};
use crate::finding::{self, Filed, svg};

/// Of fewer heads the largest error is that of the worst.
const FEW: u32 = 20;

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let choice = &self.choice;
        let mut text = format!(
            "{} on rig {}; motors ×{m} and ÷{m}, currents {} ms late; {} heads that differ\n\n{:14} {:>17} {:>24} {:>22}",
            self.shape,
            self.rig.name,
            1e3 * choice.lag_s,
            choice.plants,
            "",
            "bandwidth, rad/s",
            if choice.plants < FEW { "at most, mm" } else { "at most on 95 %, mm" },
            "rms, middle one, mm",
            m = choice.gain_margin
        );
        for &law in &choice.laws {
            let shown = self.of_law(law).min_by(|a, b| a.worst_mm().total_cmp(&b.worst_mm()));
            shown.into_iter().for_each(|tried| text += &row(law.name(), tried));
        }
        text += &row("as it was", &self.had);
        text += &row("picked", &self.picked);
        let PanTilt { pan, tilt } = self.picked.setting.bandwidth_rad_s;
        text + &format!(
            "\n\ncontrol.law = {:?}, control.pan_bandwidth = \"{pan:.1}rad/s\", control.tilt_bandwidth = \"{tilt:.1}rad/s\"",
            self.picked.setting.law.name()
        )
    }

    fn json(&self) -> String {
        let one = |tried: &Tried| {
            json!({
                "law": tried.setting.law.name(),
                "pan_bandwidth_rad_s": tried.setting.bandwidth_rad_s.pan,
                "tilt_bandwidth_rad_s": tried.setting.bandwidth_rad_s.tilt,
                "bears": tried.errors_mm.is_some(),
                "max_mm_p95": tried.errors_mm.map(|e| e.max_p95),
                "rms_mm_median": tried.errors_mm.map(|e| e.rms_median),
                "demands_borne": tried.borne,
            })
        };
        json!({
            "picked": one(&self.picked),
            "was": one(&self.had),
            "tried": self.tried.iter().map(one).collect::<Vec<_>>(),
        })
        .to_string()
    }
}

impl Filed for Finding {
    fn files(&self) -> Result<Vec<(&'static str, String)>, Failure> {
        Ok(vec![("tune.svg", svg(&self.figure())?)])
    }
}

/// A setting's line.
fn row(name: &str, tried: &Tried) -> String {
    // of a law that bears nothing no bandwidth is better than another
    let bandwidth = match tried.errors_mm {
        None if name == tried.setting.law.name() => "any".to_owned(),
        _ => bandwidths(&tried.setting),
    };
    let error = |value: fn(Errors) -> f64| {
        tried.errors_mm.map_or("bears not what is asked".to_owned(), |e| format!("{:.3}", value(e)))
    };
    let rms = tried.errors_mm.map_or(String::new(), |e| format!("{:.3}", e.rms_median));
    let line = format!("\n{name:14} {bandwidth:>17} {:>24} {rms:>22}", error(|e| e.max_p95));
    line.trim_end().to_owned()
}

fn bandwidths(setting: &Setting) -> String {
    let PanTilt { pan, tilt } = setting.bandwidth_rad_s;
    if is_even(setting) { format!("{pan:.1}") } else { format!("{pan:.1}, {tilt:.1}") }
}

/// Whether both joints have the same bandwidth.
fn is_even(setting: &Setting) -> bool {
    (setting.bandwidth_rad_s.pan - setting.bandwidth_rad_s.tilt).abs() < 1e-9
}

impl Finding {
    /// What was tried of a law with both joints as fast.
    fn of_law(&self, law: LawName) -> impl Iterator<Item = &Tried> {
        self.tried.iter().filter(move |t| t.setting.law == law && is_even(&t.setting))
    }

    /// Errors over the bandwidth.
    fn figure(&self) -> Figure {
        let (laws, colours) = (&self.choice.laws, Colour::in_turn());
        let curves = laws.iter().zip(colours.clone()).map(|(&law, colour)| {
            // a gap where the demand is not borne
            let points = self
                .of_law(law)
                .map(|t| (t.setting.bandwidth_rad_s.pan, t.errors_mm.map_or(f64::NAN, |e| e.max_p95)));
            Curve { colour, pen: Pen::Solid, points: points.collect() }
        });
        let marks = laws.iter().zip(colours.clone()).flat_map(|(&law, colour)| {
            let bear = self.of_law(law).filter(|t| t.errors_mm.is_some());
            let at = |t: &Tried| (t.setting.bandwidth_rad_s.pan, t.worst_mm());
            bear.map(move |t| Mark { colour, sign: Sign::Dot, at: at(t) })
        });
        let PanTilt { pan, tilt } = self.picked.setting.bandwidth_rad_s;
        let at = ((pan * tilt).sqrt(), self.picked.worst_mm());
        let chosen = Mark { colour: Colour::Black, sign: Sign::Ring, at };
        let mut legend: Vec<Key> =
            laws.iter().zip(colours).map(|(law, colour)| Key { colour, name: law.name().into() }).collect();
        legend.push(Key {
            colour: Colour::Black,
            name: "ring: picked; gaps: what is asked is not borne".into(),
        });
        Figure {
            title: format!(
                "{} on rig {}: largest error on heads that differ, over the loops' bandwidth",
                self.shape, self.rig.name
            ),
            legend,
            panels: vec![Panel {
                x_title: "bandwidth, rad/s".into(),
                y_title: "largest error, mm".into(),
                curves: curves.collect(),
                marks: marks.chain([chosen]).collect(),
                scale: Scale::LogX,
                ..Panel::default()
            }],
            columns: 1,
            panel: (820, 420),
            theme: Theme::Light,
        }
    }
}
