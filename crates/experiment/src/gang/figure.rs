//! The plot of the gang of four.

use tracelight_chart::{Curve, Figure, Key, Label, Mark, Panel, Pen, Scale, Sign};
use tracelight_linear::{LoopMember, Peak, decibels};

use super::view::short;
use super::{Entry, Finding, Member};
use crate::numbers::four;
use crate::steady::tidy_db;

impl Finding {
    pub(super) fn plot(&self) -> Figure {
        let panels = LoopMember::ALL.into_iter().enumerate().map(|(number, which)| self.panel(number, which));
        Figure {
            title: "Gang of four".into(),
            legend: self.loops.iter().map(|entry| Key::new(entry.colour, entry.name.clone())).collect(),
            panels: panels.collect(),
            columns: 2,
            panel: (560, 320),
            theme: self.theme,
        }
    }

    fn panel(&self, number: usize, which: LoopMember) -> Panel {
        let mut panel = Panel {
            x_title: "frequency, rad/s".into(),
            y_title: format!("{}, dB", formula(which)),
            levels: vec![0.0],
            scale: Scale::LogX,
            y_step: Some(20.0),
            ..Panel::default()
        };
        for entry in &self.loops {
            let Some(member) = entry.members.get(number) else { continue };
            panel.curves.push(member.curve(entry));
            member.mark(entry, &mut panel);
        }
        panel
    }
}

impl Member {
    fn curve(&self, entry: &Entry) -> Curve {
        let values = self.response.magnitudes_db().map(|db| if db.is_finite() { db } else { f64::NAN });
        let points = self.response.rad_s.iter().copied().zip(values).collect();
        Curve { colour: entry.colour, pen: Pen::Solid, points }
    }

    /// A dot and words at its peak.
    fn mark(&self, entry: &Entry, panel: &mut Panel) {
        let Some(Peak { rad_s, gain }) = self.peak.peak().filter(|peak| peak.gain > 0.0) else { return };
        let ends = self.response.rad_s.first().zip(self.response.rad_s.last());
        // what is largest at rest or at the very end is marked where the plot begins or ends
        let Some((&low, &high)) = ends else { return };
        let at = (rad_s.clamp(low, high), decibels(gain));
        let place = match rad_s {
            0.0 => "at rest".to_owned(),
            w if w.is_infinite() => "at the highest frequencies".to_owned(),
            w => format!("at {} rad/s", four(w)),
        };
        let name = match self.which {
            LoopMember::Sensitivity => "Ms",
            LoopMember::Complementary => "Mt",
            LoopMember::Load | LoopMember::Control => short(self.which),
        };
        panel.marks.push(Mark { colour: entry.colour, sign: Sign::Dot, at });
        panel.labels.push(Label::new(at, format!("{name} {} dB {place}", four(tidy_db(gain)))));
    }
}

const fn formula(which: LoopMember) -> &'static str {
    match which {
        LoopMember::Sensitivity => "S = 1/(1 + PC)",
        LoopMember::Complementary => "T = PC/(1 + PC)",
        LoopMember::Load => "PS = P/(1 + PC)",
        LoopMember::Control => "CS = C/(1 + PC)",
    }
}
