use clap::Args;
use serde_json::json;
use tracelight_aim::{CorneredHead, HeadPose, cornered};
use tracelight_eye::pointed::{Pointed, off_m, pointed};
use tracelight_files as files;
use tracelight_rig::PanTilt;
use tracelight_rigfile as rigfile;
use tracelight_rigfile::head::{HeadFile, HeadScore, NewHead};
use tracelight_sim::RigConfig;
use tracelight_task::Failure;
use tracelight_units::{Angle, Offset};

use crate::cli::answer::{Answer, Voice};
use crate::cli::ending::toml;
use crate::cli::placing::positive_length;
use crate::named;

/// Where the head stands, from the joint angles at which its dot is on the corners of a rectangle; without a camera
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight calibrate corners --size 2.4m,1.2m --simulate -o head.toml\n\n\
                  Mark the corners of a rectangle on the wall, or take those of a door or a board, and measure its width and height. Turn the head until its dot is on each \
                  corner, and write down pan and tilt there. Then tell them, --bottom-left 21.3deg,12.9deg and so on, or as a file: a line a corner, such as \
                  bottom-left,21.3deg,12.9deg. The middle of the rectangle becomes the target's middle. `trace` and `plan` take the file by --head.")]
pub(super) struct CornersArgs {
    /// Width and height of the rectangle, such as 2.4m,1.2m
    #[arg(long, value_name = "WIDTH,HEIGHT", allow_hyphen_values = true, value_parser = size)]
    size: Offset,
    /// Pan and tilt with the dot on the bottom left corner, such as 21.3deg,12.9deg
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    bottom_left: Option<Angles>,
    /// Pan and tilt with the dot on the bottom right corner
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    bottom_right: Option<Angles>,
    /// Pan and tilt with the dot on the top right corner
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    top_right: Option<Angles>,
    /// Pan and tilt with the dot on the top left corner
    #[arg(long, value_name = "PAN,TILT", allow_hyphen_values = true, value_parser = angles)]
    top_left: Option<Angles>,
    /// A file with the angles: a line a corner, such as bottom-left,21.3deg,12.9deg
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["bottom_left", "bottom_right", "top_right", "top_left"])]
    angles: Option<String>,
    /// A simulated person points a simulated head, which stands where nobody knows; how far the result truly is off is told
    #[arg(long, conflicts_with_all = ["angles", "bottom_left", "bottom_right", "top_right", "top_left"])]
    simulate: bool,
    /// Rig: a preset's name (see `tracelight rigs`) or a rig file
    #[arg(long, value_name = "RIG.toml|PRESET", default_value = "report")]
    rig: String,
    /// File for what is found
    #[arg(short, long, value_name = "FILE.toml", default_value = "head.toml", value_parser = toml)]
    output: String,
    /// Where a simulated head stands and how well somebody points is drawn from this seed
    #[arg(long, value_name = "N", default_value_t = 0, allow_hyphen_values = true)]
    seed: u64,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Pan and tilt, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Angles(PanTilt<f64>);

/// Corners in the order in which they are told.
const NAMES: [&str; 4] = ["bottom-left", "bottom-right", "top-right", "top-left"];

fn size(text: &str) -> Result<Offset, String> {
    let (width, height) = text
        .split_once(',')
        .ok_or_else(|| format!("{text} is no size: give width and height, such as 2.4m,1.2m"))?;
    Ok(Offset(positive_length(width)?, positive_length(height)?))
}

fn angles(text: &str) -> Result<Angles, String> {
    let (pan, tilt) = text
        .split_once(',')
        .ok_or_else(|| format!("{text} is no pair: give pan and tilt, such as 21.3deg,12.9deg"))?;
    let angle = |text: &str| text.trim().parse::<Angle>().map(|angle| angle.0).map_err(|e| e.to_string());
    Ok(Angles(PanTilt::new(angle(pan)?, angle(tilt)?)))
}

pub(super) fn run(args: &CornersArgs) -> Result<Answer, Failure> {
    let rig = named::rig(&args.rig)?;
    let size_m = (args.size.0.0, args.size.1.0);
    let simulated = args.simulate.then(|| pointed(&rig, size_m, args.seed)).transpose()?;
    let angles = match &simulated {
        Some(pointed) => pointed.angles,
        None => told(args)?,
    };
    let found = cornered(&rig.model.geometry, size_m, &angles, rig.model.encoder.count_rad())
        .map_err(|e| Failure::failed("corners", format!("calibrate corners: {e}")))?;
    let file = HeadFile::of(&NewHead {
        date: &named::today(),
        rig: &rig.name,
        geometry: rig.model.geometry,
        pose: found.pose,
        score: HeadScore { rms_m: found.rms_m(), spots: 4, outliers: 0 },
        images: None,
        area_m: Some(size_m),
        frame: None,
        pages: &[],
    });
    files::write(&args.output, rigfile::head::write(&file)?)?;
    let truth = simulated.map(|pointed| Truth::of(&rig, size_m, &found.pose, &pointed));
    Ok(Answer::new(text(args, &found, truth.as_ref()), json(&angles, &found, truth.as_ref())))
}

/// What a simulation knows of a head that was found.
struct Truth {
    pose: HeadPose,
    rms_m: f64,
    most_m: f64,
}

impl Truth {
    fn of(rig: &RigConfig, size_m: (f64, f64), found: &HeadPose, pointed: &Pointed) -> Self {
        let (rms_m, most_m) = off_m(rig, size_m, found, &pointed.truth);
        Self { pose: pointed.truth, rms_m, most_m }
    }
}

/// The angles of all four corners, from flags or a file.
fn told(args: &CornersArgs) -> Result<[PanTilt<f64>; 4], Failure> {
    let by_file = args.angles.as_deref().map(read).transpose()?;
    let given = by_file.unwrap_or([args.bottom_left, args.bottom_right, args.top_right, args.top_left]);
    let missing: Vec<String> = NAMES
        .iter()
        .zip(&given)
        .filter(|(_, angle)| angle.is_none())
        .map(|(name, _)| format!("--{name}"))
        .collect();
    match given {
        [Some(a), Some(b), Some(c), Some(d)] => Ok([a.0, b.0, c.0, d.0]),
        _ => {
            let message = format!(
                "pan and tilt at all four corners are needed, {} missing: give them, such as --top-left 21.3deg,-12.9deg, or --simulate to try it",
                if missing.len() == 1 {
                    format!("{} is", missing[0])
                } else {
                    format!("{} are", missing.join(", "))
                }
            );
            Err(Failure::usage("usage", message))
        }
    }
}

/// A line a corner: its name, pan and tilt. Empty lines, those that begin with #, and a header do not count.
fn read(path: &str) -> Result<[Option<Angles>; 4], Failure> {
    let wrong = |line: usize, why: &str| {
        Failure::usage(
            "corners",
            format!("{path}:{line}: {why}; a line is such as bottom-left,21.3deg,12.9deg"),
        )
    };
    let bytes = files::read(path)?;
    let text = String::from_utf8(bytes).map_err(|_| wrong(1, "this is no text"))?;
    let mut all = [None; 4];
    for (number, row) in text.lines().enumerate() {
        let row = row.trim().trim_start_matches('\u{feff}');
        if row.is_empty() || row.starts_with('#') || row.starts_with("corner") {
            continue;
        }
        let (name, rest) = row.split_once(',').ok_or_else(|| wrong(number + 1, "there is no comma"))?;
        let name = name.trim().to_ascii_lowercase().replace([' ', '_'], "-");
        let place = NAMES.iter().position(|known| *known == name).ok_or_else(|| {
            wrong(number + 1, &format!("{name} is no corner: they are {}", NAMES.join(", ")))
        })?;
        let found = angles(rest).map_err(|e| wrong(number + 1, &e))?;
        if all[place].replace(found).is_some() {
            return Err(wrong(number + 1, &format!("{name} is there twice")));
        }
    }
    let missing = NAMES.iter().zip(&all).find(|(_, angle)| angle.is_none());
    match missing {
        Some((name, _)) => Err(wrong(text.lines().count().max(1), &format!("the corner {name} is missing"))),
        None => Ok(all),
    }
}

fn text(args: &CornersArgs, found: &CorneredHead, truth: Option<&Truth>) -> String {
    let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = found.pose;
    let [distance, right, up, yaw, pitch, roll] = found.deviation;
    let mm = |m: f64| 1e3 * m;
    let residuals: Vec<String> =
        NAMES.iter().zip(found.residual_m).map(|(name, m)| format!("{name} {:.1}", mm(m))).collect();
    let mut text = format!(
        "stands:   {distance_m:.4} m before the wall (± {:.1} mm), {:.4} m {} and {:.4} m {} the middle of the rectangle (± {:.1} and {:.1} mm)\n\
         turned:   {:.2}° {} (± {:.2}°), {:.2}° {} (± {:.2}°), {:+.2}° about the beam (± {:.2}°)\n\
         corners:  {:.2} mm off, rms: {} mm; two of eight numbers are left over to check by",
        mm(distance),
        right_m.abs(),
        if right_m < 0.0 { "left of" } else { "right of" },
        up_m.abs(),
        if up_m < 0.0 { "below" } else { "above" },
        mm(right),
        mm(up),
        yaw_rad.to_degrees().abs(),
        if yaw_rad < 0.0 { "right" } else { "left" },
        yaw.to_degrees(),
        pitch_rad.to_degrees().abs(),
        if pitch_rad < 0.0 { "up" } else { "down" },
        pitch.to_degrees(),
        roll_rad.to_degrees(),
        roll.to_degrees(),
        mm(found.rms_m()),
        residuals.join(", "),
    );
    if let Some(Truth { pose, rms_m, most_m }) = truth {
        text += &format!(
            "\ntruth:    it stands {:.4} m before the wall, {:.4} m right of and {:.4} m above the middle; in the rectangle the spot is off by {:.2} mm rms, \
             {:.2} mm at most (known because the head is simulated)",
            pose.distance_m,
            pose.right_m,
            pose.up_m,
            mm(*rms_m),
            mm(*most_m),
        );
    }
    text + &format!("\nfile:     {}", args.output)
}

fn json(angles: &[PanTilt<f64>; 4], found: &CorneredHead, truth: Option<&Truth>) -> String {
    let pose = |pose: &HeadPose| {
        let HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad } = *pose;
        json!({
            "distance_m": distance_m, "right_m": right_m, "up_m": up_m, "yaw_rad": yaw_rad, "pitch_rad": pitch_rad, "roll_rad": roll_rad,
        })
    };
    let [distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad] = found.deviation;
    let deviation = HeadPose { distance_m, right_m, up_m, yaw_rad, pitch_rad, roll_rad };
    let corners: Vec<_> = NAMES
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
