//! A board that speaks as Grbl 1.1 does on an Uno: 15 moves, 128 characters, 115 200 baud, a planner with junction deviation, rests of whole 50 ms.

use std::collections::VecDeque;

use tracelight_maths::hypot;

/// Length of a step of its time, s.
const DT_S: f64 = 1e-4;
const STEPS_A_MS: u32 = 10;
/// Characters that come in a millisecond, and those that its memory holds.
const CHARACTERS_A_MS: usize = 11;
const MEMORY: usize = 127;
const MOVES: usize = 15;
/// How long it takes to read a line, ms.
const LINE_MS: u32 = 2;
const REST_S: f64 = 0.05;

/// Where it stood in a millisecond, in steps, and the share of light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    pub(crate) at: [f64; 2],
    pub(crate) light: f64,
}

#[derive(Clone, Copy, Debug)]
struct Block {
    from: [f64; 2],
    unit: [f64; 2],
    length: f64,
    nominal: f64,
    acceleration: f64,
    most_entry: f64,
    entry: f64,
    power: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Idle,
    Run,
    Hold,
    Alarm,
}

#[derive(Clone, Debug)]
pub(crate) struct Board {
    /// Steps a unit, most rate in units/s, most acceleration in units/s², of both axes; junction deviation in units.
    pub(crate) steps: f64,
    pub(crate) rate: f64,
    pub(crate) acceleration: f64,
    pub(crate) junction: f64,
    pub(crate) laser_mode: u8,
    /// Reports tell places of the workpiece, as with $10=0.
    pub(crate) reports_work: bool,
    /// What it says when it starts, and of itself: other firmware says something else.
    pub(crate) welcome: &'static str,
    pub(crate) options: &'static str,
    /// Characters that its memory holds.
    pub(crate) holds: usize,
    coming: VecDeque<u8>,
    memory: VecDeque<u8>,
    line: String,
    busy_ms: u32,
    said: Vec<u8>,
    blocks: VecDeque<Block>,
    /// Where the last move ends, units of the machine.
    planned: [f64; 2],
    at: [f64; 2],
    along: f64,
    speed: f64,
    mode: Mode,
    /// Work coordinates 1 and 6 begin there; which are in use.
    offsets: [[f64; 2]; 2],
    uses_zero: bool,
    in_inverse_time: bool,
    power: f64,
    constant: bool,
    /// A rest that its line waits for, s.
    rest_s: f64,
    /// Most characters that were in its memory.
    pub(crate) most: usize,
    pub(crate) seen: Vec<Seen>,
    pub(crate) lines: Vec<String>,
    /// What goes wrong: the line of that number is refused.
    pub(crate) refuses: Option<(usize, u16)>,
    /// It hears and says nothing more.
    pub(crate) dead: bool,
}

impl Board {
    pub(crate) fn new(steps: f64) -> Self {
        Self {
            steps,
            rate: 1000.0,
            acceleration: 8000.0,
            junction: 0.01,
            laser_mode: 1,
            reports_work: false,
            welcome: "Grbl 1.1h ['$' for help]",
            options: "[OPT:V,15,128]",
            holds: MEMORY,
            coming: VecDeque::new(),
            memory: VecDeque::new(),
            line: String::new(),
            busy_ms: 0,
            said: Vec::new(),
            blocks: VecDeque::new(),
            planned: [0.0; 2],
            at: [0.0; 2],
            along: 0.0,
            speed: 0.0,
            mode: Mode::Idle,
            offsets: [[0.0; 2]; 2],
            uses_zero: false,
            in_inverse_time: false,
            power: 0.0,
            constant: false,
            rest_s: 0.0,
            most: 0,
            seen: Vec::new(),
            lines: Vec::new(),
            refuses: None,
            dead: false,
        }
    }

    pub(crate) fn knows_zero(&self) -> bool {
        self.uses_zero
    }

    pub(crate) fn hear(&mut self, bytes: &[u8]) {
        self.coming.extend(bytes);
    }

    /// What it says from now on is lost.
    pub(crate) fn say(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.said)
    }

    /// Somebody presses the button of its feed hold, or its end stop.
    pub(crate) fn press_hold(&mut self) {
        self.urgent(b'!');
    }

    pub(crate) fn hit_stop(&mut self) {
        self.tell("ALARM:1");
        self.stop(Mode::Alarm);
    }

    fn tell(&mut self, line: &str) {
        if !self.dead {
            self.said.extend(line.as_bytes());
            self.said.extend(b"\r\n");
        }
    }

    fn stop(&mut self, mode: Mode) {
        self.blocks.clear();
        (self.along, self.speed, self.rest_s, self.power, self.constant) = (0.0, 0.0, 0.0, 0.0, false);
        self.planned = self.at;
        self.mode = mode;
        self.memory.clear();
        self.line.clear();
    }

    /// Where the work coordinates begin that are in use.
    pub(crate) fn begins(&self) -> [f64; 2] {
        self.offsets[usize::from(self.uses_zero)]
    }

    /// A millisecond goes by.
    pub(crate) fn pass(&mut self) {
        for _ in 0..CHARACTERS_A_MS {
            let Some(byte) = self.coming.pop_front() else { break };
            if matches!(byte, b'?' | b'!' | b'~' | 0x18 | 0x80..) {
                self.urgent(byte);
            } else {
                self.memory.push_back(byte);
                self.most = self.most.max(self.memory.len());
            }
        }
        assert!(self.memory.len() <= self.holds, "characters are lost: {} are in memory", self.memory.len());
        (0..STEPS_A_MS).for_each(|_| self.move_on());
        self.read();
        let share = |block: &Block| if self.constant { 1.0 } else { self.speed / block.nominal };
        let light = match self.blocks.front() {
            Some(block) => block.power * share(block).min(1.0),
            None if self.constant && self.mode != Mode::Hold => self.power,
            None => 0.0,
        };
        let at = self.at.map(|at| (at * self.steps).round());
        self.seen.push(Seen { at, light });
    }

    fn urgent(&mut self, byte: u8) {
        match byte {
            b'?' => {
                let state = match self.mode {
                    Mode::Idle => "Idle",
                    Mode::Run => "Run",
                    Mode::Hold if self.speed > 0.0 => "Hold:1",
                    Mode::Hold => "Hold:0",
                    Mode::Alarm => "Alarm",
                };
                let [x, y] = self.at.map(|at| (at * self.steps).round() / self.steps);
                let begins = if self.reports_work { self.begins() } else { [0.0; 2] };
                let (x, y, kind) = (x - begins[0], y - begins[1], if self.reports_work { 'W' } else { 'M' });
                let free = MOVES - self.blocks.len();
                self.tell(&format!("<{state}|{kind}Pos:{x:.3},{y:.3},0.000|Bf:{free},100|FS:0,0>"));
            }
            b'!' if self.mode != Mode::Alarm => self.mode = Mode::Hold,
            0x18 => {
                let loses = self.speed > 0.0;
                self.stop(if loses || self.mode == Mode::Alarm { Mode::Alarm } else { Mode::Idle });
                (self.uses_zero, self.in_inverse_time) = (false, false);
                self.tell("");
                self.tell(self.welcome);
                if loses {
                    self.tell("ALARM:3");
                }
            }
            _ => {}
        }
    }

    fn move_on(&mut self) {
        let Some(&block) = self.blocks.front() else {
            if self.mode == Mode::Run {
                self.mode = Mode::Idle;
            }
            return;
        };
        if self.mode == Mode::Idle || self.mode == Mode::Alarm || self.mode == Mode::Hold && self.speed == 0.0
        {
            return;
        }
        if self.mode == Mode::Hold {
            self.speed = (self.speed - block.acceleration * DT_S).max(0.0);
        } else {
            let exit = self.blocks.get(1).map_or(0.0, |next| next.entry);
            let slowing = (exit * exit + 2.0 * block.acceleration * (block.length - self.along)).sqrt();
            self.speed = (self.speed + block.acceleration * DT_S).min(block.nominal).min(slowing);
        }
        self.along += self.speed * DT_S;
        if self.along >= block.length - 1e-9 {
            self.along = (self.along - block.length).max(0.0);
            self.blocks.pop_front();
            if self.blocks.is_empty() {
                (self.along, self.speed) = (0.0, 0.0);
            }
        }
        let (from, unit, along) = match self.blocks.front() {
            Some(next) => (next.from, next.unit, self.along),
            None => (block.from, block.unit, block.length),
        };
        self.at = [0, 1].map(|i| from[i] + unit[i] * along);
    }

    fn read(&mut self) {
        if self.rest_s > 0.0 {
            if self.blocks.is_empty() && self.mode == Mode::Idle {
                self.rest_s -= 1e-3;
                if self.rest_s <= 0.0 {
                    self.tell("ok");
                }
            } else if self.mode == Mode::Idle {
                self.mode = Mode::Run;
            }
            return;
        }
        self.busy_ms = self.busy_ms.saturating_sub(1);
        if self.busy_ms > 0 || self.blocks.len() >= MOVES {
            if self.mode == Mode::Idle && self.blocks.len() >= MOVES {
                self.mode = Mode::Run;
            }
            return;
        }
        while let Some(byte) = self.memory.pop_front() {
            if byte != b'\n' {
                self.line.push(byte as char);
                continue;
            }
            let line = std::mem::take(&mut self.line);
            self.lines.push(line.clone());
            self.busy_ms = LINE_MS;
            let refused = self.refuses.filter(|(number, _)| *number == self.lines.len());
            match refused.map_or_else(|| self.take(&line), |(_, code)| Err(code)) {
                Ok(true) => self.tell("ok"),
                Ok(false) => {}
                Err(code) => self.tell(&format!("error:{code}")),
            }
            return;
        }
        // nothing more comes: it begins with what it has
        if self.mode == Mode::Idle && !self.blocks.is_empty() {
            self.mode = Mode::Run;
        }
    }

    /// Takes a line; whether it is answered at once.
    fn take(&mut self, line: &str) -> Result<bool, u16> {
        match line {
            "$I" => {
                self.tell("[VER:1.1h.20190830:]");
                self.tell(self.options);
            }
            "$$" => {
                let Self { steps, rate, acceleration, junction, laser_mode, .. } = *self;
                let minute = 60.0 * rate;
                for (number, value) in [
                    (11, junction),
                    (13, 0.0),
                    (20, 0.0),
                    (30, 1000.0),
                    (32, f64::from(laser_mode)),
                    (100, steps),
                    (101, steps),
                    (110, minute),
                    (111, minute),
                    (120, acceleration),
                    (121, acceleration),
                ] {
                    self.tell(&format!("${number}={value:.3}"));
                }
            }
            "$G" => {
                let offset = if self.uses_zero { "G59" } else { "G54" };
                self.tell(&format!("[GC:G1 {offset} G17 G21 G90 G94 M5 M9 T0 F0 S0]"));
            }
            "$#" => {
                for (name, [x, y]) in
                    ["G54", "G59", "G92"].into_iter().zip([self.offsets[0], self.offsets[1], [0.0; 2]])
                {
                    self.tell(&format!("[{name}:{x:.3},{y:.3},0.000]"));
                }
            }
            "$X" => self.mode = Mode::Idle,
            _ if self.mode == Mode::Alarm => return Err(9),
            _ => return self.block(line),
        }
        Ok(true)
    }

    fn block(&mut self, line: &str) -> Result<bool, u16> {
        let (mut to, mut feed, mut wait, mut moves, mut sets_zero) = (self.planned, None, None, false, false);
        let begins = self.begins();
        let letters: Vec<usize> =
            line.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(i, _)| i).collect();
        for (k, &i) in letters.iter().enumerate() {
            let end = letters.get(k + 1).copied().unwrap_or(line.len());
            let value: f64 = line[i + 1..end].parse().map_err(|_| 2_u16)?;
            match (&line[i..=i], value) {
                ("G", 93.0) => self.in_inverse_time = true,
                ("G", 54.0) => self.uses_zero = false,
                ("G", 59.0) => self.uses_zero = true,
                ("G", 10.0) => sets_zero = true,
                ("G", 4.0) => wait = Some(0.0),
                ("P", value) if wait.is_some() => wait = Some(value),
                ("X" | "Y", value) => {
                    let axis = usize::from(&line[i..=i] == "Y");
                    if sets_zero {
                        self.offsets[1][axis] = value;
                    } else {
                        (to[axis], moves) = (value + begins[axis], true);
                    }
                }
                ("F", value) => feed = Some(value),
                ("S", value) => self.power = value / 1000.0,
                ("M", value) => self.constant = value == 3.0,
                _ => {}
            }
        }
        if let Some(wait) = wait {
            self.rest_s = (wait / REST_S).ceil() * REST_S;
            return Ok(false);
        }
        if moves {
            let feed = feed.filter(|_| self.in_inverse_time).ok_or(22_u16)?;
            self.plan(to, feed);
        }
        Ok(true)
    }

    fn plan(&mut self, to: [f64; 2], feed: f64) {
        let to = to.map(|to| (to * self.steps).round() / self.steps);
        let by = [0, 1].map(|i| to[i] - self.planned[i]);
        let length = hypot(by[0], by[1]);
        if length < 1e-9 {
            return;
        }
        let unit = by.map(|by| by / length);
        let along = |limit: f64, of: [f64; 2]| limit / of[0].abs().max(of[1].abs());
        let nominal = (feed / 60.0 * length).min(along(self.rate, unit));
        let corner = self.blocks.back().map_or(0.0, |last| {
            let cos = -(last.unit[0] * unit[0] + last.unit[1] * unit[1]);
            let half = (0.5 * (1.0 - cos)).sqrt();
            let turn = [unit[0] - last.unit[0], unit[1] - last.unit[1]];
            let size = hypot(turn[0], turn[1]).max(1e-9);
            let acceleration = along(self.acceleration, turn.map(|turn| turn / size));
            let speed = (acceleration * self.junction * half / (1.0 - half).max(1e-9)).sqrt();
            if cos > 0.999_999 { 0.0 } else { speed.min(last.nominal).min(nominal) }
        });
        let acceleration = along(self.acceleration, unit);
        let (from, power) = (self.planned, self.power);
        self.blocks.push_back(Block {
            from,
            unit,
            length,
            nominal,
            acceleration,
            most_entry: corner,
            entry: 0.0,
            power,
        });
        self.planned = to;
        self.plan_speeds();
    }

    /// Entry speeds: back from rest at the end, then forwards from the speed that it has.
    fn plan_speeds(&mut self) {
        let mut exit = 0.0_f64;
        for block in self.blocks.iter_mut().skip(1).rev() {
            block.entry =
                block.most_entry.min((exit * exit + 2.0 * block.acceleration * block.length).sqrt());
            exit = block.entry;
        }
        let Some(first) = self.blocks.front() else { return };
        let left = first.length - self.along;
        let mut reached = (self.speed * self.speed + 2.0 * first.acceleration * left).sqrt();
        for block in self.blocks.iter_mut().skip(1) {
            block.entry = block.entry.min(reached);
            reached = (block.entry * block.entry + 2.0 * block.acceleration * block.length).sqrt();
        }
    }
}
