//! Greets a board, and asks what it is and how it is set.

use crate::board::{Board, Told};
use crate::said::{Doing, Lines, Said, Status};
use crate::trouble::Trouble;

/// How often a board is asked that does not answer, µs.
const AGAIN_US: u64 = 250_000;
/// For how long, µs: some start for two seconds when their port is opened.
const MOST_SILENT_US: u64 = 5_000_000;
/// How often a question is put that it takes for garbage: what a program before has left in its line.
const MOST_TRIES: u8 = 3;
/// What is asked, in order.
const QUESTIONS: [&str; 4] = ["$I", "$$", "$G", "$#"];
/// Ends whatever a board does, at once.
pub(crate) const RESET: u8 = 0x18;

/// A board that is asked. It does no I/O: bytes and the time are handed in.
#[derive(Clone, Debug)]
pub struct Asking {
    lines: Lines,
    began_us: u64,
    /// When something was said to it last.
    said_us: Option<u64>,
    /// When it was heard last.
    heard_us: u64,
    welcome: Option<String>,
    stranger: Option<String>,
    told: Told,
    /// The question that is open, and how often it was put; `None` before it answers at all.
    question: Option<(usize, u8)>,
    is_put: bool,
    reset: bool,
    status: Option<Status>,
    trouble: Option<Trouble>,
}

impl Asking {
    /// Begins at that time, µs.
    #[must_use]
    pub fn new(now_us: u64) -> Self {
        Self {
            lines: Lines::default(),
            began_us: now_us,
            said_us: None,
            heard_us: now_us,
            welcome: None,
            stranger: None,
            told: Told::default(),
            question: None,
            is_put: false,
            reset: false,
            status: None,
            trouble: None,
        }
    }

    /// What is to be said to it now is added to the bytes.
    pub fn give(&mut self, now_us: u64, out: &mut Vec<u8>) {
        let is_due = self.said_us.is_none_or(|said| now_us >= said + AGAIN_US);
        if std::mem::take(&mut self.reset) {
            out.push(RESET);
            self.said_us = Some(now_us);
            return;
        }
        match self.question {
            None if is_due => out.push(b'?'),
            // the last answer is how it stands after all of them
            Some((at, _)) if at >= QUESTIONS.len() => {
                if is_due || !self.is_put {
                    self.is_put = true;
                    out.push(b'?');
                    self.said_us = Some(now_us);
                }
                return;
            }
            Some((at, _)) if !self.is_put => {
                self.is_put = true;
                out.extend_from_slice(QUESTIONS[at].as_bytes());
                out.push(b'\n');
            }
            _ => return,
        }
        self.said_us = Some(now_us);
    }

    /// Hears what it says.
    pub fn take(&mut self, bytes: &[u8], now_us: u64) {
        for &byte in bytes {
            let Some(said) = self.lines.push(byte) else { continue };
            self.heard_us = now_us;
            self.hear(said);
        }
    }

    fn hear(&mut self, said: Said) {
        match said {
            Said::Welcome(text) => {
                self.welcome = Some(text);
                self.question = Some((0, 0));
                self.is_put = false;
            }
            Said::Status(status) => self.hear_status(status),
            Said::Setting(number, value) => {
                self.told.settings.insert(number, value);
            }
            Said::Told(head, rest) => self.told.hear(&head, &rest),
            Said::Ok => self.next(),
            Said::Error(code) => self.refused(code),
            Said::Alarm(_) => {}
            Said::Other(text) => self.stranger = self.stranger.take().or(Some(text)),
        }
    }

    fn hear_status(&mut self, status: Status) {
        let does = match status.state {
            Doing::Run | Doing::Holding => "moves",
            Doing::Home => "homes",
            Doing::Check => "only checks programs ($C)",
            _ => "",
        };
        if !does.is_empty() {
            self.trouble = Some(Trouble::Busy { does });
        } else if matches!(status.state, Doing::Held | Doing::Else) && self.question.is_none() {
            // it stands: nothing is lost by that
            self.reset = true;
        } else if status.state == Doing::Door {
            self.trouble = Some(Trouble::Door);
        } else if self.question.is_none() {
            self.question = Some((0, 0));
        } else if self.question.is_some_and(|(at, _)| at >= QUESTIONS.len()) {
            self.status = Some(status);
        }
    }

    /// The open question is answered.
    fn next(&mut self) {
        if let Some((at, _)) = self.question.filter(|_| self.is_put) {
            self.question = Some((at + 1, 0));
            self.is_put = false;
        }
    }

    fn refused(&mut self, code: u16) {
        let Some((at, tries)) = self.question.filter(|(at, _)| self.is_put && *at < QUESTIONS.len()) else {
            return;
        };
        if tries + 1 < MOST_TRIES {
            self.question = Some((at, tries + 1));
            self.is_put = false;
        } else if QUESTIONS[at] == "$$" {
            self.trouble = Some(Trouble::Refused { line: QUESTIONS[at].to_owned(), code });
        } else {
            self.next();
        }
    }

    /// The board, once everything is known; why it is none to be driven; `None` as long as it is asked.
    pub fn board(&self, now_us: u64) -> Option<Result<Board, Trouble>> {
        if let Some(trouble) = &self.trouble {
            return Some(Err(trouble.clone()));
        }
        if let Some(status) = &self.status {
            let version = self.welcome.as_deref().unwrap_or("Grbl");
            let place = (status.place.as_slice(), status.is_machine);
            return Some(Ok(self.told.board(version, place, status.state == Doing::Alarm)));
        }
        let waited_us = now_us.saturating_sub(self.heard_us.max(self.began_us));
        if self.question.is_none()
            && let Some(said) = &self.stranger
            && now_us > self.began_us + MOST_SILENT_US
        {
            return Some(Err(Trouble::Stranger { said: said.clone() }));
        }
        let waited_s = waited_us as f64 * 1e-6;
        (waited_us > MOST_SILENT_US).then_some(Err(Trouble::Silent { waited_s }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What was asked of a board that answers so, and what it is.
    fn asked(answer: impl Fn(&str) -> String) -> (Vec<String>, Result<Board, Trouble>) {
        let mut asking = Asking::new(0);
        let mut heard = Vec::new();
        for step in 1..2000_u64 {
            let now_us = step * 5_000;
            let mut out = Vec::new();
            asking.give(now_us, &mut out);
            if !out.is_empty() {
                let text = String::from_utf8_lossy(&out).trim().to_owned();
                asking.take(answer(&text).as_bytes(), now_us);
                heard.push(text);
            }
            if let Some(found) = asking.board(now_us) {
                return (heard, found);
            }
        }
        unreachable!("neither a board nor none")
    }

    fn usual(question: &str) -> String {
        match question {
            "?" => "<Idle|MPos:1.000,2.000,0.000|Bf:15,128|WCO:0.000,0.000,0.000>\r\n",
            "$I" => "[VER:1.1h.20190825:]\r\n[OPT:V,15,128]\r\nok\r\n",
            "$$" => "$30=1000\r\n$32=1\r\n$100=88.889\r\nok\r\n",
            "$G" => "[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]\r\nok\r\n",
            "$#" => "[G54:0.000,0.000,0.000]\r\n[G92:0.000,0.000,0.000]\r\nok\r\n",
            _ => "error:3\r\n",
        }
        .to_owned()
    }

    #[test]
    fn a_board_is_asked_in_order_and_known_then() {
        let (heard, found) = asked(usual);
        assert_eq!(heard, ["?", "$I", "$$", "$G", "$#", "?"]);
        let board = found.unwrap_or_else(|e| unreachable!("{e}"));
        assert_eq!(
            (board.version.as_str(), board.settings[&100], board.is_homed),
            ("1.1h.20190825", 88.889, false)
        );
    }

    #[test]
    fn one_that_stands_in_a_hold_is_reset_and_one_that_moves_is_left_alone() {
        let held = |question: &str| match question {
            "?" => "<Hold:0|MPos:0,0,0>\n".to_owned(),
            "\u{18}" => "\r\nGrbl 1.1h ['$' for help]\r\n".to_owned(),
            _ => usual(question),
        };
        let (heard, _) = asked(held);
        assert_eq!(heard[..3], ["?", "\u{18}", "$I"]);
        let (heard, found) = asked(|_| "<Run|MPos:0,0,0>\n".to_owned());
        assert_eq!((heard.len(), found), (1, Err(Trouble::Busy { does: "moves" })));
    }

    #[test]
    fn silence_strangers_and_garbage_in_the_line_are_told() {
        let (_, found) = asked(|_| String::new());
        assert!(matches!(found, Err(Trouble::Silent { .. })));
        let (_, found) = asked(|_| "start\necho:Marlin 2.1\n".to_owned());
        assert_eq!(found, Err(Trouble::Stranger { said: "start".to_owned() }));
        let tries = std::cell::Cell::new(0);
        let (heard, found) = asked(|question| {
            if question == "$I" && tries.replace(tries.get() + 1) == 0 {
                "error:1\n".to_owned()
            } else {
                usual(question)
            }
        });
        assert!(found.is_ok());
        assert_eq!(heard[..3], ["?", "$I", "$I"]);
    }
}
