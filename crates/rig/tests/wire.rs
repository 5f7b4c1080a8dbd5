//! What a host and a board say, there and back, whole and spoilt.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use tracelight_rig::wire::{
    Ask, Configured, FromBoard, Greeting, Order, Reset, Row, RowBytes, Rows, RowsHeader, ToBoard,
    WrongConfiguration, as_told, is_before,
};
use tracelight_rig::{
    Actuation, Capabilities, Command, DarknessSet, Exceeded, Fault, FaultRecord, Input, InputState, Inputs,
    Joint, Measurement, PanTilt, Phase, RateLimit, Segment, Sensed,
};

/// Seeded numbers (Marsaglia's xorshift).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 8
    }

    fn below(&mut self, most: u64) -> u64 {
        self.roll() % most
    }

    fn flag(&mut self) -> bool {
        self.roll() & 1 == 1
    }

    fn u32(&mut self) -> u32 {
        self.roll() as u32
    }

    /// Any float but those that are none, which equal nothing.
    fn f32(&mut self) -> f32 {
        let any = f32::from_bits(self.u32());
        if any.is_nan() { -0.0 } else { any }
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u64) as usize]
    }

    fn segment(&mut self) -> Segment {
        let mut quintic = || core::array::from_fn(|_| self.f32());
        let coefficients = PanTilt::new(quintic(), quintic());
        Segment {
            start_tick: self.u32(),
            ticks: self.u32() as u16,
            coefficients,
            tolerance_rad: PanTilt::new(self.f32(), self.f32()),
            gate: self.flag(),
            rate_limit: RateLimit { start: self.f32(), end: self.f32() },
        }
    }

    fn ask(&mut self) -> Ask {
        let command = match self.below(10) {
            0 => return Ask::Arm { nonce: self.u32(), acknowledges: self.u32() },
            1 => Command::Append(self.segment()),
            2 => Command::Finish,
            3 => Command::Home(PanTilt::new(self.u32() as i32, self.u32() as i32)),
            4 => Command::Unhome,
            5 => Command::Point(self.u32() as u16),
            6 => Command::Speed(self.f32()),
            7 => Command::Pause,
            8 => Command::Acknowledge { fault: self.u32() },
            _ => Command::Abandon,
        };
        Ask::Command(command)
    }

    fn hosts(&mut self) -> ToBoard<'static> {
        match self.below(8) {
            0 => ToBoard::Hello {
                version: (self.u32() as u8, 3),
                session: self.u32(),
                program: *b"1.2.3\0\0\0",
            },
            1 => ToBoard::Configure { offset: self.u32() as u16, bytes: &[1, 0, 3, 0, 0] },
            2 => ToBoard::Commit { length: self.u32() as u16, crc: self.u32() },
            3 => ToBoard::KeepAlive { host_us: self.roll() },
            4 => ToBoard::Disarm { before: self.u32() as u16, number: self.u32() as u16 },
            5 => ToBoard::Again { from: self.u32(), count: self.u32() as u16 },
            6 => ToBoard::Seen { number: self.u32() },
            _ => ToBoard::Order(Order { sequence: self.u32() as u16, ask: self.ask() }),
        }
    }

    fn inputs(&mut self) -> Inputs {
        let states = [InputState::Absent, InputState::Fine, InputState::Open];
        Input::ALL.into_iter().fold(Inputs::ABSENT, |all, input| all.with(input, self.of(&states)))
    }

    fn capabilities(&mut self) -> Capabilities {
        Capabilities {
            stamps: self.flag(),
            gate_watched: self.flag(),
            light_watched: self.flag(),
            gyroscope: self.flag(),
            times_ticks: self.flag(),
            absolute: self.flag(),
            inputs: self.inputs().opened_by(0),
        }
    }

    fn sensed(&mut self) -> Sensed {
        let mut encoder = || Measurement {
            count: self.u32() as i32,
            edge_age_ticks: self.flag().then(|| self.below(1 << 24) as f32 / (1 << 24) as f32),
        };
        let encoders = PanTilt::new(encoder(), encoder());
        let seen = [None, Some(false), Some(true)];
        Sensed {
            encoders,
            laser_on: self.of(&seen),
            light: self.of(&seen),
            inputs: self.inputs(),
            foot_rad_s: self.flag().then(|| core::array::from_fn(|_| self.f32())),
            lasted_ticks: self.flag().then(|| self.below(300) as f32 / 100.0),
        }
    }

    fn row(&mut self) -> Row {
        Row {
            sensed: as_told(&self.sensed()),
            plan_tick: self.u32(),
            actuation: Actuation {
                command_v: PanTilt::new(self.f32(), self.f32()),
                gate: self.flag(),
                enable: self.flag(),
            },
            darkness: DarknessSet::from_bits(self.u32() as u16),
            phase: self.of(&Phase::ALL),
            fault: self.flag().then(|| self.of(&Fault::ALL)),
            homed: self.flag(),
            taken: self.u32() as u8,
            void: self.flag(),
            heard: self.flag(),
            disarmed: self.flag(),
        }
    }

    fn boards(&mut self) -> FromBoard<'static> {
        match self.below(5) {
            0 => FromBoard::Hello(Greeting {
                version: (self.u32() as u8, self.u32() as u8),
                session: self.u32(),
                firmware: [1, 2, self.u32() as u8],
                source: self.roll().to_le_bytes(),
                board: self.u32() as u16,
                id: self.roll().to_le_bytes(),
                tick_ns: self.u32(),
                segments: self.u32() as u16,
                rows: self.u32() as u16,
                capabilities: self.capabilities(),
                configuration: self.flag().then(|| self.u32()),
                reset: self.of(&Reset::ALL),
                tick: self.u32(),
                nonce: self.u32(),
            }),
            1 => FromBoard::Configured(match self.below(5) {
                0 => Err(WrongConfiguration::Checksum(self.u32())),
                1 => Err(WrongConfiguration::Length(self.u32() as u16)),
                2 => Err(WrongConfiguration::Word { word: self.u32() as u16, bits: self.u32() }),
                3 => Err(WrongConfiguration::Armed),
                _ => Ok(Configured {
                    crc: self.u32(),
                    tick: self.u32(),
                    law: self.u32(),
                    home: self.flag().then(|| PanTilt::new(self.u32() as i32, self.u32() as i32)),
                    heat: self.flag().then(|| PanTilt::new(self.f32(), self.f32())),
                    shut_ticks: self.u32(),
                }),
            }),
            2 => FromBoard::Pong { host_us: self.roll(), tick: self.u32(), tick_us: self.u32() as u16 },
            3 => FromBoard::Fault(FaultRecord {
                fault: self.of(&Fault::ALL),
                number: self.u32(),
                tick: self.u32(),
                joint: self.of(&[None, Some(Joint::Pan), Some(Joint::Tilt)]),
                exceeded: self.flag().then(|| Exceeded { value: self.f32(), bound: self.f32() }),
            }),
            _ => FromBoard::Log("the lid is open"),
        }
    }
}

#[test]
fn whatever_a_host_says_a_board_reads() {
    let mut dice = Dice(1);
    for _ in 0..50_000 {
        let said = dice.hosts();
        let connection = dice.u32() as u8;
        let body = said.body(connection);
        assert!(!body.bytes().is_empty(), "{said:?} does not fit");
        let connection = if matches!(said, ToBoard::Hello { .. }) { 0 } else { connection };
        assert_eq!(ToBoard::read(body.bytes()), Some((said, connection)));
        assert_eq!(FromBoard::read(body.bytes()), None, "{said:?} is no board's");
    }
}

#[test]
fn whatever_a_board_says_a_host_reads() {
    let mut dice = Dice(2);
    for _ in 0..50_000 {
        let said = dice.boards();
        let connection = dice.u32() as u8;
        let body = said.body(connection);
        let connection = if matches!(said, FromBoard::Hello(_)) { 0 } else { connection };
        assert_eq!(FromBoard::read(body.bytes()), Some((said, connection)));
        assert_eq!(ToBoard::read(body.bytes()), None, "{said:?} is no host's");
    }
}

#[test]
fn rows_come_back_bit_for_bit_as_many_as_fit() {
    let mut dice = Dice(3);
    for _ in 0..5000 {
        let inputs = dice.inputs();
        let has_foot = dice.flag();
        let rows: Vec<Row> = (0..9)
            .map(|_| {
                let mut row = dice.row();
                row.sensed.inputs = inputs.opened_by(dice.u32() as u8);
                row.sensed.foot_rad_s = row.sensed.foot_rad_s.or(Some([0.5; 3])).filter(|_| has_foot);
                row
            })
            .collect();
        let header = RowsHeader { first_tick: u32::MAX - 2, wanted: 7, free: 9, disarm: 4, fault_number: 5 };
        let told: Vec<RowBytes> = rows.iter().map(Row::told).collect();
        let (body, count) = Rows::body(3, &header, &told);
        assert_eq!(count, if has_foot { 5 } else { 7 });
        let Some((FromBoard::Rows(read), 3)) = FromBoard::read(body.bytes()) else { panic!("no rows") };
        assert_eq!(read.header, header);
        assert_eq!(read.count, count);
        // half a row is none
        assert_eq!(FromBoard::read(&body.bytes()[..body.bytes().len() - 1]), None);
        let back: Vec<(u32, Row)> = read.rows(inputs).collect();
        let there = rows.iter().take(count.into()).enumerate();
        assert!(there.map(|(at, row)| ((u32::MAX - 2).wrapping_add(at as u32), *row)).eq(back));
    }
}

#[test]
fn what_is_sensed_is_told_within_a_step_and_stays_what_it_is() {
    let mut dice = Dice(4);
    for _ in 0..50_000 {
        let sensed = dice.sensed();
        let told = as_told(&sensed);
        assert_eq!(as_told(&told), told, "twice is as once");
        for joint in Joint::BOTH {
            let (before, after) = (sensed.encoders[joint], told.encoders[joint]);
            assert_eq!(before.count, after.count);
            assert_eq!(before.edge_age_ticks.is_some(), after.edge_age_ticks.is_some());
            let off = before.edge_age_ticks.unwrap_or(0.0) - after.edge_age_ticks.unwrap_or(0.0);
            assert!((0.0..=3.0 / 65536.0).contains(&off), "{off}");
        }
        let off = sensed.lasted_ticks.unwrap_or(0.0).min(255.0 / 128.0) - told.lasted_ticks.unwrap_or(0.0);
        assert!((-1.0 / 128.0..1.0 / 128.0).contains(&off), "{off}");
    }
    // a stamp that cannot be is no number, and a length that is none is late
    let wild = |age: f32| {
        let measured = Measurement { count: 0, edge_age_ticks: Some(age) };
        let encoders = PanTilt::new(measured, measured);
        as_told(&Sensed { encoders, lasted_ticks: Some(f32::NAN), ..Sensed::default() })
    };
    for age in [-0.1, 1.0, f32::NAN, f32::INFINITY] {
        assert!(wild(age).encoders.pan.edge_age_ticks.is_some_and(f32::is_nan), "{age}");
    }
    assert_eq!(wild(0.0).lasted_ticks, Some(255.0 / 128.0));
}

/// What a checksum lets pass once in a long time, and what a program of another version says.
#[test]
fn a_body_that_is_spoilt_is_read_as_something_or_not_at_all() {
    let mut dice = Dice(5);
    let (mut read, mut refused) = (0, 0);
    for _ in 0..200_000 {
        let host = dice.flag();
        let body = if host { dice.hosts().body(1) } else { dice.boards().body(1) };
        let mut bytes = body.bytes().to_vec();
        match dice.below(4) {
            0 => bytes.truncate(dice.below(bytes.len() as u64 + 1) as usize),
            1 => bytes.push(dice.u32() as u8),
            2 => bytes.iter_mut().for_each(|byte| *byte = dice.u32() as u8),
            _ => {
                let at = dice.below(bytes.len() as u64) as usize;
                bytes[at] ^= 1 << dice.below(8);
            }
        }
        let is_read = ToBoard::read(&bytes).is_some() || FromBoard::read(&bytes).is_some();
        *(if is_read { &mut read } else { &mut refused }) += 1;
    }
    assert!(read > 10_000 && refused > 50_000, "{read} {refused}");
}

#[test]
fn numbers_are_before_one_another_across_their_wrap() {
    assert!(is_before(3, 4) && !is_before(4, 4) && !is_before(5, 4));
    assert!(is_before(u16::MAX, 0) && !is_before(0, u16::MAX));
}
