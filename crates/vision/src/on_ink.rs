//! Cuts a line where it leaves its ink for longer than the widest gap.
//!
//! The reverse of `missed`, and the last word: whatever joined two lines, what lies between them must be ink, or a gap
//! that a pen may have left. Only what `twice` makes of two passes comes later, and lies between their ink.

use tracelight_image::Mask;
use tracelight_stroke::Point;

use crate::gap;
use crate::row::Row;

/// The rows without their ways over paper, and the length of what was cut, px.
pub(crate) fn only(ink: &Mask, rows: Vec<Row>) -> (Vec<Row>, f64) {
    let mut cut_px = 0.0;
    let mut kept = Vec::with_capacity(rows.len());
    for row in rows {
        let most = gap::widest_paper(row.width);
        let stray = stray_steps(ink, &row, most);
        if stray.is_empty() {
            kept.push(row);
            continue;
        }
        cut_px += stray.iter().map(|&k| step(&row, k).0.distance(step(&row, k).1)).sum::<f64>();
        kept.extend(pieces(row, &stray));
    }
    (kept, cut_px)
}

/// From one point of a row to the next; of a closed one also from the last to the first.
fn step(row: &Row, k: usize) -> (Point, Point) {
    (row.points[k], row.points[(k + 1) % row.points.len()])
}

/// The steps that belong to a way over paper of more than `most` px.
fn stray_steps(ink: &Mask, row: &Row, most: f64) -> Vec<usize> {
    let steps = if row.closed { row.points.len() } else { row.points.len().saturating_sub(1) };
    let mut stray = Vec::new();
    let (mut bare_px, mut first) = (0.0, 0);
    for k in 0..steps {
        let (from, to) = step(row, k);
        let length = from.distance(to);
        let count = length.ceil().max(1.0) as usize;
        for i in 0..count {
            let at = from.lerp(to, (i as f64 + 0.5) / count as f64);
            if is_near(ink, at) {
                bare_px = 0.0;
                first = k;
            } else {
                bare_px += length / count as f64;
            }
            if bare_px > most {
                let new = stray.last().map_or(first, |&last: &usize| first.max(last + 1));
                stray.extend(new..=k);
            }
        }
    }
    stray
}

/// Whether there is ink at most a pixel beside a place.
fn is_near(ink: &Mask, at: Point) -> bool {
    let (x, y) = (at.x.floor() as isize, at.y.floor() as isize);
    ink.get(x, y) || (-1..=1).any(|down| (-1..=1).any(|across| ink.get(x + across, y + down)))
}

/// What is left of a row without these steps: each piece at least a step long.
fn pieces(row: Row, stray: &[usize]) -> Vec<Row> {
    let n = row.points.len();
    // a closed row is opened behind its last stray step, an open one begins where it begins
    let start = if row.closed { stray[stray.len() - 1] + 1 } else { 0 };
    let order: Vec<usize> = (0..n).map(|k| (start + k) % n).collect();
    let parts = order.chunk_by(|&a, _| !stray.contains(&a));
    let long = parts.filter(|part| part.len() > 1);
    let piece = |part: &[usize]| {
        let is_own = |end: usize, k: usize| !row.closed && k == end * (n - 1);
        let free = [is_own(0, part[0]), is_own(1, part[part.len() - 1])];
        let points = part.iter().map(|&k| row.points[k]).collect();
        Row { points, closed: false, free: [row.free[0] || !free[0], row.free[1] || !free[1]], ..row.clone() }
    };
    long.map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(points: &[(f64, f64)], closed: bool) -> Row {
        let points = points.iter().map(|&p| p.into()).collect();
        Row { points, closed, width: 4.0, free: [true; 2], dot: false }
    }

    /// Ink 4 px wide along y = 20, from 10 to 90 but for 40 to 60.
    fn ink(gap: std::ops::Range<usize>) -> Mask {
        let mut ink = Mask::empty(100, 100);
        (18..22).for_each(|y| {
            ink.fill(y, 10, gap.start);
            ink.fill(y, gap.end, 90);
        });
        ink
    }

    #[test]
    fn a_way_over_paper_is_cut_and_a_pens_gap_is_not() {
        let line = || vec![row(&[(12.0, 20.0), (38.0, 20.0), (62.0, 20.0), (88.0, 20.0)], false)];
        let (kept, cut_px) = only(&ink(40..60), line());
        assert_eq!(kept.len(), 2, "{kept:?}");
        assert!((cut_px - 24.0).abs() < 1e-9 && kept.iter().all(|r| r.points.len() == 2 && !r.closed));
        assert_eq!(only(&ink(48..52), line()), (line(), 0.0));
    }

    #[test]
    fn a_closed_row_is_opened_where_it_strays() {
        let round = row(&[(12.0, 20.0), (50.0, 20.0), (88.0, 20.0), (50.0, 80.0)], true);
        let (kept, _) = only(&ink(50..50), vec![round]);
        assert_eq!(kept.len(), 1);
        assert_eq!(kept[0].points, row(&[(12.0, 20.0), (50.0, 20.0), (88.0, 20.0)], false).points);
    }
}
