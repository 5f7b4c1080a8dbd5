//! A sheet that was found, and what is known of it beside where it is.

use tracelight_image::Plane;
use tracelight_stroke::Point;

use crate::choice;
use crate::edge::{self, Edge};
use crate::quad::Quad;
use crate::sheet::Sheet;
use crate::small::Small;

/// A sheet, and what is known of it at a smaller scale.
pub(crate) struct Found {
    pub(crate) sheet: Sheet,
    pub(crate) quad: Quad,
    /// On whose lines its sides lie.
    pub(crate) square: Option<[Point; 4]>,
    /// How far inside its edge that is over.
    pub(crate) blur_px: f64,
}

impl Found {
    /// The one in a picture, if there is one.
    pub(crate) fn of(plane: &Plane<u8>, small: &Small) -> Option<Self> {
        let by = |quad: Quad| {
            let Edge { sheet, square, blur_px } = edge::sheet(plane, small, &quad)?;
            Some(Self { sheet, quad, square, blur_px })
        };
        choice::best(small).and_then(by).or_else(|| by(Quad::all(&small.levels)))
    }

    /// What someone says to be one.
    pub(crate) fn within(plane: &Plane<u8>, small: &Small, corners: [Point; 4]) -> Option<Self> {
        let by = small.by as f64;
        let quad = Quad::between(corners.map(|c| Point::new(c.x / by, c.y / by)))?;
        let sheet = edge::between(plane, corners)?;
        Some(Self { sheet, quad, square: Some(corners), blur_px: 0.0 })
    }
}
