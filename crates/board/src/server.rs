//! What speaks with the host.

use tracelight_rig::wire::{
    Ask, Configured, FromBoard, Greeting, MOST_PACKET, Order, Packets, Reset, Rows, RowsHeader, ToBoard,
    VERSION, WrongConfiguration, connection_of, crc32, packed,
};
use tracelight_rig::{Capabilities, Command, FaultRecord, Phase, TICK_NS};

use crate::configuration::{MOST_CONFIGURATION, read_configuration};
use crate::law::law_hash;
use crate::machine::{Disarm, Inbox, May, NewConfiguration, Told};
use crate::orders::Orders;
use crate::ring::Ring;

/// Ticks after which a fault that nobody has seen is told again.
const FAULT_AGAIN_TICKS: u32 = 50;
/// Ticks after which it greets again while nobody has greeted it.
const GREET_TICKS: u32 = 100;

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

impl Identity {
    /// Of a board that is emulated.
    pub fn emulated(capabilities: Capabilities, reset: Reset) -> Self {
        let firmware = version(env!("CARGO_PKG_VERSION"));
        let (board, id) = (Greeting::EMULATED, Greeting::EMULATED_ID);
        Self { firmware, source: [0; 8], board, id, capabilities, reset }
    }

    /// The digits of its number, 16 of them.
    pub fn serial(&self) -> [u8; 16] {
        let mut digits = [b'0'; 16];
        let halves = self.id.into_iter().flat_map(|byte| [byte >> 4, byte & 15]);
        for (place, half) in digits.iter_mut().zip(halves) {
            *place = if half < 10 { b'0' + half } else { b'a' + half - 10 };
        }
        digits
    }
}

/// The numbers of a version such as `0.1.0`; 0 for what is none.
pub fn version(text: &str) -> [u8; 3] {
    let mut numbers = text.split('.').map(|number| number.parse().unwrap_or_default());
    [(); 3].map(|()| numbers.next().unwrap_or_default())
}

/// The board's side of the wire.
#[derive(Clone, Debug)]
pub struct Server<const SEGMENTS: usize, const ROWS: usize> {
    identity: Identity,
    packets: Packets,
    /// Number of the connection; `None` before a host has greeted.
    session: Option<u32>,
    /// The host that has greeted speaks another version.
    is_other: bool,
    orders: Orders,
    /// Orders that were given away and wait elsewhere.
    waiting: usize,
    /// Number of the order that comes next.
    wanted: u16,
    inbox: Inbox,
    /// A configuration with which the controller begins anew in the next tick.
    new: Option<NewConfiguration>,
    /// What came of a configuration.
    upload: [u8; MOST_CONFIGURATION],
    /// Checksum of the one in force.
    configuration: Option<u32>,
    /// Checksum of the last one that was sent.
    committed: u32,
    /// What was answered when that came, in this connection.
    answered: Option<Configured>,
    /// How many are to begin with in the next ticks, and whether somebody waits for the answer to the last of them.
    coming: u8,
    is_awaited: bool,
    rows: Ring<ROWS>,
    /// Tick of the row that is told next.
    untold: u32,
    /// Rows that are to be told again: the first one's tick, and how many.
    again: Option<(u32, u16)>,
    free: u16,
    disarm: u16,
    fault_number: u32,
    phase: Phase,
    /// Number of the next tick.
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
            is_other: false,
            orders: Orders::new(),
            waiting: 0,
            wanted: 0,
            inbox: Inbox { heard: false, disarm: None },
            new: None,
            upload: [0; MOST_CONFIGURATION],
            configuration: None,
            committed: 0,
            answered: None,
            coming: 0,
            is_awaited: false,
            rows: Ring::new(),
            untold: 0,
            again: None,
            free: 0,
            disarm: 0,
            fault_number: 0,
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
        self.coming > 0
    }

    /// Stretches of bytes that were no packet.
    pub const fn spoilt(&self) -> u32 {
        self.packets.spoilt()
    }

    /// Takes bytes of the host, which came so many µs after the last tick began.
    pub fn take(&mut self, bytes: &[u8], tick_us: u16) {
        let mut packets = self.packets;
        for &byte in bytes {
            if let Some((said, connection)) = packets.push(byte).and_then(ToBoard::read) {
                self.hear(said, connection, tick_us);
            }
        }
        self.packets = packets;
    }

    fn hear(&mut self, said: ToBoard<'_>, connection: u8, tick_us: u16) {
        let is_ours =
            !self.is_other && self.session.is_some_and(|session| connection_of(session) == connection);
        match said {
            ToBoard::Hello { version, session, .. } => self.greet(version, session),
            ToBoard::Disarm { before, number } if is_ours => {
                self.inbox.disarm = Some(Disarm { before, number })
            }
            // whoever says it
            ToBoard::Disarm { .. } => self.hang_up(),
            _ if !is_ours => {}
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
                    // whoever asks for something new is there; light wants more than that
                    self.inbox.heard |= !order.ask.lights();
                }
            }
            ToBoard::KeepAlive { host_us } => {
                self.inbox.heard = true;
                self.due.pong = Some((host_us, self.tick.wrapping_sub(1), tick_us));
            }
            ToBoard::Again { from, count } => self.again = Some((from, count)),
            ToBoard::Seen { number } => {
                if let Some((record, is_seen)) = &mut self.fault {
                    *is_seen |= record.number == number;
                }
            }
        }
    }

    /// Number of the connection; `None` before a host has greeted.
    pub const fn session(&self) -> Option<u32> {
        self.session
    }

    /// Nobody is there any more, or a stranger wants it dark: what has come and waits lights nothing.
    pub fn hang_up(&mut self) {
        self.inbox.disarm.get_or_insert(Disarm { before: self.wanted, number: self.disarm });
    }

    /// So many orders that were given away wait elsewhere, and take room when their turn comes.
    pub(crate) const fn waits(&mut self, waiting: usize) {
        self.waiting = waiting;
    }

    /// Begins a connection, dark: what an earlier one left behind is nobody's.
    fn greet(&mut self, version: (u8, u8), session: u32) {
        self.orders = Orders::new();
        self.wanted = 0;
        self.inbox = Inbox { disarm: Some(Disarm { before: 0, number: 0 }), ..Inbox::default() };
        (self.untold, self.again) = (self.rows.end(), None);
        self.due = Due { greeting: true, configured: None, pong: None };
        (self.is_awaited, self.answered, self.disarm) = (false, None, 0);
        (self.session, self.is_other) = (Some(session), version.0 != VERSION.0);
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
        let is_armed = matches!(self.phase, Phase::Armed | Phase::Tracing | Phase::Holding | Phase::Testing);
        // a Disarm that has come acts before the next tick, in which the controller begins
        if is_armed && self.inbox.disarm.is_none() {
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
        if self.is_awaited && self.committed == crc {
            // it was sent again before a tick could begin with it, which is to do so once
            return Ok(());
        }
        let config = read_configuration(bytes)?;
        let is_absolute = self.identity.capabilities.absolute;
        let new = NewConfiguration { config, is_absolute, crc, law: law_hash(&config) };
        // one that no tick was given yet never begins
        self.coming += u8::from(self.new.replace(new).is_none());
        (self.is_awaited, self.committed) = (true, crc);
        Ok(())
    }

    /// A configuration that came. It is large: who asks in every tick whether there is one does not copy it.
    pub fn new_configuration(&mut self) -> Option<NewConfiguration> {
        if self.new.is_some() { self.new.take() } else { None }
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

    /// A tick is over: the number of the next one, and that of the last Arm. A board that nobody has greeted says now and then that it is there.
    pub fn ticked(&mut self, tick: u32, nonce: u32) {
        (self.tick, self.nonce) = (tick, nonce);
        self.due.greeting |= self.session.is_none() && tick.is_multiple_of(GREET_TICKS);
    }

    /// Keeps what a tick was, for the host.
    pub fn told(&mut self, told: &Told) {
        if let Some(configured) = told.began {
            self.begin(configured);
        }
        self.disarm = told.disarm.unwrap_or(self.disarm);
        self.fault_number = told.fault_number;
        if told.latched.is_none() {
            self.fault = None;
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

    fn begin(&mut self, configured: Configured) {
        self.configuration = Some(configured.crc);
        self.coming = self.coming.saturating_sub(1);
        // the host that sent it may have greeted anew meanwhile, and asks again then: that is another beginning
        if self.coming == 0 && core::mem::take(&mut self.is_awaited) {
            self.answered = Some(configured);
            self.due.configured = Some(Ok(configured));
        }
        self.untold = configured.tick;
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
        let connection = connection_of(self.session.unwrap_or_default());
        let mut say = |said: FromBoard<'_>| said.packed(connection, out);
        if core::mem::take(&mut self.due.greeting) {
            return say(FromBoard::Hello(self.greeting()));
        }
        if self.session.is_none() || self.is_other {
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
        self.rows(connection, out)
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
    fn rows(&mut self, connection: u8, out: &mut [u8; MOST_PACKET]) -> usize {
        let waiting = u16::try_from(self.orders.len() + self.waiting).unwrap_or(u16::MAX);
        let header = RowsHeader {
            first_tick: self.untold,
            wanted: self.wanted,
            free: self.free.saturating_sub(waiting),
            disarm: self.disarm,
            fault_number: self.fault_number,
        };
        if let Some((from, count)) = self.again.take() {
            let rows = self.rows.from(from).take(count.into());
            let (body, told) = Rows::body(connection, &RowsHeader { first_tick: from, ..header }, rows);
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
        let header = RowsHeader { first_tick: self.untold, ..header };
        let (body, told) = Rows::body(connection, &header, self.rows.from(self.untold));
        if told == 0 {
            return 0;
        }
        self.untold = self.untold.wrapping_add(told.into());
        packed(body.bytes(), out)
    }
}
