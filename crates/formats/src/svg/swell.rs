//! How many curves round things become.
//!
//! Whoever resolves an SVG turns an arc of radius r into some r^⅙ cubics (ten times as many for a millionfold radius).
//! A radius of 1e90, fifty characters of a file, is more of them than memory holds.

use svgtypes::{Length, LengthUnit, PathParser, PathSegment};
use tracelight_maths::powf;
use usvg::roxmltree::{Document, Node};

/// Cubics of a whole turn, as `kurbo::Arc` has them for the tolerance of 0.1 that `usvg` asks for; four at least.
fn cubics(radius: f64) -> f64 {
    powf(1.1163 * radius / 0.1, 1.0 / 6.0).max(4.0)
}

/// Bytes of attributes that would be as many segments as the element's round parts become; 0 for one without.
pub(super) fn weight(node: Node, largest: f64) -> u64 {
    let cubics = match node.tag_name().name() {
        "path" => node.attribute("d").map_or(0.0, of_path),
        "circle" | "ellipse" | "rect" => {
            let radii = ["r", "rx", "ry"].iter().filter_map(|name| node.attribute(*name));
            radii.map(|radius| of_radius(radius, largest)).fold(0.0, f64::max)
        }
        _ => 0.0,
    };
    // two bytes a segment, as everywhere here; what is no number would be endless
    if cubics.is_finite() { (2.0 * cubics) as u64 } else { u64::MAX }
}

/// More cubics than this no arc of a drawing becomes: a radius of 1e17. Whoever resolves the SVG takes them from the front
/// of their row one by one, so that the work grows with the square of their number: [`weigh`].
const MOST_OF_ARC: f64 = 1000.0;

/// Of all arcs of a path, infinite where one of them becomes too many. Where they begin is not followed up: no point is
/// further out than all numbers before it together, and a radius that is too small for its arc's ends is as large as they
/// are apart.
fn of_path(d: &str) -> f64 {
    let (mut reach, mut sum) = (0.0, 0.0);
    for segment in PathParser::from(d).map_while(Result::ok) {
        reach += extent(&segment);
        if let PathSegment::EllipticalArc { rx, ry, .. } = segment {
            sum += weigh(cubics(rx.abs().max(ry.abs()).max(2.0 * reach)));
        }
    }
    sum
}

/// What so many cubics of one arc count: they and, 32 of them moved as fast as one is made, their moves.
fn weigh(cubics: f64) -> f64 {
    if cubics > MOST_OF_ARC { f64::INFINITY } else { cubics * (1.0 + cubics / 32.0) }
}

/// Sum of the numbers that say where a segment ends.
fn extent(segment: &PathSegment) -> f64 {
    match *segment {
        PathSegment::MoveTo { x, y, .. }
        | PathSegment::LineTo { x, y, .. }
        | PathSegment::CurveTo { x, y, .. }
        | PathSegment::SmoothCurveTo { x, y, .. }
        | PathSegment::Quadratic { x, y, .. }
        | PathSegment::SmoothQuadratic { x, y, .. }
        | PathSegment::EllipticalArc { x, y, .. } => x.abs() + y.abs(),
        PathSegment::HorizontalLineTo { x, .. } => x.abs(),
        PathSegment::VerticalLineTo { y, .. } => y.abs(),
        PathSegment::ClosePath { .. } => 0.0,
    }
}

/// Of a circle whose radius is written so.
fn of_radius(text: &str, largest: f64) -> f64 {
    const PX_IN_LARGEST_UNIT: f64 = 96.0; // an inch
    let Ok(length) = text.parse::<Length>() else { return 0.0 };
    let unit = match length.unit {
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => largest,
        _ => PX_IN_LARGEST_UNIT,
    };
    cubics(length.number.abs() * unit)
}

/// The largest number of all that say how large a sheet or a font is, which relative lengths are multiples of.
pub(super) fn largest_size(document: &Document) -> f64 {
    const SIZES: [&str; 5] = ["width", "height", "viewBox", "font-size", "style"];
    let attributes = document.descendants().flat_map(|n| n.attributes());
    let sizes = attributes.filter(|a| SIZES.contains(&a.name())).map(|a| a.value());
    let sheets = document.descendants().filter(|n| n.tag_name().name() == "style").filter_map(|n| n.text());
    sizes.chain(sheets).flat_map(numbers).fold(96.0, f64::max)
}

fn numbers(text: &str) -> impl Iterator<Item = f64> {
    let parts = text.split(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'e' | 'E')));
    parts.filter_map(|part| part.trim_end_matches(['e', 'E']).parse::<f64>().ok()).map(f64::abs)
}
