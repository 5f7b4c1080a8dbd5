//! Where a drawing lies on a wall, from marks of it that somebody measured there.

use nalgebra::{DMatrix, DVector, Dyn, OMatrix, SMatrix, U2};
use tracelight_maths::{atan2, planar, powi};
use tracelight_stroke::{Affine, Point, Vec2};

use crate::homography::Homography;

/// Standard deviation of a measured coordinate of a mark, m: somebody reads a ruler to a millimetre.
pub const MARK_DEVIATION_M: f64 = 1e-3;

/// The furthest corner of a drawing may be so many times as unsure as a mark is.
const MOST_UNSURE: f64 = 20.0;

/// How much larger one end of a drawing may be drawn than its middle by keystone, or how much smaller.
const MOST_KEYSTONE: f64 = 5.0;

/// A place of a drawing, and where it belongs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// On its sheet, x right, y down, in the sheet's unit.
    pub sheet: Point,
    /// On the target, m.
    pub wall: Point,
}

/// What is known of a drawing besides its marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkedSheet {
    /// Length of the sheet's unit on the target, m, where it is to keep it: with one mark it has to be known, with two it is checked.
    pub unit_m: Option<f64>,
    /// Turned anticlockwise, rad: of one mark.
    pub rotation_rad: f64,
    /// Mirrored left to right.
    pub flip: bool,
    /// The sheet's corners or those of what is drawn on it, in its unit.
    pub corners: [Point; 4],
}

/// What marks leave to a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkedBy {
    /// Its place alone.
    Place,
    /// Place and turn; its size was told.
    Turn,
    /// Place, turn and size.
    Similarity,
    /// And skew: both directions have a size of their own.
    Affine,
    /// And keystone: one end is larger than the other.
    Projective,
}

impl MarkedBy {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Place => "place",
            Self::Turn => "place and turn",
            Self::Similarity => "place, turn and size",
            Self::Affine => "place, turn, size and skew",
            Self::Projective => "place, turn, size, skew and keystone",
        }
    }

    /// As one word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Place => "place",
            Self::Turn => "turn",
            Self::Similarity => "similarity",
            Self::Affine => "affine",
            Self::Projective => "projective",
        }
    }

    /// How many numbers that are: each mark tells two.
    #[must_use]
    pub const fn parameters(self) -> usize {
        match self {
            Self::Place => 2,
            Self::Turn => 3,
            Self::Similarity => 4,
            Self::Affine => 6,
            Self::Projective => 8,
        }
    }
}

/// Why marks do not say where a drawing lies.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MarkError {
    /// No mark.
    #[error("there is no mark; give at least one")]
    None,
    /// One mark tells no size.
    #[error("one mark says where the drawing goes, but not how large it is: give a second one, or --width")]
    NoSize,
    /// The size is told twice.
    #[error("{marks} marks say how large the drawing is: leave --width and --height out")]
    SizeTwice {
        /// How many.
        marks: usize,
    },
    /// They lie together.
    #[error(
        "the marks lie too near each other or on one line: where a mark is measured to {:.0} mm, a corner of the drawing is known to {:.0} mm only; \
         choose marks further apart{}, near the corners of the drawing", 1e3 * MARK_DEVIATION_M, 1e3 * .corner_m,
        if *.marks > 2 { ", not on one line" } else { "" }
    )]
    TooNear {
        /// How many.
        marks: usize,
        /// How unsure the furthest corner is, m.
        corner_m: f64,
    },
    /// They do not tell it at all.
    #[error(
        "marks lie in one place or on one line, and leave open how the drawing lies: choose marks further apart, not on one line, near the corners \
         of the drawing"
    )]
    Degenerate,
    /// They mirror the drawing.
    #[error(
        "the marks mirror the drawing{}: look whether two of them are exchanged, and on which side of 0 each number lies{}",
        if *.asked { " the other way than --flip does" } else { "" }, if *.asked { "" } else { "; --flip mirrors it on purpose" }
    )]
    Mirrored {
        /// Whether a mirrored drawing was asked for.
        asked: bool,
    },
    /// They tilt it over the horizon.
    #[error(
        "the marks would draw one end of the drawing more than {MOST_KEYSTONE} times as large as its middle: look whether two of them are exchanged"
    )]
    Horizon,
}

/// From a sheet to a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one a drawing")]
pub enum SheetMap {
    /// Parallel lines stay parallel.
    Affine(Affine),
    /// Straight lines stay straight. Points are taken relative to the middle of the marks, in lengths of about their distance from it.
    Projective {
        /// From these to the target.
        map: Homography,
        /// From the sheet to these.
        scaled: Affine,
    },
}

impl SheetMap {
    /// Where a place of the sheet comes to lie; `None` beyond the horizon.
    #[must_use]
    pub fn apply(&self, p: Point) -> Option<Point> {
        match self {
            Self::Affine(map) => Some(*map * p),
            Self::Projective { map, scaled } => {
                let p = *scaled * p;
                map.is_before_horizon(p).then(|| map.apply(p)).flatten()
            }
        }
    }

    /// What a direction at a place of the sheet becomes: the derivative along it.
    #[must_use]
    pub fn carry(&self, p: Point, along: Vec2) -> Option<Vec2> {
        match self {
            Self::Affine(map) => Some(linear_part(*map, along)),
            Self::Projective { map, scaled } => map.carry(*scaled * p, linear_part(*scaled, along)),
        }
    }

    /// From the target to the sheet; `None` where the target's origin lies beyond the horizon.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        match self {
            Self::Affine(map) => Some(Self::Affine(map.inverse())),
            Self::Projective { map, scaled } => {
                let map = map.after(*scaled)?.inverse()?;
                Some(Self::Projective { map, scaled: Affine::IDENTITY })
            }
        }
    }

    /// The affine map that is nearest at a place: itself, if it is one.
    #[must_use]
    pub fn near(&self, p: Point) -> Option<Affine> {
        let Self::Projective { .. } = self else {
            let Self::Affine(map) = self else { return None };
            return Some(*map);
        };
        let at = self.apply(p)?;
        let (x, y) = (self.carry(p, Vec2::new(1.0, 0.0))?, self.carry(p, Vec2::new(0.0, 1.0))?);
        let shift = at.to_vec2() - x * p.x - y * p.y;
        Some(Affine::new([x.x, x.y, y.x, y.y, shift.x, shift.y]))
    }
}

/// A direction by an affine map, without its shift.
fn linear_part(map: Affine, v: Vec2) -> Vec2 {
    let [a, b, c, d, _, _] = map.as_coeffs();
    Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
}

/// How a drawing lies by its marks.
#[derive(Clone, Debug)]
pub struct Marked {
    /// What they told.
    pub by: MarkedBy,
    /// From the sheet to the target.
    pub map: SheetMap,
    /// How far each mark lies from where it belongs, in their order, m.
    pub residual_m: Vec<f64>,
    /// How unsure the sheet's corners are in this order, m: root mean square distance, where marks are as unsure as they are taken or found to be.
    pub corner_m: [f64; 4],
    /// How long the sheet's unit is at the middle of the marks, m: the square root of the area of its square.
    pub unit_m: f64,
    /// By how much it is turned anticlockwise there, rad.
    pub rotation_rad: f64,
}

impl Marked {
    /// Root mean square of the residuals, m.
    #[must_use]
    pub fn rms_m(&self) -> f64 {
        (self.residual_m.iter().map(|r| r * r).sum::<f64>() / self.residual_m.len().max(1) as f64).sqrt()
    }

    /// The mark that lies furthest off.
    #[must_use]
    pub fn worst(&self) -> usize {
        let all = self.residual_m.iter().enumerate();
        all.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(index, _)| index)
    }
}

/// The map that fits marks best: of one its place, of two turn and size too, of three skew, of four and more keystone; least squares of the distances
/// on the wall.
///
/// # Errors
/// See [`MarkError`].
pub fn marked(marks: &[Mark], sheet: &MarkedSheet) -> Result<Marked, MarkError> {
    let by = match (marks.len(), sheet.unit_m) {
        (0, _) => return Err(MarkError::None),
        (1, None) => return Err(MarkError::NoSize),
        (1, Some(_)) => MarkedBy::Place,
        (2, Some(_)) => MarkedBy::Turn,
        (2, None) => MarkedBy::Similarity,
        (marks, Some(_)) => return Err(MarkError::SizeTwice { marks }),
        (3, None) => MarkedBy::Affine,
        (_, None) => MarkedBy::Projective,
    };
    let scaled = upright(marks, sheet, by)?;
    let pairs: Vec<(Point, Point)> = marks.iter().map(|mark| (scaled * mark.sheet, mark.wall)).collect();
    let (map, covariance) = match by {
        MarkedBy::Projective => {
            let map = Homography::through(&pairs, MARK_DEVIATION_M).ok_or(MarkError::Degenerate)?;
            (SheetMap::Projective { map, scaled }, None)
        }
        _ => {
            let fit = Fit::of(by, &pairs, sheet.rotation_rad)?;
            (SheetMap::Affine(fit.map * scaled), Some(fit))
        }
    };
    check_shape(&map, marks, sheet)?;
    let off = |mark: &Mark| map.apply(mark.sheet).map(|p| p.distance(mark.wall)).ok_or(MarkError::Horizon);
    let residual_m = marks.iter().map(off).collect::<Result<Vec<f64>, _>>()?;
    let scatter = scatter(&residual_m, by);
    let mut corner_m = [0.0; 4];
    for (slot, &corner) in corner_m.iter_mut().zip(&sheet.corners) {
        let own = match (&covariance, &map) {
            (Some(fit), _) => fit.deviation_m(scaled * corner),
            (None, SheetMap::Projective { map, .. }) => {
                map.apply_with(scaled * corner).map_or(f64::INFINITY, |seen| seen.covariance.trace().sqrt())
            }
            (None, SheetMap::Affine(_)) => 0.0,
        };
        *slot = own * scatter;
    }
    let furthest = corner_m.iter().copied().fold(0.0, f64::max);
    let corner_off_m = furthest / scatter;
    if corner_off_m.is_nan() || corner_off_m > MOST_UNSURE * MARK_DEVIATION_M {
        return Err(MarkError::TooNear { marks: marks.len(), corner_m: corner_off_m });
    }
    let (unit_m, rotation_rad) = lies(&map, marks, sheet.flip)?;
    Ok(Marked { by, map, residual_m, corner_m, unit_m, rotation_rad })
}

/// How many times as far from each other marks lie as was taken, where there are more of them than are needed; at least one.
fn scatter(residual_m: &[f64], by: MarkedBy) -> f64 {
    let spare = (2 * residual_m.len()).saturating_sub(by.parameters());
    if spare == 0 {
        return 1.0;
    }
    let squares: f64 = residual_m.iter().map(|r| powi(r / MARK_DEVIATION_M, 2)).sum();
    (squares / spare as f64).sqrt().max(1.0)
}

/// From the sheet to coordinates about the middle of the marks, y up and mirrored if asked for: in metres where the size is told, else in lengths of
/// about the marks' distance from their middle.
fn upright(marks: &[Mark], sheet: &MarkedSheet, by: MarkedBy) -> Result<Affine, MarkError> {
    let n = marks.len() as f64;
    let middle = marks.iter().map(|mark| mark.sheet.to_vec2()).sum::<Vec2>() / n;
    let mean = marks.iter().map(|mark| (mark.sheet.to_vec2() - middle).hypot()).sum::<f64>() / n;
    let scale = match (by, sheet.unit_m) {
        (MarkedBy::Place | MarkedBy::Turn, Some(unit_m)) => unit_m,
        _ => 1.0 / mean,
    };
    if !(scale.is_finite() && scale > 0.0) || (by != MarkedBy::Place && mean <= 0.0) {
        return Err(MarkError::Degenerate);
    }
    let mirror = if sheet.flip { -scale } else { scale };
    Ok(Affine::scale_non_uniform(mirror, -scale) * Affine::translate(-middle))
}

/// Refuses a map that mirrors, or that bends the drawing towards the horizon.
fn check_shape(map: &SheetMap, marks: &[Mark], sheet: &MarkedSheet) -> Result<(), MarkError> {
    for &p in sheet.corners.iter().chain(marks.iter().map(|mark| &mark.sheet)) {
        let near = map.near(p).ok_or(MarkError::Horizon)?;
        // the sheet's y points down, so that what is not mirrored turns the other way
        if (near.determinant() < 0.0) == sheet.flip {
            return Err(MarkError::Mirrored { asked: sheet.flip });
        }
        if let SheetMap::Projective { map, scaled } = map {
            let larger = map.depth(*scaled * p);
            if !(1.0 / MOST_KEYSTONE..=MOST_KEYSTONE).contains(&larger) {
                return Err(MarkError::Horizon);
            }
        }
    }
    Ok(())
}

/// Length of a unit and turn at the middle of the marks.
fn lies(map: &SheetMap, marks: &[Mark], flip: bool) -> Result<(f64, f64), MarkError> {
    let middle = marks.iter().map(|mark| mark.sheet.to_vec2()).sum::<Vec2>() / marks.len() as f64;
    let near = map.near(middle.to_point()).ok_or(MarkError::Horizon)?;
    let [a, b, ..] = near.as_coeffs();
    let turn = if flip { atan2(-b, -a) } else { atan2(b, a) };
    Ok((near.determinant().abs().sqrt(), turn))
}

/// An affine map by least squares, with what is known of its parameters.
struct Fit {
    by: MarkedBy,
    map: Affine,
    /// Covariance of the parameters, m².
    covariance: DMatrix<f64>,
}

impl Fit {
    /// Of pairs about their middle, y up.
    fn of(by: MarkedBy, pairs: &[(Point, Point)], rotation_rad: f64) -> Result<Self, MarkError> {
        // a turn of a known size is no linear parameter: it is found first, and its derivatives are taken there
        let turned = match by {
            MarkedBy::Place => planar::rotation(rotation_rad),
            MarkedBy::Turn => planar::rotation(turn(pairs)),
            _ => Affine::IDENTITY,
        };
        let (mut normal, mut gradient) =
            (DMatrix::zeros(by.parameters(), by.parameters()), DVector::zeros(by.parameters()));
        for &(from, to) in pairs {
            let rows = rows(by, turned * from);
            let fixed =
                if matches!(by, MarkedBy::Place | MarkedBy::Turn) { turned * from } else { Point::ORIGIN };
            let off = to - fixed;
            normal += rows.transpose() * &rows;
            gradient += rows.transpose() * DVector::from_vec(vec![off.x, off.y]);
        }
        let inverse = normal.cholesky().ok_or(MarkError::Degenerate)?.inverse();
        let found = &inverse * gradient;
        let map = match by {
            MarkedBy::Place | MarkedBy::Turn => turned.then_translate(Vec2::new(found[0], found[1])),
            MarkedBy::Similarity => {
                Affine::new([found[2], found[3], -found[3], found[2], found[0], found[1]])
            }
            _ => Affine::new([found[2], found[4], found[3], found[5], found[0], found[1]]),
        };
        let covariance = inverse * powi(MARK_DEVIATION_M, 2);
        let is_sound = map.as_coeffs().iter().all(|c| c.is_finite()) && map.determinant().abs() > 0.0;
        is_sound.then_some(Self { by, map, covariance }).ok_or(MarkError::Degenerate)
    }

    /// How unsure a place is, m: root mean square distance.
    fn deviation_m(&self, p: Point) -> f64 {
        let turned =
            if self.by == MarkedBy::Turn { (self.map * p) - (self.map * Point::ORIGIN) } else { p.to_vec2() };
        let rows = rows(self.by, turned.to_point());
        (&rows * &self.covariance * rows.transpose()).trace().max(0.0).sqrt()
    }
}

/// Derivatives of where a point comes to lie, by shift right and up, then by what else is told.
fn rows(by: MarkedBy, p: Point) -> OMatrix<f64, U2, Dyn> {
    let all: SMatrix<f64, 2, 6> = match by {
        MarkedBy::Place => SMatrix::from_row_slice(&[1., 0., 0., 0., 0., 0., 0., 1., 0., 0., 0., 0.]),
        MarkedBy::Turn => SMatrix::from_row_slice(&[1., 0., -p.y, 0., 0., 0., 0., 1., p.x, 0., 0., 0.]),
        MarkedBy::Similarity => {
            SMatrix::from_row_slice(&[1., 0., p.x, -p.y, 0., 0., 0., 1., p.y, p.x, 0., 0.])
        }
        MarkedBy::Affine | MarkedBy::Projective => {
            SMatrix::from_row_slice(&[1., 0., p.x, p.y, 0., 0., 0., 1., 0., 0., p.x, p.y])
        }
    };
    all.columns(0, by.parameters().min(6)).into_owned()
}

/// The turn of pairs about their middles that leaves least squares (Kabsch, in the plane), rad.
fn turn(pairs: &[(Point, Point)]) -> f64 {
    let n = pairs.len() as f64;
    let middle = pairs.iter().map(|pair| pair.1.to_vec2()).sum::<Vec2>() / n;
    let (cross, dot) = pairs.iter().fold((0.0, 0.0), |(cross, dot), (from, to)| {
        let (a, b) = (from.to_vec2(), to.to_vec2() - middle);
        (cross + a.cross(b), dot + a.dot(b))
    });
    atan2(cross, dot)
}

#[cfg(test)]
mod tests;
