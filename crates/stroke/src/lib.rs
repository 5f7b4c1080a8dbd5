//! Plane geometry of drawings.
//!
//! A [`Drawing`] is strokes in drawing order; a [`Stroke`] is a [`Path`] drawn lit; a path is lines, circular arcs
//! and cubic curves. The crate knows lengths and directions in *some* plane unit. It knows nothing of pixels, of
//! angles of a head, or of time: the unit of every length here is whatever unit the caller's points have.
//!
//! Points and vectors are [`kurbo`]'s: differences of points are vectors, and adding two points does not compile.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod colour;
mod compare;
mod doubles;
mod extent;
mod fit;
mod order;
mod parts;
mod path;
mod places;
mod polyline;
mod simplify;
mod stroke;

pub use colour::Colour;
pub use compare::{Comparison, Score, compare, compare_polylines, score, score_polylines};
pub use doubles::{Doubles, Split, doubles, without_doubles};
pub use extent::{extent, extent_of};
pub use fit::{FitOptions, Parabola, fit};
pub use kurbo::{Affine, Point, Rect, Vec2};
pub use order::{
    Effort, OrderOptions, Ordered, StrokeEnd, Travel, by_layer, least_cost, order, order_by_layer,
    reading_order,
};
pub use parts::{Measured, Span, parts};
pub use path::{Element, Path, PathPoint, Piece, turn_rad};
pub use places::{Place, PlaceKind, places, places_apart};
pub use polyline::polyline_length;
pub use simplify::{distance_to_segment, simplify};
pub use stroke::{Drawing, Entity, Stroke, StrokeKind};

/// The examples of `README.md`, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
