//! A picture's figures as scripts read them.

use serde::{Deserialize, Serialize};
use tracelight_vision::Quality;

/// The object `quality` of `--json`, `summary.json` and a batch's figures: see [`Quality`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct QualityFigures {
    pub(crate) ink_percent: f64,
    pub(crate) contrast_percent: f64,
    pub(crate) contrast_to_noise: f64,
    pub(crate) noise_levels: f64,
    pub(crate) light_evenness: f64,
    pub(crate) edge_px: Option<f64>,
    pub(crate) clipped_percent: f64,
    pub(crate) pen_px: Option<f64>,
    /// `good` or `usable`.
    pub(crate) verdict: String,
    /// What is weak: a clause a figure.
    pub(crate) remarks: Vec<String>,
}

impl QualityFigures {
    pub(crate) fn of(quality: &Quality) -> Self {
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
