//! Crumbs: small pale marks that a pencil leaves on the paper's grain beside its lines, and smudges.

use tracelight_image::{Plane, Region};
use tracelight_stroke::{Point, polyline_length};

use crate::row::Row;

/// Largest length of a crumb, in widths of the drawing's pen.
pub(crate) const LONGEST_PENS: f64 = 4.0;
/// Largest darkness of a crumb, as a share of the lines'. In six scanned sketches by others 7 % of the strokes are so short and pale,
/// and none of them was intended.
pub(crate) const PALE: f64 = 0.6;

/// What a pencil usually draws in one drawing, the mean over the length of its lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Usual {
    darkness: f64,
    /// Width, px.
    pen: f64,
}

impl Usual {
    /// In these rows.
    pub(crate) fn of(dark: &Plane<u8>, rows: &[Row]) -> Self {
        let lengths: Vec<f64> = rows.iter().map(|row| polyline_length(&row.points)).collect();
        let total = lengths.iter().sum::<f64>().max(1e-9);
        let mean = |of: &dyn Fn(&Row) -> f64| {
            rows.iter().zip(&lengths).map(|(row, length)| of(row) * length).sum::<f64>() / total
        };
        Self { darkness: mean(&|row| darkness(dark, row)), pen: mean(&|row| row.width) }
    }

    /// Whether a row is a crumb.
    pub(crate) fn is_crumb(&self, dark: &Plane<u8>, row: &Row) -> bool {
        !row.closed && self.is_little(polyline_length(&row.points), darkness(dark, row))
    }

    /// Whether a filled shape is one.
    pub(crate) fn is_smudge(&self, dark: &Plane<u8>, shape: &Region) -> bool {
        let (width, height) = shape.extent();
        let centres = shape.places().map(|(x, y)| Point::new(x as f64 + 0.5, y as f64 + 0.5));
        self.is_little(width.max(height) as f64, dark.mean_at(centres))
    }

    fn is_little(&self, length: f64, darkness: f64) -> bool {
        length < LONGEST_PENS * self.pen && darkness < PALE * self.darkness
    }
}

fn darkness(dark: &Plane<u8>, row: &Row) -> f64 {
    dark.mean_at(row.points.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_short_and_pale_is_a_crumb_and_what_is_long_dark_or_closed_is_none() {
        // a line, a pale line, a dark mark, a pale one, and a pale ring
        let drawn = [(90, 200), (60, 80), (8, 180), (8, 80), (8, 80)];
        let mut dark = Plane::filled(100, 60, 0);
        let mut row = |k: usize, (length, level): (usize, u8)| {
            (8 + 10 * k..12 + 10 * k).for_each(|y| dark.row_mut(y)[2..6 + length].fill(level));
            let points = (4..=4 + length).map(|x| Point::new(x as f64, 10.0 + 10.0 * k as f64)).collect();
            Row { points, closed: k == 4, width: 3.0, free: [true; 2], dot: false }
        };
        let rows: Vec<Row> = drawn.iter().enumerate().map(|(k, &drawn)| row(k, drawn)).collect();
        let usual = Usual::of(&dark, &rows);
        let (crumbs, kept): (Vec<Row>, Vec<Row>) =
            rows.into_iter().partition(|row| usual.is_crumb(&dark, row));
        let at = |rows: &[Row]| rows.iter().map(|row| row.points[0].y).collect::<Vec<_>>();
        assert_eq!((at(&kept), at(&crumbs)), (vec![10.0, 20.0, 30.0, 50.0], vec![40.0]));
        // a small pale patch is a smudge, a dark one and a large one are shapes
        for (columns, level, is_smudge) in [(80..90, 70, true), (80..90, 200, false), (60..98, 70, false)] {
            let mut patch = Plane::filled(100, 60, 0);
            (4..12).for_each(|y| patch.row_mut(y)[columns.clone()].fill(level));
            let shapes = tracelight_image::regions(&tracelight_image::threshold::over(&patch, 0));
            assert_eq!(usual.is_smudge(&patch, &shapes[0]), is_smudge, "{columns:?} {level}");
        }
    }
}
