use std::f64::consts::TAU;

use tracelight_stroke::{Path, Point};

use crate::shapes::{arc, circle, ellipse, line_through, polar, polyline, spline, star};
use crate::{Figure, Hand, Nib, Random};

pub(super) fn straight(random: &mut Random, hand: &Hand) -> Figure {
    let length = hand.size * random.between(0.4, 1.2);
    Figure::lines(hand, [line_through(Point::ORIGIN, random.angle(), length, length)])
}

pub(super) fn cornered(random: &mut Random, hand: &Hand) -> Figure {
    let corners = random.whole(1, 5);
    let zigzag = random.chance(0.4);
    let mut heading = random.angle();
    let mut turn_to = random.sign();
    let mut points = vec![Point::ORIGIN];
    for _ in 0..=corners {
        let length = 2.0 * hand.size / (corners as f64).sqrt() * random.between(0.5, 1.0);
        points.push(polar(points[points.len() - 1], heading, length));
        turn_to = if zigzag { -turn_to } else { random.sign() };
        heading += turn_to * random.between(32.0, 148.0).to_radians();
    }
    Figure::lines(hand, [polyline(&points, false)])
}

pub(super) fn bent(random: &mut Random, hand: &Hand) -> Figure {
    let sweep = random.between(40.0, 310.0).to_radians() * random.sign();
    // flat ones may be long: the chord of a small sweep is short for its radius
    let radius = hand.size * random.between(0.5, 1.0) * (2.0 / sweep.abs()).max(1.0);
    let from = random.angle();
    let centre = polar(Point::ORIGIN, from + 0.5 * sweep, -radius);
    Figure::lines(hand, [arc(centre, radius, from, sweep)])
}

pub(super) fn free(random: &mut Random, hand: &Hand) -> Figure {
    Figure::lines(hand, [spline(&wander(random, hand), false)])
}

/// Points of a walk that turns up to 70° at a time.
fn wander(random: &mut Random, hand: &Hand) -> Vec<Point> {
    let steps = random.whole(3, 7);
    let mut heading = random.angle();
    let mut points = vec![Point::ORIGIN];
    for _ in 0..steps {
        let length = 2.2 * hand.size / (steps as f64).sqrt() * random.between(0.6, 1.0);
        points.push(polar(points[points.len() - 1], heading, length));
        heading += random.between(-70.0, 70.0).to_radians();
    }
    points
}

pub(super) fn closed(random: &mut Random, hand: &Hand) -> Figure {
    Figure::lines(hand, [closed_path(random, hand.size)])
}

/// A closed curve or polygon about the origin.
pub(super) fn closed_path(random: &mut Random, size: f64) -> Path {
    match random.whole(0, 5) {
        0 => circle(Point::ORIGIN, size * random.between(0.3, 1.0)),
        1 => ellipse(size, size * random.between(0.3, 0.9)),
        2 => polyline(&star(random.whole(3, 8), size * random.between(0.5, 1.0), None, random.angle()), true),
        3 => {
            let inner = Some(size * random.between(0.4, 0.62));
            polyline(&star(random.whole(4, 7), size, inner, random.angle()), true)
        }
        4 => polyline(&around(random, size, 3, 7), true),
        _ => blob(random, size),
    }
}

/// A smooth closed curve about the origin.
pub(super) fn blob(random: &mut Random, size: f64) -> Path {
    spline(&around(random, size, 6, 10), true)
}

/// Points around the origin, at uneven distances.
fn around(random: &mut Random, size: f64, fewest: usize, most: usize) -> Vec<Point> {
    let (corners, from) = (random.whole(fewest, most), random.angle());
    let at = |i: usize| {
        let angle = from + TAU * (i as f64 + random.between(-0.2, 0.2)) / corners as f64;
        polar(Point::ORIGIN, angle, size * random.between(0.6, 1.0))
    };
    (0..corners).map(at).collect()
}

/// A line, an arc or a circle with one to three gaps of paper, a pixel to a pen wide.
pub(super) fn gapped(random: &mut Random, hand: &Hand) -> Figure {
    let size = hand.size * random.between(0.6, 1.1);
    // a bow is an arc of large radius, a circle one of the whole turn
    match random.whole(0, 2) {
        0 => {
            let (angle, length) = (random.angle(), 2.0 * size);
            let part = |from: f64, to: f64| {
                line_through(Point::ORIGIN, angle, size - from * length, to * length - size)
            };
            with_gaps(random, hand, length, part, false)
        }
        1 => {
            let (sweep, from) = (random.between(1.0, 4.0), random.angle());
            let part = |a: f64, b: f64| arc(Point::ORIGIN, size, from + a * sweep, (b - a) * sweep);
            with_gaps(random, hand, size * sweep, part, false)
        }
        _ => {
            let part = |a: f64, b: f64| arc(Point::ORIGIN, size, a * TAU, (b - a) * TAU);
            with_gaps(random, hand, size * TAU, part, true)
        }
    }
}

/// Length from gap to gap, in pens, about.
const PIECE_PENS: f64 = 10.0;

/// `part(a, b)` is the path from share `a` to share `b` of its length.
fn with_gaps(
    random: &mut Random,
    hand: &Hand,
    length: f64,
    part: impl Fn(f64, f64) -> Path,
    closed: bool,
) -> Figure {
    // what is left between gaps is long enough to be a line
    let most = (length / (PIECE_PENS * hand.pen)) as usize;
    let gaps = random.whole(1, 3).min(most.saturating_sub(1)).max(1);
    let mut pieces = Vec::new();
    let mut from = 0.0;
    for gap in 1..=gaps {
        let paper = random.between(1.0, hand.pen);
        let caps = if hand.nib == Nib::Round { hand.pen } else { 0.0 };
        let half = 0.5 * (paper + caps) / length;
        let at = (gap as f64 + random.between(-0.15, 0.15)) / (gaps as f64 + 1.0);
        pieces.push(part(from, at - half));
        from = at + half;
    }
    if closed {
        // the ends meet: what begins after the last gap goes on to the first one
        let first = pieces.remove(0);
        let to = 1.0 + share_of(&first, length);
        pieces.push(part(from, to));
    } else {
        pieces.push(part(from, 1.0));
    }
    let mut whole = part(0.0, 1.0);
    if closed {
        whole.close();
    }
    Figure::broken(hand, whole, pieces)
}

fn share_of(path: &Path, length: f64) -> f64 {
    path.length(1e-6) / length
}
