use std::f64::consts::PI;

use tracelight_stroke::{Path, Point};

use crate::shapes::{Turtle, arc, curve, line, polar, polyline};
use crate::{Figure, Hand, Random};

/// Hairpins turn by so many degrees less than half a turn.
const SHARPEST_DEG: f64 = 4.0;
const WIDEST_DEG: f64 = 25.0;

pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [vee, vee, turn, turn, bow, leaf, zigzag, joining, between];
    let paths = random.pick(&variants)(random, hand);
    Figure::lines(hand, paths)
}

/// An angle at which two legs of this length have paper between them at their ends; none if they are too short.
fn angle(random: &mut Random, hand: &Hand, leg: f64, least_deg: f64) -> Option<f64> {
    let least = (1.25 * (hand.pen + hand.paper) / leg).asin().max(least_deg.to_radians());
    (least < WIDEST_DEG.to_radians()).then(|| random.between(least, WIDEST_DEG.to_radians()))
}

fn vee(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let legs = [random.between(1.0, 2.0), random.between(1.0, 2.0)].map(|l| l * hand.size);
    let Some(open) = angle(random, hand, legs[0].min(legs[1]), SHARPEST_DEG) else { return vec![] };
    let tip = Point::new(hand.size, 0.0);
    vec![polyline(&[polar(tip, PI - 0.5 * open, legs[0]), tip, polar(tip, PI + 0.5 * open, legs[1])], false)]
}

/// A U whose paper closes before the turn.
fn turn(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let legs = [random.between(1.0, 2.0), random.between(1.0, 2.0)].map(|l| l * hand.size);
    let Some(open) = angle(random, hand, legs[0].min(legs[1]), 0.0) else { return vec![] };
    let radius = hand.pen * random.between(0.3, 0.8);
    let start = Turtle::new(Point::new(-hand.size, 0.0), 0.5 * open);
    vec![start.ahead(legs[0]).turn(radius, PI - open).ahead(legs[1]).path()]
}

/// A parabola with a tight turn.
fn bow(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let (focus, reach) = (0.5 * hand.pen * random.between(0.3, 0.8), hand.size * random.between(1.0, 2.0));
    let end = (4.0 * focus * reach).sqrt();
    if 2.0 * end < 1.25 * (hand.pen + hand.paper) {
        return vec![];
    }
    let at = |y: f64| Point::new(hand.size - y * y / (4.0 * focus), y);
    vec![curve(at, -end * random.between(0.8, 1.0), end, 12)]
}

/// Two bows that meet in two sharp tips.
fn leaf(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let half = hand.size * random.between(0.8, 1.2);
    // the middle is as wide as twice the sagitta
    let least = 2.0 * (1.25 * (hand.pen + hand.paper) / (2.0 * half)).atan();
    let at_tip = random.between(least.max(0.1), 0.45_f64.max(least + 0.05));
    let radius = half / at_tip.sin();
    let centre = Point::new(0.0, radius * at_tip.cos());
    let mut path = arc(centre, radius, -0.5 * PI - at_tip, 2.0 * at_tip);
    let other = Point::new(0.0, -centre.y);
    path.push(tracelight_stroke::Element::Arc { centre: other, sweep: 2.0 * at_tip });
    path.close();
    vec![path]
}

/// Grass: hairpins in a row, one stroke.
fn zigzag(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let leg = hand.size * random.between(1.0, 1.6);
    let Some(open) = angle(random, hand, leg, 8.0) else { return vec![] };
    let legs = random.whole(3, 6);
    let pitch = 2.0 * leg * (0.5 * open).sin();
    let corner = |i: usize| {
        let up = if i.is_multiple_of(2) { 0.5 } else { -0.5 };
        Point::new(0.5 * pitch * (i as f64 - 0.5 * legs as f64), up * leg)
    };
    vec![polyline(&(0..=legs).map(corner).collect::<Vec<_>>(), false)]
}

/// A line that joins another one from behind.
fn joining(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let leg = hand.size * random.between(1.0, 1.6);
    let Some(open) = angle(random, hand, leg, 8.0) else { return vec![] };
    let on = hand.size * random.between(0.4, 1.0);
    let side = random.sign();
    let bend = random.between(-0.3, 0.3);
    let through = if bend.abs() < 0.1 {
        line(Point::new(-1.2 * leg, 0.0), Point::new(on, 0.0))
    } else {
        // bent away from the third line, or it would come near again
        let radius = (leg + on) / bend.abs();
        let start = Turtle::new(Point::new(-1.2 * leg, 0.0), 0.0);
        start.ahead(1.2 * leg).turn(radius, -side * (on / radius)).path()
    };
    vec![through, line(polar(Point::ORIGIN, PI + side * open, leg), Point::ORIGIN)]
}

/// A V with a third line that leaves its tip between the legs.
fn between(random: &mut Random, hand: &Hand) -> Vec<Path> {
    let leg = hand.size * random.between(1.0, 1.8);
    let Some(half) = angle(random, hand, leg, 10.0) else { return vec![] };
    let leg_end = |side: f64| polar(Point::ORIGIN, side * half, leg);
    let third = line(Point::ORIGIN, Point::new(leg * random.between(0.9, 1.2), 0.0));
    vec![polyline(&[leg_end(1.0), Point::ORIGIN, leg_end(-1.0)], false), third]
}
