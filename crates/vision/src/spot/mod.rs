//! The laser's spot: what is brighter where it is on than where it is off.
//!
//! Of the difference of two images a window about where the spot is awaited is looked at, in light: lamps and the drawing are in both and
//! fall away. A round spot is placed by the bell of light that fits best, over what was not full; a streak, which a moving spot leaves, by the
//! middle of its light, where the spot was in the middle of the exposure.

mod change;

use std::ops::Range;

use tracelight_image::solve::linear;
use tracelight_image::{Grey, Plane, long_axis};
use tracelight_stroke::{Point, Vec2};

use change::{Change, Patch};

/// Where a spot is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotWindow {
    /// Its middle, px.
    pub centre: Point,
    /// Half of its side, px.
    pub half_px: usize,
}

/// A spot that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Its middle, pixel frame.
    pub at: Point,
    /// Standard deviation of either coordinate by what the fit leaves over, px.
    pub deviation_px: f64,
    /// Standard deviation of its light across, px: of a streak, beside it.
    pub radius_px: f64,
    /// From one end of its streak to the other, px; next to nothing of a spot at rest. Which end came first one image does not tell.
    pub streak: Vec2,
    /// Light in its middle above its surroundings, as a share of the brightest there can be; more than 1 of one that is clipped.
    pub brightness: f64,
    /// Pixels of it that were full.
    pub clipped: usize,
}

/// Why no spot is found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SpotLost {
    /// The images are not of one size.
    #[error("images of {} × {} and of {} × {} px can not be held against each other", .lit.0, .lit.1, .dark.0, .dark.1)]
    Sizes {
        /// Width and height of the image with the spot.
        lit: (usize, usize),
        /// Of the one without.
        dark: (usize, usize),
    },
    /// Too little of the window is in the image.
    #[error("the spot is awaited at ({:.0}, {:.0}) px, out of the camera's sight", .0.x, .0.y)]
    OutOfSight(Point),
    /// Nothing stands out.
    #[error(
        "no spot: the brightest change is {change:.2} % of full light, and {least:.2} % stand out from the noise; more light or a longer exposure helps"
    )]
    Dim {
        /// The brightest change, %.
        change: f64,
        /// What would stand out, %.
        least: f64,
    },
    /// It reaches beyond the window.
    #[error("the spot at ({:.1}, {:.1}) px reaches beyond where it is looked for; look in a larger window", .0.x, .0.y)]
    Cut(Point),
}

/// By how many deviations of the noise a spot stands out.
const STANDS_OUT: f64 = 6.0;
/// Share of its brightest light down to which light is the spot's.
const LEAST_SHARE: f64 = 0.2;
/// How many times as long as wide a streak is.
const LONG: f64 = 1.5;
/// Most steps of the fit: three or four, and some more where a spot is clipped.
const STEPS: usize = 20;
/// A step so short, px, is the last: the next would be much shorter.
const NEAR_PX: f64 = 1e-3;
/// By how many times what is left over where pixels were smoothed is smaller than what they are off.
const SMOOTHED_SHARES: f64 = 2.0;
/// What the middle of light on pixels is off by, as a share of its width, however little noise there is.
const UNEVEN: f64 = 0.03;

/// Finds the spot in a window.
///
/// # Errors
/// See [`SpotLost`].
pub fn find_spot(lit: &Grey, dark: &Grey, window: &SpotWindow) -> Result<Spot, SpotLost> {
    let size = |image: &Grey| (image.width(), image.height());
    if size(lit) != size(dark) {
        return Err(SpotLost::Sizes { lit: size(lit), dark: size(dark) });
    }
    let change = Change::of(lit.plane(), dark.plane(), window).ok_or(SpotLost::OutOfSight(window.centre))?;
    let noise = change.noise();
    let (peak, most) = change.peak();
    // a mean of nine is a third as noisy; and eight bits are never better than a tenth of a level
    let least = STANDS_OUT * (noise / 3.0).max(1e-4);
    if most < least {
        return Err(SpotLost::Dim { change: 100.0 * most, least: 100.0 * least });
    }
    let patch = change.patch(peak, (LEAST_SHARE * most).max(2.0 * noise / 3.0));
    if patch.touches_border {
        return Err(SpotLost::Cut(change.place(peak)));
    }
    let bell = Bell::rough(&change, &patch);
    let streak = bell.streak();
    if streak != Vec2::ZERO {
        return Ok(bell.spot(&change, streak, noise));
    }
    // beside a full pixel, the spot's or a lamp's, there is nothing to smooth with
    let fitted = match bell.is_near_full(&change) {
        false => bell.fitted(&change.smoothed(&bell), noise, SMOOTHED_SHARES).map(Spot::as_unsmoothed),
        true => bell.fitted(&change, noise, 1.0),
    };
    Ok(fitted.unwrap_or_else(|| bell.spot(&change, Vec2::ZERO, noise)))
}

impl Spot {
    /// Of one whose pixels were smoothed ([`Change::smoothed`]), which adds half a pixel to its variances and spreads its light.
    fn as_unsmoothed(self) -> Self {
        let smooth = self.radius_px * self.radius_px;
        let own = (smooth - 0.5).max(0.1);
        Self { radius_px: own.sqrt(), brightness: self.brightness * smooth / own, ..self }
    }
}

/// A bell of light: brightness · exp(−½ dᵀ S⁻¹ d) on a floor.
#[derive(Clone, Copy, Debug)]
struct Bell {
    at: Point,
    brightness: f64,
    floor: f64,
    /// Covariance of its light: across, across by down, down, px².
    spread: [f64; 3],
    clipped: usize,
}

impl Bell {
    /// By the moments of a patch.
    fn rough(change: &Change, patch: &Patch) -> Self {
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
        let (middle, half) = (0.5 * (a + c), 0.5 * (a - c).hypot(2.0 * b));
        (middle + half, (middle - half).max(0.05), long_axis(self.spread))
    }

    /// From one end of a streak to the other; nothing of a round spot. Even light on a length has a twelfth of its square as variance.
    fn streak(&self) -> Vec2 {
        let (long, wide, along) = self.axes();
        if long > LONG * LONG * wide { along * (12.0 * (long - wide)).sqrt() } else { Vec2::ZERO }
    }

    /// As it stands, by its light's middle.
    fn spot(&self, change: &Change, streak: Vec2, noise: f64) -> Spot {
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
    fn fitted(&self, change: &Change, noise: f64, shares: f64) -> Option<Spot> {
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
    fn is_near_full(&self, change: &Change) -> bool {
        let (columns, rows) = self.reach(change, change::SMOOTHED_PX + 1.0);
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
                let bell = (-0.5 * (u * off.x + v * off.y)).exp();
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

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 160;

    /// A wall with a lamp's reflection and a drawing on it, and light added to it, in levels.
    fn image(added: impl Fn(Point) -> f64, noise: f64, seed: u128) -> Grey {
        let mut dice = oorandom::Rand64::new(seed);
        let level = |i: usize| {
            let at = Point::new((i % SIZE) as f64 + 0.5, (i / SIZE) as f64 + 0.5);
            let lamp = 2.0 * (-0.5 * at.distance_squared(Point::new(40.0, 40.0)) / 100.0).exp();
            let line = if (at.y - 90.0).abs() < 2.0 { 0.3 } else { 1.0 };
            let wall = 0.1 * line * (0.5 + at.x / SIZE as f64);
            let mut normal = || (0..12).map(|_| dice.rand_float()).sum::<f64>() - 6.0;
            (255.0 * (wall + lamp + added(at)).min(1.0).powf(1.0 / 2.2) + noise * normal())
                .round()
                .clamp(0.0, 255.0) as u8
        };
        Grey::new(SIZE, SIZE, (0..SIZE * SIZE).map(level).collect()).unwrap()
    }

    fn round(at: Point, brightness: f64, radius_px: f64) -> impl Fn(Point) -> f64 {
        move |p| brightness * (-0.5 * p.distance_squared(at) / (radius_px * radius_px)).exp()
    }

    fn window(at: Point) -> SpotWindow {
        SpotWindow { centre: at + Vec2::new(6.0, -9.0), half_px: 32 }
    }

    #[test]
    fn a_round_spot_is_found_to_a_few_hundredths_of_a_pixel() {
        let dark = image(|_| 0.0, 1.0, 1);
        for (brightness, bound_px, clipped) in [(0.5, 0.03, false), (0.05, 0.2, false), (4.0, 0.06, true)] {
            for seed in 0..20 {
                let at = Point::new(100.0 + 0.13 * seed as f64, 89.0 - 0.21 * seed as f64);
                let lit = image(round(at, brightness, 2.0), 1.0, 100 + seed);
                let spot = find_spot(&lit, &dark, &window(at)).unwrap();
                assert!(
                    spot.at.distance(at) < bound_px,
                    "{brightness}: {} is {} px off",
                    spot.at,
                    spot.at.distance(at)
                );
                assert!((spot.radius_px / 2.0 - 1.0).abs() < 0.2 && spot.streak == Vec2::ZERO, "{spot:?}");
                assert_eq!(spot.clipped > 0, clipped);
                assert!(
                    spot.deviation_px > 0.2 * spot.at.distance(at) && spot.deviation_px < bound_px,
                    "{spot:?}"
                );
            }
        }
    }

    #[test]
    fn a_streak_is_found_by_its_middle_and_how_it_lies() {
        let (from, to) = (Point::new(84.0, 70.0), Point::new(100.0, 82.0));
        let streak = move |p: Point| {
            (0..60).map(|k| round(from.lerp(to, (f64::from(k) + 0.5) / 60.0), 0.02, 1.5)(p)).sum::<f64>()
        };
        let spot =
            find_spot(&image(streak, 1.0, 5), &image(|_| 0.0, 1.0, 6), &window(from.midpoint(to))).unwrap();
        assert!(spot.at.distance(from.midpoint(to)) < 0.2, "{spot:?}");
        let along = if spot.streak.x < 0.0 { -spot.streak } else { spot.streak };
        assert!((along - (to - from)).hypot() < 2.0, "{along}");
    }

    #[test]
    fn a_spot_that_is_not_there_is_lost_and_why() {
        let (dark, again) = (image(|_| 0.0, 2.0, 1), image(|_| 0.0, 2.0, 2));
        let at = Point::new(100.0, 70.0);
        assert!(matches!(find_spot(&again, &dark, &window(at)), Err(SpotLost::Dim { .. })));
        // under the lamp all pixels are full
        let under = image(round(Point::new(40.0, 40.0), 1.0, 2.0), 2.0, 3);
        assert!(matches!(
            find_spot(&under, &dark, &SpotWindow { centre: Point::new(40.0, 40.0), half_px: 6 }),
            Err(SpotLost::Dim { .. })
        ));
        let lit = image(round(at, 0.5, 2.0), 2.0, 3);
        let beside = SpotWindow { centre: at + Vec2::new(31.0, 0.0), half_px: 30 };
        assert!(matches!(find_spot(&lit, &dark, &beside), Err(SpotLost::Cut(_))));
        for centre in [Point::new(-200.0, 3.0), Point::new(f64::NAN, 3.0), Point::new(1e300, 3.0)] {
            let window = SpotWindow { centre, half_px: 20 };
            assert!(matches!(find_spot(&lit, &dark, &window), Err(SpotLost::OutOfSight(_))));
        }
        let small = Grey::new(16, 16, vec![0; 256]).unwrap();
        assert!(matches!(find_spot(&lit, &small, &window(at)), Err(SpotLost::Sizes { .. })));
        assert!(
            find_spot(&small, &small, &SpotWindow { centre: Point::new(8.0, 8.0), half_px: 400 }).is_err()
        );
    }
}
