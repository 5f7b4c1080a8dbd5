use std::cmp::Ordering;
use std::ops::Range;

use kurbo::{Point, Rect};

use super::kdtree::{Gather, KdTree};

/// Nearest ends kept for each end, whatever their direction.
const NEAREST: usize = 6;

/// Nearest ends kept in each quadrant around an end: between hatched patches all the nearest lie in the own patch
/// (Johnson & McGeoch, "Experimental analysis of heuristics for the STSP", 2002, §3.3).
const NEAREST_EACH_WAY: usize = 2;

/// For each end the nearest ends of other strokes and what the way there costs, cheapest first.
#[derive(Default)]
pub(super) struct Neighbours {
    first: Vec<u32>,
    list: Vec<(u32, f64)>,
}

impl Neighbours {
    /// Of all `ends`, the two of a stroke side by side; `nowhere` is nobody's neighbour.
    pub(super) fn of_all(ends: &[Point], nowhere: u32, travel: impl Fn(u32, u32) -> f64) -> Self {
        let mut neighbours = Self { first: vec![0], list: Vec::with_capacity(8 * ends.len()) };
        let tree = KdTree::new(ends);
        for own in 0..ends.len() as u32 {
            let from = neighbours.list.len();
            let quadrants = [None, Some(0), Some(1), Some(2), Some(3)];
            for quadrant in quadrants {
                let most = if quadrant.is_none() { NEAREST } else { NEAREST_EACH_WAY };
                let found = Vec::with_capacity(most + 1);
                let mut nearest = NearestEnds { own, nowhere, ends, quadrant, most, found };
                tree.search(ends[own as usize], &mut nearest);
                for (_, end) in nearest.found {
                    if neighbours.list[from..].iter().all(|known| known.0 != end) {
                        neighbours.list.push((end, travel(own, end)));
                    }
                }
            }
            neighbours.list[from..].sort_by(cheapest_first);

            neighbours.first.push(neighbours.list.len() as u32);
        }
        neighbours
    }

    /// What the cheapest travel from an end costs; nothing where it has no neighbours.
    pub(super) fn cheapest(&self, end: u32) -> f64 {
        self.of(end).first().map_or(0.0, |&(_, cost)| cost)
    }

    /// Takes its share off each end's costs.
    pub(super) fn discount(&mut self, shares: &[f64]) {
        for end in 0..shares.len() as u32 {
            let range = self.range(end);
            let list = &mut self.list[range];
            list.iter_mut().for_each(|(to, cost)| *cost = discounted(*cost, shares, [end, *to]));
            list.sort_by(cheapest_first);
        }
    }

    /// Those of one end.
    pub(super) fn of(&self, end: u32) -> &[(u32, f64)] {
        &self.list[self.range(end)]
    }

    fn range(&self, end: u32) -> Range<usize> {
        self.first[end as usize] as usize..self.first[end as usize + 1] as usize
    }
}

/// A travel's cost without the shares of its ends. Rounded in one way only, whichever end comes first: an exchange and its
/// opposite must not both look like a gain.
pub(super) fn discounted(cost: f64, shares: &[f64], [a, b]: [u32; 2]) -> f64 {
    cost - (shares[a.min(b) as usize] + shares[a.max(b) as usize])
}

fn cheapest_first(a: &(u32, f64), b: &(u32, f64)) -> Ordering {
    a.1.total_cmp(&b.1).then(a.0.cmp(&b.0))
}

/// The nearest ends of other strokes, in one quadrant around an end or all around it.
struct NearestEnds<'a> {
    own: u32,
    nowhere: u32,
    ends: &'a [Point],
    quadrant: Option<usize>,
    most: usize,
    found: Vec<(f64, u32)>,
}

impl NearestEnds<'_> {
    /// Squared distance from which on an end is none of the nearest.
    fn reach_sq(&self) -> f64 {
        match self.found.len() < self.most {
            true => f64::INFINITY,
            false => self.found[self.most - 1].0,
        }
    }

    /// Whether a box holds nothing of the quadrant.
    fn misses(&self, bounds: &Rect) -> bool {
        let at = self.ends[self.own as usize];
        self.quadrant.is_some_and(|quadrant| {
            let beside = if quadrant & 1 == 0 { bounds.x1 < at.x } else { bounds.x0 >= at.x };
            let beyond = if quadrant & 2 == 0 { bounds.y1 < at.y } else { bounds.y0 >= at.y };
            beside || beyond
        })
    }

    fn is_in_quadrant(&self, end: u32) -> bool {
        let (own, point) = (self.ends[self.own as usize], self.ends[end as usize]);
        let quadrant = usize::from(point.x < own.x) + 2 * usize::from(point.y < own.y);
        self.quadrant.is_none_or(|wanted| wanted == quadrant)
    }
}

impl Gather for NearestEnds<'_> {
    fn wants(&self, _: usize, bounds: &Rect, distance_sq: f64) -> bool {
        // asked this way round, a point that is not a number is still found
        let too_far = distance_sq >= self.reach_sq();
        !too_far && !self.misses(bounds)
    }

    fn offer(&mut self, end: u32, distance_sq: f64) {
        let stranger = end >> 1 != self.own >> 1 && end != self.nowhere;
        if !(stranger && distance_sq < self.reach_sq() && self.is_in_quadrant(end)) {
            return;
        }
        let at = self.found.partition_point(|&known| known < (distance_sq, end));
        self.found.insert(at, (distance_sq, end));
        self.found.truncate(self.most);
    }
}
