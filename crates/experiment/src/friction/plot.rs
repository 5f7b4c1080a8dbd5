//! Friction, plotted.

use tracelight_chart::{Colour, Curve, Figure, Key, Mark, Panel, Pen, Sign, Theme};
use tracelight_lab::{Side, SteadyPoint, Trial, Uncertain};
use tracelight_sim::RigConfig;

use super::Found;
use crate::panels::over_time;

/// Time that speeds are told over, s.
const OVER_S: f64 = 0.2;
/// Points a curve.
const POINTS: usize = 60;

/// Speeds over time and torque over speed, a row a joint.
pub(super) fn figure(rig: &RigConfig, found: &[Found]) -> Figure {
    let panels = found.iter().flat_map(|one| {
        let speeds = (!one.subject.trials.is_empty()).then(|| speeds(one));
        speeds.into_iter().chain([torques(one)])
    });
    let panels: Vec<Panel> = panels.collect();
    let with_motion = found.iter().any(|one| one.curves.is_some());
    let mut legend = Vec::new();
    if with_motion {
        legend.push(Key::new(
            Colour::Violet,
            "forwards; dots: a second each, less what speeds it up and weighs",
        ));
        legend.push(Key::new(Colour::Ochre, "backwards"));
    }
    if found.iter().any(|one| !one.steady.points.is_empty()) {
        legend.push(Key::new(
            Colour::Black,
            "crosses: the last speed of each voltage, as the report did, and its lines",
        ));
    }
    Figure {
        title: format!("Friction of rig {}", rig.name),
        legend,
        columns: if with_motion { 2 } else { 1 },
        panel: (620, 380),
        panels,
        theme: Theme::Light,
    }
}

fn speeds(one: &Found) -> Panel {
    let curve = |trial: &Trial| {
        let speeds = trial.speeds(one.subject.believed.count_rad, OVER_S);
        let furthest =
            speeds.iter().map(|(_, rate)| *rate).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        let colour = if furthest > 0.0 { Colour::Violet } else { Colour::Ochre };
        let every = (speeds.len() / POINTS).max(1);
        Curve { colour, pen: Pen::Solid, points: speeds.into_iter().step_by(every).collect() }
    };
    over_time(
        format!("{} speed, rad/s", one.subject.joint),
        Vec::new(),
        one.subject.trials.iter().map(curve).collect(),
    )
}

fn torques(one: &Found) -> Panel {
    const MILLI: f64 = 1e3;
    let mut curves = Vec::new();
    let furthest = |way: f64| {
        let seen = one.steady.points.iter().map(|p| p.rate_rad_s);
        let pieces = one.curves.iter().flat_map(|c| c.parts.iter().map(|part| part.rate_rad_s));
        seen.chain(pieces).map(|rate| way * rate).fold(0.0, f64::max) * way
    };
    let line = |side: Option<Side>, to: f64, colour, pen| {
        let at = |rate: f64| {
            (rate, MILLI * side.map_or(f64::NAN, |s| mean(s.coulomb_nm) + mean(s.viscous) * rate))
        };
        Curve { colour, pen, points: vec![at(0.0), at(to)] }
    };
    let ways = [(0, 1.0, Colour::Violet), (1, -1.0, Colour::Ochre)];
    for (side, way, colour) in ways {
        let to = furthest(way);
        if let Some(found) = &one.curves {
            let parts = found.parts.iter().filter(|part| way * part.rate_rad_s > 0.0);
            let points = parts.map(|part| (part.rate_rad_s, MILLI * part.friction_nm)).collect();
            curves.push(Curve { colour, pen: Pen::Dots, points });
            curves.push(line(one.sides()[side], to, colour, Pen::Solid));
        }
        curves.push(line(one.as_the_report()[side], to, Colour::Black, Pen::Dashed));
    }
    let mark = |p: &SteadyPoint| Mark {
        colour: Colour::Black,
        sign: Sign::Cross,
        at: (p.rate_rad_s, MILLI * p.torque_nm),
    };
    Panel {
        x_title: format!("{} speed, rad/s", one.subject.joint),
        y_title: "torque, mN m".into(),
        curves,
        marks: one.steady.points.iter().map(mark).collect(),
        ..Panel::default()
    }
}

const fn mean(value: Uncertain) -> f64 {
    value.value
}
