//! The figure on the wall, as strokes in the wall's frame: traced where the camera sees it, not where it lies in a file.

use tracelight_aim::Camera;
use tracelight_image::Grey;
use tracelight_picture::{Pixels, Raster, Source};
use tracelight_pipeline::{Choice, Placed, Sketch, Tracing, carried, sketch_at};
use tracelight_rigfile::camera::KnownCamera;
use tracelight_stroke::{Affine, Drawing, Point, Vec2};
use tracelight_task::{Failure, Task};

use crate::pages::without_pages;
use crate::wall::{SeenWall, see_wall, well_exposed};
use crate::{Looks, grey};

/// A figure that was found.
pub struct SeenFigure {
    /// The wall, by its markers.
    pub wall: SeenWall,
    /// Its picture seen square-on, and its strokes there.
    pub sketch: Sketch,
    /// The strokes on the wall.
    pub placed: Placed,
    /// Images that were refused before.
    pub retaken: u32,
    /// How long it took to trace, ms.
    pub vision_ms: f64,
}

/// How a figure is looked for.
pub struct FigureRequest<'a> {
    /// What is known of the camera.
    pub known: Option<&'a KnownCamera>,
    /// How its strokes are traced.
    pub tracing: &'a Tracing,
    /// Which of its strokes are taken.
    pub choice: &'a Choice,
    /// Most images that are refused before it is given up.
    pub most_refused: u32,
}

/// Takes images until one shows markers and a figure.
///
/// # Errors
/// The camera sends nothing, or no image shows markers or a figure; or [`Failure::interrupted`].
pub fn see_figure(
    eye: &mut dyn Looks,
    request: &FigureRequest<'_>,
    task: Task<'_>,
) -> Result<SeenFigure, Failure> {
    let mut retaken = 0;
    let mut last: Option<Failure> = None;
    loop {
        task.check()?;
        // why the last image was refused says more than that there is no other
        let pixels = well_exposed(eye, task.stop).map_err(|none| last.take().unwrap_or(none))?;
        let histogram = histogram(&grey(&pixels)?);
        let seen = see_wall(pixels, request.known).and_then(|wall| figure(wall, request, task));
        let why = match seen {
            Ok(seen) => return Ok(SeenFigure { retaken, ..seen }),
            // another image would not help
            Err(failure) if !["camera-not-found", "no-strokes-found"].contains(&failure.code) => {
                return Err(failure);
            }
            Err(failure) => failure,
        };
        let shown = format!("{}; its brightness, dark to light: {histogram}", why.message);
        if retaken >= request.most_refused {
            let message = match retaken {
                0 => format!("the image of the wall is refused: {shown}"),
                _ => format!("{} images of the wall were refused, the last: {shown}", retaken + 1),
            };
            return Err(Failure { message, ..why });
        }
        retaken += 1;
        task.say(&format!("note: image {retaken} is refused: {shown}; another is taken"));
        last = Some(why);
    }
}

/// Columns of a histogram that is printed.
const COLUMNS: usize = 32;

/// How many pixels there are of each brightness, as a line of blocks; their heights go by the root, or paper would be all one sees.
#[must_use]
pub fn histogram(grey: &Grey) -> String {
    const BLOCKS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let mut counts = [0_u32; COLUMNS];
    grey.levels().iter().for_each(|&level| counts[usize::from(level) * COLUMNS / 256] += 1);
    let most = f64::from(counts.iter().copied().max().unwrap_or(0).max(1));
    let block = |count: &u32| BLOCKS[(8.0 * (f64::from(*count) / most).sqrt()).ceil() as usize];
    format!("|{}|", counts.iter().map(block).collect::<String>())
}

fn figure(wall: SeenWall, request: &FigureRequest<'_>, task: Task<'_>) -> Result<SeenFigure, Failure> {
    let camera = wall.camera.camera;
    let scale_m = metres_per_pixel(&camera).ok_or_else(|| {
        Failure::failed("camera-not-found", "the middle of the camera's image shows no wall")
    })?;
    let blank = without_pages(&wall.pixels, &wall);
    let pixels = Pixels { grey: grey(&blank)?, colour: blank };
    // a figure is as often on a sheet on the wall as on the wall itself
    let tracing = Tracing { sheets: true, whole: true, ..*request.tracing };
    let (seen, vision_ms) = task.timed(|| {
        sketch_at("the camera's image", Source::Pixels(pixels), &tracing, request.choice, &|_, _| scale_m)
    });
    let mut seen = seen?;
    let drawing = on_wall(&seen.drawing, &camera, scale_m);
    let lost = seen.drawing.strokes.len() - drawing.strokes.len();
    if lost > 0 {
        seen.remarks
            .push(format!("{lost} strokes of the image are not drawn: some of them is beyond the wall"));
    }
    if drawing.strokes.is_empty() {
        return Err(Failure::failed("no-strokes-found", "what the camera's image shows is not on the wall"));
    }
    let (raster, wall_from_sheet, extent) = square_on(&drawing, &wall.pixels, &camera, scale_m)
        .ok_or_else(|| Failure::failed("no-strokes-found", "the figure has no size"))?;
    let size = (f64::from(raster.width()), f64::from(raster.height()));
    let sketch = Sketch {
        drawing: drawing.transformed(wall_from_sheet.inverse()),
        size,
        picture: Some(raster),
        ..seen
    };
    let mut placed = Placed::of(drawing, size, wall_from_sheet);
    placed.size_m = extent;
    Ok(SeenFigure { wall, sketch, placed, retaken: 0, vision_ms })
}

/// Length on the wall of a pixel in the middle of the image, m.
#[must_use]
pub fn metres_per_pixel(camera: &Camera) -> Option<f64> {
    let [width, height] = camera.lens.size_px.map(|n| n as f64);
    Some(1.0 / camera.scale(camera.target(Point::new(width / 2.0, height / 2.0))?)?)
}

/// Strokes in pixels on the wall: a lens makes bends of straight lines, and perspective what is no arc of an arc.
fn on_wall(drawing: &Drawing, camera: &Camera, scale_m: f64) -> Drawing {
    carried(drawing, scale_m, &|pixel| camera.target(pixel))
}

/// Longest side of the picture that is shown, px, and the rim about the figure, as a share of its size.
const SHOWN_PX: f64 = 1600.0;
const RIM: f64 = 0.08;

/// What the wall about a drawing looks like from straight ahead, where its pixels are on the wall, and how wide and high the drawing is, m.
fn square_on(
    drawing: &Drawing,
    pixels: &Raster,
    camera: &Camera,
    scale_m: f64,
) -> Option<(Raster, Affine, (f64, f64))> {
    let points = drawing.strokes.iter().flat_map(|stroke| stroke.path.flatten(0.1 * scale_m));
    let (mut low, mut high) = (Vec2::new(f64::MAX, f64::MAX), Vec2::new(f64::MIN, f64::MIN));
    for p in points {
        (low, high) =
            (Vec2::new(low.x.min(p.x), low.y.min(p.y)), Vec2::new(high.x.max(p.x), high.y.max(p.y)));
    }
    let size = high - low;
    let longest = size.x.max(size.y) * (1.0 + 2.0 * RIM);
    let pixel_m = scale_m.max(longest / SHOWN_PX);
    let rim = RIM * size.x.max(size.y);
    let count = |length: f64| ((length + 2.0 * rim) / pixel_m).ceil().max(1.0);
    let (width, height) = (count(size.x), count(size.y));
    if !(width * height).is_finite() || width.max(height) > 4.0 * SHOWN_PX {
        return None;
    }
    let corner = Vec2::new(low.x - rim, high.y + rim);
    let wall_from_sheet = Affine::scale_non_uniform(pixel_m, -pixel_m).then_translate(corner);
    let mut rgb = Vec::with_capacity(3 * (width * height) as usize);
    for k in 0..(width * height) as usize {
        let at = Point::new((k % width as usize) as f64 + 0.5, (k / width as usize) as f64 + 0.5);
        let seen = camera.pixel(wall_from_sheet * at).filter(|pixel| camera.is_in_sight(*pixel));
        rgb.extend(seen.map_or([255; 3], |pixel| pixels.between(pixel)));
    }
    Some((Raster::new(width as u32, height as u32, rgb)?, wall_from_sheet, (size.x, size.y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::room::{Furnished, RoomRequest, SimulatedEye};
    use crate::{Eye, Shot};
    use std::f64::consts::PI;
    use tracelight_aim::{CameraPose, HeadPose, Lens};
    use tracelight_rig::{Command, Rig, Telemetry};
    use tracelight_session::Session;
    use tracelight_sim::{RigConfig, Room, Simulated, Tick};
    use tracelight_stroke::{Element, Path, Piece, Stroke};
    use tracelight_task::{NoProgress, Status, Stop};

    use tracelight_picture::decode;
    use tracelight_pipeline::{Placing, has_corner};

    fn camera() -> Camera {
        let pose = CameraPose::looking_at([0.3, -0.2, 1.1], [0.0; 3]).unwrap();
        Camera { lens: Lens { radial: [-0.1, 0.0, 0.0], ..Lens::ideal(1280, 720, 1000.0) }, pose }
    }

    fn check(path: Path, corners: usize) {
        let camera = camera();
        let scale_m = metres_per_pixel(&camera).unwrap();
        let seen = Drawing { strokes: vec![Stroke { pen: Some(4.0), ..Stroke::new(path.clone()) }] };
        let on_wall = on_wall(&seen, &camera, scale_m);
        let stroke = &on_wall.strokes[0];
        assert!((stroke.pen.unwrap() - 4.0 * scale_m).abs() < 1e-12);
        assert_eq!(stroke.path.is_closed(), path.is_closed());
        let drawn = vec![stroke.path.flatten(1e-6).into_iter().map(|p| camera.pixel(p).unwrap()).collect()];
        let off = tracelight_stroke::compare(&drawn, &seen, 0.5).unwrap();
        assert!(off.max < 0.3 && off.coverage == 1.0, "{off:?}");
        let pieces: Vec<Piece> = stroke.path.pieces().collect();
        let sharp = (1..pieces.len()).filter(|&k| has_corner(pieces[k - 1], pieces[k])).count();
        assert_eq!(sharp, corners);
    }

    #[test]
    fn strokes_lie_on_the_wall_where_they_are_seen_and_keep_their_corners() {
        let points = [(300.0, 200.0), (900.0, 210.0), (880.0, 500.0), (320.0, 480.0)].map(Point::from);
        // the seam of a closed one is a corner, too, between the last piece and the first
        check(Path::polyline(&points, true).unwrap(), 3);
        check(Path::polyline(&points, false).unwrap(), 2);
        let mut circle = Path::new(Point::new(700.0, 300.0));
        (0..2).for_each(|_| circle.push(Element::Arc { centre: Point::new(600.0, 300.0), sweep: PI }));
        circle.close();
        check(circle, 0);
    }

    /// A room whose camera's lens is covered for so many images.
    struct Covered {
        room: Room,
        images: u32,
    }

    impl Rig for Covered {
        fn send(&mut self, command: Command) -> Result<(), Command> {
            self.room.send(command)
        }

        fn next(&mut self) -> Option<Telemetry> {
            self.room.next()
        }
    }

    impl Simulated for Covered {
        fn step(&mut self) -> Tick {
            self.room.step()
        }

        fn told(&self) -> &Telemetry {
            self.room.told()
        }

        fn patience_ticks(&self) -> usize {
            self.room.patience_ticks()
        }
    }

    impl Eye for Covered {
        fn expose(&mut self, exposure_s: f64) {
            Eye::expose(&mut self.room, exposure_s);
        }

        fn longest_s(&self) -> f64 {
            self.room.longest_s()
        }

        fn shot(&mut self) -> Option<Shot> {
            let shot = self.room.shot()?;
            let is_covered = self.images > 0;
            self.images = self.images.saturating_sub(1);
            Some(if is_covered { shot.covered() } else { shot })
        }
    }

    fn covered(images: u32) -> Session<Covered> {
        let (rig, pose) = (RigConfig::report(), HeadPose::square_on(0.9144));
        let placing = Placing::default();
        let bytes = include_bytes!("../../../examples/house.png");
        let Ok(Source::Pixels(picture)) = decode("house.png", bytes) else { unreachable!() };
        let request = RoomRequest {
            picture: Some(&picture.colour),
            placing: &placing,
            eye: SimulatedEye::Webcam,
            pages: true,
            seed: 2,
        };
        let room = Furnished::new(&request, &rig, pose).unwrap().watched(&rig, pose);
        Session::new(Covered { room, images })
    }

    #[test]
    fn bad_images_are_refused_and_taken_again_so_often_and_no_more() {
        let stop = Stop::default();
        let (tracing, choice) = (Tracing::default(), Choice::default());
        let task = Task { progress: &NoProgress, stop: &stop };
        let request = FigureRequest { known: None, tracing: &tracing, choice: &choice, most_refused: 3 };
        // of several covered ones some are only taken to find how long to expose, some were under way
        let found = see_figure(&mut covered(12), &request, task).unwrap();
        assert!((1..=3).contains(&found.retaken), "{}", found.retaken);
        assert_eq!(found.sketch.drawing.strokes.len(), 28);
        let failure = see_figure(&mut covered(1000), &request, task).err().unwrap();
        assert_eq!((failure.status, failure.code), (Status::Failed, "camera-not-found"));
        assert!(failure.message.starts_with("4 images of the wall were refused"), "{}", failure.message);
        assert!(failure.message.contains("dark to light: |█"), "{}", failure.message);
    }

    #[test]
    fn a_histogram_shows_where_the_pixels_are() {
        let levels = (0..64 * 64).map(|i| if i % 4 == 0 { 10 } else { 200 }).collect();
        let line = histogram(&Grey::new(64, 64, levels).unwrap());
        let columns: Vec<char> = line.chars().collect();
        assert_eq!(columns.len(), COLUMNS + 2);
        assert_eq!((columns[1 + 1], columns[1 + 25], columns[1 + 10]), ('▅', '█', ' '));
    }
}
