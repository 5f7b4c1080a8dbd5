//! From how far a drawing is drawn, who says so, and from how far it is best drawn.

use serde::Serialize;
use tracelight_aim::HeadPose;
use tracelight_maths::{atan, cos, hypot, tan};
use tracelight_stroke::{Drawing, Point};

use crate::distance::DistanceFrom;
use crate::driving::Driving;
use crate::reach::PLACES;
use crate::rounded::rounded;

/// Largest angle between the beam and the wall's normal at which drawing is comfortable, rad: the spot is a sixth longer than wide.
const COMFORTABLE_RAD: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// Nobody puts a head nearer to a wall, m, however small the drawing is.
const NEAREST_M: f64 = 0.3;

/// A laser pointer's beam where it leaves, m.
const BEAM_M: f64 = 2e-3;

/// By how much that widens, rad: what pointers have, by their data sheets.
const DIVERGENCE_RAD: f64 = 1e-3;

/// How a head stands to a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Standing {
    /// From the head to the wall, m.
    pub distance_m: f64,
    /// Who says so.
    pub from: DistanceFrom,
    /// Largest angle between the beam and the wall's normal, degrees.
    pub largest_angle_deg: f64,
    /// Diameter of a laser pointer's spot straight ahead, mm.
    pub spot_mm: f64,
    /// Its longest diameter, where it meets the wall at the largest angle, mm.
    pub longest_spot_mm: f64,
    /// The distance from which the drawing is best drawn, m: the nearest from which no part of it is further than 30° from the wall's normal.
    pub best_distance_m: f64,
}

/// Radius of a laser pointer's spot at a distance, m.
#[must_use]
pub fn spot_radius_m(distance_m: f64) -> f64 {
    0.5 * (BEAM_M + DIVERGENCE_RAD * distance_m)
}

impl Standing {
    /// Of a drawing on the target.
    #[must_use]
    pub fn of(drawing: &Drawing, driving: &Driving) -> Self {
        let HeadPose { distance_m, right_m, up_m, .. } = driving.pose;
        let foot = Point::new(right_m, up_m);
        let places = drawing.strokes.iter().flat_map(|stroke| stroke.path.pieces());
        let far_m = places
            .flat_map(|piece| PLACES.map(|share| piece.at(share).distance(foot)))
            .filter(|far_m| far_m.is_finite())
            .fold(0.0, f64::max);
        let angle_rad = atan(far_m / distance_m);
        let spot_m = |way_m: f64| 2.0 * spot_radius_m(way_m);
        Self {
            distance_m: rounded(distance_m),
            from: driving.asked.distance,
            largest_angle_deg: rounded(angle_rad.to_degrees()),
            spot_mm: rounded(1e3 * spot_m(distance_m)),
            longest_spot_mm: rounded(1e3 * spot_m(hypot(distance_m, far_m)) / cos(angle_rad)),
            best_distance_m: up_to_centimetres((far_m / tan(COMFORTABLE_RAD)).max(NEAREST_M)),
        }
    }

    /// In words: one line.
    #[must_use]
    pub fn words(&self) -> String {
        let who = self.from.words();
        format!(
            "{:.3} m from the wall ({who}), beam up to {:.0}° from square; a pointer's spot {:.1} to {:.1} mm; best from {:.2} m",
            self.distance_m, self.largest_angle_deg, self.spot_mm, self.longest_spot_mm, self.best_distance_m
        )
    }
}

fn up_to_centimetres(m: f64) -> f64 {
    (1e2 * m - 1e-6).ceil() / 1e2
}

#[cfg(test)]
mod tests {
    use tracelight_sim::RigConfig;
    use tracelight_stroke::{Path, Stroke};

    use super::*;
    use crate::driving::{Asked, request_of};

    #[test]
    fn the_best_distance_is_the_nearest_at_which_the_beam_stays_within_30_degrees() {
        let line = Path::polyline(&[Point::new(-1.8, 0.0), Point::new(1.0, 0.0)], false).unwrap();
        let drawing = Drawing { strokes: vec![Stroke::new(line)] };
        let from = |distance_m: f64| {
            let rig = RigConfig::report();
            let request = request_of(&rig);
            let driving = Driving::new(rig, HeadPose::square_on(distance_m), request, Asked::default());
            Standing::of(&drawing, &driving)
        };
        let near = from(0.9144);
        assert!((near.largest_angle_deg - 63.07).abs() < 0.01, "{near:?}");
        assert_eq!(near.from, DistanceFrom::Assumed);
        let best = from(near.best_distance_m);
        assert!((29.9..=30.0).contains(&best.largest_angle_deg), "{best:?}");
        assert_eq!(best.best_distance_m, near.best_distance_m);
        // 3.6 m of way widen the beam to 5.6 mm, and a slant of 30° stretches that
        assert!((best.longest_spot_mm - 5.6 / cos(30_f64.to_radians())).abs() < 0.02, "{best:?}");
    }
}
