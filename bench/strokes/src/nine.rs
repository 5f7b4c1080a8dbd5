//! The nine-stroke drawing that other tracers were measured on: an ellipse, a rectangle with its diagonals, a star, a
//! spiral, a sine and a plus. The same geometry as `gen.py`, by whose rules its diagonals end at corners.

use std::f64::consts::{PI, TAU};

use tracelight_stroke::{Drawing, Path, Point};

use crate::look::Look;
use crate::shapes::{curve, line, polyline};
use crate::{Figure, Hand, Ink, Nib, Picture, Random, Size};

/// The drawing in a picture of a size, clean or as a webcam sees it.
pub fn picture(size: Size, webcam: bool, seed: u64) -> Picture {
    let figure = figure(size);
    let look = if webcam { Look::webcam(size, 255.0, 20.0) } else { Look::clean(255.0, 20.0) };
    let ink: Vec<&Ink> = figure.ink.iter().collect();
    let levels = look.levels(&mut Random::new(u128::from(seed)), size, &[ink], None);
    Picture {
        width: size.width,
        height: size.height,
        levels,
        truth: Drawing { strokes: figure.strokes.clone() },
    }
}

fn figure(size: Size) -> Figure {
    let (w, h) = (size.width as f64, size.height as f64);
    let scale = (w / 4.0).min(h / 3.0);
    let (wide, high) = (4.0 * scale, 3.0 * scale);
    let corner = Point::new(0.5 * (w - wide), 0.5 * (h - high));
    let pen = (h / 120.0).round().max(2.0);
    let hand = Hand { pen, nib: Nib::Round, paper: 3.0, size: 0.5 * high };
    Figure::lines(&hand, paths(|x, y| Point::new(corner.x + x * wide, corner.y + y * high)))
}

/// In a box of 1 × 1 that `p` takes to the picture.
fn paths(p: impl Fn(f64, f64) -> Point) -> Vec<Path> {
    let ellipse = curve(|t| p(0.25 + 0.15 * t.cos(), 0.3 + 0.2 * t.sin()), 0.0, TAU, 48);
    let corners = [p(0.5, 0.1), p(0.9, 0.1), p(0.9, 0.45), p(0.5, 0.45)];
    let tip = |i: usize| {
        let (reach, angle) = (if i.is_multiple_of(2) { 1.0 } else { 0.45 }, i as f64 * PI / 5.0);
        p(0.2 + 0.13 * reach * angle.sin(), 0.75 - 0.17 * reach * angle.cos())
    };
    let sine = curve(|x| p(x, 0.7 + 0.1 * ((x - 0.42) * 24.0).sin()), 0.42, 0.95, 64);
    let spiral = |a: f64| p(0.25 + 0.024 * a / PI * a.cos(), 0.3 + 0.032 * a / PI * a.sin());
    vec![
        ellipse,
        polyline(&corners, true),
        line(corners[0], corners[2]),
        line(corners[1], corners[3]),
        polyline(&(0..10).map(tip).collect::<Vec<_>>(), true),
        sine,
        line(p(0.45, 0.92), p(0.9, 0.92)),
        line(p(0.67, 0.85), p(0.67, 0.97)),
        curve(spiral, 0.0, 5.0 * PI, 80),
    ]
}
