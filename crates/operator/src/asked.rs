//! A question that a key answers.

use std::time::{Duration, Instant};

use tracelight_task::{Failure, Task};

use crate::keys::{Key, Keys};

/// For how long an answer is waited for.
const PATIENCE: Duration = Duration::from_secs(60);

/// What is told where nobody is there to arm a real head, and what to do.
#[must_use]
pub fn nobody_arms(instead: &str) -> Failure {
    let message = format!(
        "a real head is lit only after a person has armed it by a key, and standard input is no terminal: {instead}"
    );
    Failure::usage("usage", message)
}

/// Asks whoever is at the terminal for light: the key A allows it. `hold` waits, with the head in its hands, until the key that is looked for has come.
///
/// # Errors
/// `usage`: standard input is no terminal; `not-armed`: another key was pressed, or none for a minute; what `hold` fails by.
pub fn asked(
    question: &str,
    task: Task<'_>,
    hold: impl FnOnce(&mut dyn FnMut() -> Option<bool>) -> Result<bool, Failure>,
) -> Result<(), Failure> {
    let keys = Keys::listen().ok_or_else(|| nobody_arms("start it in one"))?;
    task.say(question);
    let until = Instant::now() + PATIENCE;
    let is_allowed = hold(&mut || match keys.next() {
        Some(key) => Some(key == Key::Char('a')),
        None => (Instant::now() > until).then_some(false),
    })?;
    if is_allowed {
        return Ok(());
    }
    Err(Failure::failed("not-armed", "nobody armed it: no light was let out"))
}
