use std::f64::consts::PI;

use tracelight_maths::planar;
use tracelight_stroke::{Affine, Path, Point};

use super::plain::blob;
use crate::shapes::{circle, ellipse, line, polar, polyline, star};
use crate::{Figure, Hand, Random};

/// A filled shape is at least this many pens across where it is widest, so that nobody takes it for a line.
const LEAST_PENS: f64 = 5.0;

/// Filled shapes, with holes and with sticks.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    // half across: a shape as large as a page of writing is no drawing of lines
    let size = (0.7 * hand.size).max(0.5 * (LEAST_PENS + 1.0) * hand.pen);
    match random.whole(0, 5) {
        0 => Figure::filled(vec![disc(random, size)]),
        1 => Figure::filled(vec![polygon(random, size)]),
        2 => Figure::filled(vec![blob(random, size)]),
        3 => holed(random, hand, size),
        _ => lollipop(random, hand, size),
    }
}

fn disc(random: &mut Random, size: f64) -> Path {
    match random.chance(0.5) {
        true => circle(Point::ORIGIN, size * random.between(0.6, 1.0)),
        false => ellipse(size, size * random.between(0.5, 1.0)),
    }
}

fn polygon(random: &mut Random, size: f64) -> Path {
    let inner = random.chance(0.3).then(|| size * random.between(0.45, 0.6));
    polyline(&star(random.whole(3, 6), size, inner, random.angle()), true)
}

/// A shape with one or two round holes, each at most a third of the shape: a wall that thin would be a line.
fn holed(random: &mut Random, hand: &Hand, size: f64) -> Figure {
    let size = size.max(9.0 * hand.pen);
    let outline = match random.whole(0, 2) {
        0 => circle(Point::ORIGIN, size),
        1 => polyline(&star(random.whole(4, 6), size, None, random.angle()), true),
        _ => ellipse(size, 0.85 * size),
    };
    let hole = |at: Point, random: &mut Random| circle(at, size * random.between(0.14, 0.2));
    let holes = match random.chance(0.5) {
        true => vec![hole(polar(Point::ORIGIN, random.angle(), size * random.between(0.0, 0.2)), random)],
        false => [-1.0, 1.0].map(|side| hole(Point::new(side * 0.38 * size, 0.0), random)).into(),
    };
    Figure::filled([vec![outline], holes].concat())
}

/// A disc on a stick, now and then one at either end. The stick begins at the disc's edge.
fn lollipop(random: &mut Random, hand: &Hand, size: f64) -> Figure {
    let radius = (size * random.between(0.3, 0.6)).max(0.5 * LEAST_PENS * hand.pen);
    let length = (2.0 * size).max(8.0 * hand.pen);
    let way = random.angle();
    let (from, to) = (polar(Point::ORIGIN, way, radius), polar(Point::ORIGIN, way, radius + length));
    let figure =
        Figure::filled(vec![circle(Point::ORIGIN, radius)]).and(Figure::lines(hand, [line(from, to)]));
    if random.chance(0.75) {
        return figure;
    }
    let other = polar(to, way, radius).to_vec2();
    let far = circle(Point::ORIGIN, radius).transformed(Affine::translate(other) * planar::rotation(PI));
    figure.and(Figure::filled(vec![far]))
}
