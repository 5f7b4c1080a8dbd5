//! Profiles without phases: closed forms of distance over time, both normalized.

use std::f64::consts::PI;

use tracelight_maths::{exp, ln, powi, sin_cos};

use crate::move_point::MovePoint;

/// A move over one unit of way in one of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// Half a sine of velocity: x = ½(1 − cos πt).
    Sine,
    /// A whole sine of acceleration: x = t − sin(2πt)/2π.
    Cycloid,
    /// x = 10t³ − 15t⁴ + 6t⁵.
    Quintic,
    /// Logistic, cut and rescaled.
    Sigmoid,
}

/// Missing share at either end of a sigmoid.
const SIGMOID_CUT: f64 = 0.01;

/// The largest velocity, acceleration and jerk within a move of one unit of way and time; jumps left out.
pub(super) struct UnitPeaks {
    pub(super) velocity: f64,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
}

/// Steepness of the cut logistic over its whole length: σ(−k/2) = [`SIGMOID_CUT`].
fn sigmoid_steepness() -> f64 {
    2.0 * ln(1.0 / SIGMOID_CUT - 1.0)
}

/// What the rescaling multiplies the logistic by.
const SIGMOID_SCALE: f64 = 1.0 / (1.0 - 2.0 * SIGMOID_CUT);

impl Unit {
    /// At time t in [0, 1].
    pub(super) fn at(self, t: f64) -> MovePoint {
        let (position, velocity, acceleration) = match self {
            Unit::Sine => {
                let (s, c) = sin_cos(PI * t);
                (0.5 * (1.0 - c), 0.5 * PI * s, 0.5 * PI * PI * c)
            }
            Unit::Cycloid => {
                let (s, c) = sin_cos(2.0 * PI * t);
                (t - s / (2.0 * PI), 1.0 - c, 2.0 * PI * s)
            }
            Unit::Quintic => {
                let left = 1.0 - t;
                let position = t * t * t * (10.0 - t * (15.0 - 6.0 * t));
                (position, 30.0 * t * t * left * left, 60.0 * t * left * (1.0 - 2.0 * t))
            }
            Unit::Sigmoid => {
                let k = sigmoid_steepness();
                let y = 1.0 / (1.0 + exp(-k * (t - 0.5)));
                let slope = y * (1.0 - y);
                let scaled = [y - SIGMOID_CUT, k * slope, k * k * slope * (1.0 - 2.0 * y)];
                let [x, v, a] = scaled.map(|value| SIGMOID_SCALE * value);
                (x, v, a)
            }
        };
        MovePoint { position, velocity, acceleration }
    }

    pub(super) fn peaks(self) -> UnitPeaks {
        let k = sigmoid_steepness();
        let (velocity, acceleration, jerk) = match self {
            Unit::Sine => (PI / 2.0, PI * PI / 2.0, powi(PI, 3) / 2.0),
            Unit::Cycloid => (2.0, 2.0 * PI, 4.0 * PI * PI),
            // x″ is largest where 1 − 6t + 6t² = 0, x‴ at both ends
            Unit::Quintic => (15.0 / 8.0, 10.0 / 3f64.sqrt(), 60.0),
            // peaks of the logistic's derivatives: 1/4, 1/(6√3), 1/8
            Unit::Sigmoid => (
                SIGMOID_SCALE * k / 4.0,
                SIGMOID_SCALE * k * k / (6.0 * 3f64.sqrt()),
                SIGMOID_SCALE * powi(k, 3) / 8.0,
            ),
        };
        UnitPeaks { velocity, acceleration, jerk }
    }

    /// Whether the acceleration jumps at its ends.
    pub(super) const fn starts_hard(self) -> bool {
        matches!(self, Unit::Sine | Unit::Sigmoid)
    }
}
