//! What a tick means for the state.

use tracelight_rig::{Command, PanTilt, Phase, Rig, Telemetry};

use crate::event::Event;
use crate::session::{Session, THERE_RAD};
use crate::state::{ARMED_TICKS, PAUSED_TICKS, State};

/// How long a rig may take to say that it is armed, ticks: a wire and a queue in between.
const ANSWER_TICKS: u32 = 250;

impl<R: Rig> Session<R> {
    /// What the last tick means for the state.
    pub(crate) fn follow(&mut self) {
        let Telemetry { tick, latched, homed, .. } = self.told;
        if let Some(record) = latched {
            self.next = None;
            if self.state != State::Fault {
                self.tell(Event::Fault(record));
                self.enter(State::Fault);
            }
            return;
        }
        if !homed {
            self.follow_unhomed();
            return;
        }
        if self.state == State::Jogging {
            if self.follow_jog() {
                self.enter(State::Ready);
            }
            return;
        }
        self.follow_job();
        self.begin_again();
        match self.next_state() {
            State::Ready => {
                self.running = None;
                self.enter(State::Ready);
                // whoever asked for it armed the one before; what is held up for long is armed anew
                let next = self.next.take().filter(|job| job.dry || self.waited() <= PAUSED_TICKS);
                if let Some(Err(why)) = next.map(|job| self.start(job)) {
                    self.tell(Event::NotBegun { tick, why });
                }
            }
            State::Done if self.state.repeats() => {
                self.running = None;
                self.send(Command::Disarm);
                self.enter(State::Done);
            }
            State::Paused if self.state == State::Pausing => {
                self.since = tick;
                self.enter(State::Paused);
            }
            next => self.enter(next),
        }
    }

    /// What a tick without a fault means of a rig that is not homed.
    fn follow_unhomed(&mut self) {
        self.next = None;
        match self.state {
            State::Homing | State::Jogging => {
                let is_over = self.follow_jog();
                if is_over && self.state == State::Jogging {
                    self.enter(State::Unhomed);
                }
            }
            State::Parking if !self.is_parked() => {}
            State::Armed if self.armed_in == State::Unhomed && self.waited() < ARMED_TICKS => {}
            _ => {
                self.running = None;
                self.enter(State::Unhomed);
            }
        }
    }

    /// Where a head is that is turned in the dark: disarmed at its end. Whether it is not turned any more.
    fn follow_jog(&mut self) -> bool {
        let (told, waited) = (self.told, self.waited());
        let Some(running) = &mut self.running else { return true };
        running.follow(&told);
        let answered = running.answered;
        if answered && told.phase == Phase::Done {
            self.send(Command::Disarm);
        }
        let rests = matches!(told.phase, Phase::Done | Phase::Dark);
        if rests && (answered || waited > ANSWER_TICKS) {
            self.running = None;
        }
        self.running.is_none()
    }

    /// The state after a tick without a fault of a rig that is homed.
    fn next_state(&self) -> State {
        let phase = self.told.phase;
        let answered = self.running.as_ref().is_some_and(|running| running.answered);
        let is_again = self.on().repeats();
        // between two times it is dark, and waits
        let has_ended = self.running.as_ref().is_some_and(|running| running.ended.is_some());
        match self.state {
            // what was just told to forget may not have heard it yet
            State::Unhomed | State::Homing if self.outbox.is_empty() => State::Ready,
            State::Armed if self.armed_in == State::Unhomed => State::Ready,
            State::Marking if self.is_marked() || phase != Phase::Dark => State::Paused,
            State::Fault if self.has_begun() => State::Stopped,
            State::Fault => State::Ready,
            State::Armed if self.waited() >= ARMED_TICKS => self.armed_in,
            State::Pausing if is_again && phase == Phase::Done => State::Paused,
            state if state.repeats() && has_ended && self.is_unattended() => State::Done,
            State::Tracing | State::Returning | State::Pausing
                if answered && !is_again && phase == Phase::Done =>
            {
                State::Done
            }
            // an open interlock, for instance, keeps it from arming
            state
                if (state.traces() || state == State::Returning)
                    && phase == Phase::Dark
                    && !has_ended
                    && (answered || self.waited() > ANSWER_TICKS) =>
            {
                State::Stopped
            }
            state if state.traces() && matches!(phase, Phase::Holding | Phase::Testing) => State::Returning,
            State::Returning if matches!(phase, Phase::Tracing | Phase::Done) => self.on(),
            State::Pausing if phase == Phase::Dark => State::Paused,
            State::Parking if self.is_parked() => State::Ready,
            state => state,
        }
    }

    fn is_marked(&self) -> bool {
        self.told.tick.wrapping_sub(self.mark_ends).cast_signed() > 0
    }

    fn has_begun(&self) -> bool {
        self.running.as_ref().is_some_and(|running| running.plan_tick > 0)
    }

    fn is_parked(&self) -> bool {
        let PanTilt { pan, tilt } = self.told.position_rad;
        pan.abs().max(tilt.abs()) < THERE_RAD && self.rests()
    }

    /// Where the job is now.
    fn follow_job(&mut self) {
        let is_on = self.state.is_on();
        let Some(running) = self.running.as_mut().filter(|_| is_on) else { return };
        let of = running.of;
        if let Some(stroke) = running.follow(&self.told) {
            self.tell(Event::Stroke { tick: self.told.tick, stroke, of });
        }
    }
}
