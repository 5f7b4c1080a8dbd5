//! Keys that are pressed in a terminal, each as it is pressed.

use std::io::{IsTerminal, Read};
use std::sync::mpsc::{Receiver, channel};

/// A key that means something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Key {
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
pub(crate) struct Keys {
    pressed: Receiver<Key>,
    _raw: Raw,
}

impl Keys {
    /// Listens, if standard input is a terminal that can tell single keys.
    pub(crate) fn listen() -> Option<Self> {
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
    pub(crate) fn next(&self) -> Option<Key> {
        self.pressed.try_recv().ok()
    }
}

/// What the bytes that came at once say. Other keys that send several bytes mean nothing here.
fn keys(bytes: &[u8]) -> Vec<Key> {
    match bytes {
        b"\x1b[C" | b"\x1bOC" | b"\x1b[6~" => return vec![Key::Forwards],
        b"\x1b[D" | b"\x1bOD" | b"\x1b[5~" => return vec![Key::Backwards],
        [0x1b, _, ..] => return Vec::new(),
        _ => {}
    }
    let key = |byte: &u8| match byte {
        0x03 => Some(Key::Interrupt),
        0x1b => Some(Key::Escape),
        b'\r' | b'\n' => Some(Key::Enter),
        b' ' => Some(Key::Space),
        byte if byte.is_ascii_graphic() => Some(Key::Char(char::from(*byte).to_ascii_lowercase())),
        _ => None,
    };
    bytes.iter().filter_map(key).collect()
}

/// A terminal that hands over single keys, does not show them, and leaves Ctrl-C to the program.
struct Raw {
    #[cfg(unix)]
    before: nix::sys::termios::Termios,
}

#[cfg(unix)]
impl Raw {
    fn enter() -> Option<Self> {
        use nix::sys::termios::{LocalFlags, SetArg, tcgetattr, tcsetattr};
        let before = tcgetattr(std::io::stdin()).ok()?;
        let mut raw = before.clone();
        raw.local_flags &= !(LocalFlags::ICANON | LocalFlags::ECHO | LocalFlags::ISIG);
        tcsetattr(std::io::stdin(), SetArg::TCSANOW, &raw).ok()?;
        Some(Self { before })
    }
}

#[cfg(unix)]
impl Drop for Raw {
    fn drop(&mut self) {
        use nix::sys::termios::{SetArg, tcsetattr};
        tcsetattr(std::io::stdin(), SetArg::TCSANOW, &self.before).ok();
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
}
