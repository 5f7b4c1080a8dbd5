use tracelight_rig::{Joint, Measurement, PanTilt, Setpoint, TICK_S};

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
    /// Commands of the amplifiers in this tick beyond their dead bands, V.
    beyond_v: PanTilt<f32>,
    /// The last volts were numbers.
    sound: bool,
    /// Where the joints were told to be at the start of this tick.
    told: PanTilt<Setpoint>,
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
        let begun = Self::begin(config, |j| Observer::begin(&config.axes[j], &measured[j], STILL_RAD_S));
        if config.drive.is_open_loop() {
            let told = |j: Joint| measured[j].count as f32 * config.axes[j].count_rad;
            return begun.standing_at(PanTilt::from_fn(told));
        }
        begun
    }

    /// Of the same head, of which all but the counts that were put back is to be forgotten.
    pub(crate) fn anew(&self, config: &Config, measured: &PanTilt<Measurement>) -> Self {
        if config.drive.is_open_loop() {
            return self.standing_at(self.told.map(|told| told.position_rad));
        }
        let lost = |j: Joint| self.estimates[j].lost_counts;
        Self::begin(config, |j| Observer::anew(&config.axes[j], &measured[j], lost(j), ANY_RAD_S))
    }

    /// Believes the joints to rest at these angles, rad.
    fn standing_at(self, position_rad: PanTilt<f32>) -> Self {
        let told = position_rad.map(Setpoint::at_rest);
        Self { told, estimates: told.map(|told| believed(&told)), ..self }
    }

    fn begin(config: &Config, observer: impl FnMut(Joint) -> Observer) -> Self {
        let observers = PanTilt::from_fn(observer);
        let estimates = PanTilt::from_fn(|j| observers[j].estimate(&config.axes[j]));
        let beyond_v = PanTilt::default();
        let efforts = efforts(config, &estimates, &beyond_v);
        let told = PanTilt::default();
        Self { observers, laws: PanTilt::default(), estimates, efforts, beyond_v, sound: true, told }
    }

    /// Estimates of both joints.
    pub const fn estimates(&self) -> &PanTilt<Estimate> {
        &self.estimates
    }

    /// Where a way that begins with the next tick begins: between two ticks, joints that are told where to be are on their way through the last one.
    pub(crate) fn departure(&self, config: &Config) -> PanTilt<Estimate> {
        if config.drive.is_open_loop() {
            self.told.map(|told| believed(&moved_on(&told)))
        } else {
            self.estimates
        }
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

    /// Where the joints are told to be at the start of this tick, and how they are to move on from there.
    pub(crate) const fn told(&self) -> &PanTilt<Setpoint> {
        &self.told
    }

    /// Takes what the encoders read at the end of a tick. Of joints without them, it takes what they were told.
    pub fn observe(&mut self, config: &Config, measured: &PanTilt<Measurement>) {
        if config.drive.is_open_loop() {
            self.estimates = self.told.map(|told| believed(&moved_on(&told)));
            return;
        }
        self.efforts = efforts(config, &self.estimates, &self.beyond_v);
        for joint in Joint::BOTH {
            self.observers[joint].tick(&config.axes[joint], &self.efforts[joint], &measured[joint]);
            self.estimates[joint] = self.observers[joint].estimate(&config.axes[joint]);
        }
    }

    /// Commands of the amplifiers for this tick, V; none for joints that are told where to be.
    pub fn drive(&mut self, config: &Config, reference: &Reference) -> PanTilt<f32> {
        if config.drive.is_open_loop() {
            return self.tell(&reference.now);
        }
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
        self.beyond_v = volts;
        PanTilt::from_fn(|j| config.axes[j].command_v(volts[j]))
    }

    /// Tells joints where to be. A number that is none leaves them where they are.
    fn tell(&mut self, to: &PanTilt<Setpoint>) -> PanTilt<f32> {
        let is_number =
            |s: &Setpoint| (s.position_rad + s.velocity_rad_s + s.acceleration_rad_s2).is_finite();
        self.sound = is_number(&to.pan) && is_number(&to.tilt);
        self.told = if self.sound { *to } else { self.told.map(|told| Setpoint::at_rest(told.position_rad)) };
        PanTilt::default()
    }

    /// Commands of the amplifiers that something else decided on for this tick, V: a record is played.
    pub fn apply(&mut self, config: &Config, command_v: PanTilt<f32>) {
        self.beyond_v = PanTilt::from_fn(|j| config.axes[j].beyond_v(command_v[j]));
    }

    /// Commands of the amplifiers in this tick beyond their dead bands, V.
    pub(crate) const fn beyond_v(&self) -> &PanTilt<f32> {
        &self.beyond_v
    }

    /// No volts in this tick; joints that are told where to be stay.
    pub fn coast(&mut self) -> PanTilt<f32> {
        self.beyond_v = PanTilt::default();
        self.told = self.told.map(|told| Setpoint::at_rest(told.position_rad));
        PanTilt::default()
    }

    /// Forgets what the laws remember: a push is not a load that stays.
    pub(crate) fn forget(&mut self) {
        self.laws = PanTilt::default();
    }
}

/// Where a setpoint leads within a tick.
fn moved_on(from: &Setpoint) -> Setpoint {
    let Setpoint { position_rad, velocity_rad_s, acceleration_rad_s2 } = *from;
    Setpoint {
        position_rad: position_rad + TICK_S * (velocity_rad_s + 0.5 * TICK_S * acceleration_rad_s2),
        velocity_rad_s: velocity_rad_s + TICK_S * acceleration_rad_s2,
        acceleration_rad_s2,
    }
}

/// A joint that is believed to be where it was told to be.
fn believed(told: &Setpoint) -> Estimate {
    let Setpoint { position_rad, velocity_rad_s, acceleration_rad_s2 } = *told;
    Estimate { position_rad, velocity_rad_s, acceleration_rad_s2, ..Estimate::default() }
}

/// What acts on the joints where they are believed to be.
fn efforts(config: &Config, at: &PanTilt<Estimate>, beyond_v: &PanTilt<f32>) -> PanTilt<Effort> {
    let terms = config.model.terms(at.tilt.position_rad, at.map(|estimate| estimate.velocity_rad_s));
    let acceleration = at.map(|estimate| estimate.acceleration_rad_s2);
    let coupling = PanTilt::new(terms.m12 * acceleration.tilt, terms.m12 * acceleration.pan);
    PanTilt::from_fn(|j| Effort {
        torque_nm: beyond_v[j] * config.axes[j].torque_nm_per_v,
        bias_nm: terms.bias_nm[j] + coupling[j] - config.axes[j].quirks.cable.torque_nm(at[j].position_rad),
        inertia_kg_m2: terms.own_inertia()[j],
    })
}
