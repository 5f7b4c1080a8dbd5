//! Where images come from that are not simulated: files, one after the other, and cameras on the net.

use std::collections::VecDeque;

use super::stream::Stream;
use super::{Looks, Shot};
use crate::batch::pictures;
use crate::failure::Failure;
use crate::picture;

/// A camera, as `--camera` names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source<'a> {
    /// `sim`, `sim:PICTURE`: a simulated one, and what is on its wall.
    Simulated(Option<&'a str>),
    /// `http://…`: a stream of images, or one each time it is asked.
    Net(&'a str),
    /// A file or a folder of them.
    Files(&'a str),
}

impl<'a> Source<'a> {
    /// What `--camera` says.
    pub(crate) fn of(text: &'a str) -> Result<Self, Failure> {
        let wrong = |what: &str| {
            let known =
                "sim:PICTURE (simulated), http://… (a camera on the net), or an image or a folder of them";
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
        if std::path::Path::new(text).exists() {
            Ok(Self::Files(text))
        } else {
            Err(wrong("is no camera that is known, and no file"))
        }
    }

    /// Opens it, unless it is simulated.
    pub(crate) fn open(self) -> Result<Option<Box<dyn Looks>>, Failure> {
        Ok(match self {
            Self::Simulated(_) => None,
            Self::Net(url) => Some(Box::new(Stream::open(url)?)),
            Self::Files(path) => Some(Box::new(Files::open(path)?)),
        })
    }
}

/// Images that were taken before, in the order of their names.
struct Files {
    of: String,
    left: VecDeque<String>,
    taken: u32,
}

impl Files {
    fn open(path: &str) -> Result<Self, Failure> {
        let found = pictures::find(&[path.to_owned()], false)?;
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
        let bytes = picture::read_bytes(&name)?;
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
        for wrong in ["sim:", "simulated", "https://a/b", "/nowhere/at/all"] {
            assert!(Source::of(wrong).unwrap_err().message.contains("give sim:PICTURE"), "{wrong}");
        }
    }
}
