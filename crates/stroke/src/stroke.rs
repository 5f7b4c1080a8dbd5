use kurbo::{Affine, Point};

use crate::Path;

/// What of the ink a stroke follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StrokeKind {
    /// The middle of a pen line.
    #[default]
    Centreline,
    /// The edge of a filled shape.
    Outline,
}

impl StrokeKind {
    /// `centreline` or `outline`.
    pub const fn name(self) -> &'static str {
        match self {
            StrokeKind::Centreline => "centreline",
            StrokeKind::Outline => "outline",
        }
    }
}

/// A path drawn lit.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Where the spot goes.
    pub path: Path,
    /// What of the ink it follows.
    pub kind: StrokeKind,
    /// Width of the pen that drew it, in the path's unit, where known.
    pub pen: Option<f64>,
}

impl Stroke {
    /// A centreline of unknown pen width.
    pub const fn new(path: Path) -> Self {
        Self { path, kind: StrokeKind::Centreline, pen: None }
    }

    /// The same stroke drawn from its other end.
    pub fn reversed(&self) -> Self {
        Self { path: self.path.reversed(), ..*self }
    }
}

/// Strokes in drawing order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// First drawn first.
    pub strokes: Vec<Stroke>,
}

impl Drawing {
    /// Sum of the strokes' lengths, to `tolerance` each.
    pub fn length(&self, tolerance: f64) -> f64 {
        self.strokes.iter().map(|s| s.path.length(tolerance)).sum()
    }

    /// Sum of the straight travels between the strokes, from `start` on.
    pub fn travel(&self, start: Point) -> f64 {
        let mut at = start;
        let mut sum = 0.0;
        for stroke in &self.strokes {
            sum += at.distance(stroke.path.start());
            at = stroke.path.end();
        }
        sum
    }

    /// Every path moved by a similarity (rotation, uniform scale, reflection, shift); pen widths scale with it.
    pub fn transformed(&self, similarity: Affine) -> Self {
        let scale = similarity.determinant().abs().sqrt();
        let strokes = self.strokes.iter().map(|s| Stroke {
            path: s.path.transformed(similarity),
            kind: s.kind,
            pen: s.pen.map(|w| w * scale),
        });
        Self { strokes: strokes.collect() }
    }
}
