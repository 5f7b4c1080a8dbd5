//! Lines on their way to a board: orders one by one, moves as many as it holds.

use std::collections::VecDeque;

use crate::follower::Follower;
use crate::moves::Item;
use crate::pace::Pace;
use crate::text::Writer;
use crate::window::{Line, Window};

/// What is sent, and what was.
#[derive(Clone, Debug)]
pub(crate) struct Sender {
    pub(crate) writer: Writer,
    pub(crate) pace: Pace,
    pub(crate) window: Window,
    /// How far the board is with what was sent.
    pub(crate) follower: Follower,
    /// Moves that are not sent yet.
    pub(crate) items: VecDeque<Item>,
    /// The speed of the last one that was sent, units/s.
    pub(crate) speed: f64,
    /// Lines that go one by one, each after the answer to all before: a board that stores something hears nothing meanwhile.
    pub(crate) orders: VecDeque<String>,
    /// Most characters that waited on the board.
    pub(crate) most_waiting: usize,
}

impl Sender {
    pub(crate) fn new(
        writer: Writer,
        pace: Pace,
        characters: usize,
        orders: impl Iterator<Item = String>,
    ) -> Self {
        Self {
            writer,
            pace,
            window: Window::of(characters),
            follower: Follower::default(),
            items: VecDeque::new(),
            speed: 0.0,
            orders: orders.collect(),
            most_waiting: 0,
        }
    }

    /// Whether no move is on its way.
    pub(crate) fn is_idle(&self) -> bool {
        self.items.is_empty() && self.follower.is_idle()
    }

    /// Whether no order is on its way, and no line without its answer.
    pub(crate) fn is_quiet(&self) -> bool {
        self.orders.is_empty() && self.window.is_empty()
    }

    /// Adds what goes now to the bytes; a move, once it is known what follows it.
    pub(crate) fn give(&mut self, is_known: impl Fn(&Item) -> bool, now_us: u64, out: &mut Vec<u8>) {
        if !self.orders.is_empty() {
            if self.window.is_empty()
                && let Some(order) = self.orders.pop_front()
            {
                self.put(Line { text: order, ends: None }, out);
            }
            return;
        }
        while let Some(&front) = self.items.front() {
            let stops = front.is_rest() || self.items.iter().skip(1).any(Item::is_rest);
            if !stops && !is_known(&front) {
                return;
            }
            let speed = if front.is_rest() {
                0.0
            } else {
                self.pace.speed(self.speed, &front, self.items.iter().skip(1))
            };
            let before = self.writer.clone();
            let lines = self.writer.lines(&front, || self.pace.inverse_time(&front, speed));
            if !self.window.has_room(lines.iter().map(|line| line.len() + 1).sum()) {
                self.writer = before;
                return;
            }
            let begins = front.ends.wrapping_sub(front.ticks);
            self.follower.send((begins, front.ends), front.is_rest(), now_us);
            self.items.pop_front();
            self.speed = speed;
            let last = lines.len() - 1;
            for (i, text) in lines.into_iter().enumerate() {
                self.put(Line { text, ends: (i == last).then_some(front.ends) }, out);
            }
        }
    }

    fn put(&mut self, line: Line, out: &mut Vec<u8>) {
        out.extend_from_slice(line.text.as_bytes());
        out.push(b'\n');
        self.window.send(line);
        self.most_waiting = self.most_waiting.max(self.window.used());
    }
}
