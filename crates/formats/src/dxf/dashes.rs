//! Paths cut into the dashes of a linetype.

use tracelight_stroke::{Measured, Path};

/// Dashes of one path at most; a line of more is drawn whole.
const MOST_DASHES: f64 = 5_000.0;

/// Length of a dot of a linetype, as a share of the whole pattern.
const DOT: f64 = 0.02;

/// Error of lengths along cubics, as a share of the whole pattern.
const TOLERANCE: f64 = 1e-4;

/// What a linetype makes of a path.
pub(super) enum Dashed {
    /// Shorter than the pattern: the line is drawn whole, as CAD programs do.
    Whole,
    /// More dashes than are drawn.
    TooFine,
    Parts(Vec<Path>),
}

/// The dashes of a path: half of the first dash or more at either end, the pattern between, what is left over shared
/// out to both ends (AutoCAD's alignment A). Corners do not begin the pattern again. `lengths` are the linetype's:
/// dashes positive, gaps negative, dots zero.
pub(super) fn dashed(path: &Path, lengths: &[f64], scale: f64) -> Dashed {
    let period = scale * lengths.iter().map(|l| l.abs()).sum::<f64>();
    if !(period > 0.0 && period.is_finite()) {
        return Dashed::Whole;
    }
    let tolerance = TOLERANCE * period;
    let measured = Measured::of(path, tolerance);
    let length = measured.length();
    let times = (length / period).floor();
    if times < 1.0 {
        return Dashed::Whole;
    }
    let lit = lengths.iter().filter(|&&l| l >= 0.0).count();
    if times * lit as f64 > MOST_DASHES {
        return Dashed::TooFine;
    }
    Dashed::Parts(measured.stretches(&spans(lengths, scale, [length, period])))
}

/// Where the dashes begin and end along a path of a length.
fn spans(lengths: &[f64], scale: f64, [length, period]: [f64; 2]) -> Vec<[f64; 2]> {
    let times = (length / period).floor();
    let slack = 0.5 * (length - times * period);
    let dot = DOT * period;
    // a pattern that begins with a gap, or a dot, is not split
    let half = 0.5 * scale * lengths.first().copied().unwrap_or(0.0).max(0.0);
    let mut spans = Vec::new();
    for time in 0..=times as usize {
        let mut at = slack - half + time as f64 * period;
        for (i, &own) in lengths.iter().enumerate() {
            let own_length = scale * own.abs();
            if own >= 0.0 {
                let from = if time == 0 && i == 0 && own > 0.0 { 0.0 } else { at };
                let is_last = i == 0 && time as f64 >= times && own > 0.0;
                let to = if is_last { length } else { at + own_length.max(dot) };
                let span = [from.max(0.0), to.min(length)];
                if span[0] < span[1] {
                    spans.push(span);
                }
            }
            at += own_length;
        }
    }
    spans
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::{Element, Point};

    fn drawn(path: &Path, lengths: &[f64], scale: f64) -> Vec<Path> {
        match dashed(path, lengths, scale) {
            Dashed::Parts(parts) => parts,
            Dashed::Whole => vec![path.clone()],
            Dashed::TooFine => Vec::new(),
        }
    }

    fn line(length: f64) -> Path {
        Path::polyline(&[Point::ORIGIN, Point::new(length, 0.0)], false).unwrap()
    }

    #[test]
    fn a_line_begins_and_ends_with_half_a_dash_or_more() {
        let found: Vec<[f64; 2]> =
            drawn(&line(34.0), &[10.0, -5.0], 1.0).iter().map(|p| [p.start().x, p.end().x]).collect();
        assert_eq!(found, [[0.0, 7.0], [12.0, 22.0], [27.0, 34.0]]);
        let dotted = drawn(&line(24.0), &[10.0, -5.0, 0.0, -5.0], 0.5);
        let lengths: Vec<f64> = dotted.iter().map(|p| p.length(1e-9)).collect();
        assert_eq!(lengths.len(), 5, "{lengths:?}");
        assert!((lengths[1] - 0.2).abs() < 1e-9 && (lengths[2] - 5.0).abs() < 1e-9, "{lengths:?}");
    }

    #[test]
    fn arcs_stay_arcs_and_corners_are_passed() {
        let mut path = line(12.0);
        path.push(Element::Arc { centre: Point::new(12.0, 10.0), sweep: 3.0 });
        let parts = drawn(&path, &[8.0, -4.0], 1.0);
        let lit: f64 = parts.iter().map(|p| p.length(1e-9)).sum();
        // three times 12 in 42: 3 × 8, and the 6 that are left over
        assert!((lit - 30.0).abs() < 1e-9, "{lit}");
        assert!(parts.iter().flat_map(Path::pieces).any(|p| matches!(p.element, Element::Arc { .. })));
        assert!(parts.iter().any(|p| p.elements().len() == 2), "one dash goes round the corner");
    }

    #[test]
    fn what_is_too_short_or_too_fine_stays_whole() {
        assert!(matches!(dashed(&line(14.0), &[10.0, -5.0], 1.0), Dashed::Whole));
        assert!(matches!(dashed(&line(14.0), &[0.0, -0.001], 1.0), Dashed::TooFine));
        assert!(matches!(dashed(&line(14.0), &[1.0, -1.0], f64::INFINITY), Dashed::Whole));
    }
}
