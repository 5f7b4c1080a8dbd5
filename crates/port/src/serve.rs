//! A board that is emulated with its head at a pseudo-terminal, by the clock.

use std::io::{Read as _, Write as _};
use std::path::Path;

use serde_json::{Value, json};
use tracelight_rig::TICK_F64_S;
use tracelight_sim::ServedRig;
use tracelight_task::{Failure, Pace, Task};

use crate::terminal::Terminal;

/// Bytes that wait for a program that does not read: a board says no more then either.
const MOST_WAITING: usize = 1 << 16;

/// What is to be served.
#[derive(Clone, Debug)]
pub struct Serving<'a> {
    /// The board with its head.
    pub rig: ServedRig,
    /// What people call it.
    pub name: &'a str,
    /// Name of the pseudo-terminal.
    pub at: &'a Path,
    /// For how long, s; until it is stopped where there is none.
    pub lasts_s: Option<f64>,
}

/// What was served.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Served {
    /// For how long, s.
    pub lasted_s: f64,
    /// Bytes that came and went.
    pub came: u64,
    /// Bytes that went.
    pub went: u64,
    /// How long it was lit, s.
    pub lit_s: f64,
}

impl Served {
    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let Self { lasted_s, came, went, lit_s } = self;
        format!("served for {lasted_s:.1} s: {came} bytes came, {went} went; lit for {lit_s:.1} s")
    }

    /// For scripts.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({ "lasted_s": self.lasted_s, "came_bytes": self.came, "went_bytes": self.went, "lit_s": self.lit_s })
    }
}

/// Emulates a board and its head at a pseudo-terminal. Whether the head knows where it points is as it is given.
///
/// # Errors
/// `port`: the pseudo-terminal cannot be made, or there is something else of that name.
pub fn serve(serving: Serving<'_>, task: Task<'_>) -> Result<Served, Failure> {
    let Serving { mut rig, name, at, lasts_s } = serving;
    let wrong = |e: std::io::Error| {
        let why = match e.kind() {
            std::io::ErrorKind::AlreadyExists => {
                "there is something of that name, a board perhaps: choose another".to_owned()
            }
            _ => e.to_string(),
        };
        Failure::failed("port", format!("{}: no pseudo-terminal can be made there: {why}", at.display()))
    };
    let mut terminal = Terminal::new(at).map_err(wrong)?;
    task.say(&format!("a board with the head of {name} is at {}: Ctrl-C ends it", at.display()));
    let (mut served, mut waiting, mut pace) = (Served::default(), Vec::new(), Pace::new(TICK_F64_S));
    while !task.stop.is_wanted() && lasts_s.is_none_or(|lasts_s| served.lasted_s < lasts_s) {
        pace.wait();
        let mut bytes = [0; 4096];
        // nothing there is no error of a line that does not wait
        let count = terminal.ours.read(&mut bytes).unwrap_or(0);
        let said = rig.pass(&bytes[..count], waiting.len() < MOST_WAITING);
        served.came += count as u64;
        waiting.extend(said);
        let went = terminal.ours.write(&waiting).unwrap_or(0);
        waiting.drain(..went);
        served.went += went as u64;
        served.lasted_s += TICK_F64_S;
        served.lit_s += if rig.is_lit() { TICK_F64_S } else { 0.0 };
    }
    Ok(served)
}
