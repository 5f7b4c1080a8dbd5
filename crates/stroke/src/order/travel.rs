use kurbo::Point;

/// What a travel in the dark costs: metres, seconds, anything that is never below zero.
///
/// Any function of two points is one. A cost that has to compute something for each of them does so once, in
/// [`place`](Self::place): a search asks for the cost of millions of travels between a few thousand places.
pub trait Travel {
    /// All that the cost has to know of a point.
    type Place: Copy;

    /// A point where a stroke may be entered or left.
    fn place(&self, at: Point) -> Self::Place;

    /// From one to another.
    fn cost(&self, from: Self::Place, to: Self::Place) -> f64;
}

impl<F: Fn(Point, Point) -> f64> Travel for F {
    type Place = Point;

    fn place(&self, at: Point) -> Point {
        at
    }

    fn cost(&self, from: Point, to: Point) -> f64 {
        self(from, to)
    }
}
