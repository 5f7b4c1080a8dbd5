//! Which axis of a board turns a joint.

/// How a joint's motor is called on the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardAxis {
    /// Letter of the axis, such as `X`.
    pub letter: char,
    /// The motor turns the other way.
    pub reversed: bool,
}

/// Letters of the axes that boards have, in the order in which they tell places.
pub(crate) const LETTERS: [char; 6] = ['X', 'Y', 'Z', 'A', 'B', 'C'];

impl BoardAxis {
    /// Every axis, as a rig file names it.
    pub const NAMES: [&str; 12] = ["X", "-X", "Y", "-Y", "Z", "-Z", "A", "-A", "B", "-B", "C", "-C"];

    /// Its name in a rig file.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES[2 * self.index() + usize::from(self.reversed)]
    }

    /// Reads `X`, or `-Y` of a motor that turns the other way; `None` of what is no axis.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let (reversed, name) = text.strip_prefix('-').map_or((false, text), |rest| (true, rest));
        let mut letters = name.chars();
        let letter = letters.next()?.to_ascii_uppercase();
        (letters.next().is_none() && LETTERS.contains(&letter)).then_some(Self { letter, reversed })
    }

    /// Its place among the numbers of a report, from 0.
    pub(crate) fn index(self) -> usize {
        LETTERS.iter().position(|&letter| letter == self.letter).unwrap_or(0)
    }

    /// 1, or −1 of one that turns the other way.
    pub(crate) const fn sign(self) -> f64 {
        if self.reversed { -1.0 } else { 1.0 }
    }
}

impl std::fmt::Display for BoardAxis {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_a_letter_and_maybe_a_sign() {
        let of = |letter, reversed| Some(BoardAxis { letter, reversed });
        assert_eq!(BoardAxis::read("X"), of('X', false));
        assert_eq!(BoardAxis::read("-y"), of('Y', true));
        for none in ["", "-", "XY", "--X", "E", "1"] {
            assert_eq!(BoardAxis::read(none), None, "{none}");
        }
        for name in BoardAxis::NAMES {
            assert_eq!(BoardAxis::read(name).map(BoardAxis::name), Some(name));
        }
    }
}
