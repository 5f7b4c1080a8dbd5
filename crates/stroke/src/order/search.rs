use kurbo::Point;

use super::memo::Memo;
use super::neighbours::{Neighbours, discounted};
use super::tour::Tour;
use super::travel::{StrokeEnd, Travel};

/// A move must gain this share of the travels it removes: anything less is rounding, and might go on forever.
pub(super) const LEAST_GAIN: f64 = 1e-9;

/// Longest run of strokes that a kick swaps with another: short, so that mending it stays local. Measured at equal
/// time on 5000 random strokes: 5 and 10 stall earlier, 50 costs half as much again and gains nothing.
const LONGEST_KICK: usize = 25;

/// How much longer than before a tour may be after a kick and still be kept, in mean travels; less and less, down to
/// nothing at the last kick. (Threshold accepting: Dueck & Scheuer, 1990.)
const PATIENCE: f64 = 0.1;

/// Costs that are remembered: what fits a core's own cache. A region's ends make more pairs, but few of them are asked for
/// at a time.
const MEMO: usize = 1 << 14;

/// Two travels that were taken out: between `u` and `p`, and the other.
#[derive(Clone, Copy)]
struct Join {
    u: u32,
    p: u32,
    /// What they cost.
    held: f64,
    other: f64,
}

/// Local search over one tour with fixed ends.
pub(super) struct Search<'a, T: Travel> {
    pub(super) tour: Tour,
    pub(super) neighbours: Neighbours,
    /// Joins done, each as what undoes it.
    log: Vec<Join>,
    /// Of each end what its travel costs.
    held: Vec<f64>,
    /// What the cost knows of the ends; the last two belong to the depot.
    places: Vec<T::Place>,
    cost: &'a T,
    memo: Memo,
    /// Half of what the cheapest travel from each end costs; nothing at the end "nowhere".
    shares: Vec<f64>,
    /// Whether moves that change the last stroke are tried: they cost a fifth of the time and matter only once.
    ends_anywhere: bool,
    waiting: Vec<u32>,
    is_waiting: Vec<bool>,
}

impl<'a, T: Travel> Search<'a, T> {
    /// Strokes in a first order, each given by the ends it is entered and left by.
    pub(super) fn new(strokes: &[(StrokeEnd, StrokeEnd)], start: Point, cost: &'a T) -> Self {
        let mut ends: Vec<StrokeEnd> = strokes.iter().flat_map(|&(entry, exit)| [entry, exit]).collect();
        ends.extend([StrokeEnd::resting(start); 2]);
        let points: Vec<Point> = ends.iter().map(|&end| cost.about(end)).collect();
        let mut search = Self {
            tour: Tour::new((0..=strokes.len() as u32).map(|k| 2 * k).collect()),
            neighbours: Neighbours::default(),
            log: Vec::new(),
            held: Vec::new(),
            places: ends.iter().map(|&end| cost.place(end)).collect(),
            cost,
            memo: Memo::new(if T::IS_DEAR { MEMO } else { 1 }),
            shares: Vec::new(),
            ends_anywhere: true,
            waiting: Vec::new(),
            is_waiting: vec![false; ends.len()],
        };
        search.neighbours = Neighbours::of_all(&points, search.nowhere(), |a, b| search.cost_of(a, b));
        let ends = 0..search.places.len() as u32;
        search.shares = ends.map(|end| 0.5 * search.neighbours.cheapest(end)).collect();
        search.neighbours.discount(&search.shares);
        search.hold();
        search
    }

    /// What all travels together cost at least; the last one leads nowhere and is free.
    pub(super) fn least(&self) -> f64 {
        let of_strokes = &self.shares[..self.nowhere() as usize];
        let dearest = of_strokes.iter().copied().fold(0.0, f64::max);
        (of_strokes.iter().sum::<f64>() - dearest).max(0.0)
    }

    /// Improves until no move does; returns what was gained.
    pub(super) fn settle(&mut self) -> f64 {
        self.ends_anywhere = true;
        (0..self.places.len() as u32).rev().for_each(|end| self.wait(end));
        let gained = self.mend();
        self.log.clear();
        gained
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
        self.places.len() as u32 - 2
    }

    /// Cost of a travel beyond what both of its ends cost at least. In every tour each end has one travel, so what is
    /// taken off for an end is the same for all of them, and exchanges that cannot gain are told at their first step.
    pub(super) fn travel(&self, a: u32, b: u32) -> f64 {
        discounted(self.cost_of(a, b), &self.shares, [a, b])
    }

    /// What the travel of an end costs in full: beside it what rounding does is nothing.
    pub(super) fn full(&self, end: u32) -> f64 {
        let link = self.tour.link(end);
        self.held(end) + self.shares[end as usize] + self.shares[link as usize]
    }

    /// Cost of a travel; always computed from the lower number to the higher, so that no asymmetry of the caller's
    /// cost makes a move and its opposite both look like a gain.
    fn cost_of(&self, a: u32, b: u32) -> f64 {
        let nowhere = self.nowhere();
        if a == nowhere || b == nowhere {
            return 0.0;
        }
        let (from, to) = if a < b { (a, b) } else { (b, a) };
        let cost = || self.cost.cost(&self.places[from as usize], &self.places[to as usize]);
        if T::IS_DEAR { self.memo.get((from, to), cost) } else { cost() }
    }

    /// Where a new travel from `end` may lead and what it costs, cheapest first.
    pub(super) fn ways_from(&self, end: u32) -> impl Iterator<Item = (u32, f64)> + '_ {
        let nowhere = self.nowhere();
        let free = (self.ends_anywhere && end != nowhere).then(|| (nowhere, -self.shares[end as usize]));
        free.into_iter().chain(self.neighbours.of(end).iter().copied())
    }

    pub(super) fn wait(&mut self, end: u32) {
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
            while let Some(gain) = self.exchange(self.tour.link(end)) {
                gained += gain;
            }
        }
        gained
    }

    /// What the travel of an end costs.
    pub(super) fn held(&self, end: u32) -> f64 {
        self.held[end as usize]
    }

    /// Asks anew for what all travels of the tour cost.
    fn hold(&mut self) {
        let ends = 0..self.places.len() as u32;
        self.held = ends.map(|end| self.travel(end, self.tour.link(end))).collect();
    }

    /// 2-opt: the travels of `u` and `v` become one between them and one between their links.
    pub(super) fn flip(&mut self, u: u32, v: u32) {
        let (p, w) = (self.tour.link(u), self.tour.link(v));
        self.log.push(Join { u, p, held: self.held(u), other: self.held(v) });
        self.tour.join(u, v);
        let costs = [self.travel(u, v), self.travel(p, w)];
        self.put(u, v, costs[0]);
        self.put(p, w, costs[1]);
    }

    fn put(&mut self, a: u32, b: u32, cost: f64) {
        self.held[a as usize] = cost;
        self.held[b as usize] = cost;
    }

    /// Number of flips that can be taken back.
    pub(super) fn flips(&self) -> usize {
        self.log.len()
    }

    /// Takes back all flips but the first `kept`.
    pub(super) fn undo(&mut self, kept: usize) {
        while self.log.len() > kept {
            let Some(Join { u, p, held, other }) = self.log.pop() else { return };
            let (v, w) = (self.tour.link(u), self.tour.link(p));
            self.tour.join(u, p);
            self.put(u, p, held);
            self.put(v, w, other);
        }
    }

    /// `count` times: swaps two short neighbouring runs somewhere (a local double bridge; Martin, Otto & Felten,
    /// "Large-step Markov chains for the TSP", 1991), mends the tour around them, and takes it all back where the
    /// tour got longer than patience allows.
    pub(super) fn kick(&mut self, count: usize, seed: u64) {
        let longest = LONGEST_KICK.min(self.tour.len().saturating_sub(2) / 2);
        let whole = self.total();
        let is_free = whole <= 0.0;
        if longest == 0 || count == 0 || is_free {
            return;
        }
        self.ends_anywhere = false;
        let before = self.tour.clone();
        let patience = PATIENCE * whole / self.tour.len() as f64;
        let mut random = Xorshift::new(seed);
        for left in (0..count).rev() {
            let u = random.below(self.places.len()) as u32;
            let [first, second] = [0; 2].map(|_: usize| 1 + random.below(longest));
            self.swap_runs([u, first as u32, second as u32], patience * left as f64 / count as f64);
        }
        self.settle();
        if self.total() > whole {
            self.tour = before;
            self.hold();
        }
    }

    /// Cost of the whole tour.
    pub(super) fn total(&self) -> f64 {
        let ends = 0..self.places.len() as u32;
        0.5 * ends.map(|end| self.cost_of(end, self.tour.link(end))).sum::<f64>()
    }

    /// Swaps the run of `first` strokes from `u` on with the `second` strokes after it, for as long as that does not
    /// cost more than `patience`.
    fn swap_runs(&mut self, [u, first, second]: [u32; 3], patience: f64) {
        let p = self.tour.link(u);
        let f = self.tour.far_end(u, first as usize);
        let q = self.tour.link(f);
        let v = self.tour.far_end(q, second as usize);
        let w = self.tour.link(v);
        let cut = self.held(u) + self.held(f) + self.held(v);
        let rounding = LEAST_GAIN * (self.full(u) + self.full(f) + self.full(v));
        let added = self.travel(p, q) + self.travel(v, u) + self.travel(f, w);
        self.log.clear();
        self.flip(u, w);
        self.flip(v, f);
        self.flip(v, u);
        [p, u, f, q, v, w].into_iter().for_each(|end| self.wait(end));
        let gain = cut - added + self.mend();
        if gain < -patience - rounding {
            self.undo(0);
        }
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
