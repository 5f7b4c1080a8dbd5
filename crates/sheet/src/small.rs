//! The small picture that a sheet is looked for in.

use std::cell::OnceCell;

use tracelight_image::Plane;

use crate::steps;

/// Levels beside a side are taken so far from it, px.
pub(crate) const BESIDE: f64 = 4.0;
/// About so many rows, or columns, tell where a sheet lies.
const SIDE: usize = 180;
/// And at most so many the other way.
const LONGER: usize = 600;
/// With fewer pixels a side a picture shows a figure, hardly its surroundings.
const LEAST_SIDE: usize = 64;

/// A picture averaged down.
pub(crate) struct Small {
    /// Pixels of the picture in one, either way.
    pub(crate) by: usize,
    pub(crate) levels: Plane<u8>,
    /// The same without lines; most pictures are known to show no sheet before it is asked for.
    calm: OnceCell<Plane<u8>>,
}

impl Small {
    /// `None` of a picture that is too small to show more than a figure.
    pub(crate) fn of(plane: &Plane<u8>) -> Option<Self> {
        let side = plane.width.min(plane.height);
        let longer = plane.width.max(plane.height);
        (side >= LEAST_SIDE).then(|| Self::by(plane, (side / SIDE).max(longer / LONGER).max(1)))
    }

    /// The same of any picture, however small.
    pub(crate) fn of_any(plane: &Plane<u8>) -> Self {
        Self::by(plane, (plane.width.min(plane.height) / SIDE).max(1))
    }

    fn by(plane: &Plane<u8>, by: usize) -> Self {
        Self { by, levels: plane.reduced(by), calm: OnceCell::new() }
    }

    /// Without its lines.
    pub(crate) fn calm(&self) -> &Plane<u8> {
        self.calm.get_or_init(|| steps::without_lines(&self.levels))
    }
}
