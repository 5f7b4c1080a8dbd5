use tracelight_stroke::Point;

use crate::shapes::polyline;
use crate::{Figure, Ink, Nib, Random, Size};

/// Least of a frame that is seen where the picture cuts it, px and share of its pen.
const LEAST_SEEN_PX: f64 = 1.5;
const LEAST_SEEN: f64 = 0.6;

/// A frame along the picture's border: some px inside, or cut lengthwise by it. The truth is the middle of what is seen.
pub(crate) fn frame(random: &mut Random, size: Size, page_pen: f64) -> Figure {
    let pen = page_pen * random.between(0.7, 1.5);
    let rows = size.height as f64;
    let (seen, inset) = if random.chance(0.5) {
        let seen = random.between((LEAST_SEEN * pen).max(LEAST_SEEN_PX).min(pen), pen);
        (seen, seen - 0.5 * pen)
    } else {
        (pen, 0.5 * pen + random.between(0.0, (0.03 * rows).max(3.0)))
    };
    let at = |inset: f64| {
        let (w, h) = (size.width as f64 - inset, size.height as f64 - inset);
        polyline(&[(inset, inset), (w, inset), (w, h), (inset, h)].map(Point::from), true)
    };
    let truth = at(inset + 0.5 * (pen - seen));
    Figure::stroke(truth, seen, [Ink::Line { path: at(inset), pen, nib: Nib::Round }])
}
