use nalgebra::{SMatrix, SVector};
use tracelight_maths::{ln, powi};
use tracelight_stroke::{Point, Vec2};

use super::valley::{Slopes, lens_by_coordinates, stepped_lens, stepped_pose};
use super::{LensBelief, SeenTag, SurveyError, across};
use crate::board::Board;
use crate::camera::{CAMERA_PARAMETERS, CameraPose, POSE_PARAMETERS};
use crate::dual::Dual;
use crate::homography::Homography;
use crate::least_squares::{Normal, Problem};
use crate::lens::{LENS_PARAMETERS, distorted};

/// A place where a marker's black meets white, on its page and in an image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sighting {
    pub(super) view: usize,
    pub(super) page: usize,
    /// As meant, page frame, m.
    pub(super) at: Point,
    /// Where it is seen, px.
    pub(super) pixel: Point,
    /// Across the boundary in the image, into the black, a unit long.
    pub(super) normal: Vec2,
    /// How far it scatters along that, px.
    pub(super) deviation_px: f64,
    /// How much of black's spread is along that: 1 on a boundary, 0 of a corner.
    pub(super) spreads: f64,
}

/// Everything that is seen.
#[derive(Clone, Debug)]
pub(super) struct All {
    /// Board and number of each page, in order.
    pub(super) pages: Vec<(usize, u16)>,
    pub(super) views: usize,
    pub(super) places: Vec<Sighting>,
    /// Corners for a start: view, page, on the page, in the image.
    pub(super) corners: Vec<(usize, usize, Point, Point)>,
}

/// Least deviation of a place, px: what 8 bits of brightness leave.
const LEAST_DEVIATION_PX: f64 = 0.02;

/// Lays what is seen of every marker beside what is printed. Ids that are twice in an image are left out, both of them.
pub(super) fn sightings(boards: &[Board], views: &[Vec<SeenTag>]) -> Result<All, SurveyError> {
    let find = |id: u16| {
        let on = boards.iter().enumerate().find_map(|(k, board)| Some((k, board.find(id)?)));
        on.map(|(board, (page, number))| ((board, page), number))
    };
    let mut pages: Vec<(usize, u16)> =
        views.iter().flatten().filter_map(|tag| find(tag.id)).map(|(page, _)| page).collect();
    pages.sort_unstable();
    pages.dedup();
    let mut all = All { pages, views: views.len(), places: Vec::new(), corners: Vec::new() };
    for (view, tags) in views.iter().enumerate() {
        let before = all.corners.len();
        for tag in tags {
            let Some((page, number)) = find(tag.id).filter(|_| !is_twice(tags, tag)) else { continue };
            let (Some(board), Ok(place)) = (boards.get(page.0), all.pages.binary_search(&page)) else {
                continue;
            };
            all.add(view, place, &board.corners(number), tag);
        }
        let doubled = doubled(tags, &find);
        if let Some((_, page)) = doubled {
            return Err(SurveyError::Twice { view: view + 1, page: page + 1 });
        }
        if all.corners.len() == before {
            return Err(SurveyError::NoMarkers { view: view + 1 });
        }
    }
    all.forget_unseen();
    Ok(all)
}

/// Whether a marker's id is in an image more than once.
fn is_twice(tags: &[SeenTag], tag: &SeenTag) -> bool {
    tags.iter().filter(|other| other.id == tag.id).count() > 1
}

/// A page of which half the markers that are seen are there twice: somebody has printed it twice.
fn doubled(tags: &[SeenTag], find: &impl Fn(u16) -> Option<((usize, u16), u16)>) -> Option<(usize, u16)> {
    let page = |tag: &SeenTag| find(tag.id).map(|(page, _)| page);
    tags.iter().filter_map(page).find(|&own| {
        let here = || tags.iter().filter(move |tag| page(tag) == Some(own));
        here().count() > 2 && 2 * here().filter(|tag| is_twice(tags, tag)).count() >= here().count()
    })
}

impl All {
    /// Leaves out pages of which nothing can be used.
    fn forget_unseen(&mut self) {
        let seen = |page: usize| self.corners.iter().any(|corner| corner.1 == page);
        let kept: Vec<usize> = (0..self.pages.len()).filter(|&page| seen(page)).collect();
        let number = |page: usize| kept.iter().position(|&k| k == page).unwrap_or_default();
        self.pages = kept.iter().map(|&k| self.pages[k]).collect();
        self.corners.iter_mut().for_each(|corner| corner.1 = number(corner.1));
        self.places.iter_mut().for_each(|place| place.page = number(place.page));
    }

    fn add(&mut self, view: usize, page: usize, printed: &[Point; 4], tag: &SeenTag) {
        let pairs: [(Point, Point); 4] = std::array::from_fn(|k| (printed[k], tag.corners[k]));
        let Some(map) = Homography::through(&pairs, 1.0) else { return };
        self.corners.extend(pairs.map(|(at, pixel)| (view, page, at, pixel)));
        for seen in &tag.places {
            let (right, down) = (printed[1] - printed[0], printed[3] - printed[0]);
            let at = printed[0] + right * seen.on_tag.x + down * seen.on_tag.y;
            let (along, behind) = if seen.upright { (down, right) } else { (right, down) };
            let directions = map.carry(at, along).zip(map.carry(at, behind));
            let Some((along, behind)) = directions.filter(|(along, _)| along.hypot() > 0.0) else { continue };
            let normal = across(along / along.hypot());
            let into_black = (normal.dot(behind) > 0.0) == seen.black_behind;
            self.places.push(Sighting {
                view,
                page,
                at,
                pixel: seen.at,
                normal: if into_black { normal } else { -normal },
                deviation_px: tag.deviation_px.max(LEAST_DEVIATION_PX),
                spreads: 1.0,
            });
        }
    }
}

/// A page's place on the plane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) turn_rad: f64,
    /// How far it is in front of the plane, m, and by what share it is printed larger than the first.
    pub(super) height_m: f64,
    pub(super) larger: f64,
}

/// Everything a survey looks for.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) lens: [f64; LENS_PARAMETERS],
    pub(super) spread_px: f64,
    pub(super) pages: Vec<Place>,
    pub(super) poses: Vec<CameraPose>,
}

const PAGE_PARAMETERS: usize = 5;
/// What pages are off by of which nobody says anything, m and as a share: paper that is taped to a wall, and a printer's second page.
pub(super) const HEIGHT_DEVIATION_M: f64 = 2e-4;
pub(super) const LARGER_DEVIATION: f64 = 2e-4;
/// Index of the spread of black among the parameters.
const SPREAD_AT: usize = LENS_PARAMETERS;
/// Standard deviation of the prior on that spread, px. Ink bleed, or an unusual camera curve, shifts all edges of a blurred image.
const SPREAD_DEVIATION_PX: f64 = 0.3;

impl State {
    /// Where a page's parameters begin; the first page is the frame and has none.
    pub(super) fn page_at(&self, page: usize) -> Option<usize> {
        page.checked_sub(1).map(|k| SPREAD_AT + 1 + PAGE_PARAMETERS * k)
    }

    /// Where a pose's parameters begin.
    pub(super) fn pose_at(&self, view: usize) -> usize {
        SPREAD_AT + 1 + PAGE_PARAMETERS * (self.pages.len() - 1) + POSE_PARAMETERS * view
    }

    fn parameters(&self) -> usize {
        self.pose_at(self.poses.len())
    }
}

/// What is seen, and what is believed of the lens.
pub(super) struct Bundle<'a> {
    pub(super) belief: &'a LensBelief,
    pub(super) sightings: &'a [Sighting],
    /// How many times as far as told places scatter.
    pub(super) scale: f64,
}

/// Pose, lens, spread, page.
const LOCAL: usize = CAMERA_PARAMETERS + 1 + PAGE_PARAMETERS;

impl Bundle<'_> {
    /// Distance of a place from where it should be seen, across it, px, with its derivatives; `None` behind the camera.
    fn off(state: &State, seen: &Sighting) -> Option<Dual<LOCAL>> {
        let step = std::array::from_fn(|k| Dual::parameter(0.0, k));
        let lens = std::array::from_fn(|k| Dual::parameter(state.lens[k], POSE_PARAMETERS + k));
        let spread = Dual::parameter(state.spread_px, CAMERA_PARAMETERS);
        let place = state.pages[seen.page];
        let page = |k: usize, v: f64| Dual::<LOCAL>::parameter(v, CAMERA_PARAMETERS + 1 + k);
        let constant = |v: f64| <Dual<LOCAL> as crate::jet::Scalar>::constant(v);
        let (s, c) = crate::jet::Scalar::sin_cos(page(2, place.turn_rad));
        let larger = constant(1.0) + page(4, place.larger);
        let (x, y) = (constant(seen.at.x) * larger, constant(seen.at.y) * larger);
        let height = page(3, place.height_m);
        let on_target = [c * x - s * y + page(0, place.x), s * x + c * y + page(1, place.y), height];
        let [x, y, z] = state.poses[seen.view].seen(step, on_target);
        if z.value <= 1e-6 {
            return None;
        }
        let [u, v] = distorted(lens, [x / z, y / z]);
        Some(
            (constant(seen.pixel.x) - u) * constant(seen.normal.x)
                + (constant(seen.pixel.y) - v) * constant(seen.normal.y)
                + spread * constant(seen.spreads),
        )
    }

    /// Which of all parameters the local ones are; the first page's are none.
    fn numbers(state: &State, seen: &Sighting) -> [Option<usize>; LOCAL] {
        let pose = state.pose_at(seen.view);
        let page = state.page_at(seen.page);
        std::array::from_fn(|k| match k {
            k if k < POSE_PARAMETERS => Some(pose + k),
            k if k < CAMERA_PARAMETERS => Some(k - POSE_PARAMETERS),
            CAMERA_PARAMETERS => Some(SPREAD_AT),
            k => page.map(|page| page + k - CAMERA_PARAMETERS - 1),
        })
    }

    /// How many times as far as they are told to scatter places are off: by their median, which a few that are far off do not move.
    pub(super) fn scatter(&self, state: &State) -> f64 {
        let off = |seen: &Sighting| Some(Self::off(state, seen)?.value.abs() / seen.deviation_px);
        let mut all: Vec<f64> = self.sightings.iter().filter_map(off).collect();
        let middle = all.len() / 2;
        if all.is_empty() {
            return 1.0;
        }
        // half of a normal distribution lies within 0.6745 deviations
        *all.select_nth_unstable_by(middle, f64::total_cmp).1 / 0.6745
    }

    /// Root of the mean squared distance; what is beyond three times that counts as three times.
    pub(super) fn rms_px(&self, state: &State) -> f64 {
        let bound = 3.0 * self.scale;
        let off = |seen: &Sighting| {
            let off = Self::off(state, seen)?.value;
            Some(powi(off.abs().min(bound * seen.deviation_px), 2))
        };
        let all: Vec<f64> = self.sightings.iter().filter_map(off).collect();
        (all.iter().sum::<f64>() / all.len().max(1) as f64).sqrt()
    }

    fn believe(&self, state: &State, normal: &mut Normal) -> Option<()> {
        let (told, rows) = self.lens_off(state)?;
        let rows = rows * lens_by_coordinates(&state.lens);
        for i in 0..LENS_PARAMETERS {
            normal.add_belief(told[i], (0..LENS_PARAMETERS).map(|k| (k, rows[(i, k)])));
        }
        normal.add_belief(
            -state.spread_px / SPREAD_DEVIATION_PX,
            std::iter::once((SPREAD_AT, 1.0 / SPREAD_DEVIATION_PX)),
        );
        for (page, place) in state.pages.iter().enumerate() {
            let Some(at) = state.page_at(page) else { continue };
            for (k, value, deviation) in
                [(3, place.height_m, HEIGHT_DEVIATION_M), (4, place.larger, LARGER_DEVIATION)]
            {
                normal.add_belief(-value / deviation, std::iter::once((at + k, 1.0 / deviation)));
            }
        }
        Some(())
    }

    /// What was believed of the lens less what it is, as measurements of one deviation each that do not depend on each other, and what each
    /// of them makes of the parameters: the inverse of the covariance's lower triangle. Of focal lengths it is the logarithm: none is below
    /// zero, and twice as long is as far off as half.
    fn lens_off(&self, state: &State) -> Option<(SVector<f64, LENS_PARAMETERS>, LensMatrix)> {
        let likely = self.belief.lens.parameters();
        let unit = |k: usize| if k < 2 { likely[k] } else { 1.0 };
        let covariance = LensMatrix::from_fn(|i, j| self.belief.covariance[(i, j)] / (unit(i) * unit(j)));
        let rows = covariance.cholesky()?.l().try_inverse()?;
        let off = SVector::from_fn(|k, _| match k {
            0 | 1 => ln(likely[k] / state.lens[k]),
            k => likely[k] - state.lens[k],
        });
        Some((rows * off, rows))
    }

    /// By how many deviations the lens is not what was believed: the largest, of parameters that do not depend on each other.
    pub(super) fn surprise(&self, state: &State) -> f64 {
        self.lens_off(state).map_or(f64::INFINITY, |(told, _)| told.amax())
    }
}

type LensMatrix = SMatrix<f64, LENS_PARAMETERS, LENS_PARAMETERS>;

impl Problem for Bundle<'_> {
    type State = State;

    fn normal(&self, state: &State) -> Option<Normal> {
        let mut normal = Normal::zero(state.parameters());
        let slopes: Vec<Slopes> = state.poses.iter().map(|pose| Slopes::of(pose, &state.lens)).collect();
        for seen in self.sightings {
            let off = Self::off(state, seen)?;
            let numbers = Self::numbers(state, seen);
            let deviation = self.scale * seen.deviation_px;
            // what is told rises as the distance falls
            let by = slopes[seen.view].carry(&off.by);
            let by = numbers.iter().zip(&by).filter_map(|(number, d)| Some(((*number)?, -d / deviation)));
            normal.add(off.value / deviation, by);
        }
        self.believe(state, &mut normal)?;
        Some(normal)
    }

    fn stepped(&self, state: &State, step: &[f64]) -> State {
        let mut next = state.clone();
        next.lens = stepped_lens(&state.lens, step);
        next.spread_px += step[SPREAD_AT];
        for (page, place) in next.pages.iter_mut().enumerate() {
            let Some(at) = state.page_at(page) else { continue };
            (place.x, place.y) = (place.x + step[at], place.y + step[at + 1]);
            place.turn_rad += step[at + 2];
            (place.height_m, place.larger) = (place.height_m + step[at + 3], place.larger + step[at + 4]);
        }
        for (view, pose) in next.poses.iter_mut().enumerate() {
            let at = state.pose_at(view);
            *pose = stepped_pose(pose, std::array::from_fn(|k| step[at + k]), step);
        }
        next
    }
}
