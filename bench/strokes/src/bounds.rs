//! How far the rules go: for plain drawings, and for kinds that are made of what plain drawings must not have.

/// Widest corner, degrees: a wider one may be a curve.
pub const WIDEST_CORNER_DEG: f64 = 150.0;

/// How far the rules go for a kind of figures.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Least angle between lines that cross or meet, and within a corner, degrees.
    pub angle_deg: f64,
    /// Two nodes are at least this many pens apart.
    pub node_pens: f64,
    /// Least radius of a curve, pens.
    pub radius_pens: f64,
    /// Shortest stroke, pens and px.
    pub shortest: (f64, f64),
    /// What an end points at is further away than this, pens: nearer may be a gap.
    pub ahead_pens: f64,
    /// Whether lines that run alongside are too near.
    pub alongside: bool,
}

impl Bounds {
    /// For plain drawings.
    pub const USUAL: Self = Self {
        angle_deg: 30.0,
        node_pens: 4.0,
        radius_pens: 2.0,
        shortest: (8.0, 12.0),
        ahead_pens: 3.0,
        alongside: true,
    };
    /// For writing and marks: letters are small for their pen.
    pub const SMALL: Self =
        Self { node_pens: 1.5, radius_pens: 1.0, shortest: (2.5, 4.0), ahead_pens: 1.5, ..Self::USUAL };
    /// For hairpins, hair and shallow crossings.
    pub const SHARP: Self =
        Self { angle_deg: 2.9, node_pens: 0.0, radius_pens: 0.0, alongside: false, ..Self::USUAL };
    /// For hatching, whose lines end where others lie.
    pub const HATCHED: Self = Self { node_pens: 2.8, ahead_pens: 1.5, ..Self::USUAL };
    /// For signs, whose sides are short for their pen.
    pub const SHORT: Self = Self {
        node_pens: 1.8,
        radius_pens: 1.5,
        shortest: (2.5, 8.0),
        ahead_pens: 1.0,
        alongside: false,
        ..Self::USUAL
    };
    /// For small filled shapes, whose tips are as sharp as they like.
    pub const FILLED: Self = Self { shortest: (6.0, 12.0), ..Self::SHARP };
}
