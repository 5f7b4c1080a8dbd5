use tracelight_stroke::Path;

/// A letter, or several drawn as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Letter {
    /// Where the pen is, em from the start of the run.
    pub at: f64,
    /// Characters of the text that it stands for.
    pub chars: usize,
    /// To the next letter, em; kerning is in [`at`](Self::at).
    pub advance: f64,
    /// Lines and cubics, em, y up, from the pen on the baseline.
    pub paths: Vec<Path>,
    /// The paths are the edges of the letter; otherwise the strokes of the pen.
    pub has_outlines: bool,
}
