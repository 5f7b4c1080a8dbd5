use std::f64::consts::PI;

use tracelight_maths::planar;
use tracelight_stroke::{Path, Point, Vec2};

use crate::shapes::{arc, line, polar, spline};
use crate::touch::{Touch, profile, touches};
use crate::{Figure, Hand, Ink, Random};

/// Wisps that share ink for longer, in pens, are nobody's to tell apart.
const LONGEST_SHARED_PENS: f64 = 12.0;
/// No hair is thinner, px.
const LEAST_PX: f64 = 0.9;

/// Tapering lines close beside each other.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    match random.whole(0, 3) {
        0 => tuft(random, hand, None),
        1 => {
            let scalp = random.between(1.0, 2.5);
            tuft(random, hand, Some(scalp))
        }
        2 => wisps(random, hand),
        _ => lock(random, hand),
    }
}

/// Strands from one place in much the same direction, across each other; no end lies near another strand.
fn wisps(random: &mut Random, hand: &Hand) -> Figure {
    let clear = 1.5 * (hand.pen + hand.paper);
    let mut paths: Vec<Path> = Vec::new();
    for _ in 0..random.whole(4, 10) {
        let root = Point::new(-hand.size, hand.size * random.between(-0.3, 0.3));
        let way = random.between(-0.25, 0.25);
        let path = strand(root, way, (hand.size * random.between(1.2, 2.0), random.between(-0.5, 0.5)));
        let is_clear = |one: &Path, other: &Path| {
            let points = other.flatten(0.05);
            let ends = [one.start(), one.end()].iter().all(|&end| beside(&points, end) > clear);
            let shared = touches(one, |along| dot(along.at, 0.5 * hand.pen));
            let near = shared.iter().filter(|t| beside(&points, t.at) < hand.pen).count();
            let step = one.length(1e-3) / shared.len() as f64;
            ends && near as f64 * step < LONGEST_SHARED_PENS * hand.pen
        };
        if paths.iter().all(|other| is_clear(&path, other) && is_clear(other, &path)) {
            paths.push(path);
        }
    }
    paths.into_iter().fold(Figure::default(), |figure, path| figure.and(tapered(hand, path, true)))
}

/// Distance of a point from a line.
fn beside(points: &[Point], at: Point) -> f64 {
    let off = |pair: &[Point]| {
        let way = pair[1] - pair[0];
        let share = ((at - pair[0]).dot(way) / way.hypot2().max(1e-12)).clamp(0.0, 1.0);
        at.distance(pair[0] + way * share)
    };
    points.windows(2).map(off).fold(f64::INFINITY, f64::min)
}

/// Strands from a row of roots, which may lie on a line of their own (an arc of so many rad), fanned out.
fn tuft(random: &mut Random, hand: &Hand, scalp: Option<f64>) -> Figure {
    let pitch = (hand.pen + hand.paper) * random.between(1.1, 1.8);
    let sweep = scalp.unwrap_or(random.between(0.3, 1.0));
    let radius = 0.6 * hand.size;
    let count = ((radius * sweep / pitch) as usize).clamp(2, 9);
    let sweep = pitch * count as f64 / radius;
    let from = -0.5 * PI - 0.5 * sweep;
    let mut figure = Figure::default();
    if scalp.is_some() {
        let rim = 3.0 * pitch / radius;
        figure = Figure::lines(hand, [arc(Point::ORIGIN, radius, from - rim, sweep + 2.0 * rim)]);
    }
    let curl = random.between(-0.5, 0.5);
    for i in 0..count {
        let at = from + sweep * (i as f64 + 0.5) / count as f64;
        let root = polar(Point::ORIGIN, at, radius);
        let path = strand(root, at, (hand.size * random.between(0.7, 1.1), curl));
        figure = figure.and(tapered(hand, path, scalp.is_none() && random.chance(0.5)));
    }
    figure
}

/// A curve out of a root, bent by an angle in all.
fn strand(root: Point, way: f64, (length, curl): (f64, f64)) -> Path {
    let at = |share: f64| planar::direction(way + curl * share) * (length * share);
    spline(&[0.0, 0.25, 0.5, 0.75, 1.0].map(|s| root + at(s)), false)
}

/// A strand that others leave at 10 to 25°.
fn lock(random: &mut Random, hand: &Hand) -> Figure {
    let length = 2.0 * hand.size;
    let stem = line(Point::new(-hand.size, 0.0), Point::new(hand.size, 0.0));
    let mut figure = tapered(hand, stem, false);
    let clear = 1.5 * (hand.pen + hand.paper);
    let most = ((length / (8.0 * clear)) as usize).clamp(1, 4);
    let branches = random.whole(1, most);
    for i in 0..branches {
        let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let foot = Point::new(-hand.size + length * (i as f64 + 0.5) / (branches as f64 + 0.5), 0.0);
        let open = random.between(10.0, 25.0_f64).to_radians();
        let reach = (clear / open.sin() * random.between(1.1, 1.6)).max(8.0 * hand.pen);
        let path = strand(foot, side * open, (reach, side * random.between(0.0, 0.4)));
        figure = figure.and(tapered(hand, path, false));
    }
    figure
}

/// Thick at its root, or thin there too, and thin at its end.
fn tapered(hand: &Hand, path: Path, both: bool) -> Figure {
    let least = (0.3 * hand.pen).max(LEAST_PX).min(hand.pen);
    let shape = move |share: f64| if both { (PI * share).sin() } else { 1.0 - share * share };
    let width = profile(shape, (least, hand.pen), path.length(1e-3));
    let drawn = touches(&path, |along| dot(along.at, 0.5 * width(along.share)));
    Figure::stroke(path, 0.7 * hand.pen, [Ink::Touches(drawn)])
}

fn dot(at: Point, radius: f64) -> Touch {
    Touch { at, reach: Vec2::ZERO, radius, dark: 1.0 }
}
