//! A head that was just powered up finds out where it points: it goes round and lights a dot here and there until the camera sees one.
//!
//! Encoders that count from where they were powered up know angles from there and no others. One dot in sight tells both joints' angles as well as it is known
//! how the head stands; dots all over the wall tell them to a fraction of a count.
//!
//! | part | what |
//! |---|---|
//! | `state` | a head that is being homed, and what is known of it meanwhile |
//! | `places` | where dots are lit, one after the other |
//! | `travel` | from one to the next, and back from whatever is in the way |
//! | `dot` | one dot, and whether the camera sees it |
//! | `again` | the same of a head that lost counts while it drew |

mod again;
mod dot;
mod places;
pub(crate) mod state;
mod travel;

use tracelight_aim::{Alignment, Camera, HeadGeometry, HeadPose};
use tracelight_lab::Quantiles;
use tracelight_pipeline::Driving;
use tracelight_rig::PanTilt;
use tracelight_rigfile::Timing;
use tracelight_session::Request;
use tracelight_stroke::Point;
use tracelight_task::{Failure, Task};

use crate::Driven;
use crate::head::{DotsRequest, find_head, see_dots};
use crate::homing::state::{Homing, REST_TICKS, anywhere};
use crate::power::check_homed;

pub use crate::homing::state::Homed;
pub use crate::homing::travel::may_be_a_stop;

/// Fewest spots by which a known head is homed.
const FEWEST_SPOTS: usize = 12;
/// Half of its dots tell of zeros that are no further apart, counts.
const MOST_APART_COUNTS: f64 = 0.75;

/// Homes a head by dots, wherever it points. Zero is then where a known head, as is believed, has it; of another, where pan has the beam
/// straight at the wall, and tilt has it square to the pan axis. `known` is of a head that was found before, when its images were taken and how long
/// they were exposed, s. The rig rests unhomed in the dark; afterwards at zero, homed.
///
/// # Errors
/// The spot is not found, or the head does not go where it is sent; or [`Failure::interrupted`].
pub fn home_head<D: Driven>(
    rig: &mut D,
    camera: &Camera,
    driving: &Driving,
    known: Option<(Timing, f64)>,
    task: Task<'_>,
) -> Result<Homed, Failure> {
    let _kept = task.stop.keep();
    let mut homing = Homing::new(rig, camera, driving, known, task);
    task.stage("homing", 1);
    let homed = homing.home(known.is_some(), task);
    homing.left(homed)
}

/// Homes a known head again that lost counts, few enough for its dots to be in sight where they should be. The rig rests at zero by its counts,
/// unhomed and dark; afterwards at zero, homed. `images` tells when they are taken and how long they are exposed, s.
///
/// # Errors
/// As for [`home_head`].
pub fn home_again<D: Driven>(
    rig: &mut D,
    camera: &Camera,
    driving: &Driving,
    images: (Timing, f64),
    task: Task<'_>,
) -> Result<Homed, Failure> {
    let _kept = task.stop.keep();
    let mut homing = Homing::new(rig, camera, driving, Some(images), task);
    let homed = homing.home_again();
    homing.left(homed)
}

/// By which angles a head is turned from where it should be to have zero, rad: pan from where its beam goes straight at the wall, tilt from where it is square to the pan axis.
#[must_use]
pub fn turned_rad(geometry: &HeadGeometry, pose: &HeadPose) -> Option<PanTilt<f64>> {
    let beam = HeadGeometry { laser_offset_m: [0.0; 3], ..anywhere(geometry) };
    let straight = beam.angles(pose, Point::new(pose.right_m, pose.up_m)).ok()?;
    Some(PanTilt::new(-straight.pan, geometry.beam_off_rad[1]))
}

/// By how much a known head's joints are truly further than its encoders say, rad: what most dots say.
fn off_rad<D: Driven>(
    rig: &mut D,
    camera: &Camera,
    driving: &Driving,
    request: &DotsRequest,
    task: Task<'_>,
) -> Result<PanTilt<f64>, Failure> {
    let geometry = anywhere(&driving.machine.geometry);
    let spots = see_dots(rig, camera, driving, request, task)?.spots();
    let off: Vec<PanTilt<f64>> = spots
        .iter()
        .filter_map(|spot| {
            let truly = geometry.angles(&driving.pose, spot.at).ok()?;
            Some(PanTilt::from_fn(|j| truly[j] - spot.angle_rad[j]))
        })
        .collect();
    if off.len() < FEWEST_SPOTS {
        let message = format!(
            "of the dots only {} were seen: is the camera's view of the wall free, and the laser on?",
            off.len()
        );
        return Err(Failure::failed("head-not-found", message));
    }
    let middle = PanTilt::from_fn(|j| Quantiles::of(off.iter().map(|off| off[j])).median);
    // of a head that stands as is believed all dots say the same
    let apart_rad =
        PanTilt::from_fn(|j| Quantiles::of(off.iter().map(|off| (off[j] - middle[j]).abs())).median);
    let count_rad = driving.rig.model.encoder.count_rad();
    if apart_rad.pan.max(apart_rad.tilt) > MOST_APART_COUNTS * count_rad {
        let message = "the head stands elsewhere than where it was found: its dots tell of different zeros; find it anew (calibrate head --home without --head)";
        return Err(Failure::failed("head-not-found", message));
    }
    Ok(middle)
}

impl<D: Driven> Homing<'_, D> {
    /// Dark whatever became of it; and a guess is not to be drawn by.
    fn left(&mut self, homed: Result<Homed, Failure>) -> Result<Homed, Failure> {
        let darkened = self.rig.ask(Request::Stop);
        let forgotten = if homed.is_err() { self.rig.ask(Request::Unhome) } else { Ok(()) };
        for _ in 0..REST_TICKS {
            self.rig.step()?;
        }
        homed.and_then(|homed| darkened.and(forgotten).map(|()| homed))
    }

    fn home(&mut self, is_known: bool, task: Task<'_>) -> Result<Homed, Failure> {
        let (sought, true_rad) = self.seek()?;
        self.tell(true_rad)?;
        let off_rad = if is_known {
            let few = DotsRequest::few(self.driving, self.timing, self.exposure_s);
            off_rad(self.rig, self.camera, self.driving, &few, task)?
        } else {
            let all = DotsRequest::first(self.driving);
            let found = find_head(self.rig, self.camera, self.driving, &all, task)?;
            let Alignment { geometry, pose, .. } = found.aligned.alignment;
            turned_rad(&geometry, &pose).ok_or_else(|| {
                Failure::failed("head-not-found", "the head as its dots tell does not face the wall: turn it by hand so that it does, and home it again")
            })?
        };
        let now = self.rest(1)?;
        self.tell(PanTilt::from_fn(|j| self.count_rad() * f64::from(now.measured[j].count) + off_rad[j]))?;
        Ok(Homed { sought, stops: self.stops, counts: self.counts })
    }

    /// Lights dots further and further off until one is seen. How many there were, and the joints' true angles at the last, rad.
    fn seek(&mut self) -> Result<(usize, PanTilt<f64>), Failure> {
        // before anything is remembered: while an image is waited for, nobody watches the ticks
        let change = self.change()?;
        let stride_rad = self.stride_rad();
        let mut at = PanTilt::new(0.0, 0.0);
        let mut tried: Vec<PanTilt<f64>> = Vec::new();
        for place in places::places(stride_rad, self.reach_rad()) {
            let Some(there) = self.reach(&mut at, place, stride_rad, &tried)? else { continue };
            tried.push(there);
            if let Some(spot) = self.dot(change)? {
                let geometry = anywhere(&self.driving.machine.geometry);
                let on_wall = self.camera.target(spot);
                let truly = on_wall.and_then(|on_wall| geometry.angles(&self.driving.pose, on_wall).ok());
                if let Some(truly) = truly {
                    return Ok((tried.len(), truly));
                }
            }
        }
        let message = format!(
            "the camera saw none of {} dots{}: is the laser on, and is the wall that the camera sees within the head's reach? Turn the head by hand so that it faces the wall, and home it again",
            tried.len(),
            if self.stops > 0 { ", and something was in the head's way" } else { "" },
        );
        Err(Failure::failed("head-not-found", message))
    }

    /// Tells the rig at which angles its joints rest, rad, and lets them go to zero.
    fn tell(&mut self, true_rad: PanTilt<f64>) -> Result<(), Failure> {
        let now = self.rest(REST_TICKS)?;
        // within the count it reads the observer knows no better than that it is somewhere
        let by = PanTilt::from_fn(|j| {
            (true_rad[j] / self.count_rad() - f64::from(now.measured[j].count)).round() as i32
        });
        let counts = PanTilt::from_fn(|j| now.measured[j].count + by[j]);
        if self.rig.ask(Request::Home(counts)).is_err() {
            let message = "the rig does not take where its joints are: they move, or they cannot be there; let it come to rest, and home it again";
            return Err(Failure::failed("unfinished", message));
        }
        self.counts = PanTilt::from_fn(|j| self.counts[j] + by[j]);
        self.rest(1)?;
        self.zero("the head does not come to where it was told zero is: is something in its way?")?;
        check_homed(&self.rest(1)?)
    }
}
