use tracelight_maths::{cbrt, powf, powi};
use tracelight_rig::{Joint, PanTilt};

use super::band::Local;
use super::limits::JointLimits;
use crate::retime::along::{Along, hermite};
use crate::retime::law::GAUSS;
use crate::retime::limits::PathSample;

/// Coefficients of a cell's four numbers: x and its slope at the start, x and its slope at the end.
pub(super) type Row4 = [f64; 4];

/// Acceleration is bounded at five places of a cell, both joints, both ways; jerk at three; x itself at three.
pub(super) const ROWS: usize = 20 + 12 + 3;

const FIVE: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
const THREE: [f64; 3] = [0.0, 0.5, 1.0];

/// Gauss and Legendre's five places of a cell, and their weights.
const GAUSS_5: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

pub(super) fn dot(row: &Row4, cell: &[f64]) -> f64 {
    row[0] * cell[0] + row[1] * cell[1] + row[2] * cell[2] + row[3] * cell[3]
}

/// x, dx/dσ and d²x/dσ² at the share `u` of a cell of length `h`: Hermite's cubic.
pub(super) fn row(u: f64, h: f64) -> (Row4, Row4, Row4) {
    let value = [
        (2.0 * u - 3.0) * u * u + 1.0,
        h * ((u - 2.0) * u + 1.0) * u,
        (3.0 - 2.0 * u) * u * u,
        h * (u - 1.0) * u * u,
    ];
    let slope =
        [6.0 * (u - 1.0) * u / h, (3.0 * u - 4.0) * u + 1.0, 6.0 * (1.0 - u) * u / h, (3.0 * u - 2.0) * u];
    let bend =
        [(12.0 * u - 6.0) / (h * h), (6.0 * u - 4.0) / h, (6.0 - 12.0 * u) / (h * h), (6.0 * u - 2.0) / h];
    (value, slope, bend)
}

/// How long a cell takes up to the share `until`, s: ∫ dσ/√x.
pub(super) fn crossing_s(cell: &[f64], h: f64, until: f64) -> f64 {
    let at =
        |&(u, weight): &(f64, f64)| weight / dot(&row(u * until, h).0, cell).max(f64::MIN_POSITIVE).sqrt();
    h * until * GAUSS_5.iter().map(at).sum::<f64>()
}

/// A path as quintics between samples, with a smooth step of arc length.
#[derive(Clone, Debug)]
pub(super) struct Path {
    /// Start of each piece, its length, both joints' quintics, and the cap along it.
    pieces: Vec<(f64, f64, PanTilt<[f64; 6]>, f64)>,
    end: f64,
}

/// Both joints' derivatives by σ, first to third, and the bound on x from the cap.
pub(super) struct Place {
    joints: PanTilt<[f64; 3]>,
    cap: f64,
}

impl Path {
    pub(super) fn new(samples: &[PathSample]) -> Self {
        let pieces = samples.windows(2).map(|pair| {
            let h = pair[1].s - pair[0].s;
            let end = |sample: &PathSample, j: Joint| Along {
                s: sample.joints.angle_rad[j],
                v: sample.joints.first[j],
                a: sample.joints.second[j],
            };
            let quintics = PanTilt::from_fn(|j| hermite(end(&pair[0], j), end(&pair[1], j), h));
            (pair[0].s, h, quintics, pair[0].cap.min(pair[1].cap))
        });
        Self { pieces: pieces.collect(), end: samples.last().map_or(0.0, |sample| sample.s) }
    }

    pub(super) fn start(&self) -> f64 {
        self.pieces.first().map_or(0.0, |piece| piece.0)
    }

    pub(super) const fn end(&self) -> f64 {
        self.end
    }

    /// Arc length and its first three derivatives by σ.
    pub(super) fn step(&self, sigma: f64) -> [f64; 4] {
        let length = self.end() - self.start();
        let (a, b) = (sigma, 1.0 - sigma);
        [
            self.start() + length * a * a * a * (10.0 - 15.0 * a + 6.0 * a * a),
            length * 30.0 * a * a * b * b,
            length * 60.0 * a * b * (1.0 - 2.0 * a),
            length * 60.0 * (1.0 - 6.0 * a + 6.0 * a * a),
        ]
    }

    pub(super) fn place(&self, sigma: f64) -> Place {
        let [s, s1, s2, s3] = self.step(sigma);
        let index = self.pieces.partition_point(|piece| piece.0 <= s).max(1) - 1;
        let (start, _, quintics, cap) = &self.pieces[index];
        let t = s - start;
        let joints = quintics.map(|k| {
            let first = (((5.0 * k[5] * t + 4.0 * k[4]) * t + 3.0 * k[3]) * t + 2.0 * k[2]) * t + k[1];
            let second = ((20.0 * k[5] * t + 12.0 * k[4]) * t + 6.0 * k[3]) * t + 2.0 * k[2];
            let third = (60.0 * k[5] * t + 24.0 * k[4]) * t + 6.0 * k[3];
            [
                first * s1,
                second * s1 * s1 + first * s2,
                third * s1 * s1 * s1 + 3.0 * second * s1 * s2 + first * s3,
            ]
        });
        Place { joints, cap: powi(cap / s1, 2) }
    }
}

/// What bounds a cell, each row as a share of its limit.
struct Rows {
    acceleration: [Row4; 10],
    jerk: [Row4; 6],
    /// 1 over the highest x.
    inverse_most: [f64; 3],
}

/// A path in cells of σ.
pub(super) struct Cells {
    pub(super) h: f64,
    rows: Vec<Rows>,
    values: [Row4; 3],
    gauss: [(Row4, f64); 3],
}

impl Cells {
    pub(super) fn new(path: &Path, count: usize, limits: &PanTilt<JointLimits>) -> Self {
        let h = 1.0 / count as f64;
        let of_cell = |i: usize| {
            let places = FIVE.map(|u| path.place((i as f64 + u) * h));
            Rows {
                acceleration: core::array::from_fn(|k| {
                    let (u, j) = (FIVE[k / 2], Joint::BOTH[k % 2]);
                    let [first, second, _] = places[k / 2].joints[j];
                    let (value, slope, _) = row(u, h);
                    let most = limits[j].acceleration_rad_s2;
                    core::array::from_fn(|n| (second * value[n] + 0.5 * first * slope[n]) / most)
                }),
                jerk: core::array::from_fn(|k| {
                    let (u, j) = (THREE[k / 2], Joint::BOTH[k % 2]);
                    let [first, second, third] = places[2 * (k / 2)].joints[j];
                    let (value, slope, bend) = row(u, h);
                    let most = limits[j].jerk_rad_s3;
                    core::array::from_fn(|n| {
                        (third * value[n] + 1.5 * second * slope[n] + 0.5 * first * bend[n]) / most
                    })
                }),
                inverse_most: core::array::from_fn(|p| {
                    let place = &places[2 * p];
                    let by_joint = |j: Joint| powi(place.joints[j][0] / limits[j].speed_rad_s, 2);
                    by_joint(Joint::Pan).max(by_joint(Joint::Tilt)).max(1.0 / place.cap)
                }),
            }
        };
        Self {
            h,
            rows: (0..count).map(of_cell).collect(),
            values: THREE.map(|u| row(u, h).0),
            gauss: GAUSS.map(|(u, weight)| (row(u, h).0, weight * h)),
        }
    }

    /// An x, everywhere the same, well within all limits.
    pub(super) fn interior(&self) -> Vec<f64> {
        const SAME: Row4 = [1.0, 0.0, 1.0, 0.0];
        let mut inverse = f64::MIN_POSITIVE;
        for rows in &self.rows {
            let steady = rows.acceleration.iter().map(|row| dot(row, &SAME).abs());
            // √x · |row| x ≤ 1
            let jerk = rows.jerk.iter().map(|row| powf(dot(row, &SAME).abs(), 2.0 / 3.0));
            inverse = steady.chain(jerk).chain(rows.inverse_most).fold(inverse, f64::max);
        }
        let nodes = self.rows.len() + 1;
        (0..2 * nodes).map(|n| if n % 2 == 0 { 0.3 / inverse } else { 0.0 }).collect()
    }

    pub(super) fn is_positive(&self, z: &[f64]) -> bool {
        z.windows(4).step_by(2).all(|cell| {
            self.values.iter().chain(self.gauss.iter().map(|(row, _)| row)).all(|row| dot(row, cell) > 0.0)
        })
    }

    pub(super) fn duration_s(&self, z: &[f64]) -> f64 {
        let cell =
            |cell: &[f64]| self.gauss.iter().map(|(row, weight)| weight / dot(row, cell).sqrt()).sum::<f64>();
        z.windows(4).step_by(2).map(cell).sum()
    }

    /// What is left to every limit, cell by cell.
    pub(super) fn slacks(&self, z: &[f64]) -> Vec<[f64; ROWS]> {
        let of_cell = |(rows, cell): (&Rows, &[f64])| {
            let mut left = [0.0; ROWS];
            for (k, row) in rows.acceleration.iter().enumerate() {
                let used = dot(row, cell);
                (left[2 * k], left[2 * k + 1]) = (1.0 - used, 1.0 + used);
            }
            for (k, row) in rows.jerk.iter().enumerate() {
                let (used, most) = (dot(row, cell), 1.0 / dot(&self.values[k / 2], cell).sqrt());
                (left[20 + 2 * k], left[21 + 2 * k]) = (most - used, most + used);
            }
            for (p, inverse) in rows.inverse_most.iter().enumerate() {
                left[32 + p] = 1.0 - inverse * dot(&self.values[p], cell);
            }
            left
        };
        self.rows.iter().zip(z.windows(4).step_by(2)).map(of_cell).collect()
    }

    /// d(1/√x)/dx at the three places of a cell.
    fn tangents(&self, cell: &[f64]) -> [f64; 3] {
        self.values.map(|value| {
            let x = dot(&value, cell);
            -0.5 / (x * x.sqrt())
        })
    }

    /// How the slacks of cell `i` change along a step.
    pub(super) fn slopes(&self, i: usize, cell: &[f64], step: &[f64]) -> [f64; ROWS] {
        let rows = &self.rows[i];
        let (tangents, raised) = (self.tangents(cell), self.values.map(|value| dot(&value, step)));
        let mut slopes = [0.0; ROWS];
        for (k, row) in rows.acceleration.iter().enumerate() {
            let change = dot(row, step);
            (slopes[2 * k], slopes[2 * k + 1]) = (-change, change);
        }
        for (k, row) in rows.jerk.iter().enumerate() {
            let (change, most) = (dot(row, step), tangents[k / 2] * raised[k / 2]);
            (slopes[20 + 2 * k], slopes[21 + 2 * k]) = (most - change, most + change);
        }
        for (p, inverse) in rows.inverse_most.iter().enumerate() {
            slopes[32 + p] = -inverse * raised[p];
        }
        slopes
    }

    /// What cell `i` adds to Newton's equations.
    pub(super) fn newton(
        &self,
        i: usize,
        cell: &[f64],
        slack: &[f64; ROWS],
        duals: &[f64; ROWS],
        barrier: f64,
    ) -> Local {
        let rows = &self.rows[i];
        let mut local = ([[0.0; 4]; 4], [0.0; 4]);
        for (row, weight) in &self.gauss {
            let x = dot(row, cell);
            let inverse = weight / (x * x.sqrt());
            add(&mut local, row, 0.75 * inverse / x, 0.5 * inverse);
        }
        let weight = |k: usize| duals[k] / slack[k];
        let push = |k: usize| barrier / slack[k];
        for (k, row) in rows.acceleration.iter().enumerate() {
            let (up, down) = (2 * k, 2 * k + 1);
            add(&mut local, row, weight(up) + weight(down), push(down) - push(up));
        }
        let tangents = self.tangents(cell);
        for (k, row) in rows.jerk.iter().enumerate() {
            let (value, tangent) = (&self.values[k / 2], tangents[k / 2]);
            for (n, sign) in [(20 + 2 * k, -1.0), (21 + 2 * k, 1.0)] {
                let gradient = core::array::from_fn(|n| tangent * value[n] + sign * row[n]);
                add(&mut local, &gradient, weight(n), push(n));
            }
        }
        for (p, &inverse) in rows.inverse_most.iter().enumerate() {
            let n = 32 + p;
            add(&mut local, &self.values[p], weight(n) * inverse * inverse, -push(n) * inverse);
        }
        local
    }
}

/// Adds `weight` times a row's square, and `push` times the row.
fn add((matrix, right): &mut Local, row: &Row4, weight: f64, push: f64) {
    for (a, (line, right)) in matrix.iter_mut().zip(right).enumerate() {
        for (entry, value) in line.iter_mut().zip(row).skip(a) {
            *entry += weight * row[a] * value;
        }
        *right += push * row[a];
    }
}

/// By how much time has to be stretched for all limits to hold at seventeen places of every cell.
pub(super) fn excess(path: &Path, z: &[f64], h: f64, limits: &PanTilt<JointLimits>) -> f64 {
    const PLACES: usize = 16;
    let mut stretch = 1.0f64;
    for (i, cell) in z.windows(4).step_by(2).enumerate() {
        for n in 0..=PLACES {
            let u = n as f64 / PLACES as f64;
            let place = path.place((i as f64 + u) * h);
            let (value, slope, bend) = row(u, h);
            let [x, x1, x2] = [value, slope, bend].map(|row| dot(&row, cell));
            let rate = x.max(0.0).sqrt();
            for j in Joint::BOTH {
                let [first, second, third] = place.joints[j];
                let speed = (first * rate).abs() / limits[j].speed_rad_s;
                let acceleration = (second * x + 0.5 * first * x1).abs() / limits[j].acceleration_rad_s2;
                let jerk =
                    rate * (third * x + 1.5 * second * x1 + 0.5 * first * x2).abs() / limits[j].jerk_rad_s3;
                stretch = stretch.max(speed).max(acceleration.sqrt()).max(cbrt(jerk));
            }
            stretch = stretch.max((x / place.cap).sqrt());
        }
    }
    stretch
}
