use std::f64::consts::{PI, TAU};

use tracelight_stroke::{Path, Point};

use crate::shapes::{circle, line, line_through, polar, polyline};
use crate::{Figure, Hand, Random};

/// Short sides are so many pens long at least: what a fat pen leaves between them is closed, or nearly.
const SHORT_PENS: f64 = 2.6;
/// Where two lines meet at less than this, their tips are filled, degrees.
const SHARPEST_DEG: f64 = 35.0;

/// What signs and sketches are made of: lines that are short for their pen, and many that meet in one place.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [arrow, arrow, grid, ladder, snowflake, wheel, fir, crown];
    let paths = random.pick(&variants)(random, hand);
    Figure::lines(hand, paths)
}

/// A side between these shares of the figure's, and of [`SHORT_PENS`] at least.
fn side(random: &mut Random, hand: &Hand, least: f64, most: f64) -> f64 {
    (hand.size * random.between(least, most)).max(SHORT_PENS * hand.pen)
}

fn arrow(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let tip = Point::new(hand.size, 0.0);
    let open = random.between(SHARPEST_DEG, 60.0).to_radians();
    let arm = side(random, hand, 0.3, 0.7).max(3.2 * hand.pen);
    let head = [polar(tip, PI - open, arm), tip, polar(tip, PI + open, arm)];
    vec![line(Point::new(-hand.size, 0.0), tip), polyline(&head, false)]
}

/// Lines across each other, all of them with ends: a box of four is one line.
fn grid(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let (columns, rows) = (random.whole(2, 5), random.whole(2, 5));
    let apart = side(random, hand, 0.3, 0.6).max(hand.pen + 1.5 * hand.paper);
    let over = apart * random.between(0.6, 1.0);
    let (wide, high) = (apart * (columns - 1) as f64, apart * (rows - 1) as f64);
    let at = |k: usize, length: f64| apart * k as f64 - 0.5 * length;
    let (right, low) = (0.5 * wide + over, 0.5 * high + over);
    let upright = (0..columns).map(|k| line(Point::new(at(k, wide), -low), Point::new(at(k, wide), low)));
    let level = (0..rows).map(|k| line(Point::new(-right, at(k, high)), Point::new(right, at(k, high))));
    upright.chain(level).collect()
}

fn ladder(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let half = 0.5 * side(random, hand, 0.4, 0.8);
    let apart = side(random, hand, 0.3, 0.5).max(hand.pen + 1.5 * hand.paper);
    let rungs = random.whole(2, 5);
    let long = apart * (rungs + 1) as f64;
    let rail = |x: f64| line(Point::new(x, -0.5 * long), Point::new(x, 0.5 * long));
    let rung = |k: usize| {
        let y = apart * (k + 1) as f64 - 0.5 * long;
        line(Point::new(-half, y), Point::new(half, y))
    };
    [rail(-half), rail(half)].into_iter().chain((0..rungs).map(rung)).collect()
}

fn snowflake(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let lines = random.whole(3, 4);
    let reach = hand.size.max(4.0 * hand.pen);
    let through = |k: usize| line_through(Point::ORIGIN, PI * k as f64 / lines as f64, reach, reach);
    (0..lines).map(through).collect()
}

/// Spokes between two rings.
fn wheel(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let spokes = random.whole(4, 8);
    // beside each other where they end, spokes leave paper
    let apart = 1.4 * (hand.pen + hand.paper) * spokes as f64 / TAU;
    let hub = (hand.size * random.between(0.15, 0.3)).max(2.2 * hand.pen).max(apart);
    let rim = hand.size.max(hub + 4.0 * hand.pen);
    let spoke = |k: usize| {
        let way = TAU * k as f64 / spokes as f64;
        line(polar(Point::ORIGIN, way, hub), polar(Point::ORIGIN, way, rim))
    };
    let rings = [hub, rim].map(|radius| circle(Point::ORIGIN, radius));
    rings.into_iter().chain((0..spokes).map(spoke)).collect()
}

/// Tiers with notches between them.
fn fir(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let tiers = random.whole(2, 3);
    let notch = side(random, hand, 0.15, 0.3);
    let (wide, high) = (side(random, hand, 0.3, 0.5) + notch, side(random, hand, 0.4, 0.7));
    let mut half = vec![Point::new(0.0, 0.0)];
    for tier in 1..=tiers {
        let (out, low) = (wide + 0.15 * (tier - 1) as f64 * notch, high * tier as f64);
        half.push(Point::new(out, low));
        if tier < tiers {
            half.push(Point::new(out - notch, low));
        }
    }
    let other = half[1..].iter().rev().map(|p| Point::new(-p.x, p.y));
    let middle = 0.5 * high * tiers as f64;
    let corners: Vec<Point> = half.iter().copied().chain(other).collect();
    vec![polyline(&corners.iter().map(|p| Point::new(p.x, p.y - middle)).collect::<Vec<_>>(), true)]
}

/// A zigzag on a bar.
fn crown(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let points = random.whole(2, 4);
    let half_wide = side(random, hand, 0.2, 0.35);
    let high = half_wide * random.between(0.8, 1.5);
    let below = side(random, hand, 0.2, 0.5);
    let left = -half_wide * points as f64;
    let at = |k: usize| {
        let up = if k.is_multiple_of(2) { high } else { 0.0 };
        Point::new(left + half_wide * k as f64, -up)
    };
    let top: Vec<Point> = (0..=2 * points).map(at).collect();
    let bottom = [Point::new(-left, below), Point::new(left, below)];
    vec![polyline(&top.into_iter().chain(bottom).collect::<Vec<_>>(), true)]
}
