//! A look at a camera: what it can do, what it sends, and what is not as it should be.

use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tracelight_eye::about::{About, Stamps};
use tracelight_eye::figure::histogram;
use tracelight_eye::wall::{markers, well_exposed};
use tracelight_eye::{Looks, grey};
use tracelight_task::{Failure, Stop, Task};

use crate::devices::devices;
use crate::shown::shown;
use crate::source::{Opened, Source};

/// How long images are counted, s.
const WATCHED_S: f64 = 2.0;
/// Fewest images a second that follow a spot well: at a foot a second it goes 15 mm from one to the next.
const FEW_HZ: f64 = 20.0;
/// Latency beyond which something holds images back, s: webcams take 30 to 130 ms.
const LATE_S: f64 = 0.2;
/// Share of images that may be lost or broken.
const LOST_SHARE: f64 = 0.02;

/// A camera that was looked at.
#[derive(Debug)]
pub struct SeenCamera {
    about: About,
    size_px: [usize; 2],
    /// Images a second.
    rate_hz: Option<f64>,
    /// How many pixels there are of each brightness, as a line of blocks.
    brightness: String,
    /// Markers in its last image.
    markers: usize,
}

/// Takes images for two seconds, and one that is well exposed.
///
/// # Errors
/// `usage` where that is no camera; what a camera fails with.
pub fn look_at(name: &str, size_px: Option<[usize; 2]>, stop: &Stop) -> Result<SeenCamera, Failure> {
    let none = || {
        let message = format!("{name} is no camera that can be looked at; give /dev/video0 or http://…");
        Failure::usage("usage", message)
    };
    let source = Source::of(name)?;
    if !matches!(source, Source::Device(_) | Source::Net(_)) {
        return Err(none());
    }
    let Opened::Camera(mut camera) = source.open(size_px)? else { return Err(none()) };
    let taken_hz = watched(&mut *camera, stop)?;
    let pixels = well_exposed(&mut *camera, stop)?;
    let about = camera.about();
    let grey = grey(&pixels)?;
    Ok(SeenCamera {
        rate_hz: about.rhythm.rate_hz().or(taken_hz),
        about,
        size_px: [pixels.width() as usize, pixels.height() as usize],
        brightness: histogram(&grey),
        markers: markers(&grey).len(),
    })
}

/// Takes images for some time; how many a second they are.
fn watched(camera: &mut dyn Looks, stop: &Stop) -> Result<Option<f64>, Failure> {
    let exposure_s = 0.5 * camera.longest().unwrap_or(0.0);
    camera.take(exposure_s)?;
    let begun = Instant::now();
    let mut taken = 0;
    while begun.elapsed() < Duration::from_secs_f64(WATCHED_S) {
        stop.check()?;
        camera.take(exposure_s)?;
        taken += 1;
    }
    Ok((taken > 0).then(|| f64::from(taken) / begun.elapsed().as_secs_f64()))
}

impl SeenCamera {
    /// What is not as it should be, and what to do.
    fn remarks(&self) -> Vec<String> {
        let rhythm = &self.about.rhythm;
        let sent = f64::from((rhythm.images + rhythm.lost + rhythm.broken).max(1));
        let mut remarks = Vec::new();
        if let Some(rate) = self.rate_hz.filter(|rate| *rate < FEW_HZ) {
            remarks.push(format!("{rate:.1} images a second follow a spot badly: a smaller --camera-size, or more light, may bring more"));
        }
        if f64::from(rhythm.lost) / sent > LOST_SHARE {
            remarks.push("images are lost on their way: plug it in by itself, not through a hub, or take a smaller --camera-size".to_owned());
        }
        if f64::from(rhythm.broken) / sent > LOST_SHARE {
            remarks.push("images come in part: is its cable bad?".to_owned());
        }
        if let Some([_, median, _]) = rhythm.latency_s().filter(|late| late[1] > LATE_S) {
            remarks.push(format!(
                "its images take {:.0} ms to come: what is suddenly off is seen so much later",
                1e3 * median
            ));
        }
        match rhythm.stamps {
            Stamps::None if rhythm.images > 0 => remarks.push(
                "its driver does not stamp images: when they were taken is reckoned from when they are there".to_owned(),
            ),
            Stamps::End => remarks.push(
                "its driver stamps images when all of them is there: when they were taken is reckoned from that".to_owned(),
            ),
            Stamps::None | Stamps::Beginning => {}
        }
        if self.about.driver.is_some() && self.about.exposure_s.is_none() {
            remarks.push(
                "it exposes as it likes: a spot in its images is often clipped, and less exact".to_owned(),
            );
        }
        if self.about.focuses {
            remarks.push(
                "it focuses by itself, which changes what its lens was calibrated for: switch that off (v4l2-ctl -c focus_automatic_continuous=0)"
                    .to_owned(),
            );
        }
        remarks
    }
}

/// A camera's name, and what was seen of it.
pub type NamedCamera = (String, Result<SeenCamera, Failure>);

/// What was seen of each camera by its name: of that one, or of all that are plugged in. A second device of a camera is no news.
///
/// # Errors
/// `interrupted`.
pub fn look_at_all(
    name: Option<&str>,
    size_px: Option<[usize; 2]>,
    task: Task<'_>,
) -> Result<Vec<NamedCamera>, Failure> {
    let names: Vec<String> = match name {
        Some(name) => vec![name.to_owned()],
        None => devices().iter().map(|path| path.display().to_string()).collect(),
    };
    task.stage("cameras", names.len() as u64);
    let mut cameras = Vec::new();
    for (step, one) in (0..).zip(names) {
        task.check()?;
        task.at(step);
        let seen = look_at(&one, size_px, task.stop);
        let is_other = seen.as_ref().is_err_and(|failure| failure.code == "not-a-camera");
        if name.is_some() || !is_other {
            cameras.push((shown(&one), seen));
        }
    }
    task.check()?;
    Ok(cameras)
}

/// What to say where no camera is plugged in.
#[must_use]
pub fn no_camera_text() -> &'static str {
    match std::env::consts::OS {
        "linux" => "cameras:  none is plugged in; one on the net is looked at with --camera http://…",
        _ => {
            "cameras:  those that are plugged in are read on Linux only; one on the net is looked at with --camera http://…"
        }
    }
}

/// What was seen, for people; `name` is the camera's.
#[must_use]
pub fn camera_text(name: &str, seen: &Result<SeenCamera, Failure>) -> String {
    let seen = match seen {
        Ok(seen) => seen,
        Err(failure) => {
            let [plugged, net] = ["the camera", "the camera at"].map(|begin| format!("{begin} {name}: "));
            let why = failure.message.trim_start_matches(&plugged).trim_start_matches(&net);
            return format!("camera:   {name}: {why}");
        }
    };
    let About { name: called, driver, modes, mode, exposure_s, gain, rhythm, .. } = &seen.about;
    let called = called.as_ref().map_or_else(String::new, |called| format!(", {called}"));
    let driver = driver.as_ref().map_or_else(String::new, |driver| format!(" ({driver})"));
    let mut lines = vec![format!("camera:   {name}{called}{driver}")];
    lines.extend(by_coding(modes).iter().map(|modes| format!("  can:      {modes}")));
    let [width, height] = seen.size_px;
    let sends = mode.clone().unwrap_or_else(|| format!("{width}x{height}"));
    let rate = seen.rate_hz.map_or_else(String::new, |rate| format!(", {rate:.1} a second measured"));
    let whole = match (rhythm.images, rhythm.lost, rhythm.broken) {
        (0, _, _) => String::new(),
        (images, lost, broken) => format!("; {images} images, {lost} lost, {broken} broken"),
    };
    lines.push(format!("  sends:    {sends}{rate}{whole}"));
    if let Some([least, median, most]) = rhythm.latency_s().map(|late| late.map(|late| 1e3 * late)) {
        lines.push(format!(
            "  latency:  {median:.0} ms from when an image is stamped until it is here, median; {least:.0} to {most:.0} ms"
        ));
    }
    if let Some([least, most]) = exposure_s.map(|exposure| exposure.map(|exposure| 1e3 * exposure)) {
        let gain = gain
            .map_or_else(String::new, |[least, now, most]| format!("; gain {least} to {most}, now {now}"));
        lines.push(format!("  exposure: {least:.1} to {most:.1} ms, as it is told{gain}"));
    }
    let markers = match seen.markers {
        0 => "no markers in sight".to_owned(),
        1 => "1 marker in sight".to_owned(),
        n => format!("{n} markers in sight"),
    };
    lines.push(format!("  image:    brightness, dark to light: {}; {markers}", seen.brightness));
    lines.extend(seen.remarks().iter().map(|remark| format!("  note:     {remark}")));
    lines.join("\n")
}

/// Modes, a line for each coding.
fn by_coding(modes: &[String]) -> Vec<String> {
    let parts = |mode: &str| mode.split_once(' ').map(|(coding, rest)| (coding.to_owned(), rest.to_owned()));
    let mut lines: Vec<(String, String)> = Vec::new();
    for (coding, rest) in modes.iter().filter_map(|mode| parts(mode)) {
        match lines.last_mut().filter(|line| line.0 == coding) {
            Some(line) => line.1.push_str(&format!(", {rest}")),
            None => lines.push((coding, rest)),
        }
    }
    lines.iter().map(|(coding, rest)| format!("{coding} {rest}")).collect()
}

/// What was seen, for scripts.
#[must_use]
pub fn camera_json(name: &str, seen: &Result<SeenCamera, Failure>) -> Value {
    let seen = match seen {
        Ok(seen) => seen,
        Err(failure) => {
            return json!({"source": name, "error": {"code": failure.code, "message": failure.message}});
        }
    };
    let About { name: called, driver, modes, mode, exposure_s, gain, focuses, rhythm } = &seen.about;
    let ms = |s: f64| 1e3 * s;
    let latency = rhythm.latency_s().map(|late| late.map(ms));
    json!({
        "source": name,
        "name": called,
        "driver": driver,
        "modes": modes,
        "mode": mode,
        "width_px": seen.size_px[0],
        "height_px": seen.size_px[1],
        "rate_hz": seen.rate_hz,
        "images": rhythm.images,
        "lost": rhythm.lost,
        "broken": rhythm.broken,
        "stamped": match rhythm.stamps {
            Stamps::Beginning => Some("beginning"),
            Stamps::End => Some("end"),
            Stamps::None => None,
        },
        "latency_ms": latency.map(|[least, median, most]| json!({"least": least, "median": median, "most": most})),
        "exposure_ms": exposure_s.map(|exposure| exposure.map(ms)),
        "gain": gain.map(|[least, now, most]| json!({"least": least, "now": now, "most": most})),
        "focuses": focuses,
        "markers": seen.markers,
        "remarks": seen.remarks(),
    })
}
