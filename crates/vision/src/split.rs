//! Splits a histogram into paper and ink.

use tracelight_image::Plane;
use tracelight_image::levels::{histogram, percentile};
use tracelight_image::smooth::SMOOTHED;
use tracelight_maths::powi;

use crate::VisionError;
use crate::quality::GOOD_CONTRAST_PERCENT;
use crate::sharpness::{self, Step};

/// The level that a two-thousandth of all pixels exceed: more than specks of dust cover, and less than any drawing.
pub(crate) fn strongest(histogram: &[u32; 256]) -> f64 {
    percentile(histogram, 1.0 - 1.0 / 2000.0)
}

/// A histogram cut in two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Split {
    /// Highest level of the lower class.
    pub(crate) threshold: u8,
    /// Mean of the lower class.
    pub(crate) paper: f64,
    /// Mean of the upper class.
    pub(crate) ink: f64,
    /// Standard deviation of the lower class.
    pub(crate) paper_deviation: f64,
    /// Share of the upper class.
    pub(crate) share: f64,
}

impl Split {
    /// Where the variance between the classes is largest (Otsu, "A threshold selection method from gray-level
    /// histograms", 1979); in the middle of a stretch where it is.
    pub(crate) fn of(histogram: &[u32; 256]) -> Self {
        let (all, total, _) = moments(histogram, 0..256);
        let (mut n, mut sum) = (0.0, 0.0);
        let (mut best, mut first, mut last) = (0.0, 0, 0);
        for (level, &count) in histogram.iter().enumerate().take(255) {
            n += f64::from(count);
            sum += f64::from(count) * level as f64;
            let between =
                if n > 0.0 && n < all { powi(sum * all - n * total, 2) / (n * (all - n)) } else { 0.0 };
            if between > best * (1.0 + 1e-12) {
                (best, first) = (between, level);
            }
            if between >= best * (1.0 - 1e-12) {
                last = level;
            }
        }
        Self::at(histogram, ((first + last) / 2) as u8)
    }

    /// Falls back to the little ink that stands out from the paper, if the two classes are hardly apart and so both are paper:
    /// a small mark on a large sheet. `noise` is a pixel's deviation, levels.
    pub(crate) fn or_of_little(self, darkness: &Plane<u8>, noise: f64) -> Self {
        /// What is darker than the paper by less is no ink, levels.
        const LEAST: f64 = 2.55 * GOOD_CONTRAST_PERCENT;
        /// Of normal noise one pixel in 500 million exceeds as many deviations.
        const DEVIATIONS: f64 = 6.0;
        /// Of the pixels that stand out, the share on an edge, paler than ink.
        const EDGE: f64 = 0.5;
        if self.ink - self.paper >= LEAST {
            return self;
        }
        // all pixels: a sample may have none of the mark's
        let mut levels = histogram(std::iter::once(&darkness.values[..]));
        let all = levels;
        let least = self.paper + LEAST.max(DEVIATIONS * noise);
        levels[..=(least as usize).min(255)].fill(0);
        match levels.iter().any(|&count| count > 0) {
            true => Self::at(&all, (0.5 * (self.paper + percentile(&levels, EDGE))).max(least) as u8),
            false => self,
        }
    }

    /// At a threshold.
    pub(crate) fn at(histogram: &[u32; 256], threshold: u8) -> Self {
        let threshold = usize::from(threshold);
        let moments = |range: std::ops::Range<usize>| moments(histogram, range);
        let (lower, upper) = (moments(0..threshold + 1), moments(threshold + 1..256));
        // a class without pixels is no different from the other
        let mean = |class: (f64, f64, f64), other: (f64, f64, f64)| {
            if class.0 > 0.0 { class.1 / class.0 } else { other.1 / other.0.max(1.0) }
        };
        let paper = mean(lower, upper);
        Self {
            threshold: threshold as u8,
            paper,
            ink: mean(upper, lower),
            paper_deviation: (lower.2 / lower.0.max(1.0) - paper * paper).max(0.0).sqrt(),
            share: upper.0 / (lower.0 + upper.0).max(1.0),
        }
    }

    /// Refuses a threshold that leaves no ink, or no paper.
    pub(crate) fn check(&self, threshold_percent: Option<f64>, strongest: f64) -> Result<(), VisionError> {
        match threshold_percent {
            Some(threshold) if !(0.0 < self.share && self.share < 1.0) => {
                Err(VisionError::Threshold { threshold, darkest: strongest / 2.55 })
            }
            _ => Ok(()),
        }
    }

    /// Width of the ink's edges, px, without what smoothing added.
    pub(crate) fn edge_px(&self, darkness: &Plane<u8>, noise: f64, smoothings: usize) -> Option<f64> {
        // the binomial mean of 3 px has a variance of 1/2; a Gaussian's integral rises from 10 to 90 % in 2.563 σ
        const ADDED_SQ: f64 = 2.563 * 2.563 * 0.5;
        let noise = SMOOTHED[smoothings] * noise;
        // two deviations: what differs by less is as likely to be noise
        let step = Step {
            threshold: self.threshold,
            least: 0.5 * (self.ink - self.paper),
            noise: (2.0 * noise).max(1.0),
        };
        let width = sharpness::edge_px(darkness, step)?;
        let added = smoothings as f64 * ADDED_SQ;
        Some(if smoothings > 0 { (width * width - added).max(SHARPEST_SQ).sqrt() } else { width })
    }
}

/// Square of the least width an edge has on pixels: from 10 to 90 % of one pixel.
const SHARPEST_SQ: f64 = 0.8 * 0.8;

/// Count, sum and sum of squares of the levels in a range.
fn moments(histogram: &[u32; 256], range: std::ops::Range<usize>) -> (f64, f64, f64) {
    range.fold((0.0, 0.0, 0.0), |(n, sum, square), level| {
        let (count, v) = (f64::from(histogram[level]), level as f64);
        (n + count, sum + count * v, square + count * v * v)
    })
}
