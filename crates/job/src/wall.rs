//! What a camera adds to a job: the figure is traced where it is seen, and the head is found from dots before it draws.

use tracelight_aim::{Alignment, Camera, TrimBelief};
use tracelight_eye::figure::{FigureRequest, SeenFigure, metres_per_pixel, see_figure};
use tracelight_eye::figures::{EyeFigures, HeadFigures, HomedFigures};
use tracelight_eye::follow::Followed;
use tracelight_eye::head::{DotsRequest, FoundHead, SPOT_EXPOSURE_S, find_head, stand_before};
use tracelight_eye::homing::home_head;
use tracelight_eye::power::check_homed;
use tracelight_eye::room::{Furnished, RoomRequest};
use tracelight_eye::{Driven as _, Looks};
use tracelight_picture::{Pixels, Source};
use tracelight_pipeline::{DistanceFrom, Driving, sketch};
use tracelight_rig::PanTilt;
use tracelight_rigfile::Timing;
use tracelight_rigfile::head::KnownHead;
use tracelight_session::Session;
use tracelight_sim::Room;
use tracelight_stroke::Drawing;
use tracelight_task::{Failure, Task};

use crate::prepared::{Prepared, planned};
use crate::request::{Request, Scene, Wall};
use crate::seen::Seen;

/// Looks at the wall, has the head draw dots unless it is known, and plans the figure.
///
/// # Errors
/// Why there is nothing to be drawn, no head to draw it, or no way to draw it.
pub fn prepare_wall(request: &Request<'_>, wall: Wall<'_>, task: Task<'_>) -> Result<Prepared, Failure> {
    let Request { name, tracing, placing, run: how, .. } = request;
    let Wall { scene, camera: known_camera, head: known, home, retakes, open_loop, troubles, today } = wall;
    let mut driving = request.driving.clone();
    if how.dry && known.is_none() && matches!(scene, Scene::Room { .. }) {
        let message = "a dry run draws no dots to find the head by: give --head (tracelight calibrate head --camera … -o head.toml)";
        return Err(Failure::usage("usage", message));
    }
    task.stage("wall", 1);
    let mut stage = Stage::of(scene, request, &driving)?;
    let wanted = FigureRequest {
        known: known_camera.as_ref(),
        tracing,
        choice: &placing.choice,
        most_refused: retakes,
    };
    let SeenFigure { wall, sketch, placed, retaken, vision_ms } = see_figure(stage.looks(), &wanted, task)?;
    wall.remarks.iter().for_each(|remark| task.say(&format!("note: {remark}")));
    task.check()?;
    let camera = wall.camera.camera;
    stand_before(&mut driving, &wall, known.as_ref())?;
    driving.asked.distance = match (&known, &stage) {
        (Some(_), _) => DistanceFrom::File,
        (None, Stage::Room(_)) => DistanceFrom::Camera,
        (None, Stage::Camera(_)) => driving.asked.distance,
    };
    let head = match &mut stage {
        Stage::Room(staged) => {
            let Staged { rig, room, .. } = staged.as_mut();
            head_of(home, (rig, room), &camera, &mut driving, known, task)?
        }
        Stage::Camera(_) => {
            if known.is_none() {
                task.say(&format!(
                    "note: the simulated head is not where the camera is: it is taken to stand {:.3} m in front of the middle of the image, square-on",
                    driving.pose.distance_m
                ));
            }
            HeadSeen::believed(known.as_ref(), &camera)
        }
    };
    let figures = EyeFigures {
        source: (*name).to_owned(),
        markers: wall.markers,
        markers_rms_px: wall.rms_px,
        refused_images: retaken,
        homed: head.homed,
        head: head.figures.clone(),
        follow: None,
        figure_mm: None,
    };
    let followed = head.followed(camera, &driving);
    let known = wall.known(&today);
    let (room, hung) = stage.left();
    let truth = truth(request, hung, room.as_ref(), task);
    let seen = Seen {
        room,
        figures,
        image: wall.pixels,
        wall: known,
        followed,
        truth,
        troubles,
        open: open_loop,
        today,
    };
    planned((sketch, vision_ms), placed, driving, (*how, Some(seen)), task)
}

/// What images come from.
enum Stage<'a> {
    Camera(&'a mut dyn Looks),
    Room(Box<Staged<'a>>),
}

/// A simulated rig in its room.
struct Staged<'a> {
    rig: Session<Room>,
    room: Furnished,
    hung: Option<Hung<'a>>,
}

/// The picture on a room's wall, under its name.
type Hung<'a> = (&'a str, Pixels);

impl<'a> Stage<'a> {
    fn of(scene: Scene<'a>, request: &Request<'_>, driving: &Driving) -> Result<Self, Failure> {
        let (picture, eye, pages) = match scene {
            Scene::Camera(camera) => return Ok(Self::Camera(camera)),
            Scene::Room { picture, eye, pages } => (picture, eye, pages),
        };
        let hung = picture.as_ref().map(|(_, pixels)| &pixels.colour);
        let asked =
            RoomRequest { picture: hung, placing: &request.placing, eye, pages, seed: request.run.seed };
        let room = Furnished::new(&asked, &driving.rig, driving.pose)?;
        let put_up = if request.run.powered_up { Furnished::powered_up } else { Furnished::watched };
        let rig = Session::new(put_up(&room, &driving.rig, driving.pose));
        Ok(Self::Room(Box::new(Staged { rig, room, hung: picture })))
    }

    fn looks(&mut self) -> &mut dyn Looks {
        match self {
            Self::Camera(camera) => *camera,
            Self::Room(staged) => &mut staged.rig,
        }
    }

    /// What a room leaves: itself, and what hangs on its wall.
    fn left(self) -> (Option<Furnished>, Option<Hung<'a>>) {
        match self {
            Self::Camera(_) => (None, None),
            Self::Room(staged) => (Some(staged.room), staged.hung),
        }
    }
}

/// What is known of a head and of when its images are taken.
struct HeadSeen {
    timing: Timing,
    exposure_s: f64,
    belief: TrimBelief,
    homed: Option<HomedFigures>,
    figures: Option<HeadFigures>,
}

impl HeadSeen {
    /// Of one that was found before, or that nobody looked at.
    fn believed(known: Option<&KnownHead>, camera: &Camera) -> Self {
        let (timing, exposure_s) =
            known.and_then(KnownHead::images).unwrap_or((Timing::USUAL, SPOT_EXPOSURE_S));
        Self {
            timing,
            exposure_s,
            belief: TrimBelief::known(metres_per_pixel(camera).unwrap_or_default()),
            homed: None,
            figures: None,
        }
    }

    fn followed(&self, camera: Camera, driving: &Driving) -> Followed {
        let head =
            Alignment { geometry: driving.machine.geometry, pose: driving.pose, late_s: 0.0, readout_s: 0.0 };
        let Self { timing, exposure_s, belief, .. } = *self;
        let count_rad = driving.rig.model.encoder.count_rad();
        Followed { camera, head, timing, exposure_s, belief, count_rad, relay: driving.rig.model.relay }
    }
}

/// The head of a simulated room: homed if that is asked for, and found from dots unless it was before; from then on it is believed.
fn head_of(
    home: bool,
    (rig, room): (&mut Session<Room>, &mut Furnished),
    camera: &Camera,
    driving: &mut Driving,
    known: Option<KnownHead>,
    task: Task<'_>,
) -> Result<HeadSeen, Failure> {
    let believed = HeadSeen::believed(known.as_ref(), camera);
    let homed = if home {
        let homed = home_head(rig, camera, driving, known.as_ref().and_then(KnownHead::images), task)?;
        room.homed(rig.rig_mut(), &homed);
        Some(homed.figures())
    } else {
        None
    };
    if known.is_some() {
        check_homed(&rig.step()?.telemetry)?;
        return Ok(HeadSeen { homed, ..believed });
    }
    let (found, figures) = found_head(rig, room, camera, driving, task)?;
    Ok(HeadSeen {
        timing: found.timing,
        exposure_s: found.exposure_s,
        belief: TrimBelief::found(found.aligned.rms_m),
        homed,
        figures: Some(figures),
    })
}

/// The head found from dots; from then on it is believed.
fn found_head(
    rig: &mut Session<Room>,
    room: &Furnished,
    camera: &Camera,
    driving: &mut Driving,
    task: Task<'_>,
) -> Result<(FoundHead, HeadFigures), Failure> {
    let found = find_head(rig, camera, driving, &DotsRequest::first(driving), task)?;
    let Alignment { geometry, pose, .. } = found.aligned.alignment;
    driving.believe(geometry, pose);
    let truth = room.true_error_m(&geometry, &pose);
    let figures = HeadFigures {
        dots: found.dots,
        spots: found.aligned.spots,
        rms_mm: 1e3 * found.aligned.rms_m,
        straight_ahead_mm: found.aligned.deviation_m(PanTilt::default()).map(|m| 1e3 * m),
        truth_rms_mm: truth.map(|(rms, _)| 1e3 * rms),
        truth_max_mm: truth.map(|(_, most)| 1e3 * most),
    };
    Ok((found, figures))
}

/// The figure of a simulated room as its picture's file has it, traced as asked; `None` where there is none, or it can not be told.
fn truth(
    request: &Request<'_>,
    hung: Option<Hung<'_>>,
    room: Option<&Furnished>,
    task: Task<'_>,
) -> Option<Drawing> {
    let wall_from_picture = room.and_then(|room| room.wall_from_picture)?;
    let (name, pixels) = hung?;
    match sketch(name, Source::Pixels(pixels), &request.tracing, &request.placing) {
        // as it hangs: a sheet in it is not laid square there
        Ok(truth) => Some(truth.in_picture().0.transformed(wall_from_picture)),
        Err(why) => {
            task.say(&format!("note: how far the light is from the figure is not told: {}", why.message));
            None
        }
    }
}
