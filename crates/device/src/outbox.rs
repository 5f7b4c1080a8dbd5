//! Orders on their way: sent in their turn, again if they are lost, kept until the board says in which tick it took them.

use std::collections::VecDeque;

use tracelight_rig::Command;
use tracelight_rig::wire::{Ask, Order, WINDOW, is_before};

/// After so long without an answer all that is on its way is sent again, µs.
const AGAIN_US: u64 = 20_000;
/// Orders that wait until there is room on the way.
const MOST_WAITING: usize = 256;

/// What a host has asked for and the board has not yet said it took.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outbox {
    /// From the oldest that is not known to be taken on.
    orders: VecDeque<Order>,
    /// Number of the next order.
    next: u16,
    /// Number of the next order that is put on the way.
    unsent: u16,
    /// Number that the board waits for.
    wanted: u16,
    /// Segments that the board had room for when it said so.
    free: u16,
    /// What belongs to a job whose Arm was lost with its connection: it waits for the next one.
    held: Vec<Ask>,
    /// When the board last took something, or something was put on its way, µs.
    moved_us: u64,
}

impl Outbox {
    /// Number of the next order.
    pub(crate) const fn next(&self) -> u16 {
        self.next
    }

    /// Whether an order may be put here: a segment only if the board surely has room for it, so that what follows it never waits.
    pub(crate) fn has_room(&self, ask: Ask) -> bool {
        if !is_segment(ask) {
            return self.orders.len() < MOST_WAITING;
        }
        let coming = self
            .orders
            .iter()
            .filter(|order| !is_before(order.sequence, self.wanted) && is_segment(order.ask));
        let held = self.held.len();
        usize::from(self.in_flight()) + held < usize::from(WINDOW)
            && coming.count() + held < usize::from(self.free)
    }

    /// Whether any of them lets light out.
    pub(crate) fn lights(&self) -> bool {
        self.orders.iter().any(|order| order.ask.lights())
    }

    /// Orders that the board has not yet received, as far as is known.
    fn in_flight(&self) -> u16 {
        self.next.wrapping_sub(self.wanted)
    }

    pub(crate) fn push(&mut self, ask: Ask) {
        match ask {
            Ask::Command(Command::Append(_) | Command::Finish) if !self.held.is_empty() => {
                self.held.push(ask)
            }
            Ask::Command(Command::Abandon | Command::Unhome) => {
                self.held.clear();
                self.order(ask);
            }
            Ask::Arm { .. } => {
                self.order(ask);
                std::mem::take(&mut self.held).into_iter().for_each(|ask| self.order(ask));
            }
            Ask::Command(_) => self.order(ask),
        }
    }

    fn order(&mut self, ask: Ask) {
        self.orders.push_back(Order { sequence: self.next, ask });
        self.next = self.next.wrapping_add(1);
    }

    /// The next order to put on its way now, if there is one, of those before that number.
    pub(crate) fn send(&mut self, now_us: u64, before: Option<u16>) -> Option<Order> {
        let is_lost = self.wanted != self.unsent && now_us.saturating_sub(self.moved_us) >= AGAIN_US;
        if is_lost {
            (self.unsent, self.moved_us) = (self.wanted, now_us);
        }
        let waits = before.is_some_and(|before| !is_before(self.unsent, before));
        if waits || self.unsent == self.next || self.unsent.wrapping_sub(self.wanted) >= WINDOW {
            return None;
        }
        let order = *self.orders.iter().find(|order| order.sequence == self.unsent)?;
        if self.unsent == self.wanted {
            self.moved_us = now_us;
        }
        self.unsent = self.unsent.wrapping_add(1);
        Some(order)
    }

    /// The board says which it wants next, and how many segments it has room for.
    pub(crate) fn hear(&mut self, wanted: u16, free: u16, now_us: u64) {
        // what is no answer to anything that was sent is of another time
        let is_possible = !is_before(wanted, self.wanted) && !is_before(self.unsent, wanted);
        if !is_possible {
            return;
        }
        if wanted != self.wanted {
            (self.wanted, self.moved_us) = (wanted, now_us);
        }
        self.free = free;
    }

    /// The orders that the board took before a tick, as many as it says; `None` if there are not so many.
    pub(crate) fn take(&mut self, count: u8) -> Option<Vec<Order>> {
        (usize::from(count) <= self.orders.len()).then(|| self.orders.drain(..usize::from(count)).collect())
    }

    /// After a new greeting: what was not taken is sent from number 0 on, but for what would let light out, and for where a head was then. What was sent behind
    /// an Arm that was lost waits for another.
    pub(crate) fn begin_again(&mut self) {
        let Self { orders, held, .. } = std::mem::take(self);
        let mut is_lost = false;
        for ask in orders.into_iter().map(|order| order.ask) {
            let is_of_job = matches!(ask, Ask::Command(Command::Append(_) | Command::Finish));
            match ask {
                Ask::Arm { .. } => is_lost = true,
                Ask::Command(Command::Point(_) | Command::Home(_)) => {}
                _ if is_lost && is_of_job => self.held.push(ask),
                _ => self.push(ask),
            }
        }
        self.held.extend(held);
    }
}

const fn is_segment(ask: Ask) -> bool {
    matches!(ask, Ask::Command(Command::Append(_)))
}
