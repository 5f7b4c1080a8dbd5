//! A shadow's straight edge across a sheet: what is in it is darker by the same share, on the paper and beside it.

use tracelight_image::Plane;
use tracelight_stroke::{Point, Vec2};

use crate::sides::Side;
use crate::small::BESIDE;

/// What a shadow lets through of the light.
const SHADE: std::ops::Range<f64> = 0.35..0.88;
/// Half of its share at different places is within this factor.
const SAME: f64 = 1.2;
/// An edge lies so far inside a sheet somewhere, else it is its side, px.
const LEAST_DEPTH: f64 = 8.0;
/// Places along it at which its share is taken.
const PLACES: usize = 48;

/// The edge of a shadow that may be.
#[derive(Clone, Debug)]
pub(crate) struct Shade {
    side: Side,
    is_upright: bool,
    /// A place on the edge, and the way into the shadow.
    on: Point,
    into: Vec2,
    /// Of the light.
    share: f64,
}

impl Shade {
    /// Whether a side may be a shadow's edge: as much darker on one side all along.
    pub(crate) fn of(calm: &Plane<u8>, side: &Side, is_upright: bool) -> Option<Self> {
        let most = if is_upright { calm.height } else { calm.width };
        let (first, last) = (side.place(is_upright, 0.0), side.place(is_upright, most as f64));
        let aside = (last - first).turn_90() / (last - first).hypot();
        let ratio = |k: usize| {
            let row = (k as f64 + 0.5) * most as f64 / PLACES as f64;
            let at = side.place(is_upright, row);
            let [one, other] = [at + aside * BESIDE, at - aside * BESIDE];
            let level = |at: Point| f64::from(calm.row(at.y as usize)[at.x as usize]).max(1.0);
            (side.is_seen_near(row as usize) && calm.holds(one) && calm.holds(other))
                .then(|| level(one) / level(other))
        };
        let mut ratios: Vec<f64> = (0..PLACES).filter_map(ratio).collect();
        ratios.sort_by(f64::total_cmp);
        let [low, usual, high] = [1, 2, 3].map(|k| ratios.get(k * ratios.len() / 4).copied());
        let (low, usual, high) = (low?, usual?, high?);
        let (share, into) = if usual < 1.0 { (usual, aside) } else { (1.0 / usual, -aside) };
        (SHADE.contains(&share) && high < SAME * low).then(|| Self {
            side: side.clone(),
            is_upright,
            on: first,
            into,
            share,
        })
    }

    /// How much of it is seen in a quadrilateral, less what is not, rows; `None` where it does not cross it.
    pub(crate) fn across(&self, depth: impl Fn(Point) -> f64, plane: &Plane<u8>) -> Option<f64> {
        let most = if self.is_upright { plane.height } else { plane.width };
        let depths: Vec<f64> =
            (0..most).map(|row| depth(self.side.place(self.is_upright, row as f64 + 0.5))).collect();
        let first = depths.iter().position(|d| *d > 0.0)?;
        let last = depths.iter().rposition(|d| *d > 0.0)? + 1;
        let deepest = depths.iter().copied().fold(0.0, f64::max);
        let score = self.side.score(first..last);
        (deepest > LEAST_DEPTH && score > 0.0).then_some(score)
    }

    /// What a level would be in the light.
    pub(crate) fn lit(&self, at: Point, level: f64) -> f64 {
        if self.is_dark(at) { level / self.share } else { level }
    }

    /// Whether a place is in it.
    pub(crate) fn is_dark(&self, at: Point) -> bool {
        (at - self.on).dot(self.into) > 0.0
    }
}
