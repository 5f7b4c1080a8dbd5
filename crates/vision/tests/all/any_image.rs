//! Any image up to 64 × 64 ends in sound strokes or in an error, in bounded time, and twice in the same.

use std::time::{Duration, Instant};

use oorandom::Rand32;
use tracelight_image::Grey;
use tracelight_stroke::Point;
use tracelight_vision::{Mode, Options, Traced, VisionError, find_two_marks, trace};

const MODES: [Mode; 4] = [Mode::Auto, Mode::Centreline, Mode::Outline, Mode::Sweep];

/// How far outside the image a stroke may reach, px: rounding.
const OUTSIDE_PX: f64 = 1e-9;

/// No image of this size takes longer, whatever else the machine does: the slowest ones take 10 ms.
const LONGEST: Duration = Duration::from_secs(2);

/// Level of the pixel in column `x` of row `y`.
type Pixel<'a> = Box<dyn FnMut(usize, usize) -> u8 + 'a>;

/// A picture of one kind, its figures drawn by `r`.
fn pixel<'a>(kind: u32, (w, h): (usize, usize), r: &'a mut Rand32) -> Pixel<'a> {
    let (ink, paper) = (r.rand_range(0..256) as u8, r.rand_range(0..256) as u8);
    let two = move |inked: bool| if inked { ink } else { paper };
    let (period, share) = (1 + r.rand_range(0..12) as usize, r.rand_range(0..101));
    let (a, b) = (r.rand_range(0..9) as usize, r.rand_range(0..9) as usize);
    match kind {
        0 => Box::new(|_, _| r.rand_range(0..256) as u8),
        1 => Box::new(move |_, _| two(r.rand_range(0..100) < share)),
        2 => Box::new(move |x, y| two((a * x + b * y) / period % 2 == 0)),
        3 => Box::new(move |x, y| two((x / period + y / period).is_multiple_of(2))),
        4 => Box::new(move |x, y| ((a * x * 255 / w + b * y * 255 / h) / (a + b).max(1)) as u8),
        5 => Box::new(move |x, y| two(x * x + y * y < period * period * 8 && (x + a).abs_diff(y + b) > 2)),
        _ => Box::new(move |x, y| if (x, y) == (a * w / 9, b * h / 9) { ink } else { paper }),
    }
}

/// Lines of a round pen, thin or fat, straight across the border too; blots are lines of no length.
fn penned((w, h): (usize, usize), r: &mut Rand32) -> Vec<u8> {
    let paper = [255, 230, 128, 0][r.rand_range(0..4) as usize];
    let mut levels = vec![paper; w * h];
    for _ in 0..1 + r.rand_range(0..6) {
        let mut place =
            || Point::new(f64::from(r.rand_float()) * w as f64, f64::from(r.rand_float()) * h as f64);
        let (a, b) = (place(), place());
        let b = if r.rand_range(0..5) == 0 { a } else { b };
        let (radius, ink) = (0.5 + 6.0 * f64::from(r.rand_float()).powi(3), r.rand_range(0..256) as f64);
        for (i, level) in levels.iter_mut().enumerate() {
            let p = Point::new((i % w) as f64 + 0.5, (i / w) as f64 + 0.5);
            let along = b - a;
            let share = ((p - a).dot(along) / along.hypot2().max(1e-9)).clamp(0.0, 1.0);
            let cover = (radius + 0.5 - p.distance(a + along * share)).clamp(0.0, 1.0);
            *level = (f64::from(*level) * (1.0 - cover) + ink * cover) as u8;
        }
    }
    levels
}

/// Kinds of pictures: those of [`pixel`], and pens most of the time.
const KINDS: u32 = 12;

fn picture(number: u32, r: &mut Rand32) -> Grey {
    let size = (8 + r.rand_range(0..57) as usize, 8 + r.rand_range(0..57) as usize);
    let levels = match number % KINDS {
        kind @ 0..7 => {
            let mut pixel = pixel(kind, size, r);
            (0..size.0 * size.1).map(|i| pixel(i % size.0, i / size.0)).collect()
        }
        _ => penned(size, r),
    };
    Grey::new(size.0, size.1, levels).unwrap()
}

/// How far outside the image the strokes reach, px; everything else about them must be in order.
fn checked(traced: &Traced, what: &str) -> f64 {
    let mut outside = 0.0_f64;
    assert!(!traced.strokes.strokes.is_empty(), "{what}: no stroke is an error");
    assert!((0.0..=1.0).contains(&traced.missed_ink), "{what}: {} missed", traced.missed_ink);
    for stroke in &traced.strokes.strokes {
        let length = stroke.path.length(1e-3);
        assert!(length > 0.0 && length.is_finite(), "{what}: a stroke of length {length}: {stroke:?}");
        let end = stroke.path.pieces().last().unwrap().end();
        let gap = end.distance(stroke.path.start());
        assert!(!stroke.path.is_closed() || gap < 1e-6, "{what}: closed, but for {gap} px");
        for p in stroke.path.flatten(0.1) {
            assert!(p.is_finite(), "{what}: a point at {p:?}");
            let beyond = [-p.x, -p.y, p.x - traced.width_px as f64, p.y - traced.height_px as f64];
            outside = beyond.into_iter().fold(outside, f64::max);
        }
    }
    outside
}

fn timed(image: &Grey, mode: Mode, what: &str) -> Result<Traced, VisionError> {
    let began = Instant::now();
    let found = trace(image, &Options { mode, ..Options::default() });
    assert!(began.elapsed() < LONGEST, "{what}: took {:?}", began.elapsed());
    found
}

fn sweep(pictures: u32, seed: u64) {
    let mut random = Rand32::new(seed);
    let (mut traced, mut furthest) = (0, (0.0, String::new()));
    for number in 0..pictures {
        let image = picture(number, &mut random);
        let _ = find_two_marks(&image);
        for mode in MODES {
            let size = format!("{} × {}", image.width(), image.height());
            let what =
                format!("seed {seed}, picture {number} of kind {}, {size}, {}", number % KINDS, mode.name());
            let found = timed(&image, mode, &what);
            if number.is_multiple_of(7) {
                assert_eq!(found, timed(&image, mode, &what), "{what}: a second run differs");
            }
            let Ok(found) = found else { continue };
            traced += 1;
            let outside = checked(&found, &what);
            if outside > furthest.0 {
                furthest = (outside, what);
            }
        }
    }
    assert!(furthest.0 <= OUTSIDE_PX, "{} px outside the image: {}", furthest.0, furthest.1);
    assert!(traced > pictures, "only {traced} tracings of {pictures} pictures");
}

#[test]
fn any_image_ends_in_sound_strokes_or_in_an_error() {
    sweep(1_800, 1);
}

#[test]
#[ignore = "minutes: `bash .ci/run long`; its short twin always runs"]
fn very_many_images_end_in_sound_strokes_or_in_an_error() {
    (2..30).for_each(|seed| sweep(6_000, seed));
}
