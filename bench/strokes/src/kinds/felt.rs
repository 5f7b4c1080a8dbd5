use std::f64::consts::{PI, TAU};

use tracelight_maths::planar;
use tracelight_stroke::{Path, Point, Stroke, StrokeKind, Vec2};

use super::plain::{blob, closed_path};
use crate::shapes::{line, polar, polyline, spline};
use crate::{Figure, Hand, Ink, Random};

/// A filled area is at least so many pens across.
const LEAST_PENS: f64 = 3.5;
/// Ways to and fro lie so many pens apart: more than one leaves slits.
const PITCH_PENS: (f64, f64) = (0.75, 1.25);

/// Thick lines across each other, areas filled to and fro, and lines that leave them.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    match random.whole(0, 9) {
        0..=4 => super::lines(random, hand),
        5 => area(random, hand, closed_path),
        6 => area(random, hand, blob),
        7 => limbs(random, hand),
        8 => flag(random, hand),
        _ => crown(random, hand),
    }
}

fn area(random: &mut Random, hand: &Hand, shape: impl Fn(&mut Random, f64) -> Path) -> Figure {
    // the least circle and the inside of the thinnest star are a third of this
    let size = (0.6 * hand.size).max(1.7 * LEAST_PENS * hand.pen);
    let outline = shape(random, size);
    scribbled(random, hand, outline)
}

/// A closed path filled with a felt pen.
fn scribbled(random: &mut Random, hand: &Hand, outline: Path) -> Figure {
    let (way, pitch) =
        (planar::direction(random.angle()), hand.pen * random.between(PITCH_PENS.0, PITCH_PENS.1));
    let aside = Vec2::new(-way.y, way.x);
    let points = outline.flatten(0.1);
    let reach = points.iter().map(|p| p.to_vec2().hypot()).fold(0.0, f64::max) + hand.pen;
    let mut corners = Vec::new();
    let rows = (2.0 * reach / pitch) as usize + 1;
    for i in 0..=rows {
        let side = if i.is_multiple_of(2) { reach } else { -reach };
        let v = -reach + pitch * (i as f64 + random.between(-0.15, 0.15));
        corners.push((aside * v - way * side).to_point());
        corners.push((aside * v + way * side).to_point());
    }
    // each way is a line of its own, so that overlaps are darker
    let ways = corners.windows(2).map(|w| line(w[0], w[1])).collect();
    let stroke = Stroke { kind: StrokeKind::Outline, ..Stroke::new(outline.clone()) };
    Figure { strokes: vec![stroke], ink: vec![Ink::Scribble { outline, ways, pen: hand.pen }] }
}

/// A round body with lines that leave it.
fn limbs(random: &mut Random, hand: &Hand) -> Figure {
    let radius = (0.35 * hand.size).max(LEAST_PENS * hand.pen);
    let body = crate::shapes::circle(Point::ORIGIN, radius);
    let (limbs, from) = (random.whole(1, 5), random.angle());
    let length = (hand.size - radius).max(9.0 * hand.pen).max(13.0);
    let limb = |i: usize| {
        let way = from + TAU * i as f64 / limbs as f64;
        let at = |share: f64, bend: f64| polar(Point::ORIGIN, way + bend, radius + length * share);
        spline(&[at(0.0, 0.0), at(0.5, 0.04), at(1.0, 0.12)], false)
    };
    let lines = Figure::lines(hand, (0..limbs).map(limb));
    scribbled(random, hand, body).and(lines)
}

/// A filled rectangle at the end of a pole.
fn flag(random: &mut Random, hand: &Hand) -> Figure {
    let high = (0.3 * hand.size).max(LEAST_PENS * hand.pen);
    let wide = high * random.between(1.2, 2.0);
    let cloth = [(0.0, -high), (2.0 * wide, -high), (2.0 * wide, high), (0.0, high)].map(Point::from);
    let pole = line(Point::new(0.0, high), Point::new(0.0, high + hand.size.max(9.0 * hand.pen).max(13.0)));
    scribbled(random, hand, polyline(&cloth, true)).and(Figure::lines(hand, [pole]))
}

/// Hair above a face: the face's line begins and ends at the hair's corners.
fn crown(random: &mut Random, hand: &Hand) -> Figure {
    let radius = hand.size.max(9.0 * hand.pen);
    let brow = random.between(0.5, 0.9);
    let tips = random.whole(3, 6);
    let edge = |angle: f64, reach: f64| polar(Point::ORIGIN, angle, radius * reach);
    let (from, sweep) = (-0.5 * PI - brow, 2.0 * brow);
    let mut outline = vec![edge(from, 1.0)];
    for i in 0..tips {
        let at = |share: f64| from + sweep * (i as f64 + share) / tips as f64;
        outline.push(edge(at(0.5), random.between(1.35, 1.6)));
        outline.push(edge(at(1.0), if i + 1 == tips { 1.0 } else { 1.15 }));
    }
    // the brow is lower than the ring, so that the hair is no line
    outline.push(edge(-0.5 * PI, 0.45));
    let face = crate::shapes::arc(Point::ORIGIN, radius, from + sweep, TAU - sweep);
    scribbled(random, hand, polyline(&outline, true)).and(Figure::lines(hand, [face]))
}
