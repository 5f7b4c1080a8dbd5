//! Fits a bell-shaped light distribution to a round spot.

use std::ops::Range;

use tracelight_image::solve::linear;
use tracelight_image::{Plane, long_axis};
use tracelight_maths::{exp, hypot};
use tracelight_stroke::{Point, Vec2};

use super::change::{Change, Patch};
use super::found::Spot;

/// How many times as long as wide a streak is.
const LONG: f64 = 1.5;
/// Most steps of the fit: three or four, and some more where a spot is clipped.
const STEPS: usize = 20;
/// A step so short, px, is the last: the next would be much shorter.
const NEAR_PX: f64 = 1e-3;
/// What the middle of light on pixels is off by, as a share of its width, however little noise there is.
const UNEVEN: f64 = 0.03;
/// How far beyond a spot pixels are smoothed, px: the fit may make it some wider, and moves it.
const SMOOTHED_PX: f64 = 2.0;

/// A bell of light: brightness · exp(−½ dᵀ S⁻¹ d) on a floor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bell {
    at: Point,
    brightness: f64,
    floor: f64,
    /// Covariance of its light: across, across by down, down, px².
    spread: [f64; 3],
    clipped: usize,
}

impl Bell {
    /// By the moments of a patch.
    pub(super) fn rough(change: &Change, patch: &Patch) -> Self {
        let (mut mass, mut moment, mut brightness) = (0.0, Vec2::ZERO, 0.0_f64);
        let weight = |cell: usize| f64::from(change.light.values[cell]).max(0.0);
        for &cell in &patch.cells {
            mass += weight(cell);
            moment += change.place(cell).to_vec2() * weight(cell);
            brightness = brightness.max(weight(cell));
        }
        let at = (moment / mass.max(1e-12)).to_point();
        let mut spread = [0.0; 3];
        for &cell in &patch.cells {
            let (off, share) = (change.place(cell) - at, weight(cell) / mass.max(1e-12));
            let terms = [off.x * off.x, off.x * off.y, off.y * off.y];
            spread.iter_mut().zip(terms).for_each(|(sum, term)| *sum += share * term);
        }
        let clipped = patch.cells.iter().filter(|&&cell| change.full[cell]).count();
        // no spot is narrower than its pixel
        let spread = [spread[0].max(0.1), spread[1], spread[2].max(0.1)];
        Self { at, brightness, floor: 0.0, spread, clipped }
    }

    /// Variances along and across its long axis, and that axis.
    fn axes(&self) -> (f64, f64, Vec2) {
        let [a, b, c] = self.spread;
        let (middle, half) = (0.5 * (a + c), 0.5 * hypot(a - c, 2.0 * b));
        (middle + half, (middle - half).max(0.05), long_axis(self.spread))
    }

    /// From one end of a streak to the other; nothing of a round spot. Even light on a length has a twelfth of its square as variance.
    pub(super) fn streak(&self) -> Vec2 {
        let (long, wide, along) = self.axes();
        if long > LONG * LONG * wide { along * (12.0 * (long - wide)).sqrt() } else { Vec2::ZERO }
    }

    /// As it stands, by its light's middle.
    pub(super) fn spot(&self, change: &Change, streak: Vec2, noise: f64) -> Spot {
        let (long, wide, _) = self.axes();
        let cells = std::f64::consts::TAU * (long * wide).sqrt() * 2.0;
        let mass = (self.brightness * cells / 2.0).max(1e-12);
        Spot {
            at: self.at,
            deviation_px: (noise * (cells * long).sqrt() / mass)
                .max(UNEVEN * wide.sqrt())
                .min(change.light.width as f64),
            radius_px: wide.sqrt(),
            streak,
            brightness: self.brightness,
            clipped: self.clipped,
        }
    }

    /// The bell that fits best over what is not full: Gauss and Newton's method, each pixel by its noise, of which the light has a share
    /// (speckle, shot noise). `None` if it is lost.
    /// `shares` says by how many times what is left over is smaller than it would be of pixels each by itself.
    pub(super) fn fitted(&self, change: &Change, noise: f64, shares: f64) -> Option<Spot> {
        let mut bell = *self;
        let mut left = None;
        for _ in 0..STEPS {
            let (next, fit) = bell.nearer(change, noise)?;
            let (_, wide, _) = next.axes();
            if !(next.at.distance(self.at) < 3.0 && wide < 400.0 && next.brightness > 0.0) {
                return None;
            }
            let moved = next.at.distance(bell.at);
            (bell, left) = (next, Some(fit));
            if moved < NEAR_PX {
                break;
            }
        }
        let (long, wide, _) = bell.axes();
        Some(Spot {
            at: bell.at,
            deviation_px: shares * left?,
            radius_px: (long * wide).sqrt().sqrt(),
            streak: Vec2::ZERO,
            brightness: bell.brightness,
            clipped: bell.clipped,
        })
    }

    /// Columns and rows of what was changed that its light reaches, smoothed, if a fit moves it some.
    pub(super) fn surroundings(&self, change: &Change) -> (Range<usize>, Range<usize>) {
        self.reach(change, SMOOTHED_PX)
    }

    /// Columns and rows of what was changed on which its light is, and some more around, px.
    fn reach(&self, change: &Change, more_px: f64) -> (Range<usize>, Range<usize>) {
        let (long, _, _) = self.axes();
        let reach = 3.5 * long.sqrt() + 1.0 + more_px;
        let range = |at: f64, first: usize, size: usize| {
            let low = (at - reach - first as f64).max(0.0) as usize;
            low.min(size)..((at + reach - first as f64).max(0.0).ceil() as usize).min(size)
        };
        let Plane { width, height, .. } = change.light;
        (range(self.at.x, change.left, width), range(self.at.y, change.top, height))
    }

    /// Whether a pixel is full that its light, smoothed, would reach.
    pub(super) fn is_near_full(&self, change: &Change) -> bool {
        let (columns, rows) = self.reach(change, SMOOTHED_PX + 1.0);
        let width = change.light.width;
        let mut cells = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
        cells.any(|cell| change.full[cell])
    }

    /// A step, and the standard deviation of the place as what is left over tells it.
    fn nearer(&self, change: &Change, noise: f64) -> Option<(Self, f64)> {
        /// Share of the light that is noise of its own.
        const OWN: f64 = 0.1;
        let [a, b, c] = self.spread;
        let det = a * c - b * b;
        let (ia, ib, ic) = (c / det, -b / det, a / det);
        let (columns, rows) = self.reach(change, 0.0);
        let (mut normal, mut squares, mut count) = ([[0.0; 8]; 7], 0.0, 0.0);
        for y in rows {
            for x in columns.clone() {
                let cell = y * change.light.width + x;
                let off = change.place(cell) - self.at;
                let (u, v) = (ia * off.x + ib * off.y, ib * off.x + ic * off.y);
                let bell = exp(-0.5 * (u * off.x + v * off.y));
                let light = self.brightness * bell;
                let told = light + self.floor;
                // what is full is at least that bright, and says no more
                if change.full[cell] {
                    continue;
                }
                let own = OWN * light;
                let weight = 1.0 / (noise * noise + own * own + 1e-9);
                let residual = f64::from(change.light.values[cell]) - told;
                let terms = [
                    light * u,
                    light * v,
                    bell,
                    1.0,
                    0.5 * light * u * u,
                    light * u * v,
                    0.5 * light * v * v,
                    residual,
                ];
                for (k, row) in normal.iter_mut().enumerate() {
                    let factor = weight * terms[k];
                    row[k..].iter_mut().zip(&terms[k..]).for_each(|(sum, term)| *sum += factor * term);
                }
                (squares, count) = (squares + weight * residual * residual, count + 1.0);
            }
        }
        if count < 12.0 {
            return None;
        }
        for k in 1..normal.len() {
            let (above, row) = normal.split_at_mut(k);
            above.iter().enumerate().for_each(|(j, above)| row[0][j] = above[k]);
        }
        let step = linear(normal)?;
        // variance of the place, as if the other parameters were known: they hardly share with it in a round spot
        let variance = squares / (count - 7.0) * 0.5 * (1.0 / normal[0][0] + 1.0 / normal[1][1]);
        // of a spot that is clipped the first guess is far too dim and wide: by half at most in a step
        let near = |old: f64, by: f64| (old + by).clamp(old / 1.6, 1.6 * old);
        let next = Self {
            at: self.at + Vec2::new(step[0].clamp(-1.0, 1.0), step[1].clamp(-1.0, 1.0)),
            brightness: near(self.brightness, step[2]),
            floor: self.floor + step[3],
            spread: [near(a, step[4]).max(0.05), b + step[5], near(c, step[6]).max(0.05)],
            clipped: self.clipped,
        };
        let whole = next.spread[0] * next.spread[2] > next.spread[1] * next.spread[1];
        whole.then_some((next, variance.sqrt()))
    }
}
