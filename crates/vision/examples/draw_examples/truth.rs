use std::fmt::Write;

use tracelight_stroke::{Drawing, Point, Stroke};

use super::TOLERANCE_PX;

/// A drawing as `strokes --json` writes it; a closed stroke's last point is its first.
pub(crate) fn of_drawing([width, height]: [usize; 2], drawing: &Drawing) -> String {
    let strokes: Vec<_> = drawing.strokes.iter().map(of_stroke).collect();
    let strokes = strokes.join(",\n");
    format!("{{\"width_px\":{width},\"height_px\":{height},\"mode\":\"auto\",\"strokes\":[\n{strokes}\n]}}\n")
}

/// The middles of a ruler's two tapes.
pub(crate) fn of_marks([a, b]: [Point; 2]) -> String {
    format!("{{\"a\":{},\"b\":{}}}\n", of_point(a), of_point(b))
}

fn of_stroke(stroke: &Stroke) -> String {
    let points: Vec<_> = stroke.path.flatten(TOLERANCE_PX).into_iter().map(of_point).collect();
    let mut json = format!("{{\"closed\":{},\"kind\":\"{}\",", stroke.path.is_closed(), stroke.kind.name());
    if let Some(width) = stroke.pen {
        // writing to a string cannot fail
        let _ = write!(json, "\"pen_px\":{width},");
    }
    json + "\"points\":[" + &points.join(",") + "]}"
}

fn of_point(point: Point) -> String {
    format!("[{:.3},{:.3}]", point.x, point.y)
}
