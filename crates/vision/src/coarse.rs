//! Chooses the resolution of tracing. The grain of pencil or crayon is finer than the drawing, and thin lines are finer than the pixel grid.
//!
//! If a mask at half the resolution, or of a smoothed plane, has a shorter border, the difference was the paper's grain. If its lines are still
//! wide enough, or all there, nothing drawn is lost.

use tracelight_image::smooth::smoothed;
use tracelight_image::threshold::over;
use tracelight_image::{Grey, Mask, Plane};

/// Looked at half as closely, a picture still has so many pixels either way.
const LEAST_SIDE_PX: usize = 200;
/// The border of ragged ink is this many times as long as half as closely. Of clean edges it is 1.00 to 1.04, of those of a
/// crayon 1.06 to 1.6.
const RAGGED: f64 = 1.06;
/// Smallest mean width of the ink at half resolution, px.
const LEAST_WIDTH_PX: f64 = 4.5;
/// Largest share of its length that is thinner than three pixels.
const MOST_THIN: f64 = 0.5;
/// Smallest ratio of its length to its width: 40 at least for crayon, hardly as much for a silhouette with a ragged edge.
const LEAST_LONG: f64 = 30.0;
/// Largest relative change of its area: 3 % for crayon.
const MOST_GROWN: f64 = 0.06;

/// A picture of fewer pixels either way shows no grain: its pixels are as coarse, and smoothed its small figures run together.
const GRAIN_SIDE_PX: usize = 300;
/// The border of grainy ink is this many times as long as when it is smoothed. Of a pen it is 1.00 to 1.05, of printed letters and of
/// even pencils up to 1.08, of sketches in pencil 1.09 to 1.35.
const GRAINY: f64 = 1.09;
/// At the same threshold, before smoothed ink has its own.
const MAY_BE_GRAINY: f64 = 1.06;
/// And at most this share of it is gone then: thin lines and small letters are more than grain.
const MOST_LOST: f64 = 0.02;

/// More pixels than this say nothing more about a drawing; larger images are averaged down.
const MOST_PIXELS: usize = 12_000_000;

/// Averaged so many times either way, the shorter side of an image still has 8 px.
pub(crate) fn most_reduction(image: &Grey) -> usize {
    (image.width().min(image.height()) / Grey::LEAST_SIDE).max(1)
}

/// How many pixels of an image either way are averaged into one before tracing: 1 up to 12 megapixels. Never so many that
/// a side falls under 8 px.
pub(crate) fn reduction(image: &Grey) -> usize {
    let (w, h, most) = (image.width(), image.height(), most_reduction(image));
    (1..=most).find(|k| (w / k) * (h / k) <= MOST_PIXELS).unwrap_or(most)
}

/// Whether the ink of a plane, what is over a threshold, may be grainy: to know it takes the smoothed ink.
pub(crate) fn may_be_grainy(fine: &Mask, darkness: &Plane<u8>, threshold: u8) -> bool {
    let is_small = darkness.width.min(darkness.height) < GRAIN_SIDE_PX;
    !is_small && grain(fine, &over(&smoothed(darkness), threshold)) >= MAY_BE_GRAINY
}

/// Whether ink is so grainy that a smoothed look, in which it is `even`, is better.
pub(crate) fn is_grainy(fine: &Mask, even: &Mask) -> bool {
    lost(fine, even) <= MOST_LOST && grain(fine, even) >= GRAINY
}

/// The share of ink of which nothing is left near by when it is smoothed.
fn lost(fine: &Mask, even: &Mask) -> f64 {
    let gone = fine.clone().without(&even.clone().dilated_by(2)).count();
    gone as f64 / (fine.count() as f64).max(1.0)
}

/// How many times as long the border of ink is as when it is smoothed, along that: letters whose holes and slits are closed then are
/// not grainy.
fn grain(fine: &Mask, even: &Mask) -> f64 {
    let mut along = fine.clone().and(&even.clone().dilated_by(1));
    along.add(&even.inside());
    along.line_length() / even.line_length().max(1.0)
}

/// Whether the ink of a plane, what is over a threshold, is better looked at half as closely.
pub(crate) fn is_ragged(fine: &Mask, darkness: &Plane<u8>, threshold: u8) -> bool {
    let (fine_px, fine_length) = (fine.count() as f64, fine.line_length());
    // holes and ragged edges halve the mean width at most: thin lines need no second look, and small pictures have no grain
    let is_small = darkness.width.min(darkness.height) < 2 * LEAST_SIDE_PX;
    if is_small || fine_px < LEAST_WIDTH_PX * fine_length {
        return false;
    }
    let half = over(&darkness.reduced(2), threshold);
    let half_length = half.line_length();
    let wide = half.clone().eroded(THIN_PX).dilated(THIN_PX).and(&half);
    let (wide_px, thin_px) = (wide.count() as f64, (half.count() - wide.count()) as f64);
    // lines whose edges fall between two of the larger pixels grow wider, and their holes smaller, by up to a pixel
    let is_same = (4.0 * half.count() as f64 - fine_px).abs() <= MOST_GROWN * fine_px;
    let wide_length = wide.line_length().max(1.0);
    let width_px = wide_px / wide_length;
    let is_line = is_same && width_px >= LEAST_WIDTH_PX && wide_length >= LEAST_LONG * width_px;
    if !is_line || thin_px > MOST_THIN * half_length * (0.5 * THIN_PX as f64) {
        return false;
    }
    // marks beside it that are gone from half as closely do not make it ragged
    let about = wide.dilated_by(1);
    let fine = fine.clone().and(&about.doubled_to(darkness.width, darkness.height));
    fine.line_length() >= RAGGED * 2.0 * half.and(&about).line_length()
}

/// Thinner in the mean than this, px, lines are better looked at twice as closely: between the pixels' centres the picture is smooth,
/// and a skeleton that goes from pixel to pixel has no direction over so short a way as their corners and letters are.
const FINE_PX: f64 = 2.8;
/// Unless more than this share of them is gone when they are smoothed: crumbs of grain and specks of dust would be lines.
const MOST_CRUMBS: f64 = 0.001;

/// Whether the ink of a plane, most of it over a threshold, is better looked at twice as closely.
pub(crate) fn is_thin(ink: &Mask, darkness: &Plane<u8>, threshold: u8) -> bool {
    let is_small = 4 * darkness.values.len() <= MOST_PIXELS;
    if !is_small || ink.count() as f64 >= FINE_PX * ink.line_length() {
        return false;
    }
    lost(ink, &over(&smoothed(darkness), threshold)) <= MOST_CRUMBS
}

/// What is thinner than this is thin, px.
const THIN_PX: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(width: f64, ragged_px: f64) -> Plane<u8> {
        ring_within(400, width, ragged_px)
    }

    /// A ring of this width in so many pixels either way, drawn with a pen whose edge wanders by so many px from pixel to pixel.
    fn ring_within(side: usize, width: f64, ragged_px: f64) -> Plane<u8> {
        let mut plane = Plane::filled(side, side, 0);
        let (middle, radius) = (0.5 * (side - 1) as f64, 0.375 * side as f64);
        let mut word = 1_u64;
        for y in 0..side {
            for x in 0..side {
                word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let wander = ragged_px * ((word >> 40) as f64 / f64::from(1 << 24) - 0.5);
                let off = ((x as f64 - middle).hypot(y as f64 - middle) - radius).abs() + wander;
                plane.row_mut(y)[x] = (255.0 * (0.5 * width - off + 0.5).clamp(0.0, 1.0)) as u8;
            }
        }
        plane
    }

    fn is_ragged_over_half(plane: &Plane<u8>) -> bool {
        is_ragged(&over(plane, 128), plane, 128)
    }

    #[test]
    fn a_wide_line_with_ragged_edges_is_looked_at_from_further() {
        let is_ragged = |width, ragged_px| is_ragged_over_half(&ring(width, ragged_px));
        assert!(is_ragged(24.0, 6.0));
        assert!(!is_ragged(24.0, 0.0), "clean edges are as long however they are looked at");
        assert!(!is_ragged(5.0, 6.0), "half as wide is no line any more");
    }

    #[test]
    fn small_marks_beside_a_clean_line_do_not_make_it_ragged() {
        let mut plane = ring(24.0, 0.0);
        for (x, y) in (0..400).flat_map(|x| (0..400).map(move |y| (x, y))) {
            let dot = x % 20 < 2 && y % 20 < 2;
            if dot {
                plane.row_mut(y)[x] = 160;
            }
        }
        assert!(!is_ragged_over_half(&plane));
    }

    #[test]
    fn a_mask_twice_as_large_has_each_pixel_four_times() {
        let ink = over(&ring(10.0, 0.0), 128);
        let large = ink.doubled_to(801, 803);
        assert_eq!(large.count(), 4 * ink.count());
        assert!((0..801).all(|x| (0..803).all(|y| large.get(x, y) == ink.get(x / 2, y / 2))));
    }

    #[test]
    fn a_grainy_pencil_is_smoothed_and_a_pen_is_not() {
        let is_grainy = |width, ragged_px| {
            let plane = ring(width, ragged_px);
            is_grainy(&over(&plane, 128), &over(&smoothed(&plane), 128))
        };
        assert!(is_grainy(4.0, 4.0));
        assert!(!is_grainy(4.0, 0.0));
        assert!(!is_grainy(0.8, 0.0), "thin lines would be lost");
    }

    #[test]
    fn thin_lines_are_looked_at_closer_unless_there_are_crumbs_beside_them() {
        let is_thin = |plane: &Plane<u8>| is_thin(&over(plane, 100), plane, 100);
        assert!(is_thin(&ring(1.6, 0.0)) && is_thin(&ring(2.4, 0.0)));
        assert!(!is_thin(&ring(4.0, 0.0)));
        assert!(!is_thin(&ring_within(1800, 1.6, 0.0)), "too many pixels");
        let mut dusty = ring(1.6, 0.0);
        (10..390).step_by(40).for_each(|x| dusty.row_mut(5)[x] = 160);
        assert!(!is_thin(&dusty));
    }

    #[test]
    fn a_picture_of_few_pixels_has_no_grain() {
        let may_be_grainy = |side| {
            let plane = ring_within(side, 4.0, 4.0);
            may_be_grainy(&over(&plane, 128), &plane, 128)
        };
        assert!(may_be_grainy(GRAIN_SIDE_PX));
        assert!(!may_be_grainy(GRAIN_SIDE_PX - 1));
    }

    #[test]
    fn a_lines_length_is_that_of_its_middle() {
        let length = over(&ring(10.0, 0.0), 128).line_length();
        assert!((length / (2.0 * std::f64::consts::PI * 150.0) - 1.0).abs() < 0.03, "{length}");
    }

    #[test]
    fn a_vast_image_is_averaged_down_and_another_is_not() {
        let reduction = |width: usize, height: usize| {
            reduction(&Grey::new(width, height, vec![0; width * height]).unwrap())
        };
        assert_eq!(reduction(30, 20), 1);
        assert_eq!(reduction(4000, 3001), 2);
        assert_eq!(reduction(8, 1_500_001), 1);
    }
}
