//! A rig that a session has in hand, and a camera that looks at what it does.

use tracelight_session::{Refused, Request, Session};
use tracelight_sim::{Simulated, Tick, tick};
use tracelight_task::Failure;

use crate::shot::Shot;

/// How long a head that is parked is given to come to rest, ticks.
const MOST_SETTLING_TICKS: u32 = 1000;

/// Something that takes images of the wall, by the clock of the rig's ticks.
pub trait Eye {
    /// How long each row is to be exposed from the next image on, s.
    fn expose(&mut self, exposure_s: f64);

    /// Longest that a row can be exposed, s.
    fn longest_s(&self) -> f64;

    /// The oldest image that is there and was not asked for yet.
    fn shot(&mut self) -> Option<Shot>;
}

/// A rig that a session has in hand, with a camera. There is no other way to move it or to let its light out.
pub trait Driven: Eye {
    /// The rig.
    type Rig: Simulated;

    /// What has it in hand.
    fn session(&mut self) -> &mut Session<Self::Rig>;

    /// One tick of it.
    ///
    /// # Errors
    /// The rig is gone, or whoever watches its ticks wants no more of them.
    fn step(&mut self) -> Result<Tick, Failure>;

    /// Lets ticks pass until the joints rest, which begin a job from there; after a second it begins or is refused as it is.
    ///
    /// # Errors
    /// As of [`step`](Self::step).
    fn settle(&mut self) -> Result<(), Failure> {
        for _ in 0..MOST_SETTLING_TICKS {
            if self.session().rests() {
                break;
            }
            self.step()?;
        }
        Ok(())
    }

    /// Asks its session.
    ///
    /// # Errors
    /// `session`: why that is refused.
    fn ask(&mut self, request: Request) -> Result<(), Failure> {
        self.session().request(request).map_err(refused)
    }
}

/// What a session refuses, as what ends a job.
#[must_use]
pub fn refused(why: Refused) -> Failure {
    Failure::failed("session", why.to_string())
}

impl<R: Simulated + Eye> Driven for Session<R> {
    type Rig = R;

    fn session(&mut self) -> &mut Self {
        self
    }

    fn step(&mut self) -> Result<Tick, Failure> {
        Ok(tick(self))
    }
}

impl<R: Simulated + Eye> Eye for Session<R> {
    fn expose(&mut self, exposure_s: f64) {
        self.rig_mut().expose(exposure_s);
    }

    fn longest_s(&self) -> f64 {
        self.rig().longest_s()
    }

    fn shot(&mut self) -> Option<Shot> {
        self.rig_mut().shot()
    }
}
