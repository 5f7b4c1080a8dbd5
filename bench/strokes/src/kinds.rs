//! The kinds of figures. Each is drawn about the origin, about `hand.size` to either side, and may break the rules:
//! who places it asks [`rules`](crate::rules) and draws another one if so.

mod coloured;
mod connected;
mod crossing;
mod felt;
mod filled;
mod frame;
mod hair;
mod hairpin;
mod hatched;
mod junction;
mod looped;
mod parallel;
mod places;
mod plain;
mod retouched;
mod shallow;
mod sign;
mod silhouette;
pub(crate) mod sketched;
mod spot;
mod swelling;
mod tangent;
mod writing;

use clap::ValueEnum;

pub(crate) use frame::frame;

use crate::{Figure, Hand, Random, Set};

/// Kinds of the plain set that are all lines, without gaps.
const LINES: [Kind; 9] = [
    Kind::Lines,
    Kind::Polylines,
    Kind::Arcs,
    Kind::Splines,
    Kind::Closed,
    Kind::Crossings,
    Kind::Junctions,
    Kind::Tangents,
    Kind::Loops,
];
/// What is drawn large with a thick pen.
const THICK: [Kind; 6] =
    [Kind::Polylines, Kind::Arcs, Kind::Splines, Kind::Closed, Kind::Closed, Kind::Tangents];

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
    /// Lines that swell with pressure.
    Swell,
    /// Brushes: lines that taper to their ends.
    Brush,
    /// Broad nibs: the width depends on the direction.
    Nib,
    /// Lines that pale along the way.
    Fading,
    /// A pencil on grain, its pressure changing.
    Graphite,
    /// Crayon, chalk, a soft pencil or a dry felt pen from near: pens of ten px and more with ragged edges.
    Crayon,
    /// Felt pen: thick, darker where it goes twice, areas filled to and fro.
    Felt,
    /// Lines gone over again, in full or in part, and rings whose ends overlap.
    Retouched,
    /// A pencil sketch: each line drawn in up to three passes beside each other, paper between them or not.
    Sketched,
    /// Lines side by side that stay lines.
    Hatching,
    /// Writing of 6 to 30 px beside a large figure.
    Writing,
    /// Dashes, rings, ticks and crosses of 5 to 14 px beside a large figure.
    Marks,
    /// V and U turns whose wedge closes before the turn, leaves, a third line between two.
    Hairpin,
    /// Tufts and strands of tapering lines.
    Hair,
    /// Crossings at 3 to 15°, curves that touch and run together for a while.
    Shallow,
    /// Small filled shapes: ovals, crescents, drops, suns with rays, faces.
    Spots,
    /// What is cut out of black paper: animals with limbs, bottles, keys, leaves; white on black now and then, without a shade.
    Silhouette,
    /// A frame along the picture's border, whole or half cut off by it.
    Frame,
    /// One figure in a thick pen.
    Thick,
    /// Ruled paper of any darkness.
    Ruled,
    /// Squared paper of any darkness.
    Squared,
    /// Dotted paper of any darkness.
    Dotted,
    /// A sheet on a table, seen aside, with shadows, a finger, another sheet.
    Table,
    /// Arrows, grids, ladders, snowflakes, wheels, firs and crowns, in thin pens and fat ones.
    Signs,
    /// A ballpoint from near: the middle of its lines shines, or is bare.
    Ballpoint,
    /// Closed figures coloured in paler than the lines on and about them.
    Coloured,
}

impl Kind {
    /// Those of a set.
    pub fn of(set: Set) -> &'static [Self] {
        let (plain, world) = Self::value_variants().split_at(Self::Mixed as usize + 1);
        match set {
            Set::Plain => plain,
            Set::World => world,
        }
    }

    /// The set that it is of.
    pub fn set(self) -> Set {
        if self <= Self::Mixed { Set::Plain } else { Set::World }
    }

    /// As it is typed.
    pub fn name(self) -> String {
        self.to_possible_value().map(|v| v.get_name().to_owned()).unwrap_or_default()
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
                let plain = Self::of(Set::Plain);
                plain[random.whole(0, plain.len() - 2)].figure(random, hand)
            }
            Kind::Swell => swelling::swell(random, hand),
            Kind::Brush => swelling::brush(random, hand),
            Kind::Nib => swelling::nib(random, hand),
            Kind::Fading => swelling::fading(random, hand),
            Kind::Graphite | Kind::Crayon => swelling::pencil(random, hand),
            Kind::Felt => felt::figure(random, hand),
            Kind::Retouched => retouched::figure(random, hand),
            Kind::Sketched => sketched::figure(random, hand),
            Kind::Hatching => hatched::figure(random, hand),
            Kind::Writing => writing::words(random, hand),
            Kind::Marks => writing::marks(random, hand),
            Kind::Hairpin => hairpin::figure(random, hand),
            Kind::Hair => hair::figure(random, hand),
            Kind::Shallow => shallow::figure(random, hand),
            Kind::Spots => spot::figure(random, hand),
            Kind::Silhouette => silhouette::figure(random, hand),
            Kind::Signs => sign::figure(random, hand),
            Kind::Coloured => coloured::figure(random, hand),
            Kind::Thick => random.pick(&THICK).figure(random, hand),
            Kind::Ruled | Kind::Squared | Kind::Dotted if random.chance(0.25) => writing::words(random, hand),
            Kind::Frame | Kind::Ruled | Kind::Squared | Kind::Dotted | Kind::Table | Kind::Ballpoint => {
                lines(random, hand)
            }
        }
    }
}

/// Lines without gaps, of a plain kind or a drawing of one piece.
fn lines(random: &mut Random, hand: &Hand) -> Figure {
    if random.chance(0.5) {
        return connected::figure(random, hand);
    }
    random.pick(&LINES).figure(random, hand)
}
