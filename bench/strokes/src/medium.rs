//! How ink sits on paper.

use crate::grain::Grain;
use crate::ink::draw;
use crate::plane::{Plane, blur};
use crate::warp::Warp;
use crate::{Ink, Random, Size};

/// Graphite's edge is soft, σ in px.
const SOFT_PX: f64 = 0.6;
/// How deep the grain is for a pencil: pressed fully it fills all, by half about a half. Where a line is few pixels wide
/// its grain is finer than they are and shows less.
const DEPTH: f64 = 0.85;
const DEEP_FROM_PX: f64 = 5.0;
/// Size of the grain, in pens, and px at least and most.
const GRAIN_PENS: (f64, f64) = (0.3, 0.6);
const GRAIN_PX: (f64, f64) = (1.0, 4.0);
/// This share of the pencils is soft, on paper whose grain is as rough as under the sketches that people scan: of so many px, and deeper
/// than a full press reaches.
const ROUGH: f64 = 0.5;
const ROUGH_GRAIN_PX: (f64, f64) = (0.8, 1.4);
const ROUGH_DEPTH: (f64, f64) = (1.0, 1.25);
/// A crayon's grain, in pens, and px at least; its edge, σ in pens: what presses less takes fewer of the grain's heights.
const CRAYON_GRAIN_PENS: (f64, f64) = (0.05, 0.15);
const CRAYON_GRAIN_PX: f64 = 1.5;
const CRAYON_SOFT_PENS: (f64, f64) = (0.06, 0.16);
/// A ballpoint's streak: how long its stretches are, in pens, how much of the darkness it takes, how wide it is, in pens, and over how much of
/// the grain's height it begins.
const STREAK_PENS: (f64, f64) = (3.0, 12.0);
const STREAK_DEPTH: (f64, f64) = (0.3, 0.8);
const STREAK_WIDE: f64 = 0.3;
const STREAK_RISE: f64 = 0.15;
/// From bare to covered graphite rises over so much of the grain's height.
const RISE: f64 = 0.45;

/// What the lines are of.
#[derive(Clone, Copy)]
pub(crate) enum Medium {
    /// Ink: twice is as dark as once.
    Pen,
    /// A pencil or a crayon on grain.
    Graphite {
        /// The paper's.
        grain: Grain,
        /// How deep it is: 1 is as high as a full press reaches.
        depth: f64,
        /// How soft the line's edge is, σ in px.
        soft_px: f64,
    },
    /// A ballpoint: of the middle of its lines it leaves a streak paler, up to so much, here and there.
    Ballpoint {
        /// Where.
        streak: Grain,
        /// How much of the ink's darkness is gone at most.
        depth: f64,
    },
    /// A felt pen: this share of the light is taken where it goes once, more where it goes again.
    Felt(f64),
}

impl Medium {
    /// A pencil of so many px.
    pub(crate) fn graphite(random: &mut Random, pen: f64) -> Self {
        let is_rough = random.chance(ROUGH);
        let cell = (pen * random.between(GRAIN_PENS.0, GRAIN_PENS.1)).clamp(GRAIN_PX.0, GRAIN_PX.1);
        let (cell, depth) = match is_rough {
            true => (
                random.between(ROUGH_GRAIN_PX.0, ROUGH_GRAIN_PX.1),
                random.between(ROUGH_DEPTH.0, ROUGH_DEPTH.1),
            ),
            false => (cell, DEPTH * (0.5 + 0.5 * (pen / DEEP_FROM_PX).min(1.0))),
        };
        Self::Graphite { grain: Grain::new(random.bits(), (cell, cell)), depth, soft_px: SOFT_PX }
    }

    /// A ballpoint of so many px.
    pub(crate) fn ballpoint(random: &mut Random, pen: f64) -> Self {
        let cell = pen * random.between(STREAK_PENS.0, STREAK_PENS.1);
        let streak = Grain::new(random.bits(), (cell, cell));
        Self::Ballpoint { streak, depth: random.between(STREAK_DEPTH.0, STREAK_DEPTH.1) }
    }

    /// A crayon of so many px.
    pub(crate) fn crayon(random: &mut Random, pen: f64) -> Self {
        let cell = (pen * random.between(CRAYON_GRAIN_PENS.0, CRAYON_GRAIN_PENS.1)).max(CRAYON_GRAIN_PX);
        let soft_px = pen * random.between(CRAYON_SOFT_PENS.0, CRAYON_SOFT_PENS.1);
        Self::Graphite { grain: Grain::new(random.bits(), (cell, cell)), depth: DEPTH, soft_px }
    }

    /// Share of the ink's darkness that each pixel has; what is of one stroke is given together.
    pub(crate) fn covered(self, size: Size, ink: &[Vec<&Ink>], warp: Option<&Warp>) -> Plane {
        let empty = || Plane::filled(size.width, size.height, 0.0);
        let mut covered = empty();
        let Self::Felt(once) = self else {
            ink.iter().flatten().for_each(|ink| draw(&mut covered, ink, warp));
            if let Self::Graphite { grain, depth, soft_px } = self {
                blur(&mut covered, soft_px);
                rub(&mut covered, grain, depth);
            }
            if let Self::Ballpoint { streak, depth } = self {
                let mut middles = empty();
                ink.iter().flatten().for_each(|ink| draw(&mut middles, &middle(ink), warp));
                shine(&mut covered, &middles, streak, depth);
            }
            return covered;
        };
        for stroke in ink {
            let mut own = empty();
            stroke.iter().for_each(|ink| draw(&mut own, ink, warp));
            // Beer and Lambert: each pass takes the same share of what light is left
            covered.values.iter_mut().zip(&own.values).for_each(|(v, o)| *v += (1.0 - *v) * once as f32 * o);
        }
        covered
    }
}

/// A line's middle, as wide as a ballpoint's streak.
fn middle(ink: &Ink) -> Ink {
    match ink {
        Ink::Line { path, pen, nib } => Ink::Line { path: path.clone(), pen: STREAK_WIDE * pen, nib: *nib },
        _ => ink.clone(),
    }
}

/// Makes the middles of lines paler where there is a streak: half of the way.
fn shine(covered: &mut Plane, middles: &Plane, streak: Grain, depth: f64) {
    for (i, (value, &middle)) in covered.values.iter_mut().zip(&middles.values).enumerate() {
        if middle > 0.01 {
            let height = streak.at((i % middles.width) as f64, (i / middles.width) as f64);
            let share = ((height - 0.5) / STREAK_RISE + 0.5).clamp(0.0, 1.0);
            *value *= 1.0 - middle * (depth * share) as f32;
        }
    }
}

/// Leaves graphite on the grain's heights.
fn rub(covered: &mut Plane, grain: Grain, depth: f64) {
    for (i, value) in covered.values.iter_mut().enumerate().filter(|(_, v)| **v > 0.01) {
        let height = grain.at((i % covered.width) as f64, (i / covered.width) as f64);
        let pressed = f64::from(*value);
        let share = ((pressed - depth * height) / RISE + 0.5).clamp(0.0, 1.0);
        *value = (share * (0.4 + 0.6 * pressed)) as f32;
    }
}
