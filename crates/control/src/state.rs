//! What a controller remembers.

use tracelight_rig::{Fault, Joint, PanTilt, Phase, Sensed, Setpoint};

use crate::config::Config;
use crate::creep::Pace;
use crate::estimate::Estimate;
use crate::light_budget::LightBudget;
use crate::player::{Player, QUEUE_LENGTH};
use crate::return_path::ReturnPath;
use crate::servo::Servo;
use crate::supervisor::{Supervisor, rests};
use crate::test_move::TestMove;
use crate::watch::Watch;

/// What the controller remembers from tick to tick. It holds this many segments ahead of time: a board that a wire feeds holds more than one that
/// is fed in its own memory.
#[derive(Clone, Copy, Debug)]
pub struct State<const SEGMENTS: usize = QUEUE_LENGTH> {
    pub(crate) tick: u32,
    /// No tick has passed yet: what is sensed in the first is what it started with.
    pub(crate) fresh: bool,
    pub(crate) sensed: Sensed,
    pub(crate) servo: Servo,
    pub(crate) watch: Watch,
    pub(crate) player: Player<SEGMENTS>,
    pub(crate) supervisor: Supervisor,
    pub(crate) budget: LightBudget,
    pub(crate) way_back: Option<ReturnPath>,
    pub(crate) paces: PanTilt<Pace>,
    pub(crate) test_move: Option<TestMove>,
    /// What is added to what the encoders read, since the head was homed.
    pub(crate) home: PanTilt<i32>,
}

/// What outlives a controller: see [`State::carried`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Carried {
    /// Heat of the motors, as a share of what full drive makes of them.
    pub heat: PanTilt<f32>,
    /// How long ago the laser's gate fell, ticks; `u32::MAX` of one that was never open.
    pub shut_ticks: u32,
}

impl<const SEGMENTS: usize> State<SEGMENTS> {
    /// Starts the tick count at another number than 0, as after a long uptime.
    pub const fn count_from(&mut self, tick: u32) {
        self.tick = tick;
    }

    /// Estimates of both joints.
    pub const fn estimates(&self) -> &PanTilt<Estimate> {
        self.servo.estimates()
    }

    /// Where the joints of a head on [`Drive::Pulses`](crate::Drive::Pulses) are to be at the start of the last tick, and how they are to move until its
    /// end.
    pub const fn told(&self) -> &PanTilt<Setpoint> {
        self.servo.told()
    }

    /// Segments that there is room for.
    pub const fn room(&self) -> usize {
        self.player.room()
    }

    /// Counts at which the head stands when its encoders read this, if it is homed and nothing moves it: where it can be told that it is.
    pub fn homed_at(&self, sensed: &Sensed) -> Option<PanTilt<i32>> {
        let fault = self.supervisor.latched.map(|record| record.fault);
        let is_off =
            matches!(self.supervisor.phase, Phase::Dark | Phase::Done) || fault == Some(Fault::HostLost);
        let rates = self.servo.estimates().map(|estimate| estimate.velocity_rad_s);
        let is_still = self.supervisor.homed && is_off && rests(rates);
        let counts = |j: Joint| sensed.encoders[j].count.wrapping_add(self.home[j]);
        is_still.then(|| PanTilt::from_fn(counts))
    }

    /// Whether so many ticks of a plan are there, or all of it, or as much as there is room for.
    pub fn has_ahead(&self, ticks: u32) -> bool {
        self.player.has_ahead(ticks)
    }

    /// What a controller that begins anew with the same head must not forget.
    pub fn carried(&self) -> Carried {
        Carried { heat: self.watch.heat(), shut_ticks: self.budget.shut_ticks() }
    }

    /// In how many ticks there may be light again where none fell yet, as after a controller that knew where it fell; 0 where there may be now.
    pub fn opens_in_ticks(&self, config: &Config) -> u32 {
        self.budget.opens_in_ticks(config)
    }

    /// Whether a dot is wanted.
    pub const fn is_pointing(&self) -> bool {
        self.supervisor.is_pointing()
    }

    /// Whether it is known where the joints are.
    pub const fn is_homed(&self) -> bool {
        self.supervisor.homed
    }

    /// What is added to the counts that are read, since the head was homed.
    pub const fn home(&self) -> &PanTilt<i32> {
        &self.home
    }
}
