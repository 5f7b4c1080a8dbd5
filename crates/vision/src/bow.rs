//! Approximates the end of a line by a circular arc, some way off the ink that it shares with another.
//!
//! Where two lines run into each other at a few degrees, or touch, each leans towards the ink of both for a while before
//! that. What it is further in tells where it goes.

use tracelight_maths::{asin, planar, sin};
use tracelight_stroke::{Parabola, Point, Vec2};

use crate::bridge::{angle, measured};

/// A line leans so far from its end, in its widths.
const LEANS: f64 = 1.0;
/// Its bow is taken over this length further in, widths and px, and at most this share of the line.
const LENGTH: f64 = 6.0;
const LEAST_PX: f64 = 12.0;
const SHARE: f64 = 0.35;
/// Fewer points tell no bow.
const LEAST_POINTS: usize = 6;
/// Points are off it by less than this share of the line's width, root mean square, and px.
const MOST_OFF: f64 = 0.12;
const MOST_OFF_PX: f64 = 0.12;
/// What is straighter is straight, 1/px.
const STRAIGHT: f64 = 1e-5;

/// The middle of such a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bow {
    at: Point,
    /// The direction towards the line's end, and how much it turns on that way, rad a px.
    along: Vec2,
    turn: f64,
}

impl Bow {
    /// Of the first (`end` 0) or last points of a line of some width; `None` of a line that is short or bends otherwise.
    pub(crate) fn of(points: &[Point], end: usize, width: f64) -> Option<Self> {
        let places: Vec<(f64, Point)> = measured(points, end).collect();
        let from = LEANS * width;
        let to = from + (LENGTH * width).max(LEAST_PX).min(SHARE * places.last()?.0);
        let window: Vec<(f64, Point)> = places.into_iter().filter(|(s, _)| (from..to).contains(s)).collect();
        let (first, last) = (window.first()?.0, window.last()?.0);
        let curve = Parabola::through(window.iter().copied()).filter(|_| window.len() >= LEAST_POINTS)?;
        let middle = 0.5 * (first + last);
        // towards the end all is the other way round
        let turn = angle(curve.tangent(first), curve.tangent(last)) / (last - first).max(1e-9);
        (curve.rms < (MOST_OFF * width).max(MOST_OFF_PX)).then(|| Self {
            at: curve.point(middle),
            along: -curve.tangent(middle),
            turn: -turn,
        })
    }

    /// Where it leads on a way of this length, and in which direction.
    fn beyond(&self, way: f64) -> (Point, Vec2) {
        let angle = self.turn * way;
        let rotated = |by: f64| self.along.rotate_scale(planar::direction(by));
        if self.turn.abs() < STRAIGHT {
            return (self.at + self.along * way, rotated(angle));
        }
        let chord = 2.0 / self.turn * sin(0.5 * angle);
        (self.at + rotated(0.5 * angle) * chord, rotated(angle))
    }

    /// By how much a line would have to leave its bow to get from here to another's end, and from that one to here: off it as a
    /// share of the way, and turned from it, rad.
    pub(crate) fn misfit(&self, other: &Self) -> f64 {
        0.5 * (self.off(other) + other.off(self))
    }

    fn off(&self, other: &Self) -> f64 {
        let chord = self.at.distance(other.at).max(1e-9);
        // along the bow it is further; beyond half a circle nothing is said
        let half = asin((0.5 * self.turn.abs() * chord).min(1.0));
        let way = if self.turn.abs() < STRAIGHT { chord } else { 2.0 * half / self.turn.abs() };
        let (place, along) = self.beyond(way);
        place.distance(other.at) / way + 0.5 * angle(along, -other.along).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a circle about the origin from one angle to another.
    fn arc(radius: f64, from: f64, to: f64) -> Vec<Point> {
        let at =
            |k: i32| Point::ORIGIN + planar::direction(from + (to - from) * f64::from(k) / 60.0) * radius;
        (0..=60).map(at).collect()
    }

    #[test]
    fn a_ring_fits_itself_and_no_ring_beside_it() {
        let ring = arc(40.0, 0.4, 5.9);
        let (begin, end) = (Bow::of(&ring, 0, 4.0).unwrap(), Bow::of(&ring, 1, 4.0).unwrap());
        assert!(begin.misfit(&end) < 0.05, "{}", begin.misfit(&end));
        let other: Vec<Point> = ring.iter().map(|p| Point::new(84.0 - p.x, p.y)).collect();
        let beside = Bow::of(&other, 1, 4.0).unwrap();
        assert!(begin.misfit(&beside) > 0.5, "{}", begin.misfit(&beside));
    }

    #[test]
    fn a_straight_line_fits_what_goes_on_straight() {
        let line = |x: f64, y: f64| -> Vec<Point> {
            (0..40).map(|k| Point::new(x + f64::from(k), y + 0.1 * f64::from(k))).collect()
        };
        let (a, b) = (line(0.0, 0.0), line(60.0, 6.0));
        let (a, b) = (Bow::of(&a, 1, 3.0).unwrap(), Bow::of(&b, 0, 3.0).unwrap());
        assert!(a.misfit(&b) < 1e-6);
    }
}
