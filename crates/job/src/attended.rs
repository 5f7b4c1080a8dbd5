//! Somebody at the wall while a camera follows the spot.

use tracelight_session::{Refused, Request, State, seconds};

use crate::hands::{Ask, Look};
use crate::watched::{Looking, Watched, may_be_found_again};

/// What to do while the camera looks into what is off.
const WAIT: &str = "the camera looks into what is off; wait, or stop it";
/// What to do once that was stopped.
const GO_ON: &str = "arm first, then let it go on";

impl Watched<'_> {
    /// The camera begins to look into what is off, or is done with that. What it has drawn meanwhile is drawn as planned.
    pub(crate) fn look(&mut self, on: bool) {
        if on == self.looking.on {
            return;
        }
        let speed = if on { self.session.snapshot().speed } else { self.looking.speed };
        self.looking = Looking { on, speed, ..Looking::default() };
        let _ = self.session.request(Request::Speed(if on { 1.0 } else { speed }));
        self.hands.looks(if on { Look::Begun } else { Look::Over });
    }

    /// Waits in the dark until whoever stands there has armed and lets it begin, where he does that; who calls for the job has done both otherwise.
    pub(crate) fn await_hands(&mut self) {
        let arms = self.hands.arms() && !self.job.dry;
        while arms && !self.goes_on && !self.is_over() && self.hands.is_there() {
            self.step();
        }
        self.goes_on = false;
    }

    /// Tells whoever stands there what this tick was, and does what they ask.
    pub(crate) fn listen(&mut self) {
        let recovers = |fault| may_be_found_again(fault) && self.can_recover();
        if !self.held && self.session.told().fault().is_some_and(recovers) {
            self.look(true);
        }
        if self.looking.on && self.task.stop.is_wanted() {
            self.looking.stop.want();
        }
        let now = self.session.snapshot();
        if !self.looking.on {
            self.diary.watch(&now);
        }
        while let Some(event) = self.session.event() {
            if !self.looking.on {
                self.diary.write(&event, &now);
            }
            self.hands.event(&event);
        }
        let asked = self.hands.tick(&now);
        // strokes come one after the other by themselves
        let Some(Ask::Request(request)) = asked.filter(|_| !self.is_ended()) else { return };
        let answer = if self.looking.on { self.ask_looking(request) } else { self.ask_following(request) };
        if let Err(why) = answer {
            self.hands.refused(&why);
        }
    }

    /// Does what may be asked while a plan is followed. Where something is to be looked into first, or the plan begun again, that is done once
    /// somebody has armed.
    fn ask_following(&mut self, request: Request) -> Result<(), Refused> {
        let anew = self.due.is_some() || self.session.awaits_job();
        match (&request, self.session.state()) {
            (Request::Resume, State::Armed) if anew => {
                self.goes_on = true;
                self.session.request(Request::Disarm)
            }
            (Request::Resume, State::Paused) if anew && self.session.may_resume() => {
                self.goes_on = true;
                Ok(())
            }
            _ => self.session.request(request),
        }
    }

    /// Does what may be asked while the camera looks into what is off.
    fn ask_looking(&mut self, request: Request) -> Result<(), Refused> {
        let (state, is_stopped) = (self.session.state(), self.looking.stop.is_wanted());
        match request {
            Request::Stop | Request::Pause(_) => {
                self.looking.stop.want();
                self.session.request(Request::Stop)
            }
            Request::Resume if is_stopped && state == State::Armed => {
                self.goes_on = true;
                self.session.request(Request::Disarm)
            }
            Request::Arm | Request::Disarm | Request::Clear if is_stopped => self.session.request(request),
            request => {
                let advice = if is_stopped { GO_ON } else { WAIT };
                Err(Refused::State { request: request.name(), state, advice })
            }
        }
    }

    /// Whether somebody stopped the camera's looking into it, and wants it to go on now. Waits for them.
    pub(crate) fn is_to_look_again(&mut self) -> bool {
        let began = self.now;
        let waits = |watched: &Self| {
            let is_stopped = watched.looking.stop.is_wanted() && !watched.goes_on;
            is_stopped && !watched.is_ended() && watched.hands.is_there()
        };
        if waits(self) {
            self.hands.looks(Look::Stopped);
            // what it is looked into for is known
            let _ = self.session.request(Request::Clear);
        }
        while waits(self) {
            self.step();
        }
        if !std::mem::take(&mut self.goes_on) {
            return false;
        }
        let lasted_s = seconds(self.now.wrapping_sub(began));
        let note = format!(
            "the camera's look into it was stopped after {:.1} s, for {lasted_s:.1} s",
            seconds(began)
        );
        self.diary.notes.push(note);
        let speed = self.looking.speed;
        self.looking = Looking { on: true, speed, ..Looking::default() };
        self.hands.looks(Look::Begun);
        true
    }
}
