use std::f64::consts::PI;

use tracelight_maths::planar;
use tracelight_stroke::{Path, Point};

use super::plain::closed_path;
use crate::shapes::{arc, circle, line, polyline};
use crate::{Figure, Hand, Random};

/// Figures side by side, the paper between them from the least a hand may leave to a few pens.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let widest = hand.paper + 4.0 * hand.pen;
    let paper = if random.chance(0.3) { hand.paper } else { random.between(hand.paper, widest) };
    let pitch = hand.pen + paper;
    let variants = [lines, hatch, bows, rings, rectangles, chevrons, beside];
    Figure::lines(hand, random.pick(&variants)(random, hand.size, pitch))
}

/// As many as fit into the figure's size.
fn count(random: &mut Random, size: f64, pitch: f64) -> usize {
    random.whole(2, 6).min((2.0 * size / pitch) as usize).max(2)
}

/// Offsets about zero, a pitch apart.
fn offsets(count: usize, pitch: f64) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| (i as f64 - 0.5 * (count as f64 - 1.0)) * pitch)
}

fn lines(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let n = count(random, size, pitch);
    offsets(n, pitch).map(|y| line(Point::new(-size, y), Point::new(size, y))).collect()
}

/// Lines of uneven lengths.
fn hatch(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let n = count(random, size, pitch);
    let mut end = || size * random.between(0.4, 1.0);
    offsets(n, pitch).map(|y| line(Point::new(-end(), y), Point::new(end(), y))).collect()
}

fn bows(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let n = count(random, 0.5 * size, pitch).min(4);
    let sweep = random.between(0.8, 4.5);
    (0..n).map(|i| arc(Point::ORIGIN, size - i as f64 * pitch, 0.0, sweep)).collect()
}

fn rings(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let n = count(random, 0.5 * size, pitch).min(4);
    (0..n).map(|i| circle(Point::ORIGIN, size - i as f64 * pitch)).collect()
}

fn rectangles(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let n = count(random, 0.4 * size, pitch).min(3);
    let flat = random.between(0.5, 1.0);
    let nested = |i: usize| {
        let (x, y) = (size - i as f64 * pitch, size * flat - i as f64 * pitch);
        let corners = [(-x, -y), (x, -y), (x, y), (-x, y)].map(Point::from);
        polyline(&corners, true)
    };
    (0..n).map(nested).collect()
}

/// The same corner again and again.
fn chevrons(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let half = random.between(25.0, 70.0).to_radians();
    let arm = size * random.between(0.6, 1.0);
    let n = count(random, 0.5 * size, pitch).min(4);
    // along the axis the corners are further apart than the lines are
    let one = |x: f64| {
        let (dx, dy) = (arm * half.cos(), arm * half.sin());
        polyline(&[(x + dx, -dy), (x, 0.0), (x + dx, dy)].map(Point::from), false)
    };
    offsets(n, pitch / half.sin()).map(one).collect()
}

/// A closed figure and a line along its bounding box.
fn beside(random: &mut Random, size: f64, pitch: f64) -> Vec<Path> {
    let figure = closed_path(random, 0.7 * size);
    let right = figure.flatten(0.01).iter().fold(0.0, |x: f64, p| x.max(p.x));
    let wall = line(Point::new(right + pitch, -size), Point::new(right + pitch, size));
    vec![figure, wall].into_iter().map(|p| p.transformed(planar::rotation(PI * 0.5))).collect()
}
