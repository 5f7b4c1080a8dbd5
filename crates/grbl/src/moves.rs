//! Ticks to moves: a board goes in straight lines of its axes, each of which stands for some ticks of what the joints are told.

use std::collections::VecDeque;

use tracelight_rig::{Joint, PanTilt};

/// Most ticks of a move: what is told is soon done, and a board that is halted is soon still.
const MOST_TICKS: usize = 50;
/// Least ticks of a move where light and rests allow it: a small board takes some 250 moves a second. Where it is lit, a corner that is passed may need shorter
/// ones for a moment.
const LEAST_TICKS: usize = 4;
const LEAST_LIT_TICKS: usize = 2;
/// Most ticks of a move that is shorter than a step.
const MOST_CREEPING: usize = 100;
/// Most ticks for which light stands by one order, so that it is soon out if nobody speaks any more.
const MOST_LIT_REST: usize = 200;
/// Shorter rests are a part of the move behind them: Grbl rests for whole steps of this many ticks, and empties its plan before.
pub(crate) const SHORTEST_REST: u32 = 50;
/// After so many ticks of darkness at rest nothing is due soon.
pub(crate) const PARKED_TICKS: usize = 60;
/// Furthest that a joint may be from where it is told to be where it is dark, rad.
const DARK_RAD: f64 = 3e-4;
/// Furthest where it is lit, in steps, if what is asked for is less: places are rounded to steps anyway.
const LEAST_STEPS: f64 = 0.1;
/// Nearer than this two places are the same, steps.
const SAME: f64 = 1e-3;

/// Where the joints are told to be at the start of a tick, in steps of the board, and whether there is light until the next one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) at: PanTilt<f64>,
    pub(crate) lit: bool,
}

/// What a board is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Item {
    /// Tick at whose start it is done.
    pub(crate) ends: u32,
    pub(crate) ticks: u32,
    pub(crate) lit: bool,
    /// Where it leads, whole steps, and by how many; by none of a rest.
    pub(crate) to: PanTilt<i64>,
    pub(crate) by: PanTilt<i64>,
    /// How fast the joints are there told to turn at its beginning and its end, steps a tick.
    pub(crate) rates: (PanTilt<f64>, PanTilt<f64>),
}

impl Item {
    /// Whether it leads nowhere.
    pub(crate) fn is_rest(&self) -> bool {
        self.by == PanTilt::new(0, 0)
    }
}

/// Makes moves of ticks, as few as keep the joints near to where they are told to be.
#[derive(Clone, Debug)]
pub(crate) struct Builder {
    /// From the end of the last item on.
    points: VecDeque<Point>,
    /// Tick of the first of them.
    first: u32,
    /// Where the last item led, whole steps.
    at: PanTilt<i64>,
    lit: PanTilt<f64>,
    dark: PanTilt<f64>,
    /// Ticks of a rest that is too short to be one.
    rested: u32,
    /// Ticks over which a line from the first point is known to keep near.
    good: usize,
}

impl Builder {
    /// Of joints that rest there at a tick, whose steps are so large, rad; where there is light they may be so far off, rad.
    pub(crate) fn new(at: PanTilt<i64>, tick: u32, step_rad: PanTilt<f64>, lit_rad: f64) -> Self {
        let steps = |rad: f64| step_rad.map(|step_rad| (rad / step_rad).max(LEAST_STEPS));
        let point = Point { at: at.map(|at| at as f64), lit: false };
        Self {
            points: VecDeque::from([point]),
            first: tick,
            at,
            lit: steps(lit_rad),
            dark: steps(DARK_RAD),
            rested: 0,
            good: 1,
        }
    }

    /// Whether nothing is on its way: a tick like the last one adds nothing.
    pub(crate) fn is_still(&self, point: &Point) -> bool {
        self.points.len() == 1 && !point.lit && self.points.back().is_some_and(|last| same(last.at, point.at))
    }

    /// A tick goes by in which nothing is told.
    pub(crate) fn wait(&mut self, tick: u32) {
        self.first = tick;
    }

    /// Ticks that were told and are in no item yet.
    pub(crate) fn pending(&self) -> usize {
        self.points.len() - 1
    }

    /// Takes where the joints are told to be next, and adds to the items what is settled by that. Whether nothing moves and nothing is lit any more.
    pub(crate) fn push(&mut self, point: Point, items: &mut VecDeque<Item>) -> bool {
        self.points.push_back(point);
        loop {
            let rests = self.rests();
            let known = self.points.len() - 1;
            if rests == known && known >= PARKED_TICKS && !self.points[0].lit {
                self.drop_to(known);
                return true;
            }
            let Some(item) = self.cut(rests, known) else { return false };
            if item.is_rest() && item.ticks < SHORTEST_REST {
                self.rested = item.ticks;
            } else {
                items.push_back(item);
            }
        }
    }

    /// Makes items of all that is told, whatever follows. Whether nothing moves and nothing is lit at the end.
    pub(crate) fn settle(&mut self, items: &mut VecDeque<Item>) -> bool {
        loop {
            let (known, rests) = (self.pending(), self.rests());
            if rests == known && !self.points[0].lit {
                self.drop_to(known);
                return true;
            }
            if known == 0 {
                return false;
            }
            let lit = self.points[0].lit;
            let alike = (1..known).take_while(|&k| self.points[k].lit == lit).count() + 1;
            let ticks = if rests > 0 { rests } else { alike };
            let item = self.item(ticks);
            items.push_back(item);
        }
    }

    /// Ticks at the beginning in which nothing moves and light stays as it is.
    fn rests(&self) -> usize {
        let lit = self.points[0].lit;
        let is_rest =
            |i: &usize| same(self.points[*i].at, self.points[i + 1].at) && self.points[*i].lit == lit;
        (0..self.points.len() - 1).take_while(is_rest).count()
    }

    fn cut(&mut self, rests: usize, known: usize) -> Option<Item> {
        let lit = self.points[0].lit;
        if rests > 1 || rests == 1 && (lit || known == 1) {
            let is_over = rests < known || rests >= MOST_LIT_REST;
            return (is_over && rests > 0 && (rests > 1 || lit)).then(|| self.item(rests));
        }
        if known == 0 {
            return None;
        }
        // as far as light stays as it is and the joints move
        let goes_on = |k: usize| {
            self.points[k].lit == lit
                && (k < LEAST_TICKS.min(2) || !same(self.points[k].at, self.points[k + 1].at))
        };
        while self.good < known {
            let next = self.good + 1;
            if !goes_on(self.good) {
                return Some(self.item(self.good));
            }
            let creeps = self.rounded(self.good) == self.at;
            let least = if lit { LEAST_LIT_TICKS } else { LEAST_TICKS };
            let fits = self.good < least
                || creeps && self.good < MOST_CREEPING
                || self.good < MOST_TICKS && self.is_near(next);
            if !fits {
                return Some(self.item(self.good));
            }
            self.good = next;
        }
        None
    }

    fn rounded(&self, k: usize) -> PanTilt<i64> {
        self.points[k].at.map(|at| at.round() as i64)
    }

    /// Whether a straight line in equal times to that point keeps near to what is told on the way.
    fn is_near(&self, to: usize) -> bool {
        let (from_at, to_at) = (self.at.map(|at| at as f64), self.rounded(to).map(|at| at as f64));
        let most = if self.points[0].lit { &self.lit } else { &self.dark };
        (1..to).all(|k| {
            let t = k as f64 / to as f64;
            Joint::BOTH.iter().all(|&j| {
                let here = from_at[j] + t * (to_at[j] - from_at[j]);
                // half a step is what rounding makes of any place
                (here - self.points[k].at[j]).abs() <= most[j] + 0.5
            })
        })
    }

    /// The item over so many ticks.
    fn item(&mut self, ticks: usize) -> Item {
        let to = self.rounded(ticks);
        let by = PanTilt::from_fn(|j| to[j] - self.at[j]);
        let rate = |k: usize| PanTilt::from_fn(|j| self.points[k].at[j] - self.points[k - 1].at[j]);
        let rates = (rate(1), rate(ticks));
        let lit = self.points[0].lit;
        self.drop_to(ticks);
        self.at = to;
        let rested = if by == PanTilt::new(0, 0) { 0 } else { std::mem::take(&mut self.rested) };
        Item { ends: self.first, ticks: ticks as u32 + rested, lit, to, by, rates }
    }

    fn drop_to(&mut self, ticks: usize) {
        self.points.drain(..ticks);
        self.first = self.first.wrapping_add(ticks as u32);
        self.good = 1;
    }
}

fn same(a: PanTilt<f64>, b: PanTilt<f64>) -> bool {
    (a.pan - b.pan).abs() < SAME && (a.tilt - b.tilt).abs() < SAME
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_RAD: PanTilt<f64> = PanTilt::new(2e-4, 2e-4);

    fn point(pan: f64, tilt: f64, lit: bool) -> Point {
        Point { at: PanTilt::new(pan, tilt), lit }
    }

    /// Items of a way, which ends at rest.
    fn items(way: &[Point]) -> (Vec<Item>, bool) {
        let start = way[0].at.map(|at| at.round() as i64);
        let mut builder = Builder::new(start, 100, STEP_RAD, 5e-5);
        let mut items = VecDeque::new();
        let mut parked = false;
        for point in &way[1..] {
            parked |= builder.push(*point, &mut items);
        }
        (items.into(), parked)
    }

    /// From rest to rest over `ticks`, by `steps`, then at rest for long.
    fn smooth(steps: f64, ticks: usize, lit: bool) -> Vec<Point> {
        let at = |k: usize| {
            let t = (k as f64 / ticks as f64).min(1.0);
            steps * t * t * (3.0 - 2.0 * t)
        };
        (0..ticks + 100).map(|k| point(at(k), -0.5 * at(k), lit && k < ticks)).collect()
    }

    #[test]
    fn a_way_becomes_moves_that_end_where_it_ends_and_last_as_long() {
        let (items, parked) = items(&smooth(400.0, 200, true));
        assert!(parked);
        // it creeps in to its end, for some ticks by no step
        assert!((190..=200).contains(&items.iter().map(|item| item.ticks).sum::<u32>()));
        let last = items[items.len() - 1];
        assert_eq!(last.to, PanTilt::new(400, -200));
        assert!((10..50).contains(&items.len()), "{}", items.len());
        assert!(items.iter().all(|item| item.lit));
        // slower than a step in that time it is longer
        let is_creeping = |item: &Item| item.by.pan.abs().max(item.by.tilt.abs()) <= 1;
        assert!(items.iter().all(|item| item.ticks <= MOST_TICKS as u32 || is_creeping(item)));
        assert!(items.iter().skip(1).all(|item| item.ticks >= LEAST_LIT_TICKS as u32 || item.ends > 290));
    }

    #[test]
    fn the_joints_keep_near_to_where_they_are_told_to_be() {
        let way = smooth(400.0, 200, true);
        let (items, _) = items(&way);
        let mut from = PanTilt::new(0.0, 0.0);
        let mut worst: f64 = 0.0;
        for item in &items {
            let (to, tick) = (item.to.map(|to| to as f64), (item.ends - item.ticks - 100) as usize);
            for k in 1..=item.ticks as usize {
                let t = k as f64 / f64::from(item.ticks);
                for j in Joint::BOTH {
                    let here = from[j] + t * (to[j] - from[j]);
                    worst = worst.max((here - way[tick + k].at[j]).abs());
                }
            }
            from = to;
        }
        assert!(worst <= 0.75, "{worst} steps");
    }

    #[test]
    fn light_changes_between_moves() {
        let mut way = smooth(400.0, 200, false);
        way[50..120].iter_mut().for_each(|point| point.lit = true);
        let (items, _) = items(&way);
        let mut tick = 100;
        for item in &items {
            let lit = (150..220).contains(&tick);
            assert_eq!(item.lit, lit, "at {tick}");
            tick += item.ticks;
            assert!(!lit || tick <= 220);
        }
    }

    #[test]
    fn short_rests_are_a_part_of_what_follows_and_long_ones_are_none_of_the_boards() {
        let mut way = smooth(100.0, 50, false);
        way.truncate(50 + 21);
        let from = way[way.len() - 1];
        way.extend((1..=50).map(|k| point(from.at.pan + f64::from(k), from.at.tilt, true)));
        let end = way[way.len() - 1].at;
        way.extend((0..80).map(|_| Point { at: end, lit: true }));
        way.extend((0..100).map(|_| Point { at: end, lit: false }));
        let (items, parked) = items(&way);
        assert!(parked);
        // the last tick of the lit way is a rest too
        let rests: Vec<(u32, bool)> =
            items.iter().filter(|item| item.is_rest()).map(|item| (item.ticks, item.lit)).collect();
        assert_eq!(rests, [(81, true)]);
        let moves = items.iter().filter(|item| !item.is_rest()).map(|item| item.ticks).sum::<u32>();
        // the tick in which light changes is dark
        assert_eq!(moves, 50 + 20 + 50);
    }
}
