//! What an SVG paints, as shapes of a scene.

use kurbo::Affine;
use tracelight_stroke::{Path, Point, Rect, extent_of};

use super::dash::{Dashes, dot, moved};
use super::seen::Region;
use super::seen::scene::{Shape, Sides};
use super::shape::{affine, filled, lines, own_lines, scale, sides};
use crate::is_sound;

/// The inside of a path.
pub(super) struct Fill<'a> {
    pub(super) path: &'a usvg::Path,
    pub(super) rule: usvg::FillRule,
    pub(super) tolerance: f64,
    /// Whether its edge is drawn: it is not where a pen goes along it.
    pub(super) is_drawn: bool,
}

impl Fill<'_> {
    fn outlines(&self) -> Vec<Path> {
        lines(self.path, affine(self.path.abs_transform()), true).paths
    }
}

impl Shape for Fill<'_> {
    fn bounds(&self) -> Rect {
        rect(self.path.abs_bounding_box(), self.tolerance)
    }

    fn region(&self) -> Region {
        filled(&self.outlines(), self.rule, self.tolerance)
    }

    fn lines(&self) -> Vec<Path> {
        if self.is_drawn { self.outlines() } else { Vec::new() }
    }

    fn sides(&self) -> Sides {
        let paths = if self.is_drawn { Vec::new() } else { self.outlines() };
        Sides { paths, tolerance: self.tolerance }
    }
}

/// Tolerance of the edge of a band, which is seldom a line itself, in tolerances of lines.
const BAND: f64 = 2.0;

/// What a pen draws along a path.
pub(super) struct Pen<'a> {
    pub(super) path: &'a usvg::Path,
    pub(super) stroke: &'a usvg::Stroke,
    pub(super) tolerance: f64,
    /// Draw its dashes, not the whole line.
    pub(super) is_dashed: bool,
    /// Whether it paints a band, not only a line without width.
    pub(super) has_band: bool,
}

impl Pen<'_> {
    /// Width on the sheet.
    pub(super) fn width(&self) -> f64 {
        f64::from(self.stroke.width().get()) * scale(self.at())
    }

    fn at(&self) -> Affine {
        affine(self.path.abs_transform())
    }

    /// How many dashes it has at most; `None` if it is not dashed.
    pub(super) fn dashes(&self) -> Option<usize> {
        let dashes = Dashes::of(self.stroke, scale(self.at()))?;
        let paths = lines(self.path, self.at(), false).paths;
        Some(paths.iter().map(|path| dashes.count(path)).fold(0, usize::saturating_add))
    }

    /// Dashes measured in the path's own numbers, for lengths on the sheet depend on the direction.
    fn dashed_askew(&self) -> Vec<Path> {
        let Some(dashes) = Dashes::of(self.stroke, 1.0) else { return Vec::new() };
        let dashed = own_lines(self.path).into_iter().flat_map(|line| dashes.along(&line));
        dashed.map(|dash| moved(&dash, self.at())).collect()
    }
}

impl Shape for Pen<'_> {
    fn bounds(&self) -> Rect {
        rect(self.path.abs_stroke_bounding_box(), self.tolerance)
    }

    fn region(&self) -> Region {
        match self.has_band {
            true => {
                let sides = self.sides();
                filled(&sides.paths, usvg::FillRule::NonZero, sides.tolerance)
            }
            false => Region::default(),
        }
    }

    fn sides(&self) -> Sides {
        if !self.has_band {
            return Sides::default();
        }
        let tolerance = self.tolerance * BAND;
        Sides { paths: sides(self.path, self.stroke, self.at(), tolerance, self.is_dashed), tolerance }
    }

    fn lines(&self) -> Vec<Path> {
        let at = self.at();
        let found = lines(self.path, at, false);
        let dashes = Dashes::of(self.stroke, scale(at)).filter(|_| self.is_dashed);
        let mut drawn = match dashes {
            Some(_) if !is_similar(at) => self.dashed_askew(),
            Some(dashes) => found.paths.iter().flat_map(|line| dashes.along(line)).collect(),
            None => found.paths,
        };
        let is_dotted = self.stroke.linecap() != usvg::LineCap::Butt;
        let dots = found.dots.into_iter().filter(|&p| is_dotted && is_sound(p));
        drawn.extend(dots.map(|p| dot(p, self.width())));
        drawn
    }
}

/// Lines without width: they hide nothing, and others may hide them.
pub(super) struct Letters(pub(super) Vec<Path>);

impl Shape for Letters {
    fn bounds(&self) -> Rect {
        extent_of(&self.0).unwrap_or(Rect::ZERO)
    }

    fn region(&self) -> Region {
        Region::default()
    }

    fn lines(&self) -> Vec<Path> {
        self.0.clone()
    }
}

/// A box of single precision, with what that and chords leave uncertain.
fn rect(found: usvg::Rect, tolerance: f64) -> Rect {
    let [x0, y0, x1, y1] = [found.left(), found.top(), found.right(), found.bottom()].map(f64::from);
    let largest = [x0, y0, x1, y1].into_iter().map(f64::abs).fold(0.0, f64::max);
    let slack = 4.0 * tolerance + 8.0 * f64::from(f32::EPSILON) * largest;
    Rect::new(x0, y0, x1, y1).inflate(slack, slack)
}

/// Whether lengths grow alike in all directions.
fn is_similar(at: Affine) -> bool {
    let [a, b, c, d, ..] = at.as_coeffs();
    let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs());
    let is_turn = (a - d).abs().max((b + c).abs()) <= 1e-4 * size;
    let is_flip = (a + d).abs().max((b - c).abs()) <= 1e-4 * size;
    is_turn || is_flip
}

/// Every point that says where a path goes on the sheet.
pub(super) fn points(path: &usvg::Path) -> impl Iterator<Item = Point> + '_ {
    let at = affine(path.abs_transform());
    path.data().points().iter().map(move |p| at * Point::new(f64::from(p.x), f64::from(p.y)))
}
