//! Whether a picture is a drawing at all.
//!
//! A drawing is ink on paper, and little else: away from the ink's edges it is as bright as paper or as dark as ink. A
//! photograph of something else has all the shades between, and what is cut out of it by a threshold has no lines but
//! outlines. Neither says it alone: a sheet of notes has a shadow, a silhouette has nothing but an outline.

use tracelight_stroke::Drawing;

use crate::VisionError;
use crate::ink::{Ink, histogram, sampled_blocks};
use crate::light::percentile;
use crate::mask::Mask;
use crate::paler::clear;
use crate::quality::{GOOD_CLIPPED_PERCENT, GOOD_TONE_PERCENT};

/// Most of a drawing of lines that may be neither paper nor ink, %; what is good is never refused. Of 384 drawings of 25
/// collections (scans, photographs of paper and whiteboards, clip art) one has more, and of 25 photographs of paper with a table
/// or a finger beside it four; of 626 photographs and screenshots of other things 452 have, or are refused for other reasons.
const MOST_OF_LINES: f64 = 2.5;
/// How quickly the bound falls with the share of the light that goes round shapes.
const FALL: f64 = 2.0;
/// Paper is less dark than this share of the ink, and than so many deviations of the picture's noise, as far as that is noise.
const PAPER_SHARE: f64 = 0.2;
const DEVIATIONS: f64 = 3.0;
const MOST_NOISE: f64 = 8.0;
/// Chords this close to a path measure its length, px.
const CHORDS_PX: f64 = 0.5;
/// Most pixels that are looked at.
const SAMPLED: usize = 100_000;

impl Ink {
    /// Share of the picture that is neither paper nor ink, nor the edge between the two, nor thin, %; `mask` is what is ink. 0 where
    /// spots are burnt.
    pub(crate) fn tone_percent(&self, mask: &Mask) -> f64 {
        // under such spots paper and ink are not all there is of a drawing either
        if self.quality.clipped_percent > GOOD_CLIPPED_PERCENT {
            return 0.0;
        }
        let reach = self.edge_px().unwrap_or(1.0).clamp(1.0, 8.0).ceil() as usize + 1;
        let near = mask.clone().dilated_by(reach);
        let dark = &self.darkness;
        let blocks = || sampled_blocks(dark, SAMPLED);
        let all: usize = blocks().map(|(.., levels)| levels.len()).sum();
        let clear_eights = || blocks().flat_map(|(y, number, levels)| clear(levels, near.row(y)[number]));
        let levels = histogram(clear_eights());
        let strength = 2.55 * self.quality.contrast_percent;
        let noise = DEVIATIONS * self.quality.noise_levels.min(MOST_NOISE);
        let most = (percentile(&levels, 0.5) + (PAPER_SHARE * strength).max(noise)) as u8;
        // four in a row: the dots of dotted paper, or a pale line, are no tone
        let is_tone = |four: &&[u8]| four.iter().all(|&level| level > most);
        let fours = clear_eights().flat_map(|eight| eight.chunks(4));
        let tones: usize = fours.filter(is_tone).map(<[u8]>::len).sum();
        100.0 * tones as f64 / all.max(1) as f64
    }
}

/// Refuses what is no drawing: of which too much is neither paper nor ink.
pub(crate) fn check(tone_percent: f64, strokes: &Drawing) -> Result<(), VisionError> {
    let outlined = strokes.outlined(CHORDS_PX);
    let most_percent = (MOST_OF_LINES * (-FALL * outlined).exp()).max(GOOD_TONE_PERCENT);
    match tone_percent > most_percent {
        true => {
            Err(VisionError::NoDrawing { tone_percent, most_percent, outlined_percent: 100.0 * outlined })
        }
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use crate::{Grey, Mode, Options, VisionError, trace};

    const WIDTH: usize = 320;

    fn image(level: impl Fn(f64, f64) -> f64) -> Grey {
        let at = |i: usize| level((i % WIDTH) as f64, (i / WIDTH) as f64).clamp(0.0, 255.0) as u8;
        Grey::new(WIDTH, 240, (0..WIDTH * 240).map(at).collect()).unwrap()
    }

    /// A dark tree before hills and a bright sky: all shades.
    fn landscape() -> Grey {
        image(|x, y| {
            let hill = 120.0 + 30.0 * (x / 40.0).sin() + 12.0 * (x / 13.0).cos();
            let tree = (x - 90.0).hypot(1.3 * (y - 90.0)) < 45.0 + 6.0 * (x / 5.0).sin() * (y / 7.0).cos();
            match (tree, y > hill) {
                (true, _) => 30.0 + 25.0 * (x / 9.0).sin() * (y / 11.0).sin(),
                (_, true) => 150.0 - 60.0 * ((y - hill) / 120.0) + 35.0 * (x / 17.0).sin() * (y / 9.0).cos(),
                _ => 235.0 - 30.0 * y / 120.0,
            }
        })
    }

    #[test]
    fn a_photograph_is_refused_and_traced_only_by_force() {
        let options = Options::default();
        let refused = trace(&landscape(), &options).unwrap_err();
        let VisionError::NoDrawing { tone_percent, most_percent, .. } = refused else { panic!("{refused}") };
        assert!(tone_percent > most_percent && refused.to_string().contains("--force"), "{refused}");
        assert!(trace(&landscape(), &Options { force: true, ..options }).is_ok());
        // who wants outlines has seen that it is no drawing of lines
        assert!(trace(&landscape(), &Options { mode: Mode::Outline, ..options }).is_ok());
    }

    #[test]
    fn a_drawing_in_uneven_light_with_noise_is_one() {
        let noise = |x: f64, y: f64| ((x * 7919.0 + y * 104_729.0) % 17.0) - 8.0;
        let drawn = |x: f64, y: f64| {
            let ring = ((x - 150.0).hypot(y - 120.0) - 70.0).abs() < 2.5;
            let disc = (x - 260.0).hypot(y - 60.0) < 25.0;
            ring || disc
        };
        let paper = |x: f64, y: f64| 240.0 - 0.35 * x - 0.1 * y;
        let seen = image(|x, y| if drawn(x, y) { 0.25 } else { 1.0 } * paper(x, y) + noise(x, y));
        assert!(trace(&seen, &Options::default()).is_ok());
    }
}
