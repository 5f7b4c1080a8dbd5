//! What is asked of a job, as values.

use tracelight_eye::Looks;
use tracelight_eye::room::SimulatedEye;
use tracelight_eye::trouble::TroubleAt;
use tracelight_picture::Pixels;
use tracelight_pipeline::{Driving, Placing, Tracing};
use tracelight_rigfile::camera::KnownCamera;
use tracelight_rigfile::head::KnownHead;

/// What is to be drawn, by what, and how.
#[derive(Clone)]
pub struct Request<'a> {
    /// As people call it: the picture's file, or the camera.
    pub name: &'a str,
    /// How its pixels become strokes.
    pub tracing: Tracing,
    /// Where it goes on the target.
    pub placing: Placing,
    /// The rig where it stands, and what is asked of it.
    pub driving: Driving,
    /// How it is run.
    pub run: RunRequest,
}

/// How a job is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunRequest {
    /// How often, each time from power-up, the head identified between them.
    pub laps: u32,
    /// What differs from head to head is drawn from it.
    pub seed: u64,
    /// The laser's gate is held dark.
    pub dry: bool,
    /// A simulated head was just powered up, and nobody homed it.
    pub powered_up: bool,
}

impl Default for RunRequest {
    /// Once, lit, by a head that was homed.
    fn default() -> Self {
        Self { laps: 1, seed: 0, dry: false, powered_up: false }
    }
}

/// A wall that a camera looks at: what it sees there is drawn, in place.
pub struct Wall<'a> {
    /// Where images of it come from.
    pub scene: Scene<'a>,
    /// What is known of the camera.
    pub camera: Option<KnownCamera>,
    /// What is known of the head; otherwise it draws dots first, and the camera finds it.
    pub head: Option<KnownHead>,
    /// The head finds out where it points before it draws.
    pub home: bool,
    /// Most further images that are taken where one shows no markers or no figure.
    pub retakes: u32,
    /// What the camera sees while the laser draws is told, but nothing is made of it.
    pub open_loop: bool,
    /// What goes wrong in a simulated room.
    pub troubles: Vec<TroubleAt>,
    /// The day, such as 2026-11-23.
    pub today: String,
}

/// Where images of a wall come from.
pub enum Scene<'a> {
    /// A camera.
    Camera(&'a mut dyn Looks),
    /// A simulated room.
    Room {
        /// A picture on its wall, and its name.
        picture: Option<(&'a str, Pixels)>,
        /// What looks.
        eye: SimulatedEye,
        /// Whether pages of markers hang there.
        pages: bool,
    },
}
