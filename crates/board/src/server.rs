//! What speaks with the host.

use tracelight_rig::wire::{
    Ask, Configured, FromBoard, Greeting, MOST_PACKET, Order, Packets, Reset, Rows, ToBoard, VERSION,
    WrongConfiguration, crc32, packed,
};
use tracelight_rig::{Capabilities, Command, FaultRecord, PanTilt, Phase};

use crate::configuration::{MOST_CONFIGURATION, read_configuration};
use crate::law::law_hash;
use crate::machine::{Inbox, May, NewConfiguration, Told};
use crate::orders::Orders;
use crate::ring::Ring;

/// Ticks after which a fault that nobody has seen is told again.
const FAULT_AGAIN_TICKS: u32 = 50;
/// Length of a tick, ns.
const TICK_NS: u32 = 1_000_000;

/// What a board is.
#[derive(Clone, Copy, Debug)]
pub struct Identity {
    /// Version of its program.
    pub firmware: [u8; 3],
    /// First bytes of the hash of its program's source.
    pub source: [u8; 8],
    /// Kind of board.
    pub board: u16,
    /// Number of this one.
    pub id: [u8; 8],
    /// What it has.
    pub capabilities: Capabilities,
    /// Why it started.
    pub reset: Reset,
}

/// The board's side of the wire.
#[derive(Clone, Debug)]
pub struct Server<const SEGMENTS: usize, const ROWS: usize> {
    identity: Identity,
    packets: Packets,
    /// Number of the connection; `None` before a host of this protocol's version has greeted.
    session: Option<u32>,
    orders: Orders,
    /// Number of the order that comes next.
    wanted: u16,
    inbox: Inbox,
    /// What came of a configuration.
    upload: [u8; MOST_CONFIGURATION],
    /// Checksum of the one in force.
    configuration: Option<u32>,
    /// What was answered when that came, in this connection.
    answered: Option<Configured>,
    /// Checksum of the one that will be, and the hash of its law.
    coming: Option<(u32, u32)>,
    rows: Ring<ROWS>,
    /// Tick of the row that is told next.
    untold: u32,
    /// Rows that are to be told again: the first one's tick, and how many.
    again: Option<(u32, u16)>,
    free: u16,
    phase: Phase,
    tick: u32,
    nonce: u32,
    due: Due,
    /// The last fault, and whether the host has seen it.
    fault: Option<(FaultRecord, bool)>,
    /// Tick in which it was told last.
    fault_told: u32,
}

/// Answers that are due.
#[derive(Clone, Copy, Debug)]
struct Due {
    greeting: bool,
    configured: Option<Result<Configured, WrongConfiguration>>,
    /// What the host's clock was, and when that came: tick, µs.
    pong: Option<(u64, u32, u16)>,
}

impl<const SEGMENTS: usize, const ROWS: usize> Server<SEGMENTS, ROWS> {
    /// At power-up. It greets unasked, so that a host that is there knows of the reset.
    pub const fn new(identity: Identity) -> Self {
        Self {
            identity,
            packets: Packets::new(),
            session: None,
            orders: Orders::new(),
            wanted: 0,
            inbox: Inbox { heard: false, disarm: None, configuration: None },
            upload: [0; MOST_CONFIGURATION],
            configuration: None,
            answered: None,
            coming: None,
            rows: Ring::new(),
            untold: 0,
            again: None,
            free: 0,
            phase: Phase::Dark,
            tick: 0,
            nonce: 0,
            due: Due { greeting: true, configured: None, pong: None },
            fault: None,
            fault_told: 0,
        }
    }

    /// Whether a configuration is in force from the next tick on.
    pub const fn is_configuring(&self) -> bool {
        self.coming.is_some()
    }

    /// Stretches of bytes that were no packet.
    pub const fn spoilt(&self) -> u32 {
        self.packets.spoilt()
    }

    /// Takes bytes of the host, which came so many µs after the last tick began.
    pub fn take(&mut self, bytes: &[u8], tick_us: u16) {
        let mut packets = self.packets;
        for &byte in bytes {
            if let Some(said) = packets.push(byte).and_then(ToBoard::read) {
                self.hear(said, tick_us);
            }
        }
        self.packets = packets;
    }

    fn hear(&mut self, said: ToBoard<'_>, tick_us: u16) {
        match said {
            ToBoard::Hello { version, session, .. } => self.greet(version, session),
            // whoever says it, and whatever was said before
            ToBoard::Disarm { before } => self.inbox.disarm = Some(before),
            _ if self.session.is_none() => {}
            ToBoard::Configure { offset, bytes } => self.keep(offset, bytes),
            ToBoard::Commit { length, crc } => {
                if let Err(wrong) = self.commit(length, crc) {
                    self.due.configured = Some(Err(wrong));
                }
            }
            ToBoard::Order(order) => {
                // what is lost before it comes again, with it
                if order.sequence == self.wanted && self.orders.push(order) {
                    self.wanted = self.wanted.wrapping_add(1);
                    // whoever asks for something new is there
                    self.inbox.heard = true;
                }
            }
            ToBoard::KeepAlive { host_us } => {
                self.inbox.heard = true;
                self.due.pong = Some((host_us, self.tick, tick_us));
            }
            ToBoard::Again { from, count } => self.again = Some((from, count)),
            ToBoard::Seen { number } => {
                if let Some((record, is_seen)) = &mut self.fault {
                    *is_seen |= record.number == number;
                }
            }
        }
    }

    /// Begins a connection, dark: what an earlier one left behind is nobody's.
    fn greet(&mut self, version: (u8, u8), session: u32) {
        self.orders = Orders::new();
        self.wanted = 0;
        self.inbox = Inbox { disarm: Some(0), ..Inbox::default() };
        (self.untold, self.again) = (self.rows.end(), None);
        self.due = Due { greeting: true, configured: None, pong: None };
        (self.coming, self.answered) = (None, None);
        self.session = (version.0 == VERSION.0).then_some(session);
        if let Some((_, is_seen)) = &mut self.fault {
            *is_seen = false;
        }
    }

    fn keep(&mut self, offset: u16, bytes: &[u8]) {
        let room = self.upload.get_mut(usize::from(offset)..).unwrap_or_default();
        // what does not fit shows in the checksum
        room.iter_mut().zip(bytes).for_each(|(place, byte)| *place = *byte);
    }

    fn commit(&mut self, length: u16, crc: u32) -> Result<(), WrongConfiguration> {
        if matches!(self.phase, Phase::Armed | Phase::Tracing | Phase::Holding | Phase::Testing) {
            return Err(WrongConfiguration::Armed);
        }
        let most = u16::try_from(MOST_CONFIGURATION).unwrap_or(u16::MAX);
        let bytes = self.upload.get(..usize::from(length)).ok_or(WrongConfiguration::Length(most))?;
        let came = crc32(bytes);
        if came != crc {
            return Err(WrongConfiguration::Checksum(came));
        }
        if let Some(answered) = self.answered.filter(|answered| answered.crc == crc) {
            // the answer was lost
            self.due.configured = Some(Ok(answered));
            return Ok(());
        }
        let config = read_configuration(bytes)?;
        self.coming = Some((crc, law_hash(&config)));
        self.inbox.configuration = Some(NewConfiguration {
            config,
            is_absolute: self.identity.capabilities.absolute,
            is_same: self.configuration == Some(crc),
        });
        Ok(())
    }

    /// What came for the next tick, beside orders.
    pub fn inbox(&mut self) -> Inbox {
        core::mem::take(&mut self.inbox)
    }

    /// The order whose turn it is, if it may be taken.
    pub fn next_order(&mut self, may: May) -> Option<Order> {
        let is_segment = |order: &Order| matches!(order.ask, Ask::Command(Command::Append(_)));
        let fits = |order: &&Order| (may.append || !is_segment(order)) && (may.light || !order.ask.lights());
        self.orders.peek().filter(fits)?;
        self.orders.pop()
    }

    /// A tick is over: its number is that of the next one, and that of the last Arm.
    pub const fn ticked(&mut self, tick: u32, nonce: u32) {
        self.tick = tick;
        self.nonce = nonce;
    }

    /// Keeps what a tick was, for the host.
    pub fn told(&mut self, told: &Told) {
        if let Some(home) = told.began {
            self.begin(told.tick, home);
        }
        self.rows.push(told.tick, told.row);
        self.free = told.free;
        self.phase = told.phase;
        let is_new =
            |record: &FaultRecord| self.fault.is_none_or(|(before, _)| before.number != record.number);
        if let Some(record) = told.latched.filter(is_new) {
            self.fault = Some((record, false));
            self.fault_told = told.tick.wrapping_sub(FAULT_AGAIN_TICKS);
        }
    }

    fn begin(&mut self, tick: u32, home: Option<PanTilt<i32>>) {
        if let Some((crc, law)) = self.coming.take() {
            self.configuration = Some(crc);
            self.answered = Some(Configured { crc, tick, law, home });
            self.due.configured = self.answered.map(Ok);
        }
        self.untold = tick;
        self.fault = None;
    }

    /// Writes what is to be said, in whole packets, as far as they surely fit; how many bytes that is.
    pub fn give(&mut self, out: &mut [u8]) -> usize {
        let mut length = 0;
        let mut packet = [0; MOST_PACKET];
        while out.len() - length >= MOST_PACKET {
            let packet_length = self.packet(&mut packet);
            if packet_length == 0 {
                break;
            }
            let bytes = packet.iter().take(packet_length);
            out.iter_mut().skip(length).zip(bytes).for_each(|(place, byte)| *place = *byte);
            length += packet_length;
        }
        length
    }

    /// The next packet; its length, 0 if nothing is to be said.
    fn packet(&mut self, out: &mut [u8; MOST_PACKET]) -> usize {
        let mut say = |said: FromBoard<'_>| packed(said.body().bytes(), out);
        if core::mem::take(&mut self.due.greeting) {
            return say(FromBoard::Hello(self.greeting()));
        }
        if self.session.is_none() {
            return 0;
        }
        if let Some(configured) = self.due.configured.take() {
            return say(FromBoard::Configured(configured));
        }
        if let Some((record, false)) = self.fault
            && self.tick.wrapping_sub(self.fault_told) >= FAULT_AGAIN_TICKS
        {
            self.fault_told = self.tick;
            return say(FromBoard::Fault(record));
        }
        if let Some((host_us, tick, tick_us)) = self.due.pong.take() {
            return say(FromBoard::Pong { host_us, tick, tick_us });
        }
        self.rows(out)
    }

    fn greeting(&self) -> Greeting {
        let Identity { firmware, source, board, id, capabilities, reset } = self.identity;
        Greeting {
            version: VERSION,
            session: self.session.unwrap_or_default(),
            firmware,
            source,
            board,
            id,
            tick_ns: TICK_NS,
            segments: u16::try_from(SEGMENTS).unwrap_or(u16::MAX),
            rows: u16::try_from(ROWS).unwrap_or(u16::MAX),
            capabilities,
            configuration: self.configuration,
            reset,
            tick: self.tick,
            nonce: self.nonce,
        }
    }

    /// Rows that are to be told again, then those that were not told yet. A host that reads too slowly finds a gap.
    fn rows(&mut self, out: &mut [u8; MOST_PACKET]) -> usize {
        let waiting = u16::try_from(self.orders.len()).unwrap_or(u16::MAX);
        let free = self.free.saturating_sub(waiting);
        if let Some((from, count)) = self.again.take() {
            let rows = self.rows.from(from).take(count.into());
            let (body, told) = Rows::body((from, self.wanted, free), rows);
            let left = count - u16::from(told);
            if told > 0 {
                self.again = (left > 0).then(|| (from.wrapping_add(told.into()), left));
                return packed(body.bytes(), out);
            }
        }
        let behind = self.rows.end().wrapping_sub(self.untold);
        if behind > self.rows.end().wrapping_sub(self.rows.begin()) {
            self.untold = self.rows.begin();
        }
        let (body, told) = Rows::body((self.untold, self.wanted, free), self.rows.from(self.untold));
        if told == 0 {
            return 0;
        }
        self.untold = self.untold.wrapping_add(told.into());
        packed(body.bytes(), out)
    }
}
