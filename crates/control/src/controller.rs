use tracelight_rig::{
    Actuation, Command, Darkness, DarknessSet, Fault, Joint, Measurement, PanTilt, Phase, Sensed, Setpoint,
    Telemetry,
};

use crate::config::{Config, UNHOMED_RAD};
use crate::estimate::Estimate;
use crate::finding::Finding;
use crate::light_budget::{LightBudget, longest_dot_ticks};
use crate::player::{Played, Player};
use crate::return_path::ReturnPath;
use crate::servo::{Reference, Servo};
use crate::state::{Carried, State};
use crate::supervisor::{Clock, Situation, Supervisor, rests};
use crate::test_move::TestMove;
use crate::watch::Watch;

/// The controller: its configuration, fixed at start.
#[derive(Clone, Copy, Debug)]
pub struct Controller {
    config: Config,
}

impl Controller {
    /// What it is told.
    pub const fn config(&self) -> &Config {
        &self.config
    }

    /// Makes a controller from a configuration that the caller has checked.
    pub const fn new(config: Config) -> Self {
        Self { config }
    }

    /// State of a head at rest whose encoders are known to count from zero: homed, dark, disarmed, held where it is.
    pub fn start_homed<const SEGMENTS: usize>(&self, sensed: &Sensed) -> State<SEGMENTS> {
        let mut state: State<SEGMENTS> = self.start(sensed);
        self.trust(&mut state);
        state
    }

    /// State of a head at rest that was just powered up and reports `sensed`: unhomed, dark, disarmed, held where it is.
    pub fn start<const SEGMENTS: usize>(&self, sensed: &Sensed) -> State<SEGMENTS> {
        let servo = Servo::at_rest(&self.config, &sensed.encoders);
        State {
            tick: 0,
            fresh: true,
            sensed: *sensed,
            servo,
            watch: Watch::new(&self.config, sensed, servo.estimates()),
            player: Player::resting_at(servo.position_rad()),
            supervisor: Supervisor::default(),
            budget: LightBudget::new(),
            way_back: None,
            paces: PanTilt::default(),
            test_move: None,
            home: PanTilt::default(),
        }
    }

    /// Makes a state that of a head as in [`start`](Self::start), in place: with its queue it is too large for the stack of a tick.
    pub fn restart<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, sensed: &Sensed) {
        // every field, or it is not compiled
        let State {
            tick,
            fresh,
            sensed: last,
            servo,
            watch,
            player,
            supervisor,
            budget,
            way_back,
            paces,
            test_move,
            home,
        } = state;
        (*tick, *fresh, *last) = (0, true, *sensed);
        *servo = Servo::at_rest(&self.config, &sensed.encoders);
        *watch = Watch::new(&self.config, sensed, servo.estimates());
        player.begin_anew(servo.position_rad());
        (*supervisor, *budget) = (Supervisor::default(), LightBudget::new());
        (*way_back, *paces, *test_move, *home) = (None, PanTilt::default(), None, PanTilt::default());
    }

    /// Takes the encoders of a state that has just begun to count from zero: it is homed.
    pub fn trust<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>) {
        state.supervisor.home();
    }

    /// Has a state that has just begun remember what the one before it knew of the head; where light fell then is not known any more, so it may have been anywhere.
    pub fn carry<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, carried: &Carried) {
        state.watch.set_heat(carried.heat);
        state.budget = LightBudget::spent(&self.config, carried.shut_ticks);
    }

    /// Takes a command, or gives it back when the queue is full, or when a head is to be homed that is armed, moves, or can
    /// not be there. A segment that does not join the last one, or leaves its bounds anywhere, is taken
    /// and latches a fault. Arming that acknowledges other faults than there were, and arming and a dot without a host that is there, are taken and change nothing.
    pub fn accept<const SEGMENTS: usize>(
        &self,
        state: &mut State<SEGMENTS>,
        command: Command,
    ) -> Result<(), Command> {
        match command {
            Command::Arm { acknowledges } => self.arm(state, acknowledges),
            Command::Acknowledge { fault } => {
                if state.supervisor.latched.is_some() {
                    self.arm(state, fault);
                    self.disarm(state);
                }
            }
            Command::Disarm => self.disarm(state),
            Command::Pause if state.supervisor.phase == Phase::Tracing => state.player.pause(true),
            Command::Pause => self.disarm(state),
            Command::Speed(rate) => state.player.ask_rate(rate),
            Command::Point(_) if !state.watch.hears_host(&self.config) => {}
            Command::Point(ticks) => self.point(state, u32::from(ticks)),
            Command::Home(counts) if !self.may_home(state, counts) => return Err(command),
            Command::Home(counts) => self.home(state, counts),
            Command::Unhome => {
                state.supervisor.unhome();
                state.budget.turn(&self.config);
                state.player.hold();
            }
            Command::Abandon => {
                state.supervisor.disarm();
                state.player.abandon();
                state.way_back = Some(ReturnPath::from(&state.servo.departure(&self.config)));
            }
            Command::KeepAlive => state.watch.hear(),
            Command::Finish => state.player.finish(),
            Command::Append(_) if !state.player.has_room() => return Err(command),
            Command::Append(segment) => {
                if !self.config.may_run(&segment, state.supervisor.homed) || !state.player.append(segment) {
                    state.supervisor.trip(state.tick, Finding::of(Fault::SetpointInvalid));
                }
            }
        }
        Ok(())
    }

    fn arm<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, acknowledges: u32) {
        let read = acknowledges == state.supervisor.fault_number;
        if !read || !state.watch.hears_host(&self.config) || state.sensed.inputs.any_open() {
            return;
        }
        if state.supervisor.latched.is_some() {
            if state.supervisor.blind {
                // what was believed is not worth keeping
                state.servo = state.servo.anew(&self.config, &state.sensed.encoders);
                state.budget.turn(&self.config);
            }
            state.watch.rearm(&self.config, &state.sensed, state.servo.estimates());
            // from wherever it fell to, gently
            state.way_back = Some(ReturnPath::from(&state.servo.departure(&self.config)));
        }
        if state.supervisor.phase != Phase::Tracing {
            state.player.stop_in(0);
            state.player.reopen();
        }
        state.player.pause(false);
        state.supervisor.arm();
    }

    /// Forbids light, and stops the plan's clock once what is still on its way out has fallen on its stroke.
    fn disarm<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>) {
        let is_on_stroke = state.supervisor.phase == Phase::Tracing && state.watch.laser.lights();
        state.supervisor.disarm();
        if !state.player.runs_on() {
            // both switches open, and the faster one ends it
            let on_its_way = self.config.laser_off_ticks.min(self.config.enable_off_ticks);
            state.player.stop_in(if is_on_stroke { on_its_way } else { 0 });
        }
    }

    /// Stops the plan's clock in the same way until the host is heard again. The gate alone opens: whoever is heard soon goes on soon.
    fn wait_for_host<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>) {
        let lit = state.watch.laser.lights();
        state.supervisor.begin_hold();
        state.player.stop_in(if lit { self.config.laser_off_ticks } else { 0 });
    }

    /// A dot; of a head that is not homed, one that there is room for, or none.
    fn point<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, ticks: u32) {
        if state.supervisor.homed {
            return state.supervisor.point(ticks);
        }
        let ticks = ticks.min(longest_dot_ticks(&self.config));
        if state.supervisor.phase != Phase::Dark || state.budget.has_room(&self.config, ticks) {
            state.supervisor.point(ticks);
        }
    }

    /// Whether the joints rest, unarmed, and may be at these counts.
    fn may_home<const SEGMENTS: usize>(&self, state: &State<SEGMENTS>, counts: PanTilt<i32>) -> bool {
        let is_possible = |j: Joint| {
            let (axis, at) = (&self.config.axes[j], counts[j] as f32 * self.config.axes[j].count_rad);
            (axis.limits.lower_rad - UNHOMED_RAD..=axis.limits.upper_rad + UNHOMED_RAD).contains(&at)
        };
        state.supervisor.phase == Phase::Dark
            && rests(state.servo.estimates().map(|estimate| estimate.velocity_rad_s))
            && Joint::BOTH.into_iter().all(is_possible)
    }

    /// Reads encoders from these counts from now on; what was believed before is of other angles.
    fn home<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, counts: PanTilt<i32>) {
        for j in Joint::BOTH {
            let measured = &mut state.sensed.encoders[j];
            state.home[j] = state.home[j].wrapping_add(counts[j].wrapping_sub(measured.count));
            measured.count = counts[j];
        }
        state.servo = Servo::at_rest(&self.config, &state.sensed.encoders);
        state.watch.rearm(&self.config, &state.sensed, state.servo.estimates());
        state.player.rest_at(state.servo.position_rad());
        state.way_back = None;
        state.test_move = None;
        state.paces = PanTilt::default();
        state.budget.turn(&self.config);
        state.supervisor.home();
    }

    /// One tick. `sensed` is what the head reports at its start; the returned telemetry carries what to do until its
    /// end. The first tick after [`start`](Self::start) takes the same.
    pub fn tick<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, sensed: &Sensed) -> Telemetry {
        let sensed = &from_home(sensed, &state.home);
        self.observe(state, sensed);
        if state.supervisor.phase == Phase::Tracing {
            if state.player.may_pause(self.config.laser_off_ticks) {
                self.disarm(state);
            } else if !state.watch.hears_host(&self.config) {
                self.wait_for_host(state);
            }
        }
        let played = state.player.play();
        let estimates = *state.servo.estimates();
        let situation = self.situation(state, &played);
        let clock = state.supervisor.tick(&self.config, &situation);
        let command_v = self.drive(state, &played);
        // last of all: whatever this tick has shown is known
        let mut darkness = state.supervisor.darkness(&self.config, &situation);
        self.keep_budget(state, &estimates, &mut darkness);
        let actuation = self.actuation(state, command_v, darkness.is_empty());
        let telemetry = Telemetry {
            tick: state.tick,
            plan_tick: state.player.plan_tick(),
            measured: sensed.encoders,
            inputs: sensed.inputs,
            setpoint: played.setpoint,
            position_rad: estimates.map(|estimate| estimate.position_rad),
            velocity_rad_s: estimates.map(|estimate| estimate.velocity_rad_s),
            acceleration_rad_s2: estimates.map(|estimate| estimate.acceleration_rad_s2),
            lost_counts: estimates.map(|estimate| estimate.lost_counts),
            foot_turned_rad: state.watch.foot_turned_rad(),
            actuation,
            darkness,
            homed: state.supervisor.homed,
            phase: state.supervisor.phase,
            latched: state.supervisor.latched,
            fault_number: state.supervisor.fault_number,
        };
        run_clock(&mut state.player, clock);
        state.tick = state.tick.wrapping_add(1);
        telemetry
    }

    /// Volts, and what the laser's switches are told; `lit` is whether nothing speaks against light.
    fn actuation<const SEGMENTS: usize>(
        &self,
        state: &mut State<SEGMENTS>,
        command_v: PanTilt<f32>,
        lit: bool,
    ) -> Actuation {
        let State { supervisor, watch, sensed, player, .. } = state;
        let at = (&*sensed, player.has_light());
        let (gate, enable) =
            supervisor.drive_switches(&self.config, &watch.laser, at, (lit, watch.is_steady()));
        let actuation = Actuation { command_v, gate, enable };
        watch.laser.tell(&actuation);
        actuation
    }

    fn observe<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, sensed: &Sensed) {
        state.sensed = *sensed;
        // before all that may come of them: a motor without a supply looks like a dead encoder
        for input in sensed.inputs.opened() {
            let found = Finding { joint: input.joint(), ..Finding::of(input.fault()) };
            state.supervisor.trip(state.tick, found);
        }
        if core::mem::take(&mut state.fresh) {
            return;
        }
        state.servo.observe(&self.config, &sensed.encoders);
        let known_rad = state.supervisor.homed.then(|| state.servo.position_rad());
        let laser = &state.watch.laser;
        let seen = laser.seen_light(&self.config, sensed);
        state.budget.tick(&self.config, known_rad, laser.lights(), seen);
        let laser = laser.sense(&self.config, sensed);
        if let Some(found) = state.budget.asked_too_long() {
            state.supervisor.trip(state.tick, found);
        }
        if let Some(found) = state.watch.sense(&self.config, &state.servo, sensed) {
            // who knows nothing of where it stands has nothing to lose
            if found.fault != Fault::Bumped || state.supervisor.homed {
                state.supervisor.trip(state.tick, found);
            }
        }
        // whatever else is wrong, a switch that is stuck is known
        if let Some(found) = laser {
            state.supervisor.trip(state.tick, found);
        }
    }

    /// Makes it dark where light would stand, if it were not dark anyway.
    fn keep_budget<const SEGMENTS: usize>(
        &self,
        state: &mut State<SEGMENTS>,
        estimates: &PanTilt<Estimate>,
        darkness: &mut DarknessSet,
    ) {
        let place = state.supervisor.homed.then(|| {
            (
                estimates.map(|estimate| estimate.position_rad),
                estimates.map(|estimate| estimate.velocity_rad_s),
            )
        });
        let stands = darkness.is_empty() && state.budget.is_spent(&self.config, place);
        darkness.insert_if(stands, Darkness::Standing);
        state.budget.ask(stands && state.supervisor.phase == Phase::Tracing);
    }

    fn situation<'a, const SEGMENTS: usize>(
        &self,
        state: &State<SEGMENTS>,
        played: &'a Played,
    ) -> Situation<'a> {
        let position_rad = state.servo.position_rad();
        Situation {
            tick: state.tick,
            setpoint: &played.setpoint,
            segment: played.segment.as_ref(),
            position_rad,
            rate_rad_s: state.servo.estimates().map(|estimate| estimate.velocity_rad_s),
            error_rad: PanTilt::from_fn(|j| played.setpoint[j].position_rad - position_rad[j]),
            doubtful: state.watch.is_doubtful(),
            tested: state.watch.is_tested(&self.config),
            steady: state.watch.is_steady(),
            tried: state.supervisor.are_tried(&state.sensed, state.player.has_light()),
            host_silent: !state.watch.hears_host(&self.config),
            runs_on: state.player.runs_on(),
            planned: state.player.wants_light(self.config.laser_on_ticks, self.config.laser_off_ticks),
            light_due: state.player.light_is_due(self.config.laser_on_ticks),
            begun: state.player.has_begun(),
            may_begin: state.player.has_ahead(self.config.lead_ticks),
            starved: state.player.is_empty() && !state.player.is_done(),
            done: state.player.is_done(),
        }
    }

    /// Volts for this tick; none when there is nothing to control by.
    fn drive<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, played: &Played) -> PanTilt<f32> {
        let reference = self.reference(state, played);
        if state.supervisor.blind {
            let none = state.servo.coast();
            // joints that nothing holds go where they like, and nobody counts it
            state.supervisor.homed &= !self.config.drive.is_open_loop();
            // a motor cools meanwhile; what it still is too hot for is known
            let _ = state.watch.drive(&self.config, &state.servo);
            return none;
        }
        let volts = state.servo.drive(&self.config, &reference);
        let unsound = (!state.servo.is_sound()).then_some(Finding::of(Fault::NotANumber));
        if let Some(found) = unsound.or(state.watch.drive(&self.config, &state.servo)) {
            state.supervisor.trip(state.tick, found);
        }
        volts
    }

    /// Where the loop is to go now and half a tick later: along the plan, or, when its clock stands, gently back to
    /// where it stands; with a laser that does not go dark, to where it is to be parked.
    fn reference<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, played: &Played) -> Reference {
        let stands = match state.supervisor.phase {
            Phase::Holding => !state.player.runs_on(),
            Phase::Testing | Phase::Faulted => true,
            Phase::Dark | Phase::Armed => {
                !state.player.runs_on()
                    && (state.way_back.is_some() || (state.player.has_begun() && played.segment.is_some()))
            }
            Phase::Tracing | Phase::Done => false,
        };
        if !stands {
            state.way_back = None;
            return self.along(state, played);
        }
        state.paces = PanTilt::default();
        if let Some(reference) = self.test(state, played) {
            return reference;
        }
        let position_rad = state.servo.position_rad();
        let kept = state.way_back.filter(|w| !w.is_lost(&self.config, position_rad));
        let mut way = kept.unwrap_or_else(|| {
            state.servo.forget();
            ReturnPath::from(state.servo.estimates())
        });
        let park = self.config.park_rad.filter(|_| state.supervisor.must_park());
        let goal = park.map_or(played.setpoint, |park| park.map(Setpoint::at_rest));
        let now = way.tick(&self.config, &goal);
        state.way_back = Some(way);
        Reference { now, ahead: now }
    }

    /// A little way to and fro from where the plan's clock stands, by which encoders show whether they follow their motors.
    fn test<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, played: &Played) -> Option<Reference> {
        if state.supervisor.phase != Phase::Testing {
            state.test_move = None;
            return None;
        }
        let test_move = state.test_move.get_or_insert_with(|| {
            state.watch.begin_test(&self.config);
            TestMove::from(&self.config, &played.setpoint)
        });
        let reference = test_move.tick();
        if test_move.is_over() {
            state.test_move = None;
            state.way_back = None;
            state.supervisor.end_test();
            if let Some(found) = state.watch.end_test(&self.config) {
                state.supervisor.trip(state.tick, found);
            }
        }
        Some(reference)
    }

    /// Along the plan, from rest to rest where that is slower than friction lets go.
    fn along<const SEGMENTS: usize>(&self, state: &mut State<SEGMENTS>, played: &Played) -> Reference {
        let mut reference = Reference { now: played.setpoint, ahead: played.ahead };
        for j in Joint::BOTH {
            if let Some(creep) = &self.config.axes[j].creep {
                let planned = (&played.setpoint[j], &played.ahead[j]);
                let State { paces, servo, player, .. } = &mut *state;
                let later_rad = |ticks| player.later_rad(j, ticks);
                let (now, ahead) = paces[j].tick(creep, &servo.estimates()[j], planned, later_rad);
                (reference.now[j], reference.ahead[j]) = (now, ahead);
            }
        }
        reference
    }
}

/// What is sensed, with counts from where the head was homed.
fn from_home(sensed: &Sensed, home: &PanTilt<i32>) -> Sensed {
    let encoders = PanTilt::from_fn(|j| Measurement {
        count: sensed.encoders[j].count.wrapping_add(home[j]),
        ..sensed.encoders[j]
    });
    Sensed { encoders, ..*sensed }
}

fn run_clock<const SEGMENTS: usize>(player: &mut Player<SEGMENTS>, clock: Clock) {
    match clock {
        Clock::Run => player.advance(),
        Clock::Stop => player.hold(),
        Clock::Wait => player.run_on(),
    }
}
