//! Packets: a body and its checksum, stuffed, with a zero at the end.

use super::bytes::MOST_BODY;
use super::cobs::{stuff, stuffed_length, unstuff};
use super::crc::crc32;

/// Bytes of the checksum.
const CHECKSUM: usize = 4;
/// Most bytes of a packet on the wire, with the zero at its end.
pub const MOST_PACKET: usize = stuffed_length(MOST_BODY + CHECKSUM) + 1;

/// Makes a packet of a body; how long it is. Nothing if there is no body, or one that is too long.
pub fn packed(body: &[u8], out: &mut [u8; MOST_PACKET]) -> usize {
    if body.is_empty() || body.len() > MOST_BODY {
        return 0;
    }
    let mut checked = [0; MOST_BODY + CHECKSUM];
    let bytes = body.iter().copied().chain(crc32(body).to_le_bytes());
    checked.iter_mut().zip(bytes).for_each(|(place, byte)| *place = byte);
    let stuffed = checked.get(..body.len() + CHECKSUM).and_then(|checked| stuff(checked, out));
    // room for it is left in any packet
    let Some((length, end)) = stuffed.and_then(|length| Some((length, out.get_mut(length)?))) else {
        return 0;
    };
    *end = 0;
    length + 1
}

/// Finds the packets in a stream of bytes, whatever else is in it.
#[derive(Clone, Copy, Debug)]
pub struct Packets {
    bytes: [u8; MOST_PACKET],
    length: usize,
    /// More came than any packet has.
    is_too_long: bool,
    spoilt: u32,
}

impl Packets {
    /// At the beginning of a stream.
    pub const fn new() -> Self {
        Self { bytes: [0; MOST_PACKET], length: 0, is_too_long: false, spoilt: 0 }
    }

    /// How many stretches between zeros were no packet: noise, torn, or with a wrong checksum.
    pub const fn spoilt(&self) -> u32 {
        self.spoilt
    }

    /// Takes a byte; the body of the packet that it ends, if it ends one.
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
            // zeros between packets wake a line up
            return None;
        }
        let body = self.bytes.get_mut(..length).filter(|_| !is_too_long).and_then(body_of);
        if body.is_none() {
            self.spoilt = self.spoilt.wrapping_add(1);
        }
        body.and_then(|length| self.bytes.get(..length))
    }
}

impl Default for Packets {
    fn default() -> Self {
        Self::new()
    }
}

/// Takes stuffing and checksum off; how long the body is, which is at the beginning then.
fn body_of(bytes: &mut [u8]) -> Option<usize> {
    let length = unstuff(bytes)?;
    let body = length.checked_sub(CHECKSUM).filter(|&body| body > 0 && body <= MOST_BODY)?;
    let (body_bytes, checksum) = bytes.get(..length)?.split_at_checked(body)?;
    (checksum == crc32(body_bytes).to_le_bytes()).then_some(body)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    fn on_wire(body: &[u8]) -> Vec<u8> {
        let mut out = [0xAA; MOST_PACKET];
        let length = packed(body, &mut out);
        out[..length].to_vec()
    }

    fn read(packets: &mut Packets, bytes: &[u8]) -> Vec<Vec<u8>> {
        bytes.iter().filter_map(|&byte| packets.push(byte).map(<[u8]>::to_vec)).collect()
    }

    #[test]
    fn bodies_of_any_length_come_back() {
        let mut packets = Packets::new();
        for length in 1..=MOST_BODY {
            let body: Vec<u8> = (0..length).map(|k| (k * 7 % 5) as u8).collect();
            assert_eq!(read(&mut packets, &on_wire(&body)), [body]);
        }
        assert_eq!(packets.spoilt(), 0);
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
                let mut packets = Packets::new();
                assert_eq!(read(&mut packets, &wrong), Vec::<Vec<u8>>::new(), "{at} {flipped}");
                assert!(packets.spoilt() > 0);
                // and the next one is read
                assert_eq!(read(&mut packets, &whole).len(), 1);
            }
        }
    }

    #[test]
    fn noise_is_no_frame_and_what_follows_it_is_read() {
        let mut packets = Packets::new();
        let noise: Vec<u8> = (0..10_000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        assert!(read(&mut packets, &noise).is_empty());
        assert_eq!(read(&mut packets, &[0]).len(), 0);
        assert_eq!(read(&mut packets, &on_wire(&[1, 2, 3])), [[1, 2, 3]]);
        // two whose border was lost are both lost, and no more
        let mut merged = on_wire(&[1, 2, 3]);
        merged.pop();
        merged.extend(on_wire(&[4, 5, 6]));
        assert!(read(&mut packets, &merged).is_empty());
        assert_eq!(read(&mut packets, &on_wire(&[7])), [[7]]);
    }
}
