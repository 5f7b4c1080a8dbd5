use std::f64::consts::PI;

use tracelight_stroke::{Path, Point};

use crate::shapes::Turtle;
use crate::{Figure, Hand, Random};

/// Lines and arcs end to end, without a corner: each figure one stroke.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [hook, slot, ess, rounded, snake, key];
    Figure::lines(hand, [random.pick(&variants)(random, hand.size)])
}

/// Line, arc, line.
fn hook(random: &mut Random, size: f64) -> Path {
    let radius = size * random.between(0.2, 0.6);
    let sweep = random.between(40.0, 200.0).to_radians() * random.sign();
    let start = Turtle::new(Point::ORIGIN, 0.0).ahead(size * random.between(0.4, 1.2));
    start.turn(radius, sweep).ahead(size * random.between(0.3, 1.2)).path()
}

fn slot(random: &mut Random, size: f64) -> Path {
    let radius = size * random.between(0.15, 0.5);
    let straight = 2.0 * (size - radius);
    let start = Turtle::new(Point::new(-0.5 * straight, -radius), 0.0);
    start.ahead(straight).turn(radius, PI).ahead(straight).turn(radius, PI).closed()
}

/// Two arcs, sometimes with a line between them.
fn ess(random: &mut Random, size: f64) -> Path {
    let mut turtle = Turtle::new(Point::ORIGIN, random.angle());
    let mut arc = || (size * random.between(0.25, 0.6), random.between(60.0, 240.0).to_radians());
    let ((r1, s1), (r2, s2)) = (arc(), arc());
    turtle = turtle.turn(r1, s1);
    if random.chance(0.5) {
        turtle = turtle.ahead(size * random.between(0.2, 0.8));
    }
    turtle.turn(r2, -s2).path()
}

fn rounded(random: &mut Random, size: f64) -> Path {
    let flat = random.between(0.5, 1.0);
    let radius = size * flat * random.between(0.2, 0.7);
    let (wide, high) = (2.0 * (size - radius), 2.0 * (size * flat - radius));
    let mut turtle = Turtle::new(Point::new(radius - size, -size * flat), 0.0);
    for side in [wide, high, wide, high] {
        turtle = turtle.ahead(side).turn(radius, 0.5 * PI);
    }
    turtle.closed()
}

/// Arcs of several radii, alternating or not.
fn snake(random: &mut Random, size: f64) -> Path {
    let mut turtle = Turtle::new(Point::ORIGIN, random.angle());
    for _ in 0..random.whole(2, 5) {
        let sweep = random.between(50.0, 180.0).to_radians() * random.sign();
        turtle = turtle.turn(size * random.between(0.2, 0.7), sweep);
    }
    turtle.path()
}

/// Straight lines, corners and arcs in one outline: a U with flat feet.
fn key(random: &mut Random, size: f64) -> Path {
    let radius = size * random.between(0.2, 0.45);
    let foot = size * random.between(0.3, 0.6);
    let leg = size * random.between(0.5, 1.2);
    let start = Turtle::new(Point::ORIGIN, 0.0).ahead(foot).corner(0.5 * PI).ahead(leg);
    start.turn(radius, -PI).ahead(leg).corner(0.5 * PI).ahead(foot).path()
}
