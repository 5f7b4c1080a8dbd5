//! Consistent overhead byte stuffing: packets without a zero byte, so that a zero ends each.
//!
//! Cheshire and Baker, *Consistent Overhead Byte Stuffing*, IEEE/ACM Transactions on Networking 7 (1999), 159–172.

/// Longest run that one code byte tells of.
const LONGEST_RUN: usize = 254;

/// Bytes that so many become at most.
pub(super) const fn stuffed_length(bytes: usize) -> usize {
    bytes + bytes / LONGEST_RUN + 1
}

/// Stuffs bytes; how many they are then. `None` if they do not fit.
pub(super) fn stuff(bytes: &[u8], out: &mut [u8]) -> Option<usize> {
    let (mut code_at, mut at, mut run) = (0, 1, 1_u8);
    for &byte in bytes {
        if usize::from(run) > LONGEST_RUN {
            *out.get_mut(code_at)? = run;
            (code_at, at, run) = (at, at + 1, 1);
        }
        if byte == 0 {
            *out.get_mut(code_at)? = run;
            (code_at, at, run) = (at, at + 1, 1);
        } else {
            *out.get_mut(at)? = byte;
            (at, run) = (at + 1, run + 1);
        }
    }
    *out.get_mut(code_at)? = run;
    Some(at)
}

/// Takes the stuffing out, in place; how many bytes are left. `None` if it is none.
pub(super) fn unstuff(bytes: &mut [u8]) -> Option<usize> {
    let (mut from, mut to) = (0, 0);
    while from < bytes.len() {
        let run = usize::from(*bytes.get(from)?);
        if run == 0 || from + run > bytes.len() {
            return None;
        }
        for _ in 1..run {
            from += 1;
            *bytes.get_mut(to)? = *bytes.get(from)?;
            to += 1;
        }
        from += 1;
        // a full run has no zero behind it, nor has the last
        if run <= LONGEST_RUN && from < bytes.len() {
            *bytes.get_mut(to)? = 0;
            to += 1;
        }
    }
    Some(to)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::vec::Vec;

    fn there(bytes: &[u8]) -> Vec<u8> {
        let mut out = [0xAA; 700];
        let length = stuff(bytes, &mut out).unwrap_or(0);
        assert!(length <= stuffed_length(bytes.len()), "{length}");
        out[..length].to_vec()
    }

    #[test]
    fn the_paper_s_examples_are_stuffed_as_there() {
        for (plain, stuffed) in [
            (&[][..], &[1][..]),
            (&[0], &[1, 1]),
            (&[0, 0], &[1, 1, 1]),
            (&[0x11, 0x22, 0, 0x33], &[3, 0x11, 0x22, 2, 0x33]),
            (&[0x11, 0, 0, 0], &[2, 0x11, 1, 1, 1]),
        ] {
            assert_eq!(there(plain), stuffed);
        }
        let long: Vec<u8> = (1..=254).collect();
        assert_eq!(there(&long)[0], 255);
        let longer: Vec<u8> = (0..=254).map(|k: u8| k.wrapping_add(1)).collect();
        assert_eq!(there(&longer).len(), 257);
    }

    #[test]
    fn what_is_stuffed_has_no_zero_and_comes_back() {
        let mut state = 1_u32;
        let mut roll = |below: u32| {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            state % below
        };
        for round in 0..20_000 {
            let length = roll(600) as usize;
            let zeros = 1 + roll(300);
            let plain: Vec<u8> =
                (0..length).map(|_| if roll(zeros) == 0 { 0 } else { roll(256) as u8 }).collect();
            let mut stuffed = there(&plain);
            assert!(!stuffed.contains(&0), "{round}");
            let back = unstuff(&mut stuffed).unwrap_or(usize::MAX);
            assert_eq!(&stuffed[..back], plain, "{round}");
        }
    }

    #[test]
    fn what_does_not_fit_or_is_none_is_refused() {
        assert_eq!(stuff(&[1, 2, 3], &mut [0; 3]), None);
        assert_eq!(unstuff(&mut [3, 1]), None);
        assert_eq!(unstuff(&mut [0]), None);
        assert_eq!(unstuff(&mut []), Some(0));
    }
}
