use std::f64::consts::{PI, TAU};

use tracelight_stroke::{Path, Point, Vec2};

use super::places::Places;
use super::plain;
use crate::shapes::{circle, ellipse};
use crate::{Figure, Hand, Ink, Random};

/// The page's pen is what both lines are across together: each has this share.
const OWN_PEN: f64 = 0.5;
/// Most from middle to middle, in the line's own pens.
const MOST_APART_PENS: f64 = 1.2;
/// Points along a line.
const STEPS: usize = 400;

/// One line gone over again, or a ring whose ends overlap.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [plain::straight, plain::bent, plain::free, ring];
    let whole = random.pick(&variants)(random, hand).strokes.remove(0).path;
    let pen = OWN_PEN * hand.pen;
    let apart = pen * random.between(0.5, MOST_APART_PENS);
    if whole.is_closed() && random.chance(0.6) {
        return overlapping(random, (&whole, pen), apart);
    }
    let places = Places::along(&whole, STEPS);
    // both all along, the second on a part, or the first up to a place and the second from before it
    let (from, to) = match random.whole(0, 2) {
        0 => (0.0, 1.0),
        1 => (random.between(0.0, 0.3), random.between(0.6, 1.0)),
        _ => (random.between(0.2, 0.5), random.between(0.6, 0.8)),
    };
    let both = (from, to);
    let (turns, phase) = (random.between(0.5, 2.5), random.angle());
    let apart = |share: f64| {
        // a hand that goes over a line meets it again and again
        let window = if both == (0.0, 1.0) { 1.0 } else { bump((share - from) / (to - from)) };
        apart * window * (TAU * turns * share + phase).sin()
    };
    let ends = if random.chance(0.5) { [(0.0, 1.0), both] } else { [(0.0, both.1), (both.0, 1.0)] };
    let lines = [1.0, -1.0].into_iter().zip(ends).map(|(side, (from, to))| {
        let closed = whole.is_closed() && to - from > 0.999;
        let path = places.moved((from, to), closed, |s, normal| normal * (0.5 * side * apart(s)));
        Ink::Line { path, pen, nib: hand.nib }
    });
    Figure::stroke(whole.clone(), pen, lines.collect::<Vec<_>>())
}

fn ring(random: &mut Random, hand: &Hand) -> Figure {
    let path = match random.whole(0, 2) {
        0 => circle(Point::ORIGIN, hand.size * random.between(0.5, 1.0)),
        1 => ellipse(hand.size, hand.size * random.between(0.6, 0.9)),
        _ => plain::blob(random, hand.size),
    };
    Figure::lines(hand, [path])
}

/// A closed line that goes on beyond its start for 10 to 60°, leaves itself there and comes back.
fn overlapping(random: &mut Random, (whole, pen): (&Path, f64), apart: f64) -> Figure {
    let places = Places::along(whole, STEPS);
    let beyond = random.between(10.0, 60.0) / 360.0;
    let aside = |share: f64| 0.5 * apart * bump(share / beyond);
    let first =
        places.moved((0.0, 1.0), false, |s, normal| if s < beyond { normal * -aside(s) } else { Vec2::ZERO });
    let again = places.moved((0.0, beyond), false, |s, normal| normal * aside(s));
    let line = |path| Ink::Line { path, pen, nib: crate::Nib::Round };
    Figure::stroke(whole.clone(), pen, [line(first), line(again)])
}

/// From none to 1 and back to none, smoothly; none outside [0, 1].
fn bump(share: f64) -> f64 {
    (PI * share.clamp(0.0, 1.0)).sin().powi(2)
}
