//! Pictures of two tones: drawn by a program, or cut into black and white.
//!
//! No camera made them, so no light falls off in them, no sheet lies on a table, and what most of their border is, is paper.

use tracelight_image::levels::percentile;
use tracelight_image::threshold::over;
use tracelight_image::{Mask, Plane};

use crate::shadow;

/// Less than this share of the pixels are specks.
const SPECKS: f64 = 0.0005;
/// A tone is so much of what is nearer to it than to the other by three to one, within so many levels of its most frequent one.
const SAME: f64 = 0.97;
const LEVELS: usize = 1;
/// The tones are at least so many levels apart.
const APART: f64 = 64.0;

/// So much of a tone that is not darker has one and the same level.
const EXACT: f64 = 0.9;

/// The two levels that nearly all of a picture has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TwoTones {
    /// The lower one.
    pub dark: u8,
    /// The higher one.
    pub bright: u8,
}

impl TwoTones {
    /// Those of a histogram; `None` where a picture has more shades than edges need: between the two lies less than either covers.
    pub fn of(levels: &[u32; 256]) -> Option<Self> {
        let (least, most) = (percentile(levels, SPECKS), percentile(levels, 1.0 - SPECKS));
        if most - least < APART {
            return None;
        }
        let at = |share: f64| (least + share * (most - least)) as usize;
        let (quarter, rest) = (at(0.25), at(0.75));
        let (dark, of_dark) = tone(levels, 0..quarter + 1)?;
        let (bright, of_bright) = tone(levels, rest..256)?;
        let between = count(&levels[quarter + 1..rest]);
        // what is no darker than paper in a shadow is one, unless both are one level as no camera makes them
        let is_exact = |level: u8, all: u64| f64::from(levels[usize::from(level)]) >= EXACT * all as f64;
        let is_ink = shadow::is_ink(f64::from(dark), f64::from(bright))
            || is_exact(dark, of_dark) && is_exact(bright, of_bright);
        (is_ink && between <= of_dark.min(of_bright)).then_some(Self { dark, bright })
    }

    /// Whether a level is nearer to the bright one.
    pub fn is_bright(self, level: u8) -> bool {
        level > self.middle()
    }

    /// Where a picture of these tones is dark.
    pub fn dark(self, plane: &Plane<u8>) -> Mask {
        let mut darkness = plane.clone();
        darkness.values.iter_mut().for_each(|level| *level = 255 - *level);
        over(&darkness, 254 - self.middle())
    }

    fn middle(self) -> u8 {
        self.dark.midpoint(self.bright)
    }
}

/// The most frequent of some levels, if nearly all of their pixels are near it, and how many they are.
fn tone(levels: &[u32; 256], of: std::ops::Range<usize>) -> Option<(u8, u64)> {
    let all = count(&levels[of.clone()]);
    let tone = of.max_by_key(|&level| levels[level])?;
    let near = count(&levels[tone.saturating_sub(LEVELS)..(tone + LEVELS + 1).min(256)]);
    (near as f64 >= SAME * all as f64).then_some((tone as u8, all))
}

fn count(levels: &[u32]) -> u64 {
    levels.iter().map(|&count| u64::from(count)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// So many pixels of each of these levels.
    fn of(levels: &[(usize, u32)]) -> Option<TwoTones> {
        let mut all = [0; 256];
        levels.iter().for_each(|&(level, count)| all[level] = count);
        TwoTones::of(&all)
    }

    #[test]
    fn black_and_white_with_soft_edges_are_two_tones() {
        assert_eq!(of(&[(0, 400), (255, 600)]), Some(TwoTones { dark: 0, bright: 255 }));
        assert_eq!(
            of(&[(20, 4000), (21, 300), (100, 250), (250, 6000)]),
            Some(TwoTones { dark: 20, bright: 250 })
        );
    }

    #[test]
    fn a_third_tone_uneven_paper_and_what_hardly_differs_are_not() {
        assert_eq!(of(&[(0, 200), (128, 300), (255, 600)]), None);
        assert_eq!(of(&[(0, 400), (215, 300), (235, 300), (255, 300)]), None);
        assert_eq!(of(&[(200, 400), (255, 600)]), None);
        // paper, half of it in a shadow
        assert_eq!(of(&[(119, 100), (120, 200), (121, 100), (209, 100), (210, 400), (211, 100)]), None);
        assert_eq!(of(&[(120, 400), (210, 600)]), Some(TwoTones { dark: 120, bright: 210 }));
    }
}
