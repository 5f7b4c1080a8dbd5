use std::collections::VecDeque;

use tracelight_rig::{Command, Rig};

/// Commands that may wait for a rig which takes none.
const MOST_WAITING: usize = 16;

/// Commands that a rig did not take yet, in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outbox(VecDeque<Command>);

impl Outbox {
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn is_full(&self) -> bool {
        self.0.len() >= MOST_WAITING
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Sends a command, behind those that the rig did not take yet.
    pub(crate) fn send(&mut self, command: Command, rig: &mut impl Rig) {
        if command == Command::Disarm {
            // nothing that was asked before may come after it
            self.0.clear();
        }
        match self.0.back_mut() {
            // the newer one counts, and the same again adds nothing
            Some(last) if std::mem::discriminant(last) == std::mem::discriminant(&command) => *last = command,
            _ => self.0.push_back(command),
        }
        while let Some(&command) = self.0.front() {
            if rig.send(command).is_err() {
                return;
            }
            self.0.pop_front();
        }
    }
}
