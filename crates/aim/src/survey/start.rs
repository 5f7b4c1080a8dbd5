//! Initial values of a survey: poses from homographies, for several focal lengths.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use tracelight_maths::{acos, atan2, sin_cos};
use tracelight_stroke::{Point, Vec2};

use super::residual::{All, Bundle, Place, Sighting, State};
use super::{LensBelief, SurveyError};
use crate::camera::{Camera, CameraPose};
use crate::homography::Homography;
use crate::least_squares::solve;
use crate::lens::Lens;

/// Focal lengths that are tried, as multiples of the likeliest, where that is not known.
const GUESSES: [f64; 3] = [1.0, 0.65, 1.5];
/// Share of its focal length from which on a lens's is known.
const KNOWN: f64 = 0.1;
/// How well corners are known, px.
const CORNER_PX: f64 = 0.3;

/// A state near the best: the one that fits the corners best of those that several guesses lead to.
pub(super) fn start(belief: &LensBelief, all: &All) -> Result<State, SurveyError> {
    linked(all)?;
    let corners = as_sightings(all);
    let known = belief.covariance[(0, 0)].sqrt() < KNOWN * belief.lens.focal_px[0];
    let guesses = if known { &GUESSES[..1] } else { &GUESSES[..] };
    let bundle = Bundle { belief, sightings: &corners, scale: 1.0 };
    let mut best: Option<(f64, State)> = None;
    for factor in guesses {
        let lens = Lens { focal_px: belief.lens.focal_px.map(|f| f * factor), ..belief.lens };
        // from a wrong focal length a page may seem to lie where the wall is not
        let Some(rough) = chained(&lens, all) else { continue };
        for state in [mirrored(&rough), rough] {
            // coarse first: from a wrong focal length all corners are far off
            let loose = Bundle { scale: bundle.scatter(&state).max(1.0), ..bundle };
            let Some((state, _)) = solve(&loose, state, 30) else { continue };
            let Some((state, normal)) = solve(&bundle, state, 60) else { continue };
            if best.as_ref().is_none_or(|(cost, _)| normal.cost < *cost) {
                best = Some((normal.cost, state));
            }
        }
    }
    best.map(|(_, state)| state).ok_or(SurveyError::NoFit { tags: all.corners.len() / 4 })
}

/// Corners as places, each across and down.
fn as_sightings(all: &All) -> Vec<Sighting> {
    let both = |&(view, page, at, pixel): &(usize, usize, Point, Point)| {
        [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)].map(|normal| Sighting {
            view,
            page,
            at,
            pixel,
            normal,
            deviation_px: CORNER_PX,
            spreads: 0.0,
        })
    };
    all.corners.iter().flat_map(both).collect()
}

/// Whether images link all pages and are linked by them.
fn linked(all: &All) -> Result<(), SurveyError> {
    let mut pages = vec![false; all.pages.len()];
    pages[0] = true;
    for _ in 0..all.views {
        for view in 0..all.views {
            let here = || all.corners.iter().filter(move |corner| corner.0 == view).map(|corner| corner.1);
            if here().any(|page| pages[page]) {
                here().for_each(|page| pages[page] = true);
            }
        }
    }
    match pages.iter().position(|linked| !linked) {
        Some(page) => Err(SurveyError::Apart { page: all.pages[page].1 + 1 }),
        None => Ok(()),
    }
}

/// Poses and pages one after the other, from the first page on, with what is known of the lens.
fn chained(lens: &Lens, all: &All) -> Option<State> {
    let mut pages: Vec<Option<Place>> = vec![None; all.pages.len()];
    pages[0] = Some(Place::default());
    let mut poses: Vec<Option<CameraPose>> = vec![None; all.views];
    loop {
        let known = (pages.iter().flatten().count(), poses.iter().flatten().count());
        for (view, found) in poses.iter_mut().enumerate() {
            *found = found.or_else(|| pose(lens, all, &pages, view));
            let Some(pose) = *found else { continue };
            let camera = Camera { lens: *lens, pose };
            for (page, found) in pages.iter_mut().enumerate() {
                *found = found.or_else(|| place(&camera, all, view, page));
            }
        }
        if known == (pages.iter().flatten().count(), poses.iter().flatten().count()) {
            break;
        }
    }
    let (poses, pages): (Option<Vec<CameraPose>>, Option<Vec<Place>>) =
        (poses.into_iter().collect(), pages.into_iter().collect());
    Some(State { lens: lens.parameters(), spread_px: 0.0, pages: pages?, poses: poses? })
}

/// The pose from which the pages whose places are known are seen as they are.
fn pose(lens: &Lens, all: &All, pages: &[Option<Place>], view: usize) -> Option<CameraPose> {
    let pair = |&(seen_in, page, at, pixel): &(usize, usize, Point, Point)| {
        let place = pages[page].filter(|_| seen_in == view)?;
        let [x, y] = lens.direction(pixel)?;
        Some((place.apply(at), Point::new(x, y)))
    };
    let pairs: Vec<(Point, Point)> = all.corners.iter().filter_map(pair).collect();
    let map = Homography::through(&pairs, CORNER_PX / lens.focal_px[0])?;
    // columns: the plane's x and y as the camera has them, and its origin, all by one factor (Zhang 2000, §3.1)
    let matrix = map.matrix();
    let (x, y, origin) = (matrix.column(0), matrix.column(1), matrix.column(2));
    // what is seen lies ahead; the plane's origin may not
    let seen = pairs.iter().map(|(at, _)| at.to_vec2()).sum::<Vec2>() / pairs.len() as f64;
    let ahead = matrix[(2, 0)] * seen.x + matrix[(2, 1)] * seen.y + matrix[(2, 2)];
    let factor = (x.norm() * y.norm()).sqrt().copysign(ahead);
    let (x, y) = (x / factor, y / factor);
    let near = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    let svd = near.svd(true, true);
    let rotation = Rotation3::from_matrix_unchecked(svd.u? * svd.v_t?);
    (rotation.matrix().determinant() > 0.0).then(|| CameraPose { rotation, translation_m: origin / factor })
}

impl Place {
    fn apply(&self, at: Point) -> Point {
        let (s, c) = sin_cos(self.turn_rad);
        Point::new(c * at.x - s * at.y + self.x, s * at.x + c * at.y + self.y)
    }
}

/// Where a page lies that a camera sees: its corners carried back, and the turn and move that fit them best.
fn place(camera: &Camera, all: &All, view: usize, page: usize) -> Option<Place> {
    let here = all.corners.iter().filter(|corner| corner.0 == view && corner.1 == page);
    let pairs: Option<Vec<(Vec2, Vec2)>> =
        here.map(|&(_, _, at, pixel)| Some((at.to_vec2(), camera.target(pixel)?.to_vec2()))).collect();
    let pairs = pairs.filter(|pairs| !pairs.is_empty())?;
    let n = pairs.len() as f64;
    let mean = |of: fn(&(Vec2, Vec2)) -> Vec2| pairs.iter().map(of).sum::<Vec2>() / n;
    let (from, to) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let (sine, cosine) = pairs.iter().fold((0.0, 0.0), |(sine, cosine), (a, b)| {
        let (a, b) = (*a - from, *b - to);
        (sine + a.cross(b), cosine + a.dot(b))
    });
    let turned = Place { turn_rad: atan2(sine, cosine), ..Place::default() };
    let by = to - turned.apply(from.to_point()).to_vec2();
    Some(Place { x: by.x, y: by.y, ..turned })
}

/// Returns the mirrored poses: a small plane looks nearly alike from both (Oberkampf, DeMenthon & Davis, *Iterative
/// pose estimation using coplanar feature points*, 1996).
fn mirrored(state: &State) -> State {
    let mirror = |pose: &CameraPose| {
        let (normal, sight) = (pose.rotation * Vector3::z(), pose.translation_m.normalize());
        let turn = Unit::try_new(normal.cross(&sight), 1e-6).map_or_else(Rotation3::identity, |axis| {
            // the plane's normal comes towards the camera
            let lean = acos((-normal.dot(&sight)).clamp(-1.0, 1.0));
            Rotation3::from_axis_angle(&axis, -2.0 * lean)
        });
        CameraPose { rotation: turn * pose.rotation, ..*pose }
    };
    State { poses: state.poses.iter().map(mirror).collect(), ..state.clone() }
}
