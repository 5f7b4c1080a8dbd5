use std::ops::Range;

use kurbo::Point;

use super::kdtree::{Gather, KdTree};
use super::tour::Tour;

/// Neighbours kept for each end. Ten: below eight the result suffers, above twelve only the time.
const NEIGHBOURS: usize = 10;

/// Longest run of strokes that Or-opt moves as one (Or, 1976).
const LONGEST_RUN: usize = 3;

/// Longest run of strokes that a kick swaps with another: short, so that mending it stays local. Measured at equal
/// time on 500 and 5000 random and hatched strokes: 5 stalls early, 25 costs three times as much a kick.
const LONGEST_KICK: usize = 10;

/// A move must gain this share of the travel it removes: anything less is rounding, and might go on forever.
const LEAST_GAIN: f64 = 1e-9;

/// Local search over one tour with fixed ends.
pub(super) struct Search<'a, C> {
    tour: Tour,
    /// Where the ends are; the last two belong to the depot.
    ends: Vec<Point>,
    neighbours: Neighbours,
    cost: &'a C,
    /// Whether moves that change the last stroke are tried: they cost a fifth of the time and matter only once.
    ends_anywhere: bool,
    waiting: Vec<u32>,
    is_waiting: Vec<bool>,
    /// Joins done, each as the pair that undoes it.
    log: Vec<(u32, u32)>,
}

/// A run of strokes that Or-opt may move: from the end in question to `far`.
#[derive(Clone, Copy, Default)]
struct Run {
    far: u32,
    /// What taking the run out gains on the far side.
    hole: f64,
}

impl<'a, C: Fn(Point, Point) -> f64> Search<'a, C> {
    /// Strokes in a first order, each given by the points it is entered and left at.
    pub(super) fn new(strokes: &[(Point, Point)], start: Point, cost: &'a C) -> Self {
        let mut ends: Vec<Point> = strokes.iter().flat_map(|&(entry, exit)| [entry, exit]).collect();
        ends.extend([start, start]);
        let mut search = Self {
            tour: Tour::new((0..=strokes.len() as u32).map(|k| 2 * k).collect()),
            neighbours: Neighbours::default(),
            cost,
            ends_anywhere: true,
            waiting: Vec::new(),
            is_waiting: vec![false; ends.len()],
            log: Vec::new(),
            ends,
        };
        search.neighbours = search.find_neighbours();
        search
    }

    /// Improves until no move does.
    pub(super) fn settle(&mut self) {
        self.ends_anywhere = true;
        (0..self.ends.len() as u32).rev().for_each(|end| self.wait(end));
        self.mend();
        self.log.clear();
    }

    /// The order that was found: the numbers of the strokes given to [`new`](Self::new), and whether each is turned
    /// around.
    pub(super) fn sequence(&self) -> impl Iterator<Item = (usize, bool)> {
        let depot = self.nowhere() >> 1;
        let entries = self.tour.entries_from(depot).into_iter().skip(1);
        entries.map(|end| ((end >> 1) as usize, end & 1 == 1))
    }

    /// The end from which any travel is free: that of the depot.
    fn nowhere(&self) -> u32 {
        self.ends.len() as u32 - 2
    }

    /// Cost of a travel; always computed from the lower number to the higher, so that no asymmetry of the caller's
    /// cost makes a move and its opposite both look like a gain.
    fn travel(&self, a: u32, b: u32) -> f64 {
        let nowhere = self.nowhere();
        if a == nowhere || b == nowhere {
            return 0.0;
        }
        let (from, to) = if a < b { (a, b) } else { (b, a) };
        (self.cost)(self.ends[from as usize], self.ends[to as usize])
    }

    fn find_neighbours(&self) -> Neighbours {
        let mut neighbours = Neighbours { first: vec![0], list: Vec::new() };
        let nowhere = self.nowhere();
        let tree = KdTree::new(&self.ends);
        for end in 0..self.ends.len() as u32 {
            let mut nearest = NearestEnds { own: end, nowhere, found: Vec::with_capacity(NEIGHBOURS + 1) };
            tree.search(self.ends[end as usize], &mut nearest);
            let mut list: Vec<_> = nearest.found.iter().map(|&(_, n)| (n, self.travel(end, n))).collect();
            list.sort_by(|a, b| a.1.total_cmp(&b.1));
            neighbours.list.extend(list);
            neighbours.first.push(neighbours.list.len() as u32);
        }
        neighbours
    }

    fn wait(&mut self, end: u32) {
        if !self.is_waiting[end as usize] {
            self.is_waiting[end as usize] = true;
            self.waiting.push(end);
        }
    }

    /// Works off the waiting ends; returns what was gained.
    fn mend(&mut self) -> f64 {
        let mut gained = 0.0;
        while let Some(end) = self.waiting.pop() {
            self.is_waiting[end as usize] = false;
            while let Some(gain) = self.improve(end) {
                gained += gain;
            }
        }
        gained
    }

    /// Makes the first move found that replaces the travel at `u` by a shorter one; returns its gain.
    fn improve(&mut self, u: u32) -> Option<f64> {
        let p = self.tour.link(u);
        let held = self.travel(u, p);
        let enough = held * (1.0 - LEAST_GAIN);
        let mut runs = None;
        if self.ends_anywhere && held > 0.0 && u != self.nowhere() {
            let runs = *runs.get_or_insert_with(|| self.runs(u, p));
            if let Some(gain) = self.replace(u, held, (self.nowhere(), 0.0), &runs) {
                return Some(gain);
            }
        }
        for i in self.neighbours.of(u) {
            let (v, reach) = self.neighbours.list[i];
            // asked this way round, a cost that is not a number ends the search too
            let shorter = reach < enough;
            if !shorter {
                return None;
            }
            let runs = *runs.get_or_insert_with(|| self.runs(u, p));
            if let Some(gain) = self.replace(u, held, (v, reach), &runs) {
                return Some(gain);
            }
        }
        None
    }

    /// The runs of one to [`LONGEST_RUN`] strokes that begin at `u` with its link `p`. Of a small tour fewer: a run
    /// has to leave two strokes to be moved between.
    fn runs(&self, u: u32, p: u32) -> [Option<Run>; LONGEST_RUN] {
        let mut far = u ^ 1;
        std::array::from_fn(|i| {
            let after = self.tour.link(far);
            let hole = self.travel(far, after) - self.travel(p, after);
            let run = Run { far, hole };
            far = after ^ 1;
            (i + 3 <= self.tour.len()).then_some(run)
        })
    }

    /// Tries the moves that bring the end `u` (its travel costs `held`) next to `v` (`reach` away).
    fn replace(
        &mut self,
        u: u32,
        held: f64,
        (v, reach): (u32, f64),
        runs: &[Option<Run>; LONGEST_RUN],
    ) -> Option<f64> {
        let w = self.tour.link(v);
        let freed = held + self.travel(v, w) - reach;
        let least = LEAST_GAIN * held;
        if self.tour.enters(u) == self.tour.enters(v) {
            let gain = freed - self.travel(self.tour.link(u), w);
            if gain > least {
                self.join(u, v);
                return Some(gain);
            }
        }
        let mut last = u;
        for run in runs.iter().flatten() {
            // neither `v` nor `w` may lie in the run: each run adds the stroke of its far end to the one before
            if [v, w].iter().any(|end| end >> 1 == last >> 1 || end >> 1 == run.far >> 1) {
                return None;
            }
            last = run.far;
            let gain = freed + run.hole - self.travel(run.far, w);
            if gain > least {
                self.move_run(u, run.far, v);
                return Some(gain);
            }
        }
        None
    }

    /// Or-opt: takes out the run that goes from `u` to `f` and puts it between `v` and its link, `u` at `v`.
    fn move_run(&mut self, u: u32, f: u32, v: u32) {
        let (p, w) = (self.tour.link(u), self.tour.link(v));
        if self.tour.enters(u) == self.tour.enters(v) {
            self.join(u, v);
            self.join(f, w);
        } else {
            self.join(p, f);
            self.join(f, w);
            self.join(u, v);
        }
    }

    fn join(&mut self, u: u32, v: u32) {
        let (p, w) = (self.tour.link(u), self.tour.link(v));
        self.tour.join(u, v);
        self.log.push((u, p));
        for end in [u, v, p, w] {
            self.wait(end);
        }
    }

    /// `count` times: swaps two short neighbouring runs somewhere (a local double bridge; Martin, Otto & Felten,
    /// "Large-step Markov chains for the TSP", 1991), mends the tour around them, and takes it all back unless the
    /// tour got no longer.
    pub(super) fn kick(&mut self, count: usize, seed: u64) {
        let longest = LONGEST_KICK.min(self.tour.len().saturating_sub(2) / 2);
        if longest == 0 || count == 0 || self.is_free() {
            return;
        }
        self.ends_anywhere = false;
        let mut random = Xorshift::new(seed);
        for _ in 0..count {
            let u = random.below(self.ends.len()) as u32;
            let [first, second] = [0; 2].map(|_: usize| 1 + random.below(longest));
            self.swap_runs(u, first, second);
        }
        self.settle();
    }

    /// Whether no travel costs anything: then there is nothing to gain.
    fn is_free(&self) -> bool {
        (0..self.ends.len() as u32).all(|end| self.travel(end, self.tour.link(end)) <= 0.0)
    }

    /// Swaps the run of `first` strokes from `u` on with the `second` strokes after it, for as long as it pays.
    fn swap_runs(&mut self, u: u32, first: usize, second: usize) {
        let p = self.tour.link(u);
        let f = self.tour.far_end(u, first);
        let q = self.tour.link(f);
        let v = self.tour.far_end(q, second);
        let w = self.tour.link(v);
        let cut = self.travel(p, u) + self.travel(f, q) + self.travel(v, w);
        let added = self.travel(p, q) + self.travel(v, u) + self.travel(f, w);
        self.log.clear();
        self.move_run(u, f, v);
        let gain = cut - added + self.mend();
        if gain < -LEAST_GAIN * cut {
            while let Some((u, p)) = self.log.pop() {
                self.tour.join(u, p);
            }
        }
    }
}

/// For each end the nearest ends of other strokes and what the way there costs, cheapest first.
#[derive(Default)]
struct Neighbours {
    first: Vec<u32>,
    list: Vec<(u32, f64)>,
}

impl Neighbours {
    fn of(&self, end: u32) -> Range<usize> {
        self.first[end as usize] as usize..self.first[end as usize + 1] as usize
    }
}

struct NearestEnds {
    own: u32,
    nowhere: u32,
    found: Vec<(f64, u32)>,
}

impl NearestEnds {
    /// Squared distance from which on an end is none of the nearest.
    fn reach_sq(&self) -> f64 {
        match self.found.len() < NEIGHBOURS {
            true => f64::INFINITY,
            false => self.found[NEIGHBOURS - 1].0,
        }
    }
}

impl Gather for NearestEnds {
    fn wants(&self, _: usize, distance_sq: f64) -> bool {
        // asked this way round, a point that is not a number is still found
        let too_far = distance_sq >= self.reach_sq();
        !too_far
    }

    fn offer(&mut self, end: u32, distance_sq: f64) {
        let stranger = end >> 1 != self.own >> 1 && end != self.nowhere;
        let nearer = distance_sq < self.reach_sq();
        if !(stranger && nearer) {
            return;
        }
        let at = self.found.partition_point(|&known| known < (distance_sq, end));
        self.found.insert(at, (distance_sq, end));
        self.found.truncate(NEIGHBOURS);
    }
}

/// Marsaglia's xorshift64*, its state spread from the seed by SplitMix64 (Vigna, "An experimental exploration of
/// Marsaglia's xorshift generators, scrambled", 2016).
struct Xorshift(u64);

impl Xorshift {
    fn new(seed: u64) -> Self {
        let z = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        Self((z ^ (z >> 31)) | 1)
    }

    /// Below `bound`, which fits in 32 bits; the bias of a product and shift is below 2⁻³².
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32;
        ((high * bound as u64) >> 32) as usize
    }
}
