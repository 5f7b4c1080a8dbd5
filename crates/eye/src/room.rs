//! A simulated head and camera in front of a simulated wall, with a picture and pages of markers on it.
//!
//! Nothing is where it was said to be: the head stands and points a few millimetres and degrees off, the camera is turned, its lens is
//! like no other, the pages hang askew. What the seed draws, nobody is told.

use std::f64::consts::PI;

use tracelight_aim::{Board, Camera, CameraPose, HeadGeometry, HeadPose, Lens};
use tracelight_maths::{cos, planar, powi, sin, single};
use tracelight_picture::Raster;
use tracelight_pipeline::{Paper, Placing};
use tracelight_plant::{CameraConfig, Poster, SimulatedCamera, Wall};
use tracelight_rig::PanTilt;
use tracelight_sim::{RigConfig, Room, SimulatedRig};
use tracelight_stroke::{Affine, Point, Vec2};
use tracelight_task::Failure;

use crate::board::page_raster;
use crate::homing::{Homed, turned_rad};
use crate::{Eye, Shot};

/// Which camera is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SimulatedEye {
    /// 1280 × 720 px, as far away as it takes to see all
    #[default]
    Webcam,
    /// The 2006 report's: 320 × 240 px, 3 ft away
    Report,
}

/// What is asked of a simulated room.
pub struct RoomRequest<'a> {
    /// A picture on the wall.
    pub picture: Option<&'a Raster>,
    /// Where it hangs.
    pub placing: &'a Placing,
    /// What looks.
    pub eye: SimulatedEye,
    /// Whether pages of markers hang there.
    pub pages: bool,
    /// What nobody is told is drawn from it.
    pub seed: u64,
}

/// A room, and the truth about it, for scoring. All of it is in the frame of page 1, the wall's, as markers tell it.
pub struct Furnished {
    eye: SimulatedCamera,
    /// How the head is truly built,
    geometry: HeadGeometry,
    /// and where it stands.
    pose: HeadPose,
    /// The wall's frame from one whose origin is the picture's centre.
    wall_from_centre: Affine,
    /// The picture's size, m.
    size_m: (f64, f64),
    /// The wall's frame from the picture's pixels, if there is one.
    pub wall_from_picture: Option<Affine>,
    /// What is to be added to what its homed head's encoders read for true angles, counts.
    beside: PanTilt<i32>,
    count_rad: f64,
    seed: u64,
}

/// Wall and paper, as shares of the light that falls on them.
const PLAIN: [f32; 3] = [0.62, 0.61, 0.59];
/// Pixels of a printed page, m.
const PRINT_M: f64 = 0.25e-3;
/// Between the picture and a page, m.
const GAP_M: f64 = 0.02;
/// How far off the mounting is that somebody did by eye: 5 mm and 2°.
const OFF_M: f64 = 0.005;
const OFF_RAD: f64 = 0.035;
/// Width of a picture that is asked for in no size, m: 24 in.
const WIDTH_M: f64 = 0.6096;
/// Where pages hang for the report's camera, which sees little more than a picture: right and up, m.
const REPORT_PAGES_M: (f64, f64) = (0.19, 0.115);

impl Furnished {
    /// Hangs picture and pages, puts up camera and head: a rig in front of the picture's middle, as far away as is told.
    ///
    /// # Errors
    /// `beyond-sight`: the camera cannot see all that hangs there.
    pub fn new(request: &RoomRequest<'_>, rig: &RigConfig, pose: HeadPose) -> Result<Self, Failure> {
        let mut dice = Dice(oorandom::Rand64::new(u128::from(request.seed)));
        let hung = request.picture.map(|picture| hang(picture, request));
        let bare = (WIDTH_M, 0.7 * WIDTH_M);
        let size_m = hung.as_ref().map_or(bare, |hung| hung.size_m);
        let (board, hung_pages) = pages(request.eye, size_m, &mut dice);
        let wall_from_centre = hung_pages[0].inverse();
        let mut posters: Vec<Poster> = hung.iter().filter_map(|hung| hung.poster(wall_from_centre)).collect();
        for (number, place) in hung_pages.iter().enumerate().filter(|_| request.pages) {
            posters.push(page(&board, number as u16, wall_from_centre * *place)?);
        }
        let mut camera = camera(request.eye, &hung_pages, &mut dice)?;
        camera.pose = camera.pose.in_frame(wall_from_centre);
        let config = match request.eye {
            SimulatedEye::Webcam => CameraConfig::webcam(),
            SimulatedEye::Report => CameraConfig::report(),
        };
        let eye = SimulatedCamera::new(&config, &camera, &Wall { plain: PLAIN, posters }, request.seed);
        let (geometry, pose) = mounted(rig, pose, &mut dice);
        Ok(Self {
            eye,
            geometry,
            pose: pose.in_frame(wall_from_centre),
            wall_from_centre,
            size_m,
            wall_from_picture: hung.map(|hung| wall_from_centre * hung.centre_from_picture),
            beside: PanTilt::default(),
            count_rad: rig.truth.model.encoder.count_rad(),
            seed: request.seed,
        })
    }

    /// A rig as it truly is that is believed to be this; homed, or just powered up wherever somebody left it.
    fn rig(&self, believed: &RigConfig, pose: HeadPose, homed: bool) -> SimulatedRig {
        let mut rig = believed.clone();
        rig.truth.model.geometry = self.geometry;
        let rig = match homed {
            true => SimulatedRig::homed_beside(&rig, pose, self.beside, self.seed),
            false => left(&rig, pose, self.seed),
        };
        rig.standing(self.pose)
    }

    /// A rig of this room was homed: whoever puts it up anew homed has it as it is then.
    pub fn homed(&mut self, rig: &mut Room, homed: &Homed) {
        let truly = rig.rig().true_counts();
        self.beside = PanTilt::from_fn(|j| truly[j] - homed.counts[j]);
    }

    /// The same with the camera.
    #[must_use]
    pub fn watched(&self, believed: &RigConfig, pose: HeadPose) -> Room {
        Room::new(self.rig(believed, pose, true), self.eye.clone(), self.seed)
    }

    /// The same of a rig that was just powered up, its head wherever somebody left it.
    #[must_use]
    pub fn powered_up(&self, believed: &RigConfig, pose: HeadPose) -> Room {
        Room::new(self.rig(believed, pose, false), self.eye.clone(), self.seed)
    }

    /// By how much the joints of its homed head are truly further than their encoders say, rad.
    fn beside_rad(&self) -> PanTilt<f64> {
        self.beside.map(|counts| self.count_rad * f64::from(counts))
    }

    /// How far the zero of its homed head truly is from where it was to be, m on the wall: where a known head has it, or where one faces the wall.
    #[must_use]
    pub fn zero_error_m(&self, is_known: bool) -> PanTilt<f64> {
        let turned = turned_rad(&self.geometry, &self.pose).filter(|_| !is_known).unwrap_or_default();
        let beside_rad = self.beside_rad();
        PanTilt::from_fn(|j| self.pose.distance_m * (beside_rad[j] + turned[j]))
    }

    /// Root mean square and most of how far the spot truly is from where a head so believed would put it, over the picture's place, m.
    #[must_use]
    pub fn true_error_m(&self, geometry: &HeadGeometry, pose: &HeadPose) -> Option<(f64, f64)> {
        const STEPS: usize = 10;
        let beside_rad = self.beside_rad();
        let (mut sum, mut most, mut count) = (0.0, 0.0_f64, 0.0);
        for k in 0..(STEPS + 1) * (STEPS + 1) {
            let share = |k: usize| k as f64 / STEPS as f64 - 0.5;
            let (across, down) = (share(k % (STEPS + 1)), share(k / (STEPS + 1)));
            let asked = self.wall_from_centre * Point::new(self.size_m.0 * across, self.size_m.1 * down);
            let told = geometry.angles(pose, asked).ok()?;
            let angle = PanTilt::from_fn(|j| told[j] + beside_rad[j]);
            let off = self.geometry.spot(&self.pose, angle)?.distance(asked);
            (sum, most, count) = (sum + off * off, most.max(off), count + 1.0);
        }
        Some(((sum / count).sqrt(), most))
    }
}

/// A rig that was just powered up, its head left anywhere in four fifths of its joints' ranges, and in front of it.
#[must_use]
pub fn left(rig: &RigConfig, pose: HeadPose, seed: u64) -> SimulatedRig {
    const MOST_RAD: f64 = 1.0;
    let mut dice = Dice(oorandom::Rand64::new(u128::from(seed) << 64 | 1));
    let angle_rad = rig.model.geometry.range_rad.map(|(lower, upper)| {
        let reach = (0.4 * (upper - lower)).min(MOST_RAD);
        0.5 * (lower + upper) + dice.within(reach)
    });
    SimulatedRig::unhomed(rig, pose, angle_rad, seed)
}

/// Draws from a seed.
struct Dice(oorandom::Rand64);

impl Dice {
    /// Between − and + `size`.
    fn within(&mut self, size: f64) -> f64 {
        size * (2.0 * self.0.rand_float() - 1.0)
    }
}

/// A picture to be hung.
struct Hung {
    width: usize,
    painted: Vec<[u8; 3]>,
    size_m: (f64, f64),
    centre_from_picture: Affine,
}

impl Hung {
    fn poster(&self, wall_from_centre: Affine) -> Option<Poster> {
        Poster::new(self.width, &self.painted, wall_from_centre * self.centre_from_picture)
    }
}

fn hang(picture: &Raster, request: &RoomRequest<'_>) -> Hung {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let placed = request.placing.placement((width as f64, height as f64), WIDTH_M);
    Hung {
        width,
        painted: painted(picture.rgb()),
        size_m: (placed.width_m, placed.height_m),
        centre_from_picture: placed.target_from_pixel(width as f64),
    }
}

/// A picture painted on the wall: its white is the wall's.
fn painted(rgb: &[u8]) -> Vec<[u8; 3]> {
    let on_wall: [[u8; 256]; 3] = PLAIN.map(|plain| {
        std::array::from_fn(|level| {
            let light = single::powf(level as f32 / 255.0, 2.2) * plain;
            (255.0 * single::powf(light, 1.0 / 2.2)).round() as u8
        })
    });
    rgb.chunks_exact(3).map(|p| std::array::from_fn(|c| on_wall[c][usize::from(p[c])])).collect()
}

/// Which board hangs there, and where its pages' middles are: beside the picture, two on either side; for the report's camera where the
/// picture will be, the upper two upside down, so that what is out of its sight is their feet.
fn pages(eye: SimulatedEye, (width, height): (f64, f64), dice: &mut Dice) -> (Board, Vec<Affine>) {
    let (page_width, page_height) = Paper::A4.size_m();
    let (board, x, y) = match eye {
        SimulatedEye::Webcam => {
            let up = ((height - page_height) / 2.0).max((page_height + GAP_M) / 2.0);
            (Board::FINE, width / 2.0 + GAP_M + page_width / 2.0, up)
        }
        SimulatedEye::Report => (Board::COARSE, REPORT_PAGES_M.0, REPORT_PAGES_M.1),
    };
    let upper = if eye == SimulatedEye::Report { PI } else { 0.0 };
    let mut place = |x: f64, y: f64, turn_rad: f64| {
        let lean = planar::rotation(turn_rad + dice.within(0.025));
        let mut further = || 1.0 + 0.01 * (1.0 + dice.within(1.0));
        lean.then_translate(Vec2::new(x * further(), y * further()))
    };
    (board, vec![place(-x, -y, 0.0), place(x, -y, 0.0), place(x, y, upper), place(-x, y, upper)])
}

fn page(board: &Board, number: u16, place: Affine) -> Result<Poster, Failure> {
    let (width, levels, middle) = page_raster(board, number, Paper::A4, PRINT_M);
    let rgb: Vec<[u8; 3]> = levels.iter().map(|&v| [v; 3]).collect();
    let page_from_pixel = Affine::translate(-middle.to_vec2()).then_scale_non_uniform(PRINT_M, -PRINT_M);
    Poster::new(width, &rgb, place * page_from_pixel)
        .ok_or_else(|| Failure::failed("internal", "a page without paper"))
}

/// A camera that sees the pages: a webcam from as far away as it takes, from a side.
fn camera(eye: SimulatedEye, pages: &[Affine], dice: &mut Dice) -> Result<Camera, Failure> {
    let (size, focal, pan_rad) = match eye {
        SimulatedEye::Webcam => ((1280, 720), 1000.0, dice.within(0.35)),
        SimulatedEye::Report => ((320, 240), 432.0, dice.within(0.05)),
    };
    let (width, height) = (size.0 as f64, size.1 as f64);
    let lens = Lens {
        centre_px: Point::new(
            width / 2.0 + dice.within(0.012 * width),
            height / 2.0 + dice.within(0.012 * width),
        ),
        radial: [-0.1, 0.0, 0.0],
        ..Lens::ideal(size.0, size.1, focal * (1.0 + dice.within(0.02)))
    };
    let (tilt_rad, roll_rad) = (dice.within(0.1), dice.within(0.03));
    let from = |distance_m: f64| {
        let at = [
            distance_m * sin(pan_rad) * cos(tilt_rad),
            distance_m * sin(tilt_rad),
            distance_m * cos(pan_rad) * cos(tilt_rad),
        ];
        let pose = CameraPose::looking_at(at, [0.0; 3])?.moved([0.0, 0.0, roll_rad], [0.0; 3]);
        Some(Camera { lens, pose })
    };
    let sees_all = |camera: &Camera| {
        // markers and the white about them
        let reach = if eye == SimulatedEye::Webcam { Vec2::new(0.095, 0.125) } else { Vec2::new(0.1, 0.1) };
        pages.iter().all(|page| {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            corners.iter().all(|&(x, y)| {
                let corner = *page * Point::new(x * reach.x, y * reach.y);
                camera.pixel(corner).is_some_and(|pixel| camera.is_in_sight(pixel))
            })
        })
    };
    // the report's stands 3 ft away
    let distances = match eye {
        SimulatedEye::Webcam => (0..60).map(|k| 0.5 * powi(1.05, k)).collect(),
        SimulatedEye::Report => vec![0.9144],
    };
    let found = distances.into_iter().filter_map(from).find(sees_all);
    let beyond = "the simulated camera does not see all of the wall that is wanted; make the picture smaller (--width)";
    found.ok_or_else(|| Failure::failed("beyond-sight", beyond))
}

/// How the head truly is: off in each of its numbers, as somebody's who put it together and up by eye.
fn mounted(rig: &RigConfig, told: HeadPose, dice: &mut Dice) -> (HeadGeometry, HeadPose) {
    let mut geometry = rig.truth.model.geometry;
    geometry.laser_offset_m.iter_mut().for_each(|offset| *offset += dice.within(OFF_M));
    geometry.beam_off_rad.iter_mut().for_each(|off| *off += dice.within(OFF_RAD / 4.0));
    geometry.axis_skew_rad += dice.within(OFF_RAD / 8.0);
    let pose = HeadPose {
        distance_m: told.distance_m + dice.within(OFF_M),
        right_m: dice.within(OFF_M),
        up_m: dice.within(OFF_M),
        yaw_rad: dice.within(OFF_RAD),
        pitch_rad: dice.within(OFF_RAD),
        roll_rad: dice.within(OFF_RAD),
    };
    (geometry, pose)
}

impl Eye for Room {
    fn expose(&mut self, exposure_s: f64) {
        Room::expose(self, exposure_s);
    }

    fn longest_s(&self) -> f64 {
        self.eye_config().period_s
    }

    fn shot(&mut self) -> Option<Shot> {
        self.taken().map(Shot::from)
    }
}
