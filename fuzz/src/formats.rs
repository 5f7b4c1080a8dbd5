//! Files of drawings: read, written, read back.

use tracelight_formats::gcode::GcodeOptions;
use tracelight_formats::json::Traced;
use tracelight_formats::{FormatError, Hidden, ReadOptions, Sheet, csv, dxf, gcode, hpgl, ild, json, svg};
use tracelight_stroke::{Affine, Drawing, Element, Path, Point, Stroke, Vec2};

use crate::sound::check_sheet;

/// Flattening for the comparison, and for the formats that have no curves, m.
const TOLERANCE_M: f64 = 1e-5;

/// Strokes shorter than this may be lost in a file's decimals, m.
const SHORT_M: f64 = 1e-5;

/// Comparing takes points times segments; larger drawings are written only.
const MOST_COMPARED: usize = 600;

/// No message is longer, bytes.
const LONGEST_MESSAGE: usize = 2000;

/// A drawing's file is refused in a sentence or read; what is read can be written in every format and read back.
///
/// # Panics
/// When that does not hold.
pub fn check(file: &[u8]) {
    let about = |drawing: Drawing| Sheet::in_pixels(1.0, 1.0, drawing);
    let sheets = [
        svg::read(file).map(|r| r.sheet),
        dxf::read(file).map(|r| r.sheet),
        json::read(file).map(|t| t.sheet),
        csv::read(file).map(about),
    ];
    sheets.into_iter().for_each(|sheet| match sheet {
        Ok(sheet) => check_written(&sheet),
        Err(error) => check_message(&error),
    });
}

fn check_message(error: &FormatError) {
    let message = error.to_string();
    assert!((10..=LONGEST_MESSAGE).contains(&message.len()), "{} bytes: {message}", message.len());
}

fn check_written(sheet: &Sheet) {
    check_sheet(sheet);
    check_json(sheet);
    let Some(drawing) = on_a_metre(&sheet.drawing) else { return };
    let svg = svg::write(&drawing, 1.0, 1.0);
    let dxf = dxf::write(&drawing, 1.0, 1.0);
    let csv = csv::write(&drawing, TOLERANCE_M);
    let gcode = gcode::write(&drawing, 1.0, 1.0, &GcodeOptions::default());
    let hpgl = hpgl::write(&drawing, 1.0, 1.0, TOLERANCE_M);
    for (name, text) in [("G-code", &gcode), ("HPGL", &hpgl), ("SVG", &svg), ("DXF", &dxf), ("CSV", &csv)] {
        assert!(!text.contains("NaN") && !text.contains("inf\n"), "{name} with what is no number");
    }
    assert!(!ild::write(&drawing, 1.0, 1.0).bytes.is_empty());
    if segments(&drawing) <= MOST_COMPARED {
        // SVG is read in single precision, and its arcs may come back as cubics
        let everything = ReadOptions { hidden: Hidden::Keep, crop: false, ..ReadOptions::default() };
        check_near("SVG", svg::read_with(svg.as_bytes(), &everything).map(|r| r.sheet), &drawing, 1e-3);
        check_near("DXF", dxf::read(dxf.as_bytes()).map(|r| r.sheet), &drawing, 1e-4);
        let back = csv::read(csv.as_bytes());
        let back = back.map(|drawing| Sheet::in_pixels(1.0, 1.0, drawing));
        check_near("CSV", back.map(|s| flipped(s, 1.0)), &drawing, 1e-4);
    }
}

/// JSON keeps everything; only what closes a path may be added.
fn check_json(sheet: &Sheet) {
    // points for people; the path is exact
    let tolerance = 1e-3 * sheet.width.max(sheet.height).max(reach(&sheet.drawing));
    let traced = Traced { sheet: sheet.clone(), mode: "auto".into() };
    let back = json::read(json::write(&traced, tolerance).as_bytes());
    match back {
        Ok(back) => {
            assert_eq!(back.sheet.drawing.strokes.len(), sheet.drawing.strokes.len());
            for (a, b) in back.sheet.drawing.strokes.iter().zip(&sheet.drawing.strokes) {
                assert_eq!((a.kind, a.pen, &a.layer, a.colour), (b.kind, b.pen, &b.layer, b.colour));
                assert_eq!(a.path.start(), b.path.start());
                assert!(a.path.elements().starts_with(b.path.elements()), "{a:?} was {b:?}");
            }
        }
        // an end of an arc may lie a little further out than is read, and a small DXF may repeat its blocks often
        Err(FormatError::Far { .. } | FormatError::TooLarge { .. }) => {}
        Err(error) => panic!("our own JSON: {error}"),
    }
}

/// Furthest landmark from the origin.
fn reach(drawing: &Drawing) -> f64 {
    let points = drawing.strokes.iter().flat_map(|s| landmarks(&s.path));
    points.map(|p| p.to_vec2().hypot()).fold(0.0, f64::max)
}

fn landmarks(path: &Path) -> Vec<Point> {
    let of = |piece: tracelight_stroke::Piece| match piece.element {
        Element::Line { to } => vec![to],
        Element::Cubic { c1, c2, to } => vec![c1, c2, to],
        // the whole circle
        Element::Arc { centre, .. } => {
            let r = piece.from.distance(centre);
            let corner = Vec2::new(r, r);
            vec![centre - corner, centre + corner, piece.end()]
        }
    };
    std::iter::once(path.start()).chain(path.pieces().flat_map(of)).collect()
}

/// The drawing scaled to a metre across with all its circles, its middle the target's origin; the sheet's y is down, the
/// target's up. `None` where it has no size.
fn on_a_metre(drawing: &Drawing) -> Option<Drawing> {
    let landmarks = drawing.strokes.iter().flat_map(|s| landmarks(&s.path));
    let (low, high) = bounds(landmarks);
    let size = (high.x - low.x).max(high.y - low.y);
    if size < 1e-3 {
        return None;
    }
    let corner = Affine::translate(-low.to_vec2()).then_scale_non_uniform(1.0 / size, -1.0 / size);
    let scaled = drawing.transformed(corner);
    let (low, high) = bounds(scaled.strokes.iter().flat_map(|s| s.path.flatten(0.1 * TOLERANCE_M)));
    Some(scaled.transformed(Affine::translate(-low.midpoint(high).to_vec2())))
}

fn bounds(points: impl Iterator<Item = Point>) -> (Point, Point) {
    let nowhere = (Point::new(f64::MAX, f64::MAX), Point::new(f64::MIN, f64::MIN));
    points.fold(nowhere, |(low, high), p| {
        (Point::new(low.x.min(p.x), low.y.min(p.y)), Point::new(high.x.max(p.x), high.y.max(p.y)))
    })
}

/// From the target's frame to a sheet's of that height.
fn flipped(sheet: Sheet, side: f64) -> Sheet {
    let drawing = sheet.drawing.transformed(Affine::new([1.0, 0.0, 0.0, -1.0, 0.5 * side, 0.5 * side]));
    Sheet { metres_per_unit: Some(1.0), drawing, ..sheet }
}

fn segments(drawing: &Drawing) -> usize {
    drawing.strokes.iter().map(|s| s.path.flatten(TOLERANCE_M).len()).sum()
}

/// What was read back, a sheet about the target's origin, lies where the drawing does: all of it, and nothing else.
///
/// # Panics
/// When more than `within` metres are between the two anywhere.
pub fn check_near(format: &str, back: Result<Sheet, FormatError>, drawing: &Drawing, within: f64) {
    let long = |s: &&Stroke| s.path.length(1e-6) > SHORT_M;
    let wanted: Vec<&Stroke> = drawing.strokes.iter().filter(long).collect();
    let sheet = match back {
        Ok(sheet) => sheet,
        Err(FormatError::Nothing { .. }) if wanted.is_empty() => return,
        Err(error) => panic!("our own {format}: {error}"),
    };
    let to_metres = sheet.metres_per_unit.unwrap_or(1.0);
    // onto the target: y up, the sheet's middle the origin
    let placed = Affine::translate((-0.5 * sheet.width, -0.5 * sheet.height))
        .then_scale_non_uniform(to_metres, -to_metres);
    let found = sheet.drawing.transformed(placed);
    let all: Vec<&Stroke> = drawing.strokes.iter().collect();
    let read: Vec<&Stroke> = found.strokes.iter().collect();
    let (lost, added) = (furthest(&wanted, &read), furthest(&read, &all));
    assert!(lost <= within, "{format} loses a line: {lost} m from what is read back");
    assert!(added <= within, "{format} adds a line: {added} m from what was written");
}

/// Largest distance from some strokes' points to the nearest of others' lines.
fn furthest(from: &[&Stroke], to: &[&Stroke]) -> f64 {
    let lines: Vec<Vec<Point>> = to.iter().map(|s| s.path.flatten(TOLERANCE_M)).collect();
    let nearest = |p: Point| {
        let pairs = lines.iter().flat_map(|l| l.windows(2));
        pairs.map(|w| distance_to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min)
    };
    let points = from.iter().flat_map(|s| s.path.flatten(TOLERANCE_M));
    points.map(nearest).fold(0.0, f64::max)
}

fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    let share = ((p - a).dot(along) / along.hypot2().max(1e-300)).clamp(0.0, 1.0);
    p.distance(a + along * share)
}
