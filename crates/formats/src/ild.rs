//! ILDA image data, format 5 (2D, true colour), for show projectors: *The ILDA Image Data Transfer Format
//! Specification*, revision 011 (2014).
//!
//! A frame is a list of points that the scanners jump to at an even pace; lines are what they draw on the way. So
//! points are set close enough that the way is straight, and repeated where the mirrors must come to rest.

use tracelight_stroke::{Affine, Colour, Drawing, Path, Point, turn_rad};

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

/// Points of a frame at most, its way back left out: its header counts them in 16 bits, and the way across the whole
/// range is 31 dark steps.
const MOST_OWN_POINTS: usize = 65_535 - 2 * (31 + DWELL);

/// Status bits.
const LAST_POINT: u8 = 0x80;
const BLANKED: u8 = 0x40;

/// A point of a frame; `None` is dark.
type Dot = (Point, Option<Colour>);

/// A drawing as frames for a projector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Show {
    /// The file.
    pub bytes: Vec<u8>,
    /// How many frames it has.
    pub frames: usize,
    /// How many points its largest frame has.
    pub most_points: usize,
}

/// A drawing on the target (metres, y up, origin at the centre) as an ILDA file: the sheet's larger side spans the whole
/// range, strokes in tracing order and in their colour (white without one; black, which is ink, is white light).
///
/// A player shows a frame again and again, and one after the other: each begins and ends at the same place, the start of
/// the first stroke, and goes back there in dark steps.
///
/// One frame, unless it would have more than 65 535 points: then a new one begins at a stroke, or within one that is
/// longer than that.
#[must_use]
pub fn write(drawing: &Drawing, width_m: f64, height_m: f64) -> Show {
    let larger = width_m.max(height_m);
    let scale = if larger > 0.0 { 2.0 * RANGE / larger } else { 1.0 };
    let frames = frames(&drawing.transformed(Affine::scale(scale)));
    let mut bytes = Vec::new();
    for (number, dots) in frames.iter().enumerate() {
        bytes.extend(header(dots.len(), number, frames.len()));
        for (i, dot) in dots.iter().enumerate() {
            bytes.extend(record(dot, i + 1 == dots.len()));
        }
    }
    // no points: the end of the file
    bytes.extend(header(0, frames.len(), frames.len()));
    Show { bytes, frames: frames.len(), most_points: frames.iter().map(Vec::len).max().unwrap_or(0) }
}

fn frames(drawing: &Drawing) -> Vec<Vec<Dot>> {
    let Some(first) = drawing.strokes.first() else { return Vec::new() };
    let mut frames = Frames { home: within(first.path.start()), done: Vec::new(), frame: Vec::new() };
    for stroke in &drawing.strokes {
        let colour = stroke.colour.filter(|&c| c != Colour::BLACK).unwrap_or(Colour::WHITE);
        let dots = dots(&stroke.path, colour);
        if frames.frame.len() + dots.len() > MOST_OWN_POINTS && !frames.frame.is_empty() {
            frames.close();
        }
        frames.go_to(stroke.path.start());
        for dot in dots {
            if frames.frame.len() >= MOST_OWN_POINTS {
                frames.close();
                frames.go_to(dot.0);
            }
            frames.frame.push((within(dot.0), dot.1));
        }
    }
    frames.close();
    frames.done
}

/// Frames that are done, and one that grows.
struct Frames {
    /// Where each begins and ends.
    home: Point,
    done: Vec<Vec<Dot>>,
    frame: Vec<Dot>,
}

impl Frames {
    /// Goes to a place in the dark and comes to rest there.
    fn go_to(&mut self, place: Point) {
        let place = within(place);
        let at = self.frame.last().map_or(self.home, |dot| dot.0);
        if self.frame.is_empty() {
            self.frame.push((self.home, None));
        }
        self.frame.extend(steps(at, place, DARK_STEP).map(|p| (p, None)));
        self.frame.extend([(place, None); DWELL]);
    }

    /// Ends a frame where it began.
    fn close(&mut self) {
        self.go_to(self.home);
        self.done.push(std::mem::take(&mut self.frame));
    }
}

/// The nearest place within the range.
fn within(p: Point) -> Point {
    Point::new(p.x.clamp(-RANGE, RANGE), p.y.clamp(-RANGE, RANGE))
}

/// A stroke, from its start, where the mirrors rest, to its end.
fn dots(path: &Path, colour: Colour) -> Vec<Dot> {
    let points = path.flatten(TOLERANCE);
    let (start, end) = (path.start(), path.end());
    let mut dots: Vec<Dot> = vec![(start, Some(colour)); CORNER_DWELL];
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
    turn_rad(at - before, after - at) >= CORNER_RAD
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
