//! Keys that are pressed in a terminal, each as it is pressed.

use std::io::{IsTerminal, Read};
use std::sync::mpsc::{Receiver, channel};

/// A key that means something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// Space.
    Space,
    /// Enter.
    Enter,
    /// Escape, alone.
    Escape,
    /// The right arrow, or page down: what pedals send.
    Forwards,
    /// The left arrow, or page up.
    Backwards,
    /// Ctrl-C.
    Interrupt,
    /// A letter, sign or digit.
    Char(char),
}

/// Keys from standard input, for as long as this lives; then the terminal is as it was.
#[derive(Debug)]
pub struct Keys {
    pressed: Receiver<Key>,
    _raw: Raw,
}

impl Keys {
    /// Listens, if standard input is a terminal that can tell single keys.
    #[must_use]
    pub fn listen() -> Option<Self> {
        if !std::io::stdin().is_terminal() {
            return None;
        }
        let raw = Raw::enter()?;
        let (press, pressed) = channel();
        std::thread::spawn(move || {
            let mut bytes = [0; 64];
            while let Ok(length @ 1..) = std::io::stdin().read(&mut bytes) {
                for key in keys(&bytes[..length]) {
                    if press.send(key).is_err() {
                        return;
                    }
                }
            }
        });
        Some(Self { pressed, _raw: raw })
    }

    /// The next key that was pressed, if any was.
    #[must_use]
    pub fn next(&self) -> Option<Key> {
        self.pressed.try_recv().ok()
    }
}

/// What the bytes that came at once say, however many keys that are. Other keys that send several bytes mean nothing here.
fn keys(mut bytes: &[u8]) -> Vec<Key> {
    let mut keys = Vec::new();
    while let Some((&first, rest)) = bytes.split_first() {
        let (key, length) = match (first, rest) {
            (0x1b, _) => escaped(rest),
            (0x03, _) => (Some(Key::Interrupt), 0),
            (b'\r' | b'\n', _) => (Some(Key::Enter), 0),
            (b' ', _) => (Some(Key::Space), 0),
            (byte, _) if byte.is_ascii_graphic() => {
                (Some(Key::Char(char::from(byte).to_ascii_lowercase())), 0)
            }
            _ => (None, 0),
        };
        keys.extend(key);
        bytes = &rest[length..];
    }
    keys
}

/// The key whose bytes begin with an escape, and how many more there are. What is no whole sequence is the key Escape
/// and others after it: whoever presses it twice, or anything right after it, wants the light out.
fn escaped(rest: &[u8]) -> (Option<Key>, usize) {
    let end = match rest {
        // the function keys of a Linux console
        [b'[', b'[', _, ..] => Some(2),
        [b'[', ..] => {
            let last = rest.iter().skip(1).position(|byte| !(0x20..=0x3f).contains(byte));
            last.map(|at| at + 1).filter(|&at| (0x40..=0x7e).contains(&rest[at]))
        }
        [b'O', byte, ..] if byte.is_ascii_alphabetic() => Some(1),
        _ => None,
    };
    let Some(end) = end else { return (Some(Key::Escape), 0) };
    let key = match &rest[..=end] {
        b"[C" | b"OC" | b"[6~" => Some(Key::Forwards),
        b"[D" | b"OD" | b"[5~" => Some(Key::Backwards),
        _ => None,
    };
    (key, end + 1)
}

/// A terminal that hands over single keys, does not show them, and leaves Ctrl-C to the program.
#[derive(Debug)]
struct Raw {
    #[cfg(unix)]
    before: rustix::termios::Termios,
}

#[cfg(unix)]
impl Raw {
    fn enter() -> Option<Self> {
        use rustix::termios::{LocalModes, OptionalActions, QueueSelector, tcflush, tcgetattr, tcsetattr};
        let before = tcgetattr(std::io::stdin()).ok()?;
        let mut raw = before.clone();
        raw.local_modes.remove(LocalModes::ICANON | LocalModes::ECHO | LocalModes::ISIG);
        tcsetattr(std::io::stdin(), OptionalActions::Now, &raw).ok()?;
        // what was typed before anything was asked is no answer
        tcflush(std::io::stdin(), QueueSelector::IFlush).ok()?;
        Some(Self { before })
    }
}

#[cfg(unix)]
impl Drop for Raw {
    fn drop(&mut self) {
        use rustix::termios::{OptionalActions, tcsetattr};
        tcsetattr(std::io::stdin(), OptionalActions::Now, &self.before).ok();
    }
}

#[cfg(not(unix))]
impl Raw {
    const fn enter() -> Option<Self> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_told_apart() {
        assert_eq!(keys(b" \r+P"), [Key::Space, Key::Enter, Key::Char('+'), Key::Char('p')]);
        assert_eq!(keys(b"\x1b"), [Key::Escape]);
        assert_eq!(keys(b"\x03"), [Key::Interrupt]);
        assert_eq!(keys(b"\x1b[A"), []);
        assert_eq!(
            [keys(b"\x1b[C"), keys(b"\x1b[6~"), keys(b"\x1b[D")].concat(),
            [Key::Forwards, Key::Forwards, Key::Backwards]
        );
        assert_eq!(keys(b"\xc3\xa9\x00"), []);
    }

    #[test]
    fn keys_that_come_together_are_all_taken() {
        use Key::{Backwards, Char, Escape, Forwards, Space};
        assert_eq!(keys(b"\x1b\x1b"), [Escape, Escape]);
        assert_eq!(keys(b"\x1ba\x1b"), [Escape, Char('a'), Escape]);
        assert_eq!(keys(b"\x1b[C\x1b[Ds\x1b"), [Forwards, Backwards, Char('s'), Escape]);
        assert_eq!(keys(b"\x1bOC\x1b[1;5D \x1bO"), [Forwards, Space, Escape, Char('o')]);
        assert_eq!(keys(b"\x1b[[A\x1b[15~"), []);
        assert_eq!(keys(b"\x1b["), [Escape, Char('[')]);
        assert_eq!(keys(b"\x1b[\x1b"), [Escape, Char('['), Escape]);
    }
}
