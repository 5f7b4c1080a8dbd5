//! Orders that wait for their turn.

use tracelight_rig::wire::{Order, WINDOW};

/// First in, first out; no more than may be on their way at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Orders {
    kept: [Option<Order>; WINDOW as usize],
    first: usize,
    length: usize,
}

impl Orders {
    pub(crate) const fn new() -> Self {
        Self { kept: [None; WINDOW as usize], first: 0, length: 0 }
    }

    /// How many wait.
    pub(crate) const fn len(&self) -> usize {
        self.length
    }

    /// Keeps one; false if there is no room.
    pub(crate) fn push(&mut self, order: Order) -> bool {
        let length = self.kept.len();
        if self.length == length {
            return false;
        }
        if let Some(place) = self.kept.get_mut((self.first + self.length) % length) {
            *place = Some(order);
            self.length += 1;
        }
        true
    }

    /// The one whose turn it is.
    pub(crate) fn peek(&self) -> Option<&Order> {
        self.kept.get(self.first).and_then(Option::as_ref).filter(|_| self.length > 0)
    }

    /// Takes it.
    pub(crate) fn pop(&mut self) -> Option<Order> {
        let order = self.kept.get_mut(self.first).and_then(Option::take)?;
        self.first = (self.first + 1) % self.kept.len();
        self.length -= 1;
        Some(order)
    }
}
