use tracelight_maths::planar;
use tracelight_stroke::{Path, Point, Stroke, StrokeKind};

use super::plain::closed_path;
use crate::shapes::line;
use crate::{Figure, Hand, Ink, Random};

/// An area has this share of the ink's darkness.
const DARK: (f64, f64) = (0.12, 0.5);
/// This share of them has no line about it.
const BARE: f64 = 0.35;
/// Between a line on an area and the area's edge lie so many pens and px; the line is at least so long either way.
const CLEAR_PENS: f64 = 5.0;
const CLEAR_PX: f64 = 6.0;
const LEAST_PENS: f64 = 6.0;
const LEAST_PX: f64 = 9.0;

/// Closed figures coloured in paler than lines on and about them, and lines beside them.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    if random.chance(0.25) {
        return super::lines(random, hand);
    }
    let outline = closed_path(random, hand.size);
    let wash = Ink::Wash { outline: outline.clone(), dark: random.between(DARK.0, DARK.1) };
    let on = line_on(random, hand, &outline);
    let is_bare = on.is_some() && random.chance(BARE);
    let mut figure = match is_bare {
        true => Figure {
            strokes: vec![Stroke { kind: StrokeKind::Outline, ..Stroke::new(outline) }],
            ink: Vec::new(),
        },
        false => Figure::lines(hand, [outline]),
    };
    figure.ink.push(wash);
    match on {
        Some(on) => figure.and(Figure::lines(hand, [on])),
        None => figure,
    }
}

/// A line through the middle of an area, clear of its edge.
fn line_on(random: &mut Random, hand: &Hand, outline: &Path) -> Option<Path> {
    let nearest = outline.flatten(0.1).iter().map(|p| p.to_vec2().hypot()).fold(f64::INFINITY, f64::min);
    let half = nearest - CLEAR_PENS * hand.pen - CLEAR_PX;
    (half >= (LEAST_PENS * hand.pen).max(LEAST_PX)).then(|| {
        let way = planar::direction(random.angle()) * half;
        line(Point::ORIGIN - way, Point::ORIGIN + way)
    })
}
