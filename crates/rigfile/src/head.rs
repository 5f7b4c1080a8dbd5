//! What is known of a head in front of a wall, as a file.

use serde::{Deserialize, Serialize};
use tracelight_aim::{HeadGeometry, HeadPose, PlacedPage};
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use crate::calibrated::{Calibrated, Of};
use crate::pages::{PageName, PageTable};
use crate::text::{Kind, text_of};
use crate::timing::Timing;

/// Largest head file, bytes.
const MOST_BYTES: usize = 1 << 16;
const KIND: Kind = Kind { name: "head", code: "head-file", most_bytes: MOST_BYTES };

/// A head file.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeadFile {
    /// Day it was found, as 2026-11-23.
    date: String,
    /// Name of the rig.
    rig: String,
    /// The page whose frame the wall's is; empty where nobody knows.
    page: String,
    pose: PoseTable,
    built: BuiltTable,
    /// Not there where no camera found it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    images: Option<ImagesTable>,
    score: ScoreTable,
    /// The rectangle by whose corners it was found, about the target's middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    area: Option<AreaTable>,
    /// Pages that were in sight then, where they hung.
    #[serde(default)]
    pages: Vec<PageTable>,
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

/// A rectangle about the target's middle.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AreaTable {
    width_m: f64,
    height_m: f64,
}

/// When images are taken, by their stamps.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
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

fn named(frame: Option<PageName>) -> String {
    frame.map_or_else(String::new, |page| page.to_string())
}

/// What a head file tells.
#[derive(Clone, Debug)]
pub struct KnownHead {
    path: String,
    page: String,
    pages: Vec<PageTable>,
    /// The day on which it was found, such as 2026-11-23.
    pub date: String,
    /// How it is built.
    pub geometry: HeadGeometry,
    /// target_from_head.
    pub pose: HeadPose,
    /// Width and height of the rectangle about the target's middle by whose corners it was found, m; `None` of one that a camera found.
    pub area_m: Option<(f64, f64)>,
    images: Option<(Timing, f64)>,
}

impl KnownHead {
    /// How its camera's stamps related to the rig's ticks, and how long rows were exposed, s; `None` of one that no camera found.
    #[must_use]
    pub const fn images(&self) -> Option<(Timing, f64)> {
        self.images
    }
}

/// A head that was found.
#[derive(Clone, Copy, Debug)]
pub struct NewHead<'a> {
    /// The day, such as 2026-11-23.
    pub date: &'a str,
    /// Name of the rig.
    pub rig: &'a str,
    /// How it is built.
    pub geometry: HeadGeometry,
    /// Where it stands.
    pub pose: HeadPose,
    /// How well that fits what was seen.
    pub score: HeadScore,
    /// How its camera's stamps related to the rig's ticks, and the exposure in which the spot is not full, s; none without a camera.
    pub images: Option<(Timing, f64)>,
    /// Width and height of the rectangle by whose corners it was found, m.
    pub area_m: Option<(f64, f64)>,
    /// The page whose frame the wall's is.
    pub frame: Option<PageName>,
    /// Pages that were in sight, in the wall's frame.
    pub pages: &'a [PlacedPage],
}

/// How well a head fits what it was found by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadScore {
    /// How far spots were seen from where it has them, root mean square, m.
    pub rms_m: f64,
    /// How many spots.
    pub spots: usize,
    /// How many of them do not count.
    pub outliers: usize,
}

impl HeadFile {
    /// Of a head that was found.
    #[must_use]
    pub fn of(found: &NewHead<'_>) -> Self {
        let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = found.pose;
        let HeadGeometry { laser_offset_m, beam_off_rad, axis_skew_rad, .. } = found.geometry;
        let HeadScore { rms_m, spots, outliers } = found.score;
        Self {
            date: found.date.to_owned(),
            rig: found.rig.to_owned(),
            page: named(found.frame),
            pose: PoseTable { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad },
            built: BuiltTable { laser_offset_m, beam_off_rad, axis_skew_rad },
            images: found.images.map(|(timing, exposure_s)| ImagesTable {
                late_s: timing.late_s,
                readout_s: timing.readout_s,
                exposure_s,
            }),
            score: ScoreTable { rms_mm: 1e3 * rms_m, spots, outliers },
            area: found.area_m.map(|(width_m, height_m)| AreaTable { width_m, height_m }),
            pages: found.pages.iter().map(PageTable::of).collect(),
        }
    }
}

/// A head as a file.
///
/// # Errors
/// `internal`: of what is in a file there is nothing that cannot be written.
pub fn write(file: &HeadFile) -> Result<String, Failure> {
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

fn parsed(path: &str, bytes: Vec<u8>) -> Result<HeadFile, Failure> {
    let text = text_of(&KIND, path, bytes)?;
    toml_edit::de::from_str(&text)
        .map_err(|e| KIND.wrong(path, &format!("no head file: {}", e.to_string().trim_end())))
}

/// What a head file says of how well its head is known.
pub(crate) fn calibrated(path: &str, bytes: Vec<u8>) -> Result<Calibrated, Failure> {
    let file = parsed(path, bytes)?;
    file.check().map_err(|what| KIND.wrong(path, &what))?;
    Ok(Calibrated {
        of: Of::Head,
        date: file.date,
        off_m: Some(1e-3 * file.score.rms_mm),
        size_px: None,
        pages: file.pages.len(),
        rig: Some(file.rig),
        area_m: file.area.map(|area| (area.width_m, area.height_m)),
    })
}

/// The head of a file's bytes, for a rig that is built as told otherwise.
///
/// # Errors
/// `head-file`, with the key that is wrong; or where it is another rig's.
pub fn read(path: &str, bytes: Vec<u8>, rig: &RigConfig) -> Result<KnownHead, Failure> {
    let wrong = |what: String| KIND.wrong(path, &what);
    let file = parsed(path, bytes)?;
    if file.rig != rig.name {
        return Err(wrong(format!(
            "it is of the rig {}, and this is {}: calibrate its head",
            file.rig, rig.name
        )));
    }
    file.check().map_err(wrong)?;
    Ok(file.known(path, &rig.model.geometry))
}

impl HeadFile {
    /// Refuses numbers that no head has.
    fn check(&self) -> Result<(), String> {
        let PoseTable { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = &self.pose;
        let BuiltTable {
            laser_offset_m: [forward, left, up],
            beam_off_rad: [points_left, points_down],
            axis_skew_rad,
        } = &self.built;
        let mut fields = vec![
            ("pose.distance_m", distance_m, 0.01, 1e3),
            ("pose.right_m", right_m, -1e3, 1e3),
            ("pose.up_m", up_m, -1e3, 1e3),
            ("pose.yaw_rad", yaw_rad, -3.2, 3.2),
            ("pose.pitch_rad", pitch_rad, -1.6, 1.6),
            ("pose.roll_rad", roll_rad, -3.2, 3.2),
            ("built.laser_offset_m, forward", forward, -0.5, 0.5),
            ("built.laser_offset_m, left", left, -0.5, 0.5),
            ("built.laser_offset_m, up", up, -0.5, 0.5),
            ("built.beam_off_rad, left", points_left, -0.5, 0.5),
            ("built.beam_off_rad, down", points_down, -0.5, 0.5),
            ("built.axis_skew_rad", axis_skew_rad, -0.5, 0.5),
        ];
        if let Some(ImagesTable { late_s, readout_s, exposure_s }) = &self.images {
            fields.extend([
                ("images.late_s", late_s, -1.0, 1.0),
                ("images.readout_s", readout_s, -1.0, 1.0),
                ("images.exposure_s", exposure_s, 1e-6, 10.0),
            ]);
        }
        if let Some(AreaTable { width_m, height_m }) = &self.area {
            fields.extend([("area.width_m", width_m, 1e-3, 1e3), ("area.height_m", height_m, 1e-3, 1e3)]);
        }
        for (name, &value, least, most) in fields {
            if !(least..=most).contains(&value) {
                return Err(format!(
                    "{name} is {value}, which is not between {least} and {most}; calibrate the head again"
                ));
            }
        }
        Ok(())
    }

    fn known(&self, path: &str, told: &HeadGeometry) -> KnownHead {
        let PoseTable { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = self.pose;
        let BuiltTable { laser_offset_m, beam_off_rad, axis_skew_rad } = self.built;
        KnownHead {
            geometry: HeadGeometry { laser_offset_m, beam_off_rad, axis_skew_rad, range_rad: told.range_rad },
            pose: HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad },
            area_m: self.area.map(|area| (area.width_m, area.height_m)),
            images: self.images.map(|ImagesTable { late_s, readout_s, exposure_s }| {
                (Timing { late_s, readout_s, unsure_s: Timing::USUAL.unsure_s }, exposure_s)
            }),
            path: path.to_owned(),
            date: self.date.clone(),
            page: self.page.clone(),
            pages: self.pages.clone(),
        }
    }
}

impl KnownHead {
    /// Refuses a wall whose frame is that of another page, or on which pages hang elsewhere: then its frame is not where it was.
    ///
    /// # Errors
    /// `head-file`, with the page.
    pub fn check_wall(&self, frame: Option<PageName>, pages: &[PlacedPage]) -> Result<(), Failure> {
        let again = |why: String| {
            Failure::usage("head-file", format!("{}: {why}: calibrate the head again", self.path))
        };
        if self.page.is_empty() && self.images.is_none() {
            let message = format!(
                "{}: this head was found by corners, without a camera, and its target is not the one that the camera's page tells: calibrate it with \
                 `tracelight calibrate head --camera`",
                self.path
            );
            return Err(Failure::usage("head-file", message));
        }
        let frame = named(frame);
        if frame != self.page {
            return Err(again(format!(
                "the head was found in the frame of page {}, and the wall's is that of page {frame}",
                self.page
            )));
        }
        for page in pages {
            let off_m = self.pages.iter().find_map(|own| own.off_m(page)).unwrap_or(0.0);
            if off_m > ELSEWHERE_M {
                let (name, mm) = (PageName::of(page), 1e3 * off_m);
                return Err(again(format!(
                    "page {name} hangs {mm:.1} mm from where it hung when the head was found"
                )));
            }
        }
        Ok(())
    }
}

/// How far a page may seem to hang from where it did that was not moved, m: what one image leaves open.
const ELSEWHERE_M: f64 = 2e-3;
