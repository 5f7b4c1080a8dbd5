use std::f64::consts::TAU;

use tracelight_maths::planar;
use tracelight_stroke::{Path, Vec2};

use super::places::Places;
use super::swelling;
use crate::{Figure, Hand, Ink, Random};

/// The page's pen is what all passes of a line are across together: each of them has this share.
pub(crate) const OWN_PEN: f64 = 0.3;
/// Most from the middle of one pass to that of another one, in their own pens.
const MOST_APART_PENS: f64 = 1.0 / OWN_PEN - 1.0;
/// From place to place along a pass, in its own pens.
const STEP_PENS: f64 = 0.5;
/// This share of the lines is drawn once, and twice; the others three times.
const ONCE: f64 = 0.15;
const TWICE: f64 = 0.5;
/// A pass is pressed by at least a share of a full press between these.
const PRESSED: (f64, f64) = (0.3, 0.7);
/// How far a pass sways, of how far passes may be from the line.
const SWAY: f64 = 0.45;
/// A closed line goes on beyond its start by up to this share.
const MOST_BEYOND: f64 = 0.04;
/// Where a pass begins or ends the line goes over to it within so many of the page's pens.
const RAMP_PENS: f64 = 4.0;

/// What a pencil sketches: each line in one to three passes, the first all along, the others on a part of it or all along too; now on
/// one side of each other and now on the other. The line is the middle of them.
pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let own = OWN_PEN * hand.pen;
    let mut figure = Figure::default();
    for stroke in super::lines(random, hand).strokes {
        let (path, length) = (&stroke.path, stroke.path.length(1e-3));
        let places = Places::along(path, (length / (STEP_PENS * own)).ceil() as usize);
        let passes = passes(random, path, own);
        let drawn = passes.iter().map(|pass| {
            let path = places.moved((pass.from, pass.to), false, |share, _| pass.aside(share));
            Ink::Touches(swelling::pressed(random, (own, PRESSED), &path))
        });
        let drawn: Vec<Ink> = drawn.collect();
        let ramp = RAMP_PENS * hand.pen / length;
        let middle = places.moved((0.0, 1.0), path.is_closed(), |share, _| middle(&passes, share, ramp));
        figure = figure.and(Figure::stroke(middle, hand.pen, drawn));
    }
    figure
}

/// One time along a line.
struct Pass {
    /// Shares of the line's length where it begins and ends; beyond 1 a closed line is gone round again.
    from: f64,
    to: f64,
    /// Where it lies, px aside, and how far it sways round that.
    held: Vec2,
    sway: f64,
    turns: f64,
    phases: (f64, f64),
}

impl Pass {
    fn aside(&self, share: f64) -> Vec2 {
        let at = TAU * self.turns * share;
        self.held + Vec2::new((at + self.phases.0).sin(), (at + self.phases.1).cos()) * self.sway
    }

    /// How much it counts there.
    fn weight(&self, share: f64, ramp: f64) -> f64 {
        let up = if self.from > 0.0 { (share - self.from) / ramp } else { 1.0 };
        let down = if self.to != 1.0 { (self.to - share) / ramp } else { 1.0 };
        up.min(down).clamp(0.0, 1.0)
    }
}

/// The passes of a line by a pencil of this width.
fn passes(random: &mut Random, path: &Path, pen: f64) -> Vec<Pass> {
    let drawn = random.between(0.0, 1.0);
    let count = 1 + usize::from(drawn > ONCE) + usize::from(drawn > ONCE + TWICE);
    let reach = 0.5 * pen * random.between(0.8, MOST_APART_PENS);
    let way = random.angle();
    let mut pass = |number: usize| {
        let (from, to) = match (number, path.is_closed()) {
            (_, true) => {
                let start = random.between(0.01, 1.0);
                let beyond = random.between(0.0, MOST_BEYOND);
                (start, start + if number == 0 { 1.0 + beyond } else { random.between(0.3, 0.9) })
            }
            (0, false) => (0.0, 1.0),
            (_, false) if random.chance(0.4) => (0.0, 1.0),
            (_, false) => (random.between(0.0, 0.4), random.between(0.6, 1.0)),
        };
        let held = planar::direction(way + TAU * number as f64 / count as f64) * (1.0 - SWAY) * reach;
        Pass {
            from,
            to,
            held: if count > 1 { held } else { Vec2::ZERO },
            sway: SWAY * reach,
            turns: random.between(0.3, 1.2),
            phases: (random.angle(), random.angle()),
        }
    };
    (0..count).map(&mut pass).collect()
}

/// The middle of the passes at a place of a line.
fn middle(passes: &[Pass], share: f64, ramp: f64) -> Vec2 {
    let all =
        passes.iter().flat_map(|pass| [share, share + 1.0].map(|at| (pass.weight(at, ramp), pass.aside(at))));
    // a closed line's only pass may begin and end there
    let (sum, weights) = all
        .fold((Vec2::ZERO, 0.0), |(sum, weights), (weight, aside)| (sum + aside * weight, weights + weight));
    if weights > 0.0 { sum / weights } else { passes[0].aside(share) }
}
