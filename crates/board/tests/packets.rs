//! Packets that are spoilt, on a board that is armed and draws: whatever becomes of them, it goes on as it was, or is dark.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a test fails by panicking, and shows figures")]

use tracelight_board::{Board, Identity};
use tracelight_device::{Host, Stage};
use tracelight_rig::wire::{Ask, MOST_PACKET, Order, Reset, ToBoard, packed};
use tracelight_rig::{
    Actuation, Capabilities, Command, Measurement, PanTilt, RateLimit, Segment, Sensed, Telemetry,
};
use tracelight_sim::RigConfig;

/// The connection's number, and the byte by which its packets are known.
const SESSION: u32 = 5;
/// Lit ticks before a packet comes, and after it.
const BEFORE: usize = 400;
const AFTER: usize = 150;

/// A board whose head goes where it is told, and its host.
#[derive(Clone)]
struct Bench {
    host: Host,
    board: Board<64, 256>,
    told: Telemetry,
    count_rad: f32,
    now_us: u64,
}

impl Bench {
    fn new() -> Self {
        // without encoders nothing is asked of them: here they would follow what they are told, not their motors
        let config = RigConfig::preset("stepper").unwrap().control_config();
        let capabilities = Capabilities { absolute: true, stamps: true, ..Capabilities::default() };
        let identity = Identity::emulated(capabilities, Reset::PowerUp);
        let count_rad = config.axes.pan.count_rad;
        let (host, board) = (Host::new(config, SESSION), Board::new(identity));
        Self { host, board, told: Telemetry::default(), count_rad, now_us: 0 }
    }

    /// A tick with these bytes on the line besides what the host says.
    fn tick(&mut self, besides: &[u8]) -> Actuation {
        let _ = self.host.send(Command::KeepAlive);
        let mut bytes = Vec::new();
        self.host.give(self.now_us, &mut bytes);
        self.board.take(&bytes, 0);
        self.board.take(besides, 0);
        let measured = |j| {
            let setpoint = self.told.setpoint[j];
            Measurement {
                count: (setpoint.position_rad / self.count_rad).round() as i32,
                edge_age_ticks: None,
            }
        };
        let sensed = Sensed { encoders: PanTilt::from_fn(measured), ..Sensed::default() };
        let actuation = self.board.tick(&sensed);
        let mut out = [0; 8 * MOST_PACKET];
        let length = self.board.give(&mut out);
        self.host.take(&out[..length], self.now_us);
        while let Some(told) = self.host.telemetry() {
            self.told = told;
        }
        self.now_us += 1000;
        actuation
    }

    /// Armed, and some way along a lit circle.
    fn drawing() -> Self {
        let mut bench = Self::new();
        while bench.host.stage() != Stage::Running {
            bench.tick(&[]);
        }
        bench.host.send(Command::Arm { acknowledges: 0 }).unwrap();
        let mut next = 0;
        for _ in 0..BEFORE {
            while next < 40 && bench.host.send(Command::Append(segment(next))).is_ok() {
                next += 1;
            }
            bench.tick(&[]);
        }
        bench
    }

    /// What is done from now on, if these bytes come.
    fn goes_on(&self, besides: &[u8]) -> Vec<Actuation> {
        let mut bench = self.clone();
        let first = bench.tick(besides);
        std::iter::once(first).chain((1..AFTER).map(|_| bench.tick(&[]))).collect()
    }
}

/// A stretch of a slow sway from zero on, in pieces of 25 ticks.
fn segment(number: u32) -> Segment {
    let way = 2e-3;
    let from = if number.is_multiple_of(2) { 0.0 } else { way };
    let sign = if number.is_multiple_of(2) { way } else { -way };
    let n: f32 = 25.0;
    let n3 = n * n * n;
    let quintic = [from, 0.0, 0.0, 10.0 * sign / n3, -15.0 * sign / (n3 * n), 6.0 * sign / (n3 * n * n)];
    Segment {
        start_tick: 25 * number,
        ticks: 25,
        coefficients: PanTilt::new(quintic, quintic),
        tolerance_rad: PanTilt::new(5e-3, 5e-3),
        gate: true,
        rate_limit: RateLimit::PLANNED,
    }
}

/// What a host may say to it then, each of them valid.
fn said() -> Vec<ToBoard<'static>> {
    let order = |ask| ToBoard::Order(Order { sequence: 41, ask });
    let command = |command| order(Ask::Command(command));
    vec![
        ToBoard::Hello { version: (1, 0), session: 9, program: [0; 8] },
        ToBoard::Configure { offset: 0, bytes: &[1, 2, 3, 4] },
        ToBoard::Commit { length: 600, crc: 77 },
        order(Ask::Arm { nonce: 2, acknowledges: 0 }),
        command(Command::Append(segment(40))),
        command(Command::Finish),
        command(Command::Home(PanTilt::new(5, 5))),
        command(Command::Unhome),
        command(Command::Point(500)),
        command(Command::Speed(0.7)),
        command(Command::Pause),
        command(Command::Abandon),
        command(Command::Acknowledge { fault: 0 }),
        ToBoard::KeepAlive { host_us: 3 },
        ToBoard::Disarm { before: 41, number: 1 },
        ToBoard::Again { from: 3, count: 4 },
        ToBoard::Seen { number: 0 },
    ]
}

fn on_wire(body: &[u8]) -> Vec<u8> {
    let mut out = [0; MOST_PACKET];
    let length = packed(body, &mut out);
    out[..length].to_vec()
}

#[test]
fn a_packet_of_which_any_byte_is_another_changes_nothing() {
    let bench = Bench::drawing();
    let usual = bench.goes_on(&[]);
    assert!(usual.iter().filter(|actuation| actuation.lights()).count() > AFTER / 2, "nothing to see");
    let mut tried = 0;
    for said in said() {
        let whole = on_wire(said.body(SESSION as u8).bytes());
        for at in 0..whole.len() {
            for bit in 0..8 {
                let mut wrong = whole.clone();
                wrong[at] ^= 1 << bit;
                // the next zero ends it, whatever became of its own
                wrong.push(0);
                assert_eq!(bench.goes_on(&wrong)[..20], usual[..20], "{said:?}, byte {at}, bit {bit}");
                tried += 1;
            }
        }
    }
    println!("{tried} spoilt packets, none had an effect");
}

/// What a checksum does not stop, once in a long time, or a program that is wrong: another packet, whole. It may be another order; it lets out no light that was not there.
#[test]
fn a_packet_that_says_something_else_only_darkens() {
    let bench = Bench::drawing();
    let usual = bench.goes_on(&[]);
    let (mut tried, mut darker) = (0, 0);
    for said in said() {
        let body = said.body(SESSION as u8);
        for at in 0..body.bytes().len() {
            for bit in [0, 3, 7] {
                let mut wrong = body.bytes().to_vec();
                wrong[at] ^= 1 << bit;
                let now = bench.goes_on(&on_wire(&wrong));
                let is_lit = |of: &[Actuation]| of.iter().map(Actuation::lights).collect::<Vec<_>>();
                let new_light = is_lit(&now).iter().zip(is_lit(&usual)).any(|(now, usual)| *now && !usual);
                assert!(!new_light, "{said:?}, byte {at}, bit {bit}: light that was not there");
                darker += u32::from(is_lit(&now) != is_lit(&usual));
                tried += 1;
            }
        }
    }
    println!("{tried} packets that say something else: {darker} darken, none lights");
    assert!(darker > 20, "{darker}");
}
