//! The simulated head: volts and switches in, edges of encoders out.

use std::cell::RefCell;

use tracelight_aim::{HeadGeometry, HeadPose};
use tracelight_plant::Plant;
use tracelight_rig::{Actuation, Joint, PanTilt, Sensed};

use crate::rig;

/// From head to wall, m: three feet.
const DISTANCE_M: f64 = 0.9144;
/// Edges that a part of a tick can have at most; a joint that fast is none.
const MOST_EDGES: usize = 256;

struct Head {
    plant: Plant,
    geometry: HeadGeometry,
    pose: HeadPose,
    sensed: Sensed,
    edges: [[f64; 3]; MOST_EDGES],
    /// Volts that are all that a bridge gives.
    supply_v: PanTilt<f64>,
}

thread_local! {
    static HEAD: RefCell<Option<Head>> = const { RefCell::new(None) };
}

fn with<T: Default>(what: impl FnOnce(&mut Head) -> T) -> T {
    HEAD.with_borrow_mut(|head| head.as_mut().map(what)).unwrap_or_default()
}

const fn joint(number: u32) -> Joint {
    if number == 0 { Joint::Pan } else { Joint::Tilt }
}

/// A head of the preset `bridge` at rest, within one count of straight ahead, square on at the report's distance; with a gyroscope at its foot or without.
// SAFETY: nothing else of the module has that name, here and below
#[unsafe(no_mangle)]
pub extern "C" fn begin(seed: u32, has_gyroscope: u32) {
    let mut config = rig();
    config.truth.gyroscope.fitted = has_gyroscope != 0;
    let truth = config.plant_config();
    HEAD.set(Some(Head {
        plant: Plant::new(&truth, seed.into()),
        geometry: config.truth.model.geometry,
        pose: HeadPose::square_on(DISTANCE_M),
        sensed: Sensed::default(),
        edges: [[0.0; 3]; MOST_EDGES],
        supply_v: PanTilt::from_fn(|j| truth.motors[j].limit_v),
    }));
}

/// Lets some time pass, s, with these shares of the supply at the motors; how many edges came.
#[unsafe(no_mangle)]
pub extern "C" fn pass(pan: f64, tilt: f64, gate: u32, enable: u32, lasts_s: f64) -> u32 {
    with(|head| {
        let command_v = PanTilt::new(pan * head.supply_v.pan, tilt * head.supply_v.tilt);
        let actuation =
            Actuation { command_v: command_v.map(|v| v as f32), gate: gate != 0, enable: enable != 0 };
        let Head { plant, edges, .. } = head;
        let mut count = 0;
        head.sensed = plant.pass(&actuation, lasts_s, |joint, at, after_s| {
            if let Some(edge) = edges.get_mut(count) {
                *edge = [f64::from(joint as u8), f64::from(at), after_s];
            }
            count += 1;
        });
        count.min(MOST_EDGES) as u32
    })
}

/// Where the edges of the last part lie: joint, count, and seconds since the part began, three `f64` each, joint by joint.
#[unsafe(no_mangle)]
pub extern "C" fn edges() -> *const f64 {
    HEAD.with_borrow(|head| head.as_ref().map_or(std::ptr::null(), |head| head.edges.as_ptr().cast()))
}

/// What an encoder reads.
#[unsafe(no_mangle)]
pub extern "C" fn count(number: u32) -> i32 {
    with(|head| head.plant.measured()[joint(number)].count)
}

/// Whether light leaves the head.
#[unsafe(no_mangle)]
pub extern "C" fn light() -> u32 {
    with(|head| head.plant.light().into())
}

/// Where the beam meets the wall, m: x of 0, y of 1; no number where it misses it.
#[unsafe(no_mangle)]
pub extern "C" fn spot(axis: u32) -> f64 {
    with(|head| {
        let spot = head.geometry.spot(&head.pose, head.plant.beam_rad());
        spot.map_or(f64::NAN, |spot| if axis == 0 { spot.x } else { spot.y })
    })
}

/// How fast the foot turns about the head's x, y and z, rad/s, as a gyroscope sees it.
#[unsafe(no_mangle)]
pub extern "C" fn turning(axis: u32) -> f64 {
    with(|head| head.sensed.foot_rad_s.map_or(0.0, |rad_s| f64::from(rad_s[axis as usize % 3])))
}

/// Somebody bumps into the head: it turns by so much about pan's and tilt's axes, rad.
#[unsafe(no_mangle)]
pub extern "C" fn bump(pan: f64, tilt: f64) {
    with(|head| head.plant.bump(PanTilt::new(pan, tilt)));
}
