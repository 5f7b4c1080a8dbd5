//! Sequential exchanges of two or three travels, found without touching the tour.
//!
//! Of the tour, read from `end`, the strokes are `end … base`, and the travel from `base` to `end` is to go. `end`
//! gets a neighbour `v`, whose travel (v, w) goes too. Either the strokes from `end` up to `w` may be turned around
//! (`v` lies behind `w`): that is a 2-opt move. Or those from `end` to `v` would become a round of their own (`v`
//! lies before `w`), and a third travel has to go: `w` gets a neighbour `q`, whose travel (q, r) goes, and `r` gets
//! `base`. (Lin, "Computer solutions of the traveling salesman problem", 1965; the gain criterion, by which only
//! exchanges that gain at every step are followed, is Lin & Kernighan's, 1973.)

use super::search::{LEAST_GAIN, Search};
use super::travel::Travel;

/// Exchanges done one after the other before their sum must be a gain. Two: a third costs time and gains nothing on
/// 5000 strokes.
const DEPTH: usize = 2;

/// Of larger tours only exchanges that gain by themselves are done: trying others turns long parts of the tour around
/// and back.
const LARGE: usize = 50_000;

/// An exchange that begins with a new travel from `end` to `v`.
#[derive(Clone, Copy)]
struct Exchange {
    v: u32,
    /// The link of `v`.
    w: u32,
    kind: Kind,
    /// What is gained before the last new travel is paid for.
    open: f64,
    /// What is gained in all.
    closed: f64,
    /// What the travels taken out cost in full, this exchange's and those before it.
    removed: f64,
}

impl Exchange {
    fn gains(&self) -> bool {
        self.closed > LEAST_GAIN * self.removed.abs()
    }
}

#[derive(Clone, Copy)]
enum Kind {
    /// 2-opt: `w` gets `base`.
    Two,
    /// 2-opt twice: `w` gets `q`, and its link `r` gets `base`.
    TwoTwice { q: u32, r: u32 },
    /// The strokes up to `q` and those from there to `v` are both turned around.
    BothTurned { q: u32, r: u32 },
    /// The strokes up to `q` and those from there to `v` change places.
    Swapped { q: u32, r: u32 },
}

/// The best exchange so far: the first that gains ends the search, else the one that leaves most to go on with.
#[derive(Default)]
struct Best {
    found: Option<Exchange>,
}

impl Best {
    /// Takes note of an exchange; whether it gains.
    fn offer(&mut self, exchange: Exchange) -> bool {
        let gains = exchange.gains();
        if gains || self.found.is_none_or(|best| exchange.open > best.open) {
            self.found = Some(exchange);
        }
        gains
    }
}

impl<T: Travel> Search<'_, T> {
    /// Makes the first exchange found that replaces the travel between `base` and its link by something shorter, or
    /// several that do together; returns the gain.
    pub(super) fn exchange(&mut self, base: u32) -> Option<f64> {
        let held = self.held(base);
        if held > 0.0 { self.exchange_on(base, [held, self.full(base)], 1) } else { None }
    }

    /// `open` is what the exchanges so far have gained, the travel from `base` to its link not counted, `removed` the
    /// travels they took out.
    fn exchange_on(&mut self, base: u32, [open, removed]: [f64; 2], depth: usize) -> Option<f64> {
        let end = self.tour.link(base);
        let mut best = Best::default();
        self.look_for(base, end, [open, removed], &mut best);
        let exchange = best.found?;
        let gains = exchange.gains();
        if !gains && (depth == DEPTH || self.tour.len() > LARGE) {
            return None;
        }
        let done = self.flips();
        self.perform(end, &exchange);
        let gain = match gains {
            true => Some(exchange.closed),
            false => self.exchange_on(base, [exchange.open, exchange.removed], depth + 1),
        };
        match gain {
            Some(_) => self.wake(base, end, &exchange),
            None => self.undo(done),
        }
        gain
    }

    fn look_for(&self, base: u32, end: u32, [open, removed]: [f64; 2], best: &mut Best) {
        let side = self.tour.enters(end);
        for (v, reach) in self.ways_from(end) {
            let left = open - reach;
            // asked this way round, a cost that is not a number ends the search too
            let goes_on = left > 0.0;
            if !goes_on {
                return;
            }
            let w = self.tour.link(v);
            if v == base || v == end {
                continue;
            }
            let out = self.held(v);
            let (open, removed) = (left + out, removed + self.full(v));
            let turns = self.tour.enters(v) == side;
            if turns {
                let closed = open - self.travel(base, w);
                if best.offer(Exchange { v, w, kind: Kind::Two, open, closed, removed }) {
                    return;
                }
            }
            let first = Exchange { v, w, kind: Kind::Two, open, closed: 0.0, removed };
            if self.look_for_third(base, end, first, best) {
                return;
            }
        }
    }

    /// Goes on with a third travel after `first`; whether an exchange was found that gains.
    fn look_for_third(&self, base: u32, end: u32, first: Exchange, best: &mut Best) -> bool {
        let Exchange { v, w, .. } = first;
        let side = self.tour.enters(end);
        let turns = self.tour.enters(v) == side;
        for &(q, reach) in self.neighbours.of(w) {
            let left = first.open - reach;
            let goes_on = left > 0.0;
            if !goes_on {
                return false;
            }
            if q == end || q == v || q == base || q == w {
                continue;
            }
            let same = self.tour.enters(q) == side;
            let far = if turns { w } else { v };
            let is_before = self.tour.is_between(end, q, far);
            let r = self.tour.link(q);
            let kind = match (turns, is_before, same) {
                (true, true, false) | (true, false, true) => Kind::TwoTwice { q, r },
                (false, true, true) => Kind::BothTurned { q, r },
                (false, true, false) => Kind::Swapped { q, r },
                // the tour would fall in two
                _ => continue,
            };
            let out = self.held(q);
            let (open, removed) = (left + out, first.removed + self.full(q));
            let closed = open - self.travel(base, r);
            if best.offer(Exchange { v, w, kind, open, closed, removed }) {
                return true;
            }
        }
        false
    }

    fn perform(&mut self, end: u32, exchange: &Exchange) {
        let Exchange { v, w, .. } = *exchange;
        match exchange.kind {
            Kind::Two => self.flip(end, v),
            Kind::TwoTwice { q, .. } => {
                self.flip(end, v);
                self.flip(w, q);
            }
            Kind::BothTurned { q, .. } => {
                self.flip(end, q);
                self.flip(end, v);
            }
            Kind::Swapped { q, .. } => {
                self.flip(end, w);
                self.flip(v, q);
                self.flip(v, end);
            }
        }
    }

    fn wake(&mut self, base: u32, end: u32, exchange: &Exchange) {
        for end in [base, end, exchange.v, exchange.w] {
            self.wait(end);
        }
        if let Kind::TwoTwice { q, r } | Kind::BothTurned { q, r } | Kind::Swapped { q, r } = exchange.kind {
            self.wait(q);
            self.wait(r);
        }
    }
}
