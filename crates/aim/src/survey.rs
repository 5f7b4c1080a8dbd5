//! Cameras and boards' pages found from what the cameras see of the boards' markers.
//!
//! Every place where a marker's black meets white tells how far that is from where it should be seen, across it; poses, lens, where the pages
//! lie on their plane and how far ink runs are those that fit all places best (bundle adjustment: Triggs et al. 1999), with what is
//! believed of the lens beforehand as one measurement more.

mod residual;
mod start;

use nalgebra::{DMatrix, Matrix2, SMatrix};
use tracelight_stroke::{Point, Vec2};

use crate::board::Board;
use crate::camera::{CAMERA_PARAMETERS, Camera, CameraPose, POSE_PARAMETERS, Uncertain};
use crate::least_squares::{Normal, solve};
use crate::lens::{LENS_PARAMETERS, Lens};
use residual::{Bundle, State, sightings};

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
        let (common, apart) = ((0.4 * focal).powi(2), (0.003 * focal).powi(2));
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
    /// Covariance of each image's pose with the lens.
    covariances: Vec<SMatrix<f64, CAMERA_PARAMETERS, CAMERA_PARAMETERS>>,
}

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

/// Finds the cameras of images of one lens, and where the pages in them lie on their common plane. Sheets are as printed.
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
        (state, normal) = solve(&bundle, state, 60).ok_or(SurveyError::NoFit { tags })?;
    }
    let covariance = normal.covariance().ok_or(SurveyError::NoFit { tags })?;
    let rms_px = bundle.rms_px(&state);
    // a tenth of a marker's cell, where a wrong fit has whole cells
    if rms_px > MOST_RMS_PX {
        return Err(SurveyError::NoFit { tags });
    }
    Ok(told(belief, &all, &state, &covariance, rms_px))
}

/// Furthest that places may be off from where they should be seen, root of the mean square, px.
const MOST_RMS_PX: f64 = 3.0;

fn told(
    belief: &LensBelief,
    all: &residual::All,
    state: &State,
    covariance: &DMatrix<f64>,
    rms_px: f64,
) -> Survey {
    let of_view = |view: usize| {
        let number = |k: usize| {
            if k < POSE_PARAMETERS { state.pose_at(view) + k } else { k - POSE_PARAMETERS }
        };
        SMatrix::from_fn(|i, j| covariance[(number(i), number(j))])
    };
    let pages = all.pages.iter().zip(&state.pages).map(|(&(board, page), placed)| PlacedPage {
        board,
        page,
        middle: Point::new(placed.x, placed.y),
        turn_rad: placed.turn_rad,
    });
    Survey {
        belief: LensBelief {
            lens: belief.lens.with(state.lens),
            covariance: SMatrix::from_fn(|i, j| covariance[(i, j)]),
        },
        poses: state.poses.clone(),
        pages: pages.collect(),
        spread_px: state.spread_px,
        rms_px,
        places: all.places.len(),
        covariances: (0..state.poses.len()).map(of_view).collect(),
    }
}

/// A direction across another.
fn across(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a camera sees of pages that lie so, to a deviation.
    fn seen(
        camera: &Camera,
        board: &Board,
        pages: &[(u16, Point, f64)],
        deviation_px: f64,
        dice: &mut oorandom::Rand64,
    ) -> Vec<SeenTag> {
        let mut normal = || (0..12).map(|_| dice.rand_float()).sum::<f64>() - 6.0;
        let mut all = Vec::new();
        for &(page, middle, turn_rad) in pages {
            let (s, c) = f64::sin_cos(turn_rad);
            let pixel = |p: Point| {
                camera.pixel(Point::new(c * p.x - s * p.y + middle.x, s * p.x + c * p.y + middle.y)).unwrap()
            };
            for number in 0..board.tags() {
                let printed = board.corners(number);
                let (right, down) = (printed[1] - printed[0], printed[3] - printed[0]);
                let place = |k: usize| {
                    // the four sides of the border
                    let (side, along) = (k / 8, (k % 8) as f64 / 8.0 + 0.0625);
                    let on_tag = [(along, 0.0), (1.0, along), (along, 1.0), (0.0, along)]
                        .map(|(x, y)| Point::new(x, y))[side];
                    let upright = side % 2 == 1;
                    let at = |p: Point| pixel(printed[0] + right * p.x + down * p.y);
                    let step = if upright { Vec2::new(0.0, 1e-4) } else { Vec2::new(1e-4, 0.0) };
                    let along = at(on_tag + step) - at(on_tag - step);
                    let off = across(along / along.hypot()) * (deviation_px * normal());
                    SeenPlace { on_tag, upright, black_behind: side == 0 || side == 3, at: at(on_tag) + off }
                };
                let places = (0..32).map(place).collect();
                all.push(SeenTag {
                    id: board.id(page, number),
                    corners: printed.map(pixel),
                    places,
                    deviation_px,
                });
            }
        }
        all
    }

    fn webcam() -> Lens {
        Lens {
            radial: [-0.1, 0.01, 0.0],
            centre_px: Point::new(652.0, 351.0),
            ..Lens::ideal(1280, 720, 1000.0)
        }
    }

    fn corners() -> Vec<(u16, Point, f64)> {
        vec![
            (0, Point::ORIGIN, 0.0),
            (1, Point::new(0.72, 0.03), 1.5),
            (2, Point::new(0.70, -0.35), -0.1),
            (5, Point::new(-0.04, -0.31), 0.05),
        ]
    }

    fn looking(x: f64, y: f64) -> CameraPose {
        CameraPose::looking_at([x, y, 1.2], [0.35, -0.17, 0.0]).unwrap()
    }

    #[test]
    fn a_camera_and_where_pages_lie_are_found_and_how_well_is_known() {
        let (runs, deviation_px) = (30, 0.1);
        let (mut squares, mut ratio) = (0.0, 0.0);
        for seed in 0..runs {
            let mut dice = oorandom::Rand64::new(seed);
            let camera = Camera { lens: webcam(), pose: looking(dice.rand_float() - 0.1, -0.3) };
            let tags = seen(&camera, &Board::FINE, &corners(), deviation_px, &mut dice);
            let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap();
            assert!((found.rms_px / deviation_px - 1.0).abs() < 0.1, "{}", found.rms_px);
            let placed = found.pages[3];
            assert_eq!((placed.board, placed.page), (0, 5));
            assert!(
                placed.middle.distance(Point::new(-0.04, -0.31)) < 3e-4
                    && (placed.turn_rad - 0.05).abs() < 2e-3
            );
            let told = found.camera(0).unwrap();
            for k in 0..9 {
                let on_wall = Point::new(0.35 * f64::from(k % 3), -0.16 * f64::from(k / 3));
                let got = told.target(camera.pixel(on_wall).unwrap(), &Matrix2::zeros()).unwrap();
                squares += (got.at - on_wall).hypot2() / (9.0 * runs as f64);
                ratio += (got.at - on_wall).hypot2() / got.covariance.trace() / (9.0 * runs as f64);
            }
        }
        assert!(squares.sqrt() < 1e-4, "{} m", squares.sqrt());
        assert!((0.6..1.6).contains(&ratio), "errors are {ratio} times as large as told, squared");
    }

    #[test]
    fn several_views_tell_the_lens() {
        let mut dice = oorandom::Rand64::new(7);
        let poses = [(0.35, -0.17), (-0.6, 0.2), (1.2, 0.3), (0.4, -1.0), (0.2, 0.8)];
        let views: Vec<Vec<SeenTag>> = poses
            .iter()
            .map(|&(x, y)| {
                let camera = Camera { lens: webcam(), pose: looking(x, y) };
                seen(&camera, &Board::FINE, &corners(), 0.1, &mut dice)
            })
            .collect();
        let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &views).unwrap();
        let lens = found.belief.lens;
        let deviation = |k: usize| found.belief.covariance[(k, k)].sqrt();
        assert!((lens.focal_px[0] - 1000.0).abs() < 4.0 * deviation(0) && deviation(0) < 1.0);
        assert!((lens.radial[0] + 0.1).abs() < 4.0 * deviation(4) && deviation(4) < 5e-3);
        assert!(lens.centre_px.distance(webcam().centre_px) < 1.0);
        // with the lens known, one view of one page is enough to see the whole wall as it is
        let camera = Camera { lens: webcam(), pose: looking(0.1, -0.6) };
        let one = seen(&camera, &Board::FINE, &corners()[..1], 0.1, &mut dice);
        let known = survey(&found.belief, &Board::ALL, &[one]).unwrap().camera(0).unwrap();
        let far = Point::new(0.7, -0.3);
        let off = known.camera.target(camera.pixel(far).unwrap()).unwrap().distance(far);
        assert!(off < 1.5e-3, "{off} m");
    }

    #[test]
    fn what_can_not_be_surveyed_says_why() {
        let mut dice = oorandom::Rand64::new(1);
        let camera = Camera { lens: webcam(), pose: looking(0.3, 0.0) };
        let view = |pages: &[(u16, Point, f64)], dice: &mut _| seen(&camera, &Board::FINE, pages, 0.1, dice);
        let belief = LensBelief::unknown(1280, 720);
        let check = |views: &[Vec<SeenTag>], error: SurveyError| {
            assert_eq!(survey(&belief, &Board::ALL, views).unwrap_err(), error);
        };
        let (first, last) = (view(&corners()[..1], &mut dice), view(&corners()[3..], &mut dice));
        check(&[first.clone(), vec![]], SurveyError::NoMarkers { view: 2 });
        check(&[first, last], SurveyError::Apart { page: 6 });
        check(&[], SurveyError::NoMarkers { view: 1 });
        // pages that change places between two images
        let mut swapped = corners();
        (swapped[1].1, swapped[2].1) = (swapped[2].1, swapped[1].1);
        let views = [view(&corners(), &mut dice), view(&swapped, &mut dice)];
        assert!(matches!(survey(&belief, &Board::ALL, &views), Err(SurveyError::NoFit { .. })));
    }

    #[test]
    fn a_marker_that_was_moved_counts_little() {
        let mut dice = oorandom::Rand64::new(2);
        let camera = Camera { lens: webcam(), pose: looking(0.5, -0.3) };
        let mut tags = seen(&camera, &Board::FINE, &corners(), 0.1, &mut dice);
        for place in &mut tags[7].places {
            place.at += Vec2::new(4.0, -3.0);
        }
        let found = survey(&LensBelief::unknown(1280, 720), &Board::ALL, &[tags]).unwrap().camera(0).unwrap();
        let on_wall = Point::new(0.3, -0.2);
        assert!(found.camera.target(camera.pixel(on_wall).unwrap()).unwrap().distance(on_wall) < 3e-4);
    }
}
