//! How people name places of a drawing, and where these lie on the target, for whoever shows both.

use serde::Serialize;
use tracelight_formats::Coordinates;
use tracelight_stroke::{Point, Rect, extent};

use crate::placed::Placed;
use crate::sketch::Sketch;

/// Four places of a drawing that tell where all others lie: the corners of its sheet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SheetFigures {
    /// The unit in which `--align` reads places of it: `px`, from the picture's top left corner, or `m`, in the file's own coordinates.
    pub unit: &'static str,
    /// The corners in that unit, from the left top one clockwise.
    pub corners: [[f64; 2]; 4],
    /// Where they lie on the target, m.
    pub target_m: [[f64; 2]; 4],
    /// Width and height of the picture or page that the file shows, px; none of a file that has coordinates of its own.
    pub picture_px: Option<[f64; 2]>,
    /// Nobody says what the file's unit is: it was taken for the millimetre.
    pub unit_guessed: bool,
}

impl SheetFigures {
    /// Of a sketch that was placed; `None` where a corner lies nowhere.
    #[must_use]
    pub fn of(sketch: &Sketch, placed: &Placed) -> Option<Self> {
        let page = Rect::new(0.0, 0.0, sketch.size.0, sketch.size.1);
        // marks can put the page's margins beyond the horizon, but not what is drawn
        let drawn = || extent(&sketch.drawing).filter(|drawn| drawn.width() > 0.0 && drawn.height() > 0.0);
        let (corners, target_m) = told(sketch, placed, page).or_else(|| told(sketch, placed, drawn()?))?;
        let picture_px = sketch.coordinates.has_pixels().then(|| {
            let (width, height) = sketch.paper.as_ref().map_or(sketch.size, |paper| paper.picture_px);
            [width, height]
        });
        Some(Self {
            unit: if sketch.coordinates.has_pixels() { "px" } else { "m" },
            corners,
            target_m,
            picture_px,
            unit_guessed: sketch.unit_guessed,
        })
    }
}

/// Four places.
type Corners = [[f64; 2]; 4];

/// The corners of a part of the sheet, as people name them and on the target.
fn told(sketch: &Sketch, placed: &Placed, of: Rect) -> Option<(Corners, Corners)> {
    let on_sheet = [(of.x0, of.y0), (of.x1, of.y0), (of.x1, of.y1), (of.x0, of.y1)].map(Point::from);
    let named = all(on_sheet.map(|corner| match sketch.coordinates {
        Coordinates::File(sheet_from_file) => Some(sheet_from_file.inverse() * corner),
        Coordinates::Page { .. } => sketch.in_photograph(corner),
    }))?;
    Some((named, all(on_sheet.map(|corner| placed.on_target(corner)))?))
}

fn all(points: [Option<Point>; 4]) -> Option<Corners> {
    let is_known = |point: &Option<Point>| point.is_some_and(|point| point.is_finite());
    points.iter().all(is_known).then(|| points.map(|point| point.map_or([0.0; 2], |p| [p.x, p.y])))
}
