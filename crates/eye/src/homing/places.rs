//! Where dots are lit, one after the other, until one is seen.

use tracelight_rig::{Joint, PanTilt};
use tracelight_stroke::Point;

use crate::Driven;
use crate::homing::state::{Homing, anywhere};

/// From one dot to the next, as a share of what the camera sees: one of them at least falls well within it.
const STRIDE: f64 = 0.6;

impl<D: Driven> Homing<'_, D> {
    /// How far from where they were powered up joints must turn to have the camera see a dot, wherever in their ranges they were left, rad.
    pub(super) fn reach_rad(&self) -> PanTilt<(f64, f64)> {
        let [width, height] = self.camera.lens.size_px.map(|n| n as f64);
        let geometry = self.driving.machine.geometry;
        let middle = self.camera.target(Point::new(width / 2.0, height / 2.0));
        let facing = middle.and_then(|at| anywhere(&geometry).angles(&self.driving.pose, at).ok());
        let facing = facing.unwrap_or_default();
        PanTilt::from_fn(|j| {
            let (lower, upper) = geometry.range_rad[j];
            let facing = facing[j].clamp(lower, upper);
            (facing - upper, facing - lower)
        })
    }

    /// From one place to the next, so that one of them falls into what the camera sees, rad.
    pub(super) fn stride_rad(&self) -> PanTilt<f64> {
        let [width, height] = self.camera.lens.size_px.map(|n| n as f64);
        let geometry = anywhere(&self.driving.machine.geometry);
        let angles = |across: f64, down: f64| {
            let at = self.camera.target(Point::new(width * across, height * down))?;
            geometry.angles(&self.driving.pose, at).ok()
        };
        let between = |from: Option<PanTilt<f64>>, to: Option<PanTilt<f64>>, j: Joint| match (from, to) {
            (Some(from), Some(to)) => Some((from[j] - to[j]).abs()),
            _ => None,
        };
        // a camera that sees that little would see nothing of a head anyway
        const LEAST_RAD: f64 = 0.05;
        let pan = between(angles(0.1, 0.5), angles(0.9, 0.5), Joint::Pan);
        let tilt = between(angles(0.5, 0.1), angles(0.5, 0.9), Joint::Tilt);
        PanTilt::new(pan, tilt).map(|seen| (STRIDE * seen.unwrap_or(0.3)).max(LEAST_RAD))
    }
}

/// Places of both joints further and further from where they are, in rings, until one lies beyond `reach_rad` in either joint, rad.
pub(super) fn places(stride_rad: PanTilt<f64>, reach_rad: PanTilt<(f64, f64)>) -> Vec<PanTilt<f64>> {
    let steps = |j: Joint| {
        let (lower, upper) = reach_rad[j];
        (lower.abs().max(upper.abs()) / stride_rad[j]).ceil() as i32
    };
    let rings = steps(Joint::Pan).max(steps(Joint::Tilt)).clamp(0, 50);
    let mut all = vec![PanTilt::new(0.0, 0.0)];
    for ring in 1..=rings {
        // round from below right, so that one place is next to the one before it
        let side = (-ring..ring).collect::<Vec<i32>>();
        let corners = side
            .iter()
            .map(|k| (ring, *k))
            .chain(side.iter().map(|k| (-k, ring)))
            .chain(side.iter().map(|k| (-ring, -k)))
            .chain(side.iter().map(|k| (*k, -ring)));
        all.extend(corners.map(|(pan, tilt)| {
            PanTilt::new(f64::from(pan) * stride_rad.pan, f64::from(tilt) * stride_rad.tilt)
        }));
    }
    // what a dot shows reaches half a stride either way
    let reached = |place: &PanTilt<f64>| {
        Joint::BOTH.into_iter().all(|j| {
            let ((lower, upper), half) = (reach_rad[j], 0.5 * stride_rad[j]);
            (lower - half..=upper + half).contains(&place[j])
        })
    };
    all.retain(reached);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lie_in_rings_within_reach_and_none_is_far_from_one() {
        let range = PanTilt::new((-1.0, 1.0), (-0.5, 0.8));
        let stride = PanTilt::new(0.25, 0.2);
        let all = places(stride, range);
        let ring = |place: &PanTilt<f64>| (place.pan / 0.25).abs().max((place.tilt / 0.2).abs()).round();
        assert!(all.windows(2).all(|pair| ring(&pair[0]) <= ring(&pair[1])));
        assert_eq!(all[0], PanTilt::new(0.0, 0.0));
        // every place within reach is within half a stride of one
        for pan in -40..=40 {
            for tilt in -20..=32 {
                let at = PanTilt::new(f64::from(pan) * 0.025, f64::from(tilt) * 0.025);
                let near = |place: &PanTilt<f64>| {
                    (place.pan - at.pan).abs() <= 0.1251 && (place.tilt - at.tilt).abs() <= 0.1001
                };
                assert!(all.iter().any(near), "{at:?}");
            }
        }
        for pair in all.windows(2).filter(|pair| ring(&pair[0]) == ring(&pair[1])).take(20) {
            assert!((pair[0].pan - pair[1].pan).hypot(pair[0].tilt - pair[1].tilt) < 0.8, "{pair:?}");
        }
    }
}
