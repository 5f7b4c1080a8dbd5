//! Pictures that are broken, lying, or without a drawing.

use std::io::Cursor;

use image::{DynamicImage, GrayImage, ImageFormat, Luma, RgbaImage};

/// A small clean drawing: a black square on white.
pub(crate) fn drawing() -> DynamicImage {
    let edge = |d: u32| (20..26).contains(&d);
    let ink = |x: u32, y: u32| {
        let (left, top) = (x.min(159 - x), y.min(119 - y));
        left >= 20 && top >= 20 && (edge(left) || edge(top))
    };
    let pixel = |x, y| Luma([if ink(x, y) { 0 } else { 255 }]);
    DynamicImage::from(GrayImage::from_fn(160, 120, pixel)).to_rgb8().into()
}

/// An image as bytes of a file.
pub(crate) fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A picture file: its name and its bytes.
pub(crate) type File = (String, Vec<u8>);

fn file(name: &str, bytes: impl Into<Vec<u8>>) -> File {
    (name.to_owned(), bytes.into())
}

/// Each format cut off at several lengths.
pub(crate) fn truncated() -> Vec<File> {
    use ImageFormat::{Bmp, Gif, Jpeg, Png, Pnm, Tiff, WebP};
    let formats = [
        (Png, "png"),
        (Jpeg, "jpg"),
        (Gif, "gif"),
        (Bmp, "bmp"),
        (Tiff, "tif"),
        (WebP, "webp"),
        (Pnm, "ppm"),
    ];
    let mut files = Vec::new();
    for (format, extension) in formats {
        let whole = encoded(&drawing(), format);
        for (name, length) in [("head", 12), ("third", whole.len() / 3), ("most", whole.len() * 3 / 4)] {
            files.push(file(&format!("cut_{name}.{extension}"), &whole[..length]));
        }
    }
    files
}

/// Files that are no pictures, or lie about themselves.
pub(crate) fn malformed() -> Vec<File> {
    let png = encoded(&drawing(), ImageFormat::Png);
    let bmp = encoded(&drawing(), ImageFormat::Bmp);
    vec![
        file("empty.png", []),
        file("one_byte.png", [0x89]),
        file("zeros.png", [0; 4096]),
        file("text.png", "Dear rig, please draw a house.\n"),
        file("script.jpg", "#!/bin/sh\necho no picture\n"),
        file("bad_checksum.png", with_bad_data_checksum(&png)),
        file("giant.png", with_png_size(&png, 100_000, 100_000)),
        file("overflowing.png", with_png_size(&png, 0x7fff_ffff, 0x7fff_ffff)),
        file("sizeless.png", with_png_size(&png, 0, 0)),
        file("wide.bmp", with_bytes(&bmp, 18, &0x8000_0000_u32.to_le_bytes())),
        file("wider.bmp", with_bytes(&bmp, 18, &0x7fff_ffff_u32.to_le_bytes())),
        file("tall.bmp", with_bytes(&bmp, 22, &0x7fff_ffff_u32.to_le_bytes())),
        file("giant.ppm", "P6 4000000000 4000000000 255\n"),
        file("digits.pgm", format!("P5 {} 1 255\n", "9".repeat(1_000_000))),
        file("hollow.pgm", "P5 9000 9000 255\nnothing more"),
        file("comment.pgm", format!("P5\n#{}", "x".repeat(3_000_000))),
        file("sizeless.gif", b"GIF89a\0\0\0\0\0\0\0;".to_vec()),
        file("giant.gif", giant_gif()),
        file("giant.tif", tiff_of(1 << 31, 1 << 31)),
        file("lost.tif", b"II*\0\xf0\xff\xff\xff".to_vec()),
        file("giant.jpg", jpeg_of(65_500, 65_500)),
        file("panicking.jpg", include_bytes!("../../../../../fuzz/found/picture/panicking_decoder.jpg")),
    ]
}

/// Pictures that can be read but hold nothing to draw.
pub(crate) fn without_drawing() -> Vec<File> {
    let grey = |w, h, value| DynamicImage::from(GrayImage::from_pixel(w, h, Luma([value])));
    let png = |image: DynamicImage| encoded(&image, ImageFormat::Png);
    vec![
        file("white.png", png(grey(640, 480, 255))),
        file("black.png", png(grey(640, 480, 0))),
        file("grey.png", png(grey(640, 480, 128))),
        file("clear.png", png(RgbaImage::new(320, 240).into())),
        file("one_pixel.png", png(grey(1, 1, 0))),
        file("thread.png", png(grey(1, 10_000, 255))),
        file("thread_black.png", png(grey(10_000, 1, 0))),
        file("noise.png", png(noise(640, 480))),
        file("faint.png", png(GrayImage::from_fn(320, 240, |x, y| Luma([127 + ((x + y) % 2) as u8])).into())),
        // a few kilobytes that unfold to nearly 100 megapixels
        file("vast_white.png", png(grey(9_900, 9_900, 255))),
    ]
}

/// Uniform noise from Marsaglia's xorshift32, so that it is the same everywhere.
fn noise(width: u32, height: u32) -> DynamicImage {
    let mut state = 2_463_534_242_u32;
    let pixel = |_, _| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        Luma([(state >> 24) as u8])
    };
    GrayImage::from_fn(width, height, pixel).into()
}

fn with_bytes(file: &[u8], at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut changed = file.to_vec();
    changed[at..at + bytes.len()].copy_from_slice(bytes);
    changed
}

/// The header's size replaced and its checksum made right again: signature 8, length 4, `IHDR` and 13 bytes, CRC.
pub(crate) fn with_png_size(png: &[u8], width: u32, height: u32) -> Vec<u8> {
    let sized = with_bytes(&with_bytes(png, 16, &width.to_be_bytes()), 20, &height.to_be_bytes());
    let checksum = crc32(&sized[12..29]);
    with_bytes(&sized, 29, &checksum.to_be_bytes())
}

/// One bit of the first data chunk's checksum turned over.
fn with_bad_data_checksum(png: &[u8]) -> Vec<u8> {
    let data = find(png, b"IDAT");
    let length = u32::from_be_bytes(png[data - 4..data].try_into().unwrap()) as usize;
    let checksum = data + 4 + length;
    with_bytes(png, checksum, &[png[checksum] ^ 1])
}

fn find(bytes: &[u8], what: &[u8]) -> usize {
    bytes.windows(what.len()).position(|w| w == what).unwrap()
}

/// CRC-32 of ISO 3309, as in the PNG specification's annex D.
fn crc32(bytes: &[u8]) -> u32 {
    let bit = |crc: u32| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| bit(crc)))
}

/// A frame of 65535 × 65535 on a screen as large, in a few bytes.
fn giant_gif() -> Vec<u8> {
    let mut gif = b"GIF89a\xff\xff\xff\xff\x80\0\0\0\0\0\xff\xff\xff".to_vec();
    gif.extend(b",\0\0\0\0\xff\xff\xff\xff\0\x02\x02\x4c\x01\0;");
    gif
}

/// A bilevel TIFF of one strip that declares any size.
fn tiff_of(width: u32, height: u32) -> Vec<u8> {
    let entries =
        [(256, width), (257, height), (258, 8), (259, 1), (262, 1), (273, 8), (278, height), (279, 4)];
    let mut tiff = b"II*\0\x08\0\0\0".to_vec();
    tiff.extend((entries.len() as u16).to_le_bytes());
    for (tag, value) in entries {
        const LONG: u16 = 4;
        tiff.extend(u16::to_le_bytes(tag));
        tiff.extend(LONG.to_le_bytes());
        tiff.extend(1_u32.to_le_bytes());
        tiff.extend(u32::to_le_bytes(value));
    }
    tiff.extend([0; 4]);
    tiff
}

/// A JPEG whose frame header declares another size than its data fill.
pub(crate) fn jpeg_of(width: u16, height: u16) -> Vec<u8> {
    let jpeg = encoded(&drawing(), ImageFormat::Jpeg);
    let frame = find(&jpeg, &[0xff, 0xc0]);
    let sized = with_bytes(&jpeg, frame + 5, &height.to_be_bytes());
    with_bytes(&sized, frame + 7, &width.to_be_bytes())
}
