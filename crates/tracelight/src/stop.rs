//! Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;

/// Set once the user wants the program to end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Listens from now on. A second Ctrl-C ends the process at once.
    pub(crate) fn listen() -> Self {
        let stop = Self::default();
        let flag = Arc::clone(&stop.0);
        let armed = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::SeqCst) {
                std::process::exit(130);
            }
        });
        // without a handler Ctrl-C ends the process by itself, which is dark too: every rig darkens without a host
        drop(armed);
        stop
    }

    /// Whether the user pressed Ctrl-C.
    pub(crate) fn is_wanted(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }

    /// An error if the user pressed Ctrl-C.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if self.is_wanted() { Err(Failure::interrupted()) } else { Ok(()) }
    }
}
