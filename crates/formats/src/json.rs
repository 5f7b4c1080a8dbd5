//! Strokes in pixels as JSON: what `strokes --json` prints.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use tracelight_stroke::{Colour, Drawing, Element, Entity, Path, Point, Stroke, StrokeKind};

use crate::layers::Layers;
use crate::pen::polyline;
use crate::{FormatError, Sheet, check_size, is_sound};

/// Strokes found in a picture, in its pixel frame, and how they were found.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// The picture's size and the strokes, px.
    pub sheet: Sheet,
    /// The tracer's mode: `auto`, `centreline`, `outline` or `sweep`; `strokes` for what was not traced.
    pub mode: String,
}

#[derive(Serialize, Deserialize)]
struct Document {
    #[serde(serialize_with = "whole_if_it_is")]
    width_px: f64,
    #[serde(serialize_with = "whole_if_it_is")]
    height_px: f64,
    #[serde(default = "of_strokes")]
    mode: String,
    strokes: Vec<Line>,
}

/// The mode of a drawing that does not say how it was traced.
fn of_strokes() -> String {
    "strokes".to_owned()
}

#[derive(Serialize, Deserialize)]
struct Line {
    closed: bool,
    #[serde(default)]
    kind: Kind,
    #[serde(default)]
    pen_px: Option<f64>,
    #[serde(default)]
    points: Vec<[f64; 2]>,
    #[serde(default)]
    path: Option<Course>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    layer: Option<String>,
    /// `#rrggbb`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    colour: Option<String>,
    /// What of a drawing file it comes from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    entity: Option<Thing>,
}

/// An entity of a DXF or an element of an SVG.
#[derive(Serialize, Deserialize)]
struct Thing {
    kind: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    id: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    #[serde(default, skip_serializing_if = "is_zero")]
    more: usize,
}

const fn is_zero(number: &usize) -> bool {
    *number == 0
}

#[derive(Clone, Copy, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    #[default]
    Centreline,
    Outline,
}

/// A path: where it starts, and the lines, arcs and cubics it goes on by.
#[derive(Serialize, Deserialize)]
struct Course {
    start: [f64; 2],
    elements: Vec<Step>,
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum Step {
    /// To a point.
    Line([f64; 2]),
    /// About a centre.
    Arc { centre: [f64; 2], sweep_rad: f64 },
    /// Two control points and the end.
    Cubic([[f64; 2]; 3]),
}

/// One JSON object. `points` stay within `tolerance_px` of the path, `path` is exact.
pub fn write(traced: &Traced, tolerance_px: f64) -> String {
    let strokes = traced.sheet.drawing.strokes.iter();
    let document = Document {
        width_px: traced.sheet.width,
        height_px: traced.sheet.height,
        mode: traced.mode.clone(),
        strokes: strokes.map(|s| line_of(s, tolerance_px)).collect(),
    };
    // plain structs of numbers and strings: there is nothing that could fail
    serde_json::to_string(&document).unwrap_or_default()
}

fn line_of(stroke: &Stroke, tolerance_px: f64) -> Line {
    let mut points = stroke.path.flatten(tolerance_px);
    if stroke.path.is_closed() {
        points.pop();
    }
    Line {
        closed: stroke.path.is_closed(),
        kind: match stroke.kind {
            StrokeKind::Centreline => Kind::Centreline,
            StrokeKind::Outline => Kind::Outline,
        },
        pen_px: stroke.pen,
        points: points.into_iter().map(|p| [to_4_decimals(p.x), to_4_decimals(p.y)]).collect(),
        path: Some(Course {
            start: pair(stroke.path.start()),
            elements: stroke.path.elements().iter().map(step_of).collect(),
        }),
        layer: stroke.layer.as_deref().map(str::to_owned),
        colour: stroke.colour.map(|c| c.to_string()),
        entity: stroke.entity.as_deref().map(|entity| Thing {
            kind: entity.kind.as_ref().to_owned(),
            id: entity.id.as_deref().map(str::to_owned),
            line: entity.line,
            more: entity.more,
        }),
    }
}

fn step_of(element: &Element) -> Step {
    match *element {
        Element::Line { to } => Step::Line(pair(to)),
        Element::Arc { centre, sweep } => Step::Arc { centre: pair(centre), sweep_rad: sweep },
        Element::Cubic { c1, c2, to } => Step::Cubic([c1, c2, to].map(pair)),
    }
}

fn pair(p: Point) -> [f64; 2] {
    [p.x, p.y]
}

fn to_4_decimals(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// A picture's size is whole: 640, not 640.0.
fn whole_if_it_is<S: serde::Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
    const MOST: f64 = (1_u64 << 53) as f64;
    match value.fract() == 0.0 && (0.0..MOST).contains(value) {
        true => to.serialize_u64(*value as u64),
        false => to.serialize_f64(*value),
    }
}

/// Reads what [`write`] writes. A stroke's `path` counts where there is one, else its `points`; other fields are
/// ignored, for scripts may add their own.
///
/// # Errors
/// Broken JSON with line and column, values out of bounds with the stroke they are in, and drawings of nothing.
pub fn read(bytes: &[u8]) -> Result<Traced, FormatError> {
    check_size(bytes)?;
    let document: Document = serde_json::from_slice(bytes).map_err(|e| FormatError::Syntax {
        format: "JSON",
        line: e.line(),
        column: e.column(),
        message: e.to_string(),
    })?;
    let (width, height) = (document.width_px, document.height_px);
    let has_size = width > 0.0 && height > 0.0 && is_sound(Point::new(width, height));
    if !has_size {
        return Err(FormatError::Value {
            place: "size".into(),
            field: "width_px, height_px",
            value: format!("{width}, {height}"),
            expected: "two positive numbers up to 1e6",
        });
    }
    let mut layers = Layers::default();
    let strokes = document.strokes.iter().enumerate().map(|(i, line)| stroke_of(line, i, &mut layers));
    let strokes = strokes.collect::<Result<Vec<_>, _>>()?;
    if strokes.is_empty() {
        return Err(FormatError::Nothing { hint: "\"strokes\" is empty" });
    }
    let sheet = Sheet::in_pixels(width, height, Drawing { strokes });
    Ok(Traced { sheet, mode: document.mode })
}

fn stroke_of(line: &Line, number: usize, layers: &mut Layers) -> Result<Stroke, FormatError> {
    let place = format!("strokes[{number}]");
    let path = match &line.path {
        Some(course) => path_of(course, line.closed, &place)?,
        None => polyline_of(&line.points, line.closed, &place)?,
    };
    if let Some(pen) = line.pen_px.filter(|w| !(0.0..=crate::limit::MAX_COORDINATE).contains(w)) {
        let value = pen.to_string();
        return Err(FormatError::Value { place, field: "pen_px", value, expected: "0 to 1e6, or null" });
    }
    let kind = match line.kind {
        Kind::Centreline => StrokeKind::Centreline,
        Kind::Outline => StrokeKind::Outline,
    };
    let colour = line.colour.as_deref().map(|text| colour_of(text, &place)).transpose()?;
    let layer = line.layer.as_deref().map(|l| layers.named(l));
    let entity = line.entity.as_ref().map(|thing| {
        let id = thing.id.as_deref().map(Into::into);
        Arc::new(Entity { kind: thing.kind.as_str().into(), id, line: thing.line, more: thing.more })
    });
    Ok(Stroke { path, kind, pen: line.pen_px, layer, colour, entity })
}

fn colour_of(text: &str, place: &str) -> Result<Colour, FormatError> {
    Colour::from_hex(text).ok_or_else(|| FormatError::Value {
        place: place.into(),
        field: "colour",
        value: format!("{:?}", text.chars().take(40).collect::<String>()),
        expected: "#rrggbb, such as \"#c8102e\"",
    })
}

fn sound([x, y]: [f64; 2], place: &str) -> Result<Point, FormatError> {
    let point = Point::new(x, y);
    match is_sound(point) {
        true => Ok(point),
        false => Err(FormatError::Far { place: place.into(), x, y }),
    }
}

fn polyline_of(points: &[[f64; 2]], closed: bool, place: &str) -> Result<Path, FormatError> {
    let points = points.iter().map(|&p| sound(p, place)).collect::<Result<Vec<_>, _>>()?;
    polyline(&points, closed).ok_or_else(|| too_short(place, "points", points.len()))
}

fn too_short(place: &str, field: &'static str, found: usize) -> FormatError {
    let value = format!("a list of {found}");
    FormatError::Value { place: place.into(), field, value, expected: "two or more different points" }
}

fn path_of(course: &Course, closed: bool, place: &str) -> Result<Path, FormatError> {
    let mut path = Path::new(sound(course.start, place)?);
    for step in &course.elements {
        path.push(element_of(*step, place)?);
    }
    if course.elements.is_empty() {
        return Err(too_short(place, "path.elements", 0));
    }
    sound(pair(path.end()), place)?;
    if closed {
        path.close();
    }
    Ok(path)
}

fn element_of(step: Step, place: &str) -> Result<Element, FormatError> {
    Ok(match step {
        Step::Line(to) => Element::Line { to: sound(to, place)? },
        Step::Cubic([c1, c2, to]) => {
            Element::Cubic { c1: sound(c1, place)?, c2: sound(c2, place)?, to: sound(to, place)? }
        }
        Step::Arc { centre, sweep_rad } => {
            // a hair over one turn, for a full circle whose sweep was rounded
            if sweep_rad == 0.0 || sweep_rad.abs() > 1.001 * std::f64::consts::TAU {
                return Err(FormatError::Value {
                    place: place.into(),
                    field: "sweep_rad",
                    value: sweep_rad.to_string(),
                    expected: "an angle up to one turn, ±6.2832, not zero",
                });
            }
            Element::Arc { centre: sound(centre, place)?, sweep: sweep_rad }
        }
    })
}

#[cfg(test)]
mod tests;
