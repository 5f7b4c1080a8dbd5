use tracelight_rig::{
    Darkness, DarknessSet, Fault, FaultRecord, Joint, PanTilt, Phase, Segment, Sensed, Setpoint,
};

use crate::config::Config;
use crate::finding::Finding;
use crate::switch_test::SwitchTest;
use crate::watch::LaserWatch;

/// Share of the tolerance within which a head that left its stroke counts as back on it.
const RETURN_SHARE: f32 = 0.25;
/// Speed below which it counts as at rest there, rad/s.
const RETURN_RATE_RAD_S: f32 = 0.02;
/// How long it must stay there, ticks: four time constants of the default loop are 67.
const RETURN_TICKS: u32 = 60;
/// Ticks without a hold after which the next one is another.
const CALM_TICKS: u32 = 500;
/// How long it is dark at least from one dot of a head of which nobody knows where it points to another, ticks.
const UNHOMED_REST_TICKS: u32 = 100;
/// Test moves that may tell nothing: whoever leans on a head that long does not let it go back.
const MOST_TESTS: u32 = 8;
/// Distance in tolerances at which a head is lost on its way in the dark, too.
const LOST_TOLERANCES: f32 = 10.0;

/// Where the supervisor stands, and for how long.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Supervisor {
    pub(crate) phase: Phase,
    pub(crate) latched: Option<FaultRecord>,
    /// A fault, the first or a later one, left nothing to control the motors by.
    pub(crate) blind: bool,
    /// The encoders know where the joints are.
    pub(crate) homed: bool,
    /// How many faults were latched since power-up, of each kind one while another is latched.
    pub(crate) fault_number: u32,
    /// The kinds that came since somebody armed, a bit each.
    kinds: u64,
    /// Whether the laser's switches were seen to do what they are told, since power-up and since they did not.
    switches: SwitchTest,
    held_ticks: u32,
    /// Since the last hold.
    calm_ticks: u32,
    settled_ticks: u32,
    /// Test moves since an encoder was last trusted.
    tests: u32,
    /// The job was stopped on its way, and the head rested since: an encoder at rest knows its angle to a count only, and who stopped it may have touched it.
    rested: bool,
    /// For how long a dot is still wanted while it is disarmed.
    pointing_ticks: u32,
    /// Since the last dot.
    dotless_ticks: u32,
}

/// What the supervisor judges a tick by.
pub(crate) struct Situation<'a> {
    pub(crate) tick: u32,
    pub(crate) setpoint: &'a PanTilt<Setpoint>,
    pub(crate) segment: Option<&'a Segment>,
    pub(crate) position_rad: PanTilt<f32>,
    pub(crate) rate_rad_s: PanTilt<f32>,
    pub(crate) error_rad: PanTilt<f32>,
    /// An encoder shows nothing where it should.
    pub(crate) doubtful: bool,
    /// Both encoders were seen to follow their motors, and nothing spoke against it since.
    pub(crate) tested: bool,
    /// What the head stands on stands, as far as a gyroscope tells.
    pub(crate) steady: bool,
    /// The laser's switches were tried, or cannot be, or need not yet.
    pub(crate) tried: bool,
    /// No host has said of late that it is there.
    pub(crate) host_silent: bool,
    /// The plan's clock is about to stop, with light that is still on its way out.
    pub(crate) runs_on: bool,
    /// The plan wants the gate open, at the rate of its clock.
    pub(crate) planned: bool,
    /// What the gate lets through now falls where the plan wants light, however slowly its clock runs.
    pub(crate) light_due: bool,
    /// The plan's clock has left its start.
    pub(crate) begun: bool,
    /// So much of the plan is there that it may begin.
    pub(crate) may_begin: bool,
    /// Segments ran out and more were promised.
    pub(crate) starved: bool,
    /// Segments ran out as announced.
    pub(crate) done: bool,
}

/// What the plan's clock is to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Clock {
    /// Runs, after a stop gently.
    Run,
    /// Stands still until it may run again.
    Stop,
    /// Has not begun, or is over, or is about to stop.
    Wait,
}

impl Supervisor {
    /// Latches a fault; the first one stays, and what any of them means for the motors and for what counts are worth. One that
    /// lasts, and trips in every tick, is one.
    #[cold]
    pub(crate) fn trip(&mut self, tick: u32, found: Finding) {
        let Finding { fault, joint, exceeded } = found;
        let kind = 1_u64 << fault.number();
        if self.kinds & kind == 0 {
            self.kinds |= kind;
            self.fault_number = self.fault_number.wrapping_add(1);
        }
        let number = self.fault_number;
        self.latched.get_or_insert(FaultRecord { fault, number, tick, joint, exceeded });
        self.blind |= fault.leaves_motors_blind();
        self.homed &= !fault.loses_counts();
        if matches!(fault, Fault::LaserStuck | Fault::LaserDark) {
            self.switches = SwitchTest::default();
        }
        self.phase = Phase::Faulted;
    }

    /// Allows light; a fault is forgotten, but for its number and for counts that it lost.
    pub(crate) fn arm(&mut self) {
        if matches!(self.phase, Phase::Dark | Phase::Done | Phase::Faulted) {
            let Self { homed, fault_number, switches, .. } = *self;
            *self = Self { phase: Phase::Armed, homed, fault_number, switches, ..Self::default() };
        }
    }

    pub(crate) fn disarm(&mut self) {
        if self.phase != Phase::Faulted {
            self.phase = Phase::Dark;
            self.pointing_ticks = 0;
        }
    }

    /// A dot is wanted from now on, where the plan's clock stands; of an unhomed head anywhere.
    pub(crate) fn point(&mut self, ticks: u32) {
        if self.phase != Phase::Dark {
            self.pointing_ticks = 0;
        } else if self.homed {
            self.pointing_ticks = ticks;
        } else if self.pointing_ticks == 0 && self.dotless_ticks >= UNHOMED_REST_TICKS {
            // a host that asks again and again does not get light that stays
            self.pointing_ticks = ticks;
        }
    }

    /// Whether a dot is wanted.
    pub(crate) const fn is_pointing(&self) -> bool {
        self.pointing_ticks > 0
    }

    /// The encoders know from now on where the joints are, which rest, without a job.
    pub(crate) fn home(&mut self) {
        self.homed = true;
        self.pointing_ticks = 0;
    }

    /// Nobody knows any more where the joints are.
    pub(crate) fn unhome(&mut self) {
        self.disarm();
        self.homed = false;
        self.pointing_ticks = 0;
    }

    /// One tick: moves between phases and says what the clock does.
    pub(crate) fn tick(&mut self, config: &Config, at: &Situation<'_>) -> Clock {
        if !config.may_be_at(at.position_rad, self.homed) && self.phase != Phase::Dark {
            self.trip(at.tick, beyond_range(config, at, self.homed));
        }
        self.pointing_ticks = if at.host_silent { 0 } else { self.pointing_ticks.saturating_sub(1) };
        self.dotless_ticks = if self.pointing_ticks > 0 { 0 } else { self.dotless_ticks.saturating_add(1) };
        match self.phase {
            // a job that was disarmed on its way goes on only from where it stopped, a new one from where it begins
            Phase::Armed if at.segment.is_some() && (at.begun || strayed(at)) => {
                self.rested = at.begun && !config.drive.is_open_loop();
                self.begin_hold();
            }
            Phase::Armed if at.segment.is_some() && at.may_begin && !at.host_silent => {
                self.phase = Phase::Tracing
            }
            Phase::Tracing if at.done => self.phase = Phase::Done,
            Phase::Tracing if at.starved => self.trip(at.tick, Finding::of(Fault::SetpointsStale)),
            Phase::Tracing if must_hold(at) => self.begin_hold(),
            Phase::Holding => self.hold(config, at),
            Phase::Tracing => self.calm(),
            _ => {}
        }
        match self.phase {
            Phase::Tracing => Clock::Run,
            Phase::Holding if at.runs_on => Clock::Wait,
            Phase::Holding | Phase::Testing | Phase::Faulted => Clock::Stop,
            Phase::Dark | Phase::Armed | Phase::Done => Clock::Wait,
        }
    }

    /// The little move in the dark is over.
    pub(crate) fn end_test(&mut self) {
        self.rested = false;
        if self.phase == Phase::Testing {
            self.begin_hold();
        }
    }

    /// The plan's clock stands from now on until the head is back and nothing speaks against going on.
    pub(crate) fn begin_hold(&mut self) {
        self.phase = Phase::Holding;
        self.calm_ticks = 0;
        self.settled_ticks = 0;
    }

    /// Holds that follow each other soon are one: what comes back again and again does not get its time anew.
    const fn calm(&mut self) {
        self.calm_ticks = self.calm_ticks.saturating_add(1);
        if self.calm_ticks > CALM_TICKS {
            self.held_ticks = 0;
        }
    }

    fn hold(&mut self, config: &Config, at: &Situation<'_>) {
        self.tests = if at.tested { 0 } else { self.tests };
        // who waits for its host is not late
        self.held_ticks = self.held_ticks.saturating_add(u32::from(!at.host_silent));
        self.settled_ticks = if returned(at) { self.settled_ticks + 1 } else { 0 };
        let is_back = self.settled_ticks >= RETURN_TICKS && !at.host_silent;
        let is_sure = at.tested && !self.rested;
        if is_back && is_sure && at.tried {
            self.phase = Phase::Tracing;
        } else if is_back && !is_sure && self.tests < MOST_TESTS {
            self.phase = Phase::Testing;
            self.tests += 1;
        } else if self.held_ticks > config.hold_limit_ticks {
            let found = Finding::after(Fault::HoldTimedOut, self.held_ticks, config.hold_limit_ticks);
            self.trip(at.tick, found);
        } else if is_back && !at.tested {
            self.trip(at.tick, Finding::of(Fault::HoldTimedOut));
        }
    }

    /// Whether there may be light at all, now or soon: the second switch. Judged after [`tick`](Self::tick), as the gate is.
    pub(crate) fn may_light(&self, steady: bool) -> bool {
        let armed = matches!(self.phase, Phase::Armed | Phase::Tracing | Phase::Holding);
        let may_point = self.phase == Phase::Dark && self.pointing_ticks > 0;
        self.latched.is_none() && steady && (armed || may_point)
    }

    /// What both switches of the laser are told in this tick, the gate's first, of which `lit` says whether it is to be lit. Armed, both stay open
    /// until a plan has light to come, and are tried then; whoever asks for a dot of a head that was never armed looks himself.
    pub(crate) fn drive_switches(
        &mut self,
        config: &Config,
        watch: &LaserWatch,
        (sensed, light_queued): (&Sensed, bool),
        (lit, steady): (bool, bool),
    ) -> (bool, bool) {
        let may_light = self.may_light(steady);
        if self.phase != Phase::Dark && !self.switches.is_over(sensed) {
            // light that goes through a switch that is stuck falls where that is known
            if may_light && self.homed && light_queued {
                return self.switches.tick(config, watch);
            }
            self.switches.pause();
            return (false, false);
        }
        self.switches.pause();
        (lit, may_light)
    }

    /// Whether both switches were seen to do what they are told, or nothing sees it, or no light is to go through them.
    pub(crate) fn are_tried(&self, sensed: &Sensed, light_queued: bool) -> bool {
        self.switches.is_over(sensed) || !self.homed || !light_queued
    }

    /// Whether a switch of the laser did not open, and it is known where the head is: nobody knows whether the other one holds.
    pub(crate) const fn must_park(&self) -> bool {
        self.homed && self.kinds & (1 << Fault::LaserStuck.number()) != 0
    }

    /// Every reason against light in this tick. The gate is open only if there is none.
    pub(crate) fn darkness(&self, config: &Config, at: &Situation<'_>) -> DarknessSet {
        let mut reasons = DarknessSet::default();
        let waits = self.phase == Phase::Dark && self.pointing_ticks > 0 && is_still(at);
        let points = waits && (at.begun || !self.homed);
        // no plan knows where that falls
        let seeks = points && !self.homed;
        reasons.insert_if(!at.planned && !seeks, Darkness::Planned);
        reasons.insert_if(!self.homed && !seeks, Darkness::Unhomed);
        reasons.insert_if(self.phase == Phase::Dark && !points, Darkness::Disarmed);
        reasons.insert_if(beyond_tolerance(at), Darkness::FollowingError);
        reasons.insert_if(strayed(at), Darkness::SpotError);
        // a dot may be let out by a head that was never moved: whoever asks for it looks where it is
        reasons.insert_if(!(at.tested || points), Darkness::Untested);
        reasons.insert_if(!at.tried && self.phase != Phase::Dark, Darkness::Untested);
        reasons.insert_if(at.doubtful, Darkness::Doubtful);
        reasons.insert_if(!at.steady, Darkness::Jolted);
        let held = matches!(self.phase, Phase::Holding | Phase::Testing);
        reasons.insert_if(held || !(at.light_due || points), Darkness::Holding);
        let asked = at.setpoint.map(|s| s.position_rad);
        reasons.insert_if(!config.may_be_at(asked, self.homed), Darkness::OutOfBounds);
        let idle = matches!(self.phase, Phase::Armed | Phase::Done);
        let stale = idle || at.starved || at.segment.is_none();
        reasons.insert_if(stale && !seeks, Darkness::Stale);
        reasons.insert_if(self.latched.is_some(), Darkness::Faulted);
        reasons.insert_if(at.host_silent, Darkness::HostSilent);
        reasons
    }
}

/// The fault of a joint that is believed outside its range.
#[cold]
fn beyond_range(config: &Config, at: &Situation<'_>, homed: bool) -> Finding {
    let found = |j: Joint| {
        let ((lower, upper), value) = (config.range_rad(j, homed), at.position_rad[j]);
        let bound = if value < lower { lower } else { upper };
        let is_within = lower <= value && value <= upper;
        (!is_within).then(|| Finding::beyond(Fault::LimitReached, value, bound).by(j))
    };
    Joint::BOTH.into_iter().find_map(found).unwrap_or(Finding::of(Fault::LimitReached))
}

fn tolerance(at: &Situation<'_>) -> Option<PanTilt<f32>> {
    at.segment.map(|s| s.tolerance_rad)
}

fn beyond_tolerance(at: &Situation<'_>) -> bool {
    tolerance(at)
        .is_some_and(|t| exceeds(at.error_rad.pan.abs(), t.pan) || exceeds(at.error_rad.tilt.abs(), t.tilt))
}

/// Square of the spot's distance from its setpoint as a share of what is allowed: the tolerances are the semi-axes, in joint
/// terms, of the allowed circle on the target.
fn spot_error_squared(at: &Situation<'_>) -> f32 {
    tolerance(at).map_or(0.0, |t| {
        let off = PanTilt::from_fn(|j| at.error_rad[j] / t[j]);
        off.pan * off.pan + off.tilt * off.tilt
    })
}

fn strayed(at: &Situation<'_>) -> bool {
    exceeds(spot_error_squared(at), 1.0)
}

/// Whether the plan's clock must stand until the head is back: where there is to be light, off the stroke or in doubt of
/// an encoder or the laser's switches. In the dark nothing is lost, and to stop a fast move and begin it again halfway takes more torque than to
/// go on.
fn must_hold(at: &Situation<'_>) -> bool {
    let lit = at.segment.is_some_and(|segment| segment.gate);
    let lost = exceeds(spot_error_squared(at), LOST_TOLERANCES * LOST_TOLERANCES);
    let unsure = at.doubtful || !at.tested || !at.tried || !at.steady;
    (lit && (strayed(at) || unsure)) || lost
}

/// Whether a value is beyond its bound; what is not a number is.
fn exceeds(value: f32, bound: f32) -> bool {
    value > bound || value.is_nan() || bound.is_nan()
}

fn is_still(at: &Situation<'_>) -> bool {
    rests(at.rate_rad_s)
}

/// Whether joints of these speeds are as good as at rest.
pub(crate) fn rests(rate_rad_s: PanTilt<f32>) -> bool {
    rate_rad_s.pan.abs().max(rate_rad_s.tilt.abs()) < RETURN_RATE_RAD_S
}

fn returned(at: &Situation<'_>) -> bool {
    is_still(at) && !at.doubtful && at.steady && spot_error_squared(at) < RETURN_SHARE * RETURN_SHARE
}
