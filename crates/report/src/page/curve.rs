use std::fmt::Write;

use super::axis::Axis;
use super::cells::Cells;

/// Side of a plot's own coordinates; it is stretched to whatever room the page has.
pub(super) const SIDE: f64 = 1000.0;
/// Columns a curve is thinned to.
const COLUMNS: f64 = 1000.0;
/// Columns of a band: about the pixels of a diagram that has another beside it.
const BAND_COLUMNS: f64 = 500.0;

/// What a column of a curve holds: two values, in the order they came.
#[derive(Clone, Copy)]
struct Column {
    number: i64,
    low: (u32, f64),
    high: (u32, f64),
    count: u32,
}

/// A curve over time.
pub(super) struct Curve {
    /// Path data of the whole.
    pub(super) path: String,
    /// Its values, for who looks closer.
    pub(super) cells: Cells,
}

/// A curve over time.
pub(super) fn curve(points: impl Iterator<Item = (f64, Option<f64>)>, x: &Axis, y: &Axis) -> Curve {
    let points: Vec<_> = points.collect();
    Curve { path: path(points.iter().copied(), x, y), cells: Cells::new(&points, x, y) }
}

/// A band from the lowest to the highest of its values, and their mean: what swings faster than pixels follow each other.
pub(super) struct Band {
    /// The band, with the values.
    pub(super) spread: Curve,
    /// Path data of the mean.
    pub(super) mean: String,
}

/// A band over time; a `None` ends a piece of it.
pub(super) fn band(points: impl Iterator<Item = (f64, Option<f64>)>, x: &Axis, y: &Axis) -> Band {
    let points: Vec<_> = points.map(|(at, value)| (at, value.filter(|v| v.is_finite()))).collect();
    let (mut path, mut mean) = (String::new(), String::new());
    let column = |at: f64| (x.share(at) * BAND_COLUMNS).floor() as i64;
    let height = |value: f64| tenth((1.0 - y.share(value)) * SIDE);
    for piece in points.chunk_by(|a, b| a.1.is_some() == b.1.is_some()).filter(|piece| piece[0].1.is_some()) {
        let mut back = Vec::new();
        for run in piece.chunk_by(|a, b| column(a.0) == column(b.0)) {
            let at = tenth(column(run[0].0) as f64 * SIDE / BAND_COLUMNS);
            let values = || run.iter().filter_map(|p| p.1);
            let letter = if back.is_empty() { 'M' } else { 'L' };
            // writing to a String cannot fail
            let _ = write!(mean, "{letter}{at} {}", height(values().sum::<f64>() / run.len() as f64));
            let _ = write!(path, "{letter}{at} {}", height(values().fold(f64::NEG_INFINITY, f64::max)));
            back.push(format!("L{at} {}", height(values().fold(f64::INFINITY, f64::min))));
        }
        path.extend(back.into_iter().rev());
        path.push('Z');
    }
    Band { spread: Curve { path, cells: Cells::new(&points, x, y) }, mean }
}

/// SVG path data of a curve over time, thinned so that no peak is lost: each column keeps its lowest and its highest
/// value. A `None` lifts the pen.
fn path(points: impl Iterator<Item = (f64, Option<f64>)>, x: &Axis, y: &Axis) -> String {
    let mut out = String::new();
    let mut column: Option<Column> = None;
    let mut pen_down = false;
    for (at, value) in points {
        let number = (x.share(at) * COLUMNS).floor() as i64;
        let Some(value) = value.filter(|v| v.is_finite()) else {
            finish(&mut out, column.take(), &mut pen_down, y);
            pen_down = false;
            continue;
        };
        match &mut column {
            Some(c) if c.number == number => c.add(value),
            _ => {
                finish(&mut out, column.take(), &mut pen_down, y);
                column = Some(Column { number, low: (0, value), high: (0, value), count: 1 });
            }
        }
    }
    finish(&mut out, column, &mut pen_down, y);
    out
}

impl Column {
    fn add(&mut self, value: f64) {
        if value < self.low.1 {
            self.low = (self.count, value);
        }
        if value > self.high.1 {
            self.high = (self.count, value);
        }
        self.count += 1;
    }
}

/// Draws a column's values.
fn finish(out: &mut String, column: Option<Column>, pen_down: &mut bool, y: &Axis) {
    let Some(c) = column else { return };
    let (first, second) = if c.low.0 <= c.high.0 { (c.low, c.high) } else { (c.high, c.low) };
    let at = c.number as f64 * SIDE / COLUMNS;
    let mut point = |value: f64, at: f64| {
        let letter = if std::mem::replace(pen_down, true) { 'L' } else { 'M' };
        let height = tenth((1.0 - y.share(value)) * SIDE);
        // writing to a String cannot fail
        let _ = write!(out, "{letter}{} {height}", tenth(at));
    };
    point(first.1, at);
    if first.0 != second.0 {
        point(second.1, at + 0.5);
    }
}

/// One decimal, no idle zero.
pub(super) fn tenth(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// Spans where something holds, as path data of rectangles from edge to edge; gaps no wider than a column close up.
pub(super) fn bands(points: impl Iterator<Item = (f64, bool)>, x: &Axis) -> String {
    strip(points, x, [0.0, SIDE])
}

/// The same, only between two heights, from the top down.
pub(super) fn strip(points: impl Iterator<Item = (f64, bool)>, x: &Axis, heights: [f64; 2]) -> String {
    let mut out = String::new();
    let mut open: Option<(f64, f64)> = None;
    for (at, holds) in points {
        let place = x.share(at) * SIDE;
        open = match (open, holds) {
            (None, true) => Some((place, place)),
            (Some((from, _)), true) => Some((from, place)),
            (Some((from, to)), false) if place - to > SIDE / COLUMNS => {
                rectangle(&mut out, from, to, heights);
                None
            }
            (open, _) => open,
        };
    }
    if let Some((from, to)) = open {
        rectangle(&mut out, from, to, heights);
    }
    out
}

fn rectangle(out: &mut String, from: f64, to: f64, [top, bottom]: [f64; 2]) {
    let _ = write!(out, "M{} {top}H{}V{bottom}H{}Z", tenth(from), tenth(to), tenth(from));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_curve_keeps_its_peaks_and_is_short() {
        let x = Axis::new(0.0, 100.0, 5);
        let y = Axis::new(-1.0, 3.0, 4);
        let spike = |i: u32| if i == 77_777 { 3.0 } else { f64::from(i % 2) };
        let path = path((0..100_000).map(|i| (f64::from(i) * 1e-3, Some(spike(i)))), &x, &y);
        assert!(path.contains(" 0L"), "the spike reaches the top");
        assert!(path.matches(['M', 'L']).count() <= 2002);
        assert_eq!(path.matches('M').count(), 1);
    }

    #[test]
    fn a_gap_lifts_the_pen() {
        let x = Axis::new(0.0, 3.0, 3);
        let y = Axis::new(0.0, 1.0, 2);
        let points =
            [(0.0, Some(0.0)), (1.0, Some(1.0)), (1.5, None), (2.0, Some(1.0)), (3.0, Some(f64::NAN))];
        assert_eq!(path(points.into_iter(), &x, &y), "M0 1000L333 0M666 0");
    }

    #[test]
    fn a_band_reaches_from_the_lowest_to_the_highest() {
        let (x, y) = (Axis::new(0.0, 1.0, 3), Axis::new(0.0, 1.0, 2));
        let swings = band((0..1000).map(|i| (f64::from(i) * 1e-3, Some(f64::from(i % 2)))), &x, &y);
        assert!(
            swings.spread.path.starts_with("M0 0L2 0") && swings.spread.path.ends_with("L2 1000L0 1000Z")
        );
        assert!(swings.mean.starts_with("M0 500L2 500"));
    }

    #[test]
    fn bands_cover_what_holds() {
        let x = Axis::new(0.0, 10.0, 5);
        let points = (0..=10).map(|i| (f64::from(i), (2..5).contains(&i) || i > 8));
        assert_eq!(bands(points, &x), "M200 0H400V1000H200ZM900 0H1000V1000H900Z");
    }
}
