use std::f64::consts::PI;

use tracelight_stroke::StrokeKind;

use crate::bounds::Bounds;
use crate::{Figure, Hand, Kind, Random, Set, Size};

/// Width of the thinnest pen on 240 rows, px. It grows with the root of the rows: a better camera sees the same pens, and
/// finer ones.
const THINNEST_PEN_PX: f64 = 1.8;
/// On the small pictures of the world no pen is thinner than this, px.
const THINNEST_OF_THE_WORLD_PX: f64 = 1.5;
/// The thickest pen is this share of the rows.
const THICKEST_PEN: f64 = 1.0 / 50.0;
/// Least paper between lines, px.
const LEAST_PAPER_PX: f64 = 3.0;
/// A page of one kind, and a page of everything, have up to this many strokes.
const MOST_STROKES: usize = 15;
const MOST_STROKES_MIXED: usize = 40;
const MOST_STROKES_WRITTEN: usize = 120;
/// What stands upright leans by up to this, of a whole turn.
const LEAN: f64 = 0.02;

/// How pages of a kind are made.
pub(crate) struct Habit {
    kind: Kind,
    /// Figures on a page, fewest and most.
    pub(crate) figures: (usize, usize),
    /// Strokes on a page, at most.
    pub(crate) strokes: usize,
    /// Pens, times the usual thinnest and thickest.
    pens: (f64, f64),
    /// Least paper between lines, px.
    pub(crate) paper_px: f64,
    /// Half of a figure across, as a share of the rows: least, and most where it is alone.
    pub(crate) half: (f64, f64),
    /// The same, least, in pens.
    pub(crate) half_pens: f64,
    /// Pens kept free along the border, beside the usual margin.
    pub(crate) margin_pens: f64,
    turned: Turned,
}

/// Which way figures lie.
#[derive(Clone, Copy)]
enum Turned {
    /// Any.
    Freely,
    /// As people write, leaning a little.
    Upright,
    /// Half of them each.
    Either,
}

impl Habit {
    pub(crate) fn of(kind: Kind) -> Self {
        let usual = Self {
            kind,
            figures: (1, 5),
            strokes: MOST_STROKES,
            pens: (1.0, 1.0),
            paper_px: LEAST_PAPER_PX,
            half: (0.08, 0.42),
            half_pens: 6.0,
            margin_pens: 0.0,
            turned: Turned::Freely,
        };
        match kind {
            Kind::Lines | Kind::Arcs => Self { figures: (1, 10), ..usual },
            Kind::Polylines | Kind::Splines | Kind::Closed | Kind::Gaps => Self { figures: (1, 7), ..usual },
            Kind::Crossings | Kind::Junctions | Kind::Tangents | Kind::Loops | Kind::Filled => usual,
            Kind::Parallels => Self { figures: (1, 3), ..usual },
            Kind::Mixed => Self { figures: (5, 16), strokes: MOST_STROKES_MIXED, ..usual },
            // the page's pen is the widest place of a swelling line
            Kind::Swell | Kind::Brush | Kind::Nib => Self { pens: (1.8, 2.2), ..usual },
            Kind::Fading | Kind::Graphite => Self { figures: (1, 7), ..usual },
            Kind::Crayon => Self { figures: (1, 5), pens: (2.6, 1.0), ..usual },
            Kind::Felt => Self { figures: (1, 4), pens: (1.8, 2.4), ..usual },
            Kind::Retouched => Self { pens: (1.8, 1.6), ..usual },
            // the page's pen is what all passes of a line are across together
            Kind::Sketched => Self { figures: (4, 9), pens: (2.4, 2.6), ..usual },
            Kind::Hatching => Self { figures: (1, 3), strokes: MOST_STROKES_MIXED, paper_px: 1.5, ..usual },
            Kind::Writing => Self { figures: (2, 12), paper_px: 1.2, ..usual }.written(),
            Kind::Marks => Self { figures: (6, 24), paper_px: 1.5, ..usual }.written(),
            Kind::Hairpin | Kind::Shallow => Self { half: (0.15, 0.45), half_pens: 10.0, ..usual },
            Kind::Hair => Self { figures: (1, 4), strokes: MOST_STROKES_MIXED, half: (0.12, 0.4), ..usual },
            Kind::Spots => Self { figures: (1, 7), strokes: MOST_STROKES_MIXED, ..usual },
            Kind::Silhouette => Self { figures: (1, 3), half: (0.2, 0.45), half_pens: 12.0, ..usual },
            Kind::Frame => Self { margin_pens: 5.0, turned: Turned::Upright, ..usual },
            Kind::Thick => {
                Self { figures: (1, 1), pens: (1.6, 5.5), half: (0.28, 0.44), half_pens: 0.0, ..usual }
            }
            Kind::Coloured => Self { half: (0.14, 0.42), half_pens: 12.0, ..usual },
            Kind::Ballpoint => Self { figures: (1, 7), pens: (1.4, 0.6), ..usual },
            Kind::Signs => Self { figures: (1, 4), pens: (1.0, 3.0), half_pens: 5.0, ..usual },
            Kind::Ruled | Kind::Squared | Kind::Dotted | Kind::Table => {
                Self { figures: (1, 6), turned: Turned::Either, ..usual }
            }
        }
    }

    fn written(self) -> Self {
        Self { strokes: MOST_STROKES_WRITTEN, turned: Turned::Upright, ..self }
    }

    /// A pen for a page, px. Lengths are kept `roomy` times as large.
    pub(crate) fn pen(&self, random: &mut Random, size: Size, roomy: f64) -> f64 {
        let rows = size.height as f64;
        let thinnest = THINNEST_PEN_PX * (rows / 240.0).sqrt() * roomy;
        let thickest = rows * THICKEST_PEN;
        if self.kind.set() == Set::Plain {
            return random.log_between(thinnest, thickest);
        }
        let least = thinnest.max(THINNEST_OF_THE_WORLD_PX * roomy) * self.pens.0;
        random.log_between(least, (thickest * self.pens.1).max(1.3 * least))
    }

    /// How far a figure is turned, of a turn by chance, rad.
    pub(crate) fn turn(&self, chance: f64) -> f64 {
        match self.turned {
            Turned::Upright => (chance - PI) * LEAN,
            Turned::Either if chance < PI => (2.0 * chance - PI) * LEAN,
            Turned::Freely | Turned::Either => chance,
        }
    }

    /// Pen and bounds by which a figure is judged.
    pub(crate) fn bounds(&self, figure: &Figure, hand: &Hand) -> (f64, Bounds) {
        let pen = figure.thinnest().unwrap_or(hand.pen);
        match self.kind {
            Kind::Writing | Kind::Marks | Kind::Ruled | Kind::Squared | Kind::Dotted
                if (pen - hand.pen).abs() > 0.01 * hand.pen =>
            {
                (pen, Bounds::SMALL)
            }
            Kind::Hairpin | Kind::Hair | Kind::Shallow => (hand.pen, Bounds::SHARP),
            Kind::Hatching => (hand.pen, Bounds::HATCHED),
            Kind::Signs => (hand.pen, Bounds::SHORT),
            Kind::Spots | Kind::Silhouette => (hand.pen, Bounds::FILLED),
            Kind::Felt if figure.strokes.iter().any(|s| s.kind == StrokeKind::Outline) => {
                (hand.pen, Bounds::FILLED)
            }
            _ => (hand.pen, Bounds::USUAL),
        }
    }
}
