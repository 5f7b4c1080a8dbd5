//! The ink of a page as it is traced: with a second look where it seems to be no drawing.

use crate::ink::Ink;
use crate::mask::Mask;
use crate::{Options, Page, VisionError, streak, tone};

/// What is ink of a page, before it is looked at as closely as its lines need.
pub(crate) struct Seen {
    pub(crate) ink: Ink,
    pub(crate) mask: Mask,
    /// How much of it is broad and fades, if that is judged.
    pub(crate) tone_percent: Option<f64>,
}

impl Seen {
    pub(crate) fn of(page: &Page<'_>, options: &Options) -> Result<Self, VisionError> {
        let with_mask = |mut ink: Ink| {
            let mut mask = ink.mask();
            let tone_percent = options.judges().then(|| ink.tone_percent(&mask));
            if let Some(edge_px) = ink.edge_px() {
                streak::fill(&mut ink.darkness, &mut mask, 2.55 * ink.quality.contrast_percent, edge_px);
            }
            Self { ink, mask, tone_percent }
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

    fn is_photograph(&self) -> bool {
        self.tone_percent.is_some_and(|percent| tone::check(percent).is_err())
    }
}
