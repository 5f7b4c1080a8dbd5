use clap::Args;
use serde_json::json;
use tracelight_camera::Source;
use tracelight_eye::head::{DotsRequest, find_head, stand_before};
use tracelight_eye::homing::{Homed, home_head};
use tracelight_eye::room::{Furnished, RoomRequest};
use tracelight_eye::told::{json, text};
use tracelight_eye::wall::{see_wall, well_exposed};
use tracelight_files as files;
use tracelight_rig::PanTilt;
use tracelight_rigfile as rigfile;
use tracelight_rigfile::head::{HeadFile, HeadScore, KnownHead, NewHead};
use tracelight_session::Session;
use tracelight_task::{Failure, Task};

use crate::cli::answer::{Answer, Voice};
use crate::cli::driving::DrivingArgs;
use crate::cli::ending::toml;
use crate::cli::eyes::EyeArgs;
use crate::named;
use tracelight_flags::PlacementArgs;

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

pub(super) fn run(args: &HeadArgs, task: Task<'_>) -> Result<Answer, Failure> {
    let stop = task.stop;
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
    let put_up = if args.home { Furnished::powered_up } else { Furnished::watched };
    let mut rig = Session::new(put_up(&room, &driving.rig, driving.pose));
    let wall = see_wall(well_exposed(&mut rig, stop)?, args.eye.known()?.as_ref())?;
    wall.remarks.iter().for_each(|remark| task.say(&format!("note: {remark}")));
    stop.check()?;
    let camera = wall.camera.camera;
    stand_before(&mut driving, &wall, known.as_ref())?;
    let homed = if args.home {
        let images = known.as_ref().and_then(KnownHead::images);
        let homed = home_head(&mut rig, &camera, &driving, images, task)?;
        room.homed(rig.rig_mut(), &homed);
        Some((homed, room.zero_error_m(known.is_some())))
    } else {
        None
    };
    if known.is_some() {
        let text = format!("wall:     {}{}", wall.words(), homed_text(homed.as_ref()));
        return Ok(Answer::new(text, with_homed(json!({}), homed.as_ref()).to_string()));
    }
    let found = find_head(&mut rig, &camera, &driving, &DotsRequest::first(&driving), task)?;
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
    let text =
        format!("{}\nfile:     {}{}", text(&wall, &found, truth), args.output, homed_text(homed.as_ref()));
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
