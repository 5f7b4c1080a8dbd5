//! A picture with truth and found strokes on it, for a person to see what went wrong.

use std::io::Cursor;

use image::{ImageError, ImageFormat, Rgb, RgbImage};
use tracelight_stroke::{Drawing, Point};

use crate::Picture;

/// Shades of the found strokes, in turn.
const SHADES: [[u8; 3]; 6] =
    [[230, 0, 0], [255, 120, 0], [200, 0, 200], [150, 40, 40], [255, 60, 130], [120, 60, 255]];
const TRUTH: [u8; 3] = [0, 170, 0];
/// Pictures up to these rows are shown twice as large.
const ENLARGED_ROWS: usize = 720;

/// The picture, lightened; the truth in green; found strokes over it in shades of red and violet, their ends dotted.
///
/// # Errors
/// When the encoder fails.
pub fn png(picture: &Picture, found: &Drawing) -> Result<Vec<u8>, ImageError> {
    let scale = if picture.height <= ENLARGED_ROWS { 2 } else { 1 };
    let mut shown =
        RgbImage::from_fn((picture.width * scale) as u32, (picture.height * scale) as u32, |x, y| {
            let at = (y as usize / scale) * picture.width + x as usize / scale;
            let light = 90 + (u16::from(picture.levels[at]) * 165 / 255) as u8;
            Rgb([light; 3])
        });
    let mut lay = |drawing: &Drawing, shades: &[[u8; 3]], dot: i32| {
        for (stroke, &shade) in drawing.strokes.iter().zip(shades.iter().cycle()) {
            let points = stroke.path.flatten(0.1);
            along(&mut shown, &points, scale as f64, shade);
            if !stroke.path.is_closed() {
                [points.first(), points.last()].into_iter().flatten().for_each(|&p| {
                    square(&mut shown, p, scale as f64, dot, shade);
                });
            }
        }
    };
    lay(&picture.truth, &[TRUTH], 4);
    lay(found, &SHADES, 2);
    let mut bytes = Vec::new();
    shown.write_to(&mut Cursor::new(&mut bytes), ImageFormat::Png)?;
    Ok(bytes)
}

fn along(on: &mut RgbImage, points: &[Point], scale: f64, shade: [u8; 3]) {
    for pair in points.windows(2) {
        let steps = (pair[0].distance(pair[1]) * scale * 2.0).ceil().max(1.0) as usize;
        (0..=steps).for_each(|i| square(on, pair[0].lerp(pair[1], i as f64 / steps as f64), scale, 0, shade));
    }
}

fn square(on: &mut RgbImage, at: Point, scale: f64, half: i32, shade: [u8; 3]) {
    let (x, y) = ((at.x * scale) as i32, (at.y * scale) as i32);
    for (x, y) in (-half..=half).flat_map(|dy| (-half..=half).map(move |dx| (x + dx, y + dy))) {
        if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y))
            && let Some(pixel) = on.get_pixel_mut_checked(x, y)
        {
            *pixel = Rgb(shade);
        }
    }
}
