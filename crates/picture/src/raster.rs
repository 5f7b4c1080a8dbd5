//! Pixels in colour.

use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};
use png::{BitDepth, ColorType, Compression, Filter};
use tracelight_stroke::Point;

/// An RGB picture, eight bits a channel, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    width: u32,
    height: u32,
    rgb: Vec<u8>,
}

impl Raster {
    /// A picture from its bytes, three a pixel; `None` when their number does not fit the size or it has no pixel.
    #[must_use]
    pub fn new(width: u32, height: u32, rgb: Vec<u8>) -> Option<Self> {
        let wanted = (width as usize).checked_mul(height as usize)?.checked_mul(3)?;
        (wanted > 0 && wanted == rgb.len()).then_some(Self { width, height, rgb })
    }

    /// A picture whose rows are made by `row(y, bytes)`, rows shared out among the processor's cores.
    #[must_use]
    pub fn from_rows(width: u32, height: u32, row: impl Fn(u32, &mut [u8]) + Sync) -> Self {
        let stride = width.max(1) as usize * 3;
        let mut rgb = vec![0; stride * height.max(1) as usize];
        share_rows(&mut rgb, stride, |y, bytes| row(y as u32, bytes));
        Self { width: width.max(1), height: height.max(1), rgb }
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// Its bytes, three a pixel.
    #[must_use]
    pub fn rgb(&self) -> &[u8] {
        &self.rgb
    }

    /// The pixel at column `x`, row `y`, both clamped into the picture.
    #[must_use]
    pub fn pixel(&self, x: i64, y: i64) -> [u8; 3] {
        let x = x.clamp(0, i64::from(self.width) - 1) as usize;
        let y = y.clamp(0, i64::from(self.height) - 1) as usize;
        let at = (y * self.width as usize + x) * 3;
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }

    /// The colour at a place, pixel frame, between pixels evenly.
    #[must_use]
    pub fn between(&self, at: Point) -> [u8; 3] {
        let (x, y) = (at.x - 0.5, at.y - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (fx, fy) = (x - left, y - top);
        let pixel = |dx: i64, dy: i64| self.pixel(left as i64 + dx, top as i64 + dy);
        let (a, b, c, d) = (pixel(0, 0), pixel(1, 0), pixel(0, 1), pixel(1, 1));
        std::array::from_fn(|k| {
            let of = |p: [u8; 3]| f64::from(p[k]);
            let (upper, lower) = (of(a) + fx * (of(b) - of(a)), of(c) + fx * (of(d) - of(c)));
            (upper + fy * (lower - upper)).round() as u8
        })
    }

    /// The picture made to fit a square of `side` pixels by averaging; one that fits already stays as it is.
    #[must_use]
    pub fn shrunk(&self, side: u32) -> Self {
        let longest = self.width.max(self.height);
        if longest <= side {
            return self.clone();
        }
        let scaled =
            |n: u32| ((u64::from(n) * u64::from(side) / u64::from(longest)) as u32).clamp(1, side.max(1));
        let (width, height) = (scaled(self.width), scaled(self.height));
        Self::from_rows(width, height, |y, row| {
            let rows = share(y, height, self.height);
            for (x, out) in row.chunks_exact_mut(3).enumerate() {
                out.copy_from_slice(&self.mean(share(x as u32, width, self.width), rows));
            }
        })
    }

    /// Mean colour of a block of columns and rows.
    fn mean(&self, columns: (u32, u32), rows: (u32, u32)) -> [u8; 3] {
        let mut sum = [0_u64; 3];
        for y in rows.0..rows.1 {
            let from = (y as usize * self.width as usize + columns.0 as usize) * 3;
            let to = from + (columns.1 - columns.0) as usize * 3;
            for pixel in self.rgb[from..to].chunks_exact(3) {
                (0..3).for_each(|c| sum[c] += u64::from(pixel[c]));
            }
        }
        let count = u64::from(columns.1 - columns.0) * u64::from(rows.1 - rows.0);
        sum.map(|s| ((s + count / 2) / count) as u8)
    }

    /// The picture as a PNG file. Speed over size: the wall's texture hardly compresses either way.
    ///
    /// # Errors
    /// What the encoder says: of a picture that fits its bytes, nothing.
    pub fn png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::with_capacity(self.rgb.len());
        let mut encoder = png::Encoder::new(&mut bytes, self.width, self.height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        encoder.set_filter(Filter::Up);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.write_header()?.write_image_data(&self.rgb)?;
        Ok(bytes)
    }

    /// The picture as a JPEG file of `quality` 1 to 100.
    ///
    /// # Errors
    /// Where it has more than 65 535 columns or rows, which no JPEG has.
    pub fn jpeg(&self, quality: u8) -> Result<Vec<u8>, ImageError> {
        let mut bytes = Vec::new();
        let encoder = JpegEncoder::new_with_quality(&mut bytes, quality);
        encoder.write_image(&self.rgb, self.width, self.height, ExtendedColorType::Rgb8)?;
        Ok(bytes)
    }
}

/// The half-open range of `of` source cells that cell `i` of `cells` covers; never empty.
fn share(i: u32, cells: u32, of: u32) -> (u32, u32) {
    let edge = |i: u32| (u64::from(i) * u64::from(of) / u64::from(cells)) as u32;
    let from = edge(i).min(of - 1);
    (from, edge(i + 1).clamp(from + 1, of))
}

/// Fills rows of `stride` bytes by `fill(y, row)`, in bands on all cores. What each row becomes does not depend on
/// their number.
fn share_rows(bytes: &mut [u8], stride: usize, fill: impl Fn(usize, &mut [u8]) + Sync) {
    let rows = bytes.len() / stride.max(1);
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(8);
    let band = rows.div_ceil(cores).max(1);
    if cores == 1 {
        // where there are no threads there is one core
        bytes.chunks_exact_mut(stride.max(1)).enumerate().for_each(|(y, row)| fill(y, row));
        return;
    }
    std::thread::scope(|scope| {
        for (number, rows) in bytes.chunks_mut(band * stride).enumerate() {
            let fill = &fill;
            scope.spawn(move || {
                for (i, row) in rows.chunks_exact_mut(stride).enumerate() {
                    fill(number * band + i, row);
                }
            });
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_do_not_fit_the_size_are_no_picture() {
        assert!(Raster::new(2, 2, vec![0; 12]).is_some());
        assert!(Raster::new(2, 2, vec![0; 11]).is_none());
        assert!(Raster::new(0, 2, vec![]).is_none());
        assert!(Raster::new(u32::MAX, u32::MAX, vec![0; 3]).is_none());
    }

    #[test]
    fn shrinking_averages_and_keeps_the_shape() {
        let chequered = (0..64 * 32).flat_map(|i| [if (i + i / 64) % 2 == 0 { 0 } else { 200 }; 3]).collect();
        let small = Raster::new(64, 32, chequered).unwrap().shrunk(16);
        assert_eq!((small.width(), small.height()), (16, 8));
        assert!(small.rgb.iter().all(|&v| v == 100), "{:?}", &small.rgb[..12]);
    }

    #[test]
    fn a_sliver_keeps_at_least_one_pixel_across() {
        let small = Raster::new(3000, 1, vec![9; 9000]).unwrap().shrunk(100);
        assert_eq!((small.width(), small.height()), (100, 1));
    }

    #[test]
    fn a_png_comes_back_as_it_was() {
        let bytes: Vec<u8> = (0..5 * 4 * 3).map(|i| (i * 37 % 256) as u8).collect();
        let raster = Raster::new(5, 4, bytes.clone()).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(raster.png().unwrap())).read_info().unwrap();
        let mut back = vec![0; 60];
        reader.next_frame(&mut back).unwrap();
        assert_eq!(back, bytes);
    }
}
