//! What is known of a head in front of a wall, as a file.

use serde::{Deserialize, Serialize};
use tracelight_aim::{Alignment, HeadGeometry, HeadPose, PlacedPage};

use crate::cli::driving::Driving;
use crate::eye::head::FoundHead;
use crate::eye::spots::Timing;
use crate::failure::Failure;
use crate::picture::read_bytes;

/// Largest head file, bytes.
const MOST_BYTES: usize = 1 << 16;

/// A head file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct HeadFile {
    /// Day it was found, as 2026-11-23.
    date: String,
    /// Name of the rig.
    rig: String,
    /// The page whose frame the wall's is: fine or coarse, from 1.
    board: String,
    page: u16,
    pose: PoseTable,
    built: BuiltTable,
    images: ImagesTable,
    score: ScoreTable,
}

/// target_from_head.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseTable {
    distance_m: f64,
    right_m: f64,
    up_m: f64,
    yaw_rad: f64,
    pitch_rad: f64,
    roll_rad: f64,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BuiltTable {
    /// Where the beam leaves: forward, left, up.
    laser_offset_m: [f64; 3],
    /// Where it points: left, down.
    beam_off_rad: [f64; 2],
    axis_skew_rad: f64,
}

/// When images are taken, by their stamps.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ImagesTable {
    late_s: f64,
    readout_s: f64,
    /// Exposure in which the spot is not full.
    exposure_s: f64,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ScoreTable {
    /// How far spots were seen from where the head as found has them, root of the mean square.
    rms_mm: f64,
    spots: usize,
    outliers: usize,
}

/// Names of the boards.
const BOARDS: [&str; 2] = ["fine", "coarse"];

/// What a head file tells.
pub(crate) struct KnownHead {
    pub(crate) geometry: HeadGeometry,
    pub(crate) pose: HeadPose,
    pub(crate) timing: Timing,
    pub(crate) exposure_s: f64,
}

impl HeadFile {
    /// Of a head found in the frame of a page.
    pub(crate) fn of(found: &FoundHead, driving: &Driving, page: &PlacedPage) -> Self {
        let Alignment { geometry, pose, .. } = found.aligned.alignment;
        let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = pose;
        let HeadGeometry { laser_offset_m, beam_off_rad, axis_skew_rad, .. } = geometry;
        Self {
            date: crate::rigfile::today(),
            rig: driving.rig.name.clone(),
            board: BOARDS[page.board.min(1)].to_owned(),
            page: page.page + 1,
            pose: PoseTable { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad },
            built: BuiltTable { laser_offset_m, beam_off_rad, axis_skew_rad },
            images: ImagesTable {
                late_s: found.timing.late_s,
                readout_s: found.timing.readout_s,
                exposure_s: found.exposure_s,
            },
            score: ScoreTable {
                rms_mm: 1e3 * found.aligned.rms_m,
                spots: found.aligned.spots,
                outliers: found.aligned.outliers,
            },
        }
    }
}

/// A head as a file.
pub(crate) fn write(file: &HeadFile) -> Result<String, Failure> {
    let mut document = toml_edit::ser::to_document(file).map_err(|e| Failure::failed("internal", e))?;
    for (_, item) in document.iter_mut() {
        if let Some(table) = item.as_inline_table() {
            *item = toml_edit::Item::Table(table.clone().into_table());
        }
    }
    Ok(format!(
        "# Tracelight: a head in front of a wall. Lengths in m, angles in rad, times in s.\n\n{document}"
    ))
}
