//! Locates the black–white boundary of a marker with known cells on the grey levels.
//!
//! Across the middle of each boundary between a black cell and a white one the light is what the cells about it are, blurred; how far
//! the boundary is off from where it is thought to be is what fits the light there best, together with its brightness, its contrast
//! and, for all boundaries together, the blur. Nothing is lost where cells are hardly wider than the blur.

use std::sync::LazyLock;

use tracelight_image::Plane;
use tracelight_image::solve::symmetric;
use tracelight_maths::exp;
use tracelight_stroke::{Point, Vec2};

use super::part::{Closeness, FURTHEST_PX, Part};
use super::square::{SIDE, Square};

/// Samples across a boundary.
const SAMPLES: usize = 11;
/// Furthest of them, in cells.
const REACH_CELLS: f64 = 1.25;
/// Transitions between cells that reach into the samples, either way.
const NEAR: isize = 2;
const TRANSITIONS: usize = 2 * NEAR as usize + 1;
/// Smallest and largest blur that is estimated, px.
const BLUR_PX: (f64, f64) = (0.4, 4.0);
/// Least contrast of a boundary, as a share of the brightest there can be.
const LEAST_CONTRAST: f64 = 0.004;

/// What is looked up rather than worked out each time.
struct Tables {
    /// The normal distribution, in steps of 1/[`STEPS`] of a deviation from −[`TAILS`] on, and its density.
    below: [f32; 2 * TAILS * STEPS + 1],
    bell: [f32; 2 * TAILS * STEPS + 1],
}

const STEPS: usize = 64;
const TAILS: usize = 5;

impl Tables {
    fn get() -> &'static Self {
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
        Self { below, bell }
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

/// Boundaries between black and white.
fn boundaries(cells: &Cells, which: Which) -> impl Iterator<Item = Boundary> + '_ {
    let side = SIDE as isize;
    let of_line = move |before: isize| which == Which::All || before < 0 || before + 1 == side;
    let both = [true, false].into_iter().flat_map(move |upright| {
        let lines = (-1..side).filter(move |&before| of_line(before));
        lines.flat_map(move |before| {
            (0..side).step_by(if which == Which::Few { 2 } else { 1 }).map(move |lane| Boundary {
                upright,
                before,
                lane,
            })
        })
    });
    both.filter(|b| b.white(cells, 0, 0) != b.white(cells, 1, 0))
}

/// What the light across a boundary says.
pub(super) struct Found {
    pub(super) cell: Point,
    pub(super) upright: bool,
    pub(super) black_behind: bool,
    pub(super) off_px: f64,
    pub(super) normal: Vec2,
    /// How much wider the blur is than thought, px.
    pub(super) wider_px: f64,
}

/// Which boundaries are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Which {
    /// Every other one of the border.
    Few,
    /// Those of the border.
    Border,
    All,
}

/// A marker in an image, where it is thought to be.
pub(super) struct View<'a> {
    part: Part,
    tables: &'a Tables,
    cells: &'a Cells,
    pub(super) square: Square,
    /// Standard deviation of the blur, px.
    pub(super) blur_px: f64,
    /// Furthest sample across a boundary.
    reach_px: f64,
}

impl<'a> View<'a> {
    /// About these corners.
    pub(super) fn of(
        plane: &Plane<u8>,
        cells: &'a Cells,
        corners: &[Point; 4],
        blur_px: f64,
    ) -> Option<Self> {
        let closeness = Closeness::of(corners);
        Some(Self {
            part: Part::about(plane, corners, closeness),
            tables: Tables::get(),
            cells,
            square: Square::of(corners)?,
            blur_px,
            reach_px: closeness.reach_px,
        })
    }

    /// What is seen at boundaries, and how many of them were looked at; how wide the blur is as well, unless that is known.
    pub(super) fn look(&self, which: Which, blur_known: bool) -> (Vec<Found>, usize) {
        let mut profiles: [Option<Profile>; 2 * (SIDE + 1)] = [None; 2 * (SIDE + 1)];
        let mut found = Vec::with_capacity(96);
        let mut asked = 0;
        for boundary in boundaries(self.cells, which) {
            asked += 1;
            let number = usize::from(boundary.upright) * (SIDE + 1) + (boundary.before + 1) as usize;
            let profile = match &profiles[number] {
                Some(profile) => profile,
                None => match Profile::of(self, &boundary) {
                    Some(profile) => profiles[number].insert(profile),
                    None => continue,
                },
            };
            found.extend(profile.across(self, &boundary, blur_known));
        }
        (found, asked)
    }

    /// Takes the blur to be as wide as boundaries say, on the whole; no more than twice or half as wide as it was thought.
    pub(super) fn blur_by(&mut self, found: &[Found]) {
        let wider = found.iter().map(|f| f.wider_px).sum::<f64>() / found.len() as f64;
        let near = (0.5 * self.blur_px, 2.0 * self.blur_px);
        self.blur_px = (self.blur_px + wider).clamp(near.0, near.1).clamp(BLUR_PX.0, BLUR_PX.1);
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
    changes: Changes,
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
            changes: Changes::default(),
            own: 2.0 * view.tables.normal((0.5 * lane_px / view.blur_px) as f32) - 1.0,
        };
        let (mut moved, mut widened): (Row, Row) = ([0.0; 12], [0.0; 12]);
        for j in 0..SAMPLES {
            let place = (j as f64 - (SAMPLES / 2) as f64) * step_px;
            for k in 0..TRANSITIONS {
                let far = ((place - (k as f64 - NEAR as f64) * cell_px) / view.blur_px) as f32;
                profile.behind[k][j] = view.tables.normal(far);
                if k == NEAR as usize {
                    moved[j] = -view.tables.density(far) / view.blur_px as f32;
                    widened[j] = moved[j] * far;
                }
            }
        }
        profile.changes = Changes::of([moved, widened]);
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
        let (contrast, off, wider) = if blur_known {
            let [model, moved] = shares(&light, &model, &self.changes)?;
            (model, moved, 0.0)
        } else {
            shares::<3>(&light, &model, &self.changes)?.into()
        };
        // a step of one at the boundary would make a change of its own size; this one is as large as the model's, and up or down
        let step = contrast * f64::from(own);
        let off_px = off / step;
        (contrast > LEAST_CONTRAST && off_px.abs() < FURTHEST_PX).then(|| Found {
            cell,
            upright: boundary.upright,
            black_behind: boundary.white(view.cells, 1, 0) == 0.0,
            off_px,
            normal,
            wider_px: (wider / step).clamp(-1.0, 1.0),
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

/// Rows that are the same for all boundaries of a line, with what least squares need of them.
#[derive(Clone, Copy, Default)]
struct Changes {
    rows: [Row; 2],
    sums: [f32; 2],
    products: [[f64; 2]; 2],
}

impl Changes {
    fn of(rows: [Row; 2]) -> Self {
        let sums = rows.map(|row| dot(&ONES, &row));
        let product = |i: usize, j: usize| left(&rows[i], &rows[j], sums[i], sums[j]);
        let both = product(0, 1);
        Self { rows, sums, products: [[product(0, 0), both], [both, product(1, 1)]] }
    }
}

/// Light as a brightness and shares of a model and of the first of the changes, by least squares: the shares. `None` where these look alike.
fn shares<const N: usize>(light: &Row, model: &Row, changes: &Changes) -> Option<[f64; N]> {
    let (sum, own) = (dot(&ONES, light), dot(&ONES, model));
    let (mut products, mut right) = ([[0.0; N]; N], [0.0; N]);
    (products[0][0], right[0]) = (left(model, model, own, own), left(model, light, own, sum));
    for i in 1..N {
        let (row, its) = (&changes.rows[i - 1], changes.sums[i - 1]);
        right[i] = left(row, light, its, sum);
        products[i][0] = left(row, model, its, own);
        products[0][i] = products[i][0];
        products[i][1..].copy_from_slice(&changes.products[i - 1][..N - 1]);
    }
    symmetric(products, right)
}

/// What is left of the product of two rows without their means, by their sums.
#[inline]
fn left(a: &Row, b: &Row, sum_a: f32, sum_b: f32) -> f64 {
    f64::from(dot(a, b) - sum_a * sum_b / SAMPLES as f32)
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
