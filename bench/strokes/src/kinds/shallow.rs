use std::f64::consts::PI;

use tracelight_maths::planar;
use tracelight_stroke::{Path, Point};

use crate::shapes::{Turtle, arc, circle, line, line_through, polar};
use crate::{Figure, Hand, Random};

const FLATTEST_DEG: f64 = 3.0;
const STEEPEST_DEG: f64 = 15.0;

/// Lines that cross or touch at so small an angle that they run together for a while.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [cross, cross, bow_across, kiss, ring_on_line, touching, eight];
    let paths = random.pick(&variants)(random, hand);
    Figure::lines(hand, paths)
}

/// An angle at which lines are clear of each other after this length; none if that is too short.
fn angle(random: &mut Random, hand: &Hand, length: f64) -> Option<f64> {
    let least = (1.3 * (hand.pen + hand.paper) / length).asin().max(FLATTEST_DEG.to_radians());
    (least < STEEPEST_DEG.to_radians()).then(|| random.between(least, STEEPEST_DEG.to_radians()))
}

fn cross(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let reach = hand.size * random.between(1.0, 1.6);
    let Some(open) = angle(random, hand, reach) else { return vec![] };
    let mut arm = |turn: f64| {
        line_through(Point::ORIGIN, turn, reach * random.between(1.0, 1.2), reach * random.between(1.0, 1.2))
    };
    vec![arm(0.0), arm(open)]
}

/// A flat bow across a line, twice.
fn bow_across(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let clear = 1.3 * (hand.pen + hand.paper);
    let half = hand.size * random.between(0.7, 1.0);
    let least = 2.0 * (clear / half).atan();
    if least > STEEPEST_DEG.to_radians() {
        return vec![];
    }
    let open = random.between(least, STEEPEST_DEG.to_radians());
    let radius = half / open.sin();
    // beyond the crossing the bow leaves the line faster and faster
    let beyond = open + (2.0 * clear / radius).sqrt().min(0.6);
    let centre = Point::new(0.0, radius * open.cos());
    let bar = line_through(Point::ORIGIN, 0.0, 1.5 * half, 1.5 * half);
    vec![bar, arc(centre, radius, -0.5 * PI - beyond, 2.0 * beyond)]
}

/// Two bows, back to back, that touch.
fn kiss(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let radius = hand.size * random.between(1.2, 2.5);
    let apart = hand.pen * random.between(0.0, 0.5);
    let mut bow = |side: f64| {
        let sweep = random.between(0.9, 1.3) * 2.0 * (hand.size / radius).min(1.4);
        let centre = Point::new(0.0, side * (radius + 0.5 * apart));
        arc(centre, radius, -side * 0.5 * PI - 0.5 * sweep, sweep)
    };
    vec![bow(1.0), bow(-1.0)]
}

/// A ring that lies on a line.
fn ring_on_line(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let radius = hand.size * random.between(0.4, 0.8);
    let apart = hand.pen * random.between(0.0, 0.5);
    let bar = line(Point::new(-hand.size, 0.0), Point::new(hand.size * random.between(0.8, 1.2), 0.0));
    vec![bar, circle(Point::new(0.0, -radius - apart), radius)]
}

/// Two rings that touch.
fn touching(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let radii = [random.between(0.3, 0.6), random.between(0.3, 0.6)].map(|r| r * hand.size);
    let apart = hand.pen * random.between(0.0, 0.5);
    let other = polar(Point::ORIGIN, random.angle(), radii[0] + radii[1] + apart);
    vec![circle(Point::ORIGIN, radii[0]), circle(other, radii[1])]
}

/// A closed eight of two straight lines that cross at a small angle, and two turns.
fn eight(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let Some(open) = angle(random, hand, hand.size) else { return vec![] };
    let half = hand.size * random.between(1.0, 1.2);
    let radius = half * (0.5 * open).tan();
    if radius < (2.0 * hand.pen).max(0.5 * (hand.pen + hand.paper)) {
        return vec![];
    }
    let start = Point::ORIGIN - planar::direction(0.5 * open) * half;
    let turtle = Turtle::new(start, 0.5 * open);
    let turtle = turtle.ahead(2.0 * half).turn(radius, -PI - open).ahead(2.0 * half);
    vec![turtle.turn(radius, PI + open).closed()]
}
