//! The paper that drawing programs put behind everything.

use tracelight_stroke::{Element, Path, Rect};

use super::seen::is_whitish;
use super::seen::scene::Item;

/// Share of the page's width and height that paper may leave free at an edge.
const SLACK: f64 = 0.005;

/// Whether a fill, painted first, is paper: an upright rectangle over the whole page, white or nearly so, and opaque.
pub(super) fn is_paper(item: &Item, page: Rect) -> bool {
    let slack = SLACK * (page.width() + page.height());
    let bounds = item.shape.bounds();
    let covers = bounds.x0 <= page.x0 + slack
        && bounds.y0 <= page.y0 + slack
        && bounds.x1 >= page.x1 - slack
        && bounds.y1 >= page.y1 - slack;
    covers
        && item.opacity >= 1.0
        && item.veil.is_none()
        && is_whitish(&item.ink)
        && matches!(item.shape.lines().as_slice(), [outline] if is_upright(outline, 1e-3 * slack))
}

/// Whether a path is four sides, each along an axis.
fn is_upright(path: &Path, within: f64) -> bool {
    let is_side = |piece: tracelight_stroke::Piece| match piece.element {
        Element::Line { to } => {
            (to.x - piece.from.x).abs() <= within || (to.y - piece.from.y).abs() <= within
        }
        _ => false,
    };
    path.is_closed() && path.elements().len() == 4 && path.pieces().all(is_side)
}
