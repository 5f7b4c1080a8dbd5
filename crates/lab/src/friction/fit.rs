use nalgebra::{DMatrix, DVector};

use super::Believed;
use super::pieces::{COULOMB, GRAVITY, INERTIA, Piece, Row, UNKNOWNS, VISCOUS, trials_of};
use crate::regression::{Uncertain, student};

/// Deviation of what is believed of friction and weight, in torques of a volt: wide enough to matter only for what motion does not
/// tell.
const TORQUE_SHARE: f64 = 10.0;
/// Inertia is told by motion that has so many times the variance of what counting adds to it.
const TOLD: f64 = 10.0;

/// The solved least squares.
pub(super) struct Fit {
    unknowns: Vec<usize>,
    values: DVector<f64>,
    within: DVector<f64>,
    /// Share of the motor's second integrals that is explained.
    pub(super) r2: f64,
}

impl Fit {
    /// Of an unknown, if it was asked.
    pub(super) fn value(&self, unknown: usize) -> Option<Uncertain> {
        let at = self.unknowns.iter().position(|&k| k == unknown)?;
        Some(Uncertain { value: self.values[at], within: self.within[at] })
    }
}

/// Fits the unknowns to pieces of motion, and leaves the inertia at what is believed where they do not tell it; `None` if they do not
/// tell the rest apart.
pub(super) fn fit(pieces: &[&Piece], unknowns: Vec<usize>, believed: &Believed) -> Option<Fit> {
    let all = Equations::new(pieces, unknowns, believed);
    let (each, sum) = all.normal();
    let counting = TOLD * all.counting(pieces);
    let rest = all.unknowns.iter().copied().filter(|&k| k != INERTIA).collect();
    // an inertia that comes out below nothing, and may as well be above, is not told
    if inverse(&sum.matrix).is_some_and(|inverse| 1.0 > counting * inverse[(0, 0)])
        && let Some(found) = all.solve(each, sum)
        && found
            .value(INERTIA)
            .is_none_or(|inertia| inertia.value > 0.0 || inertia.value + inertia.within < 0.0)
    {
        return Some(found);
    }
    let rest = Equations::new(pieces, rest, believed);
    let (each, sum) = rest.normal();
    rest.solve(each, sum)
}

/// A row a sample: what is asked, and what is taken as known.
struct Equations<'a> {
    pieces: &'a [&'a Piece],
    /// Numbers of what is asked, in order.
    unknowns: Vec<usize>,
    known: [f64; UNKNOWNS],
    believed: &'a Believed,
}

impl<'a> Equations<'a> {
    fn new(pieces: &'a [&'a Piece], unknowns: Vec<usize>, believed: &'a Believed) -> Self {
        let mut known = [0.0; UNKNOWNS];
        if !unknowns.contains(&INERTIA) && !believed.another {
            known[INERTIA] = believed.inertia_kg_m2;
        }
        Self { pieces, unknowns, known, believed }
    }

    fn terms(&self, row: &Row) -> DVector<f64> {
        DVector::from_iterator(self.unknowns.len(), self.unknowns.iter().map(|&k| row.terms[k]))
    }

    /// Variance of a count's place, rad².
    fn count_variance(&self) -> f64 {
        self.believed.step_rad * self.believed.step_rad / 12.0
    }

    /// What counting adds to the square of the inertia's column, rad²: place and speed at the start are free.
    fn counting(&self, pieces: &[&Piece]) -> f64 {
        let free = |piece: &&Piece| piece.rows.len().saturating_sub(2) as f64;
        self.count_variance() * pieces.iter().map(free).sum::<f64>()
    }

    /// Normal equations of each trial, and of all with what is believed.
    fn normal(&self) -> (Vec<Normal>, Normal) {
        let asked = self.unknowns.len();
        let trials = self.pieces.iter().map(|piece| piece.trial + 1).max().unwrap_or(0);
        let mut each = vec![Normal::zeros(asked); trials];
        for piece in self.pieces {
            let normal = &mut each[piece.trial];
            for row in &piece.rows {
                let terms = self.terms(row);
                normal.matrix.ger(1.0, &terms, &terms, 1.0);
                normal.right.axpy(row.less(&self.known), &terms, 1.0);
            }
        }
        let mut all = Normal::zeros(asked);
        for (place, &unknown) in self.unknowns.iter().enumerate().filter(|(_, k)| **k != INERTIA) {
            let deviation = TORQUE_SHARE * self.believed.torque_nm_per_v;
            let weight = self.noise() / (deviation * deviation);
            all.matrix[(place, place)] += weight;
            all.right[place] += weight * self.prior(unknown);
        }
        each.iter().for_each(|one| all.add(one, 1.0));
        (each, all)
    }

    /// Variance that counting leaves in a row, (N m s²)².
    fn noise(&self) -> f64 {
        self.believed.inertia_kg_m2 * self.believed.inertia_kg_m2 * self.count_variance()
    }

    /// What is believed of friction and weight before anything was seen.
    fn prior(&self, unknown: usize) -> f64 {
        let place = GRAVITY.iter().position(|&k| k == unknown);
        place.zip(self.believed.gravity_nm).map_or(0.0, |(place, gravity)| gravity[place])
    }

    /// Intervals from how much the answer changes without each trial (the jackknife over clusters: MacKinnon, Nielsen & Webb, *J. Appl.
    /// Econometrics* 38, 2023, eq. 13): what is left within a trial is alike. Less than what counting leaves they are not. A direction's
    /// friction is told by the trials that turned that way alone.
    ///
    /// The column of the inertia is counted, and counting makes it larger than it is: that is taken out again (Fuller, *Measurement Error
    /// Models*, 1987, eq. 2.2.10).
    fn solve(self, mut each: Vec<Normal>, mut all: Normal) -> Option<Fit> {
        if self.unknowns.first() == Some(&INERTIA) {
            for piece in self.pieces {
                let counted = self.counting(&[*piece]);
                each[piece.trial].matrix[(0, 0)] -= counted;
                all.matrix[(0, 0)] -= counted;
            }
        }
        let inverse = inverse(&all.matrix)?;
        let values = &inverse * &all.right;
        let turned: Vec<&Normal> = each.iter().filter(|one| one.matrix.norm() > 0.0).collect();
        let count = turned.len() as f64;
        let mut variance = inverse.diagonal() * self.noise();
        for one in &turned {
            let mut rest = all.clone();
            rest.add(one, -1.0);
            let moved = rest.solved().map(|without| without - &values);
            for place in 0..values.len() {
                let by = moved.as_ref().map_or(f64::INFINITY, |moved| moved[place]);
                variance[place] += (count - 1.0) / count * by * by;
            }
        }
        let within = DVector::from_fn(values.len(), |place, _| {
            let t = student(self.told_by(self.unknowns[place]) as f64 - 1.0);
            t * variance[place].max(0.0).sqrt()
        });
        let rows = self.pieces.iter().flat_map(|piece| &piece.rows);
        let (left, total) = rows.fold((0.0, 0.0), |(left, total), row| {
            let motor = row.less(&self.known);
            let off = motor - self.terms(row).dot(&values);
            (left + off * off, total + motor * motor)
        });
        let r2 = if total > 0.0 { 1.0 - left / total } else { 1.0 };
        Some(Fit { unknowns: self.unknowns, values, within, r2 })
    }

    /// How many trials tell an unknown.
    fn told_by(&self, unknown: usize) -> usize {
        let side = VISCOUS.iter().chain(&COULOMB).position(|&k| k == unknown).map(|place| place % 2);
        trials_of(self.pieces.iter().copied().filter(|piece| side.is_none_or(|side| piece.side == side)))
    }
}

/// Normal equations.
#[derive(Clone)]
struct Normal {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
}

impl Normal {
    fn zeros(asked: usize) -> Self {
        Self { matrix: DMatrix::zeros(asked, asked), right: DVector::zeros(asked) }
    }

    fn add(&mut self, other: &Self, times: f64) {
        self.matrix += &other.matrix * times;
        self.right.axpy(times, &other.right, 1.0);
    }

    fn solved(&self) -> Option<DVector<f64>> {
        Some(inverse(&self.matrix)? * &self.right)
    }
}

/// Of a symmetric positive matrix, balanced first; `None` if it is singular to working digits.
fn inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = matrix.diagonal().map(|d| 1.0 / d.sqrt());
    if scale.iter().any(|s| !s.is_finite()) {
        return None;
    }
    let balanced =
        |m: &DMatrix<f64>| DMatrix::from_fn(m.nrows(), m.ncols(), |i, j| m[(i, j)] * scale[i] * scale[j]);
    Some(balanced(&balanced(matrix).cholesky()?.inverse()))
}
