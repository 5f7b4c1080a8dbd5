//! Lead-lag compensators from poles and zeros.

use tracelight_control::{Biquad, LeadLag};
use tracelight_rig::TICK_F64_S;

/// How the figures of a compensator are meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    /// gain · Π(s + z) / Π(s + p).
    Zpk,
    /// gain · Π(1 + s/z) / Π(1 + s/p).
    TimeConstants,
}

/// A compensator in continuous time: gain · (s + z₁)(s + z₂) / ((s + p₁)(s + p₂)), N m/rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LeadLagDesign {
    gain: f64,
    zeros: [f64; 2],
    poles: [f64; 2],
}

impl LeadLagDesign {
    pub(crate) fn report(gain: f64, zeros: [f64; 2], poles: [f64; 2], format: Format) -> Self {
        let gain = match format {
            Format::Zpk => gain,
            Format::TimeConstants => gain * poles[0] * poles[1] / (zeros[0] * zeros[1]),
        };
        Self { gain, zeros, poles }
    }

    /// For a pure inertia: a lead that gives 60° of phase where the loop's gain is one, at the bandwidth, and a lag a decade
    /// below that makes a constant load's error a hundredth.
    pub(crate) fn for_inertia(bandwidth_rad_s: f64, inertia_kg_m2: f64) -> Self {
        // tan 75°: the lead's phase is 2·75° − 90°
        const SPREAD: f64 = 3.732_050_807_568_877;
        let w = bandwidth_rad_s;
        Self {
            gain: inertia_kg_m2 * w * w * SPREAD,
            zeros: [w / SPREAD, w / 10.0],
            poles: [w * SPREAD, w / 1000.0],
        }
    }

    /// Tustin's rule, s = (2/T)(1 − z⁻¹)/(1 + z⁻¹), for the controller's tick.
    pub(crate) fn discretize(&self) -> LeadLag {
        let rate = 2.0 / TICK_F64_S;
        // (s + z) / (s + p) = ((rate + z) + (z − rate) z⁻¹) / ((rate + p) + (p − rate) z⁻¹); a section each, since `f32` has
        // no digits for a slow pole beside a fast one
        let section = |gain: f64, zero: f64, pole: f64| Biquad {
            numerator: [gain * (rate + zero) / (rate + pole), gain * (zero - rate) / (rate + pole), 0.0]
                .map(|b| b as f32),
            denominator: [((pole - rate) / (rate + pole)) as f32, 0.0],
        };
        let [first, second] = [0, 1].map(|i| (self.zeros[i], self.poles[i]));
        LeadLag { sections: [section(self.gain, first.0, first.1), section(1.0, second.0, second.1)] }
    }
}
