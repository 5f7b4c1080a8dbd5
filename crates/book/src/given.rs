//! What the book's commands are given: arrays of times and angles, and pictures.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use tracelight_maths::{cos, hypot, sin};
use tracelight_report::html::data_uri;
use tracelight_rig::TICK_F64_S;
use tracelight_task::Failure;
use tracelight_trajectory::{MoveLimits, Profile, Ramps, Shape};

/// A picture to trace: one closed figure, as the report asks for.
const STAR: &[u8] = include_bytes!("../../../examples/star.png");
/// It, and pictures of a ruler with two tapes 4 in apart.
const PICTURES: [(&str, &[u8]); 3] = [
    ("ruler-upright.png", include_bytes!("../../../examples/ruler-upright.png")),
    ("ruler-level.png", include_bytes!("../../../examples/ruler-level.png")),
    ("star.png", STAR),
];

/// Rest after a move that the report does not show, s.
const HOLD_S: f64 = 1.5;
/// Length of the time axis of the report's figures 14 and 15, s.
const SCOPE_S: f64 = 7.0;
/// Limits of the report's start file.
const FAST: MoveLimits = MoveLimits { speed: 24.0, acceleration: 100.0, deceleration: 100.0 };

/// A file that a command reads: its folder, its name, what is in it.
type Given = (&'static str, &'static str, Vec<u8>);

pub(crate) fn files() -> Result<Vec<Given>, Failure> {
    let slow = MoveLimits { speed: 5.0, acceleration: 4.0, deceleration: 1.0 };
    let mut files: Vec<Given> =
        PICTURES.into_iter().map(|(name, bytes)| ("pictures", name, bytes.to_vec())).collect();
    files.push(("pictures", "ring.png", ring()?));
    files.push(("arrays", "trapezoid.csv", half_turn(&FAST, |move_s| SCOPE_S - move_s).into_bytes()));
    files.push(("arrays", "feasible.csv", half_turn(&slow, |_| HOLD_S).into_bytes()));
    files.push(("arrays", "circle.csv", circle().into_bytes()));
    Ok(files)
}

/// A picture that is traced, for the page.
pub(crate) fn star_shown() -> String {
    format!("<img alt=\"a star in ink\" src=\"{}\">", data_uri("image/png", STAR))
}

/// A pen's circle as the report's camera would see it, 320 × 240 px.
fn ring() -> Result<Vec<u8>, Failure> {
    const RADIUS_PX: f64 = 90.0;
    const HALF_PEN_PX: f64 = 2.0;
    let grey = |x: u32, y: u32| {
        let from_middle = hypot(f64::from(x) + 0.5 - 160.0, f64::from(y) + 0.5 - 120.0);
        // a pixel's share of paper
        let paper = ((from_middle - RADIUS_PX).abs() - HALF_PEN_PX + 0.5).clamp(0.0, 1.0);
        image::Luma([(255.0 * paper) as u8])
    };
    let mut bytes = std::io::Cursor::new(Vec::new());
    let written = image::GrayImage::from_fn(320, 240, grey).write_to(&mut bytes, image::ImageFormat::Png);
    written.map_err(|e| Failure::failed("internal", e))?;
    Ok(bytes.into_inner())
}

/// Pan from 0 to π by a trapezoid and tilt by half of that, as the report's start file has it (`angle2=(x/2)'`), then rest.
fn half_turn(limits: &MoveLimits, rest_s: impl Fn(f64) -> f64) -> String {
    let pan = trapezoid(limits);
    let length_s = pan.duration_s() + rest_s(pan.duration_s());
    rows(length_s, &|t| {
        let x = pan.at(t.min(pan.duration_s())).position;
        [x, 0.5 * x]
    })
}

fn trapezoid(limits: &MoveLimits) -> Profile {
    Profile::new(Shape::Ramped(Ramps::NONE), PI, limits)
}

/// Pan's angle at the end of figure 14's time, rad, if the array is carried on by its last two rows, as Simulink does unless told otherwise.
pub(crate) fn carried_on_rad() -> f64 {
    /// Rows of the start file.
    const ROWS: f64 = 600.0;
    let pan = trapezoid(&FAST);
    let (end_s, step_s) = (pan.duration_s(), pan.duration_s() / ROWS);
    let speed = (PI - pan.at(end_s - step_s).position) / step_s;
    PI + speed * (SCOPE_S - end_s)
}

/// As figures 16 and 17 show it: pan between 0 and 1 rad from 100 to 800 ms, tilt within ±1 rad from 50 to 550 ms.
fn circle() -> String {
    let within = |t: f64, (from, to): (f64, f64)| ((t - from) / (to - from)).clamp(0.0, 1.0);
    rows(0.8 + HOLD_S, &|t| {
        let (pan, tilt) = (within(t, (0.1, 0.8)), within(t, (0.05, 0.55)));
        [0.5 * (1.0 - cos(TAU * pan)), sin(TAU * tilt)]
    })
}

fn rows(length_s: f64, at: &dyn Fn(f64) -> [f64; 2]) -> String {
    let mut text = String::from("t,pan,tilt\n");
    for tick in 0..=(length_s / TICK_F64_S).ceil() as usize {
        let t = tick as f64 * TICK_F64_S;
        let [pan, tilt] = at(t);
        // writing to a String cannot fail
        let _ = writeln!(text, "{t:.3},{pan:.9},{tilt:.9}");
    }
    text
}
