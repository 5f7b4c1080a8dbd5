//! Watches: what goes wrong with encoders, motors, the laser and the host, and how soon it is seen.
//!
//! | fault | seen when |
//! |---|---|
//! | encoder jumped | in the tick: over one and a half counts beside the count the joint is expected on |
//! | encoder noisy | surprises of three counts together within some 50 ticks, or three lost counts within some seconds |
//! | encoder dead | four counts of motion predicted, none counted, whether or not the last load still acts: dark at once, a fault 20 ticks later |
//! | encoder slipping | a load of 30 % of the motor's torque, or 57 % more or less inertia than there is: dark at once, a fault after 150 ticks in which it seems braked |
//! | estimate diverged | six counts between speed believed and counted, over some 20 ticks |
//! | amplifier saturated | 300 ticks at its limit, one way |
//! | motor hot | I²t over what it stands |
//! | laser stuck | three ticks after it should have switched |
//! | host lost | after [`Config::host_silence_ticks`](crate::Config) |
//! | not a number | in the tick |

mod encoder;
mod motor;

use tracelight_rig::{Fault, Joint, PanTilt, Sensed};

use crate::config::Config;
use crate::estimate::Estimate;
use crate::servo::Servo;
use encoder::EncoderWatch;
pub use motor::MotorRating;
use motor::MotorWatch;

/// Ticks a laser may take longer than its relay.
const LASER_SLACK_TICKS: u32 = 2;

/// State of all watches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch {
    encoders: PanTilt<EncoderWatch>,
    motors: PanTilt<MotorWatch>,
    gate: bool,
    /// How long the gate has been so, ticks.
    gate_ticks: u32,
    /// How long ago the host said that it is there, ticks; `None` if it never did.
    silence_ticks: Option<u32>,
}

impl Watch {
    pub(crate) fn new(sensed: &Sensed, estimates: &PanTilt<Estimate>) -> Self {
        Self {
            encoders: encoders(sensed, estimates),
            motors: PanTilt::default(),
            gate: false,
            gate_ticks: u32::MAX,
            silence_ticks: None,
        }
    }

    /// The host said that it is there.
    pub(crate) const fn hear(&mut self) {
        self.silence_ticks = Some(0);
    }

    /// Whether the host has said of late that it is there.
    pub(crate) fn hears_host(&self, config: &Config) -> bool {
        self.silence_ticks.is_some_and(|silence| silence <= config.host_silence_ticks)
    }

    /// What a tick's senses show, if anything.
    pub(crate) fn sense(&mut self, config: &Config, servo: &Servo, sensed: &Sensed) -> Option<Fault> {
        // silence is counted whatever else is wrong
        let silence = self.host(config);
        let stamped =
            |j: Joint| sensed.encoders[j].edge_age_ticks.is_none_or(|age| (0.0..1.0).contains(&age));
        if !Joint::BOTH.iter().all(|&j| stamped(j) && servo.estimates()[j].is_finite()) {
            return Some(Fault::NotANumber);
        }
        let encoder = |watch: &mut EncoderWatch, j: Joint| {
            watch.tick(&config.axes[j], &servo.efforts()[j], &servo.estimates()[j], &sensed.encoders[j])
        };
        let pan = encoder(&mut self.encoders.pan, Joint::Pan);
        let tilt = encoder(&mut self.encoders.tilt, Joint::Tilt);
        pan.or(tilt).or(self.laser(config, sensed)).or(silence)
    }

    /// Whether an encoder has shown nothing where its joint should have passed several edges, or does not fit its motor.
    pub(crate) const fn is_doubtful(&self) -> bool {
        self.encoders.pan.is_doubtful() || self.encoders.tilt.is_doubtful()
    }

    fn laser(&mut self, config: &Config, sensed: &Sensed) -> Option<Fault> {
        let delay = if self.gate { config.laser_on_ticks } else { config.laser_off_ticks };
        let due = self.gate_ticks > delay + LASER_SLACK_TICKS;
        let wrong = sensed.laser_on.is_some_and(|on| on != self.gate);
        (due && wrong).then_some(Fault::LaserStuck)
    }

    fn host(&mut self, config: &Config) -> Option<Fault> {
        let silence = self.silence_ticks?.saturating_add(1);
        self.silence_ticks = Some(silence);
        (silence > config.host_silence_ticks).then_some(Fault::HostLost)
    }

    /// What the volts of a tick show, if anything.
    pub(crate) fn drive(&mut self, config: &Config, command_v: &PanTilt<f32>) -> Option<Fault> {
        let faults = PanTilt::from_fn(|j| {
            let axis = &config.axes[j];
            self.motors[j].tick(&axis.rating, command_v[j] / axis.limit_v)
        });
        faults.pan.or(faults.tilt)
    }

    /// What the gate is set to in this tick.
    pub(crate) const fn light(&mut self, gate: bool) {
        self.gate_ticks = if gate == self.gate { self.gate_ticks.saturating_add(1) } else { 1 };
        self.gate = gate;
    }

    /// Begins anew after a fault.
    pub(crate) fn rearm(&mut self, sensed: &Sensed, estimates: &PanTilt<Estimate>) {
        self.encoders = encoders(sensed, estimates);
        Joint::BOTH.iter().for_each(|&j| self.motors[j].rearm());
    }
}

fn encoders(sensed: &Sensed, estimates: &PanTilt<Estimate>) -> PanTilt<EncoderWatch> {
    PanTilt::from_fn(|j| EncoderWatch::new(&sensed.encoders[j], &estimates[j]))
}
