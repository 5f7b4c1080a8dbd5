//! ILDA image data, format 5 (2D, true colour), for show projectors: *The ILDA Image Data Transfer Format
//! Specification*, revision 011 (2014).
//!
//! A frame is a list of points that the scanners jump to at an even pace; lines are what they draw on the way. So
//! points are set close enough that the way is straight, and repeated where the mirrors must come to rest.

use tracelight_maths::atan2;
use tracelight_stroke::{Affine, Colour, Drawing, Path, Point};

/// Coordinates go from minus this to this.
const RANGE: f64 = 32_767.0;

/// Furthest that chords may be from their curve, units: a 3000th of the sheet, less than the beam's width.
const TOLERANCE: f64 = 20.0;

/// Longest lit step, units: 1.5 % of the range. A line across the whole of it is 66 points, 2 ms at the usual 30 000
/// points a second.
const LIT_STEP: f64 = 1000.0;

/// Longest dark step, units. The mirrors may lag; nobody sees it.
const DARK_STEP: f64 = 3000.0;

/// Points at the start and end of a stroke: the mirrors settle before the light comes, and the light is gone before
/// they move on.
const DWELL: usize = 4;

/// Points in a corner.
const CORNER_DWELL: usize = 3;

/// Turns from here on are corners: 30°.
const CORNER_RAD: f64 = 0.52;

/// Points of a frame at most: its header counts them in 16 bits.
const MOST_POINTS: usize = 65_535;

/// Status bits.
const LAST_POINT: u8 = 0x80;
const BLANKED: u8 = 0x40;

/// A point of a frame; `None` is dark.
type Dot = (Point, Option<Colour>);

/// A drawing on the target (metres, y up, origin at the centre) as an ILDA file: the sheet's larger side spans the whole
/// range, strokes in tracing order and in their colour (white without one; black, which is ink, is white light).
///
/// One frame, unless it would have more than 65 535 points: then a new one begins at a stroke, or within one that is
/// longer than that.
pub fn write(drawing: &Drawing, width_m: f64, height_m: f64) -> Vec<u8> {
    let larger = width_m.max(height_m);
    let scale = if larger > 0.0 { 2.0 * RANGE / larger } else { 1.0 };
    let frames = frames(&drawing.transformed(Affine::scale(scale)));
    let mut file = Vec::new();
    for (number, dots) in frames.iter().enumerate() {
        file.extend(header(dots.len(), number, frames.len()));
        for (i, dot) in dots.iter().enumerate() {
            file.extend(record(dot, i + 1 == dots.len()));
        }
    }
    // no points: the end of the file
    file.extend(header(0, frames.len(), frames.len()));
    file
}

fn frames(drawing: &Drawing) -> Vec<Vec<Dot>> {
    let mut frames = vec![Vec::new()];
    let mut at = Point::ORIGIN;
    for stroke in &drawing.strokes {
        let colour = stroke.colour.filter(|&c| c != Colour::BLACK).unwrap_or(Colour::WHITE);
        let dots = dots(at, &stroke.path, colour);
        let used = frames.last().map_or(0, Vec::len);
        if used > 0 && used + dots.len() > MOST_POINTS {
            frames.push(Vec::new());
        }
        for dot in dots {
            if frames.last().is_some_and(|f| f.len() == MOST_POINTS) {
                frames.push(Vec::new());
            }
            if let Some(frame) = frames.last_mut() {
                frame.push(dot);
            }
        }
        at = stroke.path.end();
    }
    frames
}

/// The dark way to a stroke and the stroke itself.
fn dots(at: Point, path: &Path, colour: Colour) -> Vec<Dot> {
    let points = path.flatten(TOLERANCE);
    let (start, end) = (path.start(), path.end());
    let mut dots: Vec<Dot> = steps(at, start, DARK_STEP).map(|p| (p, None)).collect();
    dots.extend([(start, None); DWELL]);
    dots.extend([(start, Some(colour)); CORNER_DWELL]);
    for (i, pair) in points.windows(2).enumerate() {
        dots.extend(steps(pair[0], pair[1], LIT_STEP).map(|p| (p, Some(colour))));
        let next = points.get(i + 2);
        if next.is_some_and(|&next| is_corner(pair[0], pair[1], next)) {
            dots.extend([(pair[1], Some(colour)); CORNER_DWELL - 1]);
        }
    }
    dots.extend([(end, Some(colour)); CORNER_DWELL - 1]);
    dots.extend([(end, None); DWELL]);
    dots
}

fn is_corner(before: Point, at: Point, after: Point) -> bool {
    let (way_in, out) = (at - before, after - at);
    atan2(way_in.cross(out), way_in.dot(out)).abs() >= CORNER_RAD
}

/// Equal steps from one point to another, without the first.
fn steps(from: Point, to: Point, longest: f64) -> impl Iterator<Item = Point> {
    const MOST: f64 = 1e4; // what lies so far out is cut off at the edge anyway
    let n = (from.distance(to) / longest).ceil().clamp(1.0, MOST) as usize;
    (1..=n).map(move |i| from.lerp(to, i as f64 / n as f64))
}

/// 32 bytes before the points of a frame.
fn header(points: usize, number: usize, frames: usize) -> [u8; 32] {
    let mut header = [0; 32];
    let short = |value: usize| u16::try_from(value).unwrap_or(u16::MAX).to_be_bytes();
    header[..4].copy_from_slice(b"ILDA");
    header[7] = 5;
    header[8..16].copy_from_slice(b"strokes ");
    header[16..24].copy_from_slice(b"tracelgt");
    header[24..26].copy_from_slice(&short(points));
    header[26..28].copy_from_slice(&short(number));
    header[28..30].copy_from_slice(&short(frames));
    header
}

/// X, Y, status, blue, green, red.
fn record(&(point, colour): &Dot, is_last: bool) -> [u8; 8] {
    let coordinate = |v: f64| (v.round().clamp(-RANGE, RANGE) as i16).to_be_bytes();
    let ([x0, x1], [y0, y1]) = (coordinate(point.x), coordinate(point.y));
    let status = if is_last { LAST_POINT } else { 0 } | if colour.is_none() { BLANKED } else { 0 };
    let Colour { r, g, b } = colour.unwrap_or(Colour::BLACK);
    [x0, x1, y0, y1, status, b, g, r]
}
