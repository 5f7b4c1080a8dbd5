//! Both halves, for whoever has one thread.

use tracelight_rig::{Actuation, Sensed};

use crate::machine::Machine;
use crate::server::{Identity, Server};

/// A board that holds so many segments ahead, and can tell so many rows again: a power of two.
#[derive(Clone, Debug)]
pub struct Board<const SEGMENTS: usize, const ROWS: usize> {
    server: Server<SEGMENTS, ROWS>,
    machine: Machine<SEGMENTS>,
}

impl<const SEGMENTS: usize, const ROWS: usize> Board<SEGMENTS, ROWS> {
    /// At power-up.
    pub const fn new(identity: Identity) -> Self {
        Self { server: Server::new(identity), machine: Machine::new() }
    }

    /// What happens every tick.
    pub const fn machine(&self) -> &Machine<SEGMENTS> {
        &self.machine
    }

    /// Turns a bit of the configuration in force, as [`Machine::spoil`].
    pub fn spoil(&mut self, word: usize, bit: u32) -> bool {
        self.machine.spoil(word, bit)
    }

    /// What speaks with the host.
    pub const fn server(&self) -> &Server<SEGMENTS, ROWS> {
        &self.server
    }

    /// Takes bytes of the host, which came so many µs after the last tick began.
    pub fn take(&mut self, bytes: &[u8], tick_us: u16) {
        self.server.take(bytes, tick_us);
    }

    /// Writes bytes for the host, in whole packets; how many.
    pub fn give(&mut self, out: &mut [u8]) -> usize {
        self.server.give(out)
    }

    /// One tick: what the head senses at its start, and what is done until the next.
    pub fn tick(&mut self, sensed: &Sensed) -> Actuation {
        let Self { server, machine } = self;
        let (new, inbox) = (server.new_configuration(), server.inbox());
        let (actuation, told) = machine.tick(sensed, (new.as_ref(), &inbox), |may| server.next_order(may));
        server.ticked(machine.tick_number(), machine.nonce());
        if let Some(told) = told {
            server.told(&told);
        }
        actuation
    }
}
