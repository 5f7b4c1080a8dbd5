//! What whoever watches a board is told of a tick.

use serde_json::{Value, json};
use tracelight_rig::wire::Row;
use tracelight_rig::{Darkness, DarknessSet, Fault, PanTilt, Phase, TICK_F64_S, Telemetry};
use tracelight_task::phase_word;

/// A tick as whoever watches is told of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Seen {
    tick: u32,
    plan_tick: u32,
    phase: Phase,
    homed: bool,
    gate: bool,
    darkness: DarknessSet,
    fault: Option<Fault>,
    /// Where the joints are believed to be, rad, where that is known.
    angle_rad: Option<PanTilt<f32>>,
}

impl Seen {
    /// By who follows the board's controller.
    pub(crate) fn of(told: &Telemetry) -> Self {
        Self {
            tick: told.tick,
            plan_tick: told.plan_tick,
            phase: told.phase,
            homed: told.homed,
            gate: told.actuation.lights(),
            darkness: told.darkness,
            fault: told.fault(),
            angle_rad: Some(told.position_rad),
        }
    }

    /// By what passes on the wire.
    pub(crate) fn passing(tick: u32, row: &Row) -> Self {
        Self {
            tick,
            plan_tick: row.plan_tick,
            phase: row.phase,
            homed: row.homed,
            gate: row.actuation.lights(),
            darkness: row.darkness,
            fault: row.fault,
            angle_rad: None,
        }
    }

    /// Whether another tick is something else to tell.
    pub(crate) fn differs(&self, other: &Self) -> bool {
        let of = |seen: &Self| (seen.phase, seen.homed, seen.gate, seen.fault);
        of(self) != of(other)
    }

    /// For scripts.
    pub(crate) fn json(&self) -> Value {
        let reasons = Darkness::ALL.into_iter().filter(|&reason| self.darkness.contains(reason));
        let degrees = |rad: f32| (f64::from(rad).to_degrees() * 1e4).round() / 1e4;
        json!({
            "time_s": f64::from(self.tick) * TICK_F64_S, "phase": phase_word(self.phase), "gate": self.gate, "homed": self.homed,
            "dark_because": reasons.map(Darkness::code).collect::<Vec<_>>(), "fault": self.fault.map(Fault::code),
            "plan_s": f64::from(self.plan_tick) * TICK_F64_S,
            "pan_deg": self.angle_rad.map(|at| degrees(at.pan)), "tilt_deg": self.angle_rad.map(|at| degrees(at.tilt)),
        })
    }
}

/// What was seen as a line for people, with who drives it first; whatever is as it was before is left out.
#[must_use]
pub fn seen_text(before: &Value, seen: &Value) -> String {
    if let Some(port) = seen["port"].as_str() {
        let owner = seen["owner"].as_str().unwrap_or("another program");
        return format!("{port}: {owner} (pid {})", seen["pid"]);
    }
    let is_news = ["phase", "gate", "homed", "fault"].iter().any(|key| before[key] != seen[key]);
    if !is_news {
        return String::new();
    }
    let number = |key: &str| seen[key].as_f64();
    let place = number("pan_deg").zip(number("tilt_deg"));
    let place =
        place.map_or_else(String::new, |(pan, tilt)| format!(", pan {pan:.2} deg, tilt {tilt:.2} deg"));
    let phase = seen["phase"].as_str().unwrap_or_default();
    let gate = if seen["gate"] == true { "GATE OPEN" } else { "gate shut" };
    let homed = if seen["homed"] == true { "" } else { ", not homed" };
    let fault = seen["fault"].as_str().map_or_else(String::new, |fault| format!(", fault {fault}"));
    let time_s = number("time_s").unwrap_or_default();
    format!("{time_s:10.3} s  {gate}, {phase}{place}{homed}{fault}")
}
