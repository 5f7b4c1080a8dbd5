//! Ticks of a watched run that are not the drawing's: those of the dots by which its head is found again.

use tracelight_eye::power::lost_power;
use tracelight_eye::{Driven, Eye, Shot, refused};
use tracelight_session::{Request, Session};
use tracelight_sim::{Room, Tick, tick};
use tracelight_task::Failure;

use crate::watched::Watched;

/// A watched run whose images are for whoever has it, and whose ticks are kept in the log alone.
pub(crate) struct Aside<'a, 'b>(pub(crate) &'a mut Watched<'b>);

impl Driven for Aside<'_, '_> {
    type Rig = Room;

    fn session(&mut self) -> &mut Session<Room> {
        &mut self.0.session
    }

    fn step(&mut self) -> Result<Tick, Failure> {
        let watched = &mut *self.0;
        let mut tick = tick(&mut watched.session);
        if !watched.has_power(&tick) {
            return Err(lost_power());
        }
        tick.telemetry.plan_tick = watched.plan_tick;
        if !watched.log(&tick) {
            return Err(Failure::interrupted());
        }
        watched.listen();
        Ok(tick)
    }

    fn ask(&mut self, request: Request) -> Result<(), Failure> {
        if request == Request::Unhome {
            self.0.power.forget();
        }
        self.0.session.request(request).map_err(refused)
    }
}

impl Eye for Aside<'_, '_> {
    fn expose(&mut self, exposure_s: f64) {
        self.0.session.expose(exposure_s);
    }

    fn longest_s(&self) -> f64 {
        self.0.session.longest_s()
    }

    fn shot(&mut self) -> Option<Shot> {
        self.0.session.shot()
    }
}
