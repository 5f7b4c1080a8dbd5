//! Both halves of a board do what its host can follow, whenever a tick interrupts what speaks.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

use oorandom::Rand32;
use tracelight_board::{Between, Identity, Machine, Server};
use tracelight_control::Config;
use tracelight_device::{Host, Stage};
use tracelight_plant::Plant;
use tracelight_rig::wire::{MOST_PACKET, Reset, ToBoard};
use tracelight_rig::{
    Actuation, Capabilities, Command, Head as _, Inputs, PanTilt, Phase, RateLimit, Segment, Sensed,
};
use tracelight_sim::RigConfig;

const SEGMENTS: usize = 64;
const ROWS: usize = 256;
const TICK_US: u64 = 1000;
/// Ticks of a segment, and how many are drawn.
const LONG: u16 = 100;
const MANY: u32 = 40;

const CAPABILITIES: Capabilities = Capabilities {
    stamps: true,
    gate_watched: true,
    light_watched: true,
    gyroscope: false,
    times_ticks: true,
    absolute: true,
    inputs: Inputs::ABSENT,
};

/// A head on bridges.
fn rig() -> RigConfig {
    RigConfig::preset("bridge").unwrap()
}

fn config() -> Config {
    rig().control_config()
}

fn identity() -> Identity {
    Identity::emulated(CAPABILITIES, Reset::PowerUp)
}

/// To and fro, lit every second time.
fn segment(number: u32) -> Segment {
    let way = if number.is_multiple_of(2) { 0.01_f32 } else { -0.01 };
    let n = f32::from(LONG);
    let from = if number.is_multiple_of(2) { 0.0 } else { 0.01 };
    let quintic = [from, 0.0, 0.0, 10.0 * way / n.powi(3), -15.0 * way / n.powi(4), 6.0 * way / n.powi(5)];
    Segment {
        start_tick: u32::from(LONG) * number,
        ticks: LONG,
        coefficients: PanTilt::new(quintic, quintic.map(|c| -c)),
        tolerance_rad: PanTilt::new(0.05, 0.05),
        gate: !number.is_multiple_of(2),
        rate_limit: RateLimit::PLANNED,
    }
}

/// A host that has a drawing drawn, and the head.
struct Wall {
    host: Host,
    plant: Plant,
    sensed: Sensed,
    now_us: u64,
    next: u32,
    is_armed: bool,
    lit_ticks: u32,
    is_done: bool,
}

impl Wall {
    fn new() -> Self {
        let plant = Plant::new(&rig().plant_config(), 3);
        let sensed = Sensed {
            encoders: plant.measured(),
            laser_on: Some(false),
            light: Some(false),
            ..Sensed::default()
        };
        let host = Host::new(config(), 7);
        Self { host, plant, sensed, now_us: 0, next: 0, is_armed: false, lit_ticks: 0, is_done: false }
    }

    /// What the host says now, having heard this.
    fn says(&mut self, heard: &[u8]) -> Vec<u8> {
        self.host.take(heard, self.now_us);
        while let Some(told) = self.host.telemetry() {
            self.lit_ticks += u32::from(told.actuation.lights());
            self.is_done |= told.phase == Phase::Done;
            let _ = self.host.send(Command::KeepAlive);
        }
        if self.host.stage() == Stage::Running {
            if !self.is_armed {
                self.is_armed = self.host.send(Command::Arm { acknowledges: 0 }).is_ok();
            }
            while self.next < MANY && self.host.send(Command::Append(segment(self.next))).is_ok() {
                self.next += 1;
            }
            if self.next == MANY {
                self.next += u32::from(self.host.send(Command::Finish).is_ok());
            }
        }
        let mut bytes = Vec::new();
        self.host.give(self.now_us, &mut bytes);
        bytes
    }

    fn moves(&mut self, actuation: &Actuation) {
        self.sensed = Sensed { inputs: Inputs::ABSENT, foot_rad_s: None, ..self.plant.exchange(actuation) };
    }

    fn check(&self) {
        assert_eq!(self.host.stage(), Stage::Running);
        assert!(self.is_done && self.lit_ticks > u32::from(LONG), "{} ticks lit", self.lit_ticks);
    }
}

/// Bytes come in pieces, ticks between any two of them, and all that a host sends again comes twice at once.
#[test]
fn whenever_a_tick_comes_the_host_can_follow_it() {
    for seed in 0..20 {
        let mut dice = Rand32::new(seed);
        let (mut server, mut machine) = (Server::<SEGMENTS, ROWS>::new(identity()), Machine::new());
        let mut between = Between::new();
        let (mut speaker, mut ticker) = between.halves(&mut server, &mut machine);
        let mut wall = Wall::new();
        let mut said = Vec::new();
        for _ in 0..u32::from(LONG) * MANY + 3000 {
            let mut bytes = wall.says(&said);
            said.clear();
            if dice.rand_range(0..8) == 0 {
                bytes.extend(bytes.clone());
            }
            wall.now_us += TICK_US;
            let ticks_at = dice.rand_range(0..bytes.len() as u32 + 1) as usize;
            let mut tick = |wall: &mut Wall| {
                let sensed = wall.sensed;
                let done = ticker.tick(&sensed, wall.now_us as u32);
                assert_eq!(done.drives, done.limit_v.is_some());
                // what the bridges are told is a share of their supply
                let supply_v = rig().plant_config().motors.map(|motor| motor.limit_v as f32);
                assert!(done.limit_v.is_none_or(|limit_v| limit_v == supply_v));
                wall.moves(&done.actuation);
            };
            let mut at = 0;
            let mut has_ticked = false;
            while at < bytes.len() {
                let to = (at + dice.rand_range(1..64) as usize).min(bytes.len());
                speaker.take(&bytes[at..to], wall.now_us as u32);
                if to > ticks_at && !has_ticked {
                    has_ticked = true;
                    tick(&mut wall);
                }
                at = to;
            }
            if !has_ticked {
                tick(&mut wall);
            }
            // a main loop that is held up for some ticks
            if dice.rand_range(0..4) > 0 {
                speaker.round();
                let mut out = [0; 8 * MOST_PACKET];
                let length = speaker.give(&mut out);
                said.extend_from_slice(&out[..length]);
            }
        }
        wall.check();
    }
}

#[test]
fn a_configuration_that_comes_twice_begins_once() {
    let (mut server, mut machine) = (Server::<SEGMENTS, ROWS>::new(identity()), Machine::new());
    let mut between = Between::new();
    let (mut speaker, mut ticker) = between.halves(&mut server, &mut machine);
    let mut wall = Wall::new();
    let sensed = wall.sensed;
    let mut commits = 0;
    for _ in 0..200 {
        let mut out = [0; 8 * MOST_PACKET];
        let length = speaker.give(&mut out);
        let bytes = wall.says(&out[..length]);
        // it was handed over, and no tick has begun with it yet
        speaker.take(&bytes, 0);
        speaker.take(&bytes, 0);
        ticker.tick(&sensed, 0);
        speaker.round();
        ticker.tick(&sensed, 0);
        commits += u32::from(ticker.machine().state().is_some());
        wall.now_us += 2 * TICK_US;
    }
    assert!(commits > 100);
    assert_eq!(wall.host.stage(), Stage::Running, "the host's controller began when the board's did");
}

#[test]
fn who_hangs_up_leaves_it_dark_and_a_loop_that_hangs_is_not_well() {
    let (mut server, mut machine) = (Server::<SEGMENTS, ROWS>::new(identity()), Machine::new());
    let mut between = Between::new();
    let (mut speaker, mut ticker) = between.halves(&mut server, &mut machine);
    let mut wall = Wall::new();
    let mut said = Vec::new();
    let mut lit = 0;
    while lit < 20 {
        let bytes = wall.says(&said);
        speaker.take(&bytes, 0);
        wall.now_us += TICK_US;
        let sensed = wall.sensed;
        let done = ticker.tick(&sensed, 0);
        assert!(done.is_well);
        wall.moves(&done.actuation);
        lit += u32::from(done.actuation.lights());
        speaker.round();
        let mut out = [0; 8 * MOST_PACKET];
        let length = speaker.give(&mut out);
        said = out[..length].to_vec();
    }
    speaker.hang_up();
    let sensed = wall.sensed;
    assert!(!ticker.tick(&sensed, 0).actuation.gate, "in the next tick");
    // an Arm that was on its way lights nothing
    let mut packet = [0; MOST_PACKET];
    let order = tracelight_rig::wire::Order {
        sequence: 0,
        ask: tracelight_rig::wire::Ask::Arm { nonce: 99, acknowledges: 0 },
    };
    let length = ToBoard::Order(order).packed(7, &mut packet);
    speaker.take(&packet[..length], 0);
    let well = (0..200).filter(|_| ticker.tick(&sensed, 0).is_well).count();
    assert!((80..110).contains(&well), "{well} ticks");
}
