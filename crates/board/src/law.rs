//! What a law does with senses that are always the same.

use tracelight_control::{Config, Controller, State};
use tracelight_rig::wire::crc32;
use tracelight_rig::{Command, Measurement, PanTilt, RateLimit, Segment, Sensed};

/// Ticks that are hashed.
const TICKS: u32 = 400;
/// Ticks of each of two moves, there and back.
const MOVE_TICKS: u16 = 150;
/// Length of a move, rad.
const MOVE_RAD: f32 = 0.01;

/// Hash of the volts, angles and gates of some hundred ticks by a configuration. Two programs that compute the same law, on whatever processors, have the same;
/// a host and a board that have not would not do the same.
pub fn law_hash(config: &Config) -> u32 {
    let controller = Controller::new(*config);
    let counts = |angle_rad: f32| (angle_rad / config.axes.pan.count_rad) as i32;
    let sensed = |angle_rad: f32, age: u32| Sensed {
        encoders: PanTilt::new(
            Measurement { count: counts(angle_rad), edge_age_ticks: age.is_multiple_of(5).then_some(0.25) },
            Measurement {
                count: -counts(0.5 * angle_rad),
                edge_age_ticks: age.is_multiple_of(7).then_some(0.75),
            },
        ),
        ..Sensed::default()
    };
    let mut state: State<4> = controller.start_homed(&sensed(0.0, 1));
    let there = segment(0, 0.0, MOVE_RAD);
    let back = segment(u32::from(MOVE_TICKS), MOVE_RAD, 0.0);
    for command in [
        Command::KeepAlive,
        Command::Arm { acknowledges: 0 },
        Command::Append(there),
        Command::Append(back),
        Command::Finish,
    ] {
        // what is refused is refused by either
        let _ = controller.accept(&mut state, command);
    }
    let mut hash = 0_u32;
    for tick in 0..TICKS {
        let planned = if tick < MOVE_TICKS.into() { there } else { back };
        let at = planned.sample(tick.saturating_sub(planned.start_tick).min(MOVE_TICKS.into()) as f32);
        let _ = controller.accept(&mut state, Command::KeepAlive);
        let told = controller.tick(&mut state, &sensed(at.pan.position_rad, tick));
        let words = [
            hash,
            told.actuation.command_v.pan.to_bits(),
            told.actuation.command_v.tilt.to_bits(),
            told.position_rad.pan.to_bits(),
            told.position_rad.tilt.to_bits(),
            told.phase as u32 | u32::from(told.darkness.bits()) << 8,
        ];
        let mut bytes = [0; 24];
        let told = words.into_iter().flat_map(u32::to_le_bytes);
        bytes.iter_mut().zip(told).for_each(|(place, byte)| *place = byte);
        hash = crc32(&bytes);
    }
    hash
}

/// A lit move from rest to rest: 10 s³ − 15 s⁴ + 6 s⁵ of the way.
fn segment(start_tick: u32, from_rad: f32, to_rad: f32) -> Segment {
    let (way, n) = (to_rad - from_rad, f32::from(MOVE_TICKS));
    let (n3, n4) = (n * n * n, n * n * n * n);
    let pan = [from_rad, 0.0, 0.0, 10.0 * way / n3, -15.0 * way / n4, 6.0 * way / (n4 * n)];
    Segment {
        start_tick,
        ticks: MOVE_TICKS,
        coefficients: PanTilt::new(pan, pan.map(|value| -0.5 * value)),
        tolerance_rad: PanTilt::new(5e-3, 5e-3),
        gate: true,
        rate_limit: RateLimit::PLANNED,
    }
}
