//! Linear least squares over stretches of motion.

use nalgebra::{SMatrix, SVector};
use tracelight_maths::{hypot, powi};

use super::edge::PHASES;
use super::equations::{Equations, MECHANICS, RIPPLE_COS, RIPPLE_SIN};
use super::stretch::{Row, Stretch};

/// All unknowns: the mechanical ones and where the edges lie.
const UNKNOWNS: usize = MECHANICS + PHASES;

type Line = SVector<f64, UNKNOWNS>;

/// Deviation of an edge's place before anything was seen, counts.
const EDGE_DEVIATION_COUNTS: f64 = 0.1;
/// Deviation of what is left of an edge, counts.
const NOISE_COUNTS: f64 = 0.05;
/// What is left of neighbouring edges is alike where friction changes along the way: a stretch is worth so many at most.
const WORTH_EDGES: f64 = 8.0;
/// Stretches that are worse than so many times the middle one are none of this equation's: the joint stuck, somebody pushed.
const OUTLIER: f64 = 4.0;

/// The most likely equations after what is believed and what was seen (Gaussian prior and noise), found twice: stretches
/// that do not fit the first are left out of the second.
pub(super) fn fit(believed: &Equations, stretches: &[&Stretch]) -> Equations {
    let first = Normal::of(&weighed(believed, stretches)).with_prior(believed).equations(believed);
    let left: Vec<f64> = stretches.iter().map(|s| stretch_counts(&first, s)).collect();
    let bound = OUTLIER * median(&left);
    let kept: Vec<&Stretch> =
        stretches.iter().zip(&left).filter(|(_, left)| **left <= bound).map(|(s, _)| *s).collect();
    Normal::of(&weighed(believed, &kept)).with_prior(believed).equations(believed)
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// How well each of some ripples explains what the rest leaves: by how much less the sum of squares is with it, for every number
/// of periods.
pub(super) fn ripple_gains(believed: &Equations, stretches: &[&Stretch], periods: &[f64]) -> Vec<f64> {
    let lines = weighed(&believed.rippling(0.0), stretches);
    let plain = Normal::of(&lines);
    let gain = |&n: &f64| {
        let mut normal = plain;
        let columns = stretches.iter().flat_map(|stretch| {
            let free = Free::of(stretch);
            let [sines, cosines] = stretch.ripple(n).map(|column| free.leave_of(&stretch.rows, &column));
            sines.into_iter().zip(cosines)
        });
        lines.iter().zip(columns).for_each(|(line, ripple)| normal.put_ripple(line, ripple));
        normal.with_prior(&believed.rippling(n)).gain()
    };
    periods.iter().map(gain).collect()
}

/// A line of the least squares.
struct Weighed {
    /// Coefficients of the unknowns.
    line: Line,
    /// What is to be explained, rad.
    value: f64,
    /// One over its variance, rad⁻².
    weight: f64,
}

/// All lines of some stretches for the change of what is believed.
fn weighed(believed: &Equations, stretches: &[&Stretch]) -> Vec<Weighed> {
    let of_one = |stretch: &&Stretch| {
        let worth = (WORTH_EDGES / stretch.rows.len() as f64).min(1.0);
        let lines = Free::of(stretch).lines(stretch, believed);
        let weigh = |(row, (line, value)): (&Row, (Line, f64))| {
            let noise = hypot(NOISE_COUNTS * stretch.count_rad, row.blur_rad);
            Weighed { line, value, weight: worth / (noise * noise) }
        };
        stretch.rows.iter().zip(lines).map(weigh).collect::<Vec<_>>()
    };
    stretches.iter().flat_map(of_one).collect()
}

/// Normal equations of the change of what is believed.
#[derive(Clone, Copy)]
struct Normal {
    matrix: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    right: Line,
}

impl Normal {
    fn of(lines: &[Weighed]) -> Self {
        let mut normal = Self { matrix: SMatrix::zeros(), right: Line::zeros() };
        for Weighed { line, value, weight } in lines {
            normal.matrix.ger(*weight, line, line, 1.0);
            normal.right.axpy(weight * value, line, 1.0);
        }
        normal
    }

    /// Adds what a ripple's sine and cosine do on a line that has none.
    fn put_ripple(&mut self, on: &Weighed, (sin, cos): (f64, f64)) {
        let mut line = on.line;
        (line[RIPPLE_SIN], line[RIPPLE_COS]) = (sin, cos);
        for (place, entry) in [(RIPPLE_SIN, sin), (RIPPLE_COS, cos)] {
            self.right[place] += on.weight * on.value * entry;
            for k in 0..UNKNOWNS {
                let product = on.weight * entry * line[k];
                self.matrix[(place, k)] += product;
                if k != RIPPLE_SIN && k != RIPPLE_COS {
                    self.matrix[(k, place)] += product;
                }
            }
        }
    }

    /// Takes the unknowns for as uncertain as they are believed to be.
    fn with_prior(mut self, believed: &Equations) -> Self {
        // what a joint has none of stays so
        const NONE: f64 = 1e-9;
        for k in 0..UNKNOWNS {
            let deviation = believed.deviations.get(k).map_or(EDGE_DEVIATION_COUNTS, |d| d.max(NONE));
            self.matrix[(k, k)] += 1.0 / (deviation * deviation);
        }
        self
    }

    /// The most likely change. The diagonal spans many orders of magnitude and is balanced first.
    fn change(&self) -> Line {
        let scale = self.matrix.diagonal().map(|d| 1.0 / d.sqrt());
        let scaled: SMatrix<f64, UNKNOWNS, UNKNOWNS> =
            SMatrix::from_fn(|i, j| self.matrix[(i, j)] * scale[i] * scale[j]);
        let solution = scaled.cholesky().map(|c| c.solve(&self.right.component_mul(&scale)));
        solution.map_or_else(Line::zeros, |s| s.component_mul(&scale))
    }

    /// By how much the weighted sum of squares falls.
    fn gain(&self) -> f64 {
        self.right.dot(&self.change())
    }

    fn equations(&self, believed: &Equations) -> Equations {
        let change = self.change();
        let mut theta = believed.theta;
        theta.iter_mut().zip(change.iter()).for_each(|(value, change)| *value += change);
        let mut edges = believed.edges_counts;
        edges.iter_mut().zip(change.iter().skip(MECHANICS)).for_each(|(value, change)| *value += change);
        // what is common to all four is a turn of the whole disc
        let mean = edges.iter().sum::<f64>() / PHASES as f64;
        believed.with(theta, edges.map(|edge| edge - mean))
    }
}

/// What position and speed at a stretch's start, which are free, leave of any quantity over it.
struct Free {
    mean_s: f64,
    spread: f64,
}

impl Free {
    fn of(stretch: &Stretch) -> Self {
        let count = stretch.rows.len() as f64;
        let mean_s = stretch.rows.iter().map(|row| row.time_s).sum::<f64>() / count;
        let spread = stretch.rows.iter().map(|row| powi(row.time_s - mean_s, 2)).sum::<f64>();
        Self { mean_s, spread }
    }

    /// Takes the best straight line over time out of a quantity.
    fn leave_of(&self, rows: &[Row], values: &[f64]) -> Vec<f64> {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let since = |row: &Row| row.time_s - self.mean_s;
        let slope = rows.iter().zip(values).map(|(r, v)| v * since(r)).sum::<f64>() / self.spread.max(1e-12);
        rows.iter().zip(values).map(|(r, v)| v - mean - slope * since(r)).collect()
    }

    fn leave(&self, stretch: &Stretch, quantity: impl Fn(&Row) -> f64) -> Vec<f64> {
        self.leave_of(&stretch.rows, &stretch.rows.iter().map(quantity).collect::<Vec<_>>())
    }

    /// Lines of the least squares for the change of what is believed: coefficients of the unknowns, and what is to be
    /// explained, rad.
    fn lines(&self, stretch: &Stretch, believed: &Equations) -> Vec<(Line, f64)> {
        let count_rad = stretch.count_rad;
        let value = self.leave(stretch, |row| off_rad(believed, row, count_rad));
        let columns: Vec<Vec<f64>> =
            (0..UNKNOWNS).map(|k| self.leave(stretch, |row| column(row, k, count_rad))).collect();
        let line = |i: usize| Line::from_fn(|k, _| columns[k][i]);
        value.iter().enumerate().map(|(i, &value)| (line(i), value)).collect()
    }
}

/// Where the edge lies beyond where the equations put the joint when it came, but for position and speed at the start, rad.
fn off_rad(equations: &Equations, row: &Row, count_rad: f64) -> f64 {
    let moved: f64 = equations.theta.iter().zip(&row.columns).map(|(theta, column)| theta * column).sum();
    row.angle_rad + equations.edges_counts[row.phase] * count_rad - moved
}

/// How an unknown changes what is to be explained.
fn column(row: &Row, unknown: usize, count_rad: f64) -> f64 {
    match unknown.checked_sub(MECHANICS) {
        None => row.columns[unknown],
        Some(phase) if phase == row.phase => -count_rad,
        Some(_) => 0.0,
    }
}

/// How far equations are off on a stretch, root mean square, counts.
fn stretch_counts(equations: &Equations, stretch: &Stretch) -> f64 {
    let left = Free::of(stretch).leave(stretch, |row| off_rad(equations, row, stretch.count_rad));
    (left.iter().map(|value| value * value).sum::<f64>() / left.len() as f64).sqrt() / stretch.count_rad
}

/// The same over many, each stretch alike, but for the worst tenth: in one somebody may have pushed.
pub(super) fn residual_counts(equations: &Equations, stretches: &[&Stretch]) -> f64 {
    let mut squares: Vec<f64> = stretches.iter().map(|s| powi(stretch_counts(equations, s), 2)).collect();
    squares.sort_by(f64::total_cmp);
    squares.truncate(squares.len() - squares.len() / 10);
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
}
