//! A JPEG's frame and scans, read off its markers (ITU-T T.81, annex B) before anything is decoded.

/// What of a JPEG its decoder works and allocates for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Scans {
    /// Scans: each may go over the whole picture.
    pub(crate) scans: u64,
    /// Samples for each hundred pixels, all components together: 300 where none is coarser than the others.
    pub(crate) samples_percent: u64,
    /// Whether all coefficients are held until the last scan.
    pub(crate) is_held: bool,
}

const START_OF_SCAN: u8 = 0xDA;
const END_OF_IMAGE: u8 = 0xD9;

impl Scans {
    /// Of a file that begins as a JPEG does; what is cut off or no JPEG is read as far as it goes.
    pub(crate) fn of(bytes: &[u8]) -> Self {
        let mut found = Self::default();
        let mut at = 2;
        while let Some((marker, body)) = next_marker(bytes, &mut at) {
            match marker {
                END_OF_IMAGE => break,
                START_OF_SCAN => found.scans += 1,
                // frames; 0xC4, 0xC8 and 0xCC are tables and an extension
                0xC0..=0xCF if !matches!(marker, 0xC4 | 0xC8 | 0xCC) => {
                    found.samples_percent = samples_percent(body);
                    found.is_held |= matches!(marker, 0xC2 | 0xC6 | 0xCA | 0xCE);
                }
                _ => {}
            }
        }
        found.is_held |= found.scans > 1;
        found
    }
}

/// The next marker that has a body, with it. What stands between, a scan's data, is passed over: there 0xFF is followed by
/// 0 or by a restart.
fn next_marker<'a>(bytes: &'a [u8], at: &mut usize) -> Option<(u8, &'a [u8])> {
    loop {
        *at += bytes.get(*at..)?.iter().position(|&b| b == 0xFF)? + 1;
        match *bytes.get(*at)? {
            // filling, stuffing, restarts
            0xFF => {}
            0x00 | 0x01 | 0xD0..=0xD8 => *at += 1,
            END_OF_IMAGE => return Some((END_OF_IMAGE, &[])),
            marker => {
                let length = usize::from(u16::from_be_bytes([*bytes.get(*at + 1)?, *bytes.get(*at + 2)?]));
                let from = *at + 3;
                *at = (*at + 1 + length.max(2)).min(bytes.len());
                return Some((marker, bytes.get(from..*at).unwrap_or_default()));
            }
        }
    }
}

/// Of a frame's header: precision, height, width, the number of components, and of each its number, its sampling either
/// way, and its table.
fn samples_percent(frame: &[u8]) -> u64 {
    let components = frame.get(6..).unwrap_or_default().chunks_exact(3).take(4);
    let sampling = components.map(|c| (u64::from(c[1] >> 4), u64::from(c[1] & 15)));
    let (most_h, most_v) = sampling.clone().fold((1, 1), |(h, v), s| (h.max(s.0), v.max(s.1)));
    sampling.map(|(h, v)| 100 * h * v / (most_h * most_v)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of three components, the two last of which are half as fine either way, and so many scans.
    fn jpeg(frame: u8, scans: usize) -> Vec<u8> {
        let mut bytes = vec![0xFF, 0xD8, 0xFF, 0xE1, 0, 4, 0xFF, START_OF_SCAN, 0xFF, frame];
        bytes.extend([0, 17, 8, 0, 9, 0, 9, 3, 1, 0x22, 0, 2, 0x11, 0, 3, 0x11, 0]);
        for _ in 0..scans {
            bytes.extend([
                0xFF,
                START_OF_SCAN,
                0,
                8,
                1,
                1,
                0,
                0,
                0,
                0,
                0x12,
                0xFF,
                0,
                0x34,
                0xFF,
                0xD0,
                0x56,
            ]);
        }
        bytes.extend([0xFF, END_OF_IMAGE, 0xFF, START_OF_SCAN, 0, 2]);
        bytes
    }

    #[test]
    fn scans_are_counted_and_what_looks_like_one_is_not() {
        let mut bytes = jpeg(0xC2, 7);
        assert_eq!(Scans::of(&bytes), Scans { scans: 7, samples_percent: 150, is_held: true });
        bytes.truncate(40);
        assert_eq!(Scans::of(&bytes).scans, 1);
        assert_eq!(Scans::of(&jpeg(0xC0, 1)), Scans { scans: 1, samples_percent: 150, is_held: false });
        assert!(Scans::of(&jpeg(0xC0, 3)).is_held, "a component a scan");
        assert_eq!(Scans::of(&[0xFF, 0xD8]), Scans::default());
    }
}
