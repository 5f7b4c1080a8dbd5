use std::f64::consts::{PI, TAU};

use tracelight_maths::planar;
use tracelight_stroke::{Path, Vec2};

use super::writing;
use crate::touch::{Along, Touch, profile, touches};
use crate::{Figure, Hand, Ink, Random};

/// The page's pen is the widest place: 2.5 times the pen that swells from 0.3 times on.
const LEAST_SWELL: f64 = 0.3 / 2.5;
/// No line is thinner, px.
const LEAST_PX: f64 = 0.9;

/// A pencil that draws presses by at least a share of its full press between these.
const PRESSED: (f64, f64) = (0.55, 0.8);

/// This share of the figures is a word, as large as the pen needs it.
const LETTERS: f64 = 0.2;

/// Lines that swell with pressure.
pub(super) fn swell(random: &mut Random, hand: &Hand) -> Figure {
    each_line(random, hand, |random, path| {
        let least = (hand.pen * random.log_between(LEAST_SWELL, 0.5)).max(LEAST_PX).min(hand.pen);
        let width = profile(waves(random, path.is_closed()), (least, hand.pen), path.length(1e-3));
        touches(path, |along| disc(along, width(along.share), 1.0))
    })
}

/// Lines that taper to both ends or to one, as a brush leaves them; closed ones swell.
pub(super) fn brush(random: &mut Random, hand: &Hand) -> Figure {
    each_line(random, hand, |random, path| {
        let least = (hand.pen * random.between(0.08, 0.25)).max(LEAST_PX).min(hand.pen);
        let (skew, full) = (random.log_between(0.6, 1.7), random.between(1.0, 1.6));
        let both = random.chance(0.6);
        let waves = waves(random, true);
        let closed = path.is_closed();
        let shape = move |share: f64| {
            let at = if both { share.powf(skew) } else { 0.5 + 0.5 * share.powf(skew) };
            if closed { waves(share) } else { ((PI * at).sin() * full).clamp(0.0, 1.0) }
        };
        let width = profile(shape, (least, hand.pen), path.length(1e-3));
        touches(path, |along| disc(along, width(along.share), 1.0))
    })
}

/// A broad nib held at one angle: thick across it, thin along it.
pub(super) fn nib(random: &mut Random, hand: &Hand) -> Figure {
    let held = planar::direction(random.angle());
    let ratio = random.between(3.0, 8.0).min(hand.pen / LEAST_PX).max(1.0);
    let radius = 0.5 * hand.pen / ratio;
    let reach = held * (0.5 * hand.pen - radius);
    each_line(random, hand, |_, path| touches(path, |along| Touch { at: along.at, reach, radius, dark: 1.0 }))
}

/// A marker that runs dry: dark to a fifth, or pale in the middle; and lines that are pale all along.
pub(super) fn fading(random: &mut Random, hand: &Hand) -> Figure {
    each_line(random, hand, |random, path| {
        if random.chance(0.25) {
            let dark = random.between(0.3, 0.6);
            return touches(path, |along| disc(along, hand.pen, dark));
        }
        let least = random.between(0.22, 0.5);
        let waves = waves(random, path.is_closed());
        let to_the_end = random.chance(0.5) && !path.is_closed();
        let dark =
            move |share: f64| least + (1.0 - least) * if to_the_end { 1.0 - share } else { waves(share) };
        touches(path, |along| disc(along, hand.pen, dark(along.share)))
    })
}

/// A pencil: the pressure changes along the line, and a little of its width with it.
pub(super) fn pencil(random: &mut Random, hand: &Hand) -> Figure {
    each_line(random, hand, |random, path| pressed(random, (hand.pen, PRESSED), path))
}

/// A pencil along a path, pressed by at least a share between these.
pub(super) fn pressed(random: &mut Random, (pen, least): (f64, (f64, f64)), path: &Path) -> Vec<Touch> {
    let least = random.between(least.0, least.1);
    let waves = waves(random, path.is_closed());
    let lifted = random.chance(0.4) && !path.is_closed();
    let pressure = move |share: f64| {
        let lift = if lifted { (6.0 * (1.0 - share)).min(1.0) } else { 1.0 };
        (least + (1.0 - least) * waves(share)) * (0.7 + 0.3 * lift)
    };
    touches(path, |along| {
        let pressed = pressure(along.share);
        disc(along, pen * (0.75 + 0.25 * pressed), pressed)
    })
}

/// A figure of plain lines, each drawn by these touches instead.
fn each_line(
    random: &mut Random,
    hand: &Hand,
    mut drawn: impl FnMut(&mut Random, &Path) -> Vec<Touch>,
) -> Figure {
    let plain = if random.chance(LETTERS) { writing::word(random, hand) } else { super::lines(random, hand) };
    let mut figure = Figure::default();
    for stroke in plain.strokes {
        let touches = drawn(random, &stroke.path);
        let sum: f64 = touches.iter().map(|t| 2.0 * t.radius).sum();
        let pen = sum / touches.len().max(1) as f64;
        figure = figure.and(Figure::stroke(stroke.path, pen, [Ink::Touches(touches)]));
    }
    figure
}

fn disc(along: Along, width: f64, dark: f64) -> Touch {
    Touch { at: along.at, reach: Vec2::ZERO, radius: 0.5 * width, dark }
}

/// A smooth shape from 0 to 1 and back, once to thrice along a line; periodic where the line is closed.
fn waves(random: &mut Random, closed: bool) -> impl Fn(f64) -> f64 + use<> {
    let (turns, phase) = (random.whole(1, 3) as f64, random.angle());
    let turns = if closed { turns } else { turns * random.between(0.5, 1.0) };
    let (second, shift) = (random.between(0.0, 0.6), random.angle());
    let at = move |share: f64| {
        (TAU * turns * share + phase).sin() + second * (2.0 * TAU * turns * share + shift).sin()
    };
    let values = || (0..=64).map(|i| at(f64::from(i) / 64.0));
    let (low, high) = (values().fold(f64::MAX, f64::min), values().fold(f64::MIN, f64::max));
    move |share| ((at(share) - low) / (high - low)).clamp(0.0, 1.0)
}
