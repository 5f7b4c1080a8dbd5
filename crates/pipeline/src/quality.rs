//! A picture's figures as scripts read them.

use serde::{Deserialize, Serialize};
use tracelight_vision::Quality;

/// The object `quality` of `--json`, `summary.json` and a batch's figures: see [`Quality`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct QualityFigures {
    /// As [`Quality::ink_percent`].
    pub ink_percent: f64,
    /// As [`Quality::contrast_percent`].
    pub contrast_percent: f64,
    /// As [`Quality::contrast_to_noise`].
    pub contrast_to_noise: f64,
    /// As [`Quality::noise_levels`].
    pub noise_levels: f64,
    /// As [`Quality::light_evenness`].
    pub light_evenness: f64,
    /// As [`Quality::edge_px`].
    pub edge_px: Option<f64>,
    /// As [`Quality::clipped_percent`].
    pub clipped_percent: f64,
    /// As [`Quality::pen_px`].
    pub pen_px: Option<f64>,
    /// `good` or `usable`.
    pub verdict: String,
    /// What is weak: a clause a figure.
    pub remarks: Vec<String>,
}

impl QualityFigures {
    /// Rounded to what is worth telling.
    #[must_use]
    pub fn of(quality: &Quality) -> Self {
        Self {
            ink_percent: rounded(quality.ink_percent),
            contrast_percent: rounded(quality.contrast_percent),
            contrast_to_noise: rounded(quality.contrast_to_noise),
            noise_levels: rounded(quality.noise_levels),
            light_evenness: rounded(quality.light_evenness),
            edge_px: quality.edge_px.map(rounded),
            clipped_percent: rounded(quality.clipped_percent),
            pen_px: quality.pen_px.map(rounded),
            verdict: quality.verdict().name().to_owned(),
            remarks: quality.remarks(),
        }
    }
}

/// Three decimals: more say nothing of a picture.
fn rounded(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}
