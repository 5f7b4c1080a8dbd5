//! What a drawing paints, and in which order.

use std::rc::Rc;

use tracelight_stroke::{Colour, Path, Rect, Stroke};

use super::gradient::Gradient;
use super::region::Region;

/// Everything that is painted, bottom first, and the lines that could be drawn of it.
#[derive(Default)]
pub(crate) struct Scene<'a> {
    pub(crate) items: Vec<Item<'a>>,
    pub(crate) veils: Vec<Veil>,
    pub(crate) gates: Vec<Gate>,
    pub(crate) marks: Vec<Mark>,
    /// Elements of all paths, about.
    pub(crate) elements: usize,
}

/// A number that says where in its list a [`Veil`] or [`Gate`] is.
pub(crate) type Number = u32;

/// The geometry of an item. It is made when it is asked for: most of a crowded drawing is hidden, and never asked.
pub(crate) trait Shape {
    /// An upright rectangle round the region and the lines.
    fn bounds(&self) -> Rect;

    /// What is painted.
    fn region(&self) -> Region;

    /// The lines that could be drawn.
    fn lines(&self) -> Vec<Path>;

    /// The edges of the region, if they are not its lines; as chords of their tolerance they are the region's own.
    fn sides(&self) -> Sides {
        Sides::default()
    }
}

/// The sides of a pen's band, or the edge of a fill along which a pen goes.
#[derive(Default)]
pub(crate) struct Sides {
    pub(crate) paths: Vec<Path>,
    /// How closely chords follow them.
    pub(crate) tolerance: f64,
}

/// One painted region: a fill, or the band of a pen.
pub(crate) struct Item<'a> {
    pub(crate) shape: Box<dyn Shape + 'a>,
    pub(crate) ink: Ink,
    /// Own opacity, 0 to 1.
    pub(crate) opacity: f64,
    /// The innermost group around it that lets what is below shine through.
    pub(crate) veil: Option<Number>,
    /// The innermost clip path or mask around it.
    pub(crate) gate: Option<Number>,
    /// Width of the pen, if this is its band.
    pub(crate) pen: Option<f64>,
    /// Number of the path that it is of.
    pub(crate) source: u32,
    /// Looks of what is drawn of it: its colour and layer.
    pub(crate) looks: Stroke,
}

/// What an item is painted with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Ink {
    /// One colour.
    Plain(Colour),
    /// Another one at each place.
    Gradient(Rc<Gradient>),
    /// What is not known here: a pattern, or a blend with what is below.
    Mixed {
        /// Whether it hides what is below.
        hides: bool,
    },
}

impl Ink {
    /// Whether nothing below shines through it where it is.
    pub(crate) fn hides(&self) -> bool {
        const OPAQUE: f64 = 0.98;
        match self {
            Self::Plain(_) => true,
            Self::Gradient(gradient) => gradient.stops.iter().all(|&(.., alpha)| alpha >= OPAQUE),
            Self::Mixed { hides } => *hides,
        }
    }
}

/// A group that is translucent as a whole: what is in it hides other things in it, and nothing below.
pub(crate) struct Veil {
    pub(crate) around: Option<Number>,
    pub(crate) opacity: f64,
}

/// A clip path or a mask: where it lets pass.
pub(crate) struct Gate {
    pub(crate) around: Option<Number>,
    pub(crate) kind: GateKind,
    /// The smallest upright rectangle round where it lets pass.
    pub(crate) bounds: Rect,
    /// The lines along which it cuts.
    pub(crate) outlines: Vec<Path>,
}

/// How a gate tells where it lets pass.
pub(crate) enum GateKind {
    /// Where any of the regions is, each with a gate of its own.
    Clip(Vec<(Region, Option<Number>)>),
    /// Where its own picture is opaque (and bright, if by luminance).
    Mask {
        /// By brightness, not only by opacity.
        luminance: bool,
        /// What it paints, bottom first.
        lights: Vec<Light>,
    },
    /// A mask whose picture is no plain shapes: lets everything pass, as if half-transparent.
    Unknown,
}

/// One painted region of a mask's picture.
pub(crate) struct Light {
    pub(crate) region: Region,
    pub(crate) ink: Ink,
    pub(crate) opacity: f64,
    pub(crate) veil: Option<Number>,
    pub(crate) gate: Option<Number>,
}

/// Lines that could be drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    pub(crate) kind: MarkKind,
    /// The item that they are of; of a clip's edge, the topmost that it could cut.
    pub(crate) item: Number,
}

/// What a line is of the thing painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MarkKind {
    /// The middle of a pen's band.
    Middle,
    /// A side of a pen's band, or the edge of the pen's own fill, where no middle stands for it.
    Side,
    /// The edge of a fill.
    Edge,
    /// The edge of that gate's clip path, which becomes one of whatever it cuts.
    Cut(Number),
}
