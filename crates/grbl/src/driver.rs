//! A head on a board, as a rig: commands in, a telemetry for each tick out once the board has done it.

use std::collections::VecDeque;

use tracelight_control::{Config, Controller, State};
use tracelight_rig::{Command, Joint, PanTilt, Telemetry};

use crate::asking::RESET;
use crate::axis::BoardAxis;
use crate::board::{Board, ZERO, ZERO_NUMBER};
use crate::moves::Item;
use crate::pace::Pace;
use crate::said::{Doing, Lines, Said, Status};
use crate::sender::Sender;
use crate::stage::Stage;
use crate::teller::{Gear, Teller};
use crate::text::Writer;
use crate::trouble::Trouble;

/// Ticks that are told ahead at least, and so many behind a move before it is sent: what follows decides how it slows down.
const LEAST_AHEAD: usize = 200;
const MOST_AHEAD: usize = 1000;
const LOOK_TICKS: u32 = 60;
/// Ticks for which a controller goes on that is short of segments.
const SHORT_AHEAD: usize = 20;
/// For how long whoever drives it counts as being there, µs: he may be waiting for a tick that the board has to do first. Who does not wait gets none.
const ALIVE_US: u64 = 1_000_000;
const TICK_US: u64 = 1_000;
/// Ticks of rest that are made up for when somebody was late, µs.
const MOST_LATE_US: u64 = 50_000;
/// How often a board is asked how it stands: while it moves, while it rests, and while it is waited for, µs.
const ASK_MOVING_US: u64 = 100_000;
const ASK_RESTING_US: u64 = 500_000;
const ASK_WAITED_US: u64 = 20_000;
/// How long a board may be silent that has to answer, µs.
const MOST_SILENT_US: u64 = 3_000_000;
/// How long it may take to come to a hold before it is reset on its way, µs.
const MOST_HOLDING_US: u64 = 2_000_000;
/// Orders that a board takes at any time.
const HOLD: u8 = b'!';
const ASK: u8 = b'?';
/// Feed, rapids and spindle at 100 % of what they are told.
const NO_OVERRIDES: [u8; 3] = [0x90, 0x95, 0x99];
const DEGREE_RAD: f64 = std::f64::consts::PI / 180.0;

/// A head on a board. It does no I/O: bytes and the time are handed in.
#[derive(Clone, Debug)]
pub struct Driver {
    teller: Teller,
    sender: Sender,
    board: Board,
    stage: Stage,
    lines: Lines,
    /// Nothing more is told until all that was is done.
    parked: bool,
    ahead: usize,
    /// Bytes that go before any line.
    urgent: Vec<u8>,
    /// Commands that came while the board was halted.
    halted: Vec<Command>,
    /// The last tick that a head has done that was halted on its way, to which it goes back.
    rewinds: Option<u32>,
    ready: VecDeque<Telemetry>,
    alive_us: Option<u64>,
    /// When the next tick of rest is due, when it was last asked, and when it was last heard.
    due_us: u64,
    asked_us: u64,
    heard_us: u64,
    /// The last report.
    status: Option<Status>,
}

impl Driver {
    /// A head of that controller on a board that was asked, whose axes turn the joints so. The lit spot may be so far from where it is told to be, rad; the head has
    /// been dark for so many ticks.
    ///
    /// # Errors
    /// What of the board's settings does not fit.
    pub fn new(
        config: Config,
        board: Board,
        axes: PanTilt<BoardAxis>,
        (lit_rad, shut_ticks): (f64, u32),
        now_us: u64,
    ) -> Result<Self, Trouble> {
        board.check()?;
        let limits = board.limits(axes)?;
        let step_rad = limits.map(|limits| limits.step_rad);
        let gear = Gear { axes, step_rad, lit_rad };
        let units = step_rad.map(|step_rad| step_rad / DEGREE_RAD);
        let of = |list: &[f64]| PanTilt::from_fn(|j| list.get(axes[j].index()).copied().unwrap_or(0.0));
        let (machine, begins) = (of(&board.machine), of(&board.begins));
        let at = PanTilt::from_fn(|j| (machine[j] / units[j]).round() as i64);
        let homed = board.is_homed.then(|| {
            PanTilt::from_fn(|j| (axes[j].sign() * (machine[j] - begins[j]) / units[j]).round() as i32)
        });
        let pace = Pace {
            units,
            rates: limits.map(|limits| limits.speed_rad_s / DEGREE_RAD),
            accelerations: limits.map(|limits| limits.acceleration_rad_s2 / DEGREE_RAD),
        };
        // a way to a stop is never cut off by what is not told yet
        let stops_s = Joint::BOTH.map(|j| 1.5 * limits[j].speed_rad_s / limits[j].acceleration_rad_s2);
        let stops = (1e3 * stops_s[0].max(stops_s[1])) as usize + LOOK_TICKS as usize;
        let mut writer = Writer::new(axes, units, begins, board.full_power());
        let ready = writer.ready(board.is_homed.then_some(ZERO));
        let unlock = board.is_locked.then(|| "$X".to_owned());
        Ok(Self {
            teller: Teller::new(Controller::new(config), gear, at, homed, shut_ticks),
            sender: Sender::new(writer, pace, board.characters, unlock.into_iter().chain(ready)),
            stage: Stage::SettingUp,
            lines: Lines::default(),
            parked: false,
            ahead: stops.clamp(LEAST_AHEAD, MOST_AHEAD),
            urgent: NO_OVERRIDES.to_vec(),
            halted: Vec::new(),
            rewinds: None,
            ready: VecDeque::new(),
            alive_us: None,
            due_us: now_us,
            asked_us: now_us,
            heard_us: now_us,
            status: None,
            board,
        })
    }

    /// The board.
    pub const fn board(&self) -> &Board {
        &self.board
    }

    /// Why it is driven no more, if it is not.
    pub const fn trouble(&self) -> Option<&Trouble> {
        if let Stage::Failed(trouble) = &self.stage { Some(trouble) } else { None }
    }

    /// Whether it is known where the head points.
    pub fn is_homed(&self) -> bool {
        self.state().is_homed()
    }

    /// In how many dark ticks there may be light where nobody knows where it fell before.
    pub fn opens_in_ticks(&self) -> u32 {
        self.state().opens_in_ticks(self.teller.controller().config())
    }

    /// Whether the board has nothing to do, and all that it needs to know was said to it.
    pub fn is_settled(&self) -> bool {
        self.stage == Stage::Ready && self.sender.is_quiet() && self.sender.is_idle()
    }

    /// Most characters that waited in the board's memory.
    pub const fn most_waiting(&self) -> usize {
        self.sender.most_waiting
    }

    fn state(&self) -> &State {
        self.teller.state()
    }

    /// The next tick that the board has done.
    pub fn telemetry(&mut self) -> Option<Telemetry> {
        self.ready.pop_front()
    }

    /// Hands a command over.
    ///
    /// # Errors
    /// The command, if there is no room for it, or the head cannot do it now.
    pub fn send(&mut self, command: Command, now_us: u64) -> Result<(), Command> {
        if command == Command::KeepAlive {
            self.alive_us = Some(now_us);
            self.teller.hear();
            return Ok(());
        }
        match self.stage {
            Stage::Failed(_) => Err(command),
            Stage::Ready => self.take_command(command, now_us),
            // a rig that is halted does nothing of a plan
            _ if matches!(command, Command::Append(_) | Command::Finish | Command::Home(_)) => Err(command),
            _ => {
                if self.halted.last() != Some(&command) {
                    self.halted.push(command);
                }
                Ok(())
            }
        }
    }

    fn take_command(&mut self, command: Command, now_us: u64) -> Result<(), Command> {
        let is_still = self.teller.is_still() && self.sender.is_idle();
        match command {
            Command::Disarm | Command::Abandon | Command::Unhome if !is_still => {
                self.halted.push(command);
                self.halt(now_us);
                return Ok(());
            }
            Command::Home(_) if !is_still || !self.sender.orders.is_empty() => return Err(command),
            _ => self.teller.accept(command)?,
        }
        match command {
            Command::Home(counts) => self.home(counts),
            Command::Unhome => self.unhome(),
            _ => {}
        }
        Ok(())
    }

    /// Has the board remember where the head points.
    fn home(&mut self, counts: PanTilt<i32>) {
        let (axes, at) = (self.sender.writer.axes, self.teller.raw_steps());
        let zero = PanTilt::from_fn(|j| at[j] - (axes[j].sign() * f64::from(counts[j])) as i64);
        let order = self.sender.writer.home(zero, ZERO_NUMBER);
        self.sender.orders.extend([order, ZERO.to_owned()]);
        self.board.is_homed = true;
    }

    fn unhome(&mut self) {
        self.sender.orders.push_back("G54".to_owned());
        let plain = &self.board.plain;
        let axes = self.sender.writer.axes;
        self.sender.writer.begins = PanTilt::from_fn(|j| plain.get(axes[j].index()).copied().unwrap_or(0.0));
        self.sender.writer.forget();
        self.board.is_homed = false;
    }

    /// Stops what the board does, and forgets what it has not done.
    fn halt(&mut self, now_us: u64) {
        if self.sender.follower.is_idle() {
            // nothing of it is on the board
            let done = self.bound(now_us);
            self.let_go(done);
            self.rewinds = Some(self.teller.last_done());
            self.go_back();
            return;
        }
        self.urgent.extend([HOLD, ASK]);
        self.asked_us = now_us;
        self.stage = Stage::Stopping(now_us);
    }

    /// Back to what is done, of a head that rests there; then what was asked meanwhile.
    fn go_back(&mut self) {
        if let Some(tick) = self.rewinds.take() {
            let at = self.rests_at();
            self.teller.rewind(tick, at);
        }
        self.sender.items.clear();
        (self.parked, self.sender.speed) = (false, 0.0);
        self.stage = Stage::Ready;
        for command in std::mem::take(&mut self.halted) {
            // who is disarmed is still
            let _ = self.teller.accept(command);
            if command == Command::Unhome {
                self.unhome();
            }
        }
    }

    /// Where the head rests, in steps of the machine, by the last report; where it was told to be before there was one.
    fn rests_at(&self) -> PanTilt<i64> {
        self.status
            .as_ref()
            .and_then(|status| self.sender.writer.place_of(status))
            .map_or_else(|| self.teller.raw_steps(), |at| at.map(|at| at.round() as i64))
    }

    /// What is to be said now is added to the bytes.
    pub fn give(&mut self, now_us: u64, out: &mut Vec<u8>) {
        if !matches!(self.stage, Stage::Failed(_)) {
            self.go_on(now_us);
        }
        out.append(&mut self.urgent);
        if let Stage::Ready | Stage::SettingUp = self.stage {
            let (teller, parked) = (&self.teller, self.parked);
            let is_known = |item: &Item| {
                let known = teller.next().wrapping_sub(item.ends);
                parked || known >= LOOK_TICKS || teller.is_short()
            };
            self.sender.give(is_known, now_us, out);
        }
    }

    fn go_on(&mut self, now_us: u64) {
        let moves = !self.sender.follower.is_idle();
        match self.stage {
            Stage::Ready => {
                self.tell(now_us);
                self.let_go(self.bound(now_us));
            }
            Stage::Stopping(since) if now_us > since + MOST_HOLDING_US => self.reset(now_us),
            Stage::Resetting(since) if now_us > since + MOST_SILENT_US => {
                self.fail(Trouble::Silent { waited_s: (now_us - since) as f64 * 1e-6 });
                return;
            }
            Stage::SettingUp if self.sender.is_quiet() => {
                let rests = |status: &Status| matches!(status.state, Doing::Idle);
                if self.status.as_ref().is_some_and(rests) {
                    self.due_us = now_us;
                    self.go_back();
                }
            }
            _ => {}
        }
        let often_us = match self.stage {
            Stage::Ready
                if moves
                    && (self.parked && self.sender.items.is_empty() || self.sender.follower.begins()) =>
            {
                ASK_WAITED_US
            }
            Stage::Ready if moves => ASK_MOVING_US,
            Stage::Ready => ASK_RESTING_US,
            _ => ASK_WAITED_US,
        };
        if now_us >= self.asked_us + often_us && self.urgent.is_empty() {
            self.urgent.push(ASK);
            self.asked_us = now_us;
        }
        let waits = moves || !self.sender.window.is_empty() || self.stage != Stage::Ready;
        if waits && now_us > self.heard_us + MOST_SILENT_US {
            let waited_s = (now_us - self.heard_us) as f64 * 1e-6;
            self.fail(Trouble::Silent { waited_s });
        } else if !waits {
            // a report is due each half second; who is not asked is not late
            self.heard_us = self.heard_us.max(now_us.saturating_sub(MOST_SILENT_US / 2));
        }
    }

    /// Lets the controller run ahead, or by the clock while nothing moves.
    fn tell(&mut self, now_us: u64) {
        let alive = self.alive_us.is_some_and(|alive| now_us <= alive + ALIVE_US);
        loop {
            let idle = self.sender.is_idle();
            if idle && self.teller.ahead() == 0 && (self.parked || self.teller.is_still()) {
                if self.parked {
                    (self.parked, self.due_us) = (false, now_us);
                    self.sender.orders.extend(self.sender.writer.dark());
                }
                if now_us < self.due_us {
                    return;
                }
                self.due_us = (self.due_us + TICK_US).max(now_us.saturating_sub(MOST_LATE_US));
                if self.teller.tell(alive, &mut self.sender.items) {
                    self.let_go(self.teller.next());
                }
                continue;
            }
            let is_short = self.teller.is_short() && self.teller.ahead() >= SHORT_AHEAD;
            if is_short && !self.parked && self.teller.settle(&mut self.sender.items) {
                self.park(now_us);
            }
            if self.parked || is_short || self.teller.ahead() >= self.ahead {
                return;
            }
            if self.teller.tell(alive, &mut self.sender.items) {
                self.park(now_us);
            }
        }
    }

    /// Nothing more is told until the rest that was told is over; without anything on the board, it begins now.
    fn park(&mut self, now_us: u64) {
        self.parked = true;
        if self.sender.is_idle() {
            let first = self.teller.next().wrapping_sub(self.teller.ahead() as u32);
            self.sender.follower.set(first, now_us);
        }
    }

    /// The first tick that is not done.
    fn bound(&self, now_us: u64) -> u32 {
        let by_clock = self.sender.follower.by_clock(now_us);
        let unsent = self.sender.items.front().map(|item| item.ends.wrapping_sub(item.ticks));
        let bound = match (self.sender.follower.until(), unsent) {
            (Some(until), _) => until,
            (None, Some(begins)) => begins,
            (None, None) if self.parked => self.teller.next(),
            (None, None) => self.teller.settled(),
        };
        if bound.wrapping_sub(by_clock).cast_signed() > 0 { by_clock } else { bound }
    }

    /// Ticks before that one are done.
    fn let_go(&mut self, before: u32) {
        while let Some(told) = self.teller.release(before) {
            self.ready.push_back(told);
        }
        self.sender.follower.drop_before(before);
    }

    /// Hears what the board says.
    pub fn take(&mut self, bytes: &[u8], now_us: u64) {
        for &byte in bytes {
            let Some(said) = self.lines.push(byte) else { continue };
            self.heard_us = now_us;
            if !matches!(self.stage, Stage::Failed(_)) {
                self.hear(said, now_us);
            }
        }
    }

    fn hear(&mut self, said: Said, now_us: u64) {
        match said {
            Said::Ok => {
                if self.stage == Stage::SettingUp {
                    // where work coordinates begin may have changed: only a later report counts
                    self.status = None;
                }
                let ends = self.sender.window.answered().and_then(|line| line.ends);
                if let Some(ends) = ends {
                    self.sender.follower.taken(ends, now_us);
                }
            }
            // what was on its way when it was halted is refused, and not wanted
            Said::Error(_) if matches!(self.stage, Stage::Stopping(_) | Stage::Resetting(_)) => {
                self.sender.window.answered();
            }
            Said::Error(code) => {
                let line = self.sender.window.answered().map(|line| line.text).unwrap_or_default();
                self.fail(Trouble::Refused { line, code });
            }
            Said::Alarm(code) => self.fail(Trouble::Alarm { code }),
            Said::Welcome(_) if matches!(self.stage, Stage::Resetting(_)) => {
                self.stage = Stage::SettingUp;
                self.sender.window.clear();
                self.status = None;
                self.sender.orders = self.sender.writer.ready(self.board.is_homed.then_some(ZERO)).into();
            }
            // it starts twice where a port was just opened
            Said::Welcome(_) => self.fail(Trouble::Reset),
            Said::Status(status) => self.hear_status(status, now_us),
            Said::Setting(..) | Said::Told(..) | Said::Other(_) => {}
        }
    }

    fn hear_status(&mut self, status: Status, now_us: u64) {
        let at = self.sender.writer.place_of(&status);
        let state = status.state;
        if status.overrides.is_some_and(|overrides| overrides != [100; 3]) {
            self.urgent.extend(NO_OVERRIDES);
        }
        self.status = Some(status);
        match (state, &self.stage) {
            (Doing::Door, _) => self.fail(Trouble::Door),
            (Doing::Alarm, Stage::Ready) => self.fail(Trouble::Alarm { code: 0 }),
            (Doing::Held | Doing::Idle, Stage::Stopping(_)) => {
                if let Some(at) = at {
                    self.stopped_at(at, state == Doing::Idle, now_us);
                }
                self.reset(now_us);
            }
            (Doing::Held | Doing::Holding, Stage::Ready) => {
                // somebody pressed the board's own button
                self.halted.push(Command::Disarm);
                self.stage = Stage::Stopping(now_us);
            }
            (Doing::Idle, Stage::Ready) if self.sender.window.is_empty() => self.sender.follower.done(now_us),
            (Doing::Run, Stage::Ready) => {
                if let Some((at, until)) = at.zip(self.sender.follower.until()) {
                    let tick = self.teller.tick_at(at, self.sender.follower.by_clock(now_us), until);
                    self.sender.follower.at(tick, now_us);
                }
            }
            _ => {}
        }
    }

    /// The board stands there on its way: so much of it is done.
    fn stopped_at(&mut self, at: PanTilt<f64>, is_idle: bool, now_us: u64) {
        if is_idle && self.sender.window.is_empty() {
            self.sender.follower.done(now_us);
        }
        let until = self.sender.follower.until().unwrap_or_else(|| self.bound(now_us)).wrapping_add(1);
        let tick = self.teller.tick_at(at, self.sender.follower.by_clock(now_us), until);
        self.let_go(tick.wrapping_add(1));
        self.rewinds = Some(tick);
    }

    fn reset(&mut self, now_us: u64) {
        self.rewinds = self.rewinds.or_else(|| Some(self.teller.last_done()));
        self.urgent = vec![RESET];
        self.stage = Stage::Resetting(now_us);
        self.sender.follower.clear();
        self.asked_us = now_us;
    }

    /// Nothing goes on; the board is told to stop at once.
    fn fail(&mut self, trouble: Trouble) {
        let is_lost = matches!(trouble, Trouble::Silent { .. } | Trouble::Refused { .. } | Trouble::Door);
        self.urgent = if is_lost { vec![HOLD, RESET] } else { Vec::new() };
        self.stage = Stage::Failed(trouble);
    }
}
