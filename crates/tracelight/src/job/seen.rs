//! What a camera adds to a job: the figure is traced where it is seen, and the head is found from dots before it draws.

use tracelight_aim::{Alignment, Camera, TrimBelief};
use tracelight_camera::Source;
use tracelight_eye::Looks;
use tracelight_eye::figure::{FigureRequest, SeenFigure, metres_per_pixel, see_figure};
use tracelight_eye::figures::{EyeFigures, FigureMatch, FollowFigures, HeadFigures, HomedFigures};
use tracelight_eye::follow::Followed;
use tracelight_eye::head::{DotsRequest, FoundHead, SPOT_EXPOSURE_S, find_head, in_front};
use tracelight_eye::homing::{check_homed, home_head};
use tracelight_eye::room::{Furnished, RoomRequest};
use tracelight_picture::Raster;
use tracelight_pipeline::{Driving, sketch};
use tracelight_rig::PanTilt;
use tracelight_rigfile::Timing;
use tracelight_rigfile::camera::KnownCamera;
use tracelight_rigfile::head::KnownHead;
use tracelight_sim::{Room, Run, Simulated};
use tracelight_stroke::{Comparison, Drawing, Point, compare};
use tracelight_task::{Failure, Task};

use super::Prepared;
use crate::cli::eyes::SimulatedEyeName;
use crate::cli::request::TraceArgs;
use crate::named;

/// What was seen before a run.
pub(super) struct Seen {
    /// The room, if it is simulated.
    pub(super) room: Option<Furnished>,
    pub(super) figures: EyeFigures,
    /// The image in which the figure was found.
    pub(super) image: Raster,
    /// What the camera is known by, should it have to be found again.
    pub(super) wall: KnownCamera,
    /// What is known when the camera begins to follow the spot.
    pub(super) followed: Followed,
    /// The true figure on the wall, which a simulated room knows.
    truth: Option<Drawing>,
}

/// Looks at the wall, has the head draw dots unless it is known, and plans the figure.
pub(super) fn prepare(args: &TraceArgs, task: Task<'_>) -> Result<Prepared, Failure> {
    let mut driving = args.driving.resolve()?;
    args.law.apply(&mut driving.rig);
    let known = args.head.as_deref().map(|path| named::head(path, &driving.rig)).transpose()?;
    if args.dry_run && known.is_none() && matches!(args.eye.source()?, Source::Simulated(_)) {
        let message = "a dry run draws no dots to find the head by: give --head (tracelight calibrate head --camera … -o head.toml)";
        return Err(Failure::usage("usage", message));
    }
    task.stage("wall", 1);
    let mut simulated = furnished(args, &driving)?.map(|room| {
        let put_up = if args.is_powered_up() { Furnished::powered_up } else { Furnished::watched };
        (put_up(&room, &driving.rig, driving.pose), room)
    });
    let mut camera = args.eye.open()?;
    let known_camera = args.eye.known()?;
    let wanted = FigureRequest {
        known: known_camera.as_ref(),
        tracing: &args.tracing.tracing(),
        choice: &args.placement.choice.choice(),
        most_refused: args.retakes,
    };
    let looks: Option<&mut dyn Looks> = match (&mut simulated, &mut camera) {
        (Some((rig, _)), _) => Some(rig),
        (None, camera) => camera.as_mut().map(|camera| &mut **camera as &mut dyn Looks),
    };
    let looks = looks.ok_or_else(|| Failure::failed("internal", "nothing that looks"))?;
    let SeenFigure { wall, sketch, placed, retaken, vision_ms } = see_figure(looks, &wanted, task)?;
    wall.remarks.iter().for_each(|remark| task.say(&format!("note: {remark}")));
    task.check()?;
    let camera = wall.camera.camera;
    match &known {
        Some(known) => {
            known.check_wall(wall.frame, &wall.pages)?;
            driving.believe(known.geometry, known.pose);
        }
        None => driving.stand(in_front(&camera, driving.pose.distance_m)),
    }
    let head = match &mut simulated {
        Some(scene) => head_of(args, scene, &camera, &mut driving, known, task)?,
        None => {
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
        source: args.name().to_owned(),
        markers: wall.markers,
        markers_rms_px: wall.rms_px,
        refused_images: retaken,
        homed: head.homed,
        head: head.figures.clone(),
        follow: None,
        figure_mm: None,
    };
    let followed = head.followed(camera, &driving);
    let known = wall.known(&named::today());
    let room = simulated.map(|(_, room)| room);
    let truth = truth(args, room.as_ref(), task)?;
    let seen = Seen { room, figures, image: wall.pixels, wall: known, followed, truth };
    super::planned((sketch, vision_ms), placed, driving, Some(seen), task)
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
        let (timing, exposure_s) = known.map_or((Timing::USUAL, SPOT_EXPOSURE_S), KnownHead::images);
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
    args: &TraceArgs,
    (rig, room): &mut (Room, Furnished),
    camera: &Camera,
    driving: &mut Driving,
    known: Option<KnownHead>,
    task: Task<'_>,
) -> Result<HeadSeen, Failure> {
    let believed = HeadSeen::believed(known.as_ref(), camera);
    let homed = if args.home {
        let homed = home_head(rig, camera, driving, known.as_ref().map(KnownHead::images), task)?;
        room.homed(rig, &homed);
        Some(homed.figures())
    } else {
        None
    };
    if known.is_some() {
        check_homed(&rig.step().telemetry)?;
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

/// The room, if it is simulated.
fn furnished(args: &TraceArgs, driving: &Driving) -> Result<Option<Furnished>, Failure> {
    let Source::Simulated(picture) = args.eye.source()? else { return Ok(None) };
    if args.eye.sim_camera == SimulatedEyeName::Report && args.eye.has_pages()? {
        let message = format!(
            "the report's camera does not see picture and pages at once: calibrate it first (tracelight calibrate markers --camera sim \
             --sim-camera report --seed {} -o camera.toml), then give --calibration camera.toml",
            args.seed
        );
        return Err(Failure::usage("usage", message));
    }
    let picture = picture.map(named::painted).transpose()?;
    let request = RoomRequest {
        picture: picture.as_ref(),
        placing: &args.placement.placing(),
        eye: args.eye.sim_camera.eye(),
        pages: args.eye.has_pages()?,
        seed: args.seed,
    };
    Furnished::new(&request, &driving.rig, driving.pose).map(Some)
}

/// The head found from dots; from then on it is believed.
fn found_head(
    rig: &mut Room,
    room: &Furnished,
    camera: &Camera,
    driving: &mut Driving,
    task: Task<'_>,
) -> Result<(FoundHead, HeadFigures), Failure> {
    let found = find_head(rig, camera, driving, &DotsRequest::first(driving), task, &mut |_| {})?;
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

/// How far from the true figure a lit trace counts as beside it, m: what users of it see.
const BESIDE_M: f64 = 1.5e-3;

/// The figure of a simulated room as its picture's file has it, traced as asked; `None` where there is none, or it can not be told.
fn truth(args: &TraceArgs, room: Option<&Furnished>, task: Task<'_>) -> Result<Option<Drawing>, Failure> {
    let hung = room.and_then(|room| room.wall_from_picture);
    let (Source::Simulated(Some(path)), Some(wall_from_picture)) = (args.eye.source()?, hung) else {
        return Ok(None);
    };
    match sketch(path, named::picture(path)?, &args.tracing.tracing(), &args.placement.placing()) {
        // as it hangs: a sheet in it is not laid square there
        Ok(truth) => Ok(Some(truth.in_picture().0.transformed(wall_from_picture))),
        Err(why) => {
            task.say(&format!("note: how far the light is from the figure is not told: {}", why.message));
            Ok(None)
        }
    }
}

impl Seen {
    /// What a run adds: how far the lit trace truly is from the figure.
    pub(super) fn after(&self, run: &Run, follow: Option<FollowFigures>) -> EyeFigures {
        let found = self.truth.as_ref().and_then(|truth| compare(&lit(run), truth, BESIDE_M));
        let figure_mm = found.map(|Comparison { rms, p99, max, coverage, .. }| FigureMatch {
            rms: 1e3 * rms,
            p99: 1e3 * p99,
            max: 1e3 * max,
            covered_share: coverage,
        });
        EyeFigures { figure_mm, follow, ..self.figures.clone() }
    }
}

/// Where there was light, tick by tick.
fn lit(run: &Run) -> Vec<Vec<Point>> {
    let mut lines: Vec<Vec<Point>> = vec![Vec::new()];
    for tick in &run.ticks {
        match (tick.light, tick.spot) {
            (true, Some(spot)) => lines.iter_mut().last().into_iter().for_each(|line| line.push(spot)),
            _ if lines.last().is_some_and(|line| !line.is_empty()) => lines.push(Vec::new()),
            _ => {}
        }
    }
    lines
}
