//! How far a board is: by its answers, its reports, and the clock between them.

use std::collections::VecDeque;

/// How long a report is on its way when it is heard, µs: some sixty characters.
const REPORT_US: u64 = 5_000;
const TICK_US: u64 = 1_000;

/// A move on the board.
#[derive(Clone, Copy, Debug)]
struct Sent {
    /// Tick at whose start it begins, and at whose start it is done.
    begins: u32,
    ends: u32,
    /// A board answers a rest when that is over, a move when it has taken it.
    is_rest: bool,
    /// The board has taken it.
    taken: bool,
}

/// What a board has been sent, and how far it is by what is known.
#[derive(Clone, Debug, Default)]
pub(crate) struct Follower {
    sent: VecDeque<Sent>,
    /// A tick, and when it began; not yet, of a board that has not begun with what it was sent.
    base: (u32, Option<u64>),
}

impl Follower {
    /// Whether the board has nothing to do any more.
    pub(crate) fn is_idle(&self) -> bool {
        self.sent.is_empty()
    }

    /// The board is sent what begins and ends in these ticks.
    pub(crate) fn send(&mut self, (begins, ends): (u32, u32), is_rest: bool, now_us: u64) {
        if self.sent.is_empty() {
            // a board begins with moves when it has enough, or when nothing more comes
            self.base = (begins, is_rest.then_some(now_us));
        }
        self.sent.push_back(Sent { begins, ends, is_rest, taken: false });
    }

    /// The board has answered what ends in that tick.
    pub(crate) fn taken(&mut self, ends: u32, now_us: u64) {
        let Some(sent) = self.sent.iter_mut().find(|sent| sent.ends == ends) else { return };
        sent.taken = true;
        if sent.is_rest {
            self.set(ends, now_us);
            while self.sent.front().is_some_and(|sent| ends.wrapping_sub(sent.ends).cast_signed() >= 0) {
                self.sent.pop_front();
            }
        }
    }

    /// The board has done all that it was sent, and rests.
    pub(crate) fn done(&mut self, now_us: u64) {
        if let Some(last) = self.sent.back().map(|sent| sent.ends) {
            self.set(last, now_us);
            self.sent.clear();
        }
    }

    /// The board was at that tick when it made a report that is heard now.
    pub(crate) fn at(&mut self, tick: u32, now_us: u64) {
        self.set(tick, now_us.saturating_sub(REPORT_US));
    }

    /// At a tick just now.
    pub(crate) fn set(&mut self, tick: u32, now_us: u64) {
        self.base = (tick, Some(now_us));
    }

    /// Whether the board has yet to begin with what it was sent.
    pub(crate) fn begins(&self) -> bool {
        !self.sent.is_empty() && self.base.1.is_none()
    }

    /// The tick that begins now, by the clock.
    pub(crate) fn by_clock(&self, now_us: u64) -> u32 {
        let (tick, began) = self.base;
        let since_us = began.map_or(0, |began| now_us.saturating_sub(began));
        tick.wrapping_add((since_us / TICK_US) as u32)
    }

    /// The first tick that the board cannot have begun, if it has something to do.
    pub(crate) fn until(&self) -> Option<u32> {
        let last = self.sent.back()?.ends;
        let may_have_begun = |sent: &&Sent| sent.taken || sent.is_rest;
        let reached = self.sent.iter().take_while(may_have_begun).last();
        Some(match reached {
            // a tick before its end: whether it is there, it says
            Some(sent) if sent.ends == last => last.wrapping_sub(1),
            Some(sent) => sent.ends,
            None => self.sent.front()?.begins,
        })
    }

    /// Drops what is done before a tick.
    pub(crate) fn drop_before(&mut self, tick: u32) {
        while self.sent.len() > 1
            && self.sent.front().is_some_and(|sent| tick.wrapping_sub(sent.ends).cast_signed() > 0)
        {
            self.sent.pop_front();
        }
    }

    /// The board was reset.
    pub(crate) fn clear(&mut self) {
        self.sent.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_is_no_further_than_what_it_took() {
        let mut follower = Follower::default();
        assert!(follower.is_idle() && follower.until().is_none());
        follower.send((10, 30), false, 1_000_000);
        follower.send((30, 50), false, 1_000_000);
        assert_eq!(follower.until(), Some(10));
        follower.taken(30, 1_001_000);
        // it has taken a move, and not begun with it
        assert_eq!((follower.until(), follower.by_clock(1_015_000), follower.begins()), (Some(30), 10, true));
        follower.at(12, 1_020_000);
        assert_eq!((follower.by_clock(1_021_000), follower.begins()), (18, false));
        follower.taken(50, 1_021_000);
        assert_eq!(follower.until(), Some(49));
        // it says that it is behind
        follower.at(15, 1_025_000);
        assert_eq!(follower.by_clock(1_030_000), 25);
        follower.drop_before(31);
        follower.done(1_100_000);
        assert_eq!((follower.is_idle(), follower.by_clock(1_100_000)), (true, 50));
    }

    #[test]
    fn a_rest_is_over_when_it_is_answered() {
        let mut follower = Follower::default();
        follower.send((0, 20), false, 0);
        follower.send((20, 60), true, 0);
        follower.send((60, 80), false, 0);
        follower.taken(20, 1_000);
        assert_eq!(follower.until(), Some(60));
        follower.taken(60, 70_000);
        assert_eq!((follower.until(), follower.by_clock(70_000)), (Some(60), 60));
    }
}
