use std::f64::consts::PI;

use tracelight_maths::planar;
use tracelight_stroke::{Path, Point};

use crate::shapes::{line, spline};
use crate::{Figure, Hand, Random};

/// Lines side by side, not quite alike; now and then others across them.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let crossed = random.chance(0.3);
    // crossed lines keep their crossings apart
    let least =
        if crossed { (3.2 * hand.pen).max(hand.pen + 3.0) } else { hand.pen + (0.6 * hand.pen).max(1.5) };
    let pitch = (least * random.between(1.1, 2.0)).max(0.1 * hand.size);
    let mut paths = rank(random, hand, (0.0, pitch));
    if crossed {
        let turn = random.between(50.0, 90.0).to_radians();
        paths.extend(rank(random, hand, (turn, pitch)));
    }
    Figure::lines(hand, paths)
}

/// Lines in one direction, a pitch from middle to middle.
fn rank(random: &mut Random, hand: &Hand, (turn, pitch): (f64, f64)) -> Vec<Path> {
    let count = ((1.6 * hand.size / pitch) as usize).clamp(3, 14);
    let bow = hand.size * random.between(-0.15, 0.15);
    let bowed = random.chance(0.4);
    let mut one = |i: usize| {
        let x = pitch * (i as f64 - 0.5 * (count as f64 - 1.0) + random.between(-0.04, 0.04));
        let (top, bottom) = (-hand.size * random.between(0.7, 1.0), hand.size * random.between(0.7, 1.0));
        let lean = 0.04 * pitch * random.between(-1.0, 1.0);
        let (a, b) = (Point::new(x - lean, top), Point::new(x + lean, bottom));
        let middle = Point::new(x + bow, 0.5 * (top + bottom));
        let path = if bowed { spline(&[a, middle, b], false) } else { line(a, b) };
        path.transformed(planar::rotation(turn + 0.5 * PI))
    };
    (0..count).map(&mut one).collect()
}
