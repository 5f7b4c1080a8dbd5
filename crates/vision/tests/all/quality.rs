//! What a picture is worth, and what is set by hand.

use tracelight_image::Grey;
use tracelight_vision::{Options, Traced, Verdict, VisionError, trace};

const WIDTH: usize = 320;
const HEIGHT: usize = 240;

/// A picture from its brightness, 0 to 1, at places in px, each pixel the mean of 3 × 3 of them.
fn picture(level: impl Fn(f64, f64) -> f64) -> Grey {
    let pixel = |i: usize| {
        let (x, y) = ((i % WIDTH) as f64, (i / WIDTH) as f64);
        let part = |k: usize| level(x + ((k % 3) as f64 + 0.5) / 3.0, y + ((k / 3) as f64 + 0.5) / 3.0);
        ((0..9).map(part).sum::<f64>() / 9.0 * 255.0).round() as u8
    };
    Grey::new(WIDTH, HEIGHT, (0..WIDTH * HEIGHT).map(pixel).collect()).unwrap()
}

/// How much of a line of this width is at a place, its edges as soft as a Gaussian of `sigma`: 0 to 1.
fn line(beyond: f64, half: f64, sigma: f64) -> f64 {
    1.0 / (1.0 + (1.702 * (beyond.abs() - half) / sigma).exp())
}

/// A slanted line and a ring.
fn drawing(x: f64, y: f64, pen: f64, sigma: f64) -> f64 {
    let slanted = if (30.0..290.0).contains(&x) {
        line(0.9578 * (y - 40.0 - 0.3 * (x - 30.0)), pen / 2.0, sigma)
    } else {
        0.0
    };
    let ring = line((x - 120.0).hypot(y - 160.0) - 45.0, pen / 2.0, sigma);
    slanted.max(ring)
}

fn traced(image: &Grey) -> Traced {
    trace(image, &Options::default()).unwrap()
}

#[test]
fn a_clean_drawing_is_good_and_its_pen_and_edges_are_known() {
    let found = traced(&picture(|x, y| 1.0 - 0.9 * drawing(x, y, 4.0, 0.2)));
    let quality = found.quality;
    assert_eq!(quality.verdict(), Verdict::Good, "{}", quality.words());
    assert!((quality.pen_px.unwrap() - 4.0).abs() < 0.5, "{quality:?}");
    assert!((0.7..1.6).contains(&quality.edge_px.unwrap()), "{quality:?}");
    assert_eq!(quality.clipped_percent, 0.0, "white paper is no fault");
    assert!((78.0..92.0).contains(&quality.contrast_percent) && quality.ink_percent < 6.0, "{quality:?}");
}

#[test]
fn a_drawing_out_of_focus_is_usable_and_says_so() {
    let quality = traced(&picture(|x, y| 0.9 - 0.7 * drawing(x, y, 3.0, 4.0))).quality;
    assert_eq!(quality.verdict(), Verdict::Usable, "{quality:?}");
    assert!(quality.edge_px.unwrap() > 5.0, "{quality:?}");
    assert!(
        quality.words().contains("blurred over") && quality.words().contains("focus"),
        "{}",
        quality.words()
    );
}

#[test]
fn a_burnt_spot_counts_and_the_paper_does_not() {
    let burnt = |x: f64, y: f64| (x - 230.0).hypot(y - 170.0) < 60.0;
    let level = |x, y| if burnt(x, y) { 1.0 } else { 0.7 - 0.6 * drawing(x, y, 4.0, 0.2) };
    let quality = traced(&picture(level)).quality;
    let share = 100.0 * std::f64::consts::PI * 60.0 * 60.0 / (WIDTH * HEIGHT) as f64;
    assert!((quality.clipped_percent - share).abs() < 2.0, "{} of {share}", quality.clipped_percent);
    assert!(quality.words().contains("burnt"), "{}", quality.words());
}

#[test]
fn light_ink_has_the_figures_of_dark_ink() {
    let dark = traced(&picture(|x, y| 1.0 - 0.9 * drawing(x, y, 4.0, 0.6))).quality;
    let light = traced(&picture(|x, y| 0.9 * drawing(x, y, 4.0, 0.6))).quality;
    assert!(light.light_on_dark && !dark.light_on_dark);
    assert!((light.edge_px.unwrap() - dark.edge_px.unwrap()).abs() < 0.1);
    assert_eq!(light.clipped_percent, 0.0, "black paper is no fault");
    assert_eq!(light.verdict(), Verdict::Good);
}

#[test]
fn a_threshold_says_which_of_two_inks_is_drawn() {
    // a pale line above a dark one
    let level = |x: f64, y: f64| {
        let within = if (30.0..290.0).contains(&x) { 1.0 } else { 0.0 };
        1.0 - within * (0.3 * line(y - 60.0, 2.0, 0.2)).max(0.9 * line(y - 170.0, 2.0, 0.2))
    };
    let image = picture(level);
    let count = |percent| {
        let options = Options { threshold_percent: Some(percent), ..Options::default() };
        trace(&image, &options).map(|t| t.strokes.strokes.len())
    };
    assert_eq!(count(15.0), Ok(2));
    assert_eq!(count(50.0), Ok(1));
    let error = count(95.0).unwrap_err();
    assert!(
        matches!(error, VisionError::Threshold { darkest, .. } if (85.0..93.0).contains(&darkest)),
        "{error}"
    );
}

#[test]
fn despeckling_and_the_least_length_drop_what_is_smaller() {
    // a line 200 px long, one of 40 px, and three specks of 3 × 3 px far from both
    let level = |x: f64, y: f64| {
        let long = (20.0..220.0).contains(&x) && (50.0..54.0).contains(&y);
        let short = (20.0..60.0).contains(&x) && (150.0..154.0).contains(&y);
        let speck =
            (210.0..213.0).contains(&y) && [150.0, 200.0, 250.0].iter().any(|s| (*s..s + 3.0).contains(&x));
        if long || short || speck { 0.1 } else { 1.0 }
    };
    let image = picture(level);
    let count = |options: Options| trace(&image, &options).map(|t| t.strokes.strokes.len());
    let by_itself = Options::default();
    assert_eq!(count(by_itself), Ok(2), "specks are dust");
    assert_eq!(count(Options { despeckle_px2: Some(0.0), ..by_itself }), Ok(5));
    assert_eq!(
        count(Options { despeckle_px2: Some(9.0), ..by_itself }),
        Ok(5),
        "a patch of just that area stays"
    );
    assert_eq!(count(Options { despeckle_px2: Some(10.0), ..by_itself }), Ok(2));
    assert_eq!(count(Options { despeckle_px2: Some(300.0), ..by_itself }), Ok(1));
    assert_eq!(count(Options { min_length_px: 100.0, ..by_itself }), Ok(1));
    let error = count(Options { min_length_px: 500.0, ..by_itself }).unwrap_err();
    assert!(
        matches!(error, VisionError::TooShort { longest_px, .. } if (longest_px - 196.0).abs() < 6.0),
        "{error}"
    );
}

#[test]
fn options_out_of_their_bounds_are_named() {
    let image = picture(|x, y| 1.0 - drawing(x, y, 4.0, 0.2));
    let ok = Options::default();
    for (options, name) in [
        (Options { tolerance_px: f64::NAN, ..ok }, "--tolerance is NaN and must be from 0.05 to 10 px"),
        (Options { corner_rad: 3.0, ..ok }, "--corner-angle is 3"),
        (
            Options { threshold_percent: Some(100.0), ..ok },
            "--threshold is 100 and must be from 0.4 to 99.6 %",
        ),
        (Options { despeckle_px2: Some(-1.0), ..ok }, "--despeckle is -1"),
        (Options { min_length_px: f64::INFINITY, ..ok }, "--min-length is inf"),
    ] {
        let message = trace(&image, &options).unwrap_err().to_string();
        assert!(message.contains(name), "{message}");
    }
}
