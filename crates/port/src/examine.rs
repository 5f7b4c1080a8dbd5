//! Looks at a board: what it is, and how good the line to it is.

use std::path::Path;
use std::time::{Duration, Instant};

use tracelight_device::Clock;
use tracelight_rig::wire::{FromBoard, Greeting, MOST_PACKET, Packets, ToBoard, VERSION, connection_of};
use tracelight_task::{Failure, Stop};

use crate::greeting::Examined;
use crate::port::Port;
use crate::session::{micros, new_session};

/// For how long a board may think about a greeting, and how often it is greeted.
const PATIENCE: Duration = Duration::from_millis(300);
const GREETINGS: u32 = 3;
/// How often it is asked how long the way is, and how far apart.
const ANSWERS: usize = 60;
const APART: Duration = Duration::from_millis(10);

/// Greets the board at a port, which disarms it, and asks it some times for an answer; what it is, and how long that takes. It is not configured, and nothing moves.
///
/// # Errors
/// `port`: it cannot be opened. `board`: nobody answers there. `interrupted`.
pub fn examine(path: &Path, stop: &Stop) -> Result<Examined, Failure> {
    let port = Port::open(path)?;
    let mut line = Line { port, packets: Packets::new(), session: new_session(), began: Instant::now() };
    let board = line.greet(stop)?;
    let (mut round_trips_ms, mut unanswered, mut clock) = (Vec::new(), 0, Clock::default());
    // one of another version says nothing more
    let answers = if board.version.0 == VERSION.0 { ANSWERS } else { 0 };
    for _ in 0..answers {
        stop.check()?;
        match line.round_trip(&mut clock)? {
            Some(took) => round_trips_ms.push(took.as_secs_f64() * 1e3),
            None => unanswered += 1,
        }
        std::thread::sleep(APART);
    }
    let ticks_known_ms = clock.instant_of(board.tick).map(|(_, unsure_us)| 1e-3 * unsure_us);
    Ok(Examined { port: path.display().to_string(), board, round_trips_ms, unanswered, ticks_known_ms })
}

struct Line {
    port: Port,
    packets: Packets,
    session: u32,
    began: Instant,
}

impl Line {
    fn gone(&self, e: &std::io::Error) -> Failure {
        Failure::failed("board", format!("{}: the line is gone ({e})", self.port.path().display()))
    }

    fn say(&mut self, said: &ToBoard<'_>) -> Result<(), Failure> {
        let mut out = [0; MOST_PACKET];
        let length = said.packed(connection_of(self.session), &mut out);
        self.port.write(&out[..length]).map_err(|e| self.gone(&e))
    }

    /// The first answer that is what is looked for, in time.
    fn hear<T>(
        &mut self,
        patience: Duration,
        looked_for: impl Fn(FromBoard<'_>) -> Option<T>,
    ) -> Result<Option<T>, Failure> {
        let until = Instant::now() + patience;
        let mut bytes = Vec::new();
        while let Some(left) = until.checked_duration_since(Instant::now()) {
            bytes.clear();
            self.port.read(&mut bytes, left).map_err(|e| self.gone(&e))?;
            for &byte in &bytes {
                let said = self.packets.push(byte).and_then(FromBoard::read);
                if let Some(found) = said.and_then(|(said, _)| looked_for(said)) {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }

    fn greet(&mut self, stop: &Stop) -> Result<Greeting, Failure> {
        let session = self.session;
        for _ in 0..GREETINGS {
            stop.check()?;
            self.say(&ToBoard::Hello { version: VERSION, session, program: *b"doctor\0\0" })?;
            let is_ours = |said: FromBoard<'_>| match said {
                FromBoard::Hello(board) if board.session == session => Some(board),
                _ => None,
            };
            if let Some(board) = self.hear(PATIENCE, is_ours)? {
                return Ok(board);
            }
        }
        let message = format!(
            "{}: no board of Tracelight's answers there; see whether it has power, and whether Tracelight's program is loaded",
            self.port.path().display()
        );
        Err(Failure::failed("board", message))
    }

    fn round_trip(&mut self, clock: &mut Clock) -> Result<Option<Duration>, Failure> {
        let host_us = micros(self.began);
        let asked = Instant::now();
        self.say(&ToBoard::KeepAlive { host_us })?;
        let is_its = |said: FromBoard<'_>| match said {
            FromBoard::Pong { host_us: us, tick, tick_us } if us == host_us => Some((tick, tick_us)),
            _ => None,
        };
        let heard = self.hear(PATIENCE, is_its)?;
        let took = asked.elapsed();
        Ok(heard.map(|(tick, tick_us)| {
            clock.hear((host_us, micros(self.began)), tick, tick_us);
            took
        }))
    }
}
