//! Four sides of a sheet in the small picture, and what falls across it.

use tracelight_image::Plane;
use tracelight_image::border::area;
use tracelight_stroke::{Point, Vec2};

use crate::shade::Shade;
use crate::sides::Side;
use crate::small::BESIDE;

/// Least of a side that is seen; a finger, a shadow or another sheet hides the rest.
pub(crate) const LEAST_SEEN: f64 = 0.5;
/// A shorter part of a side in a shadow is not looked at, px.
const LEAST_IN_SHADE: usize = 5;

/// A sheet in the small picture.
#[derive(Clone, Debug)]
pub(crate) struct Quad {
    /// Left, top, right, bottom; `None` where it runs out of the picture.
    pub(crate) sides: [Option<Side>; 4],
    /// Upper left, upper right, lower right, lower left, px.
    pub(crate) corners: [Point; 4],
    /// Whether it is brighter than what lies beside it.
    pub(crate) is_brighter: bool,
    /// What falls across it.
    pub(crate) shade: Option<Shade>,
}

/// Of left, top, right and bottom: its number.
pub(crate) const SIDES: [usize; 4] = [0, 1, 2, 3];

/// Whether a side is the left or the right one.
pub(crate) const fn is_upright(side: usize) -> bool {
    matches!(side, 0 | 2)
}

impl Quad {
    /// All of a picture.
    pub(crate) fn all(plane: &Plane<u8>) -> Self {
        Self { sides: Default::default(), corners: corners(plane, [None; 4]), is_brighter: true, shade: None }
    }

    /// Between corners that someone gives; `None` where they are no quadrilateral.
    pub(crate) fn between(corners: [Point; 4]) -> Option<Self> {
        let turns = |k: usize| {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| corners[k % 4]);
            (b - a).cross(c - b) > 0.0
        };
        let quad = Self { sides: Default::default(), corners, is_brighter: true, shade: None };
        (0..4).all(turns).then_some(quad)
    }

    /// The ends of a side, clockwise.
    pub(crate) const fn ends(&self, side: usize) -> (Point, Point) {
        ends(&self.corners, side)
    }

    /// The way into the sheet, square to a side.
    pub(crate) fn inward(&self, side: usize) -> Vec2 {
        let (from, to) = self.ends(side);
        inward(from, to)
    }

    /// How far inside a point lies, px; negative outside.
    pub(crate) fn depths(&self) -> impl Fn(Point) -> f64 + use<> {
        let sides = SIDES.map(|side| (self.ends(side).0, self.inward(side)));
        move |at| sides.iter().map(|(from, inward)| (at - *from).dot(*inward)).fold(f64::INFINITY, f64::min)
    }

    /// In the small picture, px².
    pub(crate) fn area(&self) -> f64 {
        area(&self.corners)
    }

    pub(crate) fn seen(&self) -> usize {
        self.sides.iter().flatten().count()
    }

    /// Whether its sides are seen both in a shadow and beside it.
    pub(crate) fn goes_on_in(&self, shade: &Shade, plane: &Plane<u8>) -> bool {
        let (width, height) = (plane.width as f64 - BESIDE, plane.height as f64 - BESIDE);
        let may_be_seen = |p: Point| (BESIDE..width).contains(&p.x) && (BESIDE..height).contains(&p.y);
        SIDES.into_iter().filter_map(|k| Some((k, self.sides[k].as_ref()?))).all(|(k, side)| {
            let (from, to) = self.ends(k);
            let row = |p: Point| if is_upright(k) { p.y } else { p.x }.max(0.0) as usize;
            let (first, last) = (row(from).min(row(to)), row(from).max(row(to)));
            // in the light, and in the shadow
            let (mut all, mut seen) = ([0, 0], [0, 0]);
            for row in first..last {
                let at = side.place(is_upright(k), row as f64 + 0.5);
                if may_be_seen(at) {
                    let dark = usize::from(shade.is_dark(at));
                    all[dark] += 1;
                    seen[dark] += side.seen(row..row + 1) + side.lines(row..row + 1);
                }
            }
            let is_seen = |(all, seen)| all < LEAST_IN_SHADE || seen as f64 > LEAST_SEEN * all as f64;
            all.into_iter().zip(seen).all(is_seen)
        })
    }

    /// What a level would be without the shadow across it.
    pub(crate) fn lit(&self, at: Point, level: f64) -> f64 {
        self.shade.as_ref().map_or(level, |shade| shade.lit(at, level))
    }
}

/// The way into what lies on the right of the way from one place to another, square to that: clockwise round a sheet, into it.
pub(crate) fn inward(from: Point, to: Point) -> Vec2 {
    let way = (to - from) / from.distance(to).max(1e-9);
    Vec2::new(-way.y, way.x)
}

/// Where the picture ends on the left, at the top, on the right and at the bottom.
const fn borders(plane: &Plane<u8>) -> [f64; 4] {
    [0.0, 0.0, plane.width as f64, plane.height as f64]
}

/// Where sides and the picture's borders meet: upper left, upper right, lower right, lower left.
pub(crate) fn corners(plane: &Plane<u8>, sides: [Option<&Side>; 4]) -> [Point; 4] {
    let border = borders(plane);
    let line = |k: usize| sides[k].map_or((border[k], 0.0), |side| (side.at, side.slope));
    // x = a + b y meets y = c + d x
    let meet = |upright: usize, level: usize| {
        let ((a, b), (c, d)) = (line(upright), line(level));
        let x = (a + b * c) / (1.0 - b * d);
        Point::new(x, c + d * x)
    };
    [meet(0, 1), meet(2, 1), meet(2, 3), meet(0, 3)]
}

/// The ends of a side, clockwise.
pub(crate) const fn ends(corners: &[Point; 4], side: usize) -> (Point, Point) {
    let [upper_left, upper_right, lower_right, lower_left] = *corners;
    match side {
        0 => (lower_left, upper_left),
        1 => (upper_left, upper_right),
        2 => (upper_right, lower_right),
        _ => (lower_right, lower_left),
    }
}

/// How far the two ends of a side are from the picture's border on that side, px.
pub(crate) fn off_border(plane: &Plane<u8>, corners: &[Point; 4], side: usize) -> [f64; 2] {
    let (from, to) = ends(corners, side);
    let border = borders(plane)[side];
    [from, to].map(|p| (if is_upright(side) { p.x } else { p.y } - border).abs())
}
