use thiserror::Error;

/// Why an image gives no strokes. The message says which figure failed, its value, its bound, and what to do.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum VisionError {
    /// Ink and paper are of nearly the same brightness.
    #[error(
        "contrast between ink and paper is {contrast:.1} % and must be at least {least:.1} %: use a darker pen, more \
         light, or crop the picture to the drawing"
    )]
    NoContrast {
        /// Mean brightness of the ink below that of the paper, % of the paper's.
        contrast: f64,
        /// Its bound.
        least: f64,
    },
    /// Brightness varies without drawing anything.
    #[error(
        "contrast is {ratio:.1} times the picture's noise and must be at least {least:.1} times: this looks like \
         noise, not like a drawing; use more light, or blur the picture first"
    )]
    Noise {
        /// Contrast over the standard deviation within the paper.
        ratio: f64,
        /// Its bound.
        least: f64,
    },
    /// No ink on paper, as drawings are.
    #[error(
        "this looks like a photograph, not like a drawing: broad dark patches whose edges fade cover {tone_percent:.2} % \
         of it, up to {most_percent:.2} % are a drawing's: crop it to the drawing, or --force traces it all the same"
    )]
    NoDrawing {
        /// Broad ink whose edges fade, % of the picture.
        tone_percent: f64,
        /// Its bound.
        most_percent: f64,
    },
    /// What a computer's screen shows.
    #[error(
        "this looks like a screenshot, not like a drawing: {}: crop it to the drawing, or --force traces it all the same",
        of_a_screen(*.tones, *.kinds, *.written_percent)
    )]
    Screenshot {
        /// Tones that are parted from each other exactly along rows and columns.
        tones: usize,
        /// Different letters that come again pixel by pixel; 0 where the tones say enough.
        kinds: usize,
        /// Of them, % of the ink.
        written_percent: f64,
    },
    /// At the threshold that was set all is ink, or nothing is.
    #[error(
        "--threshold {threshold:.1} % parts no ink from the paper: the strongest ink is {darkest:.1} % darker than it; set \
         it below that and above 0, or leave it to be found (auto)"
    )]
    Threshold {
        /// As set, % of the paper's brightness.
        threshold: f64,
        /// Darkness of the strongest ink, % of the paper's brightness.
        darkest: f64,
    },
    /// An option out of its bounds.
    #[error("{option} is {value} and must be from {least} to {most} {unit}")]
    Option {
        /// Its name on a command line.
        option: &'static str,
        /// As set.
        value: f64,
        /// Its lower bound.
        least: f64,
        /// Its upper bound.
        most: f64,
        /// What it is in.
        unit: &'static str,
    },
    /// All strokes are shorter than asked for.
    #[error(
        "the longest stroke is {longest_px:.1} px and --min-length drops what is shorter than {least_px:.1} px: set it \
         lower"
    )]
    TooShort {
        /// Length of the longest stroke, px.
        longest_px: f64,
        /// Length that was asked for, px.
        least_px: f64,
    },
    /// Everything dark is small enough to be dust.
    #[error(
        "the largest patch of ink has {largest_px} px and dust has up to {least_px} px here: there is nothing to \
         draw; use a larger drawing or a thicker pen"
    )]
    NoInk {
        /// Pixels of the largest patch.
        largest_px: usize,
        /// Pixels a patch must have.
        least_px: usize,
    },
    /// The sweep found no white pixel all round.
    #[error(
        "sweep: at step {step}, pixel ({x:.0}, {y:.0}), no ink at {radius:.0} px in any direction; it needs one closed \
         figure without breaks: use --mode auto"
    )]
    SweepLost {
        /// Steps done before.
        step: usize,
        /// Where, px.
        x: f64,
        /// Where, px.
        y: f64,
        /// Length of a step, px.
        radius: f64,
    },
    /// The sweep never came back to its start.
    #[error(
        "sweep: not back at its start ({x:.0}, {y:.0}) after {steps} steps, more than the figure's ink allows; it \
         needs one closed figure without crossings or hollows: use --mode auto"
    )]
    SweepEndless {
        /// Where it started, px.
        x: f64,
        /// Where it started, px.
        y: f64,
        /// Steps done.
        steps: usize,
    },
    /// Not two ruler marks.
    #[error(
        "found {found} marks of one size on the ruler and need 2: use two like tapes, dark on a light ruler or light \
         on a dark one, and crop the picture to the ruler"
    )]
    Marks {
        /// Marks found.
        found: usize,
    },
    /// The marks lie on a slant.
    #[error(
        "the line through the two marks is {slant_deg:.1}° off upright or level and may be at most {most_deg:.0}°: \
         hold the ruler straight"
    )]
    Slant {
        /// Angle to the nearer of upright and level, degrees.
        slant_deg: f64,
        /// Its bound.
        most_deg: f64,
    },
}

/// By what a screen was told.
fn of_a_screen(tones: usize, kinds: usize, written_percent: f64) -> String {
    match kinds {
        0 => format!("{tones} even tones in it are parted exactly along rows and columns"),
        _ => format!(
            "{written_percent:.0} % of its ink are letters that come again pixel by pixel, of {kinds} kinds"
        ),
    }
}
