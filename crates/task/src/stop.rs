//! That work is to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::Failure;

/// Set once somebody wants a piece of work to end; its clones are set with it.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Wants it to end; whether that was wanted before.
    pub fn want(&self) -> bool {
        self.0.swap(true, Ordering::SeqCst)
    }

    /// Whether it is to end.
    #[must_use]
    pub fn is_wanted(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// # Errors
    /// [`Failure::interrupted`] if it is to end.
    pub fn check(&self) -> Result<(), Failure> {
        if self.is_wanted() { Err(Failure::interrupted()) } else { Ok(()) }
    }
}
