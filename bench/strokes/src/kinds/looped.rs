use std::f64::consts::{PI, TAU};

use tracelight_stroke::{Path, Point};

use crate::shapes::curve;
use crate::{Figure, Hand, Random};

/// Lines that cross themselves as handwriting does, and spirals: each figure one stroke.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [writing, writing, eight, alpha, spiral, petals];
    Figure::lines(hand, [random.pick(&variants)(random, hand)])
}

/// Letters e and l in a chain: a trochoid whose loops differ in height.
fn writing(random: &mut Random, hand: &Hand) -> Path {
    let letters = random.whole(1, 4);
    let pitch = 2.0 * hand.size / (letters as f64 + 0.5);
    let widths = pitch * random.between(0.4, 0.7);
    let mut height = |_| pitch * random.pick(&[0.7, 0.8, 1.3]) * random.between(0.9, 1.1);
    let heights: Vec<f64> = (0..letters + 2).map(&mut height).collect();
    // the loops lean to the right, as most hands do
    let slant = random.between(0.0, 0.3);
    let at = move |t: f64| {
        // heights change at the foot, where the rise is none
        let letter = ((t / TAU + 1.0) as usize).min(heights.len() - 1);
        let rise = 0.5 * heights[letter] * (1.0 - t.cos());
        let x = pitch * t / TAU + widths * t.sin() + slant * rise;
        Point::new(x - hand.size, 0.5 * hand.size - rise)
    };
    let tail = random.between(0.2, 0.35) * TAU;
    curve(at, -tail, TAU * letters as f64 + tail, 16 * (letters + 1))
}

/// Gerono's curve.
fn eight(random: &mut Random, hand: &Hand) -> Path {
    let (a, b) = (hand.size, hand.size * random.between(0.6, 1.4));
    curve(|t| Point::new(a * t.sin(), b * t.sin() * t.cos()), 0.5, 0.5 + TAU, 32)
}

/// A fish: one loop with crossed ends.
fn alpha(random: &mut Random, hand: &Hand) -> Path {
    let (size, open) = (hand.size, random.between(0.6, 1.1));
    // x = t² − c, y = t³ − d t crosses itself where t² = d (Tschirnhausen's cubic, stretched)
    let at = |t: f64| Point::new(size * (0.9 * t * t - 0.8), open * size * (t * t * t - 0.9 * t));
    curve(at, -1.25, random.between(1.15, 1.3), 24)
}

fn spiral(random: &mut Random, hand: &Hand) -> Path {
    let pitch = hand.pen + random.between(hand.paper, hand.paper + 6.0 * hand.pen);
    let turns = (hand.size / pitch).clamp(1.0, random.between(2.0, 5.0));
    let inner = 2.5 * hand.pen;
    let way = random.sign();
    let at = |t: f64| {
        let radius = inner + pitch * t / TAU;
        Point::new(radius * t.cos(), way * radius * t.sin())
    };
    curve(at, 0.0, turns * TAU, (turns * 16.0) as usize + 1)
}

/// A closed line that crosses itself between three to five petals.
fn petals(random: &mut Random, hand: &Hand) -> Path {
    let petals = random.whole(3, 5) as f64;
    let (ring, loops) = (0.5 * hand.size, hand.size * random.between(0.4, 0.5));
    let at = |t: f64| {
        let inner = t * (1.0 - petals);
        Point::new(ring * t.cos() + loops * inner.cos(), ring * t.sin() + loops * inner.sin())
    };
    curve(at, 0.1 * PI, 0.1 * PI + TAU, 24 * petals as usize)
}
