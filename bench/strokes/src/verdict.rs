//! What the tracer made of one picture.

use std::time::{Duration, Instant};

use tracelight_stroke::{Drawing, Score, score};
use tracelight_vision::{Grey, Options, trace};

use crate::Picture;

/// One picture's result.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// True strokes.
    pub truth: usize,
    /// What was found; none if the picture was refused.
    pub found: Drawing,
    /// Its score; none if nothing was found.
    pub score: Option<Score>,
    /// Why it was refused.
    pub refused: Option<String>,
    /// What tracing took.
    pub took: Duration,
}

/// Traces a picture and scores the strokes at a tolerance in px.
pub fn judge(picture: &Picture, tolerance_px: f64) -> Verdict {
    let started = Instant::now();
    let traced = Grey::new(picture.width, picture.height, picture.levels.clone())
        .and_then(|grey| trace(&grey, &Options::default()));
    let took = started.elapsed();
    let refused = traced.as_ref().err().map(ToString::to_string);
    let found = traced.map(|t| t.strokes).unwrap_or_default();
    let score = score(&found, &picture.truth, tolerance_px);
    Verdict { truth: picture.truth.strokes.len(), found, score, refused, took }
}

impl Verdict {
    /// Strokes too many (positive) or too few.
    pub fn surplus(&self) -> isize {
        self.found.strokes.len() as isize - self.truth as isize
    }

    /// How wrong, for the worst-first order: unmatched and surplus strokes, then ink; a refusal is as bad as missing all.
    pub fn badness(&self) -> f64 {
        let truth = self.truth as f64;
        self.score.map_or(2.0 * truth + 2.0, |s| {
            (truth - s.matched as f64) + self.surplus().unsigned_abs() as f64 + s.missed + s.stray
        })
    }
}
