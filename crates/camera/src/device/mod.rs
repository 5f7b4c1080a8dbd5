//! Cameras that are plugged in, by Video4Linux: what they can, what they are told, and their images with the times at which they were taken.
//!
//! | part | what |
//! |---|---|
//! | [`mode`] | what a camera can send, and which of it is taken |
//! | [`controls`] | exposure and gain |
//! | [`reader`] | images, read by a thread |
//! | [`why`] | a camera cannot be used |

mod controls;
mod mode;
mod reader;
mod why;

use std::io;

use moq_v4l::buffer::Type;
use moq_v4l::capability::{Capabilities, Flags as Can};
use moq_v4l::format::{Colorspace, Quantization};
use moq_v4l::frameinterval::{FrameInterval, FrameIntervalEnum};
use moq_v4l::framesize::FrameSizeEnum;
use moq_v4l::io::mmap::Stream;
use moq_v4l::video::Capture;
use moq_v4l::video::capture::Parameters;
use moq_v4l::{Device, Format, FourCC, Fraction};
use tracelight_picture::unless_it_panics;
use tracelight_task::Failure;

use crate::latest::PATIENCE;
use controls::Controls;
use mode::{Mode, chosen};
use reader::{Reader, now_s};
use tracelight_eye::about::About;
use tracelight_eye::coding::{Coding, Layout};
use tracelight_eye::{Looks, Shot};
use why::calmly;

/// A camera that is plugged in, sending images.
pub(crate) struct Plugged {
    path: String,
    /// What its maker calls it, and its driver.
    name: Option<String>,
    driver: Option<String>,
    /// What it can send.
    modes: Vec<Mode>,
    /// What it sends.
    mode: Mode,
    layout: Layout,
    /// From one image to the next, s.
    interval_s: f64,
    controls: Controls,
    reader: Reader,
    opened_s: f64,
    /// Images up to this number are exposed otherwise than it was told last.
    settled_at: u64,
    /// Images that began to arrive earlier are, too, s.
    settled_s: f64,
}

/// How many images come until one is exposed as it was told: some are on their way, or half exposed.
const SETTLING_IMAGES: u64 = 4;
/// How long a camera that exposes as it likes takes to find how, s.
const WARMING_S: f64 = 1.0;
/// Images that a driver may have in hand.
const BUFFERS: u32 = 4;
/// Images a second of a camera that does not say.
const USUAL_HZ: f64 = 30.0;

impl Plugged {
    /// Has a camera send images, columns and rows as wanted.
    pub(crate) fn open(path: &str, size_px: Option<[usize; 2]>) -> Result<Self, Failure> {
        let failed = |why: &str| Failure::failed("no-camera", format!("the camera {path}: {why}"));
        let told = |error: io::Error| failed(&why::not_opened(path, &error));
        let device = Device::with_path(path).map_err(told)?;
        // the library panics at names that are cut in the middle of a letter; what such a camera can, its modes tell
        let about = unless_it_panics(|| device.query_caps()).transpose().map_err(told)?;
        let sends = |about: &Capabilities| about.capabilities.contains(Can::VIDEO_CAPTURE | Can::STREAMING);
        if !about.as_ref().is_none_or(sends) {
            let message = format!(
                "the camera {path}: it sends no images; a camera often has two devices, and the other does"
            );
            return Err(Failure::failed("not-a-camera", message));
        }
        let modes = modes(&device, size_px);
        let mode = chosen(&modes, size_px).ok_or_else(|| failed(&none_fits(&modes, size_px)))?;
        let set = calmly(|| set(&device, &mode)).map_err(told)?;
        let (layout, rate_hz) =
            set.ok_or_else(|| failed(&format!("it does not send {mode} when told to")))?;
        let stream = calmly(|| Stream::with_buffers(&device, Type::VideoCapture, BUFFERS)).map_err(told)?;
        let interval_s = 1.0 / rate_hz.unwrap_or(USUAL_HZ);
        let reader = Reader::begin(stream, layout, interval_s);
        reader.next().map_err(|why| Failure::failed("no-image", format!("the camera {path}: {why}")))?;
        let controls = Controls::take_over(device);
        let opened_s = now_s();
        let warms_s = if controls.exposure_s().is_some() { 0.0 } else { WARMING_S };
        let (name, driver) = about.map(|about| (about.card, about.driver)).unzip();
        Ok(Self {
            path: path.to_owned(),
            name,
            driver,
            modes,
            mode: Mode { rate_hz, ..mode },
            layout,
            interval_s,
            controls,
            reader,
            opened_s,
            settled_at: 0,
            settled_s: opened_s + warms_s,
        })
    }

    /// It was told something; those that are on their way are exposed otherwise.
    fn was_told(&mut self) {
        self.settled_at = self.reader.count() + SETTLING_IMAGES;
    }

    fn failed(&self, why: &str) -> Failure {
        Failure::failed("no-image", format!("the camera {}: {why}", self.path))
    }
}

impl Looks for Plugged {
    fn take(&mut self, exposure_s: f64) -> Result<Shot, Failure> {
        let mut exposed_s = 0.0;
        if let Some((is_s, is_new)) = self.controls.expose(exposure_s) {
            exposed_s = is_s;
            if is_new {
                self.was_told();
            }
        }
        // what begins to arrive within an interval was exposed before, in part
        self.settled_s = self.settled_s.max(now_s() + self.interval_s);
        let until_s = self.settled_s + SETTLING_IMAGES as f64 * self.interval_s + PATIENCE.as_secs_f64();
        while now_s() < until_s {
            let image = self.reader.next().map_err(|why| self.failed(&why))?;
            if image.stamp_s >= self.settled_s && image.number > self.settled_at {
                let stamp_s = image.stamp_s - self.opened_s;
                return Ok(Shot::sent(&self.path, self.layout, image.bytes, [stamp_s, exposed_s]));
            }
        }
        Err(self.failed("the images it sends were taken long ago: is the machine overloaded?"))
    }

    fn longest(&self) -> Option<f64> {
        // longer, and images would be fewer
        Some(self.controls.exposure_s()?[1].min(self.interval_s))
    }

    fn brighten(&mut self) -> bool {
        let is_brighter = self.controls.brighten();
        if is_brighter {
            self.was_told();
        }
        is_brighter
    }

    fn about(&self) -> About {
        About {
            name: self.name.clone(),
            driver: self.driver.clone(),
            modes: self.modes.iter().map(Mode::to_string).collect(),
            mode: Some(self.mode.to_string()),
            exposure_s: self.controls.exposure_s(),
            gain: self.controls.gain(),
            focuses: self.controls.focuses(),
            rhythm: self.reader.rhythm(),
        }
    }
}

/// What a camera can send that is understood; at a size that is wanted, and at usual ones, of one that sends any.
fn modes(device: &Device, size_px: Option<[usize; 2]>) -> Vec<Mode> {
    let mut modes = Vec::new();
    let formats = calmly(|| device.enum_formats()).unwrap_or_default();
    let known = |name: FourCC| Some((name, Coding::named(name.repr)?));
    for (name, coding) in formats.into_iter().filter_map(|format| known(format.fourcc)) {
        for size_px in sizes(device, name, size_px) {
            modes.push(Mode { name: name.repr, coding, size_px, rate_hz: rate_hz(device, name, size_px) });
        }
    }
    if modes.is_empty()
        && let Ok(now) = calmly(|| device.format())
        && let Some((name, coding)) = known(now.fourcc)
    {
        // a driver that lists nothing
        let size_px = [now.width as usize, now.height as usize];
        modes.push(Mode { name: name.repr, coding, size_px, rate_hz: None });
    }
    modes
}

/// Columns and rows that a camera sends.
fn sizes(device: &Device, name: FourCC, wanted: Option<[usize; 2]>) -> Vec<[usize; 2]> {
    const USUAL: [[usize; 2]; 6] =
        [[320, 240], [640, 480], [800, 600], [1280, 720], [1280, 960], [1920, 1080]];
    let found = calmly(|| device.enum_framesizes(name)).unwrap_or_default();
    let mut sizes = Vec::new();
    for size in found {
        match size.size {
            FrameSizeEnum::Discrete(size) => sizes.push([size.width as usize, size.height as usize]),
            FrameSizeEnum::Stepwise(steps) => {
                let fits = |wanted: usize, [least, most, step]: [u32; 3]| {
                    let [least, most, step] = [least, most, step.max(1)].map(|n| n as usize);
                    (least..=most).contains(&wanted) && (wanted - least).is_multiple_of(step)
                };
                let width = [steps.min_width, steps.max_width, steps.step_width];
                let height = [steps.min_height, steps.max_height, steps.step_height];
                let some = USUAL.into_iter().chain(wanted).chain([[width[1] as usize, height[1] as usize]]);
                sizes.extend(some.filter(|[w, h]| fits(*w, width) && fits(*h, height)));
            }
        }
    }
    sizes.sort_unstable();
    sizes.dedup();
    sizes
}

/// Images a second at most.
fn rate_hz(device: &Device, name: FourCC, [width, height]: [usize; 2]) -> Option<f64> {
    let (width, height) = (u32::try_from(width).ok()?, u32::try_from(height).ok()?);
    let found = calmly(|| device.enum_frameintervals(name, width, height)).ok()?;
    let shortest = |interval: &FrameInterval| match &interval.interval {
        FrameIntervalEnum::Discrete(interval) => *interval,
        FrameIntervalEnum::Stepwise(steps) => steps.min,
    };
    let rates = found.iter().map(shortest).filter(|f| f.numerator > 0 && f.denominator > 0);
    rates.map(|f| f64::from(f.denominator) / f64::from(f.numerator)).max_by(f64::total_cmp)
}

/// Has a camera send a mode; what its images are like then, if it does, and how many it sends a second, if it says.
fn set(device: &Device, mode: &Mode) -> io::Result<Option<(Layout, Option<f64>)>> {
    let [width, height] = mode.size_px.map(|n| n as u32);
    let format = device.set_format(&Format::new(width, height, FourCC::new(&mode.name)))?;
    let mut rate_hz = mode.rate_hz;
    if let Some(rate) = mode.rate_hz {
        // in thousandths, as television's rates want; a camera that has one rate only need not know of rates
        let interval = Fraction::new(1000, (1000.0 * rate).round() as u32);
        if let Ok(granted) = device.set_params(&Parameters::new(interval))
            && let Fraction { numerator: 1.., denominator: 1.. } = granted.interval
        {
            rate_hz = Some(f64::from(granted.interval.denominator) / f64::from(granted.interval.numerator));
        }
    }
    let full_range = match (format.quantization, format.colorspace) {
        (Quantization::FullRange, _) | (Quantization::Default, Colorspace::JPEG) => true,
        (Quantization::Default | Quantization::LimitedRange, _) => false,
    };
    let size = [format.width as usize, format.height as usize];
    let is_so = format.fourcc.repr == mode.name && size == mode.size_px;
    let layout = Layout::new(mode.coding, size, format.stride as usize, full_range).filter(|_| is_so);
    Ok(layout.map(|layout| (layout, rate_hz)))
}

/// Why a camera has no mode that fits.
fn none_fits(modes: &[Mode], size_px: Option<[usize; 2]>) -> String {
    let mut sizes: Vec<[usize; 2]> = modes.iter().map(|mode| mode.size_px).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let sizes: Vec<String> = sizes.iter().map(|[width, height]| format!("{width}x{height}")).collect();
    match size_px {
        Some([width, height]) if !sizes.is_empty() => {
            format!("it sends no images of {width}x{height} px, but {}", sizes.join(", "))
        }
        _ => {
            "it sends nothing that is understood (MJPG, YUYV, UYVY, NV12, YU12, GREY, RGB3, BGR3)".to_owned()
        }
    }
}
