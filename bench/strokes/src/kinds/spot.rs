use std::f64::consts::{PI, TAU};

use tracelight_maths::planar;
use tracelight_stroke::{Affine, Element, Path, Point};

use crate::shapes::{arc, circle, ellipse, line, polar, spline};
use crate::{Figure, Hand, Random};

/// A spot is at least so many pens across where it is widest.
const LEAST_PENS: f64 = 2.5;

/// Small filled shapes, alone, with rays, or as eyes and mouth of a face.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    match random.whole(0, 6) {
        0..=3 => Figure::filled(vec![spot(random, hand, 0.4 * hand.size)]),
        4..=5 => sun(random, hand),
        _ => face(random, hand),
    }
}

/// An oval, a crescent or a drop, half as long as this; at most 3.5 times as long as wide.
fn spot(random: &mut Random, hand: &Hand, half: f64) -> Path {
    let wide = random.between(0.3, 0.9);
    let half = half.max(0.5 * LEAST_PENS * hand.pen / wide);
    match random.whole(0, 2) {
        0 => ellipse(half, wide * half),
        1 => crescent(half, random.between(0.55, 0.9), random.between(0.1, 0.5)),
        _ => drop_shape(half, wide.max(0.45)),
    }
}

/// Two bows over one chord, as far apart in the middle as `thick` half chords.
fn crescent(half: f64, thick: f64, inner: f64) -> Path {
    // the angle of a bow at its tips, of its sagitta over the half chord
    let at_tip = |sagitta: f64| 2.0 * sagitta.atan();
    let (out, back) = (at_tip(inner + thick), at_tip(inner));
    let bow = |angle: f64| (half / angle.sin(), Point::new(0.0, half / angle.tan()));
    let (radius, centre) = bow(out);
    let mut path = arc(centre, radius, -0.5 * PI - out, 2.0 * out);
    path.push(Element::Arc { centre: bow(back).1, sweep: -2.0 * back });
    path.close();
    path
}

/// Round below, drawn out to a tip.
fn drop_shape(half: f64, wide: f64) -> Path {
    let at = |x: f64, y: f64| Point::new(x * wide * half, y * half);
    let side = [at(0.0, -1.0), at(0.45, -0.3), at(0.95, 0.35), at(0.62, 0.88), at(0.0, 1.0)];
    let other = side.iter().rev().skip(1).map(|p| Point::new(-p.x, p.y));
    let mut path = spline(&side.iter().copied().chain(other).collect::<Vec<_>>(), false);
    path.close();
    path
}

/// A disc with rays around it, paper between.
fn sun(random: &mut Random, hand: &Hand) -> Figure {
    let radius = (hand.size * random.between(0.2, 0.5)).max(2.5 * hand.pen);
    let inner = radius + hand.pen + hand.paper * random.between(1.0, 2.5);
    let most = (TAU * inner / (1.4 * (hand.pen + hand.paper))) as usize;
    let rays = random.whole(6, 14).min(most);
    let length = (hand.size - inner).max(8.0 * hand.pen).max(12.5);
    let ray = |i: usize| {
        let way = TAU * i as f64 / rays as f64;
        line(polar(Point::ORIGIN, way, inner), polar(Point::ORIGIN, way, inner + length))
    };
    Figure::filled(vec![circle(Point::ORIGIN, radius)]).and(Figure::lines(hand, (0..rays).map(ray)))
}

/// A ring with two eyes and a mouth, filled.
fn face(random: &mut Random, hand: &Hand) -> Figure {
    let size = hand.size.max(14.0 * hand.pen);
    let mut figure = Figure::lines(hand, [ellipse(size, size * random.between(0.85, 1.0))]);
    let shift = |x: f64, y: f64| Affine::translate((x * size, y * size));
    let eye = spot(random, hand, 0.12 * size);
    for side in [-1.0, 1.0] {
        figure = figure.and(Figure::filled(vec![eye.transformed(shift(0.38 * side, -0.25))]));
    }
    let mouth = crescent(0.28 * size, 0.55, random.between(0.1, 0.3)).transformed(planar::rotation(PI));
    figure.and(Figure::filled(vec![mouth.transformed(shift(0.0, 0.35))]))
}
