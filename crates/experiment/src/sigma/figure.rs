//! Singular values over frequency, as a plot and a table.

use std::fmt::Write;

use tracelight_chart::{Colour, Curve, Figure, Key, Label, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::decibels;
use tracelight_task::Failure;

use super::Finding;
use crate::finding::Plotted;
use crate::numbers::four;

/// More curves than that are told apart by their place alone.
const MOST_NAMED: usize = 4;

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let count = self.system.d().nrows().min(self.system.d().ncols());
        let colours: Vec<Colour> = Colour::in_turn().take(MOST_NAMED).collect();
        let colour = |k: usize| match k {
            0 => colours[0],
            _ if k + 1 == count => colours[1],
            _ if count <= MOST_NAMED => colours[k + 1],
            _ => Colour::Grey,
        };
        // infinities lift the pen, as no numbers do
        let points = |k: usize| {
            let value = |values: &Vec<f64>| if values[k].is_finite() { values[k] } else { f64::NAN };
            self.rad_s.iter().copied().zip(self.values_db.iter().map(value)).collect()
        };
        let mut panel = Panel {
            x_title: "frequency, rad/s".into(),
            y_title: "singular values, dB".into(),
            curves: (0..count)
                .map(|k| Curve { colour: colour(k), pen: Pen::Solid, points: points(k) })
                .collect(),
            levels: vec![0.0],
            scale: Scale::LogX,
            y_step: Some(20.0),
            ..Panel::default()
        };
        self.mark(&mut panel);
        let named = (0..count).filter(|k| *k == 0 || *k + 1 == count || count <= MOST_NAMED);
        let legend = named.map(|k| {
            let name = match k {
                0 if count == 1 => "its gain".to_owned(),
                0 => "σ1, the largest".to_owned(),
                _ if k + 1 == count => format!("σ{count}, the smallest"),
                _ => format!("σ{}", k + 1),
            };
            Key { colour: colour(k), name }
        });
        Ok(Figure {
            title: format!("Singular values of {}{}", self.name, self.disk.summary()),
            legend: legend.collect(),
            panels: vec![panel],
            columns: 1,
            panel: (820, 420),
            theme: self.request.system.theme,
        })
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("rad_s");
        for number in 1..=self.values_db.first().map_or(0, Vec::len) {
            let _ = write!(text, ",sigma_{number}_db");
        }
        for (w, values) in self.rad_s.iter().zip(&self.values_db) {
            let _ = write!(text, "\n{w:.9e}");
            for value in values {
                // nothing and what is beyond all numbers have no decibels
                let _ = match value.is_finite() {
                    true => write!(text, ",{value:.6}"),
                    false => write!(text, ","),
                };
            }
        }
        Ok(text + "\n")
    }
}

impl Finding {
    /// The level of the norm, and where it is reached.
    fn mark(&self, panel: &mut Panel) {
        let ends = (self.rad_s.first().copied(), self.rad_s.last().copied());
        let (Some(peak), (Some(low), Some(high))) = (self.peak.filter(|peak| peak.gain > 0.0), ends) else {
            return;
        };
        let db = decibels(peak.gain);
        let colour = Colour::Limit;
        panel.curves.push(Curve { colour, pen: Pen::FaintDashed, points: vec![(low, db), (high, db)] });
        // at rest and at infinite frequency it is at the plot's ends
        let at = (peak.rad_s.clamp(low, high), db);
        if at.0 == peak.rad_s {
            panel.marks.push(Mark { colour, sign: Sign::Dot, at });
        }
        let words = format!("H∞ norm {} dB at {} rad/s", four(db), four(peak.rad_s));
        panel.labels.push(Label::new(at, words));
    }
}
