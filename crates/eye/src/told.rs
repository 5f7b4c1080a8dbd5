//! A head found from dots, as it is told.

use serde_json::json;
use tracelight_aim::HeadPose;
use tracelight_rig::PanTilt;
use tracelight_stroke::Point;

use crate::head::FoundHead;
use crate::wall::SeenWall;

/// What is told of a head that was found before a wall; `truth` is by how much its spot is off in a simulated room, m: rms, and at most.
#[must_use]
pub fn text(wall: &SeenWall, found: &FoundHead, truth: Option<(f64, f64)>) -> String {
    let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = found.aligned.alignment.pose;
    let built = &found.aligned.alignment.geometry;
    let [_, left, up] = built.laser_offset_m.map(|m| 1e3 * m);
    let middle = wall.camera.camera.lens.size_px.map(|n| n as f64 / 2.0);
    let likely = wall.camera.camera.target(Point::new(middle[0], middle[1])).and_then(|at| {
        let angle = built.angles(&found.aligned.alignment.pose, at).ok()?;
        found.aligned.deviation_m(angle)
    });
    let likely = likely
        .map_or_else(String::new, |m| format!("; in the middle the spot is known to {:.2} mm", 1e3 * m));
    let simulated = truth.map_or_else(String::new, |(rms, most)| {
        format!("\ntruth:    the spot is off by {:.3} mm rms, {:.3} mm at most over the picture (known because the room is simulated)", 1e3 * rms, 1e3 * most)
    });
    format!(
        "wall:     {}\n\
         stands:   {distance_m:.4} m before the wall, ({right_m:.4}, {up_m:.4}) m from the middle of the first page; turned {}, {}, {:+.2}° about the beam\n\
         built:    the beam leaves {} of and {} the axes, points {} and {}; the axes are {:+.2}° from square\n\
         images:   taken {} than stamped, the last row {:.1} ms later still\n\
         dots:     {}, seen in {} images, in {} not; {:.3} mm off, rms{likely}{simulated}",
        wall.words(),
        degrees(yaw_rad, "left", "right"),
        degrees(pitch_rad, "down", "up"),
        roll_rad.to_degrees(),
        toward(left, 1, " mm", "left", "right"),
        toward(up, 1, " mm", "above", "below"),
        degrees(built.beam_off_rad[0], "left", "right"),
        degrees(built.beam_off_rad[1], "down", "up"),
        built.axis_skew_rad.to_degrees(),
        toward(1e3 * found.timing.late_s, 1, " ms", "later", "earlier"),
        1e3 * found.timing.readout_s,
        found.dots,
        found.aligned.spots,
        found.lost,
        1e3 * found.aligned.rms_m,
    )
}

/// A signed number as one without a sign, and which way it goes.
pub(crate) fn toward(value: f64, decimals: usize, unit: &str, more: &str, less: &str) -> String {
    format!("{:.decimals$}{unit} {}", value.abs(), if value < 0.0 { less } else { more })
}

pub(crate) fn degrees(angle_rad: f64, more: &str, less: &str) -> String {
    toward(angle_rad.to_degrees(), 2, "°", more, less)
}

/// Where a head stands, for scripts.
pub(crate) fn pose(pose: &HeadPose) -> serde_json::Value {
    let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = *pose;
    json!({
        "distance_m": distance_m, "right_m": right_m, "up_m": up_m, "yaw_rad": yaw_rad, "pitch_rad": pitch_rad, "roll_rad": roll_rad,
    })
}

/// Figures of a head that was found, for scripts.
#[must_use]
pub fn json(found: &FoundHead, truth: Option<(f64, f64)>) -> serde_json::Value {
    let built = &found.aligned.alignment.geometry;
    let at_zero = found.aligned.deviation_m(PanTilt::default()).map(|m| 1e3 * m);
    let mut object = json!({
        "pose": pose(&found.aligned.alignment.pose),
        "built": {"laser_offset_m": built.laser_offset_m, "beam_off_rad": built.beam_off_rad, "axis_skew_rad": built.axis_skew_rad},
        "images": {"late_s": found.timing.late_s, "readout_s": found.timing.readout_s, "exposure_s": found.exposure_s},
        "dots": found.dots,
        "spots": found.aligned.spots,
        "outliers": found.aligned.outliers,
        "lost": found.lost,
        "rms_mm": 1e3 * found.aligned.rms_m,
        "straight_ahead_mm": at_zero,
    });
    if let Some((rms, most)) = truth {
        object["truth_mm"] = json!({"rms": 1e3 * rms, "max": 1e3 * most});
    }
    object
}
