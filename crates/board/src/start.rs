//! How a controller begins by a configuration.

use tracelight_control::{Carried, Controller, State};
use tracelight_rig::{Command, PanTilt, Sensed};

/// What a controller begins with, on a board and in the twin that follows it: both do the same with the same.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Number of its first tick.
    pub tick: u32,
    /// Whether the encoders know where they are.
    pub is_absolute: bool,
    /// Counts at which the head is told to stand, if it is held to be where it was.
    pub home: Option<PanTilt<i32>>,
    /// What was known of the head before.
    pub carried: Option<Carried>,
}

impl Start {
    /// The state before the first tick, in which this is sensed. Homed, if the encoders are absolute or the head can be where it is told to stand.
    pub fn state<const SEGMENTS: usize>(&self, controller: &Controller, sensed: &Sensed) -> State<SEGMENTS> {
        let mut state = controller.start(sensed);
        self.apply(controller, &mut state);
        state
    }

    /// Makes a state that one, in place.
    pub fn renew<const SEGMENTS: usize>(
        &self,
        controller: &Controller,
        sensed: &Sensed,
        state: &mut State<SEGMENTS>,
    ) {
        controller.restart(state, sensed);
        self.apply(controller, state);
    }

    /// What is different from a head that was just powered up.
    pub(crate) fn apply<const SEGMENTS: usize>(&self, controller: &Controller, state: &mut State<SEGMENTS>) {
        state.count_from(self.tick);
        if self.is_absolute {
            controller.trust(state);
        }
        if let Some(home) = self.home {
            // what cannot be is refused, and then it is not homed
            let _ = controller.accept(state, Command::Home(home));
        }
        if let Some(carried) = &self.carried {
            controller.carry(state, carried);
        }
    }
}
