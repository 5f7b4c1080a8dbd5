//! What a Grbl board has said of itself, for people and for scripts.

use serde_json::{Value, json};
use tracelight_grbl::Board;

/// Settings that matter for a head, and what each means.
const SETTINGS: [(u16, &str); 10] = [
    (100, "X: steps a degree"),
    (101, "Y: steps a degree"),
    (110, "X: degrees a minute at most"),
    (111, "Y: degrees a minute at most"),
    (120, "X: degrees/s2 at most"),
    (121, "Y: degrees/s2 at most"),
    (11, "junction deviation, degrees"),
    (30, "S of full light"),
    (32, "laser mode, has to be 1"),
    (20, "soft limits, have to be 0"),
];

/// For people.
#[must_use]
pub fn asked_text(at: &str, board: &Board) -> String {
    let Board { version, moves, characters, has_door, settings, is_homed, is_locked, .. } = board;
    let door = if *has_door { "a door input" } else { "no door input" };
    let homed = match (is_homed, is_locked) {
        (true, _) => "it knows where it points (G59 is its angle zero)",
        (_, true) => "locked by an alarm, and not homed: tracelight home",
        _ => "not homed: tracelight home once it points straight ahead",
    };
    let wrong = board.check().err().map_or_else(String::new, |why| format!("\n          {why}"));
    let told: Vec<String> = SETTINGS
        .iter()
        .filter_map(|(number, means)| {
            settings.get(number).map(|value| format!("${number}={value} ({means})"))
        })
        .collect();
    format!(
        "board:    {at}: Grbl {version}; {homed}\n          plans {moves} moves ahead, holds {characters} characters, {door}\n          {}{wrong}",
        told.join("\n          ")
    )
}

/// For scripts.
#[must_use]
pub fn asked_json(at: &str, board: &Board) -> Value {
    let Board { version, moves, characters, has_door, settings, is_homed, is_locked, .. } = board;
    let settings: serde_json::Map<String, Value> =
        settings.iter().map(|(number, value)| (number.to_string(), json!(value))).collect();
    json!({
        "port": at, "kind": "Grbl", "program": version, "moves": moves, "characters": characters, "door": has_door, "homed": is_homed,
        "locked": is_locked, "settings": settings, "wrong": board.check().err().map(|why| why.to_string()),
        "simulated": board.is_simulated(),
    })
}
