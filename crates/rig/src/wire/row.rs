//! What a board tells of each tick: all that its controller sensed and did, so that a host's own controller can do the same again.

use super::bytes::Rest;
use crate::{Actuation, DarknessSet, Fault, Inputs, Measurement, PanTilt, Phase, Sensed};

/// A tick as a board tells it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// What its head sensed at the start of the tick, [as it can be told](as_told); of its encoders what they read, before homing.
    pub sensed: Sensed,
    /// The plan's clock, whole ticks.
    pub plan_tick: u32,
    /// What is done until the next tick.
    pub actuation: Actuation,
    /// Why the gate is shut.
    pub darkness: DarknessSet,
    /// Supervisor's state.
    pub phase: Phase,
    /// The latched fault, if any.
    pub fault: Option<Fault>,
    /// Whether the rig is homed.
    pub homed: bool,
    /// Orders that were taken before this tick, after a keep-alive and before a Disarm.
    pub taken: u8,
    /// The one of them that lets light out was void; there is one a tick at most.
    pub void: bool,
    /// A keep-alive came before this tick.
    pub heard: bool,
    /// A Disarm came before this tick, which acted last of all.
    pub disarmed: bool,
}

/// Bytes of a row; a gyroscope's three rates come after it.
const BYTES: usize = 32;
/// Bytes of a row with them.
const MOST_BYTES: usize = BYTES + 12;
/// Steps of an edge's stamp in a tick, and the last of them that says when the edge was.
pub const STAMPS_A_TICK: f32 = 65536.0;
/// See [`STAMPS_A_TICK`].
pub const LAST_STAMP: u16 = WRONG_STAMP - 1;
/// Stamp of an encoder that has none, and one that is not within a tick.
const NO_STAMP: u16 = u16::MAX;
const WRONG_STAMP: u16 = u16::MAX - 1;
/// Steps of a tick's length; 0 where it is not measured.
const STEPS_A_TICK: f32 = 128.0;

/// Bits of a row. Phases have three, from [`PHASE`] on.
mod bit {
    pub(super) const GATE: u16 = 1;
    pub(super) const ENABLE: u16 = 1 << 1;
    pub(super) const SWITCH_KNOWN: u16 = 1 << 2;
    pub(super) const SWITCH_ON: u16 = 1 << 3;
    pub(super) const LIGHT_KNOWN: u16 = 1 << 4;
    pub(super) const LIGHT: u16 = 1 << 5;
    pub(super) const HOMED: u16 = 1 << 6;
    pub(super) const HEARD: u16 = 1 << 10;
    pub(super) const DISARMED: u16 = 1 << 11;
    pub(super) const VOID: u16 = 1 << 12;
    pub(super) const FOOT: u16 = 1 << 13;
    pub(super) const ALL: u16 = (1 << 14) - 1;
}
const PHASE: u32 = 7;

/// What a head sensed as a row tells it: stamps in 65536ths of a tick, no number where they are not within it, a tick's length in 128ths, 255 at most. A controller that is given this can be followed by
/// another one that reads the rows.
pub fn as_told(sensed: &Sensed) -> Sensed {
    let stamped = |measured: Measurement| {
        let edge_age_ticks = stamp_of(stamp(measured.edge_age_ticks));
        Measurement { edge_age_ticks, ..measured }
    };
    let PanTilt { pan, tilt } = sensed.encoders;
    Sensed {
        encoders: PanTilt::new(stamped(pan), stamped(tilt)),
        lasted_ticks: length_of(length(sensed.lasted_ticks)),
        ..*sensed
    }
}

fn stamp(age_ticks: Option<f32>) -> u16 {
    match age_ticks {
        None => NO_STAMP,
        // the cast is down
        Some(age) if (0.0..1.0).contains(&age) => ((age * STAMPS_A_TICK) as u16).min(LAST_STAMP),
        Some(_) => WRONG_STAMP,
    }
}

fn stamp_of(stamp: u16) -> Option<f32> {
    match stamp {
        NO_STAMP => None,
        WRONG_STAMP => Some(f32::NAN),
        _ => Some(f32::from(stamp) / STAMPS_A_TICK),
    }
}

fn length(lasted_ticks: Option<f32>) -> u8 {
    // what is no number is as long as can be told: late
    lasted_ticks
        .map_or(0, |ticks| if ticks.is_nan() { u8::MAX } else { ((ticks * STEPS_A_TICK) as u8).max(1) })
}

fn length_of(length: u8) -> Option<f32> {
    (length != 0).then(|| f32::from(length) / STEPS_A_TICK)
}

/// A row as it is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowBytes([u8; MOST_BYTES]);

impl RowBytes {
    /// Of no row.
    pub const NONE: Self = Self([0; MOST_BYTES]);

    /// How many rows these bytes are; `None` if they end within one.
    pub(super) fn count_in(mut bytes: &[u8]) -> Option<usize> {
        let mut count = 0;
        while !bytes.is_empty() {
            let length = if has_foot(bytes) { MOST_BYTES } else { BYTES };
            bytes = bytes.get(length..)?;
            count += 1;
        }
        Some(count)
    }

    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        let Self(bytes) = self;
        let (without, _) = bytes.split_at_checked(BYTES).unwrap_or_default();
        if has_foot(bytes) { bytes } else { without }
    }
}

/// Whether a row that begins with these bytes has a gyroscope's rates.
fn has_foot(bytes: &[u8]) -> bool {
    /// The upper byte of its bits.
    const AT: usize = 27;
    bytes.get(AT).is_some_and(|&byte| u16::from(byte) << 8 & bit::FOOT != 0)
}

impl Row {
    /// As it is told.
    pub fn told(&self) -> RowBytes {
        let Self { sensed, actuation, .. } = self;
        let PanTilt { pan, tilt } = sensed.encoders;
        let stamps = u32::from(stamp(pan.edge_age_ticks)) | u32::from(stamp(tilt.edge_age_ticks)) << 16;
        let last = [
            self.fault.map_or(0, Fault::number),
            sensed.inputs.open_bits(),
            length(sensed.lasted_ticks),
            self.taken,
        ];
        let [ahead, left, up] = sensed.foot_rad_s.unwrap_or_default();
        let words = [
            self.plan_tick,
            pan.count.cast_unsigned(),
            tilt.count.cast_unsigned(),
            stamps,
            actuation.command_v.pan.to_bits(),
            actuation.command_v.tilt.to_bits(),
            u32::from(self.darkness.bits()) | u32::from(self.bits()) << 16,
            u32::from_le_bytes(last),
            ahead.to_bits(),
            left.to_bits(),
            up.to_bits(),
        ];
        let mut bytes = [0; MOST_BYTES];
        let told = words.into_iter().flat_map(u32::to_le_bytes);
        bytes.iter_mut().zip(told).for_each(|(place, byte)| *place = byte);
        RowBytes(bytes)
    }

    fn bits(&self) -> u16 {
        let Self { sensed, actuation, .. } = self;
        let flags = [
            (actuation.gate, bit::GATE),
            (actuation.enable, bit::ENABLE),
            (sensed.laser_on.is_some(), bit::SWITCH_KNOWN),
            (sensed.laser_on == Some(true), bit::SWITCH_ON),
            (sensed.light.is_some(), bit::LIGHT_KNOWN),
            (sensed.light == Some(true), bit::LIGHT),
            (self.homed, bit::HOMED),
            (self.heard, bit::HEARD),
            (self.disarmed, bit::DISARMED),
            (self.void, bit::VOID),
            (sensed.foot_rad_s.is_some(), bit::FOOT),
        ];
        let phase = (self.phase as u16) << PHASE;
        flags.into_iter().filter(|(holds, _)| *holds).fold(phase, |bits, (_, bit)| bits | bit)
    }

    /// Reads the next row of a rig that has these inputs; `None` at the end, or if it is none.
    pub(super) fn read(rest: &mut Rest<'_>, inputs: Inputs) -> Option<Self> {
        let plan_tick = rest.u32()?;
        let counts = PanTilt::new(rest.i32()?, rest.i32()?);
        let stamps = PanTilt::new(rest.u16()?, rest.u16()?);
        let command_v = PanTilt::new(rest.f32()?, rest.f32()?);
        let (darkness, bits) = (rest.u16()?, rest.u16()?);
        let (fault, open, lasted, taken) = (rest.u8()?, rest.u8()?, rest.u8()?, rest.u8()?);
        let has = |bit: u16| bits & bit != 0;
        let foot_rad_s = if has(bit::FOOT) { Some([rest.f32()?, rest.f32()?, rest.f32()?]) } else { None };
        let fault = if fault == 0 { None } else { Some(Fault::from_number(fault)?) };
        if bits & !bit::ALL != 0 || open & !inputs.present_bits() != 0 {
            return None;
        }
        let encoder = |count: i32, stamp: u16| Measurement { count, edge_age_ticks: stamp_of(stamp) };
        let sensed = Sensed {
            encoders: PanTilt::new(encoder(counts.pan, stamps.pan), encoder(counts.tilt, stamps.tilt)),
            laser_on: has(bit::SWITCH_KNOWN).then(|| has(bit::SWITCH_ON)),
            light: has(bit::LIGHT_KNOWN).then(|| has(bit::LIGHT)),
            inputs: inputs.opened_by(open),
            foot_rad_s,
            lasted_ticks: length_of(lasted),
        };
        Some(Self {
            sensed,
            plan_tick,
            actuation: Actuation { command_v, gate: has(bit::GATE), enable: has(bit::ENABLE) },
            darkness: DarknessSet::from_bits(darkness),
            phase: Phase::ALL.into_iter().find(|&phase| phase as u16 == bits >> PHASE & 7)?,
            fault,
            homed: has(bit::HOMED),
            taken,
            void: has(bit::VOID),
            heard: has(bit::HEARD),
            disarmed: has(bit::DISARMED),
        })
    }
}
