use std::collections::VecDeque;

use tracelight_rig::{Command, PanTilt, Rig, SPEED_RANGE, Telemetry};

use crate::event::{Event, Snapshot};
use crate::feed::{Trim, Untrimmed};
use crate::job::{Job, stroke_at};
use crate::outbox::Outbox;
use crate::request::{Refused, Request, When, advice};
use crate::running::Running;
use crate::state::{ARMED_TICKS, ATTENDED_TICKS, PAUSED_TICKS, State};

/// A head within this of where a job begins is there, rad: a little less than the controller allows.
pub(crate) const THERE_RAD: f32 = 1.5e-3;
/// Slower than this a head rests, rad/s.
const REST_RAD_S: f32 = 5e-3;
/// Slower than this a job may begin, rad/s: a head at rest hunts for its place within a count.
const START_RAD_S: f32 = 0.02;
/// Events that are kept for whoever does not fetch them; older ones go.
const MOST_EVENTS: usize = 4096;

/// One rig and at most one job.
#[derive(Clone, Debug)]
pub struct Session<R> {
    pub(crate) rig: R,
    pub(crate) state: State,
    /// The state in which it was armed, which comes back when that is over.
    pub(crate) armed_in: State,
    /// Tick in which it was armed, or paused, or the rig was asked to go on.
    pub(crate) since: u32,
    pub(crate) running: Option<Running>,
    /// What is begun once it is parked.
    pub(crate) next: Option<Job>,
    /// Tick in which something was asked last.
    pub(crate) asked: u32,
    pub(crate) speed: f32,
    pub(crate) told: Telemetry,
    pub(crate) outbox: Outbox,
    /// Tick in which the dot that is let out is over.
    pub(crate) mark_ends: u32,
    pub(crate) events: VecDeque<Event>,
}

impl<R: Rig> Session<R> {
    /// Takes over a rig, which is darkened. Before its first tick nothing is known of it.
    pub fn new(rig: R) -> Self {
        let mut session = Self {
            rig,
            state: State::Unhomed,
            armed_in: State::Unhomed,
            since: 0,
            running: None,
            next: None,
            asked: 0,
            speed: 1.0,
            told: Telemetry::default(),
            outbox: Outbox::default(),
            mark_ends: 0,
            events: VecDeque::new(),
        };
        session.send(Command::Disarm);
        session
    }

    /// The rig.
    pub const fn rig(&self) -> &R {
        &self.rig
    }

    /// The rig, for what is no command: a simulated one suffers faults, for instance.
    pub const fn rig_mut(&mut self) -> &mut R {
        &mut self.rig
    }

    /// What it does.
    pub const fn state(&self) -> State {
        self.state
    }

    /// The rig's last telemetry.
    pub const fn told(&self) -> &Telemetry {
        &self.told
    }

    /// The next event that was not fetched yet.
    pub fn event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Whether a job that was paused may go on without arming anew.
    pub fn may_resume(&self) -> bool {
        self.state == State::Paused && self.check_resume().is_ok()
    }

    /// Whether it is armed with no job in hand: whatever was to be done was stopped, or ended by a fault, before it began.
    pub fn awaits_job(&self) -> bool {
        self.state == State::Armed && self.running.is_none()
    }

    /// Where it stands.
    pub fn snapshot(&self) -> Snapshot {
        let job = self.running.as_ref();
        let armed = if self.state == State::Armed { ARMED_TICKS.saturating_sub(self.waited()) } else { 0 };
        Snapshot {
            state: self.state,
            tick: self.told.tick,
            homed: self.told.homed,
            gate: self.told.actuation.lights(),
            speed: self.speed,
            plan_tick: job.map_or(0, |running| running.plan_tick),
            plan_ticks: job.map_or(0, |running| running.ticks),
            stroke: job.and_then(|running| {
                stroke_at(&running.strokes, running.plan_tick).map(|at| at + running.first)
            }),
            strokes: job.map_or(0, |running| running.of),
            laps: job.map_or(0, |running| running.laps),
            armed_ticks: armed,
        }
    }

    /// Does what is asked, from the next tick on.
    ///
    /// # Errors
    /// Why it is refused; nothing has changed then.
    pub fn request(&mut self, request: Request) -> Result<(), Refused> {
        use State::{
            Armed, Done, Fault, Homing, Marking, Parking, Paused, Pausing, Ready, Returning, Stopped, Unhomed,
        };
        if self.outbox.is_full() && request != Request::Stop {
            return Err(Refused::Busy);
        }
        self.asked = self.told.tick;
        match (request, self.state) {
            (Request::Stop, _) => self.stop(),
            (Request::Speed(rate), _) => self.set_speed(rate)?,
            (Request::Home(counts), Unhomed | Homing | Ready | Done) => self.home(counts)?,
            (Request::Unhome, state) if state != State::Lost => self.unhome(),
            (Request::Arm, Unhomed | Ready | Done | Stopped | Paused) => {
                self.armed_in = self.state;
                self.since = self.told.tick;
                self.enter(Armed);
            }
            (Request::Disarm, Armed) => self.let_arming_go(),
            (Request::Seek, Armed) if self.armed_in == Unhomed => self.enter(Homing),
            (Request::Jog(job), Unhomed | Homing | Ready | Done)
                if self.state != Homing || self.running.is_none() =>
            {
                self.jog(job)?;
            }
            (Request::Trace(job), Ready | Done | Armed) if self.state != Armed || self.may_begin() => {
                self.begin(job)?;
            }
            (Request::Mark(ticks), Homing | Paused) => self.mark(ticks)?,
            (Request::Disarm, Homing) => self.send(Command::Disarm),
            (Request::Disarm, Marking) => {
                self.send(Command::Disarm);
                self.enter(Paused);
            }
            (Request::Resume, Armed) if self.is_resumable() => self.resume(),
            (Request::Resume, Paused | Stopped) => {
                self.check_resume()?;
                self.resume();
            }
            (Request::Next(job), Parking) if self.next.is_some() => {
                self.check_next(&job, self.next.as_ref().is_some_and(|next| next.dry))?;
                self.next = Some(job);
            }
            (Request::Next(job), state)
                if state == Armed && self.armed_in != Unhomed
                    || self.on().repeats()
                        && (state.repeats() || matches!(state, Returning | Pausing | Paused)) =>
            {
                self.check_next(&job, self.running.as_ref().is_some_and(|running| running.dry))?;
                self.park();
                self.next = Some(job);
            }
            (Request::Pause(when), state) if state.traces() || state == Returning => {
                self.send(if when == When::AtOnce { Command::Disarm } else { Command::Pause });
                self.enter(Pausing);
            }
            (Request::Pause(When::AtOnce), Pausing) => self.send(Command::Disarm),
            (Request::Clear, Fault) => self.clear(),
            (Request::Park, Unhomed | Homing | Ready | Done | Stopped | Paused) => self.park(),
            (request, state) => {
                return Err(Refused::State { request: request.name(), state, advice: advice(state) });
            }
        }
        Ok(())
    }

    /// Lets the rig run for a tick; `None` once it is gone.
    pub fn tick(&mut self) -> Option<Telemetry> {
        self.tick_by(R::next, Option::as_ref, &mut Untrimmed)
    }

    /// Lets a rig run for a tick that tells more of it than its telemetry, which is not there once the rig is gone; the job's segments are trimmed on their way.
    pub fn tick_by<T>(
        &mut self,
        step: impl FnOnce(&mut R) -> T,
        telemetry: impl FnOnce(&T) -> Option<&Telemetry>,
        trim: &mut impl Trim,
    ) -> T {
        self.before_tick(trim);
        let tick = step(&mut self.rig);
        match telemetry(&tick) {
            Some(&told) => {
                self.told = told;
                self.follow();
            }
            None => {
                self.running = None;
                self.outbox.clear();
                self.enter(State::Lost);
            }
        }
        tick
    }

    /// Sends what is due.
    fn before_tick(&mut self, trim: &mut impl Trim) {
        if self.state != State::Lost {
            self.send(Command::KeepAlive);
            if let Some(running) = &mut self.running
                && self.outbox.is_empty()
            {
                running.feed(&mut self.rig, trim);
            }
        }
    }

    /// Sends a command, behind those that the rig did not take yet.
    pub(crate) fn send(&mut self, command: Command) {
        self.outbox.send(command, &mut self.rig);
    }

    pub(crate) fn enter(&mut self, to: State) {
        let from = std::mem::replace(&mut self.state, to);
        if from != to {
            self.tell(Event::State { tick: self.told.tick, from, to });
        }
    }

    pub(crate) fn tell(&mut self, event: Event) {
        if self.events.len() >= MOST_EVENTS {
            self.events.pop_front();
        }
        self.events.push_back(event);
    }

    /// Ticks since it was armed, or paused, or the rig was asked to go on.
    pub(crate) const fn waited(&self) -> u32 {
        self.told.tick.wrapping_sub(self.since)
    }

    const fn is_resumable(&self) -> bool {
        matches!(self.armed_in, State::Stopped | State::Paused)
    }

    /// Whether it was armed for a job from its beginning.
    const fn may_begin(&self) -> bool {
        !self.is_resumable() && !matches!(self.armed_in, State::Unhomed)
    }

    fn let_arming_go(&mut self) {
        self.enter(self.armed_in);
        self.since = self.told.tick;
    }

    /// Refuses a job in the place of another one: light is allowed to whom it was allowed before, and not for ever.
    fn check_next(&self, job: &Job, before_was_dry: bool) -> Result<(), Refused> {
        check(job)?;
        if self.state == State::Armed {
            return Ok(());
        }
        self.check_resume()?;
        if before_was_dry && !job.dry { Err(Refused::NotArmed) } else { Ok(()) }
    }

    fn park(&mut self) {
        self.running = None;
        self.next = None;
        self.since = self.told.tick;
        self.send(Command::Abandon);
        self.enter(State::Parking);
    }

    fn stop(&mut self) {
        self.send(Command::Disarm);
        self.next = None;
        match self.state {
            State::Paused | State::Marking => self.enter(State::Stopped),
            state if state.is_on() => self.enter(State::Stopped),
            State::Homing | State::Jogging => {
                self.running = None;
                self.enter(if self.told.homed { State::Ready } else { State::Unhomed });
            }
            State::Armed if self.armed_in == State::Unhomed => self.enter(State::Unhomed),
            State::Armed if self.is_resumable() => self.enter(State::Stopped),
            State::Armed => self.enter(State::Ready),
            _ => {}
        }
    }

    fn set_speed(&mut self, rate: f32) -> Result<(), Refused> {
        if !(SPEED_RANGE.0..=SPEED_RANGE.1).contains(&rate) {
            return Err(Refused::Speed { asked: rate });
        }
        let least = self.running.as_ref().map_or(0.0, |running| running.slowest);
        // what is told as so many percent is taken as that
        if rate < least - 1e-4 {
            return Err(Refused::Slow { asked: rate, least });
        }
        self.speed = rate;
        if self.state != State::Lost {
            self.send(Command::Speed(rate));
        }
        Ok(())
    }

    fn home(&mut self, counts: PanTilt<i32>) -> Result<(), Refused> {
        if !self.outbox.is_empty() || self.rig.send(Command::Home(counts)).is_err() {
            return Err(Refused::Rig);
        }
        self.running = None;
        Ok(())
    }

    /// Lets a dot out where the head rests, if light was allowed before.
    fn mark(&mut self, ticks: u16) -> Result<(), Refused> {
        if self.state == State::Paused {
            self.check_resume()?;
            if self.running.as_ref().is_none_or(|running| running.dry) {
                return Err(Refused::NotArmed);
            }
            // the pause it is let out in is no longer by that
            self.mark_ends = self.told.tick.wrapping_add(u32::from(ticks));
            self.enter(State::Marking);
        }
        self.send(Command::Point(ticks));
        Ok(())
    }

    fn unhome(&mut self) {
        (self.running, self.next) = (None, None);
        self.send(Command::Unhome);
        if self.state != State::Fault {
            self.enter(State::Unhomed);
        }
    }

    fn clear(&mut self) {
        self.send(Command::KeepAlive);
        self.send(Command::Acknowledge { fault: self.told.fault_number });
    }

    /// Turns the head in the dark, from where it rests; of one that is not homed nobody knows where that is but by what it was told before.
    fn jog(&mut self, job: Job) -> Result<(), Refused> {
        check(&job)?;
        if self.told.homed {
            self.check_start(&job)?;
        }
        self.running = Some(Running::of(Job { dry: true, again: None, ..job }));
        self.arm_rig();
        if self.state != State::Homing {
            self.enter(State::Jogging);
        }
        Ok(())
    }

    fn begin(&mut self, job: Job) -> Result<(), Refused> {
        check(&job)?;
        if !job.dry && self.state != State::Armed {
            return Err(Refused::NotArmed);
        }
        self.start(job)
    }

    /// Begins a job where the head rests.
    pub(crate) fn start(&mut self, job: Job) -> Result<(), Refused> {
        self.check_start(&job)?;
        let slowest = job.slowest.min(1.0);
        self.running = Some(Running::of(job));
        // slowed before anybody knew what is drawn
        if self.speed < slowest {
            self.set_speed(slowest)?;
        }
        self.go_on();
        Ok(())
    }

    /// Refuses a job that begins elsewhere than where the head rests.
    fn check_start(&self, job: &Job) -> Result<(), Refused> {
        let Some(first) = job.segments.first() else { return Err(Refused::Empty) };
        let start = first.sample(0.0);
        let off = PanTilt::from_fn(|j| (start[j].position_rad - self.told.position_rad[j]).abs());
        let off_rad = off.pan.max(off.tilt);
        // what is not a number is nowhere
        if off_rad > THERE_RAD || off_rad.is_nan() {
            return Err(Refused::Elsewhere { off_rad });
        }
        if self.is_slower_than(START_RAD_S) { Ok(()) } else { Err(Refused::Moving) }
    }

    fn check_resume(&self) -> Result<(), Refused> {
        let is_dry = self.running.as_ref().is_some_and(|running| running.dry);
        match self.state {
            _ if is_dry => Ok(()),
            State::Paused if self.waited() > PAUSED_TICKS => Err(Refused::PausedLong),
            State::Stopped => Err(Refused::NotArmed),
            _ => Ok(()),
        }
    }

    /// Goes on where it was; a job that was just done is begun again when it is time.
    fn resume(&mut self) {
        let on = self.on();
        match &mut self.running {
            Some(running) if running.ended.is_some() => {
                running.answered = false;
                self.since = self.told.tick;
                self.enter(on);
            }
            _ => self.go_on(),
        }
    }

    /// A job begins, or goes on.
    pub(crate) fn go_on(&mut self) {
        self.arm_rig();
        self.enter(self.on());
    }

    fn arm_rig(&mut self) {
        let acknowledges = self.told.fault_number;
        self.send(Command::KeepAlive);
        self.send(Command::Arm { acknowledges });
        self.since = self.told.tick;
        if let Some(running) = &mut self.running {
            running.answered = false;
        }
    }

    /// The state of the job in hand while its clock runs.
    pub(crate) fn on(&self) -> State {
        let again = self.running.as_ref().and_then(|running| running.again.as_ref());
        again.map_or(State::Tracing, |again| again.what.state())
    }

    /// Begins a job again that is done again and again, once it was dark for long enough.
    pub(crate) fn begin_again(&mut self) {
        let is_ready = self.state.repeats() && !self.is_unattended() && self.rests();
        let Some(running) = self.running.as_mut().filter(|_| is_ready) else { return };
        let (Some(again), Some(ended)) = (&running.again, running.ended) else { return };
        let waited = self.told.tick.wrapping_sub(ended);
        // at half the speed there is twice the light in a place
        let wait_ticks = again.wait_ticks as f32 / self.speed.min(1.0);
        if (waited as f32) < wait_ticks {
            return;
        }
        running.begin_again();
        self.go_on();
    }

    /// Whether nothing was asked for so long that nobody may be there.
    pub(crate) const fn is_unattended(&self) -> bool {
        self.told.tick.wrapping_sub(self.asked) > ATTENDED_TICKS
    }

    /// Whether the joints rest, as far as the last telemetry tells.
    pub fn rests(&self) -> bool {
        self.is_slower_than(REST_RAD_S)
    }

    /// What is not a number is fast.
    fn is_slower_than(&self, rad_s: f32) -> bool {
        let PanTilt { pan, tilt } = self.told.velocity_rad_s;
        pan.abs() < rad_s && tilt.abs() < rad_s
    }
}

/// Refuses a job with nothing in it.
const fn check(job: &Job) -> Result<(), Refused> {
    if job.segments.is_empty() { Err(Refused::Empty) } else { Ok(()) }
}
