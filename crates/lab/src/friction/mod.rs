//! What holds a joint back, told from how it turns under known voltages.
//!
//! The 2006 report holds a voltage for 30 s, takes the last speed for steady, and lays a line through torque over speed
//! ([`Steady`]). A head whose time constant J/Fv is longer is far from steady then, and the line too steep. The whole curve tells more
//! ([`Curves`]): between two reversals the equation of motion
//!
//! ```text
//! k u = J q̈ + Fv q̇ + Fc − gc cos q − gs sin q + s q
//! ```
//!
//! integrated twice is linear in all that is unknown and in what the encoder counted, steady or not.

mod curves;
mod error;
mod fit;
mod line;
mod pieces;
mod protocol;
mod replay;
mod saturated;
mod steady;

use tracelight_rig::Joint;

pub use curves::{Curves, Part, curves};
pub use error::FrictionError;
pub use line::{Line, Side};
pub use protocol::{Protocol, Shuttle, Travel, free_trial};
pub use replay::replayed;
pub use saturated::{Plateau, plateau, saturated};
pub use steady::{Steady, SteadyPoint, steady, steady_of};

/// Reading of a joint under a voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Since the trial began, s.
    pub time_s: f64,
    /// Mean voltage from here to the next sample, V.
    pub volts: f64,
    /// What the encoder counted; between counts where a finer place is known.
    pub count: f64,
}

/// A joint's motion under a voltage.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Which joint.
    pub joint: Joint,
    /// In order of time, two or more.
    pub samples: Vec<Sample>,
}

/// What is believed of a joint whose friction is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Believed {
    /// Torque a volt at the amplifier beyond its dead band, N m: the scale of all that is found.
    pub torque_nm_per_v: f64,
    /// Command of the amplifier of which nothing comes, either sign, V.
    pub dead_band_v: f64,
    /// Width of a count, rad.
    pub count_rad: f64,
    /// How finely places are known, rad: a count's width where they are counted.
    pub step_rad: f64,
    /// kg m²; kept where no motion tells it.
    pub inertia_kg_m2: f64,
    /// Whether the motor is another than the one that this is believed of: where motion tells no inertia, it has none.
    pub another: bool,
    /// Gravity with cos and sin of the angle, N m; none where it does not turn the joint.
    pub gravity_nm: Option<[f64; 2]>,
    /// Whether cables may pull at it, the more the further it turns.
    pub cables: bool,
}

impl Believed {
    /// Torque that a voltage makes, N m; what the motor's own voltage takes from it counts as friction.
    pub fn torque_nm(&self, volts: f64) -> f64 {
        self.torque_nm_per_v * (volts.abs() - self.dead_band_v).max(0.0).copysign(volts)
    }
}

impl Trial {
    /// What the joint turned by, rad, at each sample.
    fn angles(&self, count_rad: f64) -> Vec<f64> {
        self.samples.iter().map(|s| s.count * count_rad).collect()
    }

    /// Time from the first sample to the last, s.
    pub fn length_s(&self) -> f64 {
        let ends = self.samples.first().zip(self.samples.last());
        ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
    }

    /// Speed of the joint over time, s and rad/s: counts compared over about `over_s`.
    pub fn speeds(&self, count_rad: f64, over_s: f64) -> Vec<(f64, f64)> {
        let angles = self.angles(count_rad);
        let reach = self.reach(over_s);
        let at = |i: usize| {
            let (from, to) = (i.saturating_sub(reach), (i + reach).min(angles.len() - 1));
            let span_s = self.samples[to].time_s - self.samples[from].time_s;
            let time_s = 0.5 * (self.samples[to].time_s + self.samples[from].time_s);
            (time_s, (angles[to] - angles[from]) / span_s)
        };
        (0..angles.len()).map(at).collect()
    }

    /// Samples to either side that make up a time.
    fn reach(&self, over_s: f64) -> usize {
        let step_s = self.length_s() / (self.samples.len() - 1) as f64;
        ((0.5 * over_s / step_s).round() as usize).clamp(1, self.samples.len())
    }
}
