//! A head found from the joint angles at which its dot is on the corners of a rectangle: what is told of it, and the angles as a file.

use serde_json::json;
use tracelight_aim::{CorneredHead, HeadPose};
use tracelight_rig::PanTilt;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;
use tracelight_units::Angle;

use crate::pointed::{Pointed, off_m};
use crate::told::{degrees, pose, toward};

/// Corners in the order in which they are told.
pub const CORNERS: [&str; 4] = ["bottom-left", "bottom-right", "top-right", "top-left"];

/// Pan and tilt, rad, as people write them: `21.3deg,12.9deg`.
///
/// # Errors
/// What is no pair of angles with units.
pub fn angles(text: &str) -> Result<PanTilt<f64>, String> {
    let (pan, tilt) = text
        .split_once(',')
        .ok_or_else(|| format!("{text} is no pair: give pan and tilt, such as 21.3deg,12.9deg"))?;
    let angle = |text: &str| text.trim().parse::<Angle>().map(|angle| angle.0).map_err(|e| e.to_string());
    Ok(PanTilt::new(angle(pan)?, angle(tilt)?))
}

/// What a simulation knows of a head that was found.
pub struct Truth {
    pose: HeadPose,
    rms_m: f64,
    most_m: f64,
}

impl Truth {
    /// Of a head that was found from what somebody pointed at.
    #[must_use]
    pub fn of(rig: &RigConfig, size_m: (f64, f64), found: &HeadPose, pointed: &Pointed) -> Self {
        let (rms_m, most_m) = off_m(rig, size_m, found, &pointed.truth);
        Self { pose: pointed.truth, rms_m, most_m }
    }
}

/// A line a corner: its name, pan and tilt. Empty lines, those that begin with #, and a header do not count.
///
/// # Errors
/// `corners`, with the line: what is no corner, one that is there twice, and one that is missing.
pub fn read(path: &str, bytes: Vec<u8>) -> Result<[PanTilt<f64>; 4], Failure> {
    let wrong = |line: usize, why: &str| {
        Failure::usage(
            "corners",
            format!("{path}:{line}: {why}; a line is such as bottom-left,21.3deg,12.9deg"),
        )
    };
    let text = String::from_utf8(bytes).map_err(|_| wrong(1, "this is no text"))?;
    let mut all = [None; 4];
    for (number, row) in text.lines().enumerate() {
        let row = row.trim().trim_start_matches('\u{feff}');
        if row.is_empty() || row.starts_with('#') || row.starts_with("corner") {
            continue;
        }
        let (name, rest) = row.split_once(',').ok_or_else(|| wrong(number + 1, "there is no comma"))?;
        let name = name.trim().to_ascii_lowercase().replace([' ', '_'], "-");
        let place = CORNERS.iter().position(|known| *known == name).ok_or_else(|| {
            wrong(number + 1, &format!("{name} is no corner: they are {}", CORNERS.join(", ")))
        })?;
        let found = angles(rest).map_err(|e| wrong(number + 1, &e))?;
        if all[place].replace(found).is_some() {
            return Err(wrong(number + 1, &format!("{name} is there twice")));
        }
    }
    match all {
        [Some(a), Some(b), Some(c), Some(d)] => Ok([a, b, c, d]),
        _ => {
            let missing =
                CORNERS.iter().zip(&all).find(|(_, angle)| angle.is_none()).map_or("", |(name, _)| name);
            Err(wrong(text.lines().count().max(1), &format!("the corner {missing} is missing")))
        }
    }
}

/// What is told of a head that was found.
#[must_use]
pub fn text(found: &CorneredHead, truth: Option<&Truth>) -> String {
    let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = found.pose;
    let [distance, right, up, yaw, pitch, roll] = found.deviation;
    let mm = |m: f64| 1e3 * m;
    let residuals: Vec<String> =
        CORNERS.iter().zip(found.residual_m).map(|(name, m)| format!("{name} {:.1}", mm(m))).collect();
    let mut text = format!(
        "stands:   {distance_m:.4} m before the wall (± {:.1} mm), {} and {} the middle of the rectangle (± {:.1} and {:.1} mm)\n\
         turned:   {} (± {:.2}°), {} (± {:.2}°), {:+.2}° about the beam (± {:.2}°)\n\
         corners:  {:.2} mm off, rms: {} mm; two of eight numbers are left over to check by",
        mm(distance),
        toward(right_m, 4, " m", "right of", "left of"),
        toward(up_m, 4, " m", "above", "below"),
        mm(right),
        mm(up),
        degrees(yaw_rad, "left", "right"),
        yaw.to_degrees(),
        degrees(pitch_rad, "down", "up"),
        pitch.to_degrees(),
        roll_rad.to_degrees(),
        roll.to_degrees(),
        mm(found.rms_m()),
        residuals.join(", "),
    );
    if let Some(Truth { pose, rms_m, most_m }) = truth {
        text += &format!(
            "\ntruth:    it stands {:.4} m before the wall, {} and {} the middle; in the rectangle the spot is off by {:.2} mm rms, \
             {:.2} mm at most (known because the head is simulated)",
            pose.distance_m,
            toward(pose.right_m, 4, " m", "right of", "left of"),
            toward(pose.up_m, 4, " m", "above", "below"),
            mm(*rms_m),
            mm(*most_m),
        );
    }
    text
}

/// Figures of a head that was found, and of the truth, for scripts.
#[must_use]
pub fn json(angles: &[PanTilt<f64>; 4], found: &CorneredHead, truth: Option<&Truth>) -> String {
    let [distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad] = found.deviation;
    let deviation = HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad };
    let corners: Vec<_> = CORNERS
        .iter()
        .zip(angles.iter().zip(found.residual_m))
        .map(|(name, (angle, off_m))| {
            json!({ "corner": name, "pan_rad": angle.pan, "tilt_rad": angle.tilt, "residual_mm": 1e3 * off_m })
        })
        .collect();
    let mut object = json!({
        "pose": pose(&found.pose),
        "deviation": pose(&deviation),
        "corners": corners,
        "rms_mm": 1e3 * found.rms_m(),
        "simulated": truth.is_some(),
    });
    if let Some(truth) = truth {
        object["truth"] =
            json!({ "pose": pose(&truth.pose), "rms_mm": 1e3 * truth.rms_m, "max_mm": 1e3 * truth.most_m });
    }
    object.to_string()
}
