//! Cameras that are plugged in, by Video4Linux: what they can, what they are told, and their images with the times at which they were taken.
//!
//! | part | what |
//! |---|---|
//! | [`mode`] | what a camera can send, and which of it is taken |
//! | [`controls`] | exposure and gain |
//! | [`reader`] | images, read by a thread |

mod controls;
mod mode;
mod reader;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use moq_v4l::buffer::Type;
use moq_v4l::capability::Flags as Can;
use moq_v4l::format::{Colorspace, Quantization};
use moq_v4l::frameinterval::{FrameInterval, FrameIntervalEnum};
use moq_v4l::framesize::FrameSizeEnum;
use moq_v4l::io::mmap::Stream;
use moq_v4l::video::Capture;
use moq_v4l::video::capture::Parameters;
use moq_v4l::{Device, Format, FourCC, Fraction};

use super::about::{About, Rhythm};
use super::coding::{Coding, Layout};
use super::latest::Latest;
use super::source::devices;
use super::{Looks, Shot};
use crate::failure::Failure;
use crate::quiet::unless_it_panics;
use controls::Controls;
use mode::{Mode, chosen};
use reader::{PATIENCE, Reader, now_s};

/// A camera that is plugged in, sending images.
pub(crate) struct Plugged {
    path: String,
    /// What its maker calls it, and its driver.
    name: String,
    driver: String,
    /// What it can send.
    modes: Vec<Mode>,
    /// What it sends.
    mode: Mode,
    controls: Controls,
    reader: Arc<Reader>,
    opened_s: f64,
    /// Images whose exposure began earlier are exposed otherwise.
    settled_s: f64,
}

/// How many images go by until one is exposed as it was told: two are on their way, or half exposed.
const SETTLING_IMAGES: f64 = 3.0;
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
        let told = |error: io::Error| failed(&words(path, &error));
        let device = Device::with_path(path).map_err(told)?;
        let unknown = || failed("its driver says what nobody knows");
        let about = unless_it_panics(|| device.query_caps()).ok_or_else(unknown)?.map_err(told)?;
        if !about.capabilities.contains(Can::VIDEO_CAPTURE | Can::STREAMING) {
            return Err(failed("it sends no images; a camera often has a second device that does"));
        }
        let modes = modes(&device, size_px);
        let mode = chosen(&modes, size_px).ok_or_else(|| failed(&none_fits(&modes, size_px)))?;
        let layout = unless_it_panics(|| set(&device, &mode)).ok_or_else(unknown)?.map_err(told)?;
        let layout = layout.ok_or_else(|| failed(&format!("it does not send {mode} when told to")))?;
        let stream = unless_it_panics(|| Stream::with_buffers(&device, Type::VideoCapture, BUFFERS));
        let stream = stream.ok_or_else(unknown)?.map_err(told)?;
        let reader = Arc::new(Reader {
            layout,
            interval_s: 1.0 / mode.rate_hz.unwrap_or(USUAL_HZ),
            latest: Latest::default(),
            rhythm: Mutex::default(),
            is_over: AtomicBool::new(false),
        });
        let controls = Controls::take_over(device);
        let reads = Arc::clone(&reader);
        std::thread::spawn(move || reads.read_all(stream));
        let opened_s = now_s();
        let settles = if controls.exposure_s().is_some() { 0.0 } else { WARMING_S };
        Ok(Self {
            path: path.to_owned(),
            name: about.card,
            driver: about.driver,
            modes,
            mode,
            controls,
            reader,
            opened_s,
            settled_s: opened_s + settles,
        })
    }

    fn rhythm(&self) -> Rhythm {
        self.reader.rhythm.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn failed(&self, why: &str) -> Failure {
        Failure::failed("no-image", format!("the camera {}: {why}", self.path))
    }
}

impl Looks for Plugged {
    fn take(&mut self, exposure_s: f64) -> Result<Shot, Failure> {
        let told_s = now_s();
        let mut exposed_s = 0.0;
        self.settled_s = self.settled_s.max(told_s);
        match self.controls.expose(exposure_s) {
            Some(Ok((is, has_changed))) => {
                exposed_s = is;
                if has_changed {
                    self.settled_s = told_s + SETTLING_IMAGES * self.reader.interval_s;
                }
            }
            Some(Err(error)) => return Err(self.failed(&format!("it cannot be exposed as told: {error}"))),
            None => {}
        }
        while now_s() < self.settled_s + PATIENCE.as_secs_f64() {
            let image = self.reader.latest.next(PATIENCE).map_err(|why| match self.rhythm() {
                Rhythm { images: 0, broken, .. } if broken > 0 => {
                    self.failed(&format!("{broken} images came, none of them whole: is its cable bad?"))
                }
                _ => self.failed(&why),
            })?;
            if image.began_s >= self.settled_s {
                let (from, stamp_s) = (self.path.as_str(), image.began_s - self.opened_s);
                return Ok(Shot::sent(from, self.reader.layout, image.bytes, [stamp_s, exposed_s]));
            }
        }
        Err(self.failed("the images it sends were taken long ago: is the machine overloaded?"))
    }

    fn longest(&self) -> Option<f64> {
        // longer, and images would be fewer
        Some(self.controls.exposure_s()?[1].min(self.reader.interval_s))
    }

    fn brighten(&mut self) -> bool {
        let has_changed = self.controls.brighten();
        if has_changed {
            self.settled_s = now_s() + SETTLING_IMAGES * self.reader.interval_s;
        }
        has_changed
    }

    fn about(&self) -> About {
        About {
            name: Some(self.name.clone()),
            driver: Some(self.driver.clone()),
            modes: self.modes.iter().map(Mode::to_string).collect(),
            mode: Some(self.mode.to_string()),
            exposure_s: self.controls.exposure_s(),
            gain: self.controls.gain(),
            focuses: self.controls.focuses(),
            rhythm: self.rhythm(),
        }
    }
}

impl Drop for Plugged {
    fn drop(&mut self) {
        self.reader.is_over.store(true, Ordering::SeqCst);
    }
}

/// What a camera can send that is understood; at a size that is wanted, and at usual ones, of one that sends any.
fn modes(device: &Device, size_px: Option<[usize; 2]>) -> Vec<Mode> {
    let mut modes = Vec::new();
    let formats = unless_it_panics(|| device.enum_formats()).and_then(Result::ok).unwrap_or_default();
    let known = |name: FourCC| Some((name, Coding::named(name.repr)?));
    for (name, coding) in formats.into_iter().filter_map(|format| known(format.fourcc)) {
        for size_px in sizes(device, name, size_px) {
            modes.push(Mode { name: name.repr, coding, size_px, rate_hz: rate_hz(device, name, size_px) });
        }
    }
    if modes.is_empty()
        && let Some(Ok(now)) = unless_it_panics(|| device.format())
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
    let found = unless_it_panics(|| device.enum_framesizes(name)).and_then(Result::ok).unwrap_or_default();
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
    let found = unless_it_panics(|| device.enum_frameintervals(name, width, height))?.ok()?;
    let shortest = |interval: &FrameInterval| match &interval.interval {
        FrameIntervalEnum::Discrete(interval) => *interval,
        FrameIntervalEnum::Stepwise(steps) => steps.min,
    };
    let rates = found.iter().map(shortest).filter(|f| f.numerator > 0 && f.denominator > 0);
    rates.map(|f| f64::from(f.denominator) / f64::from(f.numerator)).max_by(f64::total_cmp)
}

/// Has a camera send a mode; what its images are like then, if it does.
fn set(device: &Device, mode: &Mode) -> io::Result<Option<Layout>> {
    let [width, height] = mode.size_px.map(|n| n as u32);
    let format = device.set_format(&Format::new(width, height, FourCC::new(&mode.name)))?;
    if let Some(rate) = mode.rate_hz {
        // in thousandths, as television's rates want; a camera that has one rate only need not know of rates
        let interval = Fraction::new(1000, (1000.0 * rate).round() as u32);
        drop(device.set_params(&Parameters::new(interval)));
    }
    let full_range = match (format.quantization, format.colorspace) {
        (Quantization::FullRange, _) => true,
        (Quantization::Default, Colorspace::JPEG) => true,
        (Quantization::Default | Quantization::LimitedRange, _) => false,
    };
    let size = [format.width as usize, format.height as usize];
    let is_so = format.fourcc.repr == mode.name && size == mode.size_px;
    Ok(Layout::new(mode.coding, size, format.stride as usize, full_range).filter(|_| is_so))
}

/// Why a camera has no mode that fits.
fn none_fits(modes: &[Mode], size_px: Option<[usize; 2]>) -> String {
    let mut sizes: Vec<String> =
        modes.iter().map(|mode| format!("{}x{}", mode.size_px[0], mode.size_px[1])).collect();
    sizes.dedup();
    match size_px {
        Some([width, height]) if !sizes.is_empty() => {
            format!("it sends no images of {width}x{height} px, but {}", sizes.join(", "))
        }
        _ => {
            "it sends nothing that is understood (MJPG, YUYV, UYVY, NV12, YU12, GREY, RGB3, BGR3)".to_owned()
        }
    }
}

/// Why a camera cannot be used, in words.
fn words(path: &str, error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => {
            let all: Vec<String> = devices().iter().map(|path| path.display().to_string()).collect();
            let there = if all.is_empty() {
                "there is none".to_owned()
            } else {
                format!("there is {}", all.join(", "))
            };
            format!("no such device ({there}): is it plugged in? `tracelight doctor` lists what is there")
        }
        io::ErrorKind::PermissionDenied => {
            format!(
                "you may not use it: add yourself to the group that owns it (sudo usermod -aG video $USER; ls -l {path}) and log in again"
            )
        }
        io::ErrorKind::ResourceBusy => "another program uses it: close that first".to_owned(),
        _ => error.to_string(),
    }
}
