//! Which camera looks.

use std::str::FromStr;

use clap::{Args, ValueEnum};
use tracelight_aim::HeadPose;
use tracelight_camera::{Opened, Source};
use tracelight_eye::Looks;
use tracelight_eye::room::{Furnished, RoomRequest, SimulatedEye};
use tracelight_eye::trouble::TroubleAt;
use tracelight_pipeline::{DEFAULT_DISTANCE_M, Placing};
use tracelight_rigfile::camera::KnownCamera;
use tracelight_session::Session;
use tracelight_sim::RigConfig;
use tracelight_task::Failure;

use crate::named;

/// Which camera looks at the wall.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct EyeArgs {
    /// Source of images: a camera, simulated or real, or recorded images
    ///
    /// sim:PICTURE  a simulated camera, in front of a simulated wall with
    ///              PICTURE on it
    /// /dev/video0  a connected camera (`tracelight doctor` lists them)
    /// http://…     a network camera that sends an MJPEG stream, or an image
    ///              per request
    /// FILE         an image, or a video (Motion JPEG: .mjpeg, .avi, .mkv,
    ///              .mov)
    /// FOLDER       a folder of images
    #[arg(long, value_name = "SOURCE", verbatim_doc_comment)]
    pub(crate) camera: Option<String>,
    /// Columns and rows of the images of a connected camera [default: those it was calibrated for, or else about 1280x720]
    #[arg(long, value_name = "WxH", requires = "camera")]
    pub(crate) camera_size: Option<ImageSize>,
    /// Simulated camera
    #[arg(help_heading = "Simulation", long, value_enum, default_value_t, requires = "camera")]
    pub(crate) sim_camera: SimulatedEyeName,
    /// What is known of the camera: a file that `calibrate markers` or `calibrate lens` has written. If no markers are in sight, the
    /// camera is assumed not to have moved
    #[arg(long, value_name = "FILE.toml", requires = "camera")]
    pub(crate) calibration: Option<String>,
}

/// Which camera is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SimulatedEyeName {
    /// 1280 × 720 px, as far away as it takes to see all
    #[default]
    Webcam,
    /// The 2006 report's: 320 × 240 px, 3 ft away
    Report,
}

impl SimulatedEyeName {
    pub(crate) const fn eye(self) -> SimulatedEye {
        match self {
            SimulatedEyeName::Webcam => SimulatedEye::Webcam,
            SimulatedEyeName::Report => SimulatedEye::Report,
        }
    }
}

/// What is before a simulated camera.
pub(crate) struct SimulatedWall {
    pub(crate) eye: SimulatedEyeName,
    /// Where its picture hangs.
    pub(crate) placing: Placing,
    /// Whether pages of markers hang there.
    pub(crate) pages: bool,
    pub(crate) seed: u64,
}

/// A camera that takes images when told: one that was opened, or that of a simulated room.
pub(crate) fn looking(opened: Opened<'_>, wall: &SimulatedWall) -> Result<Box<dyn Looks>, Failure> {
    let picture = match opened {
        Opened::Camera(camera) => return Ok(camera),
        Opened::Simulated(picture) => picture.map(named::painted).transpose()?,
    };
    let (rig, pose) = (RigConfig::report(), HeadPose::square_on(DEFAULT_DISTANCE_M));
    let SimulatedWall { eye, placing, pages, seed } = wall;
    let request =
        RoomRequest { picture: picture.as_ref(), placing, eye: eye.eye(), pages: *pages, seed: *seed };
    let room = Furnished::new(&request, &rig, pose)?.watched(&rig, pose);
    Ok(Box::new(Session::new(room)))
}

/// How a camera follows the spot while it draws.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct FollowArgs {
    /// What the camera sees while the laser draws is reported but not used: no aim correction, no recovery of a bumped head
    #[arg(long, requires = "camera")]
    pub(crate) open_loop: bool,
    /// Inject a fault in the simulated room, or with --rig emulated: FAULT@SECONDS after drawing began; repeatable
    ///
    /// pan-slip=COUNTS        the pan encoder slips by so many counts
    /// tilt-slip=COUNTS       the tilt encoder does
    /// head-bump=DEGREES      a bump turns the head by that angle
    /// power-loss             the rig loses power
    /// drift=PERCENT          the scale of both axes grows linearly, by that
    ///                        share until the end of the job
    /// camera-bump=PX         the middle of the image moves by so many px
    /// camera-unplugged       the camera sends no more images
    /// camera-frozen          the camera repeats its last image
    /// camera-black           something covers the lens
    /// camera-slow=HZ         the camera sends so many images per second
    /// camera-stamps=SECONDS  time stamps of images are off by up to that
    /// unplug=SECONDS         the cable to an emulated board is pulled for so long
    /// host-stall=SECONDS     the host of an emulated board hangs for so long
    /// link-loss=1%           so many packets are lost; all the time, without @
    /// link-corrupt=1%        so many come spoilt; link-delay=MS, link-jitter=MS
    ///
    /// pan-slip=20@5: the pan encoder slips by 20 counts after 5 s.
    #[arg(help_heading = "Simulation", long, value_name = "TROUBLE", verbatim_doc_comment)]
    pub(crate) sim_trouble: Vec<TroubleAt>,
}

/// Columns and rows of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ImageSize(pub(crate) [usize; 2]);

impl FromStr for ImageSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse().ok().filter(|n| (1..=100_000).contains(n));
        let pair = text.trim_end_matches("px").split_once(['x', '×']);
        pair.and_then(|(width, height)| Some(Self([number(width)?, number(height)?]))).ok_or_else(|| {
            format!(
                "{text} is no size of an image; write columns x rows, such as 1280x720, 1 to 100000 of either"
            )
        })
    }
}

impl EyeArgs {
    /// The camera, sending images, or what is simulated.
    pub(crate) fn open(&self) -> Result<Opened<'_>, Failure> {
        let known = || Ok::<_, Failure>(self.known()?.map(|known| known.lens.lens.size_px));
        let size = self.camera_size.map_or_else(known, |size| Ok(Some(size.0)))?;
        self.source()?.open(size)
    }

    /// The camera.
    pub(crate) fn source(&self) -> Result<Source<'_>, Failure> {
        let missing = "which camera? --camera sim is a simulated one, --camera /dev/video0 one that is plugged in, --camera http://… one on the net";
        Source::of(self.camera.as_deref().ok_or_else(|| Failure::usage("usage", missing))?)
    }

    /// Whether pages of markers hang on a simulated wall: the report's camera does not see them and a picture at once, and they are taken
    /// down once it is calibrated.
    pub(crate) fn has_pages(&self) -> Result<bool, Failure> {
        let stood = self.known()?.is_some_and(|known| known.stood.is_some());
        Ok(self.sim_camera == SimulatedEyeName::Webcam || !stood)
    }

    /// What is known of it.
    pub(crate) fn known(&self) -> Result<Option<KnownCamera>, Failure> {
        self.calibration.as_deref().map(named::camera).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_columns_and_rows() {
        assert_eq!("1280x720".parse(), Ok(ImageSize([1280, 720])));
        assert_eq!("320×240px".parse(), Ok(ImageSize([320, 240])));
        for wrong in ["", "1280", "x", "0x5", "1280x", "12.5x3", "1x2x3", "99999999999999999999x1", "-1x5"] {
            assert!(wrong.parse::<ImageSize>().unwrap_err().contains("such as 1280x720"), "{wrong}");
        }
    }
}
