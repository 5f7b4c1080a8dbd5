use std::f64::consts::{PI, TAU};

use tracelight_maths::planar;
use tracelight_stroke::{Affine, Path, Point, Vec2};

use super::plain::closed_path;
use crate::shapes::{arc, circle, curve, line, line_through, polar, polyline};
use crate::{Figure, Hand, Random};

pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [cross, asterisk, grid, wave_and_lines, closed_and_line, two_closed, bows, arcs_and_line];
    let paths = random.pick(&variants)(random, hand.size);
    Figure::lines(hand, paths)
}

fn cross(random: &mut Random, size: f64) -> Vec<Path> {
    let (angle, between) = (random.angle(), random.between(32.0, 148.0).to_radians());
    let mut arm = |angle| line_through(Point::ORIGIN, angle, size * random.between(0.4, 1.0), size);
    vec![arm(angle), arm(angle + between)]
}

/// Three lines through one point.
fn asterisk(random: &mut Random, size: f64) -> Vec<Path> {
    let from = random.angle();
    let mut arm = |i: usize| {
        let angle = from + (60.0 * i as f64 + random.between(-10.0, 10.0)).to_radians();
        line_through(Point::ORIGIN, angle, size * random.between(0.6, 1.0), size * random.between(0.6, 1.0))
    };
    (0..3).map(&mut arm).collect()
}

/// Two or three lines across two or three.
fn grid(random: &mut Random, size: f64) -> Vec<Path> {
    let lean = random.between(-40.0, 40.0).to_radians();
    let along = Vec2::new(1.0, 0.0);
    let across = planar::direction(PI / 2.0 + lean);
    let (rows, columns) = (random.whole(2, 3), random.whole(2, 3));
    let mut lines = Vec::new();
    for (count, way, aside) in [(rows, along, across), (columns, across, along)] {
        for i in 0..count {
            let shift = aside * (size * (2.0 * (i as f64 + 1.0) / (count as f64 + 1.0) - 1.0));
            let reach = way * size;
            lines.push(line((shift - reach).to_point(), (shift + reach).to_point()));
        }
    }
    lines
}

fn wave_and_lines(random: &mut Random, size: f64) -> Vec<Path> {
    let (height, turns, phase) = (size * random.between(0.15, 0.4), random.between(0.8, 2.0), random.angle());
    let at = |t: f64| Point::new(size * t, height * (turns * PI * t + phase).sin());
    let mut paths = vec![curve(at, -1.0, 1.0, 24)];
    let lines = random.whole(1, 3);
    for i in 0..lines {
        let x = size * (2.0 * (i as f64 + 1.0) / (lines as f64 + 1.0) - 1.0);
        let angle = random.between(50.0, 130.0).to_radians();
        paths.push(line_through(Point::new(x, 0.0), angle, 0.7 * size, size * random.between(0.5, 0.8)));
    }
    paths
}

fn closed_and_line(random: &mut Random, size: f64) -> Vec<Path> {
    let figure = closed_path(random, 0.7 * size);
    let middle = polar(Point::ORIGIN, random.angle(), size * random.between(0.0, 0.25));
    vec![figure, line_through(middle, random.angle(), size, size)]
}

fn two_closed(random: &mut Random, size: f64) -> Vec<Path> {
    let shift = polar(Point::ORIGIN, random.angle(), size * random.between(0.35, 0.8)).to_vec2();
    let one = closed_path(random, 0.6 * size);
    let other = closed_path(random, 0.6 * size);
    vec![one.transformed(Affine::translate(-0.5 * shift)), other.transformed(Affine::translate(0.5 * shift))]
}

/// Two bows across each other twice.
fn bows(random: &mut Random, size: f64) -> Vec<Path> {
    let (radius, sweep) = (size * random.between(0.8, 1.2), random.between(1.8, 2.8));
    let apart = radius * random.between(0.3, 1.0);
    let left = arc(Point::new(-apart, 0.0), radius, -0.5 * sweep, sweep);
    let right = arc(Point::new(apart, 0.0), radius, PI - 0.5 * sweep, sweep);
    vec![left, right]
}

/// A zigzag or a circle with several lines across.
fn arcs_and_line(random: &mut Random, size: f64) -> Vec<Path> {
    let bar = line_through(Point::ORIGIN, random.between(-0.2, 0.2), size, size);
    if random.chance(0.5) {
        let turns = random.whole(2, 4);
        let corner = |i: usize| {
            let side = if i.is_multiple_of(2) { 0.5 } else { -0.5 };
            Point::new(size * (1.7 * i as f64 / turns as f64 - 0.85), size * side)
        };
        let corners: Vec<_> = (0..=turns).map(corner).collect();
        return vec![bar, polyline(&corners, false)];
    }
    let ring = circle(Point::ORIGIN, size * random.between(0.4, 0.7));
    let other = line_through(Point::ORIGIN, random.between(0.2, 0.8) * TAU / 2.0, size, size);
    vec![bar, ring, other]
}
