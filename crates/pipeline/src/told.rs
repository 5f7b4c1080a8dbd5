//! Places that somebody tells one by one.

use tracelight_formats::{Coordinates, Reading, Sheet};
use tracelight_picture::Source;
use tracelight_stroke::{Drawing, Place, PlaceKind, Point, Vec2};

use crate::edges::Origin;
use crate::placed::Placing;

/// Half the least side of the sheet on which they lie, m.
const LEAST_M: f64 = 1e-3;

/// Places on the target as a drawing of their own, which lies there by itself: `placing` no longer moves it.
#[must_use]
pub fn told_places(places: &[Vec2], placing: &mut Placing) -> Source {
    let told: Vec<Point> = places.iter().map(|&place| placing.from.place(place)).collect();
    let remarks = placing.from.remark().into_iter().collect();
    (placing.from, placing.offset_m) = (Origin::default(), None);
    let reach = |of: fn(&Point) -> f64| told.iter().map(|at| of(at).abs()).fold(LEAST_M, f64::max);
    let (half_width, half_height) = (reach(|at| at.x), reach(|at| at.y));
    let place = |at: &Point| Place {
        at: Point::new(half_width + at.x, half_height - at.y),
        kind: PlaceKind::Point,
        block: None,
        layer: None,
        colour: None,
        entity: None,
    };
    let sheet = Sheet {
        width: 2.0 * half_width,
        height: 2.0 * half_height,
        metres_per_unit: Some(1.0),
        drawing: Drawing::default(),
        coordinates: Coordinates::Page { unit_m: Some(1.0) },
        places: told.iter().map(place).collect(),
    };
    Source::Strokes(Reading { sheet, remarks, doubt: None, is_list: true })
}
