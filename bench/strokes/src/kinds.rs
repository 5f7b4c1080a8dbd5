//! The kinds of figures. Each is drawn about the origin, about `hand.size` to either side, and may break the rules:
//! who places it asks [`rules`](crate::rules) and draws another one if so.

mod crossing;
mod filled;
mod junction;
mod looped;
mod parallel;
mod plain;
mod tangent;

use clap::ValueEnum;

use crate::{Figure, Hand, Random};

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum Kind {
    /// Straight lines.
    Lines,
    /// Straight lines with corners.
    Polylines,
    /// Circular arcs.
    Arcs,
    /// Free curves.
    Splines,
    /// Circles, ellipses, polygons, stars, smooth closed curves.
    Closed,
    /// Lines and curves across each other.
    Crossings,
    /// T and Y junctions, combs, ladders, block letters.
    Junctions,
    /// Lines, arcs and figures side by side, down to 3 px of paper.
    Parallels,
    /// Lines and arcs end to end: hooks, slots, S curves.
    Tangents,
    /// Handwriting's loops, figure eights, spirals.
    Loops,
    /// Filled shapes, with holes and with sticks.
    Filled,
    /// Lines with gaps up to a pen's width.
    Gaps,
    /// A page of everything.
    Mixed,
}

impl Kind {
    /// All of them.
    pub fn all() -> &'static [Self] {
        Self::value_variants()
    }

    /// As it is typed.
    pub fn name(self) -> String {
        self.to_possible_value().map(|v| v.get_name().to_owned()).unwrap_or_default()
    }

    /// Figures of a page, fewest and most.
    pub(crate) fn figures(self) -> (usize, usize) {
        match self {
            Kind::Lines | Kind::Arcs => (1, 10),
            Kind::Polylines | Kind::Splines | Kind::Closed | Kind::Gaps => (1, 7),
            Kind::Crossings | Kind::Junctions | Kind::Tangents | Kind::Loops | Kind::Filled => (1, 5),
            Kind::Parallels => (1, 3),
            Kind::Mixed => (5, 16),
        }
    }

    /// One figure about the origin. It may break the rules; who places it asks.
    pub fn figure(self, random: &mut Random, hand: &Hand) -> Figure {
        match self {
            Kind::Lines => plain::straight(random, hand),
            Kind::Polylines => plain::cornered(random, hand),
            Kind::Arcs => plain::bent(random, hand),
            Kind::Splines => plain::free(random, hand),
            Kind::Closed => plain::closed(random, hand),
            Kind::Crossings => crossing::figure(random, hand),
            Kind::Junctions => junction::figure(random, hand),
            Kind::Parallels => parallel::figure(random, hand),
            Kind::Tangents => tangent::figure(random, hand),
            Kind::Loops => looped::figure(random, hand),
            Kind::Filled => filled::figure(random, hand),
            Kind::Gaps => plain::gapped(random, hand),
            Kind::Mixed => {
                let last = Self::all().len() - 2;
                Self::all()[random.whole(0, last)].figure(random, hand)
            }
        }
    }
}
