//! Locates the black–white boundary of a marker with known cells on the grey levels.
//!
//! Across the middle of each boundary between a black cell and a white one the light is what the cells about it are, blurred; how far
//! the boundary is off from where it is thought to be is what fits the light there best, together with its brightness, its contrast
//! and, for all boundaries together, the blur. Nothing is lost where cells are hardly wider than the blur.

use std::sync::LazyLock;

use tracelight_image::Plane;
use tracelight_image::solve::symmetric;
use tracelight_maths::{exp, powi};
use tracelight_stroke::{Point, Vec2};

use super::place::TagPlace;
use super::square::{Off, SIDE, Square};
use crate::light::{Border, light_of_levels, smooth};

/// Samples across a boundary.
const SAMPLES: usize = 11;
/// Furthest of them, in cells.
const REACH_CELLS: f64 = 1.25;
/// Transitions between cells that reach into the samples, either way.
const NEAR: isize = 2;
const TRANSITIONS: usize = 2 * NEAR as usize + 1;
/// Initial blur: standard deviation, px.
const FIRST_BLUR_PX: f64 = 1.0;
/// Smallest and largest blur that is estimated, px.
const BLUR_PX: (f64, f64) = (0.4, 4.0);
/// How far off a boundary can be placed, px.
const FURTHEST_PX: f64 = 1.5;
/// Least contrast of a boundary, as a share of the brightest there can be.
const LEAST_CONTRAST: f64 = 0.004;
/// Fewest boundaries that place a marker.
const FEWEST: usize = 24;

/// What is looked up rather than worked out each time.
pub(super) struct Tables {
    /// Light from levels: halfway up a blurred edge in levels is not where the edge is.
    light: &'static [f32; 256],
    /// The normal distribution, in steps of 1/[`STEPS`] of a deviation from −[`TAILS`] on, and its density.
    below: [f32; 2 * TAILS * STEPS + 1],
    bell: [f32; 2 * TAILS * STEPS + 1],
}

const STEPS: usize = 64;
const TAILS: usize = 5;

impl Tables {
    pub(super) fn get() -> &'static Self {
        static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);
        &TABLES
    }

    fn new() -> Self {
        let deviations = |k: usize| k as f64 / STEPS as f64 - TAILS as f64;
        let density = |z: f64| exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt();
        let bell = std::array::from_fn(|k| density(deviations(k)) as f32);
        let mut below = [0.0; 2 * TAILS * STEPS + 1];
        let mut sum = 0.0;
        for (k, v) in below.iter_mut().enumerate().skip(1) {
            // Simpson's rule over each step
            let (a, b) = (deviations(k - 1), deviations(k));
            sum += (density(a) + 4.0 * density(f64::midpoint(a, b)) + density(b)) / (6.0 * STEPS as f64);
            *v = sum as f32;
        }
        Self { light: light_of_levels(), below, bell }
    }

    /// The normal distribution at `z` deviations.
    fn normal(&self, z: f32) -> f32 {
        Self::between(&self.below, z)
    }

    /// Its density.
    fn density(&self, z: f32) -> f32 {
        Self::between(&self.bell, z)
    }

    fn between(table: &[f32; 2 * TAILS * STEPS + 1], z: f32) -> f32 {
        let place = ((z + TAILS as f32) * STEPS as f32).clamp(0.0, (2 * TAILS * STEPS) as f32 - 0.5);
        let k = place as i32;
        let (low, high) = (table[k as usize], table[k as usize + 1]);
        low + (high - low) * (place - k as f32)
    }
}

/// How closely a marker is looked at.
#[derive(Clone, Copy)]
struct Closeness {
    /// How many times its light is smoothed. What a sensor of one colour a pixel fills in goes away by it, which is different from pixel to
    /// pixel, and what is left bends so little from pixel to pixel that a straight line between them is true.
    smoothings: usize,
    /// Furthest sample across a boundary, px.
    reach_px: f64,
}

impl Closeness {
    /// Of a marker by the side of its smallest cells, px. The smallest have no sharpness to spare: with all smoothed once, corners of eighty
    /// markers down to 19 px a side are found to 0.055 px, with none 0.053, so 0.048. Large ones have room for more: looked at as those of
    /// middle size are, four pages of four put the wall 0.039 mm off, so 0.026.
    const fn for_cells(side_px: f64) -> Self {
        let (smoothings, reach_px) = match side_px {
            ..3.0 => (0, 2.5),
            ..6.0 => (1, 2.5),
            _ => (2, MOST_REACH_PX),
        };
        Self { smoothings, reach_px }
    }

    fn of(corners: &[Point; 4]) -> Self {
        let sides = (0..4).map(|k| corners[k].distance(corners[(k + 1) % 4]));
        Self::for_cells(sides.fold(f64::MAX, f64::min) / SIDE as f64)
    }
}

const MOST_REACH_PX: f64 = 3.5;

/// The light of a part of an image.
struct Part {
    /// Its upper left, px.
    corner: Vec2,
    light: Plane<f32>,
}

impl Part {
    /// About a square and what is looked at beside it.
    fn about(plane: &Plane<u8>, tables: &Tables, corners: &[Point; 4], smoothings: usize) -> Self {
        const MARGIN: f64 = 2.0 * FURTHEST_PX + MOST_REACH_PX + 2.0;
        let range = |of: fn(&Point) -> f64, size: usize| {
            let least = corners.iter().map(of).fold(f64::MAX, f64::min) - MARGIN;
            let most = corners.iter().map(of).fold(f64::MIN, f64::max) + MARGIN;
            let place = |v: f64| v.clamp(0.0, size as f64) as usize;
            (place(least), place(most.ceil()))
        };
        let ((left, right), (top, bottom)) = (range(|p| p.x, plane.width), range(|p| p.y, plane.height));
        let mut values = Vec::with_capacity((right - left) * (bottom - top));
        for y in top..bottom {
            values.extend(plane.row(y)[left..right].iter().map(|&v| tables.light[usize::from(v)]));
        }
        let mut light = Plane { width: right - left, height: bottom - top, values };
        (0..smoothings).for_each(|_| smooth(&mut light, Border::Stays));
        let corner = Vec2::new(left as f64, top as f64);
        Self { corner, light }
    }

    /// Light at equal steps from a place on, bilinear; `None` where a step leads out of the part.
    fn along(&self, from: Point, step: Vec2, light: &mut [f32]) -> Option<()> {
        let steps = self.light.steps(from - self.corner, step, light.len())?;
        let share = |v: i32| v as f32 * (1.0 / 65536.0);
        for (v, (first, x, y)) in light.iter_mut().zip(steps) {
            let mix = |first: usize| match self.light.values.get(first..first + 2) {
                Some(&[a, b]) => a + (b - a) * share(x),
                _ => 0.0,
            };
            let (above, below) = (mix(first), mix(first + self.light.width));
            *v = above + (below - above) * share(y);
        }
        Some(())
    }
}

/// A marker's cells: black or white, with what lies about them.
pub(super) struct Cells([[bool; SIDE]; SIDE]);

impl Cells {
    pub(super) const fn new(black: [[bool; SIDE]; SIDE]) -> Self {
        Self(black)
    }

    /// 1 is white; about the marker there is white.
    fn white(&self, column: isize, row: isize) -> f32 {
        let inside = |v: isize| usize::try_from(v).ok().filter(|v| *v < SIDE);
        match (inside(column), inside(row)) {
            (Some(column), Some(row)) if self.0[row][column] => 0.0,
            _ => 1.0,
        }
    }
}

/// A boundary between two cells: behind cell `before` along its axis, in a column or row.
#[derive(Clone, Copy)]
struct Boundary {
    upright: bool,
    before: isize,
    lane: isize,
}

impl Boundary {
    /// White of the cell that is `k` behind the boundary, `aside` lanes beside it.
    fn white(&self, cells: &Cells, k: isize, aside: isize) -> f32 {
        let (along, across) = (self.before + k, self.lane + aside);
        if self.upright { cells.white(along, across) } else { cells.white(across, along) }
    }

    /// Its middle, in cells.
    fn middle(&self) -> Point {
        let (on, lane) = ((self.before + 1) as f64, self.lane as f64 + 0.5);
        if self.upright { Point::new(on, lane) } else { Point::new(lane, on) }
    }
}

/// Boundaries between black and white: those of the border, or all.
fn boundaries(cells: &Cells, all: bool) -> impl Iterator<Item = Boundary> + '_ {
    let side = SIDE as isize;
    let of_line = move |before: isize| all || before < 0 || before + 1 == side;
    let both = [true, false].into_iter().flat_map(move |upright| {
        let lines = (-1..side).filter(move |&before| of_line(before));
        lines.flat_map(move |before| (0..side).map(move |lane| Boundary { upright, before, lane }))
    });
    both.filter(|b| b.white(cells, 0, 0) != b.white(cells, 1, 0))
}

/// A marker placed: its square, its boundaries, and their scatter, px.
pub(super) struct Placed {
    pub(super) square: Square,
    pub(super) places: Vec<TagPlace>,
    pub(super) deviation_px: f64,
}

/// Places a marker that is thought to be at `square`, to a pixel or so.
pub(super) fn placed(plane: &Plane<u8>, tables: &Tables, cells: &Cells, square: &Square) -> Option<Placed> {
    let corners = square.corners()?;
    let Closeness { smoothings, reach_px } = Closeness::of(&corners);
    let part = Part::about(plane, tables, &corners, smoothings);
    let mut view = View { part, tables, cells, square: *square, blur_px: FIRST_BLUR_PX, reach_px };
    for _ in 0..2 {
        let found = view.look(false)?;
        let wider = found.iter().map(|f| f.wider_px).sum::<f64>() / found.len() as f64;
        let near = (0.5 * view.blur_px, 2.0 * view.blur_px);
        view.blur_px = (view.blur_px + wider).clamp(near.0, near.1).clamp(BLUR_PX.0, BLUR_PX.1);
        view.square = view.square.moved(&offs(&found))?;
    }
    let found = view.look(true)?;
    let square = view.square.moved(&offs(&found))?;
    let mut squares = 0.0;
    let mut places = Vec::with_capacity(found.len());
    for f in &found {
        let Found { cell, upright, black_behind, .. } = *f;
        let at = view.square.at(cell.x, cell.y)? + f.normal * f.off_px;
        squares += powi((at - square.at(cell.x, cell.y)?).dot(f.normal), 2);
        places.push(TagPlace { cell, upright, black_behind, at });
    }
    // eight of them it takes to place the square
    let deviation_px = (squares / (found.len() - 8) as f64).sqrt();
    Some(Placed { square, places, deviation_px })
}

fn offs(found: &[Found]) -> Vec<Off> {
    found.iter().map(|f| (f.cell, f.off_px, f.normal)).collect()
}

/// What the light across a boundary says.
struct Found {
    cell: Point,
    upright: bool,
    black_behind: bool,
    off_px: f64,
    normal: Vec2,
    /// How much wider the blur is than thought, px.
    wider_px: f64,
}

/// A marker in an image, where it is thought to be.
struct View<'a> {
    part: Part,
    tables: &'a Tables,
    cells: &'a Cells,
    square: Square,
    blur_px: f64,
    /// Furthest sample across a boundary.
    reach_px: f64,
}

impl View<'_> {
    /// Looks across the boundaries of the border, or all.
    fn look(&self, all: bool) -> Option<Vec<Found>> {
        let mut profiles: [Option<Profile>; 2 * (SIDE + 1)] = [None; 2 * (SIDE + 1)];
        let mut found = Vec::with_capacity(96);
        for boundary in boundaries(self.cells, all) {
            let number = usize::from(boundary.upright) * (SIDE + 1) + (boundary.before + 1) as usize;
            let profile = match &profiles[number] {
                Some(profile) => profile,
                None => profiles[number].insert(Profile::of(self, &boundary)?),
            };
            found.extend(profile.across(self, &boundary, all));
        }
        (found.len() >= FEWEST).then_some(found)
    }
}

/// Values at the samples; what is beyond them is nothing.
type Row = [f32; 12];

/// What a boundary's samples get from each transition near it: of a whole row or column of boundaries, which are much alike.
#[derive(Clone, Copy)]
struct Profile {
    /// From a sample to the next, px.
    step_px: f64,
    /// Share of light from behind each transition.
    behind: [Row; TRANSITIONS],
    /// How that of the boundary itself falls if it moves, 1/px, and if the blur widens.
    moved: Row,
    widened: Row,
    /// Share of the samples' light that comes from the lane itself; half of what is left from either side.
    own: f32,
}

impl Profile {
    fn of(view: &View, boundary: &Boundary) -> Option<Self> {
        // in the middle lane
        let middle = Boundary { lane: SIDE as isize / 2, ..*boundary }.middle();
        let (_, across, down) = view.square.with_slopes(middle.x, middle.y)?;
        let (along, lane) = if boundary.upright { (across, down) } else { (down, across) };
        let lane_px = lane.hypot();
        let cell_px = along.cross(lane).abs() / lane_px;
        if !(cell_px > 0.5 && lane_px > 0.5) {
            return None;
        }
        let step_px = view.reach_px.min(REACH_CELLS * cell_px) / (SAMPLES / 2) as f64;
        let mut profile = Self {
            step_px,
            behind: [[0.0; 12]; TRANSITIONS],
            moved: [0.0; 12],
            widened: [0.0; 12],
            own: 2.0 * view.tables.normal((0.5 * lane_px / view.blur_px) as f32) - 1.0,
        };
        for j in 0..SAMPLES {
            let place = (j as f64 - (SAMPLES / 2) as f64) * step_px;
            for k in 0..TRANSITIONS {
                let far = ((place - (k as f64 - NEAR as f64) * cell_px) / view.blur_px) as f32;
                profile.behind[k][j] = view.tables.normal(far);
                if k == NEAR as usize {
                    profile.moved[j] = -view.tables.density(far) / view.blur_px as f32;
                    profile.widened[j] = profile.moved[j] * far;
                }
            }
        }
        Some(profile)
    }

    /// Looks across one of its boundaries, and how wide the blur is, unless that is known; `None` where nothing is seen.
    fn across(&self, view: &View, boundary: &Boundary, blur_known: bool) -> Option<Found> {
        let cell = boundary.middle();
        let (at, across, down) = view.square.with_slopes(cell.x, cell.y)?;
        let (along, lane) = if boundary.upright { (across, down) } else { (down, across) };
        let normal = Vec2::new(-lane.y, lane.x) / lane.hypot2().sqrt();
        let normal = if normal.dot(along) < 0.0 { -normal } else { normal };
        let mut light: Row = [0.0; 12];
        let reach = self.step_px * (SAMPLES / 2) as f64;
        view.part.along(at - normal * reach, normal * self.step_px, &mut light[..SAMPLES])?;
        let (model, own) = self.model(view.cells, boundary);
        let [moved, widened] = [self.moved, self.widened].map(|row| row.map(|v| own * v));
        let (contrast, off, wider) = if blur_known {
            let [model, moved] = shares(&light, [&model, &moved])?;
            (model, moved, 0.0)
        } else {
            shares(&light, [&model, &moved, &widened])?.into()
        };
        let off_px = off / contrast;
        (contrast > LEAST_CONTRAST && off_px.abs() < FURTHEST_PX).then(|| Found {
            cell,
            upright: boundary.upright,
            black_behind: boundary.white(view.cells, 1, 0) == 0.0,
            off_px,
            normal,
            wider_px: (wider / contrast).clamp(-1.0, 1.0),
        })
    }

    /// The light at the samples if black is 0 and white 1, and how much of it the boundary itself makes.
    fn model(&self, cells: &Cells, boundary: &Boundary) -> (Row, f32) {
        let aside = 0.5 * (1.0 - self.own);
        let white = |k: isize| {
            self.own * boundary.white(cells, k, 0)
                + aside * (boundary.white(cells, k, -1) + boundary.white(cells, k, 1))
        };
        let mut model = ONES.map(|one| one * white(-NEAR));
        let mut own = 0.0;
        for (k, behind) in (-NEAR..=NEAR).zip(&self.behind) {
            let step = white(k + 1) - white(k);
            model.iter_mut().zip(behind).for_each(|(v, b)| *v += step * b);
            own = if k == 0 { step } else { own };
        }
        (model, own)
    }
}

/// One at every sample.
const ONES: Row = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0];

/// Light as a brightness and shares of rows, by least squares: the shares. `None` where the rows look alike.
fn shares<const N: usize>(light: &Row, rows: [&Row; N]) -> Option<[f64; N]> {
    let sums = rows.map(|row| dot(&ONES, row));
    let sum = dot(&ONES, light);
    // what is left of the products without the means
    let left =
        |a: &Row, b: &Row, sum_a: f32, sum_b: f32| f64::from(dot(a, b) - sum_a * sum_b / SAMPLES as f32);
    let mut products = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            products[i][j] = left(rows[i], rows[j], sums[i], sums[j]);
            products[j][i] = products[i][j];
        }
    }
    symmetric(products, std::array::from_fn(|i| left(rows[i], light, sums[i], sum)))
}

/// Sum of the products, four lanes at a time.
#[inline]
fn dot(a: &Row, b: &Row) -> f32 {
    let mut sums = [0f32; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}
