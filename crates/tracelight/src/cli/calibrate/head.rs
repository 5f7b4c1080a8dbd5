use clap::Args;
use serde_json::json;
use tracelight_aim::HeadPose;
use tracelight_camera::Source;
use tracelight_eye::head::{DotsRequest, FoundHead, find_head, stand_before};
use tracelight_eye::homing::{Homed, home_head};
use tracelight_eye::room::{Furnished, RoomRequest};
use tracelight_eye::wall::{SeenWall, see_wall, well_exposed};
use tracelight_files as files;
use tracelight_rig::PanTilt;
use tracelight_rigfile as rigfile;
use tracelight_rigfile::head::{HeadFile, HeadScore, KnownHead, NewHead};
use tracelight_stroke::Point;
use tracelight_task::{Failure, Stop, Task};

use crate::bar::Bar;
use crate::cli::answer::{Answer, Voice};
use crate::cli::driving::DrivingArgs;
use crate::cli::ending::toml;
use crate::cli::eyes::EyeArgs;
use crate::cli::placing::PlacementArgs;
use crate::named;

/// Position and direction of the head, from dots that it draws and a camera sees
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate head --camera sim -o head.toml\n\n\
                  Put the head up by eye in front of the middle of the wall, pages of markers on the wall in the camera's sight. The laser draws 25 dots, small circles; \
                  the camera sees where they are, and pose, laser offset, axes, encoder zeroes and how late images come are those that fit them best. \
                  With --camera sim the room is simulated: head and camera stand millimetres and degrees from where they should, and how far the result truly is off is told.")]
pub(super) struct HeadArgs {
    #[command(flatten, next_help_heading = "Camera")]
    eye: EyeArgs,
    #[command(flatten, next_help_heading = "Size and place")]
    placement: PlacementArgs,
    #[command(flatten)]
    driving: DrivingArgs,
    /// First find out where the head points, after power-up or a lost count. The head moves in the dark and lights dots of a third of a second in
    /// unknown places until the camera sees one: keep eyes away. A simulated head starts in a random position
    #[arg(long)]
    home: bool,
    /// Home a head that was calibrated before, so that its head file is valid again. The file is one that this command has written; it is not changed
    #[arg(long, value_name = "FILE.toml", requires = "home", conflicts_with = "output")]
    head: Option<String>,
    /// Head file to write
    #[arg(short, long, value_name = "FILE.toml", default_value = "head.toml", value_parser = toml)]
    output: String,
    /// Random seed for the simulated room
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    seed: u64,
    #[command(flatten)]
    pub(super) voice: Voice,
}

pub(super) fn run(args: &HeadArgs, stop: &Stop) -> Result<Answer, Failure> {
    let bar = Bar::new(args.voice.quiet);
    let task = Task { progress: &bar, stop };
    let mut driving = args.driving.resolve()?;
    let Source::Simulated(picture) = args.eye.source()? else {
        let message = "no head can be driven yet but simulated ones, and they draw in simulated rooms: give --camera sim or sim:PICTURE";
        return Err(Failure::usage("usage", message));
    };
    let picture = picture.map(named::painted).transpose()?;
    let request = RoomRequest {
        picture: picture.as_ref(),
        placing: &args.placement.placing(),
        eye: args.eye.sim_camera.eye(),
        pages: args.eye.has_pages()?,
        seed: args.seed,
    };
    task.stage("wall", 1);
    let known = args.head.as_deref().map(|path| named::head(path, &driving.rig)).transpose()?;
    let mut room = Furnished::new(&request, &driving.rig, driving.pose)?;
    let mut rig = if args.home {
        room.powered_up(&driving.rig, driving.pose)
    } else {
        room.watched(&driving.rig, driving.pose)
    };
    let wall = see_wall(well_exposed(&mut rig, stop)?, args.eye.known()?.as_ref())?;
    wall.remarks.iter().for_each(|remark| task.say(&format!("note: {remark}")));
    stop.check()?;
    let camera = wall.camera.camera;
    stand_before(&mut driving, &wall, known.as_ref())?;
    let homed = if args.home {
        let images = known.as_ref().and_then(KnownHead::images);
        let homed = home_head(&mut rig, &camera, &driving, images, task)?;
        room.homed(&mut rig, &homed);
        Some((homed, room.zero_error_m(known.is_some())))
    } else {
        None
    };
    if known.is_some() {
        let text = format!("wall:     {}{}", wall.words(), homed_text(homed.as_ref()));
        return Ok(Answer::new(text, with_homed(json!({}), homed.as_ref()).to_string()));
    }
    let found = find_head(&mut rig, &camera, &driving, &DotsRequest::first(&driving), task, &mut |_| {})?;
    stop.check()?;
    let file = HeadFile::of(&NewHead {
        date: &named::today(),
        rig: &driving.rig.name,
        geometry: found.aligned.alignment.geometry,
        pose: found.aligned.alignment.pose,
        score: HeadScore {
            rms_m: found.aligned.rms_m,
            spots: found.aligned.spots,
            outliers: found.aligned.outliers,
        },
        images: Some((found.timing, found.exposure_s)),
        area_m: None,
        frame: wall.frame,
        pages: &wall.pages,
    });
    files::write(&args.output, rigfile::head::write(&file)?)?;
    let pose = found.aligned.alignment.pose;
    let truth = room.true_error_m(&found.aligned.alignment.geometry, &pose);
    let text = text(&wall, &found, truth, &args.output) + &homed_text(homed.as_ref());
    Ok(Answer::new(text, with_homed(json(&found, truth), homed.as_ref()).to_string()))
}

/// What became of homing, and by how much zero truly is off, m.
type HomedTruly = (Homed, PanTilt<f64>);

fn homed_text(homed: Option<&HomedTruly>) -> String {
    let Some((homed, off_m)) = homed else { return String::new() };
    format!(
        "\nhomed:    {}\n\
         truth:    zero is off by {:.2} mm on the wall in pan, {:.2} mm in tilt (known because the room is simulated)",
        homed.figures().words(),
        1e3 * off_m.pan.abs(),
        1e3 * off_m.tilt.abs(),
    )
}

fn with_homed(mut object: serde_json::Value, homed: Option<&HomedTruly>) -> serde_json::Value {
    if let Some((homed, off_m)) = homed {
        object["homed"] = json!({
            "sought": homed.sought,
            "stops": homed.stops,
            "counts": [homed.counts.pan, homed.counts.tilt],
            "truth_mm": [1e3 * off_m.pan, 1e3 * off_m.tilt],
        });
    }
    object
}

fn text(wall: &SeenWall, found: &FoundHead, truth: Option<(f64, f64)>, output: &str) -> String {
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
         dots:     {}, seen in {} images, in {} not; {:.3} mm off, rms{likely}{simulated}\n\
         file:     {output}",
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
fn toward(value: f64, decimals: usize, unit: &str, more: &str, less: &str) -> String {
    format!("{:.decimals$}{unit} {}", value.abs(), if value < 0.0 { less } else { more })
}

fn degrees(angle_rad: f64, more: &str, less: &str) -> String {
    toward(angle_rad.to_degrees(), 2, "°", more, less)
}

fn json(found: &FoundHead, truth: Option<(f64, f64)>) -> serde_json::Value {
    let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = found.aligned.alignment.pose;
    let built = &found.aligned.alignment.geometry;
    let at_zero = found.aligned.deviation_m(PanTilt::default()).map(|m| 1e3 * m);
    let mut object = json!({
        "pose": {"distance_m": distance_m, "right_m": right_m, "up_m": up_m, "yaw_rad": yaw_rad, "pitch_rad": pitch_rad, "roll_rad": roll_rad},
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
