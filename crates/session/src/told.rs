//! Events and snapshots for scripts and pages: one object each.

use serde_json::{Value, json};
use tracelight_rig::Joint;

use crate::event::{Event, Snapshot, seconds};

/// An event as an object, `event` first; strokes count from 1, times are in s.
#[must_use]
pub fn event_json(event: &Event) -> Value {
    match *event {
        Event::State { tick, from, to } => {
            json!({"event": "state", "t_s": seconds(tick), "from": from.name(), "to": to.name()})
        }
        Event::Stroke { tick, stroke, of } => {
            json!({"event": "stroke", "t_s": seconds(tick), "stroke": stroke + 1, "strokes": of})
        }
        Event::NotBegun { tick, why } => {
            json!({"event": "refused", "t_s": seconds(tick), "message": why.to_string()})
        }
        Event::Fault(record) => {
            let told = record.told();
            json!({
                "event": "fault", "t_s": seconds(record.tick), "code": record.fault.code(), "message": record.fault.row().what,
                "joint": record.joint.map(Joint::name), "value": told.map(|told| told.value), "bound": told.map(|told| told.bound),
                "unit": told.map(|told| told.unit),
            })
        }
    }
}

/// A snapshot as an object, the event `progress`; strokes count from 1, times are in s.
#[must_use]
pub fn snapshot_json(now: &Snapshot) -> Value {
    json!({
        "event": "progress", "t_s": seconds(now.tick), "state": now.state.name(), "plan_s": seconds(now.plan_tick),
        "of_s": seconds(now.plan_ticks), "stroke": now.stroke.map(|stroke| stroke + 1), "strokes": now.strokes, "laps": now.laps,
        "speed": now.speed, "gate": now.gate, "armed_s": seconds(now.armed_ticks),
    })
}
