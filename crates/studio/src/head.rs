//! The head at a port, moved by hand from a page: always in the dark.

use std::sync::Arc;

use serde::Deserialize;
use serde_json::Value;
use tracelight_task::Failure;

use crate::answers::answer;
use crate::desk::Desk;
use crate::tasks::{AtLast, Ended};

/// Longest way, bytes.
const MOST_BYTES: usize = 40;

/// What a page asks of the head.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(tag = "move", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Move {
    /// The head points straight ahead now, and is told so.
    Home,
    /// To straight ahead.
    Park,
    /// By two angles, pan to the left and tilt down, or by a way on the wall.
    Jog { by: String },
    /// Nothing: where it is.
    Look,
}

impl Move {
    /// The command that does it, without its head.
    ///
    /// # Errors
    /// `usage` of a way that is none, or that could be taken for a flag.
    fn command(&self) -> Result<Vec<String>, Failure> {
        let words = match self {
            Self::Home => vec!["home"],
            Self::Park => vec!["park"],
            Self::Look => vec!["jog", "0deg,0deg"],
            Self::Jog { by } => {
                let is_way = |c: char| c.is_ascii_alphanumeric() || ".,+- ".contains(c);
                if by.is_empty() || by.len() > MOST_BYTES || by.starts_with("--") || !by.chars().all(is_way) {
                    let message = format!("{by:?} is no way to go: give two angles such as 5deg,-2deg");
                    return Err(Failure::usage("usage", message));
                }
                vec!["jog", by]
            }
        };
        Ok(words.into_iter().map(str::to_owned).collect())
    }
}

impl Desk {
    /// Moves the head at the port that the studio was opened for, in the dark; where it is then. *Stop* ends it.
    ///
    /// # Errors
    /// `usage` where there is none; `busy` while a job or another move is on; what the program says.
    pub(crate) fn move_head(&self, by: &Move) -> Result<Value, Failure> {
        let Some(head) = self.program.head().filter(|head| head.is_at_port) else {
            let message = "no head is at a port here: open the studio with --rig PORT:RIG";
            return Err(Failure::usage("usage", message));
        };
        let mut command = by.command()?;
        command.extend([format!("--rig={}", head.draws_as), "--json".to_owned(), "--quiet".to_owned()]);
        let work = self.begin_move()?;
        let _ended = AtLast(Arc::clone(&work));
        let done = self.program.perform(&command, None, (&*work, &work.stop));
        work.end(Ended { answer: Value::Null, failure: None });
        answer(done?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_is_no_flag() {
        let jog = |by: &str| Move::Jog { by: by.to_owned() }.command();
        assert_eq!(jog("-3deg,0.5deg").unwrap(), ["jog", "-3deg,0.5deg"]);
        for none in ["", "--dot=2s", "5deg,0deg\n--dot", "5deg;0deg", &"1".repeat(50)] {
            assert!(jog(none).is_err(), "{none}");
        }
        assert_eq!(Move::Home.command().unwrap(), ["home"]);
    }
}
