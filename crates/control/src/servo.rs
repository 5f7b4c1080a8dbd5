use tracelight_rig::{Joint, Measurement, PanTilt, Setpoint};

use crate::config::Config;
use crate::estimate::{Effort, Estimate};
use crate::law::{LawInput, LawState, feedforward};
use crate::limit::within;
use crate::observer::Observer;

/// Observers and laws of both joints: counts and setpoints in, volts out. It judges nothing and knows no light.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    observers: PanTilt<Observer>,
    laws: PanTilt<LawState>,
    estimates: PanTilt<Estimate>,
    /// What acted on the joints during the last tick.
    efforts: PanTilt<Effort>,
    /// Torque of the motors in this tick, N m.
    torque_nm: PanTilt<f32>,
    /// The last volts were numbers.
    sound: bool,
}

/// Standard deviation of the speed of a joint at rest, rad/s.
const STILL_RAD_S: f32 = 1e-3;
/// Standard deviation of the speed of a joint left without control, rad/s: tilt falls with 2 rad/s² at most.
const ANY_RAD_S: f32 = 1.0;

/// Where the joints should be.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// Now.
    pub now: PanTilt<Setpoint>,
    /// Half a tick later.
    pub ahead: PanTilt<Setpoint>,
}

impl Servo {
    /// Of a head at rest whose encoders read `measured`.
    pub fn at_rest(config: &Config, measured: &PanTilt<Measurement>) -> Self {
        Self::begin(config, |j| Observer::begin(&config.axes[j], &measured[j], STILL_RAD_S))
    }

    /// Of the same head, of which all but the counts that were put back is to be forgotten.
    pub(crate) fn anew(&self, config: &Config, measured: &PanTilt<Measurement>) -> Self {
        let lost = |j: Joint| self.estimates[j].lost_counts;
        Self::begin(config, |j| Observer::anew(&config.axes[j], &measured[j], lost(j), ANY_RAD_S))
    }

    fn begin(config: &Config, observer: impl FnMut(Joint) -> Observer) -> Self {
        let observers = PanTilt::from_fn(observer);
        let estimates = PanTilt::from_fn(|j| observers[j].estimate(&config.axes[j]));
        let torque_nm = PanTilt::default();
        let efforts = efforts(config, &estimates, torque_nm);
        Self { observers, laws: PanTilt::default(), estimates, efforts, torque_nm, sound: true }
    }

    /// Estimates of both joints.
    pub const fn estimates(&self) -> &PanTilt<Estimate> {
        &self.estimates
    }

    /// Where they are believed to be, rad.
    pub(crate) fn position_rad(&self) -> PanTilt<f32> {
        self.estimates.map(|estimate| estimate.position_rad)
    }

    /// Whether the last volts were numbers; those that were none became 0.
    pub const fn is_sound(&self) -> bool {
        self.sound
    }

    /// What acted on them during the last tick.
    pub(crate) const fn efforts(&self) -> &PanTilt<Effort> {
        &self.efforts
    }

    /// Takes what the encoders read at the end of a tick.
    pub fn observe(&mut self, config: &Config, measured: &PanTilt<Measurement>) {
        self.efforts = efforts(config, &self.estimates, self.torque_nm);
        for joint in Joint::BOTH {
            self.observers[joint].tick(&config.axes[joint], &self.efforts[joint], &measured[joint]);
            self.estimates[joint] = self.observers[joint].estimate(&config.axes[joint]);
        }
    }

    /// Volts for this tick.
    pub fn drive(&mut self, config: &Config, reference: &Reference) -> PanTilt<f32> {
        let added = feedforward(config, &reference.ahead, &self.estimates);
        let mut sound = true;
        let volts = PanTilt::from_fn(|j| {
            let axis = &config.axes[j];
            let input = LawInput {
                setpoint: &reference.now[j],
                estimate: &self.estimates[j],
                inertia_kg_m2: self.efforts[j].inertia_kg_m2,
            };
            let law = &mut self.laws[j];
            let volts = (axis.law.feedback.torque_nm(law, &input) + added[j]) / axis.torque_nm_per_v;
            // a number that is none must not become the amplifier's stop
            sound &= volts.is_finite();
            let limited = if volts.is_finite() { within(volts, axis.limit_v) } else { 0.0 };
            axis.law.feedback.settle(law, &input, volts - limited);
            limited
        });
        self.sound = sound;
        self.apply(config, volts);
        volts
    }

    /// Volts that something else decided on for this tick: a record is played.
    pub fn apply(&mut self, config: &Config, command_v: PanTilt<f32>) {
        self.torque_nm = PanTilt::from_fn(|j| command_v[j] * config.axes[j].torque_nm_per_v);
    }

    /// No volts in this tick.
    pub fn coast(&mut self) -> PanTilt<f32> {
        self.torque_nm = PanTilt::default();
        PanTilt::default()
    }

    /// Forgets what the laws remember: a push is not a load that stays.
    pub(crate) fn forget(&mut self) {
        self.laws = PanTilt::default();
    }
}

/// What acts on the joints where they are believed to be.
fn efforts(config: &Config, at: &PanTilt<Estimate>, torque_nm: PanTilt<f32>) -> PanTilt<Effort> {
    let terms = config.model.terms(at.tilt.position_rad, at.map(|estimate| estimate.velocity_rad_s));
    let acceleration = at.map(|estimate| estimate.acceleration_rad_s2);
    let coupling = PanTilt::new(terms.m12 * acceleration.tilt, terms.m12 * acceleration.pan);
    PanTilt::from_fn(|j| Effort {
        torque_nm: torque_nm[j],
        bias_nm: terms.bias_nm[j] + coupling[j] - config.axes[j].quirks.cable.torque_nm(at[j].position_rad),
        inertia_kg_m2: terms.own_inertia()[j],
    })
}
