//! How much of what was sent may still wait in a board's memory.

use std::collections::VecDeque;

/// Lines on their way, counted by their characters: a board answers each of them, in order, once it has taken it out of its memory.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    room: usize,
    used: usize,
    lines: VecDeque<(usize, Line)>,
}

/// What an answer is of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Line {
    /// The line itself, for people.
    pub(crate) text: String,
    /// Last tick of the move that it ends, if it ends one.
    pub(crate) ends: Option<u32>,
}

impl Window {
    /// Of a board that has memory for so many characters. One is left free: some boards count one less than they have.
    pub(crate) const fn of(characters: usize) -> Self {
        Self { room: characters.saturating_sub(1), used: 0, lines: VecDeque::new() }
    }

    /// Whether there is room for lines of so many characters together, with their ends. A line that is longer than all of it goes alone.
    pub(crate) fn has_room(&self, characters: usize) -> bool {
        self.used == 0 || self.used + characters <= self.room
    }

    /// Counts a line that is sent now, with its end.
    pub(crate) fn send(&mut self, line: Line) {
        let characters = line.text.len() + 1;
        self.used += characters;
        self.lines.push_back((characters, line));
    }

    /// The line that was answered; `None` of an answer to nothing.
    pub(crate) fn answered(&mut self) -> Option<Line> {
        let (characters, line) = self.lines.pop_front()?;
        self.used -= characters;
        Some(line)
    }

    /// Whether nothing waits for an answer.
    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Characters that wait, at most so many.
    pub(crate) const fn used(&self) -> usize {
        self.used
    }

    /// Forgets what was sent: the board was reset.
    pub(crate) fn clear(&mut self) {
        (self.used, self.lines) = (0, VecDeque::new());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_is_on_its_way_than_the_board_holds() {
        let mut window = Window::of(128);
        let line = |length: usize| Line { text: "x".repeat(length), ends: None };
        let mut sent = 0;
        while window.has_room(25) {
            window.send(line(24));
            sent += 1;
        }
        assert_eq!((sent, window.used()), (5, 125));
        assert!(window.has_room(2) && !window.has_room(3));
        assert_eq!(window.answered(), Some(line(24)));
        assert_eq!(window.used(), 100);
        window.clear();
        assert!(window.is_empty() && window.answered().is_none() && window.has_room(1000));
    }
}
