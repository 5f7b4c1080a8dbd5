use tracelight_stroke::{Affine, Path, Stroke, StrokeKind};

use crate::Touch;

/// How a pen's line ends and turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nib {
    /// Round caps and joins: a pen.
    Round,
    /// Butt caps and mitre joins: a drawing program.
    Sharp,
}

/// What a figure is drawn with, and how large. Lengths in px.
#[derive(Clone, Copy, Debug)]
pub struct Hand {
    /// Width of the line.
    pub pen: f64,
    /// Ends and corners of the line.
    pub nib: Nib,
    /// Least paper between two lines.
    pub paper: f64,
    /// Half of what the figure measures across, about.
    pub size: f64,
}

/// What is put on the paper.
#[derive(Clone, Debug)]
pub enum Ink {
    /// A line along the path.
    Line {
        /// Its middle.
        path: Path,
        /// Its width, px.
        pen: f64,
        /// Its ends and corners.
        nib: Nib,
    },
    /// The inside of closed paths; a path inside another one is a hole.
    Fill(Vec<Path>),
    /// The inside of a closed path, coloured in.
    Wash {
        /// Its edge.
        outline: Path,
        /// Share of the ink's darkness.
        dark: f64,
    },
    /// A line whose width or darkness changes along it.
    Touches(Vec<Touch>),
    /// A closed path filled with a felt pen, to and fro.
    Scribble {
        /// Its edge.
        outline: Path,
        /// The ways to and fro; what they reach beyond the edge is not drawn.
        ways: Vec<Path>,
        /// The pen's width, px.
        pen: f64,
    },
}

/// Ink, and the strokes that a hand would draw it with.
#[derive(Clone, Debug, Default)]
pub struct Figure {
    /// The truth.
    pub strokes: Vec<Stroke>,
    /// What is seen.
    pub ink: Vec<Ink>,
}

impl Figure {
    /// Pen lines, each of them a stroke.
    pub(crate) fn lines(hand: &Hand, paths: impl IntoIterator<Item = Path>) -> Self {
        let mut figure = Self::default();
        for path in paths {
            figure.ink.push(Ink::Line { path: path.clone(), pen: hand.pen, nib: hand.nib });
            figure.strokes.push(pen_stroke(path, hand.pen));
        }
        figure
    }

    /// One stroke of which only these pieces are inked.
    pub(crate) fn broken(hand: &Hand, whole: Path, pieces: impl IntoIterator<Item = Path>) -> Self {
        let ink = pieces.into_iter().map(|path| Ink::Line { path, pen: hand.pen, nib: hand.nib });
        Self { ink: ink.collect(), strokes: vec![pen_stroke(whole, hand.pen)] }
    }

    /// A filled shape: its outline and its holes'.
    pub(crate) fn filled(outlines: Vec<Path>) -> Self {
        let stroke = |path: &Path| Stroke { kind: StrokeKind::Outline, ..Stroke::new(path.clone()) };
        Self { strokes: outlines.iter().map(stroke).collect(), ink: vec![Ink::Fill(outlines)] }
    }

    /// One stroke, seen as this ink.
    pub(crate) fn stroke(path: Path, pen: f64, ink: impl IntoIterator<Item = Ink>) -> Self {
        Self { strokes: vec![pen_stroke(path, pen)], ink: ink.into_iter().collect() }
    }

    /// The ink, what certainly belongs to one stroke together.
    pub(crate) fn by_stroke(&self) -> Vec<Vec<&Ink>> {
        match self.ink.len() == self.strokes.len() {
            true => self.ink.iter().map(|ink| vec![ink]).collect(),
            false => vec![self.ink.iter().collect()],
        }
    }

    /// Both.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.strokes.extend(other.strokes);
        self.ink.extend(other.ink);
        self
    }

    /// Width of the thinnest line, at its thinnest place, px; none if there is none.
    pub(crate) fn thinnest(&self) -> Option<f64> {
        self.widths().reduce(f64::min)
    }

    /// Widths of the lines, px, along those that swell too; a broad nib's is the least and the most that it draws.
    pub(crate) fn widths(&self) -> impl Iterator<Item = f64> + '_ {
        let widths = |ink: &Ink| match ink {
            Ink::Line { pen, .. } | Ink::Scribble { pen, .. } => vec![*pen],
            Ink::Touches(touches) => {
                let both = |t: &Touch| [2.0 * t.radius, 2.0 * (t.radius + t.reach.hypot())];
                touches.iter().flat_map(both).collect()
            }
            Ink::Fill(_) | Ink::Wash { .. } => vec![],
        };
        self.ink.iter().flat_map(widths)
    }

    /// Moved by a similarity that keeps lengths.
    pub(crate) fn moved(&self, by: Affine) -> Self {
        let stroke = |s: &Stroke| s.along(s.path.transformed(by));
        let ink = |i: &Ink| match i {
            Ink::Line { path, pen, nib } => Ink::Line { path: path.transformed(by), pen: *pen, nib: *nib },
            Ink::Wash { outline, dark } => Ink::Wash { outline: outline.transformed(by), dark: *dark },
            Ink::Fill(paths) => Ink::Fill(paths.iter().map(|p| p.transformed(by)).collect()),
            Ink::Touches(touches) => Ink::Touches(touches.iter().map(|t| t.moved(by)).collect()),
            Ink::Scribble { outline, ways, pen } => Ink::Scribble {
                outline: outline.transformed(by),
                ways: ways.iter().map(|w| w.transformed(by)).collect(),
                pen: *pen,
            },
        };
        Self { strokes: self.strokes.iter().map(stroke).collect(), ink: self.ink.iter().map(ink).collect() }
    }
}

pub(crate) fn pen_stroke(path: Path, pen: f64) -> Stroke {
    Stroke { pen: Some(pen), ..Stroke::new(path) }
}
