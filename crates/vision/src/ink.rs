//! Separates ink from paper: polarity, illumination, noise, threshold, refusal of bad pictures.

use std::borrow::Cow;

use tracelight_image::levels::{SAMPLED, sampled_histogram};
use tracelight_image::smooth::{SMOOTHED, noise, smoothed};
use tracelight_image::threshold::over;
use tracelight_image::{Mask, Plane, Region, mask_of, regions};
use tracelight_maths::powi;
use tracelight_sheet::{Page, Paper};

use crate::coarse;
use crate::comb::{self, Lie, TakenOff};
use crate::faint;
use crate::paler::Inked;
use crate::polarity::is_light_on_dark;
use crate::quality::clipped_percent;
use crate::row::Row;
use crate::split::{Split, strongest};
use crate::{Quality, VisionError};

/// Noise from which on the picture is smoothed, levels.
const SMOOTHED_FROM: f64 = 2.5;
/// Most passes.
const MOST_SMOOTHINGS: usize = SMOOTHED.len() - 1;

/// A pencil's ink ends by this share of its strength nearer to the paper than a pen's, and so many deviations of the noise above it.
const PALER: f64 = 0.18;
const PALER_DEVIATIONS: f64 = 4.0;
/// This share of a patch that pales is as dark as ink: light that falls off towards a corner has a speck of it.
const LEAST_JOINED: f64 = 0.15;

/// How closely a picture is looked at.
#[derive(Clone, Copy)]
struct Look {
    /// Pixels averaged into one, either way.
    reduction: usize,
    /// Passes of [`smoothed`], if its noise asks for no more.
    smoothings: usize,
}

/// What is known of a pencil's drawing whose grain was smoothed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pencil {
    /// A pencil pales along its way: what is joined to ink is ink where it is darker than this.
    threshold: u8,
    /// Its tone before it was smoothed: that makes edges fade.
    pub(crate) tone_percent: f64,
}

/// An image with its light and polarity evened out.
#[derive(Clone, Debug)]
pub(crate) struct Ink {
    /// 0 is paper, 255 total darkness.
    pub(crate) darkness: Plane<u8>,
    /// Ink is darker than this.
    pub(crate) threshold: u8,
    /// The paper's rules, which are no longer there.
    pub(crate) rules: Option<TakenOff>,
    /// How much darker the ink is than the paper, levels; `None` where all that is paler is paper: the threshold was
    /// given, or there are shadows.
    strength: Option<f64>,
    /// Pixels of the image along one of these: 2 where four were averaged into one, a half where one became four.
    pub(crate) scale: f64,
    /// Passes of [`smoothed`] over it.
    smoothings: usize,
    /// What is otherwise where it was smoothed for a pencil's grain.
    pub(crate) pencil: Option<Pencil>,
    pub(crate) quality: Quality,
}

impl Ink {
    /// Finds the ink of an image and refuses one that has none. `threshold_percent` is the darkness from which on it
    /// is ink, % of the paper's brightness; without it, it is found. Paper may have hard edges, of `sheets` or of shadows.
    /// Wide lines with ragged edges are looked at from further, and grainy ones smoothed, as long as that evens them.
    pub(crate) fn of(
        page: &Page<'_>,
        threshold_percent: Option<f64>,
        sheets: bool,
    ) -> Result<Self, VisionError> {
        Self::by(page, threshold_percent, (sheets, false))
    }

    /// Finds dark ink, regardless of the picture's polarity.
    pub(crate) fn of_dark_lines(page: &Page<'_>, sheets: bool) -> Result<Self, VisionError> {
        Self::by(page, None, (sheets, true))
    }

    fn by(
        page: &Page<'_>,
        threshold_percent: Option<f64>,
        (sheets, is_dark): (bool, bool),
    ) -> Result<Self, VisionError> {
        let at = |look| Self::at(page, threshold_percent, (sheets, is_dark), look);
        let mut reduction = coarse::reduction(&page.picture);
        let mut ink = at(Look { reduction, smoothings: 0 })?;
        let most = coarse::most_reduction(&page.picture);
        let mut fine = ink.over();
        while 2 * reduction <= most && coarse::is_ragged(&fine, &ink.darkness, ink.threshold) {
            let Ok(coarser) = at(Look { reduction: 2 * reduction, smoothings: 0 }) else { break };
            // rules that are no longer seen would be lines
            if ink.rules.is_some() && coarser.rules.is_none() {
                break;
            }
            reduction *= 2;
            fine = coarser.over();
            ink = coarser;
        }
        let mut tone_percent = None;
        while ink.smoothings < MOST_SMOOTHINGS && coarse::may_be_grainy(&fine, &ink.darkness, ink.threshold) {
            let look = Look { reduction, smoothings: ink.smoothings + 1 };
            let Ok(smoother) = at(look) else { break };
            let even = smoother.over();
            if !coarse::is_grainy(&fine, &even) {
                break;
            }
            tone_percent = tone_percent.or_else(|| Some(ink.tone_percent(&ink.mask())));
            (ink, fine) = (smoother, even);
        }
        let tone_percent = tone_percent.filter(|_| threshold_percent.is_none());
        ink.pencil =
            tone_percent.map(|percent| Pencil { threshold: ink.pencils_threshold(), tone_percent: percent });
        Ok(ink)
    }

    /// Finds the ink at a given resolution and smoothing.
    fn at(
        page: &Page<'_>,
        threshold_percent: Option<f64>,
        (sheets, is_dark): (bool, bool),
        Look { reduction, smoothings }: Look,
    ) -> Result<Self, VisionError> {
        let image = &*page.picture;
        let reduced = |plane| match reduction {
            1 => Cow::Borrowed(plane),
            _ => Cow::Owned(Plane::reduced(plane, reduction)),
        };
        let mut plane = reduced(page.beside.as_ref().map_or(image.plane(), |beside| &beside.papered));
        // a shadow on the sheet goes on beside it
        let mut seen = page.beside.as_ref().map(|_| reduced(image.plane()));
        let mut raw_levels = sampled_histogram(&plane);
        let light_on_dark = !is_dark && is_light_on_dark(&plane, &raw_levels, page.is_brighter);
        if light_on_dark {
            for plane in [Some(&mut plane), seen.as_mut()].into_iter().flatten() {
                plane.to_mut().values.iter_mut().for_each(|v| *v = 255 - *v);
            }
            raw_levels.reverse();
        }
        let paper = Paper::of(&plane, &raw_levels, seen.as_deref().unwrap_or(&plane), sheets);
        let mut darkness = paper.darkness(&plane);
        let noise_levels = noise(&darkness, SAMPLED);
        let smoothings = smoothings.max(usize::from(noise_levels > SMOOTHED_FROM));
        for _ in 0..smoothings {
            darkness = smoothed(&darkness);
        }
        let beside = page.beside.as_ref().map(|beside| reduced_mask(&beside.mask, &darkness, reduction));
        if let Some(beside) = &beside {
            darkness.clear(beside);
        }
        let mut levels = sampled_histogram(&darkness);
        let blur = SMOOTHED[smoothings];
        let lie = Lie { beside: beside.as_ref(), corners: page.lines_meet(reduction) };
        let rules = comb::without_rules(&darkness, blur * noise_levels, strongest(&levels), lie);
        let rules = rules.map(|(plain, taken_off)| {
            levels = sampled_histogram(&plain);
            darkness = plain;
            taken_off
        });
        let split = match threshold_percent {
            Some(percent) => Split::at(&levels, (2.55 * percent).round() as u8),
            None => Split::of(&levels).or_of_little(&darkness, blur * noise_levels),
        };
        let strongest = strongest(&levels);
        split.check(threshold_percent, strongest)?;
        let (dimmest, brightest) = paper.range();
        let quality = Quality {
            contrast_percent: (split.ink - split.paper) / 2.55,
            contrast_to_noise: (split.ink - split.paper) / split.paper_deviation.max(0.5),
            noise_levels,
            light_evenness: dimmest / brightest,
            ink_percent: 100.0 * split.share,
            edge_px: split.edge_px(&darkness, noise_levels, smoothings).map(|px| px * reduction as f64),
            clipped_percent: clipped_percent(&raw_levels, split.share),
            pen_px: None,
            tone_percent: None,
            light_on_dark,
        };
        quality.gate(threshold_percent.is_some())?;
        let is_alone = threshold_percent.is_some() || paper.has_shadows();
        let strength = (!is_alone).then_some(split.ink - split.paper);
        Ok(Self {
            darkness,
            threshold: split.threshold,
            rules,
            strength,
            scale: reduction as f64,
            smoothings,
            pencil: None,
            quality,
        })
    }

    /// So many pixels of the image, however closely it is looked at; from further they are as many of its own.
    pub(crate) fn px2(&self, pixels: usize) -> usize {
        (pixels as f64 / powi(self.scale.min(1.0), 2)) as usize
    }

    /// Whether what its mask shows is so thin that a look twice as close tells more.
    pub(crate) fn is_thin(&self, mask: &Mask) -> bool {
        coarse::is_thin(mask, &self.darkness, self.threshold)
    }

    /// Converts the ink to the doubled resolution.
    pub(crate) fn doubled(self) -> Self {
        Self {
            darkness: self.darkness.doubled(),
            rules: self.rules.map(|rules| rules.doubled()),
            scale: 0.5 * self.scale,
            ..self
        }
    }

    /// Where a pencil's ink ends: smoothed, it stands out from paper that is paler than half of it.
    fn pencils_threshold(&self) -> u8 {
        let noise = SMOOTHED[self.smoothings] * self.quality.noise_levels;
        let lower = f64::from(self.threshold) - PALER * 2.55 * self.quality.contrast_percent;
        (lower.max(PALER_DEVIATIONS * noise) as u8).min(self.threshold)
    }

    /// Where it is darker than the threshold.
    fn over(&self) -> Mask {
        over(&self.darkness, self.threshold)
    }

    /// Where there is ink; there may be a second, paler one.
    pub(crate) fn mask(&self) -> Mask {
        let mask = match self.pencil {
            Some(pencil) => joined(over(&self.darkness, pencil.threshold), &self.over()),
            None => self.over(),
        };
        let Some(strength) = self.strength else { return mask };
        // what is left of rules is no line
        let pales = self.rules.is_none();
        Inked { dark: &self.darkness, ink: mask, strength, edge_px: self.edge_px() }.with_paler(pales)
    }

    /// The mask with what is too pale for it of its lines, ahead of their ends; `None` where there is nothing.
    pub(crate) fn goes_on(&self, mask: &Mask, rows: &[Row]) -> Option<Mask> {
        // what is left of rules is no line
        let followed = || faint::followed(&self.darkness, mask, rows, self.strength.is_none());
        self.rules.is_none().then(followed).flatten()
    }

    /// How wide the ink's edges are, px of [`Self::darkness`]; `None` where too few could be measured.
    pub(crate) fn edge_px(&self) -> Option<f64> {
        self.quality.edge_px.map(|px| px / self.scale)
    }
}

/// The patches of a mask of which enough is in the other.
fn joined(mask: Mask, other: &Mask) -> Mask {
    let is_joined =
        |region: &&Region| region.cells(other).count() as f64 >= LEAST_JOINED * region.area() as f64;
    mask_of(&mask, regions(&mask).iter().filter(is_joined))
}

/// A mask on a plane for which so many pixels were averaged into one.
fn reduced_mask(mask: &Mask, plane: &Plane<u8>, reduction: usize) -> Mask {
    let mut out = Mask::empty(plane.width, plane.height);
    let middle = |k: usize| (k * reduction + reduction / 2) as isize;
    for y in 0..plane.height {
        let beside = (0..plane.width).filter(|&x| mask.get(middle(x), middle(y)));
        beside.for_each(|x| out.set(out.cell(x, y)));
    }
    out
}

#[cfg(test)]
mod tests {
    use tracelight_image::Grey;

    use super::*;

    fn image(level: impl Fn(usize, usize) -> u8) -> Grey {
        Grey::new(160, 120, (0..160 * 120).map(|i| level(i % 160, i / 160)).collect()).unwrap()
    }

    fn noise_at(x: usize, y: usize) -> f64 {
        let mut v = (x * 7919 + y * 104_729 + 12_345) as u64;
        for _ in 0..3 {
            v = (v ^ (v >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
        (v >> 40) as f64 / f64::from(1 << 24)
    }

    #[test]
    fn polarity_is_found_without_being_told() {
        let line = |x: usize, y: usize| (x + y) % 60 < 5 && (20..100).contains(&y);
        let dark =
            Ink::of(&Page::whole(&image(|x, y| if line(x, y) { 40 } else { 220 })), None, false).unwrap();
        let light =
            Ink::of(&Page::whole(&image(|x, y| if line(x, y) { 220 } else { 40 })), None, false).unwrap();
        assert!(!dark.quality.light_on_dark && light.quality.light_on_dark);
        let filled = |x: usize, y: usize| (x as f64 - 80.0).hypot(y as f64 - 60.0) < 55.0;
        assert!(
            !Ink::of(&Page::whole(&image(|x, y| if filled(x, y) { 30 } else { 230 })), None, false)
                .unwrap()
                .quality
                .light_on_dark
        );
        assert!(
            Ink::of(&Page::whole(&image(|x, y| if filled(x, y) { 230 } else { 30 })), None, false)
                .unwrap()
                .quality
                .light_on_dark
        );
    }

    #[test]
    fn pictures_without_a_drawing_are_refused_with_the_figure_that_failed() {
        for level in [0, 128, 255] {
            let error = Ink::of(&Page::whole(&image(|_, _| level)), None, false).unwrap_err();
            assert!(matches!(error, VisionError::NoContrast { contrast, .. } if contrast < 1.0), "{error}");
        }
        let faint = Ink::of(&Page::whole(&image(|x, y| 127 + ((x + y) % 2) as u8)), None, false).unwrap_err();
        assert!(matches!(faint, VisionError::NoContrast { .. }), "{faint}");
        for strength in [255.0, 80.0] {
            let noise = Ink::of(&Page::whole(&image(|x, y| (strength * noise_at(x, y)) as u8)), None, false)
                .unwrap_err();
            assert!(matches!(noise, VisionError::Noise { .. }), "{noise}");
        }
    }

    #[test]
    fn a_line_is_in_the_sample_whatever_its_direction() {
        let (width, height) = (1280, 720);
        for (rise, run) in [(0, 1), (1, 64), (1, 32), (29, 64), (-1, 64), (-3, 64), (1, 1)] {
            for from in 0..8 {
                let at = |x: i32| 360 + from + (x - 640) * rise / run;
                let level = |i: usize| {
                    let (x, y) = ((i % width) as i32, (i / width) as i32);
                    255 * u8::from((y - at(x)).abs() < 2)
                };
                let plane = Plane { width, height, values: (0..width * height).map(level).collect() };
                let counts = sampled_histogram(&plane);
                let share = f64::from(counts[255]) / f64::from(counts.iter().sum::<u32>());
                let true_share =
                    plane.values.iter().filter(|&&v| v == 255).count() as f64 / (width * height) as f64;
                assert!(
                    (0.4..2.5).contains(&(share / true_share)),
                    "{rise}/{run} {from}: {share} {true_share}"
                );
            }
        }
    }

    #[test]
    fn a_small_mark_on_a_large_sheet_is_ink() {
        let (width, height) = (1600, 1200);
        let level = |i: usize| {
            let (x, y) = (i % width, i / width);
            let mark = (800..803).contains(&x) && (600..620).contains(&y);
            let paper = 215.0 + 10.0 * (x as f64 / 200.0).sin() + 4.0 * (noise_at(x, y) - 0.5);
            if mark { 60 } else { paper as u8 }
        };
        let image = Grey::new(width, height, (0..width * height).map(level).collect()).unwrap();
        let mask = Ink::of(&Page::whole(&image), None, false).unwrap().mask();
        assert!((600..620).all(|y| mask.get(801, y)));
        assert!(mask.count() < 100, "{}", mask.count());
    }

    #[test]
    fn a_faint_line_in_noise_is_still_ink() {
        let level = |x: usize, y: usize| {
            let pen = if (60..65).contains(&x) && y > 20 { 60.0 } else { 0.0 };
            (200.0 - pen + 20.0 * (noise_at(x, y) - 0.5)) as u8
        };
        let ink = Ink::of(&Page::whole(&image(level)), None, false).unwrap();
        let mask = ink.mask();
        assert!((60..65).all(|x| mask.get(x, 60)));
        assert!(ink.quality.ink_percent < 4.0, "{:?}", ink.quality);
    }
}
