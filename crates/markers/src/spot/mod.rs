//! Detects the laser spot from an image with light and one without.
//!
//! Of the difference of two images a window about where the spot is awaited is looked at, in light: lamps and the drawing are in both and
//! fall away. A round spot is placed by the bell of light that fits best, over what was not full; a streak, which a moving spot leaves, by the
//! middle of its light, where the spot was in the middle of the exposure.

mod bell;
mod change;
mod found;
mod window;

use tracelight_image::Grey;
use tracelight_stroke::Vec2;

use crate::error::SpotLost;
use bell::Bell;
use change::Change;
pub use found::Spot;
pub use window::SpotWindow;

/// By how many deviations of the noise a spot stands out.
const STANDS_OUT: f64 = 6.0;
/// Share of its brightest light down to which light is the spot's.
const LEAST_SHARE: f64 = 0.2;
/// By how many times what is left over where pixels were smoothed is smaller than what they are off.
const SMOOTHED_SHARES: f64 = 2.0;

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
        false => {
            let smooth = change.smoothed(bell.surroundings(&change));
            bell.fitted(&smooth, noise, SMOOTHED_SHARES).map(Spot::as_unsmoothed)
        }
        true => bell.fitted(&change, noise, 1.0),
    };
    Ok(fitted.unwrap_or_else(|| bell.spot(&change, Vec2::ZERO, noise)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_stroke::Point;

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
