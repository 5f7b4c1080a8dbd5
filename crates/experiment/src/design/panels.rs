//! The plot of a loop's step.

use tracelight_chart::{Colour, Curve, Panel, Pen};
use tracelight_linear::Response;

use crate::panels::over_time;

/// What comes out of a step of 1, and what is put in for it.
pub(super) fn step_panels(output: &Response, input: &Response) -> [Panel; 2] {
    let curve = |response: &Response| Curve {
        colour: Colour::Violet,
        pen: Pen::Solid,
        points: (0..).zip(&response.values).map(|(k, y)| (f64::from(k) * response.step_s, *y)).collect(),
    };
    [("output", 1.0, output), ("input", 0.0, input)]
        .map(|(title, level, response)| over_time(title, vec![level], vec![curve(response)]))
}
