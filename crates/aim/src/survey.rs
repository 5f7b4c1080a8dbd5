//! Estimates cameras and pages of boards from observed markers.
//!
//! Every place where a marker's black meets white tells how far that is from where it should be seen, across it; poses, lens, where the pages
//! lie on their plane and how far ink runs are those that fit all places best (bundle adjustment: Triggs et al. 1999), with what is
//! believed of the lens beforehand as one measurement more.

mod residual;
mod start;
#[cfg(test)]
mod tests;
mod valley;

use tracelight_maths::{planar, powi};

use nalgebra::{DMatrix, Matrix2, SMatrix};
use tracelight_stroke::{Affine, Point, Vec2};

use crate::board::Board;
use crate::camera::{CAMERA_PARAMETERS, Camera, CameraPose, POSE_PARAMETERS, Uncertain};
use crate::least_squares::{Normal, solve};
use crate::lens::{LENS_PARAMETERS, Lens};
use residual::{All, Bundle, HEIGHT_DEVIATION_M, LARGER_DEVIATION, State, sightings};
use valley::Slopes;

/// A marker as an image has it, px.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenTag {
    /// Its number.
    pub id: u16,
    /// Its corners: upper left as printed, then clockwise.
    pub corners: [Point; 4],
    /// Where its black meets white.
    pub places: Vec<SeenPlace>,
    /// Standard deviation of these places across their boundaries.
    pub deviation_px: f64,
}

/// A place where a marker's black meets white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPlace {
    /// On the marker as printed, in sides of its border from the upper left: x right, y down.
    pub on_tag: Point,
    /// Whether the boundary is upright there, or level.
    pub upright: bool,
    /// Whether black is on its right, or below.
    pub black_behind: bool,
    /// Where it is seen, px; along the boundary nothing is known of it.
    pub at: Point,
}

/// What is believed of a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensBelief {
    /// The likeliest.
    pub lens: Lens,
    /// Covariance of focal lengths and centre, px, of k₁, k₂, p₁, p₂ and k₃.
    pub covariance: SMatrix<f64, LENS_PARAMETERS, LENS_PARAMETERS>,
}

impl LensBelief {
    /// Of a lens that nobody has looked at: of usual webcams, 50° to 100° wide, with square pixels.
    pub fn unknown(width_px: usize, height_px: usize) -> Self {
        let width = width_px as f64;
        let focal = 0.8 * width;
        let mut covariance = SMatrix::zeros();
        // square pixels: the two focal lengths vary as one, but for 0.3 %
        let (common, apart) = (powi(0.4 * focal, 2), powi(0.003 * focal, 2));
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            covariance[(i, j)] = common + if i == j { apart } else { 0.0 };
        }
        for (k, deviation) in
            [(2, 0.02 * width), (3, 0.02 * width), (4, 0.2), (5, 0.1), (6, 1e-3), (7, 1e-3), (8, 0.02)]
        {
            covariance[(k, k)] = deviation * deviation;
        }
        Self { lens: Lens::ideal(width_px, height_px, focal), covariance }
    }
}

/// Where a board's page lies on the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPage {
    /// Number of its board in [`Board::ALL`].
    pub board: usize,
    /// Number of the page.
    pub page: u16,
    /// Where its middle is in the target frame, m.
    pub middle: Point,
    /// By how much it is turned anticlockwise, rad.
    pub turn_rad: f64,
    /// How far it seems to be in front of the plane, m.
    pub height_m: f64,
    /// By what share it seems to be printed larger than the first page.
    pub larger: f64,
}

impl PlacedPage {
    /// The target's frame from the page's own: its middle, x to its right, y up as printed.
    pub fn place(&self) -> Affine {
        planar::rotation(self.turn_rad).then_translate(self.middle.to_vec2())
    }
}

/// What does not look as it should: the wall may be further off than told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// A page that does not lie flat on the plane: which of [`Survey::pages`], and how far it seems to be in front of it, m.
    Loose(usize, f64),
    /// A page printed at another scale than the first: which, and by what share larger.
    Scaled(usize, f64),
    /// Places are that many times as far off as they scatter on a marker by itself.
    Misfit(f64),
    /// The lens is that many deviations from what was believed of it.
    Lens(f64),
}

/// Why cameras can not be found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// An image without markers.
    #[error(
        "image {view} shows no marker of a board: print one (`tracelight calibrate sheet`), have all of it in sight, sharp and lit"
    )]
    NoMarkers {
        /// Which, from 1.
        view: usize,
    },
    /// A page that is there twice.
    #[error(
        "image {view} shows page {page} twice: every page has markers of its own and is printed once; print others (--first) or cover one"
    )]
    Twice {
        /// Which, from 1.
        view: usize,
        /// Number of the page, from 1.
        page: u16,
    },
    /// Pages that no image links.
    #[error("page {page} is in no image together with the other pages: take one that shows both")]
    Apart {
        /// Number of the page, from 1.
        page: u16,
    },
    /// Nothing fits.
    #[error("the {tags} markers fit no camera: is the wall flat, and are the pages flat on it?")]
    NoFit {
        /// How many markers there are.
        tags: usize,
    },
}

/// What a survey finds.
#[derive(Clone, Debug)]
pub struct Survey {
    /// The lens that all images were taken with.
    pub belief: LensBelief,
    /// The pose of each image's camera. The target frame is that of the first page's board.
    pub poses: Vec<CameraPose>,
    /// Where the pages lie.
    pub pages: Vec<PlacedPage>,
    /// How far ink and exposure move black's edges outwards, px.
    pub spread_px: f64,
    /// Root of the mean squared distance of places from where they should be seen, px; what is far off counts less.
    pub rms_px: f64,
    /// Number of places that were told apart.
    pub places: usize,
    /// What does not look as it should.
    pub doubts: Vec<Doubt>,
    /// Covariance of each image's pose with the lens.
    covariances: Vec<Covariance>,
}

type Covariance = SMatrix<f64, CAMERA_PARAMETERS, CAMERA_PARAMETERS>;

/// A camera with what is not known of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurveyedCamera {
    /// The likeliest.
    pub camera: Camera,
    /// Covariance of a small turn about the camera's axes, rad, of the translation, m, and of the lens's parameters.
    pub covariance: SMatrix<f64, CAMERA_PARAMETERS, CAMERA_PARAMETERS>,
}

impl SurveyedCamera {
    /// The point of the target that is seen at a pixel, with what a pixel's covariance, px², and the camera's own make of it, m².
    pub fn target(&self, pixel: Point, covariance_px2: &Matrix2<f64>) -> Option<Uncertain> {
        let at = self.camera.target(pixel)?;
        let (_, by_point, [u, v]) = self.camera.derivatives(at)?;
        let back = by_point.try_inverse()?;
        let own = self.pixels(&[u, v]) + covariance_px2;
        Some(Uncertain { at, covariance: back * own * back.transpose() })
    }

    /// Where a point of the target is seen, with what the camera's covariance makes of it, px².
    pub fn pixel(&self, on_target: Point) -> Option<Uncertain> {
        let (at, _, by) = self.camera.derivatives(on_target)?;
        Some(Uncertain { at, covariance: self.pixels(&by) })
    }

    /// Expresses the survey in another frame on the target plane; `frame_from_target` is a rotation and a translation.
    #[must_use]
    pub fn in_frame(&self, frame_from_target: Affine) -> Self {
        let pose = self.camera.pose.in_frame(frame_from_target);
        // the translation in the other frame is t − R s, so that a turn by w changes it by dt − w × R s
        let shift = self.camera.pose.translation_m - pose.translation_m;
        let mut by_own = SMatrix::<f64, CAMERA_PARAMETERS, CAMERA_PARAMETERS>::identity();
        by_own.fixed_view_mut::<3, 3>(3, 0).copy_from(&shift.cross_matrix());
        let covariance = by_own * self.covariance * by_own.transpose();
        Self { camera: Camera { pose, ..self.camera }, covariance }
    }

    fn pixels(&self, by: &[[f64; CAMERA_PARAMETERS]; 2]) -> Matrix2<f64> {
        let rows = SMatrix::<f64, 2, CAMERA_PARAMETERS>::from_fn(|i, k| by[i][k]);
        rows * self.covariance * rows.transpose()
    }

    /// How far the target is likely to be off at these pixels, root of the mean square, m; `None` if one of them shows no target.
    pub fn wall_deviation_m(&self, pixels: &[Point]) -> Option<f64> {
        let square = |pixel: &Point| Some(self.target(*pixel, &Matrix2::zeros())?.covariance.trace());
        let squares: Option<Vec<f64>> = pixels.iter().map(square).collect();
        squares.map(|squares| (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt())
    }
}

impl Survey {
    /// An image's camera.
    pub fn camera(&self, view: usize) -> Option<SurveyedCamera> {
        let camera = Camera { lens: self.belief.lens, pose: *self.poses.get(view)? };
        Some(SurveyedCamera { camera, covariance: *self.covariances.get(view)? })
    }
}

/// Finds the cameras of images of one lens, and where the pages in them lie on their common plane. Boards are as printed.
///
/// # Errors
/// See [`SurveyError`].
pub fn survey(belief: &LensBelief, boards: &[Board], views: &[Vec<SeenTag>]) -> Result<Survey, SurveyError> {
    if views.is_empty() {
        return Err(SurveyError::NoMarkers { view: 1 });
    }
    let all = sightings(boards, views)?;
    let tags = views.iter().map(Vec::len).sum();
    let start = start::start(belief, &all)?;
    let mut bundle = Bundle { belief, sightings: &all.places, scale: 1.0 };
    let mut state = start;
    let mut normal = Normal::zero(0);
    // scattered as they are seen to be, and again when they fit
    for _ in 0..3 {
        bundle.scale = bundle.scatter(&state).max(1.0);
        (state, normal) = solve(&bundle, state, MOST_STEPS).ok_or(SurveyError::NoFit { tags })?;
    }
    let covariance = normal.covariance().ok_or(SurveyError::NoFit { tags })?;
    let rms_px = bundle.rms_px(&state);
    // no wall is known to a millimetre by such
    if rms_px > MOST_RMS_PX {
        return Err(SurveyError::NoFit { tags });
    }
    Ok(told(&bundle, &all, &state, &covariance, rms_px))
}

/// Most steps of one fit; a usual one takes ten.
const MOST_STEPS: usize = 200;
/// Furthest that places may be off from where they should be seen, root of the mean square, px.
const MOST_RMS_PX: f64 = 1.5;
/// From how many deviations on something is doubtful.
const DOUBTFUL: f64 = 3.0;
const LOOSE: f64 = 1.5;

fn doubts(bundle: &Bundle, state: &State) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    for (page, place) in state.pages.iter().enumerate() {
        // most of what a page is off by, an unknown lens takes upon itself
        if place.height_m.abs() > LOOSE * HEIGHT_DEVIATION_M {
            doubts.push(Doubt::Loose(page, place.height_m));
        }
        if place.larger.abs() > LOOSE * LARGER_DEVIATION {
            doubts.push(Doubt::Scaled(page, place.larger));
        }
    }
    let (scatter, surprise) = (bundle.scatter(state), bundle.surprise(state));
    doubts.extend((scatter > DOUBTFUL).then_some(Doubt::Misfit(scatter)));
    doubts.extend((surprise > DOUBTFUL).then_some(Doubt::Lens(surprise)));
    doubts
}

fn told(bundle: &Bundle, all: &All, state: &State, covariance: &DMatrix<f64>, rms_px: f64) -> Survey {
    let of_view = |view: usize| {
        let number = |k: usize| {
            if k < POSE_PARAMETERS { state.pose_at(view) + k } else { k - POSE_PARAMETERS }
        };
        let own = SMatrix::from_fn(|i, j| covariance[(number(i), number(j))]);
        let slopes = Slopes::of(&state.poses[view], &state.lens).matrix();
        slopes * own * slopes.transpose()
    };
    let covariances: Vec<Covariance> = (0..state.poses.len()).map(of_view).collect();
    let pages = all.pages.iter().zip(&state.pages).map(|(&(board, page), placed)| PlacedPage {
        board,
        page,
        middle: Point::new(placed.x, placed.y),
        turn_rad: placed.turn_rad,
        height_m: placed.height_m,
        larger: placed.larger,
    });
    Survey {
        belief: LensBelief {
            lens: bundle.belief.lens.with(state.lens),
            // the lens is the same in all of them
            covariance: covariances[0]
                .fixed_view::<LENS_PARAMETERS, LENS_PARAMETERS>(POSE_PARAMETERS, POSE_PARAMETERS)
                .into(),
        },
        poses: state.poses.clone(),
        pages: pages.collect(),
        spread_px: state.spread_px,
        rms_px,
        places: all.places.len(),
        doubts: doubts(bundle, state),
        covariances,
    }
}

/// A direction across another.
fn across(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}
