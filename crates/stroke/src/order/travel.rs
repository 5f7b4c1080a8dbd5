use kurbo::{Point, Vec2};

use crate::Path;

/// What a travel in the dark costs: metres, seconds, anything that is never below zero.
///
/// Any function of two points is one; one that minds where a stroke leads may look at [`StrokeEnd::outward`]. A cost that has to compute something for each of them does so once, in
/// [`place`](Self::place): a search asks for the cost of millions of travels between a few thousand places.
pub trait Travel {
    /// All that the cost has to know of an end.
    type Place;

    /// Whether a cost takes so long to compute that a search had better remember it: longer than to look something up.
    const IS_DEAR: bool = false;

    /// Where a stroke may be entered or left.
    fn place(&self, end: StrokeEnd) -> Self::Place;

    /// Ends for which these points are near each other are cheap to travel between: where a search looks first.
    fn about(&self, end: StrokeEnd) -> Point {
        end.point
    }

    /// From the end by which a stroke is left to the end by which another is entered.
    fn cost(&self, from: &Self::Place, to: &Self::Place) -> f64;
}

/// A point where a stroke may be entered or left, and the stroke's direction there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeEnd {
    /// Place.
    pub point: Point,
    /// Unit vector out of the stroke: who leaves goes this way, who enters comes from there. Zero where none is known:
    /// on a closed stroke and at the start of all.
    pub outward: Vec2,
}

impl StrokeEnd {
    /// A place without a direction.
    pub const fn resting(point: Point) -> Self {
        Self { point, outward: Vec2::ZERO }
    }

    /// Both ends of a path: its start and its end.
    pub fn of(path: &Path) -> [Self; 2] {
        let [start, end] = [path.start(), path.end()].map(Self::resting);
        if path.is_closed() {
            return [start, end];
        }
        let out_of_start = path.pieces().next().map_or(Vec2::ZERO, |piece| -piece.start_tangent());
        let out_of_end = path.pieces().last().map_or(Vec2::ZERO, |piece| piece.end_tangent());
        [Self { outward: out_of_start, ..start }, Self { outward: out_of_end, ..end }]
    }
}

impl<F: Fn(Point, Point) -> f64> Travel for F {
    type Place = Point;

    fn place(&self, end: StrokeEnd) -> Point {
        end.point
    }

    fn cost(&self, &from: &Point, &to: &Point) -> f64 {
        self(from, to)
    }
}
