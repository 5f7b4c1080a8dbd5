//! Poles and zeros, as they are shown.

use std::fmt::Write;

use serde_json::json;
use tracelight_chart::{Figure, Key};
use tracelight_linear::{DistinctRoot, Mode, Time};
use tracelight_task::Failure;

use super::Finding;
use crate::finding::{self, Plotted};
use crate::named::Named;
use crate::plane::{Extent, draw, plane, signs};
use crate::systems::{place, pole_lines};

/// A zero and how often it is one.
fn zero(root: &DistinctRoot) -> String {
    let times = if root.count > 1 { format!(" ({} times)", root.count) } else { String::new() };
    place(root.value) + &times
}

impl finding::Finding for Finding {
    fn text(&self) -> String {
        let mut text = String::new();
        for named in &self.systems {
            let Named { name, system, .. } = named;
            let zeros: Vec<String> =
                system.numerator().distinct_roots().iter().filter(|z| z.value.im >= 0.0).map(zero).collect();
            // writing to a String cannot fail
            let _ = writeln!(text, "{name} = {}\n    = {}", system.factored(), system);
            text += &named.approximated();
            let _ = writeln!(
                text,
                "    zeros: {}",
                if zeros.is_empty() { "none".to_owned() } else { zeros.join(", ") }
            );
            let _ = writeln!(text, "{}", pole_lines(&system.denominator().distinct_roots(), system.time()));
        }
        text.trim_end().to_owned()
    }

    fn json(&self) -> String {
        let all: Vec<_> = self.systems.iter().map(Named::approximated_json).collect();
        json!({ "systems": all }).to_string()
    }
}

impl Plotted for Finding {
    fn figure(&self) -> Result<Figure, Failure> {
        let systems = &self.systems;
        let time = systems.first().map_or(Time::Continuous, |named| named.system.time());
        let places =
            systems.iter().flat_map(|named| named.system.poles().into_iter().chain(named.system.zeros()));
        let mut panel = plane(&Extent::all(time, places.collect()), self.of.reach);
        systems.iter().for_each(|named| panel.marks.extend(signs(named)));
        let legend =
            systems.iter().map(|named| Key { colour: named.colour, name: named.name.clone() }).collect();
        Ok(draw("Poles (crosses) and zeros (rings)", legend, panel, self.of.systems.theme))
    }

    fn csv(&self) -> Result<String, Failure> {
        let mut text = String::from("system,kind,re,im,natural_rad_s,damping\n");
        for (number, named) in (1..).zip(&self.systems) {
            let all = named.system.poles().into_iter().map(|z| ("pole", z));
            for (kind, z) in all.chain(named.system.zeros().into_iter().map(|z| ("zero", z))) {
                let Mode { natural_rad_s, damping, .. } = Mode::of(z, named.system.time());
                let _ = writeln!(
                    text,
                    "{number},{kind},{:.9e},{:.9e},{natural_rad_s:.9e},{damping:.9}",
                    z.re, z.im
                );
            }
        }
        Ok(text)
    }
}
