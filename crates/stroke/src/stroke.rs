use std::fmt;
use std::sync::Arc;

use kurbo::{Affine, Point};

use crate::{Colour, Path};

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

/// What a drawing file calls the thing that a stroke comes from, to find it there again.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Entity {
    /// Kind of thing: `LINE` or `INSERT` of a DXF, `path` or `text` of an SVG.
    pub kind: Arc<str>,
    /// Handle in a DXF, id in an SVG, where it has one.
    pub id: Option<Arc<str>>,
    /// Line of the file at which it begins, from 1, where the file is text.
    pub line: Option<u32>,
    /// Further entities that meet it end to end and are one stroke with it.
    pub more: usize,
}

impl fmt::Display for Entity {
    /// Such as `LINE 2F`, `path at line 12`, `LINE 2F and 3 more`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.kind)?;
        match (&self.id, self.line) {
            (Some(id), _) => write!(f, " {id}")?,
            (None, Some(line)) => write!(f, " at line {line}")?,
            (None, None) => {}
        }
        if self.more > 0 { write!(f, " and {} more", self.more) } else { Ok(()) }
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
    /// Name of the layer it lay on, where the drawing has layers.
    pub layer: Option<Arc<str>>,
    /// Colour it had, where the drawing has colours.
    pub colour: Option<Colour>,
    /// What of a drawing file it comes from, where it comes from one.
    pub entity: Option<Arc<Entity>>,
}

impl Stroke {
    /// A centreline of unknown pen width, on no layer, of no colour.
    pub const fn new(path: Path) -> Self {
        Self { path, kind: StrokeKind::Centreline, pen: None, layer: None, colour: None, entity: None }
    }

    /// A stroke with everything of this one but its path.
    pub fn along(&self, path: Path) -> Self {
        Self {
            path,
            kind: self.kind,
            pen: self.pen,
            layer: self.layer.clone(),
            colour: self.colour,
            entity: self.entity.clone(),
        }
    }

    /// Returns the stroke in the opposite direction.
    pub fn reversed(&self) -> Self {
        self.along(self.path.reversed())
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

    /// Share of that length that goes round shapes, 0 to 1; 0 of no strokes.
    pub fn outlined(&self, tolerance: f64) -> f64 {
        let (mut outlines, mut all) = (0.0, 0.0);
        for stroke in &self.strokes {
            let length = stroke.path.length(tolerance);
            all += length;
            outlines += if stroke.kind == StrokeKind::Outline { length } else { 0.0 };
        }
        if all > 0.0 { outlines / all } else { 0.0 }
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
        let strokes = self
            .strokes
            .iter()
            .map(|s| Stroke { pen: s.pen.map(|w| w * scale), ..s.along(s.path.transformed(similarity)) });
        Self { strokes: strokes.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{OrderOptions, order};

    #[test]
    fn what_goes_round_shapes_is_a_share_of_the_length() {
        let line = |to: f64, kind: StrokeKind| {
            let path = Path::polyline(&[Point::new(0.0, 0.0), Point::new(to, 0.0)], false).unwrap();
            Stroke { kind, ..Stroke::new(path) }
        };
        let strokes = vec![line(3.0, StrokeKind::Centreline), line(1.0, StrokeKind::Outline)];
        assert_eq!(Drawing { strokes: strokes.clone() }.outlined(1e-3), 0.25);
        let lines = Drawing { strokes: strokes[..1].to_vec() };
        assert!(lines.outlined(1e-3).is_sign_positive() && lines.outlined(1e-3) == 0.0);
        assert_eq!(Drawing::default().outlined(1e-3), 0.0);
    }

    #[test]
    fn layer_and_colour_stay_with_a_stroke() {
        let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(Point::from);
        let named = |closed| Stroke {
            layer: Some("cut".into()),
            colour: Some(Colour::new(255, 0, 0)),
            pen: Some(1.0),
            ..Stroke::new(Path::polyline(&square, closed).unwrap())
        };
        let drawing = Drawing { strokes: vec![named(true), named(false), named(false).reversed()] };
        let moved = drawing.transformed(Affine::scale(2.0));
        let ordered =
            order(&moved, Point::new(5.0, 5.0), OrderOptions::default(), &|a: Point, b: Point| a.distance(b))
                .drawing;
        assert_eq!(ordered.strokes.len(), 3);
        for stroke in &ordered.strokes {
            assert_eq!(stroke.layer.as_deref(), Some("cut"));
            assert_eq!((stroke.colour, stroke.pen), (Some(Colour::new(255, 0, 0)), Some(2.0)));
        }
    }
}
