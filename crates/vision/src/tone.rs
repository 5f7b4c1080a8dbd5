//! Distinguishes drawings from photographs.
//!
//! What is drawn is thin, or ends where paper begins. A threshold cuts broad patches out of a photograph of something else, and
//! beside them it is neither light nor dark: their edges fade. Neither says it alone: a sheet of notes has a shadow, pencils
//! fade, a silhouette is broad.

use tracelight_image::Mask;
use tracelight_image::levels::sampled_blocks;
use tracelight_image::threshold::word_over;

use crate::VisionError;
use crate::ink::Ink;
use crate::quality::GOOD_CLIPPED_PERCENT;

/// Most of a drawing that may be broad and fade, %. Of 326 photographs of other things 97 % have more, or are refused for other
/// reasons; of 340 drawings (scans, photographs of paper and whiteboards, sketches, plans, pictures of the bench) 1 %.
const MOST_PERCENT: f64 = 0.16;
/// A hundredth of the picture's shorter side, at least so many pixels: ink is broad that is as far from paper, and beside the ink is
/// what is from once to one and a half times as far from it. Blurred edges are narrower.
const SIDES: usize = 100;
const LEAST_PX: usize = 3;
/// Paper is less dark than this share of the ink, and than so many deviations of the picture's noise, as far as that is noise.
const PAPER_SHARE: f64 = 0.25;
const DEVIATIONS: f64 = 3.0;
const MOST_NOISE: f64 = 8.0;
/// Most pixels that are looked at.
const SAMPLED: usize = 200_000;

impl Ink {
    /// Broad ink, % of the picture, as far as it fades: times the share of what lies beside ink that is no paper. `mask` is what is ink.
    /// 0 where spots are burnt.
    pub(crate) fn tone_percent(&self, mask: &Mask) -> f64 {
        if let Some(pencil) = self.pencil {
            return pencil.tone_percent;
        }
        // under such spots paper and ink are not all there is of a drawing either
        if self.quality.clipped_percent > GOOD_CLIPPED_PERCENT {
            return 0.0;
        }
        let dark = &self.darkness;
        let reach = (dark.width.min(dark.height) / SIDES).max(LEAST_PX);
        let broad = mask.clone().eroded(2 * reach - 1).count();
        if broad == 0 {
            return 0.0;
        }
        let near = mask.clone().dilated_by(reach - 1);
        let beside = mask.clone().dilated_by(reach + reach / 2).without(&near);
        let strength = 2.55 * self.quality.contrast_percent;
        let noise = DEVIATIONS * self.quality.noise_levels.min(MOST_NOISE);
        let most = (PAPER_SHARE * strength).max(noise) as u8;
        let counted = |(y, number, levels): (usize, usize, &[u8])| {
            let there = beside.row(y)[number];
            (there.count_ones(), (there & word_over(levels, most)).count_ones())
        };
        let (mut all, mut faded) = (0, 0);
        sampled_blocks(dark, SAMPLED)
            .map(counted)
            .for_each(|(there, dark)| (all, faded) = (all + there, faded + dark));
        let broad_percent = 100.0 * broad as f64 / (dark.width * dark.height) as f64;
        broad_percent * f64::from(faded) / f64::from(all.max(1))
    }
}

/// Refuses what is no drawing: of which too much is broad and fades.
pub(crate) fn check(tone_percent: f64) -> Result<(), VisionError> {
    match tone_percent > MOST_PERCENT {
        true => Err(VisionError::NoDrawing { tone_percent, most_percent: MOST_PERCENT }),
        false => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use tracelight_image::Grey;

    use crate::options::{Mode, Options};
    use crate::{VisionError, trace};

    const WIDTH: usize = 320;

    fn image(level: impl Fn(f64, f64) -> f64) -> Grey {
        let at = |i: usize| level((i % WIDTH) as f64, (i / WIDTH) as f64).clamp(0.0, 255.0) as u8;
        Grey::new(WIDTH, 240, (0..WIDTH * 240).map(at).collect()).unwrap()
    }

    /// A dark tree before hills and a bright sky: all shades, and twigs let light through at the tree's edge.
    fn landscape() -> Grey {
        image(|x, y| {
            let hill = 120.0 + 30.0 * (x / 40.0).sin() + 12.0 * (x / 13.0).cos();
            let inside = 45.0 + 6.0 * (x / 5.0).sin() * (y / 7.0).cos() - (x - 90.0).hypot(1.3 * (y - 90.0));
            let tree = (0.5 + inside / 24.0).clamp(0.0, 1.0);
            let behind = match y > hill {
                true => 150.0 - 60.0 * ((y - hill) / 120.0) + 35.0 * (x / 17.0).sin() * (y / 9.0).cos(),
                false => 235.0 - 30.0 * y / 120.0,
            };
            tree * (30.0 + 25.0 * (x / 9.0).sin() * (y / 11.0).sin()) + (1.0 - tree) * behind
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

    #[test]
    fn what_a_felt_pen_filled_with_slits_under_light_from_one_side_is_dark_on_light() {
        let slitted = image(|x, y| {
            let paper = 235.0 - 0.55 * x;
            let (across, down) = (x - 110.0, y - 120.0);
            let slit = (x / 12.0).fract() < 0.17 && down.abs() < 52.0;
            match across.hypot(down) < 60.0 && !slit {
                true => 0.25 * paper,
                false => paper,
            }
        });
        let traced = trace(&slitted, &Options::default()).unwrap();
        assert_eq!((traced.quality.light_on_dark, traced.strokes.strokes.len()), (false, 1));
    }
}
