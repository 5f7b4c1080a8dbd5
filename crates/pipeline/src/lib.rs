//! From a picture or a drawing to a plan: strokes on their sheet, on the target, in order, in time. Values in, values out: no flag,
//! no file, no clock.

mod align;
mod bent;
mod carried;
mod choice;
mod corners;
mod distance;
mod driving;
mod edges;
mod frame;
mod hopeless;
mod no_go;
mod ordering;
mod paper;
mod placed;
mod points;
mod preflight;
mod quality;
mod reach;
mod refused;
mod rounded;
mod schedule;
mod sheet;
mod sketch;
mod spread;
mod standing;
mod told;
mod tracing;
mod twice;
mod typed;

pub use align::{AlignFigures, AskedMark, MarkedAt};
pub use carried::{carried, has_corner};
pub use choice::Choice;
pub use corners::SheetFigures;
pub use distance::DistanceFrom;
pub use driving::{Asked, DEFAULT_DISTANCE_M, DEFAULT_SPEED_M_S, Driving, REACHED, request_of};
pub use edges::{Corner, Origin};
pub use frame::Frame;
pub use no_go::LeftOut;
pub use ordering::{OrderBy, OrderRequest, Sequence};
pub use paper::Paper;
pub use placed::{Fit, Page, Placed, Placing, place, sketch};
pub use points::{PointMark, Points, TypedKinds, point_json, point_words};
pub use preflight::{Before, Check, Verdict, preflight};
pub use quality::QualityFigures;
pub use refused::refused;
pub use schedule::{
    Schedule, check_speed, check_standing, schedule, schedule_as_it_is, schedule_rest, schedule_whole,
};
pub use sheet::{PaperSeen, Straight, clockwise, page};
pub use sketch::{Sketch, sketch_at};
pub use standing::{Standing, spot_radius_m};
pub use told::told_places;
pub use tracing::{LeastLength, Straighten, Tracing};
pub use typed::{NoGo, TypedMark, typed_marks, typed_no_go};
