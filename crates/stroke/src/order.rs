//! Chooses the order of strokes, their directions, and the start of closed ones.
//!
//! The dark way between strokes is an open travelling-salesman path over strokes that may be drawn from either end
//! (a rural postman's problem in general, NP-hard). Here: nearest neighbour, then exchanges of two and three travels
//! over neighbour lists until none helps, then seeded local kicks, each kept when it loses little or nothing, less and
//! less with time, and all of them only when they gain together (iterated local search, after
//! Johnson & McGeoch, "The traveling salesman problem: a case study in local optimization", 1997).

mod ascent;
mod bound;
mod exchange;
mod followed;
mod forest;
mod greedy;
mod kdtree;
mod memo;
mod neighbours;
mod ports;
mod route;
mod search;
mod tour;
mod travel;

use kurbo::Point;

use crate::Drawing;
pub use followed::{by_layer, order_by_layer, reading_order};
use ports::Ports;
use route::Route;
pub use travel::{StrokeEnd, Travel};

/// How much work goes into an order: an amount, not a time, so that equal inputs give equal orders on any machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Effort {
    /// The first order that no single move improves.
    Quick,
    /// Local kicks on top: about a second for 5000 strokes.
    #[default]
    Normal,
    /// Ten times as many kicks.
    Best,
}

impl Effort {
    /// Rounds of ascent for the bound; a share of them where ports are very many.
    fn rounds(self, ports: usize) -> usize {
        let rounds = match self {
            Effort::Quick => 15,
            Effort::Normal => 60,
            Effort::Best => 200,
        };
        if ports <= MANY_PORTS { rounds } else { rounds * MANY_PORTS / ports }
    }

    /// Kicks for a region of so many of all strokes.
    fn kicks(self, region: usize, strokes: usize, is_dear: bool) -> usize {
        let each = if is_dear { DEAR_KICKS_EACH } else { KICKS_EACH };
        let normal = (each * strokes).min(MOST_KICKS);
        let all = match self {
            Effort::Quick => 0,
            Effort::Normal => normal,
            Effort::Best => 10 * normal,
        };
        // u128: on a 32-bit machine too the product of two counts fits
        (all as u128 * region as u128 / strokes.max(1) as u128) as usize
    }
}

/// Kicks a stroke: where the curve of gain over work bends. Of the 4 % that kicks gain on 5000 random strokes, ten
/// times as many add 0.4 %.
const KICKS_EACH: usize = 18;

/// Kicks a stroke if the cost is expensive to evaluate: about a second of work. Ten times as many gain another 2 to 3 %.
const DEAR_KICKS_EACH: usize = 8;

/// Up to so many ports the bound gets all its rounds.
const MANY_PORTS: usize = 50_000;

/// Kicks in all, which bounds the time on endless drawings: 5 a stroke of 20 000.
const MOST_KICKS: usize = 100_000;

/// Times that all regions are kicked and the starts of closed strokes chosen anew. Two, for the borders of the
/// regions lie elsewhere the second time.
const ROUNDS: usize = 2;

/// How to search for an order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct OrderOptions {
    /// How much work.
    pub effort: Effort,
    /// Seed of the kicks: equal seeds, equal orders.
    pub seed: u64,
}

/// A drawing in its new order.
#[derive(Clone, Debug, PartialEq)]
pub struct Ordered {
    /// The strokes in the order, direction and from the start points that were found.
    pub drawing: Drawing,
    /// Sum of the handed-in cost over the travels, in its unit.
    pub cost: f64,
    /// Straight travel from the start through every stroke, plane units.
    pub travel: f64,
    /// No order whatever travels less than this, plane units. Valid, rarely tight.
    pub lower_bound: f64,
}

impl Ordered {
    /// How far [`travel`](Self::travel) may be above the best order's, % of the lower bound; zero where nothing is
    /// left to gain, `None` where the bound is zero and the travel is not.
    pub fn gap_percent(&self) -> Option<f64> {
        let excess = self.travel - self.lower_bound;
        match self.lower_bound > 0.0 {
            true => Some(100.0 * excess / self.lower_bound),
            false => (excess <= 0.0).then_some(0.0),
        }
    }
}

/// Puts a drawing's strokes in an order with little travel, starting at `start`, ending anywhere.
///
/// Open strokes may be reversed. A closed stroke may begin at any joint of its elements; at its corners only, if it
/// has any, because a spot that starts and stops in a corner shows least. `cost` of a travel from one point to
/// another is in any unit; where it is not symmetric, one direction stands for both during the search and
/// [`Ordered::cost`] is summed the way the strokes are drawn.
pub fn order<C: Travel>(drawing: &Drawing, start: Point, options: OrderOptions, cost: &C) -> Ordered {
    let ports = Ports::of(drawing);
    let mut route = Route { stops: greedy::nearest_neighbour(&ports, start), ports: &ports, start, cost };
    for round in 0..ROUNDS {
        route.settle();
        for region in route.regions(round) {
            let kicks = options.effort.kicks(region.len(), drawing.strokes.len(), C::IS_DEAR) / ROUNDS;
            route.kick_region(&region, kicks, options.seed.wrapping_add(round as u64));
        }
        route.choose_joints();
    }
    route.settle();
    let drawing = Drawing { strokes: route.stops.iter().map(|stop| stop.drawn(drawing, &ports)).collect() };
    Ordered {
        cost: travel_cost(&drawing, start, cost),
        travel: drawing.travel(start),
        lower_bound: bound::lower_bound(&ports, start, options.effort.rounds(ports.points.len()))
            .min(drawing.travel(start)),
        drawing,
    }
}

/// What the travels of any order cost at least, in the unit of `cost`: each end of a stroke has one travel, and half of that
/// is no less than half of the cheapest to any end near it. Takes a small part of what [`order`] does.
///
/// As valid as what lies near an end is cheap: the ends looked at are those that [`order`] looks at. Of closed strokes the
/// joint that the nearest-neighbour order enters stands for all.
pub fn least_cost<C: Travel>(drawing: &Drawing, start: Point, cost: &C) -> f64 {
    let ports = Ports::of(drawing);
    let stops = greedy::nearest_neighbour(&ports, start);
    Route { stops, ports: &ports, start, cost }.least_cost()
}

fn travel_cost(drawing: &Drawing, start: Point, cost: &impl Travel) -> f64 {
    let mut at = StrokeEnd::resting(start);
    let mut sum = 0.0;
    for stroke in &drawing.strokes {
        let [entry, exit] = StrokeEnd::of(&stroke.path);
        sum += cost.cost(&cost.place(at), &cost.place(entry));
        at = exit;
    }
    sum
}

#[cfg(test)]
mod tests;
