//! The head found from dots that it draws and a camera sees.
//!
//! A dot is a circle of a few millimetres, drawn slowly: at rest an encoder says no more than between which two of its edges a joint is.

use std::f64::consts::PI;

use tracelight_aim::{AlignError, Aligned, Alignment, AlignmentBelief, Camera, HeadPose, SeenSpot, align};
use tracelight_maths::{atan2, planar};
use tracelight_pipeline::{Driving, refused};
use tracelight_rigfile::Timing;
use tracelight_rigfile::head::KnownHead;
use tracelight_session::{Request, State};
use tracelight_sim::{DriveKind, RigConfig, Simulated as _, job_of};
use tracelight_stroke::{Drawing, Element, Path, Point, Stroke, Vec2};
use tracelight_task::{Failure, Task};
use tracelight_trajectory::{Plan, PlanRequest, plan};

use crate::power::check_homed;
use crate::spots::{History, Sight, Sighting, SpotWatch};
use crate::wall::SeenWall;
use crate::{Driven, Eye, Looks};

/// Radius of a dot, m: three and a half counts of the report's encoders at 3 ft.
const DOT_M: f64 = 0.005;
/// Speed at which it is drawn, m/s.
const DOT_SPEED_M_S: f64 = 0.1;
/// Dots across, and as many down: of a head of which nothing is known, and of one that moved.
const ACROSS: usize = 5;
pub(crate) const ACROSS_AGAIN: usize = 3;
/// Images of dots of a head that moved in which nothing is seen: it points elsewhere.
const IN_VAIN: usize = 6;
/// Share of the image, from its border, in which none are drawn.
const BORDER: f64 = 0.08;
/// A first guess of an exposure in which the spot is not full, s.
pub const SPOT_EXPOSURE_S: f64 = 2e-3;
/// Ticks after a job, or a fault, in which its last images arrive.
const AFTERMATH_TICKS: u32 = 300;
/// How often lateness is estimated anew: each time what is left is a tenth or less.
const ROUNDS: usize = 4;

/// A head that was found.
pub struct FoundHead {
    /// How it is built and stands.
    pub aligned: Aligned,
    /// When the camera's images are taken.
    pub timing: Timing,
    /// Exposure in which the spot is not full, s.
    pub exposure_s: f64,
    /// Dots that were drawn.
    pub dots: usize,
    /// Images in which the spot was looked for in vain.
    pub lost: usize,
}

/// What is known before dots are drawn.
pub struct DotsRequest {
    belief: AlignmentBelief,
    timing: Timing,
    /// A first guess of an exposure in which the spot is not full, s.
    exposure_s: f64,
    /// Dots across, and as many down.
    across: usize,
    /// After so many images in which the spot was looked for and never once seen it is given up.
    most_in_vain: usize,
}

impl DotsRequest {
    /// Of a head that somebody put up by eye, and a camera whose stamps nobody knows.
    #[must_use]
    pub const fn first(driving: &Driving) -> Self {
        Self {
            belief: AlignmentBelief::by_eye(driving.machine.geometry, driving.pose),
            timing: Timing::USUAL,
            exposure_s: SPOT_EXPOSURE_S,
            across: ACROSS,
            most_in_vain: usize::MAX,
        }
    }

    /// Of a known head that was homed by one dot: to tell where zero is.
    #[must_use]
    pub const fn few(driving: &Driving, timing: Timing, exposure_s: f64) -> Self {
        Self { across: ACROSS_AGAIN, timing, exposure_s, ..Self::first(driving) }
    }

    /// Of a head that stood and was built so until it was bumped or an encoder slipped, by a few degrees; the camera's stamps are known.
    #[must_use]
    pub const fn again(driving: &Driving, timing: Timing, exposure_s: f64) -> Self {
        let first = AlignmentBelief::by_eye(driving.machine.geometry, driving.pose);
        // where the beam points is also where the tilt encoder's zero is
        let belief = AlignmentBelief {
            place_m: 0.01,
            turn_rad: 0.05,
            offset_m: 2e-4,
            beam_rad: 0.03,
            skew_rad: 1e-3,
            late_s: 2e-3,
            readout_s: 2e-3,
            ..first
        };
        Self { belief, timing, exposure_s, across: ACROSS_AGAIN, most_in_vain: IN_VAIN }
    }
}

/// Places for the dots: evenly over what the camera sees, as far as the head reaches.
pub(crate) fn dots(camera: &Camera, driving: &Driving, across: usize) -> Vec<Point> {
    let [width, height] = camera.lens.size_px.map(|n| n as f64);
    let place = |k: usize| BORDER + (1.0 - 2.0 * BORDER) * k as f64 / (across - 1) as f64;
    let at = |row: usize, k: usize| {
        // each other row back
        let column = if row.is_multiple_of(2) { k } else { across - 1 - k };
        Point::new(width * place(column), height * place(row))
    };
    let all = (0..across * across).map(|k| at(k / across, k % across));
    let reached = |at: &Point| {
        let edges =
            [Vec2::new(DOT_M, 0.0), Vec2::new(-DOT_M, 0.0), Vec2::new(0.0, DOT_M), Vec2::new(0.0, -DOT_M)];
        edges.iter().all(|edge| driving.machine.angles(*at + *edge).is_ok())
    };
    all.filter_map(|pixel| camera.target(pixel)).filter(reached).collect()
}

/// The plan that draws dots in their order.
fn plan_of(dots: &[Point], driving: &Driving) -> Result<Plan, Failure> {
    let circle = |at: &Point| {
        let mut path = Path::new(*at + Vec2::new(DOT_M, 0.0));
        (0..2).for_each(|_| path.push(Element::Arc { centre: *at, sweep: PI }));
        path.close();
        Stroke::new(path)
    };
    let drawing = Drawing { strokes: dots.iter().map(circle).collect() };
    let request = PlanRequest { speed_m_s: DOT_SPEED_M_S, ..driving.request };
    plan(&drawing, &driving.machine, &request).map_err(refused)
}

/// Dots that were drawn and watched.
pub struct SeenDots {
    watch: SpotWatch,
    history: History,
    sightings: Vec<Sighting>,
    dots: usize,
}

impl SeenDots {
    /// Where they were seen, and where the encoders had the joints then.
    #[must_use]
    pub fn spots(&self) -> Vec<SeenSpot> {
        spots(&self.sightings, &self.history, &self.watch.timing)
    }
}

/// Has the head draw dots, watches them, and finds the head. The rig rests at zero in the dark; afterwards it rests in the dark at the last dot.
///
/// # Errors
/// The head does not draw, its spot is not seen, or what is seen fits no head; or [`Failure::interrupted`].
pub fn find_head<D: Driven>(
    rig: &mut D,
    camera: &Camera,
    driving: &Driving,
    request: &DotsRequest,
    task: Task<'_>,
) -> Result<FoundHead, Failure> {
    placed_finely(&driving.rig)?;
    let _kept = task.stop.keep();
    let mut seen = see_dots(rig, camera, driving, request, task)?;
    let aligned = aligned(&request.belief, &mut seen.watch.timing, &seen.sightings, &seen.history)
        .map_err(|e| not_found(&e, &seen.watch, seen.dots))?;
    Ok(FoundHead {
        aligned,
        timing: Timing { unsure_s: Timing::FOUND_S, ..seen.watch.timing },
        exposure_s: seen.watch.exposure_s,
        dots: seen.dots,
        lost: seen.watch.lost,
    })
}

/// Refuses a head that places its dots further off than any camera sees them.
fn placed_finely(rig: &RigConfig) -> Result<(), Failure> {
    if rig.drive.kind != DriveKind::Servo {
        return Ok(());
    }
    let message = format!(
        "a camera cannot find the head of the rig {}: its hobby servos place a dot no finer than {:.2} degrees. Tell where it stands (--distance), and draw without a \
         camera",
        rig.name,
        rig.drive.servo.resolution_rad().to_degrees()
    );
    Err(Failure::usage("open-loop-rig", message))
}

/// Has the head draw dots, and watches them. The rig is as for [`find_head`].
///
/// # Errors
/// The head does not draw, or its spot is not seen often enough; or [`Failure::interrupted`].
pub fn see_dots<D: Driven>(
    rig: &mut D,
    camera: &Camera,
    driving: &Driving,
    request: &DotsRequest,
    task: Task<'_>,
) -> Result<SeenDots, Failure> {
    let belief = &request.belief;
    let places = dots(camera, driving, request.across);
    let plan = plan_of(&places, driving)?;
    task.stage("dots", plan.points.len() as u64);
    let mut watch = SpotWatch::new(*camera, request.exposure_s.min(rig.longest_s()));
    watch.timing = request.timing;
    watch.begin(rig.take(watch.exposure_s)?);
    let mut history = History::new(&driving.rig.model.relay);
    let mut sightings = Vec::new();
    rig.settle()?;
    check_homed(rig.session().told())?;
    rig.ask(Request::Arm)?;
    rig.ask(Request::Trace(job_of(&plan, false)))?;
    let most = plan.points.len() + rig.session().rig().patience_ticks();
    let (mut in_vain, mut homed, mut aftermath) = (false, Ok(()), AFTERMATH_TICKS);
    for _ in 0..most {
        let now = rig.step()?;
        history.push(&now.telemetry);
        look(rig, &mut watch, &history, &belief.alignment, &mut sightings);
        task.at(u64::from(now.telemetry.plan_tick));
        in_vain = sightings.is_empty() && watch.lost > request.most_in_vain;
        homed = check_homed(&now.telemetry);
        let state = rig.session().state();
        aftermath -= u32::from(!state.is_on());
        if in_vain || homed.is_err() || task.stop.is_wanted() || state == State::Done || aftermath == 0 {
            break;
        }
    }
    let (is_done, fault) = (rig.session().state() == State::Done, rig.session().told().latched);
    // dark, whether it came to its end or not
    rig.ask(Request::Stop)?;
    for _ in 0..AFTERMATH_TICKS {
        let tick = rig.step()?;
        homed = homed.and_then(|()| check_homed(&tick.telemetry));
        if homed.is_err() {
            break;
        }
        history.push(&tick.telemetry);
        look(rig, &mut watch, &history, &belief.alignment, &mut sightings);
    }
    task.check()?;
    if let Some(fault) = fault {
        return Err(Failure::fault(fault));
    }
    homed?;
    if in_vain {
        let message =
            format!("in {} images of its dots no spot is to be seen: it points elsewhere", watch.lost);
        return Err(Failure::failed("head-not-found", message));
    }
    if !is_done {
        let message =
            "the head left its dots again and again, and the run was given up; step nearer (--distance)";
        return Err(Failure::failed("unfinished", message));
    }
    Ok(SeenDots { watch, history, sightings, dots: places.len() })
}

fn look<R: Eye>(
    rig: &mut R,
    watch: &mut SpotWatch,
    history: &History,
    head: &Alignment,
    sightings: &mut Vec<Sighting>,
) {
    while let Some(shot) = rig.shot() {
        if let Sight::Seen(sighting) = watch.see(&shot, history, head) {
            sightings.push(sighting);
        }
        watch.bound(rig.longest_s());
        rig.expose(watch.exposure_s);
    }
}

fn spots(sightings: &[Sighting], history: &History, timing: &Timing) -> Vec<SeenSpot> {
    sightings.iter().filter_map(|sighting| sighting.spot(history, timing)).collect()
}

fn aligned(
    belief: &AlignmentBelief,
    timing: &mut Timing,
    sightings: &[Sighting],
    history: &History,
) -> Result<Aligned, AlignError> {
    let mut found = align(belief, &spots(sightings, history, timing))?;
    for _ in 1..ROUNDS {
        timing.late_s += found.alignment.late_s;
        timing.readout_s += found.alignment.readout_s;
        found = align(belief, &spots(sightings, history, timing))?;
    }
    Ok(found)
}

fn not_found(error: &AlignError, watch: &SpotWatch, dots: usize) -> Failure {
    let why = watch.last_lost.map_or_else(String::new, |why| {
        format!("; {} times it was looked for in vain, last: {why}", watch.lost)
    });
    Failure::failed("head-not-found", format!("of {dots} dots: {error}{why}"))
}

/// Has a rig stand before a wall that was seen: as it did when its head was found, or else in front of the middle of the image.
///
/// # Errors
/// `head-file`, where the wall is not the one before which the head was found.
pub fn stand_before(
    driving: &mut Driving,
    wall: &SeenWall,
    known: Option<&KnownHead>,
) -> Result<(), Failure> {
    match known {
        Some(known) => {
            known.check_wall(wall.frame, &wall.pages)?;
            driving.believe(known.geometry, known.pose);
        }
        None => driving.stand(in_front(&wall.camera.camera, driving.pose.distance_m)),
    }
    Ok(())
}

/// Where a head probably stands that was put up in front of the middle of what the camera shows: square-on, as far away as told, and as
/// upright as the camera, however the page hangs whose frame is the wall's.
fn in_front(camera: &Camera, distance_m: f64) -> HeadPose {
    let [width, height] = camera.lens.size_px.map(|n| n as f64);
    let on_wall = |down: f64| camera.target(Point::new(width / 2.0, height * down));
    let (Some(middle), Some(above)) = (on_wall(0.5), on_wall(0.45)) else {
        return HeadPose::square_on(distance_m);
    };
    let up = above - middle;
    let upright = planar::rotation(atan2(-up.x, up.y)).then_translate(middle.to_vec2());
    HeadPose::square_on(distance_m).in_frame(upright)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracelight_aim::{CameraPose, Lens};

    #[test]
    fn a_head_is_taken_to_be_upright_however_the_page_hangs() {
        let pose = CameraPose::looking_at([0.3, 0.2, 1.2], [0.1, 0.0, 0.0]).unwrap();
        let camera = Camera { lens: Lens::ideal(1280, 720, 1000.0), pose };
        let upright = in_front(&camera, 0.9);
        assert!(upright.roll_rad.abs() < 0.06 && (upright.right_m - 0.1).abs() < 1e-9, "{upright:?}");
        for turn_rad in [0.5, 1.6, 3.1, -2.0] {
            let frame = planar::rotation(turn_rad).then_translate(Vec2::new(0.3, -0.4));
            let turned = in_front(&Camera { pose: camera.pose.in_frame(frame), ..camera }, 0.9);
            let wanted = upright.in_frame(frame);
            assert!((turned.right_m - wanted.right_m).hypot(turned.up_m - wanted.up_m) < 1e-9);
            let off = (turned.roll_rad - wanted.roll_rad).rem_euclid(2.0 * PI);
            assert!(off.min(2.0 * PI - off) < 1e-9, "{turned:?} {wanted:?}");
        }
    }
}
