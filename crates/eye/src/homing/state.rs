//! A head that is being homed, and what is known of it meanwhile.

use tracelight_aim::{Camera, HeadGeometry};
use tracelight_pipeline::Driving;
use tracelight_rig::PanTilt;
use tracelight_rigfile::Timing;
use tracelight_task::Task;

use crate::Driven;
use crate::figures::HomedFigures;
use crate::head::SPOT_EXPOSURE_S;
use crate::spots::History;

/// How long a joint rests after a motion until a dot is lit, ticks.
pub(super) const REST_TICKS: u32 = 150;
/// How far before a stop a joint turns back, rad.
pub(super) const BEFORE_STOP_RAD: f64 = 0.03;

/// A head whose encoders were told where it stands.
#[derive(Clone, Copy, Debug)]
pub struct Homed {
    /// Dots that were lit until one was seen.
    pub sought: usize,
    /// How often something was in a joint's way.
    pub stops: usize,
    /// What its encoders read where they read 0 before.
    pub counts: PanTilt<i32>,
}

impl Homed {
    /// The same as figures.
    #[must_use]
    pub fn figures(&self) -> HomedFigures {
        let PanTilt { pan, tilt } = self.counts.map(|count| -count);
        HomedFigures { sought: self.sought, stops: self.stops, pan_counts: pan, tilt_counts: tilt }
    }
}

/// The same head with joints that go anywhere in front of it: where one stands that was left, its range does not tell.
pub(super) fn anywhere(geometry: &HeadGeometry) -> HeadGeometry {
    const NEARLY_RIGHT_RAD: f64 = 1.4;
    let all = (-NEARLY_RIGHT_RAD, NEARLY_RIGHT_RAD);
    HeadGeometry { range_rad: PanTilt::new(all, all), ..*geometry }
}

/// A rig that is being homed, and what is known meanwhile.
pub(super) struct Homing<'a, D> {
    pub(super) rig: &'a mut D,
    pub(super) camera: &'a Camera,
    pub(super) driving: &'a Driving,
    pub(super) task: Task<'a>,
    pub(super) history: History,
    /// When images are taken, by their stamps, and how long they are exposed, s.
    pub(super) timing: Timing,
    pub(super) exposure_s: f64,
    /// What was added to what its encoders read, until now.
    pub(super) counts: PanTilt<i32>,
    /// How far the joints may turn from where they were powered up: as wide as their ranges are, or until something is in their way, rad.
    pub(super) free_rad: PanTilt<(f64, f64)>,
    /// How often something was.
    pub(super) stops: usize,
}

impl<'a, D: Driven> Homing<'a, D> {
    pub(super) fn new(
        rig: &'a mut D,
        camera: &'a Camera,
        driving: &'a Driving,
        known: Option<(Timing, f64)>,
        task: Task<'a>,
    ) -> Self {
        // an unhomed rig goes no further from where it was powered up than its joints' ranges are wide
        let free_rad = driving.machine.geometry.range_rad.map(|(lower, upper)| {
            let width_rad = (upper - lower - BEFORE_STOP_RAD).max(0.0);
            (-width_rad, width_rad)
        });
        let (timing, exposure_s) = known.unwrap_or((Timing::USUAL, SPOT_EXPOSURE_S));
        let exposure_s = exposure_s.min(rig.longest_s());
        Self {
            rig,
            camera,
            driving,
            task,
            history: History::new(&driving.rig.model.relay),
            timing,
            exposure_s,
            counts: PanTilt::default(),
            free_rad,
            stops: 0,
        }
    }

    pub(super) fn count_rad(&self) -> f64 {
        self.driving.rig.model.encoder.count_rad()
    }
}
