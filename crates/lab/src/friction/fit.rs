use nalgebra::{DMatrix, DVector};

use super::line::student;
use super::pieces::{GRAVITY, INERTIA, Piece, Row, UNKNOWNS, trials_of};
use super::{Believed, Uncertain};

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
    let (matrix, right) = all.normal();
    let told = inverse(&matrix).is_some_and(|inverse| 1.0 > TOLD * all.counting(pieces) * inverse[(0, 0)]);
    if told {
        return all.solve(matrix, right);
    }
    let rest = all.unknowns.into_iter().filter(|&k| k != INERTIA).collect();
    let rest = Equations::new(pieces, rest, believed);
    let (matrix, right) = rest.normal();
    rest.solve(matrix, right)
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
        if !unknowns.contains(&INERTIA) {
            known[INERTIA] = believed.inertia_kg_m2;
        }
        Self { pieces, unknowns, known, believed }
    }

    fn terms(&self, row: &Row) -> DVector<f64> {
        DVector::from_iterator(self.unknowns.len(), self.unknowns.iter().map(|&k| row.terms[k]))
    }

    /// Variance of a count's place, rad².
    fn count_variance(&self) -> f64 {
        self.believed.count_rad * self.believed.count_rad / 12.0
    }

    /// What counting adds to the square of the inertia's column, rad²: place and speed at the start are free.
    fn counting(&self, pieces: &[&Piece]) -> f64 {
        let free = |piece: &&Piece| piece.rows.len().saturating_sub(2) as f64;
        self.count_variance() * pieces.iter().map(free).sum::<f64>()
    }

    /// Normal equations, with what is believed.
    fn normal(&self) -> (DMatrix<f64>, DVector<f64>) {
        let asked = self.unknowns.len();
        let (mut matrix, mut right) = (DMatrix::zeros(asked, asked), DVector::zeros(asked));
        for row in self.pieces.iter().flat_map(|piece| &piece.rows) {
            let terms = self.terms(row);
            matrix.ger(1.0, &terms, &terms, 1.0);
            right.axpy(row.less(&self.known), &terms, 1.0);
        }
        let noise = self.believed.inertia_kg_m2 * self.believed.inertia_kg_m2 * self.count_variance();
        for (place, &unknown) in self.unknowns.iter().enumerate().filter(|(_, k)| **k != INERTIA) {
            let deviation = TORQUE_SHARE * self.believed.torque_nm_per_v;
            let weight = noise / (deviation * deviation);
            matrix[(place, place)] += weight;
            right[place] += weight * self.prior(unknown);
        }
        (matrix, right)
    }

    /// What is believed of friction and weight before anything was seen.
    fn prior(&self, unknown: usize) -> f64 {
        let place = GRAVITY.iter().position(|&k| k == unknown);
        place.zip(self.believed.gravity_nm).map_or(0.0, |(place, gravity)| gravity[place])
    }

    /// The column of the inertia is counted, and counting makes it larger than it is: that is taken out again (Fuller, *Measurement Error
    /// Models*, 1987, eq. 2.2.10). Intervals from how trials differ (Liang & Zeger, *Biometrika* 73, 1986, eq. 2): what is left within one is
    /// alike.
    fn solve(self, mut matrix: DMatrix<f64>, right: DVector<f64>) -> Option<Fit> {
        let counted = self.unknowns.first() == Some(&INERTIA);
        if counted {
            matrix[(0, 0)] -= self.counting(self.pieces);
        }
        let inverse = inverse(&matrix)?;
        let values = &inverse * &right;
        let clusters = trials_of(self.pieces.iter().copied());
        let last = self.pieces.iter().map(|piece| piece.trial).max()?;
        let mut pulls: Vec<DVector<f64>> = vec![DVector::zeros(values.len()); last + 1];
        let (mut left, mut total) = (0.0, 0.0);
        for piece in self.pieces {
            for row in &piece.rows {
                let terms = self.terms(row);
                let motor = row.less(&self.known);
                let off = motor - terms.dot(&values);
                pulls[piece.trial].axpy(off, &terms, 1.0);
                left += off * off;
                total += motor * motor;
            }
            if counted {
                pulls[piece.trial][0] += self.counting(&[*piece]) * values[0];
            }
        }
        let degrees = clusters.saturating_sub(1).max(1) as f64;
        let mut between = DMatrix::zeros(values.len(), values.len());
        pulls.iter().for_each(|pull| between.ger(1.0, pull, pull, 1.0));
        let covariance = &inverse * between * &inverse * (clusters as f64 / degrees);
        let t = student(degrees);
        let within = covariance.diagonal().map(|variance| t * variance.max(0.0).sqrt());
        let r2 = if total > 0.0 { 1.0 - left / total } else { 1.0 };
        Some(Fit { unknowns: self.unknowns, values, within, r2 })
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
