//! What a board says that it is, in words.

use serde_json::{Value, json};
use tracelight_rig::wire::{Greeting, Reset};
use tracelight_rig::{Capabilities, Input, InputState, TICK_F64_S};

/// A board that was looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Examined {
    /// Where it is.
    pub port: String,
    /// What it says that it is.
    pub board: Greeting,
    /// How long the way there and back takes, ms, of each answer; none of a board that answers nothing but greetings.
    pub round_trips_ms: Vec<f64>,
    /// Answers that did not come.
    pub unanswered: usize,
    /// How well it is known when its ticks are, by the clock of this computer, ms; `None` without an answer.
    pub ticks_known_ms: Option<f64>,
}

/// Kinds of boards, by their numbers.
const KINDS: [(u16, &str); 3] = [
    (Greeting::EMULATED, "emulated board"),
    (Greeting::PICO_2, "Pico 2"),
    (Greeting::DOUBLE, "test double of a Pico 2, emulated"),
];

fn kind(board: u16) -> String {
    let known = KINDS.into_iter().find(|(number, _)| *number == board);
    known.map_or_else(|| format!("board of kind {board}"), |(_, name)| name.to_owned())
}

const fn why(reset: Reset) -> &'static str {
    match reset {
        Reset::PowerUp => "power-up",
        Reset::Button => "its button",
        Reset::Watchdog => "its watchdog: its program hung",
        Reset::BrownOut => "a supply that was too low",
        Reset::Told => "another program that was loaded",
        Reset::Unknown => "nobody knows what",
    }
}

const fn input(input: Input) -> &'static str {
    match input {
        Input::EmergencyStop => "emergency stop",
        Input::Lid => "lid",
        Input::Key => "key",
        Input::Amplifier(tracelight_rig::Joint::Pan) => "fault of pan's amplifier",
        Input::Amplifier(tracelight_rig::Joint::Tilt) => "fault of tilt's amplifier",
        Input::Supply => "supply",
        Input::Temperature => "temperature",
        _ => "an input",
    }
}

/// What a board has, by name.
fn having(has: &Capabilities) -> Vec<&'static str> {
    let flags = [
        (has.stamps, "stamped edges"),
        (has.gate_watched, "the gate's switch watched"),
        (has.light_watched, "light watched"),
        (has.gyroscope, "gyroscope"),
        (has.times_ticks, "timed ticks"),
        (has.absolute, "absolute encoders"),
    ];
    let inputs = Input::ALL.into_iter().filter(|&one| has.inputs.state(one) != InputState::Absent).map(input);
    flags.into_iter().filter(|(has, _)| *has).map(|(_, name)| name).chain(inputs).collect()
}

/// The share of them that is no longer, ms.
fn quantile(of: &[f64], share: f64) -> Option<f64> {
    let mut sorted = of.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(((share * sorted.len() as f64) as usize).min(sorted.len().checked_sub(1)?)).copied()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// What was seen, for people.
#[must_use]
pub fn examined_text(seen: &Examined) -> String {
    let Examined { port, board, round_trips_ms, unanswered, ticks_known_ms } = seen;
    let [major, minor, patch] = board.firmware;
    let has = having(&board.capabilities);
    let has = if has.is_empty() { "nothing beside its joints and a gate".to_owned() } else { has.join(", ") };
    let configured = board.configuration.map_or("none".to_owned(), |crc| format!("{crc:08x}"));
    let known = ticks_known_ms.map_or_else(String::new, |ms| format!("; its ticks are known to {ms:.2} ms"));
    let link = match (quantile(round_trips_ms, 0.5), quantile(round_trips_ms, 0.99)) {
        (Some(middle), Some(most)) => {
            format!("there and back in {middle:.2} ms, 99 % within {most:.2} ms{known}")
        }
        _ => "no answer to any keep-alive".to_owned(),
    };
    let lost = if *unanswered > 0 { format!("; {unanswered} not answered") } else { String::new() };
    format!(
        "board:    {port}: {}, program {major}.{minor}.{patch}, wire {}.{}, number {}\n          \
         started {:.1} s ago by {}; configuration {configured}\n          \
         holds {} segments ahead and tells {} ticks again; ticks of {:.3} ms\n          \
         has {has}\n          \
         link: {link}{lost}",
        kind(board.board),
        board.version.0,
        board.version.1,
        hex(&board.id),
        f64::from(board.tick) * TICK_F64_S,
        why(board.reset),
        board.segments,
        board.rows,
        f64::from(board.tick_ns) * 1e-6,
    )
}

/// What was seen, for scripts.
#[must_use]
pub fn examined_json(seen: &Examined) -> Value {
    let Examined { port, board, round_trips_ms, unanswered, ticks_known_ms } = seen;
    let [major, minor, patch] = board.firmware;
    json!({
        "port": port, "kind": kind(board.board), "program": format!("{major}.{minor}.{patch}"),
        "wire": [board.version.0, board.version.1], "id": hex(&board.id), "up_s": f64::from(board.tick) * TICK_F64_S,
        "reset": why(board.reset), "configuration": board.configuration, "segments": board.segments, "rows": board.rows,
        "tick_ns": board.tick_ns, "has": having(&board.capabilities),
        "round_trip_ms": { "median": quantile(round_trips_ms, 0.5), "p99": quantile(round_trips_ms, 0.99) },
        "unanswered": unanswered, "ticks_known_ms": ticks_known_ms,
    })
}
