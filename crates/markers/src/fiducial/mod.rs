//! Detects square markers of the AprilTag family 36h11, to a few hundredths of a pixel.
//!
//! What is darker than halfway between the darkest and the brightest about it is cut from the rest (`local`), its patches with
//! four straight sides are found (`quad`), the cells between them are read and looked up (`cells`, `codes`), and every boundary between
//! black and white cells, inside as well, is placed on the grey levels (`boundary`). The way is that of Wang & Olson, *AprilTag 2: Efficient and robust fiducial detection*, IROS 2016;
//! sides are placed by how much of each pixel beside them is inked.

mod boundary;
mod cells;
mod codes;
mod local;
mod place;
mod quad;
mod square;

use tracelight_image::{Grey, Mask, Plane, regions};
use tracelight_stroke::Point;

use boundary::{Cells, Tables};
pub use place::TagPlace;
use square::Square;

/// A marker that was found, pixel frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Tag {
    /// Its number in the family 36h11.
    pub id: u16,
    /// Corners of its black border: upper left as printed, then clockwise.
    pub corners: [Point; 4],
    /// Where black meets white.
    pub places: Vec<TagPlace>,
    /// Standard deviation of these places across their boundaries, px.
    pub deviation_px: f64,
    /// Number of corrected cells.
    pub wrong_cells: u8,
}

/// How many ids the family has.
pub const TAG_COUNT: u16 = codes::CODES.len() as u16;

/// The cells of a marker with its black border, row by row from the upper left as printed; `true` is black. `None` of an id that
/// the family does not have.
pub fn tag_cells(id: u16) -> Option<[[bool; 8]; 8]> {
    let code = *codes::CODES.get(usize::from(id))?;
    let inner = |row: usize, column: usize| code >> (35 - (6 * (row - 1) + column - 1)) & 1 == 0;
    let black = |row: usize, column: usize| {
        !((1..7).contains(&row) && (1..7).contains(&column)) || inner(row, column)
    };
    Some(std::array::from_fn(|row| std::array::from_fn(|column| black(row, column))))
}

/// Finds every marker whose sides are at least 12 px long and all in sight, with white about it as wide as one of its cells.
pub fn find_tags(image: &Grey) -> Vec<Tag> {
    let plane = image.plane();
    let dark = local::darker(plane);
    let tables = Tables::get();
    let mut walked = Mask::empty(dark.width(), dark.height());
    let patches = regions(&dark);
    let rough = patches.iter().filter_map(|patch| quad::of(&dark, patch, &mut walked));
    rough.filter_map(|corners| tag(plane, tables, &corners)).collect()
}

/// The marker with about these corners.
fn tag(plane: &Plane<u8>, tables: &Tables, rough: &[Point; 4]) -> Option<Tag> {
    let read = cells::read(plane, &Square::of(rough)?)?;
    let corners = std::array::from_fn(|k| rough[(k + read.turns) % 4]);
    let cells = Cells::new(tag_cells(read.id)?);
    let placed = boundary::placed(plane, tables, &cells, &Square::of(&corners)?)?;
    Some(Tag {
        id: read.id,
        corners: placed.square.corners()?,
        places: placed.places,
        deviation_px: placed.deviation_px,
        wrong_cells: read.wrong,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Vec2;

    /// A picture of one marker on a white page on a grey wall, in even light: blurred, with noise.
    fn picture(id: u16, corners: &[Point; 4], blur_px: f64, noise: f64, seed: u64) -> Grey {
        const SIZE: usize = 120;
        const FINE: usize = 5;
        let cells = tag_cells(id).unwrap();
        let square = Square::of(corners).unwrap();
        // where a pixel is on the marker: by Newton's method
        let on_marker = |p: Point| {
            let mut at = Point::new(4.0, 4.0);
            for _ in 0..20 {
                let (seen, across, down) = square.with_slopes(at.x, at.y)?;
                let (off, det) = (p - seen, across.cross(down));
                at += Vec2::new(off.cross(down) / det, across.cross(off) / det);
            }
            Some(at)
        };
        let light = |p: Point| match on_marker(p) {
            Some(at) if (0.0..8.0).contains(&at.x) && (0.0..8.0).contains(&at.y) => {
                if cells[at.y as usize][at.x as usize] { 0.03 } else { 0.8 }
            }
            Some(at) if (-1.5..9.5).contains(&at.x) && (-1.5..9.5).contains(&at.y) => 0.8,
            _ => 0.4,
        };
        let sharp: Vec<f64> = (0..SIZE * SIZE * FINE * FINE)
            .map(|i| {
                let place = |k: usize| (k as f64 + 0.5) / FINE as f64;
                light(Point::new(place(i % (SIZE * FINE)), place(i / (SIZE * FINE))))
            })
            .collect();
        let mut dice = oorandom::Rand64::new(u128::from(seed));
        let reach = (3.0 * blur_px * FINE as f64) as isize;
        let bell = |d: isize| (-0.5 * (d as f64 / (blur_px * FINE as f64)).powi(2)).exp();
        let blurred = |from: &[f64], step: isize| -> Vec<f64> {
            let total: f64 = (-reach..=reach).map(bell).sum();
            let last = from.len() as isize - 1;
            let sum = |i: isize| {
                (-reach..=reach).map(|d| bell(d) * from[(i + d * step).clamp(0, last) as usize]).sum::<f64>()
            };
            (0..from.len()).map(|i| sum(i as isize) / total).collect()
        };
        let blurred = blurred(&blurred(&sharp, 1), (SIZE * FINE) as isize);
        let level = |i: usize| {
            let (x, y) = (i % SIZE * FINE, i / SIZE * FINE);
            let sum: f64 =
                (0..FINE * FINE).map(|k| blurred[(y + k / FINE) * SIZE * FINE + x + k % FINE]).sum();
            (sum / (FINE * FINE) as f64).powf(1.0 / 2.2) * 255.0
        };
        let mut noisy = |v: f64| {
            let sum: f64 = (0..12).map(|_| dice.rand_float()).sum();
            (v + noise * (sum - 6.0)).round().clamp(0.0, 255.0) as u8
        };
        Grey::new(SIZE, SIZE, (0..SIZE * SIZE).map(|i| noisy(level(i))).collect()).unwrap()
    }

    /// Renders an image as a single-chip colour sensor with nearest-neighbour interpolation shows it, in video brightness. Levels are gamma-coded
    /// (1/2.2); the interpolation is linear in light.
    fn through_mosaic(image: &Grey) -> Grey {
        let (width, height) = (image.width(), image.height());
        let light = |x: isize, y: isize| {
            let beyond = |v: isize, n: usize| if v < 0 { 1 } else { (v as usize).min(n - 1) };
            (f64::from(image.levels()[beyond(y, height) * width + beyond(x, width)]) / 255.0).powf(2.2)
        };
        let brightness = |i: usize| {
            let (x, y) = ((i % width) as isize, (i / width) as isize);
            let mean = |places: &[(isize, isize)]| {
                places.iter().map(|(dx, dy)| light(x + dx, y + dy)).sum::<f64>() / places.len() as f64
            };
            let (own, beside, upright) = (light(x, y), mean(&[(-1, 0), (1, 0)]), mean(&[(0, -1), (0, 1)]));
            let corners = mean(&[(-1, -1), (1, -1), (-1, 1), (1, 1)]);
            let [red, green, blue] = match (x % 2, y % 2) {
                (0, 0) => [own, 0.5 * (beside + upright), corners],
                (1, 1) => [corners, 0.5 * (beside + upright), own],
                (1, 0) => [beside, own, upright],
                _ => [upright, own, beside],
            }
            .map(|v| 255.0 * v.powf(1.0 / 2.2));
            (0.299 * red + 0.587 * green + 0.114 * blue).round() as u8
        };
        Grey::new(width, height, (0..width * height).map(brightness).collect()).unwrap()
    }

    #[test]
    fn colours_that_a_sensor_fills_in_move_no_boundary() {
        let corners = [point(35.3, 34.6), point(75.1, 35.2), point(74.0, 74.4), point(34.1, 73.3)];
        let found = find_tags(&through_mosaic(&picture(3, &corners, 0.8, 0.0, 9)));
        let [tag] = found.as_slice() else { panic!("{} markers of one", found.len()) };
        // 0.036 px; without smoothing 0.049
        assert!(tag.deviation_px < 0.042, "{}", tag.deviation_px);
        let off = (0..4).map(|k| tag.corners[k].distance(corners[k])).fold(0.0, f64::max);
        assert!(off < 0.03, "{off} px");
    }

    fn point(x: f64, y: f64) -> Point {
        Point::new(x, y)
    }

    #[test]
    fn a_marker_is_found_to_a_few_hundredths_of_a_pixel_however_it_lies() {
        let upright = [point(40.3, 38.6), point(80.1, 37.2), point(83.0, 79.4), point(39.1, 78.3)];
        let small = [point(50.2, 50.7), point(69.8, 51.4), point(70.3, 71.9), point(49.4, 71.1)];
        let askew = [point(30.4, 60.0), point(58.2, 33.1), point(84.6, 66.3), point(55.0, 92.2)];
        for (corners, bound_px) in [(upright, 0.07), (small, 0.15), (askew, 0.07)] {
            for turns in 0..4 {
                let corners: [Point; 4] = std::array::from_fn(|k| corners[(k + turns) % 4]);
                let id = 37 + 100 * turns as u16;
                let found = find_tags(&picture(id, &corners, 0.9, 2.0, 5));
                let [tag] = found.as_slice() else { panic!("{} markers of one", found.len()) };
                assert!(
                    tag.id == id && tag.wrong_cells <= 1,
                    "{} with {} wrong cells",
                    tag.id,
                    tag.wrong_cells
                );
                let off = (0..4).map(|k| tag.corners[k].distance(corners[k])).fold(0.0, f64::max);
                assert!(off < bound_px, "{id}: corners are off by {off} px");
                assert!(
                    tag.deviation_px < 0.1 && tag.places.len() > 60,
                    "{} {}",
                    tag.deviation_px,
                    tag.places.len()
                );
            }
        }
    }

    #[test]
    fn blur_and_noise_move_no_corner_far() {
        let corners = [point(35.3, 34.6), point(85.1, 37.2), point(83.0, 84.4), point(32.1, 83.3)];
        for (blur_px, noise, bound_px) in [(0.5, 1.0, 0.05), (2.0, 2.0, 0.15), (0.9, 8.0, 0.12)] {
            let found = find_tags(&picture(3, &corners, blur_px, noise, 9));
            assert_eq!(found.len(), 1, "{blur_px} {noise}");
            let off = (0..4).map(|k| found[0].corners[k].distance(corners[k])).fold(0.0, f64::max);
            assert!(off < bound_px, "{blur_px} {noise}: {off} px");
        }
    }

    #[test]
    fn boundaries_know_on_which_side_black_is() {
        let corners = [point(35.3, 34.6), point(85.1, 37.2), point(83.0, 84.4), point(32.1, 83.3)];
        let found = find_tags(&picture(11, &corners, 0.7, 0.0, 1));
        let cells = tag_cells(11).unwrap();
        let black = |x: f64, y: f64| {
            (0.0..8.0).contains(&x) && (0.0..8.0).contains(&y) && cells[y as usize][x as usize]
        };
        for place in &found[0].places {
            let behind = if place.upright { Vec2::new(0.3, 0.0) } else { Vec2::new(0.0, 0.3) };
            let (after, before) = (place.cell + behind, place.cell - behind);
            assert_eq!(black(after.x, after.y), place.black_behind);
            assert_ne!(black(after.x, after.y), black(before.x, before.y));
        }
    }

    #[test]
    fn squares_of_random_cells_are_no_markers() {
        let mut dice = oorandom::Rand64::new(3);
        let (mut squares, mut ids) = (0, 0);
        for seed in 0..40 {
            // a field of framed squares, each of 8 × 8 cells of 3 px
            let cells: Vec<bool> = (0..64 * 36).map(|_| dice.rand_float() < 0.5).collect();
            let black = |x: usize, y: usize| {
                let (square, column, row) = (x / 36 + 8 * (y / 36), (x % 36) / 3, (y % 36) / 3);
                let inside = (2..10).contains(&column) && (2..10).contains(&row);
                let frame = [2, 9].contains(&column) || [2, 9].contains(&row);
                inside && (frame || cells[(square * 36 + (row - 2) * 6 + column - 2) % cells.len()])
            };
            let levels = (0..288 * 288).map(|i| if black(i % 288, i / 288) { 30 } else { 220 }).collect();
            squares += 64;
            ids += find_tags(&Grey::new(288, 288, levels).unwrap()).len();
            assert!(ids <= 1, "{ids} of {squares} squares of random cells pass for markers ({seed})");
        }
    }

    #[test]
    fn nothing_is_found_where_nothing_is() {
        let mut dice = oorandom::Rand64::new(3);
        let noise = (0..320 * 240).map(|_| dice.rand_range(0..256) as u8).collect();
        assert!(find_tags(&Grey::new(320, 240, noise).unwrap()).is_empty());
        for size in [8, 9, 13] {
            assert!(find_tags(&Grey::new(size, size, vec![7; size * size]).unwrap()).is_empty());
        }
    }

    #[test]
    fn every_id_has_its_own_cells() {
        for id in [0, 1, 300, TAG_COUNT - 1] {
            let cells = tag_cells(id).unwrap();
            assert!((0..8).all(|k| cells[0][k] && cells[7][k] && cells[k][0] && cells[k][7]), "no border");
        }
        assert_eq!(tag_cells(TAG_COUNT), None);
    }
}
