use std::collections::{BTreeMap, VecDeque};

use tracelight_board::{MOST_CONFIGURATION, Start, law_hash, write_configuration};
use tracelight_control::{Carried, Config};
use tracelight_rig::wire::{
    Ask, Configured, FromBoard, Greeting, Packets, Rows, ToBoard, VERSION, WrongConfiguration as Wrong,
    connection_of, crc32,
};
use tracelight_rig::{Command, TICK_NS, Telemetry};

use crate::clock::Clock;
use crate::line::Line;
use crate::outbox::Outbox;
use crate::times::{Times, is_due};
use crate::trouble::Trouble;
use crate::twin::{MOST_SEGMENTS, Twin};

/// How often a board is greeted that does not answer, µs.
const GREET_AGAIN_US: u64 = 100_000;
/// How often a configuration is sent that is not answered, µs.
const CONFIGURE_AGAIN_US: u64 = 250_000;
/// How long a board may be silent while it is greeted or configured, µs.
const MOST_SILENT_US: u64 = 3_000_000;
/// Bytes of a configuration in a packet.
const PIECE: usize = 200;
/// How often a host says that it is there, µs.
const KEEP_ALIVE_US: u64 = 5_000;
/// For how long who drives it counts as being there, µs: he may be waiting for a row that is lost.
const ALIVE_US: u64 = 40_000;
/// How often a Disarm is said that is not confirmed, µs.
const DISARM_AGAIN_US: u64 = 5_000;
/// How often lost rows are asked for, µs.
const ROWS_AGAIN_US: u64 = 10_000;
/// How long rows may be missing that are asked for, µs.
const MOST_MISSING_US: u64 = 3_000_000;
/// How long nothing may come of a board that runs, µs: time to put a cable in again.
const MOST_GONE_US: u64 = 10_000_000;
/// Remarks of a board that are kept, and ticks that nobody has fetched.
const MOST_REMARKS: usize = 64;
const MOST_UNREAD: usize = 4096;
/// Rows that are kept ahead of one that is missing.
const MOST_AHEAD: u32 = 1 << 14;

/// How far a host and its board are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// The host greets.
    Greeting,
    /// The host sends the configuration.
    Configuring,
    /// The board's controller runs.
    Running,
    /// Something is wrong, and the board was told to be dark.
    Failed(Trouble),
}

/// A host's side of the wire. It does no I/O: bytes and the time are handed in.
#[derive(Clone, Debug)]
pub struct Host {
    config: Config,
    configuration: Vec<u8>,
    packets: Packets,
    stage: Stage,
    session: u32,
    board: Option<Greeting>,
    outbox: Outbox,
    twin: Option<Twin>,
    /// Rows that came, by their tick after the next one.
    rows: BTreeMap<u32, tracelight_rig::wire::Row>,
    next_tick: u32,
    /// Tick of the greeting after which orders are numbered anew.
    begins_again: Option<u32>,
    telemetry: VecDeque<Telemetry>,
    /// The board was disarmed in the last tick that was followed, and no dot was wanted.
    is_off: bool,
    /// Number before which orders that let light out are void, until the board says that this Disarm acted.
    disarm: Option<u16>,
    /// Number of the last Disarm.
    disarms: u16,
    is_alive: bool,
    seen: Option<u32>,
    remarks: VecDeque<String>,
    clock: Clock,
    times: Times,
}

impl Host {
    /// Of a head that is configured so. The number is one that no connection had before.
    pub fn new(config: Config, session: u32) -> Self {
        let mut bytes = [0; MOST_CONFIGURATION];
        // a test holds every configuration to that size
        let length = write_configuration(&config, &mut bytes).unwrap_or_default();
        Self {
            config,
            configuration: bytes[..length].to_vec(),
            packets: Packets::new(),
            stage: Stage::Greeting,
            session,
            board: None,
            outbox: Outbox::default(),
            twin: None,
            rows: BTreeMap::new(),
            next_tick: 0,
            begins_again: None,
            telemetry: VecDeque::new(),
            is_off: false,
            disarm: None,
            disarms: 0,
            is_alive: false,
            seen: None,
            remarks: VecDeque::new(),
            clock: Clock::default(),
            times: Times::default(),
        }
    }

    /// How far it is.
    pub const fn stage(&self) -> Stage {
        self.stage
    }

    /// What the board is, once it has answered.
    pub const fn board(&self) -> Option<&Greeting> {
        self.board.as_ref()
    }

    /// When the board's ticks are.
    pub const fn clock(&self) -> &Clock {
        &self.clock
    }

    /// The board's controller, as it is known here.
    pub const fn twin(&self) -> Option<&Twin> {
        self.twin.as_ref()
    }

    /// In how many dark ticks the board may light again where it did not yet: one that is configured anew does not know where it was lit before.
    pub fn opens_in_ticks(&self) -> u32 {
        self.twin.as_ref().map_or(0, Twin::opens_in_ticks)
    }

    /// For how long nothing came, µs.
    pub fn silent_us(&self, now_us: u64) -> u64 {
        self.times.heard.map_or(0, |heard| now_us.saturating_sub(heard))
    }

    /// Stretches of bytes that were no packet.
    pub const fn spoilt(&self) -> u32 {
        self.packets.spoilt()
    }

    /// The next tick that was followed.
    pub fn telemetry(&mut self) -> Option<Telemetry> {
        self.telemetry.pop_front()
    }

    /// The next remark of the board for people.
    pub fn remark(&mut self) -> Option<String> {
        self.remarks.pop_front()
    }

    /// Greets anew, as after a cable was pulled: the board is dark, knows where its head is if it kept its power, and goes on once somebody arms.
    pub fn connect_again(&mut self, session: u32) {
        self.session = session;
        self.stage = Stage::Greeting;
        self.packets = Packets::new();
        (self.disarm, self.disarms) = (None, 0);
        self.times = Times::default();
    }

    /// Hands a command over.
    ///
    /// # Errors
    /// The command, if there is no room for it, the board would refuse it, or it does not run.
    pub fn send(&mut self, command: Command) -> Result<(), Command> {
        let ask = match command {
            Command::KeepAlive => {
                self.is_alive = true;
                return Ok(());
            }
            // nothing that would let light out is on its way, and none can be
            Command::Disarm if self.is_off && !self.outbox.lights() => return Ok(()),
            // a greeting disarms
            Command::Disarm if !self.takes_orders() => return Ok(()),
            Command::Disarm => {
                self.disarm = Some(self.outbox.next());
                self.disarms = self.disarms.wrapping_add(1);
                self.times.disarmed = None;
                return Ok(());
            }
            _ if !self.takes_orders() => return Err(command),
            Command::Home(_) if self.twin.as_ref().is_some_and(|twin| twin.refuses(command)) => {
                return Err(command);
            }
            Command::Arm { acknowledges } => {
                let next = self.board.as_mut().and_then(|board| Some((board.nonce.checked_add(1)?, board)));
                let Some((nonce, board)) = next else { return Err(command) };
                board.nonce = nonce;
                Ask::Arm { nonce, acknowledges }
            }
            _ => Ask::Command(command),
        };
        if !self.outbox.has_room(ask) {
            return Err(command);
        }
        self.outbox.push(ask);
        Ok(())
    }

    /// Whether what is asked can be sent: orders have their numbers.
    fn takes_orders(&self) -> bool {
        self.stage == Stage::Running && self.begins_again.is_none()
    }

    /// What is to be sent now.
    pub fn give(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let mut line = Line { connection: connection_of(self.session), out };
        match self.stage {
            Stage::Greeting | Stage::Configuring => self.connect(now_us, &mut line),
            Stage::Running => self.drive(now_us, &mut line),
            Stage::Failed(_) => {
                if is_due(&mut self.times.disarmed, now_us, DISARM_AGAIN_US) {
                    line.say(ToBoard::Disarm { before: self.outbox.next(), number: self.disarms });
                }
            }
        }
    }

    /// Fails if nothing came for so long; whether it did not.
    fn is_heard(&mut self, now_us: u64, most_us: u64) -> bool {
        let waited_us = now_us.saturating_sub(*self.times.heard.get_or_insert(now_us));
        if waited_us > most_us {
            self.stage = Stage::Failed(Trouble::Silent { waited_us });
        }
        waited_us <= most_us
    }

    /// Greets, and sends the configuration.
    fn connect(&mut self, now_us: u64, line: &mut Line<'_>) {
        if !self.is_heard(now_us, MOST_SILENT_US) {
            return;
        }
        if self.stage == Stage::Greeting && is_due(&mut self.times.greeted, now_us, GREET_AGAIN_US) {
            let mut program = [0; 8];
            let version = env!("CARGO_PKG_VERSION").bytes();
            program.iter_mut().zip(version).for_each(|(place, byte)| *place = byte);
            line.say(ToBoard::Hello { version: VERSION, session: self.session, program });
        }
        if self.stage == Stage::Configuring && is_due(&mut self.times.configured, now_us, CONFIGURE_AGAIN_US)
        {
            for (number, bytes) in self.configuration.chunks(PIECE).enumerate() {
                // some kilobytes at most
                let offset = (number * PIECE) as u16;
                line.say(ToBoard::Configure { offset, bytes });
            }
            let (length, crc) = (self.configuration.len() as u16, crc32(&self.configuration));
            line.say(ToBoard::Commit { length, crc });
        }
    }

    /// Says what a board that runs is to hear.
    fn drive(&mut self, now_us: u64, line: &mut Line<'_>) {
        if !self.is_heard(now_us, MOST_GONE_US) {
            return;
        }
        // before all: what was asked earlier and would let light out is void then, and what is asked later waits until it acted
        if let Some(before) = self.disarm
            && is_due(&mut self.times.disarmed, now_us, DISARM_AGAIN_US)
        {
            line.say(ToBoard::Disarm { before, number: self.disarms });
        }
        if core::mem::take(&mut self.is_alive) {
            self.times.said = Some(now_us);
        }
        let is_alive = self.times.said.is_some_and(|said| now_us.saturating_sub(said) <= ALIVE_US);
        if is_alive && is_due(&mut self.times.alive, now_us, KEEP_ALIVE_US) {
            line.say(ToBoard::KeepAlive { host_us: now_us });
        }
        while self.begins_again.is_none()
            && let Some(order) = self.outbox.send(now_us, self.disarm)
        {
            // nothing is lit for a host that was not heard before
            if order.ask.lights() && is_alive {
                self.times.alive = Some(now_us);
                line.say(ToBoard::KeepAlive { host_us: now_us });
            }
            line.say(ToBoard::Order(order));
        }
        if let Some(number) = self.seen.take() {
            line.say(ToBoard::Seen { number });
        }
        self.ask_for_rows(now_us, line);
    }

    /// Asks for rows that are lost, and gives up on those that cannot be had.
    fn ask_for_rows(&mut self, now_us: u64, line: &mut Line<'_>) {
        let Some((from, count)) = self.missing() else {
            self.times.missing = None;
            return;
        };
        let since = *self.times.missing.get_or_insert(now_us);
        if is_due(&mut self.times.asked, now_us, ROWS_AGAIN_US) {
            line.say(ToBoard::Again { from, count });
        }
        if now_us.saturating_sub(since) > MOST_MISSING_US {
            let to = from.wrapping_add(count.into());
            self.stage = Stage::Failed(Trouble::LostRows { from, to });
        }
    }

    /// Takes bytes of the board.
    pub fn take(&mut self, bytes: &[u8], now_us: u64) {
        let mut packets = std::mem::take(&mut self.packets);
        for &byte in bytes {
            if let Some((said, connection)) = packets.push(byte).and_then(FromBoard::read)
                && (connection == connection_of(self.session) || matches!(said, FromBoard::Hello(_)))
                && let Err(trouble) = self.hear(said, now_us)
            {
                self.stage = Stage::Failed(trouble);
                self.times.disarmed = None;
            }
        }
        self.packets = packets;
    }

    fn hear(&mut self, said: FromBoard<'_>, now_us: u64) -> Result<(), Trouble> {
        match (said, self.stage) {
            (_, Stage::Failed(_)) => {}
            (FromBoard::Hello(board), Stage::Greeting) if board.session == self.session => {
                self.times.heard = Some(now_us);
                self.meet(board)?;
            }
            // unasked: it has started anew
            (FromBoard::Hello(board), Stage::Running) if board.session == 0 => return Err(Trouble::Reset),
            (FromBoard::Hello(board), Stage::Configuring) if board.session == 0 => {
                self.stage = Stage::Greeting;
                self.times.greeted = None;
            }
            // a piece was lost, or a Disarm did not act yet: it is sent again
            (FromBoard::Configured(Err(Wrong::Checksum(_) | Wrong::Armed)), Stage::Configuring) => {}
            (FromBoard::Configured(answer), Stage::Configuring) => {
                self.times.heard = Some(now_us);
                self.begin(answer.map_err(Trouble::Configuration)?)?;
            }
            (FromBoard::Rows(rows), Stage::Running) => {
                self.times.heard = Some(now_us);
                self.keep(&rows, now_us);
                self.follow()?;
            }
            (FromBoard::Pong { host_us, tick, tick_us }, _) => {
                self.clock.hear((host_us, now_us), tick, tick_us);
            }
            (FromBoard::Fault(record), Stage::Running) => self.seen = Some(record.number),
            (FromBoard::Log(text), _) => {
                if self.remarks.len() == MOST_REMARKS {
                    self.remarks.pop_front();
                }
                self.remarks.push_back(text.to_owned());
            }
            _ => {}
        }
        Ok(())
    }

    /// The board has answered: it is configured, or goes on where it was.
    fn meet(&mut self, board: Greeting) -> Result<(), Trouble> {
        if board.version.0 != VERSION.0 {
            return Err(Trouble::Version { board: board.version });
        }
        if board.tick_ns != TICK_NS {
            return Err(Trouble::TickLength { board_ns: board.tick_ns });
        }
        if usize::from(board.segments) > MOST_SEGMENTS {
            return Err(Trouble::Segments { board: board.segments });
        }
        let before = self.board.replace(board);
        if self.twin.is_none() {
            self.stage = Stage::Configuring;
            return Ok(());
        }
        let crc = crc32(&self.configuration);
        let is_same = before.is_some_and(|before| before.id == board.id) && board.configuration == Some(crc);
        if !is_same || is_earlier(board.tick, self.next_tick) {
            return Err(Trouble::Reset);
        }
        let missed = board.tick.wrapping_sub(self.next_tick);
        if missed > u32::from(board.rows) {
            let to = board.tick.wrapping_sub(board.rows.into());
            return Err(Trouble::LostRows { from: self.next_tick, to });
        }
        self.begins_again = Some(board.tick);
        self.stage = Stage::Running;
        Ok(())
    }

    /// The configuration is in force.
    fn begin(&mut self, configured: Configured) -> Result<(), Trouble> {
        let Configured { crc, tick, law, home, heat, shut_ticks } = configured;
        if crc != crc32(&self.configuration) {
            // of an earlier connection
            return Ok(());
        }
        let host = law_hash(&self.config);
        if law != host {
            return Err(Trouble::Law { host, board: law });
        }
        let is_absolute = self.board.is_some_and(|board| board.capabilities.absolute);
        let carried = heat.map(|heat| Carried { heat, shut_ticks });
        self.twin = Some(Twin::new(self.config, Start { tick, is_absolute, home, carried }));
        self.next_tick = tick;
        self.rows.clear();
        self.stage = Stage::Running;
        Ok(())
    }

    /// Keeps rows until their turn comes.
    fn keep(&mut self, rows: &Rows<'_>, now_us: u64) {
        if self.begins_again.is_none() {
            self.outbox.hear(rows.header.wanted, rows.header.free, now_us);
            if rows.header.disarm == self.disarms {
                self.disarm = None;
            }
        }
        let inputs = self.board.map(|board| board.capabilities.inputs).unwrap_or_default();
        for (tick, row) in rows.rows(inputs) {
            if tick.wrapping_sub(self.next_tick) < MOST_AHEAD {
                self.rows.insert(tick, row);
            }
        }
    }

    /// Follows the rows whose turn it is.
    fn follow(&mut self) -> Result<(), Trouble> {
        let Some(twin) = &mut self.twin else { return Ok(()) };
        loop {
            if self.begins_again == Some(self.next_tick) {
                self.outbox.begin_again();
                self.begins_again = None;
            }
            // whoever does not look does not get more
            if self.telemetry.len() >= MOST_UNREAD {
                break;
            }
            let Some(row) = self.rows.remove(&self.next_tick) else { break };
            let Some(orders) = self.outbox.take(row.taken) else {
                return Err(Trouble::Diverged(crate::trouble::Divergence {
                    tick: self.next_tick,
                    what: "number of orders taken",
                    host: 0.0,
                    board: row.taken.into(),
                }));
            };
            let told = twin.follow(self.next_tick, &row, &orders)?;
            self.is_off = twin.is_off(&told);
            self.telemetry.push_back(told);
            self.times.missing = None;
            self.next_tick = self.next_tick.wrapping_add(1);
        }
        Ok(())
    }

    /// From the first row that did not come up to the last one that did, or up to a new greeting: what is lost in between is rarely alone.
    fn missing(&self) -> Option<(u32, u16)> {
        let to = self.begins_again.or_else(|| {
            // ticks wrap: the last one is before the next one then
            let last = self.rows.range(..self.next_tick).next_back().or_else(|| self.rows.iter().next_back());
            last.map(|(&tick, _)| tick)
        })?;
        let count = to.wrapping_sub(self.next_tick);
        (count > 0).then(|| (self.next_tick, u16::try_from(count).unwrap_or(u16::MAX)))
    }
}

/// Whether a tick is before another one, across their wrap.
const fn is_earlier(tick: u32, other: u32) -> bool {
    tick.wrapping_sub(other) >= 1 << 31
}
