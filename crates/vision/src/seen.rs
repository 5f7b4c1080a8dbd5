//! The ink of a page as it is traced: with a second look where it seems to be no drawing.

use tracelight_stroke::{Affine, Drawing, Stroke};

use crate::areas::Picture;
use crate::ink::Ink;
use crate::inside::inside;
use crate::mask::Mask;
use crate::{Mode, Options, Page, VisionError, streak, tone};

/// What is ink of a page, before it is looked at as closely as its lines need.
pub(crate) struct Seen {
    pub(crate) ink: Ink,
    pub(crate) mask: Mask,
    /// How much of it is broad and fades, if that is judged.
    pub(crate) tone_percent: Option<f64>,
    /// The outlines of areas that were coloured in, px of the page's picture.
    pub(crate) areas: Vec<Stroke>,
}

impl Seen {
    pub(crate) fn of(page: &Page<'_>, options: &Options) -> Result<Self, VisionError> {
        let with_mask = |mut ink: Ink| {
            let mut mask = ink.mask();
            if let Some(edge_px) = ink.edge_px() {
                streak::fill(&mut ink.darkness, &mut mask, 2.55 * ink.quality.contrast_percent, edge_px);
            }
            let seen = Self { ink, mask, tone_percent: None, areas: Vec::new() }.without_areas(options);
            let tone_percent = options.judges().then(|| seen.ink.tone_percent(&seen.mask));
            Self { tone_percent, ..seen }
        };
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

    /// With what was coloured in taken out, unless outlines are wanted or who says what is ink.
    fn without_areas(mut self, options: &Options) -> Self {
        let looks_for_lines = matches!(options.mode, Mode::Auto | Mode::Centreline);
        let (Some(edge_px), None, true) = (self.ink.edge_px(), options.threshold_percent, looks_for_lines)
        else {
            return self;
        };
        let (dark, ink, noise) = (&mut self.ink.darkness, &mut self.mask, self.ink.quality.noise_levels);
        let (width, height) = (dark.width as f64, dark.height as f64);
        let outlines = Picture { dark, ink, edge_px, noise }.without_areas(options);
        let strokes =
            outlines.iter().map(|stroke| stroke.along(inside(&stroke.path, width, height))).collect();
        let outlines = Drawing { strokes }.transformed(Affine::scale(self.ink.scale));
        Self { areas: outlines.strokes, ..self }
    }

    fn is_photograph(&self) -> bool {
        self.tone_percent.is_some_and(|percent| tone::check(percent).is_err())
    }
}
