use tracelight_stroke::{Affine, Point, Vec2};

use crate::finished::Finished;

/// Width of the painting, px.
pub(super) const WIDTH: u32 = 1600;
/// Room for the trace on the wall, px.
const WALL: Vec2 = Vec2::new(880.0, 800.0);
/// Room for the picture on its sheet, px.
const SHEET: Vec2 = Vec2::new(400.0, 520.0);
/// The longer side of the sheet: A4, ISO 216. It hangs there to the wall's scale, wherever it has the room.
const A4_M: f64 = 0.297;
/// The longer side of the sheet over that of the picture on it.
pub(super) const SHEET_OVER_PICTURE: f64 = 1.2;
/// Between the sheet and the trace.
const GAP: f64 = 130.0;
/// Above and below, for air and captions.
const MARGIN: f64 = 120.0;

/// Where things are on the painting; pixels, x right, y down.
pub(super) struct Layout {
    /// Rows of the painting.
    pub(super) height: u32,
    /// From target metres to pixels.
    pub(super) pixel_from_target: Affine,
    /// Pixels a metre on the wall.
    pub(super) px_per_m: f64,
    /// Corners of what is shown of the wall, upper left and lower right.
    pub(super) wall: (Point, Point),
    /// Middle of the sheet.
    pub(super) sheet_middle: Point,
    /// Width and height of the picture on the sheet, without its margin.
    pub(super) sheet_size: Vec2,
    /// Whether the sheet is as large on the wall as an A4 one is.
    pub(super) sheet_to_scale: bool,
}

impl Layout {
    /// Fits a job's picture and trace side by side, both as large as their rooms allow.
    pub(super) fn new(job: &Finished<'_>) -> Self {
        let (low, high) = job.bounds();
        let size = high - low;
        let px_per_m = (WALL.x / size.x).min(WALL.y / size.y);
        let wall = size * px_per_m;
        let (sheet_size, sheet_to_scale) = sheet_size(job, size, px_per_m);
        let height = (wall.y.max(sheet_size.y) + 2.0 * MARGIN).clamp(640.0, 1200.0).round();
        let left = (f64::from(WIDTH) - sheet_size.x - GAP - wall.x) / 2.0;
        let middle = height / 2.0 - 14.0; // the captions weigh below
        let corner = Point::new(left + sheet_size.x + GAP, middle - wall.y / 2.0);
        let place = Affine::translate(corner.to_vec2() - Vec2::new(low.x, -high.y) * px_per_m)
            * Affine::scale_non_uniform(px_per_m, -px_per_m);
        Self {
            height: height as u32,
            pixel_from_target: place,
            px_per_m,
            wall: (corner, corner + wall),
            sheet_middle: Point::new(left + sheet_size.x / 2.0, middle),
            sheet_size,
            sheet_to_scale,
        }
    }
}

/// Size of the picture on its sheet, and whether that is to scale; a vector file's is that of what is shown of the wall.
fn sheet_size(job: &Finished<'_>, wall: Vec2, px_per_m: f64) -> (Vec2, bool) {
    let size =
        job.picture.map_or(wall, |p| Vec2::new(f64::from(p.raster.width()), f64::from(p.raster.height())));
    let room = (SHEET.x / size.x).min(SHEET.y / size.y);
    let true_size = A4_M / SHEET_OVER_PICTURE * px_per_m / size.x.max(size.y);
    let fitted = size * room.min(true_size);
    (Vec2::new(fitted.x.max(8.0), fitted.y.max(8.0)), true_size <= room)
}
