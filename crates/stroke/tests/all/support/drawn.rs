//! Figures of lines and arcs that pass into each other, and what is asked of those found.

use tracelight_maths::planar;
use tracelight_stroke::{Element, Path, Point, Vec2};

/// What was drawn: a line's length, or an arc's radius and sweep in degrees (positive turns x towards y).
#[derive(Clone, Copy, Debug)]
pub(crate) enum Drawn {
    Line(f64),
    Arc(f64, f64),
}

/// Draws one after the other, from a place in a direction.
pub(crate) fn path(start: Point, angle_rad: f64, drawn: &[Drawn], closed: bool) -> Path {
    let mut path = Path::new(start);
    let mut along = planar::direction(angle_rad);
    for d in drawn {
        match *d {
            Drawn::Line(length) => path.line_to(path.end() + along * length),
            Drawn::Arc(radius, degrees) => {
                let sweep = degrees.to_radians();
                let centre = path.end() + along.turn_90() * radius.copysign(sweep);
                path.push(Element::Arc { centre, sweep });
                along = planar::direction(planar::heading(along) + sweep);
            }
        }
    }
    if closed {
        path.close();
    }
    path
}

/// The kinds of what was drawn, as [`kinds`] tells them of a path.
pub(crate) fn kinds_drawn(drawn: &[Drawn]) -> String {
    drawn.iter().map(|d| if matches!(d, Drawn::Line(_)) { 'L' } else { 'A' }).collect()
}

/// L, A and C of a path's elements.
pub(crate) fn kinds(path: &Path) -> String {
    let kind = |e: &Element| match e {
        Element::Line { .. } => 'L',
        Element::Arc { .. } => 'A',
        Element::Cubic { .. } => 'C',
    };
    path.elements().iter().map(kind).collect()
}

/// Greatest break of direction between neighbours, degrees.
pub(crate) fn kink(path: &Path) -> f64 {
    let pieces: Vec<_> = path.pieces().collect();
    let next = pieces.iter().skip(1).chain(pieces.first().filter(|_| path.is_closed()));
    let turn = |a: Vec2, b: Vec2| a.cross(b).atan2(a.dot(b)).abs().to_degrees();
    pieces.iter().zip(next).map(|(a, b)| turn(a.end_tangent(), b.start_tangent())).fold(0.0, f64::max)
}
