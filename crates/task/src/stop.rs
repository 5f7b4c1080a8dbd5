//! That work is to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::Failure;

/// Set once somebody wants a piece of work to end; its clones are set with it.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<State>);

#[derive(Debug, Default)]
struct State {
    wanted: AtomicBool,
    kept: AtomicUsize,
}

/// As long as this lives, work goes on that must come to its own end: a laser that is lit, results that belong together.
#[derive(Debug)]
pub struct Kept(Stop);

impl Stop {
    /// Wants it to end; whether that was wanted before.
    pub fn want(&self) -> bool {
        self.0.wanted.swap(true, Ordering::SeqCst)
    }

    /// Whether it is to end.
    #[must_use]
    pub fn is_wanted(&self) -> bool {
        self.0.wanted.load(Ordering::SeqCst)
    }

    /// # Errors
    /// [`Failure::interrupted`] if it is to end.
    pub fn check(&self) -> Result<(), Failure> {
        if self.is_wanted() { Err(Failure::interrupted()) } else { Ok(()) }
    }

    /// Until what is returned is dropped, nobody ends the process but by asking twice.
    #[must_use]
    pub fn keep(&self) -> Kept {
        self.0.kept.fetch_add(1, Ordering::SeqCst);
        Kept(self.clone())
    }

    /// Whether work goes on that must come to its own end.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        self.0.kept.load(Ordering::SeqCst) > 0
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        self.0.0.kept.fetch_sub(1, Ordering::SeqCst);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_must_come_to_its_own_end_is_known_until_it_has() {
        let stop = Stop::default();
        let (one, other) = (stop.clone().keep(), stop.keep());
        drop(one);
        assert!(stop.is_kept());
        drop(other);
        assert!(!stop.is_kept() && !stop.is_wanted());
        assert!(!stop.want() && stop.want() && stop.check().is_err());
    }
}
