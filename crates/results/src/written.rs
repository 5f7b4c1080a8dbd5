//! A run that is over, in its folder.

use tracelight_files::{self as files, ResultFolder};
use tracelight_job::{Prepared, Ran};
use tracelight_pipeline::Standing;
use tracelight_report::{Finished, Picture, Setting, Summary, Target, Timing};
use tracelight_rig::PanTilt;
use tracelight_rigfile as rigfile;
use tracelight_sim::{Tracking, score};
use tracelight_task::Failure;

use crate::folder::{CAMERA, RIG, STROKES, put_jpeg, write_all};
use crate::points::{figures as point_figures, put_points};

/// What a run's results tell of what was asked.
#[derive(Clone, Debug)]
pub struct Told<'a> {
    /// The picture or the camera, as people call it.
    pub name: &'a str,
    /// In words, in the order to show.
    pub settings: &'a [Setting],
    /// Seed of the run.
    pub seed: u64,
    /// The gate was held dark on purpose.
    pub dry_run: bool,
    /// The rig file that was given, or the name of a preset.
    pub rig_file: &'a str,
    /// The day, such as 2026-11-23.
    pub today: String,
}

/// Where a job is drawn, and how large.
#[must_use]
pub fn target(prepared: &Prepared) -> Target {
    let Prepared { placed, driving, .. } = prepared;
    Target {
        width_m: placed.size_m.0,
        height_m: placed.size_m.1,
        middle: placed.centre(),
        distance_m: driving.pose.distance_m,
    }
}

/// Writes what a run came to, the summary last.
///
/// # Errors
/// `cannot-write`.
pub fn write(
    folder: &ResultFolder,
    told: &Told<'_>,
    prepared: &Prepared,
    ran: &Ran,
) -> Result<Summary, Failure> {
    let Prepared { sketch, placed, driving, schedule, .. } = prepared;
    let drawing = &schedule.ordered.drawing;
    folder.put(STROKES, placed.svg(drawing))?;
    put_jpeg(folder, CAMERA, prepared.camera_image())?;
    write_rig(folder, told, ran)?;
    put_points(folder, &ran.points)?;
    let plan = ran.plan(prepared);
    let tracking: Tracking = score(plan, &ran.last, plan.set_speed_m_s);
    let motors = &driving.rig.model.motors;
    let bent = sketch.picture.as_ref().and_then(|picture| placed.bent_picture(picture));
    let job = Finished {
        picture_path: told.name,
        picture: sketch.picture.as_ref().map(|raster| match &bent {
            Some((raster, target_from_pixel)) => Picture { raster, target_from_pixel: *target_from_pixel },
            None => Picture { raster, target_from_pixel: placed.target_from_sheet },
        }),
        quality: sketch.quality.as_ref(),
        target: target(prepared),
        standing: Standing::of(drawing, driving),
        align: placed.align.as_ref(),
        left_out: placed.left_out,
        points: point_figures(&ran.points),
        drawing,
        plan,
        run: &ran.last,
        finished: ran.finished,
        earlier_laps: &ran.earlier,
        tracking,
        set_speed_m_s: plan.set_speed_m_s,
        command_limit_v: motors.map(|m| m.limit_v),
        torque_limit_nm: PanTilt::new(motors.pan.torque_limit_nm(), motors.tilt.torque_limit_nm()),
        tolerance_mm: driving.request.tolerance_m * 1e3,
        settings: told.settings,
        notes: &ran.notes,
        timing: Timing {
            vision_ms: prepared.vision_ms,
            plan_ms: prepared.plan_ms,
            run_ms: ran.run_ms,
            report_ms: 0.0,
        },
        seed: told.seed,
        dry_run: told.dry_run,
        origin: ran.origin,
        eye: ran.eye.clone(),
        seen: ran.seen.as_ref(),
    };
    write_all(folder, &job)
}

/// Writes `rig.toml`, the rig as its laps identified it. A rig file that the job was given stays as it is.
fn write_rig(folder: &ResultFolder, told: &Told<'_>, ran: &Ran) -> Result<(), Failure> {
    let Some(mut rig) = ran.identified.clone() else { return Ok(()) };
    if files::is_same(&folder.path(RIG).to_string_lossy(), told.rig_file) {
        return Ok(());
    }
    if let Some(identified) = &mut rig.identified {
        identified.date.clone_from(&told.today);
    }
    folder.put(RIG, rigfile::write(&rig))
}
