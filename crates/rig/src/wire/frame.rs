//! Frames: a body and its checksum, stuffed, with a zero at the end.

use super::bytes::MOST_BODY;
use super::cobs::{stuff, stuffed_length, unstuff};
use super::crc::crc32;

/// Bytes of the checksum.
const CHECKSUM: usize = 4;
/// Most bytes of a frame on the wire, with the zero at its end.
pub const MOST_FRAME: usize = stuffed_length(MOST_BODY + CHECKSUM) + 1;

/// Makes a frame of a body; how long it is. Nothing if there is no body, or one that is too long.
pub fn framed(body: &[u8], out: &mut [u8; MOST_FRAME]) -> usize {
    let mut checked = [0; MOST_BODY + CHECKSUM];
    let (Some(place), false) = (checked.get_mut(..body.len() + CHECKSUM), body.is_empty()) else { return 0 };
    place[..body.len()].copy_from_slice(body);
    place[body.len()..].copy_from_slice(&crc32(body).to_le_bytes());
    let Some(length) = stuff(place, &mut out[..MOST_FRAME - 1]) else { return 0 };
    out[length] = 0;
    length + 1
}

/// Finds the frames in a stream of bytes, whatever else is in it.
#[derive(Clone, Copy, Debug)]
pub struct Frames {
    bytes: [u8; MOST_FRAME],
    length: usize,
    /// More came than any frame has.
    is_too_long: bool,
    spoilt: u32,
}

impl Frames {
    /// At the beginning of a stream.
    pub const fn new() -> Self {
        Self { bytes: [0; MOST_FRAME], length: 0, is_too_long: false, spoilt: 0 }
    }

    /// How many stretches between zeros were no frame: noise, torn, or with a wrong checksum.
    pub const fn spoilt(&self) -> u32 {
        self.spoilt
    }

    /// Takes a byte; the body of the frame that it ends, if it ends one.
    pub fn push(&mut self, byte: u8) -> Option<&[u8]> {
        if byte != 0 {
            match self.bytes.get_mut(self.length) {
                Some(place) => {
                    *place = byte;
                    self.length += 1;
                }
                None => self.is_too_long = true,
            }
            return None;
        }
        let length = core::mem::take(&mut self.length);
        let is_too_long = core::mem::take(&mut self.is_too_long);
        if length == 0 && !is_too_long {
            // zeros between frames wake a line up
            return None;
        }
        let body = if is_too_long { None } else { body_of(&mut self.bytes[..length]) };
        if body.is_none() {
            self.spoilt = self.spoilt.wrapping_add(1);
        }
        body.and_then(|length| self.bytes.get(..length))
    }
}

impl Default for Frames {
    fn default() -> Self {
        Self::new()
    }
}

/// Takes stuffing and checksum off; how long the body is, which is at the beginning then.
fn body_of(bytes: &mut [u8]) -> Option<usize> {
    let length = unstuff(bytes)?;
    let body = length.checked_sub(CHECKSUM).filter(|&body| body > 0 && body <= MOST_BODY)?;
    let (body_bytes, checksum) = bytes.get(..length)?.split_at(body);
    (checksum == crc32(body_bytes).to_le_bytes()).then_some(body)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    fn on_wire(body: &[u8]) -> Vec<u8> {
        let mut out = [0xAA; MOST_FRAME];
        let length = framed(body, &mut out);
        out[..length].to_vec()
    }

    fn read(frames: &mut Frames, bytes: &[u8]) -> Vec<Vec<u8>> {
        bytes.iter().filter_map(|&byte| frames.push(byte).map(<[u8]>::to_vec)).collect()
    }

    #[test]
    fn bodies_of_any_length_come_back() {
        let mut frames = Frames::new();
        for length in 1..=MOST_BODY {
            let body: Vec<u8> = (0..length).map(|k| (k * 7 % 5) as u8).collect();
            assert_eq!(read(&mut frames, &on_wire(&body)), [body]);
        }
        assert_eq!(frames.spoilt(), 0);
        assert!(on_wire(&[]).is_empty() && on_wire(&[1; MOST_BODY + 1]).is_empty());
    }

    #[test]
    fn a_frame_of_which_any_byte_is_another_is_none() {
        let body: Vec<u8> = (0..60).collect();
        let whole = on_wire(&body);
        for at in 0..whole.len() {
            for flipped in 1..=255_u8 {
                let mut wrong = whole.clone();
                wrong[at] ^= flipped;
                wrong.push(0);
                let mut frames = Frames::new();
                assert_eq!(read(&mut frames, &wrong), Vec::<Vec<u8>>::new(), "{at} {flipped}");
                assert!(frames.spoilt() > 0);
                // and the next one is read
                assert_eq!(read(&mut frames, &whole).len(), 1);
            }
        }
    }

    #[test]
    fn noise_is_no_frame_and_what_follows_it_is_read() {
        let mut frames = Frames::new();
        let noise: Vec<u8> = (0..10_000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        assert!(read(&mut frames, &noise).is_empty());
        assert_eq!(read(&mut frames, &[0]).len(), 0);
        assert_eq!(read(&mut frames, &on_wire(&[1, 2, 3])), [[1, 2, 3]]);
        // two whose border was lost are both lost, and no more
        let mut merged = on_wire(&[1, 2, 3]);
        merged.pop();
        merged.extend(on_wire(&[4, 5, 6]));
        assert!(read(&mut frames, &merged).is_empty());
        assert_eq!(read(&mut frames, &on_wire(&[7])), [[7]]);
    }
}
