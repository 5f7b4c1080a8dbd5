//! Marks that a pencil leaves on the paper's grain beside its lines: short, and paler than what it draws.

use tracelight_stroke::polyline_length;

use crate::centreline::Row;
use crate::plane::Plane;

/// A crumb is shorter than this, in widths of the drawing's pen,
pub(crate) const LONGEST_PENS: f64 = 4.0;
/// and has less than this share of the lines' darkness. Of six sketches that others scanned 7 % of the strokes are so short and pale,
/// and none of them was meant.
pub(crate) const PALE: f64 = 0.6;

/// The rows that were drawn, and the crumbs beside them.
pub(crate) fn parted(dark: &Plane<u8>, rows: Vec<Row>) -> (Vec<Row>, Vec<Row>) {
    let lengths: Vec<f64> = rows.iter().map(|row| polyline_length(&row.points)).collect();
    let darkness = |row: &Row| dark.mean_at(row.points.iter().copied());
    let darknesses: Vec<f64> = rows.iter().map(darkness).collect();
    let widths: Vec<f64> = rows.iter().map(|row| row.width).collect();
    let total = lengths.iter().sum::<f64>().max(1e-9);
    // over the length of the lines
    let mean =
        |values: &[f64]| values.iter().zip(&lengths).map(|(v, length)| v * length).sum::<f64>() / total;
    let (usual, pen) = (mean(&darknesses), mean(&widths));
    let is_crumb =
        |k: usize| !rows[k].closed && lengths[k] < LONGEST_PENS * pen && darknesses[k] < PALE * usual;
    let crumbs: Vec<bool> = (0..rows.len()).map(is_crumb).collect();
    let mut crumbs = crumbs.into_iter();
    rows.into_iter().partition(|_| crumbs.next() == Some(false))
}

#[cfg(test)]
mod tests {
    use tracelight_stroke::Point;

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
        let (kept, crumbs) = parted(&dark, rows);
        let at = |rows: &[Row]| rows.iter().map(|row| row.points[0].y).collect::<Vec<_>>();
        assert_eq!((at(&kept), at(&crumbs)), (vec![10.0, 20.0, 30.0, 50.0], vec![40.0]));
    }
}
