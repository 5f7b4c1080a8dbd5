use std::f64::consts::{PI, TAU};

use tracelight_maths::planar;
use tracelight_stroke::Point;

use super::plain::blob;
use crate::shapes::{circle, polar, polyline, spline, star};
use crate::{Figure, Hand, Random};

/// Nothing of a silhouette is thinner than this, px and pens.
const LEAST_PX: f64 = 4.0;
const LEAST_PENS: f64 = 1.5;
/// A limb begins at this share of its body's radius wide, and is so many times as long as that.
const LIMB: (f64, f64) = (0.3, 0.6);
const LONG: (f64, f64) = (1.5, 4.0);
/// It tapers to this share of its width, or opens again into a hand or a hoof.
const TAPER: (f64, f64) = (0.35, 0.7);
const HAND: (f64, f64) = (1.4, 1.9);

/// What is cut out of black paper: animals, bottles, keys, leaves. Its outline is meant, also round what is narrow.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let least = LEAST_PX.max(LEAST_PENS * hand.pen);
    match random.whole(0, 5) {
        0..=2 => creature(random, hand.size, least),
        3 => vessel(random, hand.size, least),
        4 => leaf(random, hand.size),
        _ => Figure::filled(vec![blob(random, hand.size)]),
    }
}

/// A round body with limbs that taper, bend, and end in hands; no two are alike.
fn creature(random: &mut Random, size: f64, least: f64) -> Figure {
    let radius = (size * random.between(0.3, 0.45)).max(3.5 * least);
    let limbs = random.whole(2, 6);
    let first = random.angle();
    let mut points = Vec::new();
    for i in 0..limbs {
        let room = TAU / limbs as f64;
        let way = first + room * (i as f64 + random.between(-0.1, 0.1));
        let width = (radius * random.between(LIMB.0, LIMB.1)).clamp(1.5 * least, 0.8 * radius * room);
        limb(random, &mut points, (way, radius), width, least);
        // the body between two limbs
        points.push(polar(Point::ORIGIN, way + 0.5 * room, radius * random.between(0.9, 1.1)));
    }
    Figure::filled(vec![spline(&points, true)])
}

/// Goes out along one side of a limb and back along the other.
fn limb(random: &mut Random, points: &mut Vec<Point>, (way, radius): (f64, f64), width: f64, least: f64) {
    const STEPS: usize = 5;
    let length = width * random.between(LONG.0, LONG.1);
    let bend = random.between(-0.6, 0.6);
    let tip = (width * random.between(TAPER.0, TAPER.1)).max(least);
    let hand = if random.chance(0.4) { random.between(HAND.0, HAND.1) } else { 1.0 };
    // its middle, from the body's edge on, and half of its width there
    let middle = |share: f64| {
        let heading = way + bend * share;
        polar(polar(Point::ORIGIN, way, 0.9 * radius), heading, length * share)
    };
    let half = |k: usize| match k {
        STEPS => 0.5 * tip * hand,
        _ => 0.5 * (width + (tip - width) * k as f64 / (STEPS - 1) as f64),
    };
    let side = |k: usize, sign: f64| {
        let share = k as f64 / STEPS as f64;
        let heading = way + 2.0 * bend * share;
        middle(share) + planar::direction(heading + sign * PI / 2.0) * half(k)
    };
    points.extend((0..=STEPS).map(|k| side(k, -1.0)));
    points.push(polar(middle(1.0), way + 2.0 * bend, half(STEPS)));
    points.extend((0..=STEPS).rev().map(|k| side(k, 1.0)));
}

/// A bottle, a key, a spoon: as wide on the left as on the right, a body and a neck; a key has a hole.
fn vessel(random: &mut Random, size: f64, least: f64) -> Figure {
    let neck = (size * random.between(0.1, 0.2)).max(0.5 * least);
    let body = (neck * random.between(2.0, 3.5)).min(0.6 * size).max(1.8 * neck);
    let shoulder = random.between(-0.2, 0.3) * size;
    let profile = [
        (-size, 0.8 * neck),
        (-0.6 * size, neck),
        (shoulder - 0.3 * size, 1.1 * neck),
        (shoulder, 0.9 * body),
        (0.5 * (shoulder + size), body),
        (0.95 * size, 0.8 * body),
    ];
    let right = profile.iter().map(|&(y, half)| Point::new(half, y));
    let left = profile.iter().rev().map(|&(y, half)| Point::new(-half, y));
    let points: Vec<Point> = right.chain(left).collect();
    let outline = if random.chance(0.5) { spline(&points, true) } else { polyline(&points, true) };
    let at = Point::new(0.0, 0.5 * (shoulder + 0.95 * size));
    let hole = circle(at, 0.3 * body);
    let is_key = random.chance(0.3) && 0.3 * body > least;
    Figure::filled(if is_key { vec![outline, hole] } else { vec![outline] })
}

/// A star of many narrow tips, pointed or round.
fn leaf(random: &mut Random, size: f64) -> Figure {
    let tips = random.whole(4, 8);
    let points = star(tips, size, Some(size * random.between(0.4, 0.6)), random.angle());
    Figure::filled(vec![if random.chance(0.5) { spline(&points, true) } else { polyline(&points, true) }])
}
