//! Both halves, for a chip whose ticks interrupt what speaks with the host.
//!
//! The [`Ticker`] runs in the timer's interrupt, the [`Speaker`] in the main loop. Values pass [between](Between) them by queues with one writer and one
//! reader, so that neither ever waits for the other: a tick takes what was handed over in whole, and what it has done waits until the loop looks.

use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use heapless::spsc::{Consumer, Producer, Queue};
use tracelight_rig::wire::{Ask, Order, WINDOW};
use tracelight_rig::{Actuation, Command, Motors, PanTilt, Phase, Sensed};

use crate::machine::{Disarm, Inbox, Machine, May, NewConfiguration, Told};
use crate::server::Server;

/// A queue holds one less than its length.
const ORDERS: usize = WINDOW as usize + 1;
const DISARMS: usize = 5;
const CONFIGURATIONS: usize = 2;
/// For so many ticks less one the main loop may be held up before the host misses rows.
const TOLD: usize = 32;
/// For so many ticks the main loop may be held up before it counts as hung.
const HUNG_TICKS: u32 = 100;

/// What lies between both halves.
#[derive(Debug)]
pub struct Between {
    orders: Queue<Addressed<Order>, ORDERS>,
    disarms: Queue<Addressed<Disarm>, DISARMS>,
    configurations: Queue<NewConfiguration, CONFIGURATIONS>,
    told: Queue<Told, TOLD>,
    signals: Signals,
}

/// Of a connection: what an earlier one asked for and what waits is nobody's.
#[derive(Debug)]
struct Addressed<T> {
    session: u32,
    what: T,
}

/// Numbers that one half writes and the other reads.
#[derive(Debug)]
struct Signals {
    /// Number of the connection, written by the speaker.
    session: AtomicU32,
    /// How often a host was heard, written by the speaker.
    heard: AtomicU32,
    /// How often the main loop came round, written by the speaker.
    rounds: AtomicU32,
    /// Number of the next tick, written by the ticker.
    tick: AtomicU32,
    /// Number of the last Arm that was taken, written by the ticker.
    nonce: AtomicU32,
    /// When the last tick began, µs, written by the ticker.
    began_us: AtomicU32,
}

impl Between {
    /// With nothing in it.
    pub const fn new() -> Self {
        Self {
            orders: Queue::new(),
            disarms: Queue::new(),
            configurations: Queue::new(),
            told: Queue::new(),
            signals: Signals {
                session: AtomicU32::new(0),
                heard: AtomicU32::new(0),
                rounds: AtomicU32::new(0),
                tick: AtomicU32::new(0),
                nonce: AtomicU32::new(0),
                began_us: AtomicU32::new(0),
            },
        }
    }

    /// Both halves of a board.
    pub fn halves<'a, const SEGMENTS: usize, const ROWS: usize>(
        &'a mut self,
        server: &'a mut Server<SEGMENTS, ROWS>,
        machine: &'a mut Machine<SEGMENTS>,
    ) -> (Speaker<'a, SEGMENTS, ROWS>, Ticker<'a, SEGMENTS>) {
        let Self { orders, disarms, configurations, told, signals } = self;
        let signals = &*signals;
        let (to_orders, orders) = orders.split();
        let (to_disarms, disarms) = disarms.split();
        let (to_configurations, configurations) = configurations.split();
        let (to_told, told) = told.split();
        let speaker = Speaker {
            server,
            orders: to_orders,
            disarms: to_disarms,
            configurations: to_configurations,
            told,
            signals,
            unsaid: None,
        };
        let ticker = Ticker {
            machine,
            orders,
            disarms,
            configurations,
            told: to_told,
            signals,
            heard: 0,
            rounds: (0, 0),
        };
        (speaker, ticker)
    }
}

impl Default for Between {
    fn default() -> Self {
        Self::new()
    }
}

/// The half that speaks with the host.
pub struct Speaker<'a, const SEGMENTS: usize, const ROWS: usize> {
    server: &'a mut Server<SEGMENTS, ROWS>,
    orders: Producer<'a, Addressed<Order>>,
    disarms: Producer<'a, Addressed<Disarm>>,
    configurations: Producer<'a, NewConfiguration>,
    told: Consumer<'a, Told>,
    signals: &'a Signals,
    /// A Disarm that there was no room for: nobody took those before.
    unsaid: Option<Disarm>,
}

impl<const SEGMENTS: usize, const ROWS: usize> Speaker<'_, SEGMENTS, ROWS> {
    /// Takes bytes of the host; they came now, µs of the clock that the [`Ticker`] is told.
    pub fn take(&mut self, bytes: &[u8], now_us: u32) {
        let since_us = self.hear();
        let tick_us = now_us.wrapping_sub(since_us).min(u16::MAX.into());
        self.server.take(bytes, tick_us as u16);
        self.hand_over();
    }

    /// The line is gone: dark, as by a Disarm. Whoever greets anew may arm again.
    pub fn hang_up(&mut self) {
        self.server.hang_up();
        self.hand_over();
    }

    /// The main loop came round: takes what the ticks left and hands over what waits. A loop that does not come round is held for hung.
    pub fn round(&mut self) {
        let _ = self.hear();
        self.hand_over();
        let rounds = self.signals.rounds.load(Relaxed);
        self.signals.rounds.store(rounds.wrapping_add(1), Relaxed);
    }

    /// Writes bytes for the host, in whole packets; how many.
    pub fn give(&mut self, out: &mut [u8]) -> usize {
        let _ = self.hear();
        self.server.give(out)
    }

    /// Hears what the ticks told; when the last one began, µs.
    fn hear(&mut self) -> u32 {
        let Signals { tick, nonce, began_us, .. } = self.signals;
        // looked at first: what is taken meanwhile is held for waiting, never the other way round
        self.server.waits(self.orders.len());
        let (number, since_us) = loop {
            let (number, since_us) = (tick.load(Relaxed), began_us.load(Relaxed));
            // a tick between both would make them of two ticks
            if tick.load(Relaxed) == number {
                break (number, since_us);
            }
        };
        while let Some(told) = self.told.dequeue() {
            self.server.ticked(told.tick.wrapping_add(1), nonce.load(Relaxed));
            self.server.told(&told);
        }
        self.server.ticked(number, nonce.load(Relaxed));
        since_us
    }

    /// Hands over what waits, as far as there is room.
    fn hand_over(&mut self) {
        let Some(session) = self.server.session() else { return };
        self.signals.session.store(session, Relaxed);
        let inbox = self.server.inbox();
        if inbox.heard {
            let heard = self.signals.heard.load(Relaxed);
            self.signals.heard.store(heard.wrapping_add(1), Relaxed);
        }
        self.unsaid = inbox.disarm.or(self.unsaid);
        if let Some(what) = self.unsaid
            && self.disarms.enqueue(Addressed { session, what }).is_ok()
        {
            self.unsaid = None;
        }
        if self.configurations.ready()
            && let Some(new) = self.server.new_configuration()
        {
            // there is room
            let _ = self.configurations.enqueue(new);
        }
        // nothing overtakes a Disarm that could not be handed over
        while self.unsaid.is_none()
            && self.orders.ready()
            && let Some(what) = self.server.next_order(May { append: true, light: true })
        {
            let _ = self.orders.enqueue(Addressed { session, what });
        }
    }
}

/// The half that ticks.
pub struct Ticker<'a, const SEGMENTS: usize> {
    machine: &'a mut Machine<SEGMENTS>,
    orders: Consumer<'a, Addressed<Order>>,
    disarms: Consumer<'a, Addressed<Disarm>>,
    configurations: Consumer<'a, NewConfiguration>,
    told: Producer<'a, Told>,
    signals: &'a Signals,
    heard: u32,
    /// How often the main loop had come round, and the tick in which that was seen first.
    rounds: (u32, u32),
}

/// What a tick does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Done {
    /// Until the next one.
    pub actuation: Actuation,
    /// Volts that are all that an amplifier gives; `None` without a configuration.
    pub limit_v: Option<PanTilt<f32>>,
    /// Whether the amplifiers are on: not without a configuration, nor in a fault that lets the joints go.
    pub drives: bool,
    /// The main loop is there. A watchdog is fed only then.
    pub is_well: bool,
}

impl<const SEGMENTS: usize> Ticker<'_, SEGMENTS> {
    /// One tick, which began then, µs: what the head senses at its start, and what is done until the next.
    pub fn tick(&mut self, sensed: &Sensed, now_us: u32) -> Done {
        let Self { machine, orders, disarms, configurations, told, signals, heard, rounds } = self;
        let session = signals.session.load(Relaxed);
        let new = configurations.dequeue();
        let mut inbox = Inbox::default();
        while let Some(Addressed { session: of, what }) = disarms.dequeue() {
            // one of an earlier connection darkens too, but speaks of other orders
            let what = if of == session { what } else { Disarm { before: 0, number: 0 } };
            inbox.disarm = Some(what);
        }
        inbox.heard = core::mem::replace(heard, signals.heard.load(Relaxed)) != *heard;
        let next = |may: May| {
            while orders.peek().is_some_and(|order| order.session != session) {
                let _ = orders.dequeue();
            }
            let order = &orders.peek()?.what;
            let is_segment = matches!(order.ask, Ask::Command(Command::Append(_)));
            let may = (may.append || !is_segment) && (may.light || !order.ask.lights());
            if may { orders.dequeue().map(|order| order.what) } else { None }
        };
        let (actuation, done) = machine.tick(sensed, (new.as_ref(), &inbox), next);
        let drives = done.as_ref().is_some_and(drives);
        if let Some(done) = done {
            // a loop that does not look loses rows, which its host finds missing
            let _ = told.enqueue(done);
        }
        signals.nonce.store(machine.nonce(), Relaxed);
        signals.began_us.store(now_us, Relaxed);
        signals.tick.store(machine.tick_number(), Relaxed);
        let round = signals.rounds.load(Relaxed);
        if round != rounds.0 {
            *rounds = (round, machine.tick_number());
        }
        let is_well = machine.tick_number().wrapping_sub(rounds.1) < HUNG_TICKS;
        Done { actuation, limit_v: machine.limit_v(), drives, is_well }
    }

    /// The controller and its state.
    pub const fn machine(&self) -> &Machine<SEGMENTS> {
        self.machine
    }
}

/// Whether the amplifiers are to be on after a tick.
fn drives(told: &Told) -> bool {
    let lets_go = |record: tracelight_rig::FaultRecord| record.fault.row().motors == Motors::Off;
    told.phase != Phase::Faulted || !told.latched.is_some_and(lets_go)
}

impl<const SEGMENTS: usize, const ROWS: usize> core::fmt::Debug for Speaker<'_, SEGMENTS, ROWS> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Speaker").field("signals", self.signals).finish_non_exhaustive()
    }
}

impl<const SEGMENTS: usize> core::fmt::Debug for Ticker<'_, SEGMENTS> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Ticker").field("signals", self.signals).finish_non_exhaustive()
    }
}
