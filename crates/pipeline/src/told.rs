//! Places that somebody tells one by one.

use tracelight_formats::{Coordinates, Reading, Sheet};
use tracelight_picture::Source;
use tracelight_stroke::{Drawing, Place, PlaceKind, Point, Rect, Vec2};

use crate::edges::Origin;
use crate::placed::Placing;

/// About the places, to the sheet's edge, m.
const MARGIN_M: f64 = 1e-3;

/// Places on the target as a drawing of their own, which lies there by itself: `placing` no longer moves it.
#[must_use]
pub fn told_places(places: &[Vec2], placing: &mut Placing) -> Source {
    let told: Vec<Point> = places.iter().map(|&place| placing.from.place(place)).collect();
    let remarks = placing.from.remark().into_iter().collect();
    let boxes = told.iter().map(|&at| Rect::from_points(at, at));
    let bounds = boxes.reduce(|all, one| all.union(one)).unwrap_or(Rect::ZERO).inflate(MARGIN_M, MARGIN_M);
    (placing.from, placing.offset_m) = (Origin::default(), Some(bounds.center().to_vec2()));
    let place = |at: &Point| Place {
        at: Point::new(at.x - bounds.x0, bounds.y1 - at.y),
        kind: PlaceKind::Point,
        block: None,
        layer: None,
        colour: None,
        entity: None,
    };
    let sheet = Sheet {
        width: bounds.width(),
        height: bounds.height(),
        metres_per_unit: Some(1.0),
        drawing: Drawing::default(),
        coordinates: Coordinates::Page { unit_m: Some(1.0) },
        places: told.iter().map(place).collect(),
    };
    Source::Strokes(Reading { sheet, remarks, doubt: None, unit_guessed: false, is_list: true })
}
