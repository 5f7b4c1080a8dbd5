//! Decides whether lines are a pencil sketch.

use tracelight_image::Plane;
use tracelight_image::median::median;
use tracelight_stroke::polyline_length;

use super::place::{places, way_at};
use crate::row::Row;

/// Along a pencil's line its middle varies by more than this share of its usual darkness, and so does all that a cut across it has; from
/// line to line it varies by more than that: measured from the 15th to the 85th percentile. Of 230 public pictures sketches have at
/// least 0.22, 0.41 and 0.14. Pens have up to 0.3 at their middle where they are thin, and then less across; of what has both most are
/// crayons, markers that run dry, and hairs that taper.
const VARIES_ALONG: f64 = 0.15;
const VARIES_ACROSS: f64 = 0.38;
const VARIES_BETWEEN: f64 = 0.06;
/// Fewer points tell no variation, and fewer lines none between them.
const LEAST_POINTS: usize = 12;
const LEAST_ROWS: usize = 3;
/// Half of the way is in lines of so many widths at least: sketches have 27 and more, pages of printed letters up to 8.
const LONG_WIDTHS: f64 = 15.0;
/// Places that lead along rows or columns within this angle, rad, are no more than this share: programs' plans have half and more.
const ON_THE_GRID: f64 = 0.03;
const MOST_ON_THE_GRID: f64 = 0.5;
/// A cut across has so many places, and reaches so far beyond the line, px.
const CUT: usize = 9;
const BEYOND_PX: f64 = 1.0;

/// Whether the lines are a pencil's, whose darkness varies along them and from one to the other, and no letters and no program's.
pub(super) fn is_sketched(dark: &Plane<u8>, rows: &[Row]) -> bool {
    let long: Vec<&Row> = rows.iter().filter(|row| row.points.len() >= LEAST_POINTS).collect();
    let middles = |row: &&Row| varies(row.points.iter().map(|&p| dark.at(p)).collect());
    let (along, levels): (Vec<f64>, Vec<f64>) = long.iter().map(middles).unzip();
    let is_varied =
        long.len() >= LEAST_ROWS && median(&along) > VARIES_ALONG && varies(levels).0 > VARIES_BETWEEN;
    let across = |row: &&Row| varies((0..row.points.len()).map(|k| strength(dark, row, k)).collect()).0;
    is_varied
        && usual_length(rows) > LONG_WIDTHS
        && on_the_grid(&long) < MOST_ON_THE_GRID
        && median(&long.iter().map(across).collect::<Vec<_>>()) > VARIES_ACROSS
}

/// All the darkness that a cut across a row at one of its points has.
pub(super) fn strength(dark: &Plane<u8>, row: &Row, number: usize) -> f64 {
    let reach = way_at(&row.points, number).turn_90() * (0.5 * row.width + BEYOND_PX);
    let at = |i: usize| row.points[number] + reach * (2.0 * i as f64 / (CUT - 1) as f64 - 1.0);
    (0..CUT).map(|i| dark.at(at(i))).sum()
}

/// From the 15th to the 85th percentile of some levels, as a share of their median, and that.
fn varies(mut levels: Vec<f64>) -> (f64, f64) {
    levels.sort_unstable_by(f64::total_cmp);
    let at = |percent: usize| levels[(levels.len() - 1) * percent / 100];
    ((at(85) - at(15)) / at(50).max(1.0), at(50))
}

/// Half of the way is in rows of this length and longer, widths of the pen.
fn usual_length(rows: &[Row]) -> f64 {
    let mut lengths: Vec<f64> = rows.iter().map(|row| polyline_length(&row.points)).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let mut left = 0.5 * lengths.iter().sum::<f64>();
    let usual = lengths.into_iter().find(|length| {
        left -= length;
        left <= 0.0
    });
    let widths: Vec<f64> = rows.iter().map(|row| row.width).collect();
    usual.map_or(0.0, |length| length / median(&widths).max(1e-9))
}

/// Which share of the places of some rows lead along the picture's rows or columns.
fn on_the_grid(rows: &[&Row]) -> f64 {
    let (mut on, mut all) = (0_u32, 0_u32);
    for place in rows.iter().flat_map(|row| places(0, row)) {
        all += 1;
        on += u32::from(place.way.x.abs().min(place.way.y.abs()) < ON_THE_GRID);
    }
    f64::from(on) / f64::from(all.max(1))
}
