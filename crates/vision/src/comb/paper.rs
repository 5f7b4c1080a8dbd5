//! Where a page has paper, and the page laid square: on a sheet that was photographed at a slant rules fan out and lie aslant, but they
//! are printed along its sides. They are looked for where its sides are a rectangle's, and taken out of the picture where they then lie.

use std::borrow::Cow;

use tracelight_image::{Mask, Plane, Projection};
use tracelight_stroke::{Point, Vec2};

/// How a sheet lies in a picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lie<'a> {
    /// What of the plane lies beside it; `None` where all is paper.
    pub(crate) beside: Option<&'a Mask>,
    /// The quadrilateral on whose lines its sides lie, clockwise from the upper left, px; `None` where they are not known.
    pub(crate) corners: Option<[Point; 4]>,
}

/// A side moves across its way by no more than this share of it where the sheet lies square as it is.
const SQUARE: f64 = 0.01;
/// Largest enlargement of a sheet laid square, in pixels per pixel of the plane.
const MOST_ENLARGED: f64 = 2.0;
/// Pixel count beyond which pixels are averaged two by two: a rule is wider there.
const MOST_PX: f64 = 3e6;

/// A sheet laid square.
#[derive(Debug)]
pub(super) struct Laid<'a> {
    beside: Option<&'a Mask>,
    turned: Option<Turned>,
}

/// A sheet that lies aslant: what it is when it is laid square.
#[derive(Debug)]
struct Turned {
    width: usize,
    height: usize,
    /// So many pixels of the plane either way are one.
    by: usize,
    on_plane: Projection,
    /// Pixels of the plane.
    plane: (usize, usize),
}

impl<'a> Laid<'a> {
    /// In a plane of so many px.
    pub(super) fn of(lie: Lie<'a>, size: (usize, usize)) -> Self {
        let turned = lie.corners.and_then(|corners| Turned::of(&corners, size));
        Self { beside: lie.beside, turned }
    }

    /// Whether there is paper on the plane.
    fn has(&self, x: isize, y: isize) -> bool {
        self.beside.is_none_or(|beside| !beside.get(x, y))
    }

    /// A plane as it is seen so.
    pub(super) fn seen<'p>(&self, plane: &'p Plane<u8>) -> Cow<'p, Plane<u8>> {
        self.turned.as_ref().map_or(Cow::Borrowed(plane), |turned| Cow::Owned(turned.seen(plane)))
    }
}

impl Turned {
    /// `None` where it lies square as it is, or on its side.
    fn of(corners: &[Point; 4], plane: (usize, usize)) -> Option<Self> {
        let [a, b, c, d] = *corners;
        let (level, upright) = ([b - a, c - d], [d - a, c - b].map(|way| Vec2::new(way.y, way.x)));
        let mut sides = level.into_iter().chain(upright);
        // corners that someone gives may begin with another one: then what is level is upright
        let lies_right = sides.clone().all(|side| side.x > side.y.abs());
        let is_turned = lies_right && sides.any(|side| side.y.abs() > SQUARE * side.x);
        // as large as where it is nearest: no rule gets thinner
        let (width, height) = (a.distance(b).max(d.distance(c)), a.distance(d).max(b.distance(c)));
        let most = MOST_ENLARGED * (plane.0 * plane.1) as f64;
        if !is_turned || width.min(height) < 1.0 || width * height > most {
            return None;
        }
        let by = if width * height > MOST_PX { 2 } else { 1 };
        let side = |px: f64| (px / by as f64).ceil() as usize;
        let (width, height) = (side(width), side(height));
        let on_plane = Projection::of((width as f64, height as f64), corners)?;
        Some(Self { width, height, by, on_plane, plane })
    }

    /// Where the centre of one of its pixels is on the plane, if it is on it, px.
    fn place(&self, x: usize, y: usize) -> Option<Point> {
        let at = self.on_plane.at(x as f64 + 0.5, y as f64 + 0.5)?;
        let (right, bottom) = (self.plane.0 as f64, self.plane.1 as f64);
        ((0.0..right).contains(&at.x) && (0.0..bottom).contains(&at.y)).then_some(at)
    }

    fn seen(&self, plane: &Plane<u8>) -> Plane<u8> {
        let plane = if self.by > 1 { Cow::Owned(plane.reduced(self.by)) } else { Cow::Borrowed(plane) };
        let place = |x: usize, y: usize| {
            let at = self.on_plane.at(x as f64 + 0.5, y as f64 + 0.5).unwrap_or(Point::new(FAR, FAR));
            Point::new(at.x / self.by as f64, at.y / self.by as f64)
        };
        let mut seen = Plane::filled(self.width, self.height, 0);
        let mut levels = [0.0; STRAIGHT];
        for y in 0..self.height {
            for (k, row) in seen.row_mut(y).chunks_mut(STRAIGHT).enumerate() {
                let (from, to) = (place(k * STRAIGHT, y), place((k + 1) * STRAIGHT, y));
                plane.along(from, (to - from) / STRAIGHT as f64, &mut levels[..row.len()]);
                row.iter_mut().zip(levels).for_each(|(to, level)| *to = (level + 0.5) as u8);
            }
        }
        seen
    }
}

/// So many pixels of a sheet laid square lie straight and equally far apart on the plane.
const STRAIGHT: usize = 16;

/// The paper of a sheet laid square, along and across rules of one direction; places are px from the first pixel's centre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper<'a> {
    laid: &'a Laid<'a>,
    /// Whether along the rules is down the plane.
    is_upright: bool,
}

impl<'a> Paper<'a> {
    /// For level rules.
    pub(super) const fn level(laid: &'a Laid<'a>) -> Self {
        Self { laid, is_upright: false }
    }

    /// For upright rules.
    pub(super) const fn upright(laid: &'a Laid<'a>) -> Self {
        Self { laid, is_upright: true }
    }

    /// Whether there is more than paper.
    pub(super) const fn is_cut_out(self) -> bool {
        self.laid.beside.is_some()
    }

    /// From where to where there is paper across a place along, of so many px.
    pub(super) fn across(self, along: usize, breadth: usize) -> (f64, f64) {
        let has = |&across: &usize| match &self.laid.turned {
            Some(turned) => {
                let (x, y) = self.turned(along, across);
                turned.place(x, y).is_some_and(|at| self.laid.has(at.x as isize, at.y as isize))
            }
            None => self.is_on_plane(along, across),
        };
        let first = (0..breadth).find(has).unwrap_or(breadth);
        let last = (first..breadth).rfind(has);
        (first as f64, last.map_or(-1.0, |last| last as f64))
    }

    /// Whether there is paper on the plane, as it lies there.
    pub(super) fn is_on_plane(self, along: usize, across: usize) -> bool {
        let (x, y) = self.turned(along, across);
        self.laid.has(x as isize, y as isize)
    }

    /// Column and row, of what is along and across; and the other way round.
    const fn turned<T: Copy>(self, along: T, across: T) -> (T, T) {
        if self.is_upright { (across, along) } else { (along, across) }
    }

    /// Where a place along and across is on the plane, along and across the rules that are level there, or upright.
    pub(super) fn on_plane(self, along: f64, across: f64) -> (f64, f64) {
        let Some(turned) = &self.laid.turned else { return (along, across) };
        let (x, y) = self.turned(along, across);
        let at = turned.on_plane.at(x + 0.5, y + 0.5).unwrap_or(Point::new(FAR, FAR));
        self.turned(at.x - 0.5, at.y - 0.5)
    }
}

/// Where what the camera cannot see is, px.
pub(super) const FAR: f64 = -1e6;

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of 240 × 180 px that is seen at a slant.
    const CORNERS: [Point; 4] =
        [Point::new(60.0, 40.0), Point::new(280.0, 20.0), Point::new(300.0, 190.0), Point::new(40.0, 210.0)];

    #[test]
    fn lines_across_a_sheet_that_lies_aslant_are_level_where_it_is_laid_square() {
        let lie = Lie { beside: None, corners: Some(CORNERS) };
        let laid = Laid::of(lie, (320, 240));
        let ends = [0.0, 230.0].map(|along| Paper::level(&laid).on_plane(along, 90.0));
        let [from, to] = ends.map(|(x, y)| Point::new(x + 0.5, y + 0.5));
        let off = |x: usize, y: usize| {
            let at = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            (at - from).cross(to - from).abs() / from.distance(to)
        };
        let mut plane = Plane::filled(320, 240, 0_u8);
        (0..240)
            .for_each(|y| (0..320).for_each(|x| plane.row_mut(y)[x] = if off(x, y) < 1.5 { 200 } else { 0 }));
        let seen = laid.seen(&plane);
        let darkest = |x: usize| (0..seen.height).max_by_key(|&y| seen.row(y)[x]).unwrap_or(0);
        let rows: Vec<usize> = (20..seen.width - 20).step_by(20).map(darkest).collect();
        assert!(rows.iter().all(|row| row.abs_diff(90) <= 1), "{rows:?}");
        let back = Paper::level(&laid).on_plane(-0.5, -0.5);
        assert!((back.0 + 0.5 - 60.0).abs() < 1e-6 && (back.1 + 0.5 - 40.0).abs() < 1e-6, "{back:?}");
    }

    #[test]
    fn a_sheet_that_lies_square_or_on_its_side_is_seen_as_it_is() {
        let plane = Plane::filled(320, 240, 7_u8);
        let [a, b, c, d] = CORNERS;
        let square = [(10.0, 10.0), (300.0, 10.5), (300.0, 200.0), (10.0, 200.0)].map(Point::from);
        for corners in [None, Some(square), Some([b, c, d, a]), Some([c, d, a, b])] {
            let laid = Laid::of(Lie { beside: None, corners }, (320, 240));
            assert!(matches!(laid.seen(&plane), Cow::Borrowed(_)), "{corners:?}");
            assert_eq!(Paper::upright(&laid).on_plane(12.0, 34.0), (12.0, 34.0));
        }
    }
}
