//! Paints of the resolved tree: colours, and whether they hide what is below.

use tracelight_stroke::Colour;
use usvg::filter::{Input, Kind};

use super::seen::scene::Ink;

/// Opacity from which on nothing shines through.
const OPAQUE: f32 = 0.98;

/// The colour of a paint that has one.
pub(super) const fn colour_of(paint: &usvg::Paint) -> Option<Colour> {
    match paint {
        usvg::Paint::Color(c) => Some(Colour::new(c.red, c.green, c.blue)),
        _ => None,
    }
}

/// A paint as an ink: a gradient of one colour is that colour.
pub(super) fn ink_of(paint: &usvg::Paint) -> Ink {
    match paint {
        usvg::Paint::Color(c) => Ink::Plain(Colour::new(c.red, c.green, c.blue)),
        usvg::Paint::LinearGradient(gradient) => gradient_ink(gradient.stops()),
        usvg::Paint::RadialGradient(gradient) => gradient_ink(gradient.stops()),
        usvg::Paint::Pattern(pattern) => Ink::Mixed { hides: is_full(pattern) },
    }
}

fn gradient_ink(stops: &[usvg::Stop]) -> Ink {
    let hides = stops.iter().all(|stop| stop.opacity().get() >= OPAQUE);
    let colours = stops.iter().map(usvg::Stop::color);
    let one = stops
        .first()
        .map(usvg::Stop::color)
        .filter(|&first| hides && colours.into_iter().all(|c| c == first));
    one.map_or(Ink::Mixed { hides }, |c| Ink::Plain(Colour::new(c.red, c.green, c.blue)))
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
