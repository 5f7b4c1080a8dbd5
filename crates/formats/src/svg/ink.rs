//! Paints of the resolved tree: colours, and whether they hide what is below.

use std::rc::Rc;

use kurbo::Affine;
use tracelight_stroke::{Colour, Point};
use usvg::filter::{Input, Kind};

use super::seen::Rgb;
use super::seen::gradient::{Along, Gradient, Spread};
use super::seen::scene::Ink;
use super::shape::affine;

/// Opacity from which on nothing shines through.
const OPAQUE: f32 = 0.98;

/// The colour of a paint that has one.
pub(super) const fn colour_of(paint: &usvg::Paint) -> Option<Colour> {
    match paint {
        usvg::Paint::Color(c) => Some(Colour::new(c.red, c.green, c.blue)),
        _ => None,
    }
}

/// A paint as an ink; `at` moves the path that it paints to the sheet.
pub(super) fn ink_of(paint: &usvg::Paint, at: Affine) -> Ink {
    match paint {
        usvg::Paint::Color(c) => Ink::Plain(Colour::new(c.red, c.green, c.blue)),
        usvg::Paint::LinearGradient(found) => {
            let along = Along::Line([point(found.x1(), found.y1()), point(found.x2(), found.y2())]);
            gradient(found, along, at)
        }
        usvg::Paint::RadialGradient(found) => {
            let (focus, centre) = (point(found.fx(), found.fy()), point(found.cx(), found.cy()));
            gradient(found, Along::Circle { focus, centre, radius: f64::from(found.r().get()) }, at)
        }
        usvg::Paint::Pattern(pattern) => Ink::Mixed { hides: is_full(pattern) },
    }
}

fn point(x: f32, y: f32) -> Point {
    Point::new(f64::from(x), f64::from(y))
}

/// A gradient; where it has one colour throughout, or no place to change it, that colour.
fn gradient(found: &usvg::BaseGradient, along: Along, at: Affine) -> Ink {
    let colour = |stop: &usvg::Stop| Colour::new(stop.color().red, stop.color().green, stop.color().blue);
    let stop = |stop: &usvg::Stop| {
        (f64::from(stop.offset().get()), Rgb::from(colour(stop)), f64::from(stop.opacity().get()))
    };
    let hides = found.stops().iter().all(|stop| stop.opacity().get() >= OPAQUE);
    let own = at * affine(found.transform());
    match found.stops() {
        [first, rest @ ..] if hides && rest.iter().all(|stop| stop.color() == first.color()) => {
            Ink::Plain(colour(first))
        }
        _ if own.determinant() == 0.0 => Ink::Mixed { hides },
        stops => Ink::Gradient(Rc::new(Gradient {
            own: own.inverse(),
            along,
            spread: match found.spread_method() {
                usvg::SpreadMethod::Pad => Spread::Pad,
                usvg::SpreadMethod::Reflect => Spread::Reflect,
                usvg::SpreadMethod::Repeat => Spread::Repeat,
            },
            stops: stops.iter().map(stop).collect(),
        })),
    }
}

/// Whether a gradient changes at once from one look to another somewhere inside: an edge that nothing here draws.
pub(super) fn has_hard_stops(paint: &usvg::Paint) -> bool {
    let stops = match paint {
        usvg::Paint::LinearGradient(found) => found.stops(),
        usvg::Paint::RadialGradient(found) => found.stops(),
        usvg::Paint::Color(_) | usvg::Paint::Pattern(_) => return false,
    };
    // stops that share an offset are told apart by whoever resolves the file as little as single precision can
    const ONE: f32 = 1e-5;
    let inside: Vec<_> =
        stops.iter().filter(|stop| (ONE..1.0 - ONE).contains(&stop.offset().get())).collect();
    inside.chunk_by(|a, b| (b.offset().get() - a.offset().get()).abs() <= ONE).any(|at_once| {
        let (first, last) = (at_once[0], at_once[at_once.len() - 1]);
        let look = |stop: &usvg::Stop| (stop.color(), stop.opacity().get().to_bits());
        look(first) != look(last)
    })
}

/// Whether a pattern's own picture begins with something opaque that fills its tile.
fn is_full(pattern: &usvg::Pattern) -> bool {
    let rect = pattern.rect();
    let slack = 0.01 * (rect.width() + rect.height());
    let Some(usvg::Node::Path(path)) = pattern.root().children().first() else { return false };
    let bounds = path.bounding_box();
    let is_opaque = path.fill().is_some_and(|fill| fill.opacity().get() >= OPAQUE);
    is_opaque
        && path.data().len() <= 6
        && bounds.left() <= rect.left() + slack
        && bounds.top() <= rect.top() + slack
        && bounds.right() >= rect.right() - slack
        && bounds.bottom() >= rect.bottom() - slack
}

/// Whether filters leave what they are given where it is and only add to it, as a shadow does.
pub(super) fn adds_only(group: &usvg::Group) -> bool {
    let adds = |filter: &usvg::filter::Filter| {
        filter.primitives().last().is_some_and(|last| match last.kind() {
            Kind::Blend(_) | Kind::Composite(_) | Kind::Merge(_) => {
                last.kind().has_input(&Input::SourceGraphic)
            }
            _ => false,
        })
    };
    group.filters().iter().all(|filter| adds(filter))
}
