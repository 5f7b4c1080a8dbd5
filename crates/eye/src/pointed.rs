//! A simulated person points a simulated head's dot at the corners of a rectangle.

use tracelight_aim::{HeadPose, POINTED_M, corners_of};
use tracelight_rig::PanTilt;
use tracelight_sim::RigConfig;
use tracelight_stroke::{Point, Vec2};
use tracelight_task::Failure;

/// Poses that are drawn until the head reaches all corners.
const MOST_DRAWS: usize = 100;

/// What somebody pointed at, and what nobody but a simulation knows.
#[derive(Clone, Copy, Debug)]
pub struct Pointed {
    /// Joint angles by the encoders, whole counts, rad: bottom left, bottom right, top right, top left.
    pub angles: [PanTilt<f64>; 4],
    /// Where the head truly stands.
    pub truth: HeadPose,
}

/// Puts a head up somewhere before a rectangle of a size, and points at its corners by eye.
///
/// # Errors
/// `unreachable`: from nowhere does the head reach all corners.
pub fn pointed(rig: &RigConfig, size_m: (f64, f64), seed: u64) -> Result<Pointed, Failure> {
    let mut dice = oorandom::Rand64::new(u128::from(seed));
    let count_rad = rig.model.encoder.count_rad();
    let counted = |angle: PanTilt<f64>| PanTilt::from_fn(|j| (angle[j] / count_rad).round() * count_rad);
    for _ in 0..MOST_DRAWS {
        let truth = somewhere(size_m, &mut dice);
        let aimed = corners_of(size_m).map(|corner| {
            let off = Vec2::new(by_eye(&mut dice), by_eye(&mut dice));
            rig.truth.model.geometry.angles(&truth, corner + off).map(counted).ok()
        });
        if let [Some(a), Some(b), Some(c), Some(d)] = aimed {
            return Ok(Pointed { angles: [a, b, c, d], truth });
        }
    }
    let message =
        "the simulated head reaches the corners of this rectangle from nowhere: its joints turn too little";
    Err(Failure::failed("unreachable", message))
}

/// How far from a corner somebody points, m: even draws of the standard deviation that is taken of people.
fn by_eye(dice: &mut oorandom::Rand64) -> f64 {
    even(dice, 3_f64.sqrt() * POINTED_M)
}

fn even(dice: &mut oorandom::Rand64, most: f64) -> f64 {
    most * (2.0 * dice.rand_float() - 1.0)
}

/// About as far away as the rectangle is wide, a quarter of its size beside its middle, turned by some degrees.
fn somewhere((width, height): (f64, f64), dice: &mut oorandom::Rand64) -> HeadPose {
    let size = width.max(height);
    HeadPose {
        distance_m: size * (1.1 + even(dice, 0.3)),
        right_m: even(dice, 0.25 * width),
        up_m: even(dice, 0.25 * height),
        yaw_rad: even(dice, 0.2),
        pitch_rad: even(dice, 0.1),
        roll_rad: even(dice, 0.05),
    }
}

/// How far the spot of a head that is believed to stand somewhere is off within a rectangle, m: root mean square and largest.
#[must_use]
pub fn off_m(rig: &RigConfig, size_m: (f64, f64), believed: &HeadPose, truth: &HeadPose) -> (f64, f64) {
    const STEPS: i32 = 8;
    let mut squares = Vec::new();
    for i in 0..=STEPS {
        for j in 0..=STEPS {
            let share = |k: i32| f64::from(k) / f64::from(STEPS) - 0.5;
            let at = Point::new(share(i) * size_m.0, share(j) * size_m.1);
            let spot = rig.model.geometry.angles(believed, at).ok();
            let spot = spot.and_then(|angle| rig.truth.model.geometry.spot(truth, angle));
            squares.push(spot.map_or(f64::INFINITY, |spot| spot.distance_squared(at)));
        }
    }
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (mean.sqrt(), squares.into_iter().fold(0.0, f64::max).sqrt())
}
