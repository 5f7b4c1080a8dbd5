//! Where images come from that are not simulated: files and films, one image after the other, and cameras.

use std::collections::VecDeque;

use tracelight_files as files;
use tracelight_task::Failure;

use crate::film::{self, Film};
use crate::stream::Stream;
use tracelight_eye::{Looks, Shot};

/// A camera, as `--camera` names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source<'a> {
    /// `sim`, `sim:PICTURE`: a simulated one, and what is on its wall.
    Simulated(Option<&'a str>),
    /// `http://…`: a stream of images, or one each time it is asked.
    Net(&'a str),
    /// `/dev/…`: one that is plugged in.
    Device(&'a str),
    /// A file of many images.
    Film(&'a str),
    /// An image, or a folder of them.
    Files(&'a str),
}

/// A source that was opened.
pub enum Opened<'a> {
    /// It sends images.
    Camera(Box<dyn Looks>),
    /// It is simulated: what is on its wall.
    Simulated(Option<&'a str>),
}

impl<'a> Source<'a> {
    /// What `--camera` says.
    ///
    /// # Errors
    /// `usage`: what is no camera and no file, with what may be given.
    pub fn of(text: &'a str) -> Result<Self, Failure> {
        let wrong = |what: &str| {
            let known = "sim:PICTURE (simulated), /dev/video0 (one that is plugged in), http://… (one on the net), or an image, a folder of them, or a film of them (Motion JPEG)";
            Failure::usage("usage", format!("--camera {text} {what}; give {known}"))
        };
        match text.strip_prefix("sim") {
            Some("") => return Ok(Self::Simulated(None)),
            Some(":") => return Err(wrong("names no picture")),
            Some(rest) if rest.starts_with(':') => return Ok(Self::Simulated(Some(&rest[1..]))),
            _ => {}
        }
        if text.starts_with("https://") {
            return Err(wrong("would need encryption, which is not spoken"));
        }
        if text.starts_with("http://") {
            return Ok(Self::Net(text));
        }
        if is_device(text) {
            return Ok(Self::Device(text));
        }
        let path = std::path::Path::new(text);
        match path.exists() {
            true if film::is_film(text) && !path.is_dir() => Ok(Self::Film(text)),
            true => Ok(Self::Files(text)),
            false => Err(wrong("is no camera that is known, and no file")),
        }
    }

    /// Opens it, unless it is simulated; one that is plugged in sends images of so many columns and rows, if that is asked for.
    ///
    /// # Errors
    /// What cannot be opened, or sends nothing that is understood.
    pub fn open(self, size_px: Option<[usize; 2]>) -> Result<Opened<'a>, Failure> {
        let camera: Box<dyn Looks> = match self {
            Self::Simulated(picture) => return Ok(Opened::Simulated(picture)),
            Self::Device(path) => plugged(path, size_px)?,
            Self::Net(url) => Box::new(Stream::open(url)?),
            Self::Film(path) => Box::new(Film::open(path)?),
            Self::Files(path) => Box::new(Files::open(path)?),
        };
        Ok(Opened::Camera(camera))
    }
}

/// Whether a name is that of a video device, be it plugged in or not.
fn is_device(name: &str) -> bool {
    #[cfg(unix)]
    if let Ok(about) = std::fs::metadata(name) {
        use std::os::unix::fs::FileTypeExt;
        return about.file_type().is_char_device();
    }
    ["/dev/video", "/dev/v4l/"].iter().any(|begin| name.starts_with(begin))
}

/// A camera that is plugged in.
#[cfg(target_os = "linux")]
fn plugged(path: &str, size_px: Option<[usize; 2]>) -> Result<Box<dyn Looks>, Failure> {
    Ok(Box::new(crate::device::Plugged::open(path, size_px)?))
}

/// A camera that is plugged in.
#[cfg(not(target_os = "linux"))]
fn plugged(path: &str, _: Option<[usize; 2]>) -> Result<Box<dyn Looks>, Failure> {
    let message = format!(
        "the camera {path}: cameras that are plugged in are read on Linux only; have a program send its images by http://"
    );
    Err(Failure::failed("no-camera", message))
}

/// Images that were taken before, in the order of their names.
struct Files {
    of: String,
    left: VecDeque<String>,
    taken: u32,
}

impl Files {
    fn open(path: &str) -> Result<Self, Failure> {
        let found = files::find(&[path.to_owned()], false)?;
        Ok(Self {
            of: path.to_owned(),
            left: found.pictures.into_iter().map(|picture| picture.name).collect(),
            taken: 0,
        })
    }
}

impl Looks for Files {
    fn take(&mut self, _: f64) -> Result<Shot, Failure> {
        let Some(name) = self.left.pop_front() else {
            return Err(Failure::failed(
                "no-image",
                format!("{} has no image after its {}", self.of, self.taken),
            ));
        };
        self.taken += 1;
        let bytes = files::read(&name)?;
        // as if thirty had been taken a second
        Ok(Shot::encoded(&name, bytes, f64::from(self.taken) / 30.0))
    }

    fn longest(&self) -> Option<f64> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_source_is_told_by_its_name() {
        assert_eq!(Source::of("sim").unwrap(), Source::Simulated(None));
        assert_eq!(Source::of("sim:a.png").unwrap(), Source::Simulated(Some("a.png")));
        assert_eq!(Source::of("http://10.0.0.2/video").unwrap(), Source::Net("http://10.0.0.2/video"));
        assert_eq!(
            Source::of(env!("CARGO_MANIFEST_DIR")).unwrap(),
            Source::Files(env!("CARGO_MANIFEST_DIR"))
        );
        assert_eq!(Source::of("/dev/video7").unwrap(), Source::Device("/dev/video7"));
        for wrong in ["sim:", "simulated", "https://a/b", "/nowhere/at/all"] {
            assert!(Source::of(wrong).unwrap_err().message.contains("give sim:PICTURE"), "{wrong}");
        }
    }
}
