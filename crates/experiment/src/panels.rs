//! Panels that several plots have.

use tracelight_chart::{Colour, Curve, Panel, Pen, Scale};
use tracelight_rig::{Joint, TICK_F64_S};
use tracelight_sim::BenchTick;

/// A panel of curves over time.
pub(crate) fn over_time(title: impl Into<String>, levels: Vec<f64>, curves: Vec<Curve>) -> Panel {
    Panel {
        x_title: "time, s".into(),
        y_title: title.into(),
        curves,
        levels,
        scale: Scale::Free,
        ..Panel::default()
    }
}

/// Something of each tick, over time.
pub(crate) fn curve(
    colour: Colour,
    ticks: &[BenchTick],
    pen: Pen,
    value: &dyn Fn(&BenchTick) -> f64,
) -> Curve {
    let points = ticks.iter().enumerate().map(|(k, tick)| (k as f64 * TICK_F64_S, value(tick)));
    Curve { colour, pen, points: points.collect() }
}

/// The colour of what belongs to one joint, in every plot.
pub(crate) const fn of_joint(joint: Joint) -> Colour {
    match joint {
        Joint::Pan => Colour::Pan,
        Joint::Tilt => Colour::Tilt,
    }
}
