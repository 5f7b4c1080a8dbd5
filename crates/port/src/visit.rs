//! Boards that other programs of this computer have in hand: watched, and made dark.

use std::io::{BufRead as _, BufReader, ErrorKind, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tracelight_task::{Failure, Task};

use crate::shared::{Owner, folder, line_of, socket_of};

/// How long a board may take to say that it was disarmed.
const DARK: Duration = Duration::from_secs(1);
/// How often it is looked whether anybody drives one.
const LOOK_AGAIN: Duration = Duration::from_millis(100);

/// A board that was told to be dark.
#[derive(Clone, Debug, PartialEq)]
pub struct Darkened {
    /// Its port.
    pub port: String,
    /// Who has it in hand, for people.
    pub owner: String,
    /// Whether anybody drove it: a port may be shared, and nobody there.
    pub driven: bool,
    /// How long it took until the board said that it is disarmed and its gate shut, s; `None` if it did not.
    pub within_s: Option<f64>,
}

/// Whoever has a port, as far as he answers.
enum Found {
    Owner(Owner),
    /// At this socket somebody is who does not answer.
    Silent(PathBuf),
}

/// Those who have ports, or that one.
fn owners(port: Option<&Path>) -> Result<Vec<Found>, Failure> {
    let wrong = |e: std::io::Error| {
        Failure::failed("port", format!("who drives heads on this computer cannot be found out: {e}"))
    };
    let sockets: Vec<PathBuf> = match port {
        Some(port) => vec![socket_of(port).map_err(wrong)?],
        None => {
            let entries = std::fs::read_dir(folder().map_err(wrong)?).map_err(wrong)?;
            let mut all: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
            all.retain(|path| path.extension().is_some_and(|end| end == "sock"));
            all.sort();
            all
        }
    };
    let found = |socket: &PathBuf| match Owner::of(socket) {
        Ok(owner) => owner.map(Found::Owner),
        Err(_) => Some(Found::Silent(socket.clone())),
    };
    Ok(sockets.iter().filter_map(found).collect())
}

/// Disarms every board that a program of this computer drives, or the one at a port, whoever does; all are told before any is waited for.
///
/// # Errors
/// `port`: who drives heads cannot be found out.
pub fn darken(port: Option<&Path>) -> Result<Vec<Darkened>, Failure> {
    let found = owners(port)?;
    // side by side: one that is slow is not waited for by the others
    Ok(std::thread::scope(|threads| {
        let asked: Vec<_> = found.into_iter().map(|one| threads.spawn(|| darkened(one))).collect();
        asked.into_iter().filter_map(|one| one.join().ok()).collect()
    }))
}

/// Disarms the board that somebody has in hand, and waits until it says so.
fn darkened(found: Found) -> Darkened {
    let mut owner = match found {
        Found::Owner(owner) => owner,
        Found::Silent(socket) => {
            let port =
                socket.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            let owner = "a program that does not answer".to_owned();
            return Darkened { port, owner, driven: true, within_s: None };
        }
    };
    let since = Instant::now();
    let is_told = owner.stream.write_all(b"disarm\nwatch\n").is_ok();
    // a board that nobody drives is dark by itself, and says nothing
    let is_known = is_told && (!owner.is_driven() || is_dark(&mut owner, since));
    let within_s = is_known.then(|| since.elapsed().as_secs_f64());
    Darkened { port: owner.port().to_owned(), owner: owner.words(), driven: owner.is_driven(), within_s }
}

/// Waits until a board says that it is disarmed and its gate shut; whether it does in time.
fn is_dark(owner: &mut Owner, since: Instant) -> bool {
    while since.elapsed() < DARK {
        let Ok(line) = line_of(&mut owner.stream) else { return false };
        let Ok(seen) = serde_json::from_str::<Value>(&line) else { return false };
        let reasons = seen["dark_because"].as_array().map_or(&[][..], Vec::as_slice);
        if seen["gate"] == false && reasons.iter().any(|reason| reason == "disarmed") {
            return true;
        }
    }
    false
}

/// For people.
#[must_use]
pub fn darkened_text(all: &[Darkened]) -> String {
    let line = |of: &Darkened| match of.within_s {
        Some(_) if !of.driven => format!("dark: {}, which nobody drives; {} shares it", of.port, of.owner),
        Some(s) => format!("dark: {}, which {} drives, disarmed within {:.0} ms", of.port, of.owner, 1e3 * s),
        None => format!(
            "NOT KNOWN: {}, which {} drives, did not say that it is disarmed: take its power",
            of.port, of.owner
        ),
    };
    if all.is_empty() {
        return "no program of yours was found that drives a head there; a board that nobody drives is dark by itself".to_owned();
    }
    all.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// For scripts.
#[must_use]
pub fn darkened_json(all: &[Darkened]) -> Value {
    let one = |of: &Darkened| json!({ "port": of.port, "owner": of.owner, "dark": of.within_s.is_some(), "within_ms": of.within_s.map(|s| 1e3 * s) });
    all.iter().map(one).collect()
}

/// Waits until a program has the board at a port in hand, or any; `None` if that is over before.
fn awaited(port: Option<&Path>, until: Option<Instant>, task: Task<'_>) -> Result<Option<Owner>, Failure> {
    let mut is_told = false;
    while !is_over(until, task) {
        let answers = |found| match found {
            Found::Owner(owner) => Some(owner),
            Found::Silent(_) => None,
        };
        let mut owners: Vec<Owner> = owners(port)?.into_iter().filter_map(answers).collect();
        if owners.len() > 1 {
            let ports: Vec<&str> = owners.iter().map(Owner::port).collect();
            let message = format!("several heads are driven: name the port of one: {}", ports.join(", "));
            return Err(Failure::usage("usage", message));
        }
        if let Some(owner) = owners.pop() {
            return Ok(Some(owner));
        }
        if !std::mem::replace(&mut is_told, true) {
            task.say("note: no program of this computer drives a head there yet: waiting");
        }
        std::thread::sleep(LOOK_AGAIN);
    }
    Ok(None)
}

fn is_over(until: Option<Instant>, task: Task<'_>) -> bool {
    task.stop.is_wanted() || until.is_some_and(|until| Instant::now() >= until)
}

/// Shows what the board at a port does, or the only one that is driven, until it is done with, it took that long, s, or nobody wants to see more: first who drives it, then line by
/// line what was seen. Where nobody drives one yet, it waits.
///
/// # Errors
/// `usage`: several are driven, and none was named.
pub fn watch(
    port: Option<&Path>,
    lasts_s: Option<f64>,
    mut show: impl FnMut(&Value) -> ControlFlow<()>,
    task: Task<'_>,
) -> Result<(), Failure> {
    let until = lasts_s.map(|lasts_s| Instant::now() + Duration::from_secs_f64(lasts_s));
    let Some(mut owner) = awaited(port, until, task)? else { return Ok(()) };
    if show(&owner.greeting).is_break() || owner.stream.write_all(b"watch\n").is_err() {
        return Ok(());
    }
    let (mut lines, mut line) = (BufReader::new(owner.stream), Vec::new());
    while !is_over(until, task) {
        match lines.read_until(b'\n', &mut line) {
            Ok(0) => break,
            Ok(_) => {
                let Ok(seen) = serde_json::from_slice(&line) else { break };
                if show(&seen).is_break() {
                    break;
                }
                line.clear();
            }
            // of a port that is shared, and that nobody drives, there is nothing to tell
            Err(e)
                if matches!(
                    e.kind(),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                ) => {}
            Err(_) => break,
        }
    }
    Ok(())
}
