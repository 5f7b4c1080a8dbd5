//! Somebody at the wall: what they ask, and what they are told.

use tracelight_session::{Event, Refused, Request, Snapshot};
use tracelight_stroke::{Place, Point};

/// What somebody at the wall asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Ask {
    /// Of the session.
    Request(Request),
    /// Another stroke, where strokes are drawn one at a time.
    Step(Step),
}

/// How a camera looks into what is suddenly off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// A look begins, or begins again.
    Begun,
    /// Somebody stopped it: it begins again once they have armed and let it go on.
    Stopped,
    /// A look is done, and the job goes on or ends.
    Over,
}

impl Look {
    /// Stable name for scripts.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Begun => "begun",
            Self::Stopped => "stopped",
            Self::Over => "over",
        }
    }
}

/// What a camera has seen of the light while it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Where the spot was seen last, m on the target.
    pub seen: Point,
    /// Where it was asked to be then, m.
    pub asked: Point,
    /// How far the spot was off in the last images, at most twenty-five of them, m, root of the mean square.
    pub rms_m: f64,
    /// Images in which it was seen until now.
    pub images: usize,
}

/// Which stroke comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// This one is done, and the one after it comes.
    Next,
    /// The one before it.
    Previous,
    /// This one is left as it is, and the one after it comes.
    Skip,
    /// The one of that number, from 0.
    To(u32),
}

/// Nobody: the job runs by itself, as fast as its rig does.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nobody;

impl Hands for Nobody {
    fn tick(&mut self, _: &Snapshot) -> Option<Ask> {
        None
    }

    fn event(&mut self, _: &Event) {}

    fn refused(&mut self, _: &Refused) {}

    fn is_there(&self) -> bool {
        false
    }
}

/// Somebody at the wall while a lap runs.
pub trait Hands {
    /// Told after each tick, and may wait, so that a simulated rig keeps real time. Returns what is asked, if anything is.
    fn tick(&mut self, now: &Snapshot) -> Option<Ask>;

    /// Told what happened.
    fn event(&mut self, event: &Event);

    /// Told why a request was refused.
    fn refused(&mut self, why: &Refused);

    /// Told that a stroke or a point was left, by its number from 0, and whether it is done.
    fn left(&mut self, _number: u32, _done: bool) {}

    /// Told that the head sets off to a point, by its number from 0 of so many.
    fn goes_to(&mut self, _point: &Place, _number: u32, _of: u32) {}

    /// Told that the frame of the drawing is drawn again and again from now on, until [`Step::Next`] is asked for, or that it is over.
    fn frames(&mut self, _on: bool) {}

    /// Told how a camera looks into what is suddenly off, in the dark or by dots: meanwhile nothing but to stop can be asked.
    fn looks(&mut self, _look: Look) {}

    /// Told what a camera has seen of the light, some times a second.
    fn sees(&mut self, _sighting: &Sighting) {}

    /// Whether they arm before the first light; otherwise who starts the job has done that.
    fn arms(&self) -> bool {
        false
    }

    /// Whether anything may still be asked; otherwise a lap that is stopped, or that a fault ended, is over.
    fn is_there(&self) -> bool;
}
