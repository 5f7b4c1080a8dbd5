//! Bytes of a picture file to something that can be traced.

use std::fmt::Display;
use std::io::Cursor;
use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits, RgbaImage};
use tracelight_formats::{
    Coordinates, FormatError, ReadOptions, Reading, Sheet, csv, dxf, head, json, svg, unpacked,
};
use tracelight_image::Grey;
use tracelight_stroke::{Affine, Drawing, Vec2};
use tracelight_task::Failure;

use crate::cost::{self, Declared, MOST_DECODED_BYTES, too_large};
use crate::quiet::unless_it_panics;
use crate::raster::Raster;
use crate::turned::turned;

/// What a decoder may allocate, bytes: the pixels of the largest picture, and as much again.
const MOST_DECODER_BYTES: u64 = 2 * MOST_DECODED_BYTES;

/// What a file holds.
#[derive(Clone, Debug)]
pub enum Source {
    /// Pixels, to be traced.
    Pixels(Pixels),
    /// Strokes, to be taken as they are.
    Strokes(Reading),
}

/// A decoded picture, upright, on paper where it was transparent.
#[derive(Clone, Debug)]
pub struct Pixels {
    /// For display.
    pub colour: Raster,
    /// For tracing.
    pub grey: Grey,
}

/// What a file's bytes are; `path` is for messages, and its extension for contents that say nothing of themselves.
///
/// # Errors
/// What is wrong with the file: broken, cut off, too large, of a kind that is not read, or with nothing in it.
pub fn decode(path: &str, bytes: &[u8]) -> Result<Source, Failure> {
    decode_with(path, bytes, &ReadOptions::default())
}

/// As [`decode`]; a drawing is read by the options, pixels have none.
///
/// # Errors
/// As there.
pub fn decode_with(path: &str, bytes: &[u8], options: &ReadOptions) -> Result<Source, Failure> {
    let malformed = |e: &FormatError| match e {
        FormatError::Nothing { .. } | FormatError::Undrawn { .. } => {
            Failure::failed("no-strokes", format!("{path}: {e}"))
        }
        _ => Failure::usage("malformed", format!("{path}: {}", brief(e))),
    };
    let bytes = &*unpacked(bytes).map_err(|e| malformed(&e))?;
    let extension = Path::new(path).extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    match kind_of(bytes, extension.as_deref()) {
        Kind::Svg => svg::read_with(bytes, options).map(Source::Strokes).map_err(|e| malformed(&e)),
        Kind::Dxf => dxf::read_with(bytes, options).map(Source::Strokes).map_err(|e| malformed(&e)),
        Kind::Json => json::read(bytes).map(|t| whole(t.sheet)).map_err(|e| malformed(&e)),
        Kind::Csv => csv::read(bytes).map(|d| whole(sheet_about(&d))).map_err(|e| malformed(&e)),
        Kind::Image => image(path, bytes).map(Source::Pixels),
    }
}

/// A sheet that is all its file holds.
fn whole(sheet: Sheet) -> Source {
    Source::Strokes(Reading::of_list(sheet))
}

/// A sheet of true size whose centre is the target's origin, just large enough for a drawing in target metres.
fn sheet_about(drawing: &Drawing) -> Sheet {
    const LEAST_M: f64 = 1e-3;
    let points = drawing.strokes.iter().flat_map(|s| s.path.flatten(LEAST_M));
    let reach =
        points.fold(Vec2::new(LEAST_M, LEAST_M), |r, p| Vec2::new(r.x.max(p.x.abs()), r.y.max(p.y.abs())));
    let sheet_from_file = Affine::FLIP_Y.then_translate(reach);
    Sheet {
        width: 2.0 * reach.x,
        height: 2.0 * reach.y,
        metres_per_unit: Some(1.0),
        drawing: drawing.transformed(sheet_from_file),
        coordinates: Coordinates::File(sheet_from_file),
        places: Vec::new(),
    }
}

enum Kind {
    Svg,
    Dxf,
    Json,
    Csv,
    Image,
}

/// By content; a name only decides where the content is silent.
fn kind_of(bytes: &[u8], extension: Option<&str>) -> Kind {
    if image::guess_format(bytes).is_ok() {
        return Kind::Image;
    }
    let head = head(bytes);
    match extension {
        _ if is_dxf(bytes, &head) => Kind::Dxf,
        _ if head.starts_with('<') => Kind::Svg,
        _ if head.starts_with('{') => Kind::Json,
        _ if csv::is_header(head.lines().next().unwrap_or_default()) => Kind::Csv,
        Some("svg" | "svgz") => Kind::Svg,
        Some("dxf") => Kind::Dxf,
        Some("json") => Kind::Json,
        Some("csv") => Kind::Csv,
        _ => Kind::Image,
    }
}

/// A first group of code 0 (a section) or 999 (a comment); or what says that it is of a kind no one reads.
fn is_dxf(bytes: &[u8], head: &str) -> bool {
    let mut lines = head.lines().map(str::trim);
    let ascii = match (lines.next(), lines.next()) {
        (Some("0"), Some(second)) => second == "SECTION",
        (Some("999"), Some(_)) => true,
        _ => false,
    };
    ascii || bytes.starts_with(b"AutoCAD Binary DXF") || bytes.starts_with(b"AC10")
}

fn image(path: &str, bytes: &[u8]) -> Result<Pixels, Failure> {
    // the decoder for JPEG panics on some broken files (zune-image's issue 362)
    unless_it_panics(|| decode_image(path, bytes))
        .unwrap_or_else(|| Err(broken(path, "its decoder gave up on it")))
}

/// What to do about a file of a kind that people have and that is not read here, by its first bytes.
fn way_out(bytes: &[u8]) -> Option<&'static str> {
    const HEIC: [&[u8]; 7] = [b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1"];
    match bytes {
        [_, _, _, _, b'f', b't', b'y', b'p', brand @ ..]
            if HEIC.iter().any(|name| brand.starts_with(name)) =>
        {
            Some(
                "it is a HEIC photo: share it as JPEG (iPhone: Settings, Camera, Formats, Most Compatible), or run heif-convert on it",
            )
        }
        [b'%', b'P', b'D', b'F', ..] => Some(
            "it is a PDF (or an Illustrator file): save its drawing as SVG (pdftocairo -svg, Inkscape), or its page as PNG (pdftoppm -png -r 200)",
        ),
        [b'%', b'!', b'P', b'S', ..] | [0xc5, 0xd0, 0xd3, 0xc6, ..] => {
            Some("it is PostScript (EPS, Illustrator): open it with Inkscape and save it as SVG")
        }
        [b'8', b'B', b'P', b'S', ..] => Some("it is a Photoshop file: export it as PNG"),
        _ => None,
    }
}

fn broken(path: &str, what: &str) -> Failure {
    Failure::usage("malformed", format!("{path} is broken: {what}; save it again or give another file"))
}

fn decode_image(path: &str, bytes: &[u8]) -> Result<Pixels, Failure> {
    let not_a_picture = || {
        let known = "PNG, JPEG, WebP, BMP, GIF, PNM, TIFF, SVG, DXF, JSON or CSV";
        let way = way_out(bytes).map_or_else(String::new, |way| format!("; {way}"));
        Failure::usage("not-a-picture", format!("{path} is none of {known}{way}"))
    };
    let unread = |e: ImageError| match e {
        ImageError::Limits(_) => too_large(path, "more than the memory a picture may take"),
        ImageError::Unsupported(_) => {
            Failure::usage("unsupported", format!("{path}: {}; save it as PNG", brief(&e)))
        }
        _ => broken(path, &brief(&e)),
    };
    let mut reader =
        ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|_| not_a_picture())?;
    let format = reader.format();
    if format.is_none() {
        return Err(not_a_picture());
    }
    if format == Some(ImageFormat::Jpeg) && !jpeg_is_whole(bytes) {
        return Err(Failure::usage(
            "malformed",
            format!("{path} is cut off: its picture has no end; save it again"),
        ));
    }
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_DECODER_BYTES);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(unread)?;
    let (width, height) = decoder.dimensions();
    cost::check(path, Declared { format, width, height, colour: decoder.color_type() }, bytes)?;
    let upright = decoder.orientation().ok();
    let image = DynamicImage::from_decoder(decoder).map_err(unread)?;
    pixels(path, image, upright.unwrap_or(Orientation::NoTransforms))
}

/// What a decoder says, cut off where it goes on to repeat the file.
fn brief(error: &impl Display) -> String {
    const MOST_CHARACTERS: usize = 500;
    let text = error.to_string();
    match text.char_indices().nth(MOST_CHARACTERS) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text,
    }
}

/// Whether the last scan of a JPEG ends: decoders fill what is missing with grey. Within a scan 0xFF is followed by 0,
/// so neither marker can be picture data; a thumbnail's stand before the picture's (ITU-T T.81, §B.1.1.3).
#[must_use]
pub fn jpeg_is_whole(bytes: &[u8]) -> bool {
    let last = |marker: u8| bytes.windows(2).rposition(|w| w == [0xFF, marker]);
    let (start_of_scan, end_of_image) = (last(0xDA), last(0xD9));
    start_of_scan.is_none() || end_of_image > start_of_scan
}

/// Alpha on paper, 8 bit, upright, and the luma of it. Turned when it is 8-bit colour: a copy of what was decoded may be
/// three times as large.
fn pixels(path: &str, image: DynamicImage, upright: Orientation) -> Result<Pixels, Failure> {
    let size = (image.width() as usize, image.height() as usize);
    let rgb = if image.color().has_alpha() { on_paper(image) } else { image.into_rgb8().into_raw() };
    let ((width, height), rgb) = turned(size, rgb, upright);
    let luma = rgb.chunks_exact(3).map(luma).collect();
    let grey = Grey::new(width, height, luma)
        .map_err(|e| Failure::failed("no-strokes-found", format!("{path}: {e}")))?;
    let colour = Raster::new(width as u32, height as u32, rgb)
        .ok_or_else(|| Failure::usage("malformed", format!("{path} has no pixels")))?;
    Ok(Pixels { colour, grey })
}

/// Alpha on white paper, or on black where hardly anything that is seen would show on white; in the picture's own bytes.
fn on_paper(image: DynamicImage) -> Vec<u8> {
    let rgba = image.into_rgba8();
    let paper = if is_light(&rgba) { 0 } else { 255 };
    let blend = |c: u8, a: u8| {
        let (c, a) = (u32::from(c), u32::from(a));
        ((c * a + paper * (255 - a) + 127) / 255) as u8
    };
    let mut bytes = rgba.into_raw();
    let pixels = bytes.len() / 4;
    for pixel in 0..pixels {
        let alpha = bytes[4 * pixel + 3];
        for channel in 0..3 {
            bytes[3 * pixel + channel] = blend(bytes[4 * pixel + channel], alpha);
        }
    }
    bytes.truncate(3 * pixels);
    bytes.shrink_to_fit();
    bytes
}

/// Whether what is seen of a picture is light ink: light in the mean, and hardly any of it dark. A light figure with
/// dark lines, or a page with clear corners, is drawn on white.
fn is_light(rgba: &RgbaImage) -> bool {
    let (mut seen, mut light, mut dark) = (0_u64, 0_u64, 0_u64);
    for p in rgba.pixels() {
        let (alpha, level) = (u64::from(p.0[3]), u64::from(luma(&p.0[..3])));
        seen += alpha;
        light += alpha * level;
        dark += if level < 128 { alpha } else { 0 };
    }
    let all = 255 * u64::from(rgba.width()) * u64::from(rgba.height());
    // ink covers less than half of a picture and fringes of it may be dark; a page covers more, and its ink may be
    // one part in two hundred
    let most_dark = if 2 * seen < all { seen / 20 } else { seen / 200 };
    2 * light > 255 * seen && dark <= most_dark
}

/// ITU-R BT.601 luma in integers.
fn luma(rgb: &[u8]) -> u8 {
    let [r, g, b] = [rgb[0], rgb[1], rgb[2]].map(u32::from);
    ((299 * r + 587 * g + 114 * b + 500) / 1000) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// A bar of one colour across a transparent picture, and a dash of another in it.
    fn bar(bar: [u8; 4], dash: [u8; 4], rows: std::ops::Range<u32>) -> DynamicImage {
        let colour = |x: u32, y: u32| match (rows.contains(&y), (x, y)) {
            (true, (20..40, 10..15)) => dash,
            (true, _) => bar,
            (false, _) => [0, 0, 0, 0],
        };
        RgbaImage::from_fn(100, 100, |x, y| Rgba(colour(x, y))).into()
    }

    #[test]
    fn light_ink_lies_on_black_paper_and_all_else_on_white() {
        let corner = |image| on_paper(image)[0];
        let (white, black, grey) = ([255, 255, 255, 255], [0, 0, 0, 255], [90, 90, 90, 255]);
        assert_eq!(corner(bar(white, white, 8..18)), 0, "white ink");
        assert_eq!(corner(bar([255, 255, 0, 90], white, 8..18)), 0, "faint yellow ink");
        assert_eq!(corner(bar(black, black, 8..18)), 255, "black ink");
        assert_eq!(corner(bar(grey, grey, 8..18)), 255, "grey ink");
        assert_eq!(corner(bar(white, black, 8..18)), 255, "a light figure with dark lines");
        assert_eq!(corner(bar(white, black, 4..98)), 255, "a page with clear borders");
        assert_eq!(corner(bar([0; 4], [0; 4], 0..0)), 255, "nothing");
    }

    fn strokes(name: &str, bytes: &[u8]) -> Reading {
        match decode(name, bytes) {
            Ok(Source::Strokes(reading)) => reading,
            other => panic!("{name}: {other:?}"),
        }
    }

    #[test]
    fn drawings_are_known_by_their_content_packed_or_not() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='9mm' height='9mm'><path d='M1 1h7' stroke='red'/></svg>";
        let wide: Vec<u8> = format!("\u{feff}{svg}").encode_utf16().flat_map(u16::to_be_bytes).collect();
        let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        std::io::Write::write_all(&mut packer, &wide).unwrap();
        for bytes in [svg.as_bytes().to_vec(), wide, packer.finish().unwrap()] {
            assert_eq!(strokes("no-extension", &bytes).sheet.drawing.strokes.len(), 1);
        }
        let table = strokes("no-extension", b"x_mm;y_mm\n0,5;0\n100,5;0\n");
        assert!((table.sheet.drawing.length(1e-9) - 0.1).abs() < 1e-9);
        let json = r#"{"width_px":4,"height_px":3,"strokes":[{"closed":false,"points":[[0,0],[3,2]]}]}"#;
        assert_eq!(strokes("no-extension", json.as_bytes()).sheet.drawing.strokes.len(), 1);
        assert!(strokes("map.csv", b"0,0\n250,0\n").doubt.unwrap().contains("--width"));
    }
}
