use super::*;
use tracelight_stroke::Point;
use tracelight_stroke::Vec2;

mod kinds;
mod picture;

use picture::{picture, through_mosaic};

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
            assert!(tag.id == id && tag.wrong_cells <= 1, "{} with {} wrong cells", tag.id, tag.wrong_cells);
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
    let black =
        |x: f64, y: f64| (0.0..8.0).contains(&x) && (0.0..8.0).contains(&y) && cells[y as usize][x as usize];
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
