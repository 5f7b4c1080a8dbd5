//! The plot of a root locus.

use tracelight_chart::{Arrows, Colour, Curve, Figure, Key, Label, Mark, Panel, Pen, Sign};
use tracelight_linear::{Complex, Time};
use tracelight_maths::{cos, sin};

use super::{Chosen, Entry, Finding};
use crate::numbers::four;
use crate::plane::{Extent, draw, plane, signs};
use crate::systems::place;

impl Finding {
    pub(super) fn plot(&self) -> Figure {
        let reach = self.of.plane.reach;
        let extent = self.extent();
        let mut panel = plane(&extent, reach);
        for entry in &self.entries {
            entry.draw_asymptotes(&mut panel);
        }
        for entry in &self.entries {
            entry.draw_branches(&mut panel);
        }
        for entry in &self.entries {
            entry.mark(&mut panel);
        }
        if reach.is_none() && !extent.outside.is_empty() {
            panel.x_title += &format!(" (outside: {})", self.outside(&extent));
        }
        draw(
            "Root locus; arrows: rising gain k",
            self.entries.iter().map(key).collect(),
            panel,
            self.of.plane.systems.theme,
        )
    }

    /// What is shown: crossings and the closed poles that swing must be, a pole far from all others need not.
    fn extent(&self) -> Extent {
        let time = self.entries.first().map_or(Time::Continuous, |entry| entry.named.system.time());
        let (mut must, mut others) = (Vec::new(), Vec::new());
        for entry in &self.entries {
            must.extend(entry.crossings.first().map(|crossing| crossing.pole));
            others.extend(entry.crossings.iter().skip(1).map(|crossing| crossing.pole));
            others.extend(entry.named.system.poles());
            others.extend(entry.named.system.zeros());
            others.extend(entry.breakaways.iter().map(|breakaway| breakaway.pole));
            if let Chosen::Gain(_, closed) = &entry.chosen {
                let (swinging, real): (Vec<Complex>, Vec<Complex>) = closed.iter().partition(|z| z.im != 0.0);
                must.extend(swinging);
                others.extend(real);
            }
        }
        Extent::what_matters(time, &must, &others)
    }

    /// Poles and zeros that are not shown, in words.
    fn outside(&self, extent: &Extent) -> String {
        const MOST: usize = 3;
        let mut words = Vec::new();
        for entry in &self.entries {
            let system = &entry.named.system;
            for (name, all) in [("pole", system.poles()), ("zero", system.zeros())] {
                let far = all.into_iter().filter(|z| z.im >= 0.0 && extent.outside.contains(z));
                words.extend(far.map(|z| format!("{name} {}", place(z))));
            }
        }
        let more = words.len().saturating_sub(MOST);
        words.truncate(MOST);
        if words.is_empty() {
            return "meeting points of branches".to_owned();
        }
        let rest = if more > 0 { format!(" and {more} more") } else { String::new() };
        words.join(", ") + &rest
    }
}

fn key(entry: &Entry) -> Key {
    let name = &entry.named.name;
    let name = match &entry.chosen {
        Chosen::Gain(gain, _) => format!("{name}, dots: closed poles for k = {}", four(*gain)),
        Chosen::None(_) => name.clone(),
    };
    Key { colour: entry.named.colour, name }
}

impl Entry {
    fn draw_branches(&self, panel: &mut Panel) {
        const MANY: usize = 8;
        let colour = self.named.colour;
        let branches = self.locus.poles.first().map_or(0, Vec::len);
        for branch in 0..branches {
            let points: Vec<(f64, f64)> =
                self.locus.poles.iter().map(|poles| (poles[branch].re, poles[branch].im)).collect();
            let count = if branches > MANY { 1 } else { 2 };
            panel.arrows.push(Arrows { colour, points: points.clone(), count, is_faint: false });
            panel.curves.push(Curve { colour, pen: Pen::Solid, points });
        }
    }

    /// Where branches go that go far away; one alone goes along the real axis.
    fn draw_asymptotes(&self, panel: &mut Panel) {
        let Some(far) = self.named.system.asymptotes().filter(|far| far.angles_rad.len() > 1) else { return };
        let [x, y] = panel.view.unwrap_or([(-1.0, 1.0); 2]);
        let long = 2.0 * (x.1 - x.0 + y.1 - y.0) + far.centre.abs();
        for &angle in &far.angles_rad {
            let end = (far.centre + long * cos(angle), long * sin(angle));
            let points = vec![(far.centre, 0.0), end];
            panel.curves.push(Curve { colour: Colour::Grey, pen: Pen::FaintDashed, points });
        }
    }

    /// Poles, zeros, closed poles, and gains where branches meet and where they pass the edge of stability.
    fn mark(&self, panel: &mut Panel) {
        let colour = self.named.colour;
        panel.marks.extend(signs(&self.named));
        if let Chosen::Gain(_, closed) = &self.chosen {
            panel.marks.extend(closed.iter().map(|z| Mark { colour, sign: Sign::Dot, at: (z.re, z.im) }));
        }
        for crossing in &self.crossings {
            let at = (crossing.pole.re, crossing.pole.im);
            for at in [at, (at.0, -at.1)] {
                panel.marks.push(Mark { colour: Colour::Limit, sign: Sign::Point, at });
            }
            let words = format!("k = {}, {} rad/s", four(crossing.gain), four(crossing.rad_s));
            panel.labels.push(Label::new(at, words));
        }
        for breakaway in &self.breakaways {
            let at = (breakaway.pole.re, breakaway.pole.im);
            panel.marks.push(Mark { colour, sign: Sign::Point, at });
            if at.1 >= 0.0 {
                panel.labels.push(Label::new(at, format!("k = {}", four(breakaway.gain))));
            }
        }
    }
}
