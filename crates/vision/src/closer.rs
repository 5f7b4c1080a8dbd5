//! Traces small figures at twice the resolution.
//!
//! A letter ten pixels high suffers from the pixel grid: its lines are three pixels apart, its corners are as long as its pen is wide, and a
//! pixel-by-pixel skeleton has no direction. Between the pixel centres the picture is smooth, so interpolation gains detail.

use tracelight_image::threshold::over;
use tracelight_image::{Mask, Plane, Region, regions};
use tracelight_stroke::Vec2;

use crate::centreline::{self, is_dot};
use crate::graph::Graph;
use crate::parts::graphs;
use crate::row::Row;

/// Largest width and height of a small figure, px.
const LARGEST_PX: usize = 64;
/// Widest and thinnest pen of a small figure, px. Enlarging a hair line shows no more than its pixels.
const WIDEST_PX: f64 = 5.0;
const THINNEST_PX: f64 = 2.0;
/// Where more of a figure, as a share, is too pale for the picture's threshold, its pixels are all that tells what is ink.
const MOST_PALE: f64 = 0.02;
/// Pixels round a figure that tell where its edges and its ends are.
const ROUND_PX: usize = 8;
/// Fewer pixels of the closer look than this are none of a figure's, unless they are all of it.
const LEAST_PX: usize = 24;

/// The rows of a small figure of the picture's ink, which ends at `threshold`; `None` of others.
pub(crate) fn rows(
    dark: &Plane<u8>,
    threshold: u8,
    (ink, shapes): (&Mask, &Mask),
    (region, graph): (&Region, &Graph),
) -> Option<Vec<Row>> {
    let (width, height) = region.extent();
    let pen = 2.0 * graph.pen_radius();
    let is_small = width.max(height) <= LARGEST_PX && (THINNEST_PX..=WIDEST_PX).contains(&pen);
    // what the picture's border cuts is no whole figure
    if !is_small || is_dot(graph) || region.at_border_px(ink) > 0 {
        return None;
    }
    let (columns, lines) = region.bounds(ROUND_PX, (dark.width, dark.height))?;
    let part = dark.part(columns.clone(), lines.clone());
    let near = part.doubled();
    let closer = |mask: Mask| mask.doubled_to(near.width, near.height);
    let mut own = Mask::empty(part.width, part.height);
    region.seen_from(columns.start, lines.start).fill_into(&mut own);
    let pale = own.clone().without(&over(&part, threshold)).count();
    if pale as f64 > MOST_PALE * own.count() as f64 {
        return None;
    }
    let others = ink.part(&columns, &lines).without(&own);
    // its edge is up to a pixel further out than its own pixels
    let figure = over(&near, threshold).and(&closer(own.dilated_by(1))).without(&closer(others));
    let mut patches = regions(&figure);
    let largest = patches.iter().map(Region::area).max().unwrap_or(0);
    patches.retain(|patch| patch.area() >= LEAST_PX.min(largest));
    let shapes = closer(shapes.part(&columns, &lines));
    let found = graphs(&near, &figure, patches);
    let rows = found.iter().flat_map(|(region, graph)| centreline::rows(&near, &shapes, region, graph));
    let corner = Vec2::new(columns.start as f64, lines.start as f64);
    let back = |row: Row| Row {
        points: row.points.iter().map(|p| (0.5 * p.to_vec2() + corner).to_point()).collect(),
        width: 0.5 * row.width,
        ..row
    };
    Some(rows.map(back).collect())
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use tracelight_stroke::Point;

    use super::*;

    /// What a pen of 3.3 px draws from corner to corner through a lens, in a picture of 44 pixels either way.
    fn drawn(corners: &[Point]) -> Plane<u8> {
        let off = |p: Point| {
            let side = |w: &[Point]| {
                let along = w[1] - w[0];
                let share = ((p - w[0]).dot(along) / along.hypot2()).clamp(0.0, 1.0);
                p.distance(w[0] + along * share)
            };
            corners.windows(2).map(side).fold(f64::INFINITY, f64::min)
        };
        let mut dark = Plane::filled(44, 44, 0);
        for (x, y) in (0..44).flat_map(|x| (0..44).map(move |y| (x, y))) {
            // a lens blurs over a pixel and a half
            let inside = 1.65 - off(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            dark.row_mut(y)[x] = (225.0 * (inside / 1.5 + 0.5).clamp(0.0, 1.0)) as u8;
        }
        dark
    }

    #[test]
    fn a_small_zigzag_is_one_line_and_nearer_to_its_corners_than_from_afar() {
        // in all directions: how far off the worst corner is, px, and how many rows there are
        let (mut near_px, mut far_px, mut pieces) = (0.0, 0.0, 0);
        for turned in 0..12 {
            let along = planar::direction(0.3 + f64::from(turned) * 0.5);
            let corner = |k: i32| {
                let aside = if k % 2 == 0 { -6.0 } else { 6.0 };
                Point::new(22.3, 21.6) + along * (5.0 * f64::from(k - 2)) + along.turn_90() * aside
            };
            let corners: Vec<Point> = (0..5).map(corner).collect();
            let dark = drawn(&corners);
            let (ink, none) = (over(&dark, 112), Mask::empty(44, 44));
            let found = graphs(&dark, &ink, regions(&ink));
            let (region, graph) = &found[0];
            let worst_px = |rows: &[Row]| {
                let points = || rows.iter().flat_map(|row| &row.points);
                let off =
                    |corner: &Point| points().map(|p| p.distance(*corner)).fold(f64::INFINITY, f64::min);
                corners.iter().map(off).fold(0.0, f64::max)
            };
            let near = rows(&dark, 112, (&ink, &none), (region, graph)).expect("a small figure");
            near_px += worst_px(&near);
            far_px += worst_px(&centreline::rows(&dark, &none, region, graph));
            pieces += near.len();
        }
        assert!(near_px < 0.5 * far_px && near_px < 26.0, "{near_px} and {far_px} px in all");
        assert!(pieces <= 13, "{pieces} rows of 12 zigzags");
    }

    #[test]
    fn large_figures_and_dots_are_not_looked_at_closer() {
        let looked_at = |width: usize, height: usize| {
            let mut dark = Plane::filled(160, 60, 0);
            (20..20 + height).for_each(|y| dark.row_mut(y)[20..20 + width].fill(200));
            let ink = over(&dark, 100);
            let found = graphs(&dark, &ink, regions(&ink));
            let (region, graph) = &found[0];
            rows(&dark, 100, (&ink, &Mask::empty(160, 60)), (region, graph)).is_some()
        };
        assert!(looked_at(40, 3));
        assert!(!looked_at(80, 3) && !looked_at(40, 9) && !looked_at(4, 3));
    }
}
