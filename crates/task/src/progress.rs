//! How far work is, and what it is given to say so.

use crate::{Failure, Stop};

/// Who is told how far a piece of work is.
pub trait Progress: Sync {
    /// A stage of `steps` steps begins; of one step where nobody knows how far it is until it ends.
    fn stage(&self, name: &'static str, steps: u64);

    /// So many steps of the stage are done.
    fn at(&self, step: u64);

    /// A stage of `count` things begins, each of which has a name.
    fn things(&self, count: u64) {
        self.stage("", count);
    }

    /// One more of them has ended.
    fn finished(&self, name: &str) {
        let _ = name;
    }

    /// A remark that people should read.
    fn say(&self, message: &str);

    /// Seconds since some moment, by which is told how long work took; always the same where there is no clock.
    fn clock_s(&self) -> f64 {
        0.0
    }
}

/// Nobody.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {
    fn stage(&self, _: &'static str, _: u64) {}

    fn at(&self, _: u64) {}

    fn say(&self, _: &str) {}
}

/// What a piece of work is given by who has it done: whom it tells how far it is, and whether it is to stop.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// Told how far it is.
    pub progress: &'a dyn Progress,
    /// Set where it is to stop.
    pub stop: &'a Stop,
}

impl Task<'_> {
    /// As [`Progress::stage`].
    pub fn stage(&self, name: &'static str, steps: u64) {
        self.progress.stage(name, steps);
    }

    /// As [`Progress::at`].
    pub fn at(&self, step: u64) {
        self.progress.at(step);
    }

    /// As [`Progress::say`].
    pub fn say(&self, message: &str) {
        self.progress.say(message);
    }

    /// What `work` makes, and how long that took, ms.
    pub fn timed<T>(&self, work: impl FnOnce() -> T) -> (T, f64) {
        let began_s = self.progress.clock_s();
        let made = work();
        (made, 1e3 * (self.progress.clock_s() - began_s))
    }

    /// # Errors
    /// [`Failure::interrupted`] if it is to stop.
    pub fn check(&self) -> Result<(), Failure> {
        self.stop.check()
    }
}
