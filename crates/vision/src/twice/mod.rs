//! Merges lines that were sketched twice.
//!
//! Who sketches with a pencil goes over a line again, a little beside it. Where two rows run side by side, nearer to each other than two
//! lines would be drawn, both are passes of one line: between them, nearer to the darker one. Either the slit between them is no paper,
//! and one of them begins or ends there; or they touch, and wherever they part again one of them ends. Only in a sketch: with a pen two
//! lines beside each other, at a few degrees too, are two. A sketch shows by its lines, which are darker here and paler there, along
//! their way and one beside the other. Hatches, of which a third one is beside, stay.

use tracelight_image::Plane;
use tracelight_image::median::median;
use tracelight_stroke::polyline_length;

use self::sketch::{APART_PENS, Sketch};
use crate::line::parted;
use crate::row::Row;

mod fold;
mod merge;
mod pencil;
mod place;
mod sketch;

/// From point to point of a row that is looked at, px.
const STEP_PX: f64 = 1.0;
/// So often what was made of two rows is looked at again.
const ROUNDS: usize = 6;

/// A drawing's rows, each line once.
#[derive(Default)]
pub(crate) struct Once {
    pub(crate) rows: Vec<Row>,
    /// How the rows lay before, if it is a sketch; none of other drawings.
    pub(crate) before: Vec<Row>,
    /// Length of what was drawn again, px.
    pub(crate) again_px: f64,
}

/// The rows of which those that were drawn twice are one.
pub(crate) fn once(dark: &Plane<u8>, rows: Vec<Row>) -> Once {
    let pen = median(&rows.iter().filter(|row| !row.dot).map(|row| row.width).collect::<Vec<_>>());
    if pen <= 0.0 || !pencil::is_sketched(dark, &rows) {
        return Once { rows, ..Once::default() };
    }
    let before = rows.clone();
    let mut rows = fold::folded(dark, rows.into_iter().map(evenly).collect(), pen);
    for _ in 0..ROUNDS {
        let mut runs = Sketch::of(dark, &rows, pen).runs();
        if runs.is_empty() {
            break;
        }
        runs.sort_by(|a, b| b.length.total_cmp(&a.length));
        let mut is_taken = vec![false; rows.len()];
        for run in runs {
            if is_taken[run.kept] || is_taken[run.other] {
                continue;
            }
            (is_taken[run.kept], is_taken[run.other]) = (true, true);
            run.merge(dark, &mut rows, APART_PENS * pen);
        }
        rows.retain(|row| row.points.len() > 1);
    }
    Once { again_px: (length(&before) - length(&rows)).max(0.0), rows, before }
}

fn length(rows: &[Row]) -> f64 {
    rows.iter().map(|row| polyline_length(&row.points)).sum()
}

/// A row whose points follow each other as closely as they are looked at.
fn evenly(row: Row) -> Row {
    Row { points: parted(&row.points, row.closed, |far| (far / STEP_PX).ceil() as usize), ..row }
}

#[cfg(test)]
mod tests {
    use tracelight_stroke::Point;

    use super::*;

    /// How much the sketch is turned, px down a px across: no hand draws along the rows.
    const DOWN: f64 = 0.08;

    fn turned(p: &Point, down: f64) -> Point {
        Point::new(p.x, p.y + down * (p.x - 20.0))
    }

    /// A plane on which these lines are 2 px wide, as dark as the way along them says, and the slit between y = 44 and 48.
    fn sketched(lines: &[Vec<Point>], slit: u8) -> (Plane<u8>, Vec<Row>) {
        let mut plane = Plane::filled(200, 140, 0_u8);
        let lines: Vec<Vec<Point>> =
            lines.iter().map(|line| line.iter().map(|p| turned(p, DOWN)).collect()).collect();
        for (number, line) in lines.iter().enumerate() {
            for (k, p) in line.iter().enumerate() {
                let level = 60.0 + 15.0 * number as f64 + 30.0 * (k as f64 / 9.0).sin();
                for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, y) = ((p.x - 1.0) as usize + x, (p.y - 1.0) as usize + y);
                    plane.row_mut(y)[x] = level as u8;
                }
            }
        }
        for (x, y) in (20..180).flat_map(|x| (44..48).map(move |y| (x, y))) {
            let y = turned(&Point::new(x.into(), y.into()), DOWN).y as usize;
            let level = &mut plane.row_mut(y)[x as usize];
            *level = (*level).max(slit);
        }
        let row = |points: Vec<Point>| Row { points, closed: false, width: 2.5, free: [true; 2], dot: false };
        (plane, lines.into_iter().map(row).collect())
    }

    fn level(from: f64, to: f64, y: f64) -> Vec<Point> {
        (0..=(to - from) as usize).map(|k| Point::new(from + k as f64, y)).collect()
    }

    /// What becomes of these lines, beside four others.
    fn sketched_as(lines: &[Vec<Point>], slit: u8) -> Vec<Row> {
        let others = (0..4).map(|k| level(20.0, 180.0, 70.0 + 12.0 * f64::from(k)));
        let (plane, rows) = sketched(&lines.iter().cloned().chain(others).collect::<Vec<_>>(), slit);
        let mut rows = once(&plane, rows).rows;
        rows.iter_mut().flat_map(|row| &mut row.points).for_each(|p| *p = turned(p, -DOWN));
        rows.retain(|row| row.points[0].y < 65.0);
        rows
    }

    /// A line that bows away from a level one by so much between two places.
    fn bow(from: f64, to: f64, y: f64, by: f64) -> Vec<Point> {
        let aside = |x: f64| by * ((x - from) / (to - from) * std::f64::consts::PI).sin();
        level(from, to, y).into_iter().map(|p| Point::new(p.x, p.y + aside(p.x))).collect()
    }

    #[test]
    fn a_pencils_line_gone_over_again_is_one_line_between_both() {
        let rows = sketched_as(&[level(20.0, 180.0, 44.0), level(40.0, 150.0, 48.0)], 30);
        assert_eq!(rows.len(), 1);
        let at = |x: f64| rows[0].points.iter().find(|p| (p.x - x).abs() < 0.51).map_or(0.0, |p| p.y);
        assert!(
            (at(100.0) - 46.0).abs() < 0.7 && (at(22.0) - 44.0).abs() < 0.1,
            "{} {}",
            at(100.0),
            at(22.0)
        );
    }

    #[test]
    fn passes_with_paper_between_them_are_one_line() {
        // one that leaves the line and comes back to it, one that ends beside it, and one that runs beside it from end to end
        let line = level(20.0, 180.0, 44.0);
        for pass in [bow(50.0, 150.0, 44.0, 5.0), level(20.0, 110.0, 49.0), bow(20.0, 180.0, 44.0, 5.0)] {
            assert_eq!(sketched_as(&[line.clone(), pass], 0).len(), 1);
        }
    }

    #[test]
    fn lines_that_end_side_by_side_and_lines_that_cross_are_two() {
        let slope: Vec<Point> =
            (20..=180).map(|x| Point::new(x.into(), 30.0 + 0.2 * f64::from(x - 20))).collect();
        for other in [level(20.0, 180.0, 49.0), slope, bow(20.0, 180.0, 60.0, -16.0)] {
            assert_eq!(sketched_as(&[level(20.0, 180.0, 44.0), other], 0).len(), 2);
        }
    }

    #[test]
    fn a_line_that_comes_back_beside_itself_ends_where_it_turns() {
        let round = |k: usize| {
            let angle = std::f64::consts::PI * (k as f64 / 8.0 - 0.5);
            Point::new(150.0 + 2.5 * angle.cos(), 46.5 + 2.5 * angle.sin())
        };
        let back: Vec<Point> = level(60.0, 150.0, 49.0).into_iter().rev().collect();
        let there: Vec<Point> = [level(20.0, 149.0, 44.0), (0..8).map(round).collect(), back].concat();
        let rows = sketched_as(&[there], 0);
        assert_eq!(rows.len(), 1);
        let furthest = rows[0].points.iter().map(|p| p.x).fold(0.0, f64::max);
        assert!(rows[0].points[0].x == 20.0 && (150.0..154.0).contains(&furthest), "{furthest}");
        assert!(polyline_length(&rows[0].points) < 140.0);
    }

    #[test]
    fn hatching_stays() {
        let hatches: Vec<_> =
            (0..6).map(|k| level(20.0 + 9.0 * f64::from(k % 2), 180.0, 14.0 + 5.0 * f64::from(k))).collect();
        assert_eq!(sketched_as(&hatches, 0).len(), 6);
    }
}
