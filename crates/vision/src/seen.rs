//! Selects the ink for tracing, with a second attempt if the picture seems to be no drawing.

use tracelight_image::Mask;
use tracelight_sheet::Page;
use tracelight_stroke::{Affine, Drawing};

use crate::areas::{Areas, Picture};
use crate::ink::Ink;
use crate::inside::inside;
use crate::options::{Mode, Options};
use crate::{VisionError, streak, tone};

/// What is ink of a page, before it is looked at as closely as its lines need.
pub(crate) struct Seen {
    pub(crate) ink: Ink,
    pub(crate) mask: Mask,
    /// How much of it is broad and fades, if that is judged.
    pub(crate) tone_percent: Option<f64>,
    /// What was coloured in, px of the page's picture.
    pub(crate) areas: Areas,
}

impl Seen {
    pub(crate) fn of(page: &Page<'_>, options: &Options) -> Result<Self, VisionError> {
        let with_mask = |ink: Ink| Self::by(ink, options);
        let seen = with_mask(Ink::of(page, options.threshold_percent, options.sheets)?);
        // slits in what was filled look like light lines: then the paper round them looks like broad ink
        if seen.is_photograph()
            && seen.ink.quality.light_on_dark
            && let Ok(dark) = Ink::of_dark_lines(page, options.sheets).map(with_mask)
            && !dark.is_photograph()
        {
            return Ok(dark);
        }
        Ok(seen)
    }

    /// Its mask, with streaks filled and areas taken out where lines are looked for, unless someone says what is ink.
    fn by(ink: Ink, options: &Options) -> Self {
        let mask = ink.mask();
        let mut seen = Self { ink, mask, tone_percent: None, areas: Areas::default() };
        if let (Some(edge_px), None) = (seen.ink.edge_px(), options.threshold_percent) {
            if matches!(options.mode, Mode::Auto | Mode::Centreline) {
                let strength = 2.55 * seen.ink.quality.contrast_percent;
                streak::fill(&mut seen.ink.darkness, &mut seen.mask, strength, edge_px);
            }
            if options.mode == Mode::Auto {
                seen.take_areas(edge_px, options);
            }
        }
        seen.tone_percent = options.judges().then(|| seen.ink.tone_percent(&seen.mask));
        seen
    }

    fn take_areas(&mut self, edge_px: f64, options: &Options) {
        let (dark, ink, noise) = (&mut self.ink.darkness, &mut self.mask, self.ink.quality.noise_levels);
        let (width, height) = (dark.width as f64, dark.height as f64);
        let Areas { outlines, lined } = Picture { dark, ink, edge_px, noise }.take_areas(options);
        let strokes =
            outlines.iter().map(|stroke| stroke.along(inside(&stroke.path, width, height))).collect();
        let outlines = Drawing { strokes }.transformed(Affine::scale(self.ink.scale)).strokes;
        self.areas = Areas { outlines, lined };
    }

    fn is_photograph(&self) -> bool {
        self.tone_percent.is_some_and(|percent| tone::check(percent).is_err())
    }
}
