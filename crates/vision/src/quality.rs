//! Judges a picture for tracing: figures, their bounds, and a verdict in words.

use crate::VisionError;

/// Figures of an image's quality.
///
/// Lengths are in pixels of the image as it was given, shares in per cent of its pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Mean ink against mean paper, % of the paper's brightness.
    pub contrast_percent: f64,
    /// Contrast over the standard deviation within the paper.
    pub contrast_to_noise: f64,
    /// Standard deviation of the image's pixel noise, levels of 255.
    pub noise_levels: f64,
    /// Darkest paper over brightest: 1 is even light.
    pub light_evenness: f64,
    /// Share of the picture that is ink, %.
    pub ink_percent: f64,
    /// Width of the ink's edges, from 10 % to 90 % of the step across them, px: about 1 is sharp. `None` where too
    /// few edges stand free to tell.
    pub edge_px: Option<f64>,
    /// Share of the pixels at an end of the scale whose kind is not there as a rule, %: burnt spots on grey paper,
    /// shadows darker than the ink. White paper as such and black ink as such are no loss.
    pub clipped_percent: f64,
    /// Width of the pen, px: the median over the length of the centrelines. `None` where there are none.
    pub pen_px: Option<f64>,
    /// Broad ink whose edges fade, % of the picture: of a drawing next to nothing.
    /// `None` where who had it traced has seen what it is, and said so.
    pub tone_percent: Option<f64>,
    /// Whether the ink is lighter than the paper.
    pub light_on_dark: bool,
}

/// A picture that was not refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Every figure is within its bound.
    Good,
    /// Traced, but a figure says that strokes may be missing or wrong.
    Usable,
}

impl Verdict {
    /// `good` or `usable`.
    pub const fn name(self) -> &'static str {
        match self {
            Verdict::Good => "good",
            Verdict::Usable => "usable",
        }
    }
}

/// One of the figures that decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Figure {
    /// [`Quality::contrast_percent`].
    Contrast,
    /// [`Quality::contrast_to_noise`].
    ContrastToNoise,
    /// [`Quality::noise_levels`].
    Noise,
    /// [`Quality::light_evenness`].
    Evenness,
    /// [`Quality::ink_percent`].
    Ink,
    /// [`Quality::edge_px`] over [`Quality::pen_px`], the pen counted as at least [`LEAST_PEN_PX`].
    Blur,
    /// [`Quality::clipped_percent`].
    Clipped,
    /// [`Quality::pen_px`].
    Pen,
    /// [`Quality::tone_percent`].
    Tone,
}

/// On which side of a bound a figure is bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bad {
    Below,
    Above,
}

/// A figure's bounds.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    figure: Figure,
    bad: Bad,
    /// Up to here it is good.
    good: f64,
    /// Beyond this the picture is refused; none where no value alone makes a picture hopeless.
    refused: Option<f64>,
    /// Name, and format of the value's unit.
    words: (&'static str, &'static str),
    /// What to do about it.
    advice: &'static str,
}

/// A pen thinner than this is as wide as a pixel's blur, so that edges are compared with this much.
const LEAST_PEN_PX: f64 = 2.0;

/// Of [`Figure::Contrast`], from here on it is good, %.
pub(crate) const GOOD_CONTRAST_PERCENT: f64 = 12.0;
/// Of [`Figure::Clipped`] and of [`Figure::Tone`], up to here it is good, %.
pub(crate) const GOOD_CLIPPED_PERCENT: f64 = 10.0;
pub(crate) const GOOD_TONE_PERCENT: f64 = 0.06;

/// What is good, what is weak, what is refused.
///
/// Measured on 72 clean drawings of 640 × 480 px from `bench/strokes` (all kinds but filled shapes), spoilt step by
/// step; "exact" is the share with exactly the true number of strokes, 100 % of them before.
///
/// | figure | good | refused | why |
/// |---|---|---|---|
/// | contrast | from 12 % | under 8 % | exact 97 % at 11.6; at 9.3 a tenth of the drawings is refused already. 8 % are 20 levels: under that JPEG's blocks look like ink |
/// | contrast to noise | from 9 | under 4.5 | exact 96 % at 9.5, 88 % at 8.1, 78 % at 6.5. Splitting mere noise at its best threshold gives 2.7 (normal) to 3.5 (uniform) whatever its strength |
/// | noise | up to 20 levels | – | exact 97 % at 18 and at 23; of 29 levels a tenth is refused for contrast to noise |
/// | evenness | from 0.17 | – | exact 100 % at 0.18, 90 % at 0.15, none at 0.13 |
/// | ink | up to 50 % | – | less than half of a drawing is ink; what is more is a photograph, or its paper was taken for ink |
/// | blur | up to 0.7 pens | – | blur that hides the pen's own width gives 1.69 σ / 2.51 σ = 0.67; exact 97 % at 0.61, 88 % at 0.70, 69 % at 0.77 |
/// | clipped | up to 10 % | – | pictures with up to 8 % trace as others do; more is a third of the picture's side |
/// | pen | from 1.8 px | – | exact 94 % at 2.2, 85 % at 1.7, 83 % at 1.5 |
/// | tone | up to 0.3 % | by how much of the light goes round shapes | 3 % of 384 drawings that others made have more, and 81 % of 626 photographs and screenshots, or are refused |
const BOUNDS: [Bounds; 9] = [
    Bounds {
        figure: Figure::Contrast,
        bad: Bad::Below,
        good: GOOD_CONTRAST_PERCENT,
        refused: Some(8.0),
        words: ("contrast is", " %"),
        advice: "use a darker pen or more light",
    },
    Bounds {
        figure: Figure::ContrastToNoise,
        bad: Bad::Below,
        good: 9.0,
        refused: Some(4.5),
        words: ("contrast over the noise of the paper is", ""),
        advice: "use more light, or a scanner",
    },
    Bounds {
        figure: Figure::Noise,
        bad: Bad::Above,
        good: 20.0,
        refused: None,
        words: ("noise is", " levels of 255"),
        advice: "use more light, or a lower ISO",
    },
    Bounds {
        figure: Figure::Evenness,
        bad: Bad::Below,
        good: 0.17,
        refused: None,
        words: ("the darkest paper over the brightest is", ""),
        advice: "light the paper from both sides",
    },
    Bounds {
        figure: Figure::Ink,
        bad: Bad::Above,
        good: 50.0,
        refused: None,
        words: ("the ink's share of the picture is", " %"),
        advice: "is this a photograph? Strokes are found in drawings; --threshold says what is ink",
    },
    Bounds {
        figure: Figure::Blur,
        bad: Bad::Above,
        good: 0.7,
        refused: None,
        words: ("edges are blurred over", " pen widths"),
        advice: "focus, or hold the camera still",
    },
    Bounds {
        figure: Figure::Clipped,
        bad: Bad::Above,
        good: GOOD_CLIPPED_PERCENT,
        refused: None,
        words: ("burnt or black spots cover", " %"),
        advice: "expose for the paper, and avoid reflections",
    },
    Bounds {
        figure: Figure::Pen,
        bad: Bad::Below,
        good: 1.8,
        refused: None,
        words: ("the pen's width is", " px"),
        advice: "use a larger picture or a thicker pen",
    },
    Bounds {
        figure: Figure::Tone,
        bad: Bad::Above,
        good: GOOD_TONE_PERCENT,
        refused: None,
        words: ("broad patches whose edges fade cover", " %"),
        advice: "is this a photograph, or more than a drawing? Crop it to the drawing",
    },
];

impl Bounds {
    fn is_beyond(&self, value: f64, bound: f64) -> bool {
        match self.bad {
            Bad::Below => value < bound,
            Bad::Above => value > bound,
        }
    }

    /// The figure, its value, its bound and what to do.
    fn remark(&self, value: f64) -> String {
        let (name, unit) = self.words;
        let side = if self.bad == Bad::Below { "from" } else { "up to" };
        let text = |v: f64| if v < 10.0 { format!("{v:.2}") } else { format!("{v:.0}") };
        let good = self.good;
        format!("{name} {}{unit} (good {side} {good}{unit}): {}", text(value), self.advice)
    }
}

impl Quality {
    /// What a figure amounts to here; `None` where it is not known.
    pub fn value(&self, figure: Figure) -> Option<f64> {
        match figure {
            Figure::Contrast => Some(self.contrast_percent),
            Figure::ContrastToNoise => Some(self.contrast_to_noise),
            Figure::Noise => Some(self.noise_levels),
            Figure::Evenness => Some(self.light_evenness),
            Figure::Ink => Some(self.ink_percent),
            Figure::Blur => self.edge_px.zip(self.pen_px).map(|(edge, pen)| edge / pen.max(LEAST_PEN_PX)),
            Figure::Clipped => Some(self.clipped_percent),
            Figure::Pen => self.pen_px,
            Figure::Tone => self.tone_percent,
        }
    }

    /// Whether strokes found in it can be trusted.
    pub fn verdict(&self) -> Verdict {
        if self.weak().next().is_none() { Verdict::Good } else { Verdict::Usable }
    }

    /// What is weak: a clause a figure, with its value, its bound and what to do.
    pub fn remarks(&self) -> Vec<String> {
        self.weak().map(|(bounds, value)| bounds.remark(value)).collect()
    }

    /// The verdict as a sentence.
    pub fn words(&self) -> String {
        let remarks = self.remarks();
        if !remarks.is_empty() {
            return format!("usable: {}", remarks.join("; "));
        }
        let pen = self.pen_px.map_or_else(String::new, |pen| format!(", the pen {pen:.1} px wide"));
        let edge = self.edge_px.map_or_else(String::new, |edge| format!(", edges {edge:.1} px"));
        format!("good: contrast {:.0} %{edge}{pen}", self.contrast_percent)
    }

    fn weak(&self) -> impl Iterator<Item = (&'static Bounds, f64)> + '_ {
        let of = |bounds: &'static Bounds| {
            let value = self.value(bounds.figure)?;
            bounds.is_beyond(value, bounds.good).then_some((bounds, value))
        };
        BOUNDS.iter().filter_map(of)
    }

    /// Refuses a picture with a figure beyond its last bound. Who sets the `threshold` has seen the ink: then contrast
    /// is no reason.
    pub(crate) fn gate(&self, threshold_is_set: bool) -> Result<(), VisionError> {
        for bounds in BOUNDS.iter().filter(|b| !(threshold_is_set && b.figure == Figure::Contrast)) {
            let (Some(value), Some(least)) = (self.value(bounds.figure), bounds.refused) else { continue };
            match bounds.figure {
                _ if !bounds.is_beyond(value, least) => {}
                Figure::Contrast => return Err(VisionError::NoContrast { contrast: value, least }),
                _ => return Err(VisionError::Noise { ratio: value, least }),
            }
        }
        Ok(())
    }
}

/// Share of the pixels, %, that lie at an end of the scale while their kind, paper or ink, as a rule does not. The
/// `histogram` is that of dark ink on light paper, of which `ink` is the share that is ink.
pub(crate) fn clipped_percent(histogram: &[u32; 256], ink: f64) -> f64 {
    /// A kind whose median is within a tenth of the scale of its end loses nothing there: paper of 230 under burnt
    /// spots of 255 still is paper.
    const TENTH: usize = 26;
    let all = f64::from(histogram.iter().sum::<u32>()).max(1.0);
    let share = |levels: &[u32]| f64::from(levels.iter().sum::<u32>()) / all;
    let median_of_ink = level_at(histogram, 0.5 * ink * all);
    let median_of_paper = level_at(histogram, 0.5 * (1.0 + ink) * all);
    let black = if median_of_ink > TENTH { share(&histogram[..2]) } else { 0.0 };
    let white = if median_of_paper < 255 - TENTH { share(&histogram[254..]) } else { 0.0 };
    100.0 * (black + white)
}

/// The level of the pixel that has `below` darker ones.
fn level_at(histogram: &[u32; 256], below: f64) -> usize {
    let mut passed = 0.0;
    let reached = |&n: &u32| {
        passed += f64::from(n);
        passed > below
    };
    histogram.iter().position(reached).unwrap_or(255)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clean() -> Quality {
        Quality {
            contrast_percent: 85.0,
            contrast_to_noise: 30.0,
            noise_levels: 0.0,
            light_evenness: 1.0,
            ink_percent: 4.0,
            edge_px: Some(1.1),
            clipped_percent: 0.0,
            pen_px: Some(4.0),
            tone_percent: None,
            light_on_dark: false,
        }
    }

    #[test]
    fn a_clean_drawing_is_good() {
        assert_eq!(clean().verdict(), Verdict::Good);
        assert_eq!(clean().words(), "good: contrast 85 %, edges 1.1 px, the pen 4.0 px wide");
    }

    #[test]
    fn each_figure_beyond_its_bound_is_named_with_value_bound_and_advice() {
        let check = |spoilt: Quality, words: [&str; 2]| {
            assert_eq!(spoilt.verdict(), Verdict::Usable);
            let remarks = spoilt.remarks();
            assert_eq!(remarks.len(), 1, "{remarks:?}");
            assert!(words.iter().all(|w| remarks[0].contains(w)), "{remarks:?}");
        };
        check(
            Quality { contrast_percent: 9.0, ..clean() },
            ["contrast is 9.00 % (good from 12 %)", "darker pen"],
        );
        check(Quality { contrast_to_noise: 5.0, ..clean() }, ["5.00 (good from 9)", "light"]);
        check(Quality { noise_levels: 24.0, ..clean() }, ["24 levels", "up to 20"]);
        check(Quality { light_evenness: 0.1, ..clean() }, ["0.10 (good from 0.17)", "both sides"]);
        check(Quality { ink_percent: 61.0, ..clean() }, ["61 % (good up to 50 %)", "photograph"]);
        check(Quality { edge_px: Some(6.0), ..clean() }, ["1.50 pen widths", "focus"]);
        check(Quality { clipped_percent: 12.0, ..clean() }, ["12 %", "reflections"]);
        check(Quality { pen_px: Some(1.2), ..clean() }, ["1.20 px", "larger picture"]);
    }

    #[test]
    fn refusals_stand_beyond_what_is_weak() {
        for bounds in &BOUNDS {
            let sane = bounds.refused.is_none_or(|refused| bounds.is_beyond(refused, bounds.good));
            assert!(sane, "{bounds:?}");
        }
    }

    #[test]
    fn only_spots_are_clipped_and_neither_white_paper_nor_black_ink() {
        let histogram = |levels: &[(usize, u32)]| {
            let mut histogram = [0; 256];
            levels.iter().for_each(|&(level, n)| histogram[level] += n);
            histogram
        };
        let page = histogram(&[(0, 50), (255, 950)]);
        assert_eq!(clipped_percent(&page, 0.05), 0.0);
        let burnt = histogram(&[(40, 50), (180, 850), (255, 100)]);
        assert!((clipped_percent(&burnt, 0.05) - 10.0).abs() < 1e-9);
        let crushed = histogram(&[(0, 30), (60, 70), (240, 900)]);
        assert!((clipped_percent(&crushed, 0.1) - 3.0).abs() < 1e-9);
    }
}
