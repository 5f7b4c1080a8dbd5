//! Somebody at the wall while a camera follows the spot.

use tracelight_session::{Refused, Request, State};

use crate::hands::Ask;
use crate::watched::{Looking, Watched};

/// What to do while the camera looks into what is off.
const WAIT: &str = "the camera looks into what is off: wait, or stop";
/// What to do once that was stopped.
const GO_ON: &str = "arm and resume";

impl Watched<'_> {
    /// Whether anybody may still ask for anything.
    pub(crate) fn is_attended(&self) -> bool {
        self.hands.is_there()
    }

    /// The camera begins to look into what is off, or is done with that.
    pub(crate) fn look(&mut self, on: bool) {
        self.looking = Looking { on, ..Looking::default() };
        self.hands.looks(on);
    }

    /// Tells whoever stands there what this tick was, and does what they ask.
    pub(crate) fn listen(&mut self) {
        if self.looking.on && self.task.stop.is_wanted() {
            self.looking.stop.want();
        }
        let now = self.session.snapshot();
        self.diary.watch(&now);
        while let Some(event) = self.session.event() {
            if !self.looking.on {
                self.diary.write(&event, &now);
            }
            self.hands.event(&event);
        }
        let asked = self.hands.tick(&now);
        // strokes come one after the other by themselves
        let Some(Ask::Request(request)) = asked.filter(|_| !self.is_ended()) else { return };
        let answer = if self.looking.on { self.ask_looking(request) } else { self.session.request(request) };
        if let Err(why) = answer {
            self.hands.refused(&why);
        }
    }

    /// Does what may be asked while the camera looks into what is off.
    fn ask_looking(&mut self, request: Request) -> Result<(), Refused> {
        let (state, is_stopped) = (self.session.state(), self.looking.stop.is_wanted());
        match request {
            Request::Stop => {
                self.looking.stop.want();
                self.session.request(Request::Stop)
            }
            Request::Resume if is_stopped && state == State::Armed => {
                self.looking.goes_on = true;
                self.session.request(Request::Disarm)
            }
            Request::Arm | Request::Disarm | Request::Clear if is_stopped => self.session.request(request),
            Request::Speed(_) => self.session.request(request),
            request => {
                let advice = if is_stopped { GO_ON } else { WAIT };
                Err(Refused::State { request: request.name(), state, advice })
            }
        }
    }

    /// Whether somebody stopped the camera's looking into it, and wants it to go on now. Waits for them.
    pub(crate) fn is_to_look_again(&mut self) -> bool {
        while self.looking.stop.is_wanted() && !self.looking.goes_on {
            if self.is_ended() || !self.is_attended() {
                return false;
            }
            self.step();
        }
        let again = self.looking.goes_on;
        self.looking = Looking { on: true, ..Looking::default() };
        again
    }
}
