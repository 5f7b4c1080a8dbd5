//! Where a plan lies on its picture.

use tracelight_stroke::{Point, Rect};
use tracelight_trajectory::Plan;

/// The longer side of the drawing in the picture's own units, and the room around it and for the legend below.
const SIDE: f64 = 1000.0;
pub(super) const MARGIN: f64 = 40.0;

/// From target metres to the picture, y down.
pub(super) struct Frame {
    corner: Point,
    /// Units a metre.
    pub(super) scale: f64,
    pub(super) size: (f64, f64),
}

impl Frame {
    pub(super) fn around(plan: &Plan) -> Self {
        let lit = plan.points.iter().filter(|p| p.lit).map(|p| p.spot);
        let all = lit.fold(None, |all: Option<Rect>, p| {
            Some(all.map_or(Rect::from_points(p, p), |all| all.union_pt(p)))
        });
        let all = all.unwrap_or(Rect::ZERO);
        let scale = SIDE / all.width().max(all.height()).max(1e-3);
        Self {
            corner: Point::new(all.x0, all.y1),
            scale,
            size: (scale * all.width(), (scale * all.height()).max(1.0)),
        }
    }

    pub(super) fn at(&self, p: Point) -> (f64, f64) {
        (MARGIN + self.scale * (p.x - self.corner.x), MARGIN + self.scale * (self.corner.y - p.y))
    }
}
