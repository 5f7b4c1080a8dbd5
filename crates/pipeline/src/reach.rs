//! Whether a drawing can be lit from where the head stands, and what would be.

use tracelight_aim::HeadPose;
use tracelight_maths::atan2;
use tracelight_stroke::{Point, Vec2};
use tracelight_task::Failure;
use tracelight_trajectory::{Machine, PlanError};

use crate::distance::DistanceFrom;
use crate::driving::Driving;
use crate::placed::Placed;
use crate::refused::refused;

/// Where a piece of a stroke is looked at, as shares of it.
pub(crate) const PLACES: [f64; 5] = [0.0, 1.0, 0.5, 0.25, 0.75];
/// Directions about a drawing's centre, in each of which its furthest point counts.
const DIRECTIONS: usize = 720;
/// Smallest width that is named, m.
const LEAST_WIDTH_M: f64 = 1e-3;
/// Largest distance that is named, m.
const MOST_DISTANCE_M: f64 = 1e3;

/// A look at a few places of every piece; planning looks at all of them.
///
/// # Errors
/// `unreachable`, with the largest width from here and the least distance for this one.
pub(crate) fn check_reach(placed: &Placed, driving: &Driving) -> Result<(), Failure> {
    for (index, stroke) in placed.drawing.strokes.iter().enumerate() {
        for piece in stroke.path.pieces() {
            for place in PLACES {
                let aimed = driving.machine.angles(piece.at(place));
                aimed.map_err(|source| {
                    let failure = refused(PlanError::Aim { stroke: index + 1, source });
                    Failure { message: failure.message.clone() + &ways_out(placed, driving), ..failure }
                })?;
            }
        }
    }
    Ok(())
}

/// The two numbers that work, in words; nothing of a head whose place a camera found, which no flag moves. Several marks tell the width: no other is
/// named then.
fn ways_out(placed: &Placed, driving: &Driving) -> String {
    if driving.asked.distance == DistanceFrom::Camera {
        return String::new();
    }
    let distance_m = driving.pose.distance_m;
    let reach = Reach::of(placed);
    let mut words = String::new();
    let is_sized_by_marks = placed.align.as_ref().is_some_and(|align| align.residual_mm.len() > 1);
    let width_m = reach.largest_width_m(placed.size_m.0, &driving.machine).filter(|_| !is_sized_by_marks);
    if let Some(width_m) = width_m {
        words += &format!("; from {} away up to --width {}", metres(distance_m), metres(width_m));
    }
    if let Some(least_m) = reach.least_distance_m(driving) {
        let how = if driving.asked.distance == DistanceFrom::File { "a distance of" } else { "--distance" };
        words += &format!("; for {} from {how} {}", metres(placed.size_m.0), metres(least_m));
    }
    words
}

fn metres(m: f64) -> String {
    format!("{}m", (1e3 * m).round() / 1e3)
}

/// How far a drawing reaches about its centre.
struct Reach {
    centre: Point,
    furthest: Vec<Vec2>,
}

impl Reach {
    fn of(placed: &Placed) -> Self {
        let centre = placed.centre();
        let mut furthest = vec![Vec2::ZERO; DIRECTIONS];
        for piece in placed.drawing.strokes.iter().flat_map(|stroke| stroke.path.pieces()) {
            for place in PLACES {
                let from = piece.at(place) - centre;
                let turns = 0.5 + atan2(from.y, from.x) / std::f64::consts::TAU;
                let kept = &mut furthest[(turns * DIRECTIONS as f64) as usize % DIRECTIONS];
                if from.hypot2() > kept.hypot2() {
                    *kept = from;
                }
            }
        }
        Self { centre, furthest }
    }

    /// Whether all of it, so many times as large, is within reach.
    fn is_in(&self, machine: &Machine, scale: f64) -> bool {
        self.furthest.iter().all(|&from| machine.angles(self.centre + scale * from).is_ok())
    }

    /// Rounded down to a hundredth of itself.
    fn largest_width_m(&self, width_m: f64, machine: &Machine) -> Option<f64> {
        let least = LEAST_WIDTH_M / width_m;
        let scale = boundary(least, 1.0, |scale| self.is_in(machine, scale))?;
        Some(rounded(scale * width_m, f64::floor)).filter(|m| *m >= LEAST_WIDTH_M)
    }

    /// Rounded up to a hundredth of itself.
    fn least_distance_m(&self, driving: &Driving) -> Option<f64> {
        let is_in =
            |m: f64| self.is_in(&driving.rig.machine(HeadPose { distance_m: m, ..driving.pose }), 1.0);
        let m = boundary(MOST_DISTANCE_M, driving.pose.distance_m, is_in)?;
        Some(rounded(m, f64::ceil)).filter(|m| *m <= MOST_DISTANCE_M)
    }
}

/// The last value on the way from one that is good to one that is not, both above zero; `None` where the first is not good.
fn boundary(good: f64, bad: f64, is_good: impl Fn(f64) -> bool) -> Option<f64> {
    const HALVINGS: usize = 30;
    if !is_good(good) {
        return None;
    }
    let (mut good, mut bad) = (good, bad);
    for _ in 0..HALVINGS {
        let middle = (good * bad).sqrt();
        if is_good(middle) { good = middle } else { bad = middle }
    }
    Some(good)
}

/// To three figures, but to whole millimetres.
fn rounded(m: f64, way: fn(f64) -> f64) -> f64 {
    const STEPS_M: [f64; 5] = [1e-3, 1e-2, 1e-1, 1.0, 10.0];
    let step_m = STEPS_M.into_iter().rev().find(|step| 100.0 * step <= m).unwrap_or(1e-3);
    way(m / step_m) * step_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_named_is_rounded_to_the_side_that_works() {
        for (m, down, up) in
            [(0.0257, 0.025, 0.026), (1.2345, 1.23, 1.24), (10.38, 10.3, 10.4), (999.9, 999.0, 1000.0)]
        {
            assert!((rounded(m, f64::floor) - down).abs() < 1e-9, "{m}");
            assert!((rounded(m, f64::ceil) - up).abs() < 1e-9, "{m}");
        }
        assert_eq!([metres(rounded(8.6249, f64::floor)), metres(2.77)], ["8.62m", "2.77m"]);
    }

    #[test]
    fn a_boundary_is_found_from_either_side_and_not_where_nothing_is_good() {
        assert!((boundary(1.0, 1000.0, |x| x < 7.0).unwrap() - 7.0).abs() < 1e-5);
        assert!((boundary(1000.0, 1.0, |x| x > 7.0).unwrap() - 7.0).abs() < 1e-5);
        assert_eq!(boundary(1.0, 2.0, |_| false), None);
    }
}
