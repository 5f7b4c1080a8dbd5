use kurbo::Point;

use super::ports::Ports;
use super::search::Search;
use super::travel::{StrokeEnd, Travel};
use crate::{Drawing, Stroke};

/// Most strokes of a region. A kick costs time in proportion to the tour it is in, since moves turn around parts of
/// it, and regions smaller than this lose more at their borders than they gain.
const REGION: usize = 600;

/// Sweeps over the start joints at most; each lowers the cost, and later ones hardly do.
const SWEEPS: usize = 8;

/// One stroke of a route: which, and through which port it is entered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stop {
    pub(super) stroke: u32,
    pub(super) entry: u32,
}

impl Stop {
    /// The stroke as this stop draws it.
    pub(super) fn drawn(self, drawing: &Drawing, ports: &Ports) -> Stroke {
        let stroke = &drawing.strokes[self.stroke as usize];
        let joint = ports.joint[self.entry as usize] as usize;
        match (stroke.path.is_closed(), joint) {
            (true, _) => stroke.along(stroke.path.started_at(joint)),
            (false, 0) => stroke.clone(),
            (false, _) => stroke.reversed(),
        }
    }
}

/// An order of all strokes that is being improved.
pub(super) struct Route<'a, C> {
    pub(super) stops: Vec<Stop>,
    pub(super) ports: &'a Ports,
    pub(super) start: Point,
    pub(super) cost: &'a C,
}

impl<C: Travel> Route<'_, C> {
    /// Improves the whole until no single move does.
    pub(super) fn settle(&mut self) {
        let runs: Vec<_> = (0..self.stops.len()).map(|i| i..i + 1).collect();
        self.search(&runs, 0, 0);
    }

    /// Kicks the strokes marked in `region` only. What lies between two of them on the route is one long stroke to
    /// the search, so that every order it finds is an order of the whole (Karp's partitioning as in Helsgaun,
    /// "Solving arc routing problems using the Lin-Kernighan-Helsgaun algorithm", 2014).
    pub(super) fn kick_region(&mut self, region: &[u32], kicks: usize, seed: u64) {
        if kicks == 0 {
            return;
        }
        let mut inside = vec![false; self.stops.len()];
        region.iter().for_each(|&stroke| inside[stroke as usize] = true);
        let is_inside = |i: usize| inside[self.stops[i].stroke as usize];
        let mut runs: Vec<std::ops::Range<usize>> = Vec::new();
        for i in 0..self.stops.len() {
            match runs.last_mut() {
                Some(run) if !is_inside(i) && !is_inside(run.start) => run.end = i + 1,
                _ => runs.push(i..i + 1),
            }
        }
        self.search(&runs, kicks, seed);
    }

    /// Where a run of stops is entered and left.
    fn ends(&self, run: &std::ops::Range<usize>) -> (StrokeEnd, StrokeEnd) {
        let (first, last) = (self.stops[run.start], self.stops[run.end - 1]);
        (self.ports.end(first.entry), self.ports.end(self.ports.exit(last.entry)))
    }

    /// See [`least_cost`](super::least_cost).
    pub(super) fn least_cost(&self) -> f64 {
        let strokes: Vec<_> = (0..self.stops.len()).map(|i| self.ends(&(i..i + 1))).collect();
        Search::new(&strokes, self.start, self.cost).least()
    }

    /// Improves the order of runs of stops.
    fn search(&mut self, runs: &[std::ops::Range<usize>], kicks: usize, seed: u64) {
        let strokes: Vec<_> = runs.iter().map(|run| self.ends(run)).collect();
        let mut search = Search::new(&strokes, self.start, self.cost);
        search.settle();
        search.kick(kicks, seed);
        let turned = |stop: &Stop| Stop { entry: self.ports.exit(stop.entry), ..*stop };
        let mut stops = Vec::with_capacity(self.stops.len());
        for (run, is_turned) in search.sequence() {
            let run = &self.stops[runs[run].clone()];
            match is_turned {
                true => stops.extend(run.iter().rev().map(turned)),
                false => stops.extend_from_slice(run),
            }
        }
        self.stops = stops;
    }

    /// Strokes that lie together, all of them in groups of [`REGION`] at most; another `round` has other borders.
    pub(super) fn regions(&self, round: usize) -> Vec<Vec<u32>> {
        let mut middles = vec![Point::ORIGIN; self.stops.len()];
        for stop in &self.stops {
            let [entry, exit] =
                [stop.entry, self.ports.exit(stop.entry)].map(|p| self.ports.points[p as usize]);
            middles[stop.stroke as usize] = entry.midpoint(exit);
        }
        let mut regions = Vec::new();
        let all = (0..middles.len() as u32).collect();
        divide(&middles, all, 1.0 / (2.0 + round as f64), &mut regions);
        regions
    }

    /// Moves the start of each closed stroke to the joint with the cheapest way in and out, its neighbours on the
    /// route as they are, until none moves.
    pub(super) fn choose_joints(&mut self) {
        for _ in 0..SWEEPS {
            let moved = (0..self.stops.len()).filter(|&i| self.choose_joint(i)).count();
            if moved == 0 {
                break;
            }
        }
    }

    fn between(&self, from: StrokeEnd, to: StrokeEnd) -> f64 {
        self.cost.cost(&self.cost.place(from), &self.cost.place(to))
    }

    fn choose_joint(&mut self, i: usize) -> bool {
        let stop = self.stops[i];
        if !self.ports.is_closed(stop.stroke) {
            return false;
        }
        let at = |port: u32| self.ports.end(port);
        let exit_of = |stop: &Stop| at(self.ports.exit(stop.entry));
        let before = if i == 0 { StrokeEnd::resting(self.start) } else { exit_of(&self.stops[i - 1]) };
        let after = self.stops.get(i + 1).map(|next| at(next.entry));
        let through = |port: u32| {
            let on = after.map_or(0.0, |next| self.between(at(port), next));
            self.between(before, at(port)) + on
        };
        let mut best = (through(stop.entry), stop.entry);
        for port in self.ports.range(stop.stroke) {
            let way = through(port);
            if way < best.0 * (1.0 - 1e-9) {
                best = (way, port);
            }
        }
        self.stops[i].entry = best.1;
        best.1 != stop.entry
    }
}

/// Cuts a region across its longer side, `share` of its strokes to one part, until all parts are small; parts of a
/// part are halves.
fn divide(middles: &[Point], mut region: Vec<u32>, share: f64, regions: &mut Vec<Vec<u32>>) {
    if region.len() <= REGION {
        regions.push(region);
        return;
    }
    let spread = |key: fn(&Point) -> f64| {
        let values = || region.iter().map(|&i| key(&middles[i as usize]));
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let key: fn(&Point) -> f64 = if spread(|p| p.x) >= spread(|p| p.y) { |p| p.x } else { |p| p.y };
    let cut = ((region.len() as f64 * share) as usize).clamp(1, region.len() - 1);
    let of = |i: &u32| key(&middles[*i as usize]);
    region.select_nth_unstable_by(cut, |a, b| of(a).total_cmp(&of(b)).then(a.cmp(b)));
    let rest = region.split_off(cut);
    divide(middles, region, 0.5, regions);
    divide(middles, rest, 0.5, regions);
}
