//! Watches: detect faults of encoders, motors, the laser and the host.
//!
//! [`Fault::TABLE`] lists when and how soon each fault is detected and what follows; `docs/faults.md` is printed from it. A test
//! below compares its bounds with the constants here.

mod encoder;
mod foot;
mod knock;
mod laser;
mod motor;
mod scale;
mod scale_filter;

use tracelight_rig::{Fault, Joint, PanTilt, Sensed};

use crate::config::Config;
use crate::estimate::Estimate;
use crate::finding::Finding;
use crate::servo::Servo;
use encoder::EncoderWatch;
use foot::FootWatch;
pub use foot::{Foot, Sway};
use knock::KnockWatch;
pub(crate) use laser::LaserWatch;
pub use motor::MotorRating;
use motor::MotorWatch;
use scale::ScaleWatch;

/// Length from which on a tick is late, ticks: what was reckoned for one was held for another half.
const LATE_TICKS: f32 = 1.5;

/// State of all watches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Watch {
    encoders: PanTilt<EncoderWatch>,
    scales: PanTilt<ScaleWatch>,
    motors: PanTilt<MotorWatch>,
    foot: FootWatch,
    knocks: PanTilt<KnockWatch>,
    pub(crate) laser: LaserWatch,
    /// How long ago the host said that it is there, ticks; `None` if it never did.
    silence_ticks: Option<u32>,
}

impl Watch {
    pub(crate) fn new(config: &Config, sensed: &Sensed, estimates: &PanTilt<Estimate>) -> Self {
        Self {
            encoders: encoders(sensed, estimates),
            scales: scales(config, sensed, estimates),
            motors: PanTilt::default(),
            foot: FootWatch::default(),
            knocks: PanTilt::new(KnockWatch::new(), KnockWatch::new()),
            laser: LaserWatch::new(),
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

    /// What a tick's senses show of encoders, motors and the host, if anything; what they show of the laser is [`LaserWatch::sense`]'s.
    pub(crate) fn sense(&mut self, config: &Config, servo: &Servo, sensed: &Sensed) -> Option<Finding> {
        // silence is counted whatever else is wrong
        let silence = self.host(config);
        let stamped =
            |j: Joint| sensed.encoders[j].edge_age_ticks.is_none_or(|age| (0.0..1.0).contains(&age));
        if let Some(&j) = Joint::BOTH.iter().find(|&&j| !stamped(j) || !servo.estimates()[j].is_finite()) {
            return Some(Finding::of(Fault::NotANumber).by(j));
        }
        if let Some(lasted) = sensed.lasted_ticks.filter(|&lasted| is_late(lasted)) {
            // counts of more than a tick say nothing of encoders
            self.encoders = encoders(sensed, servo.estimates());
            return Some(Finding::beyond(Fault::TickLate, lasted, LATE_TICKS));
        }
        if config.drive.is_open_loop() {
            let sped_up = servo.estimates().map(|estimate| estimate.acceleration_rad_s2);
            let turned = self.foot.tick(&config.foot, sensed.foot_rad_s, sped_up);
            return silence.or(turned);
        }
        let encoder = |watch: &mut EncoderWatch, j: Joint| {
            watch.tick(&config.axes[j], &servo.efforts()[j], &servo.estimates()[j], &sensed.encoders[j])
        };
        let pan = encoder(&mut self.encoders.pan, Joint::Pan);
        let tilt = encoder(&mut self.encoders.tilt, Joint::Tilt);
        let (mut thrown, lit) = (None, self.laser.lights());
        for j in Joint::BOTH {
            let (axis, measured) = (&config.axes[j], &sensed.encoders[j]);
            let (effort, estimate) = (&servo.efforts()[j], &servo.estimates()[j]);
            let surprise = self.scales[j].tick(axis, effort, estimate, measured);
            if self.knocks[j].tick(axis, effort, estimate, measured, (surprise, lit)) {
                thrown = Some(j);
            }
        }
        let sped_up = servo.estimates().map(|estimate| estimate.acceleration_rad_s2);
        let turned = self.foot.tick(&config.foot, sensed.foot_rad_s, sped_up);
        // who has a gyroscope need not ask encoders
        let thrown = thrown.filter(|_| !self.foot.is_fitted()).map(|j| Finding::of(Fault::Bumped).by(j));
        // one by one: copies of what is rarely there take time in every tick
        if let Some(found) = pan {
            return Some(found.by(Joint::Pan));
        }
        if let Some(found) = tilt {
            return Some(found.by(Joint::Tilt));
        }
        if silence.is_some() {
            return silence;
        }
        if turned.is_some() { turned } else { thrown }
    }

    /// Whether an encoder has shown nothing where its joint should have passed several edges, or does not fit its motor.
    pub(crate) const fn is_doubtful(&self) -> bool {
        self.encoders.pan.is_doubtful() || self.encoders.tilt.is_doubtful()
    }

    /// Whether both encoders were seen to follow their motors, and nothing spoke against it since; of a head that has none, nothing ever does.
    pub(crate) fn is_tested(&self, config: &Config) -> bool {
        config.drive.is_open_loop() || (self.scales.pan.is_tested() && self.scales.tilt.is_tested())
    }

    /// Whether what the head stands on stands, as far as a gyroscope tells.
    pub(crate) const fn is_steady(&self) -> bool {
        self.foot.is_steady()
    }

    /// How far that has turned since it last stood still, rad about the head's x, y and z; `None` without a gyroscope.
    pub(crate) fn foot_turned_rad(&self) -> Option<[f32; 3]> {
        self.foot.turned_rad()
    }

    /// The head rests and is about to make its test move.
    pub(crate) fn begin_test(&mut self, config: &Config) {
        Joint::BOTH.into_iter().for_each(|j| self.scales[j].begin_test(&config.axes[j]));
    }

    /// Ends the test move and returns the fault it showed, if any.
    pub(crate) fn end_test(&mut self, config: &Config) -> Option<Finding> {
        let faults = PanTilt::from_fn(|j| self.scales[j].end_test(&config.axes[j]).map(|found| found.by(j)));
        faults.pan.or(faults.tilt)
    }

    fn host(&mut self, config: &Config) -> Option<Finding> {
        let silence = self.silence_ticks?.saturating_add(1);
        self.silence_ticks = Some(silence);
        (silence > config.host_lost_ticks)
            .then(|| Finding::after(Fault::HostLost, silence, config.host_lost_ticks))
    }

    /// What the volts of a tick show, if anything.
    pub(crate) fn drive(&mut self, config: &Config, servo: &Servo) -> Option<Finding> {
        let faults = PanTilt::from_fn(|j| {
            let (axis, beyond_v) = (&config.axes[j], servo.beyond_v()[j]);
            let share = beyond_v / axis.limit_v;
            let current = axis.current_share(share, servo.estimates()[j].velocity_rad_s);
            self.motors[j].tick(&axis.rating, share, current).map(|found| found.by(j))
        });
        faults.pan.or(faults.tilt)
    }

    /// Heat of the motors, as a share of what full drive makes of them.
    pub(crate) fn heat(&self) -> PanTilt<f32> {
        PanTilt::from_fn(|j| self.motors[j].heat())
    }

    /// Motors are as hot as they are, whatever controls them.
    pub(crate) fn set_heat(&mut self, heat: PanTilt<f32>) {
        Joint::BOTH.iter().for_each(|&j| self.motors[j].set_heat(heat[j]));
    }

    /// Begins anew after a fault.
    pub(crate) fn rearm(&mut self, config: &Config, sensed: &Sensed, estimates: &PanTilt<Estimate>) {
        self.encoders = encoders(sensed, estimates);
        let anew = scales(config, sensed, estimates);
        self.scales = PanTilt::from_fn(|j| anew[j].with_first(&self.scales[j]));
        self.foot.rearm();
        self.knocks = PanTilt::new(KnockWatch::new(), KnockWatch::new());
        Joint::BOTH.iter().for_each(|&j| self.motors[j].rearm());
    }
}

fn encoders(sensed: &Sensed, estimates: &PanTilt<Estimate>) -> PanTilt<EncoderWatch> {
    PanTilt::from_fn(|j| EncoderWatch::new(&sensed.encoders[j], &estimates[j]))
}

fn scales(config: &Config, sensed: &Sensed, estimates: &PanTilt<Estimate>) -> PanTilt<ScaleWatch> {
    PanTilt::from_fn(|j| ScaleWatch::new(&config.axes[j], &sensed.encoders[j], &estimates[j]))
}

/// Whether a tick of that length is late; one whose length is no number is.
fn is_late(lasted_ticks: f32) -> bool {
    lasted_ticks > LATE_TICKS || lasted_ticks.is_nan()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_rig::Soon;

    #[test]
    fn the_table_of_faults_has_the_bounds_of_the_watches() {
        let soon = |fault: Fault| fault.row().soon;
        let ticks = |ticks: u32| u16::try_from(ticks).unwrap_or(u16::MAX);
        assert_eq!(soon(Fault::EncoderDead), Soon::DarkThen(ticks(encoder::DOUBT_TICKS)));
        assert_eq!(soon(Fault::AmplifierSaturated), Soon::Ticks(ticks(motor::SATURATED_TICKS)));
        for fault in [Fault::LaserStuck, Fault::LaserDark] {
            assert_eq!(soon(fault), Soon::Ticks(ticks(laser::SLACK_TICKS + 1)));
        }
    }

    #[test]
    fn a_tick_is_late_over_one_and_a_half_of_its_length() {
        assert!(!is_late(1.0) && !is_late(1.5));
        assert!(is_late(1.51) && is_late(f32::INFINITY) && is_late(f32::NAN));
    }
}
