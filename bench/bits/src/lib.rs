//! The controller in a closed loop, hashed: every bit it decides, on whatever target this is compiled for.
//!
//! The law that is simulated is the law that is flashed only if both compute the same bits. [`run`] runs the controller
//! of the preset `report` on a head made of a few lines of `f32`, through strokes, reversals, a push and a fault, and
//! folds every tick's telemetry into one number. `bin/host` prints it here, `bin/board` on an emulated Cortex-M33, with the instructions that a tick takes.

#![no_std]

mod config;
mod head;
mod strokes;
mod wired;

pub use config::report;
pub use wired::{Firmware, IDENTITY, run_wired};

use head::Head;
use strokes::Strokes;
use tracelight_control::{Controller, State};
use tracelight_rig::{Command, Fault, PanTilt, Phase, Telemetry};

/// Ticks that are hashed.
pub const TICKS: u32 = 100_000;
/// Ticks of a board behind a wire that are hashed.
pub const WIRED_TICKS: u32 = 20_000;

/// How often both encoders lose a count of a dear run, ticks.
const LOSES_EVERY: u32 = 1500;

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// FNV-1a of every tick's telemetry.
    pub hash: u64,
    /// Ticks with the gate open.
    pub lit_ticks: u32,
    /// The first fault.
    pub fault: Option<Fault>,
    /// Ticks with the plan's clock stopped, for a push or a fault.
    pub held_ticks: u32,
}

/// What a run asks of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Load {
    /// Strokes as they come.
    Usual,
    /// All that is dear at once: fast moves whose edges come in every tick, and counts that both encoders lose in the same tick, so that either observer has two
    /// beliefs in a contest.
    Dearest,
}

/// Told around what a board computes.
pub trait Meter {
    /// Something begins.
    fn begin(&mut self) {}
    /// A tick is over.
    fn tick(&mut self) {}
    /// A segment was taken.
    fn append(&mut self) {}
}

impl Meter for () {}

/// Runs so many ticks as they come.
pub fn run(ticks: u32) -> Outcome {
    run_metered(ticks, Load::Usual, &mut ())
}

/// Runs so many ticks, metered.
pub fn run_metered(ticks: u32, load: Load, meter: &mut impl Meter) -> Outcome {
    let is_dear = load == Load::Dearest;
    let controller = Controller::new(report());
    let mut head = Head::default();
    let rearm_ticks = if is_dear { 1_000 } else { 10_000 };
    let mut sensed = head.sensed();
    let mut state = controller.start_homed(&sensed);
    let mut strokes = if is_dear { Strokes::far() } else { Strokes::default() };
    let mut fnv = Fnv::default();
    let (mut lit_ticks, mut held_ticks, mut fault, mut acknowledges) = (0, 0, None, 0);
    for tick in 0..ticks {
        tell(&controller, &mut state, Command::KeepAlive);
        // armed anew now and then: whatever fault there was is behind
        if tick % rearm_ticks == 0 {
            tell(&controller, &mut state, Command::Arm { acknowledges });
        }
        while let Some(segment) = strokes.due(tick) {
            meter.begin();
            let taken = controller.accept(&mut state, Command::Append(segment)).is_ok();
            meter.append();
            if !taken {
                strokes.put_back();
                break;
            }
        }
        meter.begin();
        let telemetry = controller.tick(&mut state, &sensed);
        meter.tick();
        fnv.take(&telemetry);
        fault = fault.or(telemetry.fault());
        acknowledges = telemetry.fault_number;
        lit_ticks += u32::from(telemetry.actuation.gate);
        held_ticks += u32::from(matches!(telemetry.phase, Phase::Holding | Phase::Faulted));
        head.push_nm = if tick % 7_300 < 60 { PanTilt::new(0.4, -0.3) } else { PanTilt::default() };
        head.exchange(&telemetry.actuation);
        if is_dear && tick % LOSES_EVERY == 0 {
            head.lose_counts();
        }
        sensed = head.sensed();
    }
    Outcome { hash: fnv.0, lit_ticks, held_ticks, fault }
}

/// Only segments are ever given back.
fn tell(controller: &Controller, state: &mut State, command: Command) {
    let taken = controller.accept(state, command).is_ok();
    debug_assert!(taken, "only segments wait");
}

/// <http://www.isthe.com/chongo/tech/comp/fnv/>, 64 bits.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn take(&mut self, telemetry: &Telemetry) {
        let Telemetry { tick, plan_tick, measured, setpoint, actuation, .. } = *telemetry;
        self.word(tick);
        self.word(plan_tick);
        for joint in tracelight_rig::Joint::BOTH {
            self.word(measured[joint].count as u32);
            self.number(setpoint[joint].position_rad);
            self.number(telemetry.position_rad[joint]);
            self.number(telemetry.velocity_rad_s[joint]);
            self.number(telemetry.acceleration_rad_s2[joint]);
            self.number(actuation.command_v[joint]);
        }
        self.word(u32::from(actuation.gate) | u32::from(telemetry.darkness.bits()) << 1);
        self.word(telemetry.phase as u32 | (telemetry.fault().map_or(0, |fault| fault as u32 + 1)) << 8);
    }

    /// Targets agree on every number, and on what is none, but not on the sign they give that.
    fn number(&mut self, number: f32) {
        self.word(if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() });
    }

    fn word(&mut self, word: u32) {
        self.bytes(&word.to_le_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
