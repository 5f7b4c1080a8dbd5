//! The two marks of a ruler.

use std::path::Path;

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::Point;
use tracelight_vision::{VisionError, find_two_marks};

use crate::raster::Canvas;

fn picture(name: &str) -> Grey {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name);
    let image = image::open(path).unwrap().to_luma8();
    Grey::new(image.width() as usize, image.height() as usize, image.into_raw()).unwrap()
}

#[test]
fn the_example_rulers_marks_are_48_px_apart() {
    for (name, upright) in [("ruler-upright.png", true), ("ruler-level.png", false)] {
        let marks = find_two_marks(&picture(name)).unwrap();
        println!("{name}: {marks:?} {:.4} px", marks.distance_px());
        assert!((marks.distance_px() - 48.0).abs() < 0.1, "{name}: {} px", marks.distance_px());
        assert_eq!(marks.upright(), upright);
    }
}

/// Bars of 60 × 8 px across a direction, at these places along it, on a light ruler.
fn ruler(places: &[f64], tilt_rad: f64, light: bool) -> Grey {
    let mut canvas = Canvas::new(320, 240);
    let (along, across) =
        (planar::direction(tilt_rad), planar::direction(tilt_rad + std::f64::consts::FRAC_PI_2));
    let corner = |s: f64, t: f64| Point::new(100.0, 120.0) + along * s + across * t;
    let bar = |&s: &f64| {
        vec![corner(s - 4.0, -30.0), corner(s + 4.0, -30.0), corner(s + 4.0, 30.0), corner(s - 4.0, 30.0)]
    };
    canvas.fill(&places.iter().map(bar).collect::<Vec<_>>());
    let level = |share: f64| if light { 40.0 + 180.0 * share } else { 230.0 - 190.0 * share };
    Grey::new(320, 240, canvas.shares().map(|s| level(s) as u8).collect()).unwrap()
}

#[test]
fn marks_are_measured_to_a_twentieth_of_a_pixel_wherever_they_fall() {
    for k in 0..20 {
        let (apart, tilt) = (48.0 + 0.37 * f64::from(k), 0.005 * f64::from(k));
        let marks =
            find_two_marks(&ruler(&[0.13 * f64::from(k), 0.13 * f64::from(k) + apart], tilt, k % 2 == 0))
                .unwrap();
        assert!((marks.distance_px() - apart).abs() < 0.05, "{} instead of {apart}", marks.distance_px());
    }
}

#[test]
fn one_mark_three_marks_or_slanted_ones_are_refused() {
    let of = |places: &[f64], tilt| find_two_marks(&ruler(places, tilt, false)).unwrap_err();
    assert_eq!(of(&[20.0], 0.0), VisionError::Marks { found: 1 });
    assert_eq!(of(&[0.0, 48.0, 96.0], 0.0), VisionError::Marks { found: 3 });
    assert!(
        matches!(of(&[0.0, 80.0], 0.6), VisionError::Slant { slant_deg, .. } if (slant_deg - 34.4).abs() < 0.5)
    );
}
