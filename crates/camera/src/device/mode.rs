use std::fmt;

use tracelight_eye::coding::Coding;

/// What a camera can be told to send.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mode {
    /// How it calls the coding.
    pub(super) name: [u8; 4],
    pub(super) coding: Coding,
    /// Columns, rows.
    pub(super) size_px: [usize; 2],
    /// Images a second at most; `None` of a camera that does not say.
    pub(super) rate_hz: Option<f64>,
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size_px;
        let name = String::from_utf8_lossy(&self.name);
        write!(f, "{} {width}x{height}", name.trim_end())?;
        match self.rate_hz {
            Some(rate) if (rate - rate.round()).abs() < 0.05 => write!(f, " {rate:.0}/s"),
            Some(rate) => write!(f, " {rate:.1}/s"),
            None => Ok(()),
        }
    }
}

/// Columns and rows that are taken where nobody asks for others: more of them show a wall to a tenth of a millimetre no better, and
/// through a USB 2 cable they come late.
const USUAL_PX: [usize; 2] = [1280, 720];
/// Fewest images a second that a spot is followed by.
const FLUENT_HZ: f64 = 24.0;
/// Fewest a second that anybody waits for.
const SLOWEST_HZ: f64 = 9.0;

/// The mode that is used, of those a camera has: of a size, if one is wanted, else the largest up to the usual size that is not slow, or
/// the next above. In colour, for inks and a laser have some, and uncompressed where that is fluent: JPEG blurs a spot.
pub(super) fn chosen(modes: &[Mode], size_px: Option<[usize; 2]>) -> Option<Mode> {
    let rate = |mode: &Mode| mode.rate_hz.unwrap_or(FLUENT_HZ);
    let pixels = |mode: &Mode| mode.size_px[0] * mode.size_px[1];
    let of_size: Vec<&Mode> = match size_px {
        Some(size) => modes.iter().filter(|mode| mode.size_px == size).collect(),
        None => {
            let usual = |mode: &Mode| mode.size_px[0] <= USUAL_PX[0] && mode.size_px[1] <= USUAL_PX[1];
            let is_large = |mode: &&Mode| usual(mode) && rate(mode) >= SLOWEST_HZ;
            let largest = modes.iter().filter(is_large).max_by_key(|mode| pixels(mode));
            let size = largest.or_else(|| modes.iter().min_by_key(|mode| pixels(mode)))?.size_px;
            modes.iter().filter(|mode| mode.size_px == size).collect()
        }
    };
    let worth = |mode: &&&Mode| {
        let is_fluent = rate(mode) >= FLUENT_HZ;
        let is_plain = mode.coding != Coding::Jpeg;
        (mode.coding != Coding::Grey, is_fluent, is_fluent && is_plain, rate(mode))
    };
    of_size
        .iter()
        .rev()
        .max_by(|a, b| worth(a).partial_cmp(&worth(b)).unwrap_or(std::cmp::Ordering::Equal))
        .map(|mode| **mode)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(name: &[u8; 4], size_px: [usize; 2], rate_hz: f64) -> Mode {
        Mode { name: *name, coding: Coding::named(*name).unwrap(), size_px, rate_hz: Some(rate_hz) }
    }

    #[test]
    fn the_usual_size_is_taken_fluent_and_uncompressed_where_both_go() {
        // as a USB 2 webcam has them
        let mut modes = vec![
            mode(b"YUYV", [640, 480], 30.0),
            mode(b"YUYV", [1280, 720], 10.0),
            mode(b"YUYV", [1920, 1080], 5.0),
            mode(b"MJPG", [640, 480], 30.0),
            mode(b"MJPG", [1280, 720], 30.0),
            mode(b"MJPG", [1920, 1080], 30.0),
        ];
        let told =
            |modes: &[Mode], size| chosen(modes, size).map_or_else(String::new, |mode| mode.to_string());
        assert_eq!(told(&modes, None), "MJPG 1280x720 30/s");
        assert_eq!(told(&modes, Some([640, 480])), "YUYV 640x480 30/s");
        assert_eq!(told(&modes, Some([1920, 1080])), "MJPG 1920x1080 30/s");
        assert_eq!(told(&modes, Some([1000, 1000])), "");
        modes.push(mode(b"YUYV", [1280, 720], 29.97));
        assert_eq!(told(&modes, None), "YUYV 1280x720 30/s");
    }

    #[test]
    fn what_is_too_slow_or_too_large_is_taken_where_there_is_nothing_else() {
        let slow = [mode(b"YUYV", [1280, 720], 5.0), mode(b"YUYV", [320, 240], 15.0)];
        assert_eq!(chosen(&slow, None).unwrap().size_px, [320, 240]);
        let colourful = [mode(b"GREY", [640, 480], 30.0), mode(b"MJPG", [640, 480], 15.0)];
        assert_eq!(chosen(&colourful, None).unwrap().to_string(), "MJPG 640x480 15/s");
        let large = [mode(b"GREY", [3840, 2160], 15.0), mode(b"GREY", [1920, 1080], 7.5)];
        assert_eq!(chosen(&large, None).unwrap().to_string(), "GREY 1920x1080 7.5/s");
        assert_eq!(chosen(&[], None), None);
        let mute = Mode { rate_hz: None, ..mode(b"GREY", [640, 480], 1.0) };
        assert_eq!(chosen(&[mute], None).unwrap().to_string(), "GREY 640x480");
    }
}
