//! How cameras that are plugged in code pixels.

use std::borrow::Cow;

use tracelight_picture::{Raster, jpeg_is_whole};

/// How an image's bytes mean pixels; named by four characters, as in Video4Linux and UVC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// A JPEG file each.
    Jpeg,
    /// Two pixels in four bytes: Y U Y V.
    Yuyv,
    /// Two pixels in four bytes: U Y V Y.
    Uyvy,
    /// All Y, then U V of four pixels each.
    Nv12,
    /// All Y, then all U, then all V of four pixels each.
    Yu12,
    /// One byte a pixel.
    Grey,
    /// Three bytes a pixel.
    Rgb,
    /// Three bytes a pixel, blue first.
    Bgr,
}

impl Coding {
    /// All that are understood.
    const ALL: [([u8; 4], Self); 9] = [
        (*b"YUYV", Self::Yuyv),
        (*b"UYVY", Self::Uyvy),
        (*b"NV12", Self::Nv12),
        (*b"YU12", Self::Yu12),
        (*b"GREY", Self::Grey),
        (*b"RGB3", Self::Rgb),
        (*b"BGR3", Self::Bgr),
        (*b"MJPG", Self::Jpeg),
        (*b"JPEG", Self::Jpeg),
    ];

    /// The coding of that name, if it is understood.
    #[must_use]
    pub fn named(name: [u8; 4]) -> Option<Self> {
        Self::ALL.iter().find(|known| known.0 == name).map(|known| known.1)
    }

    /// Bytes of a row of the first plane.
    const fn row(self, width: usize) -> usize {
        match self {
            Self::Jpeg => 0,
            Self::Yuyv | Self::Uyvy => 2 * width,
            Self::Nv12 | Self::Yu12 | Self::Grey => width,
            Self::Rgb | Self::Bgr => 3 * width,
        }
    }
}

/// How the bytes of an image lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    coding: Coding,
    /// Columns, rows.
    size_px: [usize; 2],
    /// Bytes from one row to the next, of the first plane; no fewer than its pixels take.
    stride: usize,
    /// Whether Y goes from 0 to 255, and not from 16 to 235.
    full_range: bool,
}

/// Most pixels of an image.
const MOST_PIXELS: usize = 100_000_000;

impl Layout {
    /// A layout of columns and rows, so many bytes from row to row; `None` where pixels that share a colour would have no partner, or an
    /// image would have no pixel, or too many.
    #[must_use]
    pub fn new(coding: Coding, size_px: [usize; 2], stride: usize, full_range: bool) -> Option<Self> {
        let shared = matches!(coding, Coding::Yuyv | Coding::Uyvy | Coding::Nv12 | Coding::Yu12);
        let pixels = size_px[0].checked_mul(size_px[1]).filter(|n| (1..=MOST_PIXELS).contains(n))?;
        let stride = stride.max(coding.row(size_px[0]));
        let is_even = size_px.iter().chain([&stride]).all(|n| n % 2 == 0);
        (stride <= 8 * pixels && (is_even || !shared)).then_some(Self { coding, size_px, stride, full_range })
    }

    /// How pixels are coded.
    #[must_use]
    pub const fn coding(&self) -> Coding {
        self.coding
    }

    /// Whether bytes may be a whole image: a camera whose cable is bad sends half ones.
    #[must_use]
    pub fn is_whole(&self, bytes: &[u8]) -> bool {
        match self.coding {
            Coding::Jpeg => begins(bytes) && jpeg_is_whole(bytes),
            _ => bytes.len() >= self.bytes(),
        }
    }

    /// Whether it may be a JPEG file but for its end, which some cameras never send.
    #[must_use]
    pub fn is_endless(&self, bytes: &[u8]) -> bool {
        self.coding == Coding::Jpeg && begins(bytes) && !jpeg_is_whole(bytes)
    }

    /// Fewest bytes of an image.
    fn bytes(&self) -> usize {
        let ([width, height], stride) = (self.size_px, self.stride);
        match self.coding {
            Coding::Nv12 => stride * height + stride * (height / 2 - 1) + width,
            Coding::Yu12 => stride * height + stride / 2 * 2 * (height / 2),
            _ => stride * (height - 1) + self.coding.row(width),
        }
    }

    /// An image's pixels; `None` of JPEG, which a decoder reads, and where bytes are missing.
    #[must_use]
    pub fn pixels(&self, bytes: &[u8]) -> Option<Raster> {
        if self.coding == Coding::Jpeg || !self.is_whole(bytes) {
            return None;
        }
        let [width, height] = self.size_px;
        let mut rgb = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            for x in 0..width {
                rgb.extend(self.pixel(bytes, x, y));
            }
        }
        Raster::new(u32::try_from(width).ok()?, u32::try_from(height).ok()?, rgb)
    }

    /// One pixel.
    fn pixel(&self, bytes: &[u8], x: usize, y: usize) -> [u8; 3] {
        let row = &bytes[y * self.stride..];
        let pair = 4 * (x / 2);
        let planes = self.stride * self.size_px[1];
        match self.coding {
            Coding::Jpeg => [0; 3],
            Coding::Grey => [row[x]; 3],
            Coding::Rgb => [row[3 * x], row[3 * x + 1], row[3 * x + 2]],
            Coding::Bgr => [row[3 * x + 2], row[3 * x + 1], row[3 * x]],
            Coding::Yuyv => self.colour([row[2 * x], row[pair + 1], row[pair + 3]]),
            Coding::Uyvy => self.colour([row[2 * x + 1], row[pair], row[pair + 2]]),
            Coding::Nv12 => {
                let two = &bytes[planes + self.stride * (y / 2) + x / 2 * 2..];
                self.colour([row[x], two[0], two[1]])
            }
            Coding::Yu12 => {
                let (half, at) = (self.stride / 2, self.stride / 2 * (y / 2) + x / 2);
                let u = planes + at;
                self.colour([row[x], bytes[u], bytes[u + half * (self.size_px[1] / 2)]])
            }
        }
    }

    /// Red, green and blue of Y, Cb and Cr (Rec. ITU-R BT.601-7, §2.5).
    fn colour(&self, [y, cb, cr]: [u8; 3]) -> [u8; 3] {
        let (luma, chroma) = if self.full_range {
            (f32::from(y), 1.0)
        } else {
            ((f32::from(y) - 16.0) * (255.0 / 219.0), 255.0 / 224.0)
        };
        let [cb, cr] = [cb, cr].map(|c| (f32::from(c) - 128.0) * chroma);
        [luma + 1.402 * cr, luma - 0.344_136 * cb - 0.714_136 * cr, luma + 1.772 * cb]
            .map(|level| level.round().clamp(0.0, 255.0) as u8)
    }
}

/// Whether bytes begin as a JPEG file does, as far as its lines.
fn begins(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xd8]) && bytes.windows(2).any(|two| two == [0xff, 0xda])
}

/// What a camera sends as a JPEG file that every decoder reads. Many leave out the tables by which it was compressed, and mean the usual ones (ITU-T T.81,
/// annex K.3), as the JPEG of AVI files does: that it is such a one, a segment tells the decoder. Some leave out the end.
#[must_use]
pub fn as_file(bytes: &[u8]) -> Cow<'_, [u8]> {
    const AS_IN_AVI: [u8; 18] = [0xff, 0xe0, 0, 16, b'A', b'V', b'I', b'1', 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    let tables: &[u8] = if has_tables(bytes) { &[] } else { &AS_IN_AVI };
    let end: &[u8] = if jpeg_is_whole(bytes) { &[] } else { &[0xff, 0xd9] };
    match bytes {
        [a, b, rest @ ..] if !tables.is_empty() || !end.is_empty() => {
            Cow::Owned([&[*a, *b], tables, rest, end].concat())
        }
        _ => Cow::Borrowed(bytes),
    }
}

/// Whether a JPEG file says by which tables it was compressed, or is none.
fn has_tables(bytes: &[u8]) -> bool {
    let mut at = 2;
    // segments: a mark of two bytes, a length of two that counts itself
    while let Some([0xff, mark, high, low]) = bytes.get(at..at + 4) {
        match mark {
            0xc4 => return true,
            0xda => return false,
            _ => at += 2 + usize::from(u16::from_be_bytes([*high, *low])),
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(name: &[u8; 4], size_px: [usize; 2], stride: usize) -> Layout {
        Layout::new(Coding::named(*name).unwrap(), size_px, stride, false).unwrap()
    }

    #[test]
    fn two_pixels_red_and_blue_are_those_in_every_coding() {
        // Y, Cb, Cr of pure red, of pure blue, and of both on average: BT.601's bars at 100 %
        let (red, blue) = ([82, 90, 240], [41, 240, 110]);
        let [_, cb, cr] = [0, 1, 2].map(|k| ((u16::from(red[k] as u8) + u16::from(blue[k] as u8)) / 2) as u8);
        let rows = |row: &[u8]| [row, row].concat();
        for (name, stride, bytes) in [
            (b"YUYV", 4, rows(&[82, cb, 41, cr])),
            (b"UYVY", 4, rows(&[cb, 82, cr, 41])),
            (b"NV12", 2, vec![82, 41, 82, 41, cb, cr]),
            (b"YU12", 2, vec![82, 41, 82, 41, cb, cr]),
        ] {
            let raster = layout(name, [2, 2], stride).pixels(&bytes).unwrap();
            // one colour for both, as bright as each is
            let grey = |p: &[u8]| 0.299 * f64::from(p[0]) + 0.587 * f64::from(p[1]) + 0.114 * f64::from(p[2]);
            let [first, second] = [0, 3].map(|at| &raster.rgb()[at..at + 3]);
            assert!(first[0] > first[1] && first[2] > first[1], "{name:?} {first:?}");
            assert!((grey(first) - 76.8).abs() < 2.0, "{name:?} {first:?}");
            assert!(grey(second) < grey(first) - 20.0, "{name:?} {second:?}");
        }
        let red = layout(b"YUYV", [2, 2], 4).pixels(&rows(&[82, 90, 82, 240])).unwrap();
        assert!(
            red.rgb().iter().zip([254, 0, 0].into_iter().cycle()).all(|(is, want)| is.abs_diff(want) < 3),
            "{red:?}"
        );
    }

    #[test]
    fn rows_may_be_longer_than_their_pixels() {
        let raster = layout(b"GREY", [2, 2], 4).pixels(&[1, 2, 99, 99, 3, 4]).unwrap();
        assert_eq!(raster.rgb(), [1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4]);
        let raster = layout(b"BGR3", [1, 2], 4).pixels(&[3, 2, 1, 99, 6, 5, 4]).unwrap();
        assert_eq!(raster.rgb(), [1, 2, 3, 4, 5, 6]);
        let raster = layout(b"RGB3", [1, 1], 3).pixels(&[1, 2, 3]).unwrap();
        assert_eq!(raster.rgb(), [1, 2, 3]);
    }

    #[test]
    fn half_an_image_is_none() {
        for (name, stride, whole) in
            [(b"YUYV", 10, 38), (b"NV12", 6, 34), (b"YU12", 6, 36), (b"GREY", 5, 19), (b"RGB3", 12, 48)]
        {
            let layout = layout(name, [4, 4], stride);
            for bytes in 0..=whole {
                assert_eq!(layout.pixels(&vec![7; bytes]).is_some(), bytes == whole, "{name:?} {bytes}");
            }
        }
        let jpeg = layout(b"MJPG", [4, 4], 0);
        assert!(jpeg.is_whole(&[0xff, 0xd8, 0xff, 0xda, 1, 0xff, 0xd9, 0, 0]));
        // the second has the end of a thumbnail only
        for (cut, endless) in [
            (&[0xff, 0xd8, 1, 2][..], false),
            (&[0xff, 0xd8, 0xff, 0xd9, 0xff, 0xda, 1], true),
            (&[1, 0xff, 0xd9], false),
            (&[], false),
        ] {
            assert!(!jpeg.is_whole(cut) && jpeg.is_endless(cut) == endless, "{cut:?}");
        }
        assert_eq!(Coding::named(*b"H264"), None);
        assert_eq!(Layout::new(Coding::Yuyv, [3, 2], 0, false), None);
        assert_eq!(Layout::new(Coding::Grey, [0, 2], 0, false), None);
        assert_eq!(Layout::new(Coding::Grey, [usize::MAX, 2], 0, false), None);
    }
}
