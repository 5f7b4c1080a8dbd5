//! Eigenvalues of a real matrix, in bounded time.

use tracelight_maths::{exp2, log2, powi};

use crate::{Complex, LinearError, Matrix};

/// Sweeps that one eigenvalue may take; on average it takes two or three. Every tenth is shifted out of the ordinary.
const MOST_SWEEPS: usize = 60;

/// Eigenvalues of a square matrix, conjugate pairs exactly so, in no order: it is balanced, reduced to Hessenberg's form, and swept by
/// Francis's double shifts (Golub & Van Loan, *Matrix Computations*, 4th ed., §7.4–7.5).
pub fn eigenvalues(matrix: &Matrix) -> Result<Vec<Complex>, LinearError> {
    if !matrix.is_square() {
        return Err(LinearError::Shape("eigenvalues are of a square matrix"));
    }
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(LinearError::NotFinite);
    }
    let (balanced, _) = balanced(matrix.clone());
    let mut hessenberg = Hessenberg { h: reduced(balanced), found: Vec::with_capacity(matrix.nrows()) };
    let mut size = matrix.nrows();
    while size > 0 {
        size = hessenberg.deflate(size)?;
    }
    Ok(hessenberg.found)
}

/// D⁻¹ A D and the diagonal of D, powers of two, so that rows and columns are about as large (Osborne; Parlett & Reinsch 1969).
pub(crate) fn balanced(mut a: Matrix) -> (Matrix, Vec<f64>) {
    /// Rounds; each at least halves what is out of balance, and there is little to gain after some.
    const MOST_ROUNDS: usize = 60;
    let n = a.nrows();
    let mut scales = vec![1.0; n];
    for _ in 0..MOST_ROUNDS {
        let mut changed = false;
        for i in 0..n {
            let beside = (0..n).filter(|&j| j != i);
            let row: f64 = beside.clone().map(|j| a[(i, j)].abs()).sum();
            let column: f64 = beside.map(|j| a[(j, i)].abs()).sum();
            if row == 0.0 || column == 0.0 || !(row / column).is_finite() || row / column == 0.0 {
                continue;
            }
            let scale = exp2((0.5 * log2(row / column)).round().clamp(-500.0, 500.0));
            if column * scale + row / scale < 0.95 * (column + row) {
                changed = true;
                scales[i] *= scale;
                a.row_mut(i).iter_mut().for_each(|entry| *entry /= scale);
                a.column_mut(i).iter_mut().for_each(|entry| *entry *= scale);
            }
        }
        if !changed {
            break;
        }
    }
    (a, scales)
}

/// Hessenberg's form by Householder's reflections.
fn reduced(mut a: Matrix) -> Matrix {
    let n = a.nrows();
    for k in 1..n.saturating_sub(1) {
        let column: Vec<f64> = (k..n).map(|i| a[(i, k - 1)]).collect();
        if let Some(mirror) = Mirror::of(&column) {
            mirror.rows(&mut a, k, 0..n);
            mirror.columns(&mut a, k, 0..n);
        }
        (k + 1..n).for_each(|i| a[(i, k - 1)] = 0.0);
    }
    a
}

/// The reflection I − β v vᵀ.
struct Mirror {
    v: Vec<f64>,
    beta: f64,
}

impl Mirror {
    /// The one that turns a vector onto the first axis; none for zero.
    fn of(vector: &[f64]) -> Option<Self> {
        let most = vector.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        if most == 0.0 {
            return None;
        }
        let mut v: Vec<f64> = vector.iter().map(|value| value / most).collect();
        let norm = v.iter().map(|value| value * value).sum::<f64>().sqrt();
        v[0] += norm.copysign(v[0]);
        let beta = 2.0 / v.iter().map(|value| value * value).sum::<f64>();
        Some(Self { v, beta })
    }

    /// From the left, on the rows from `first`.
    fn rows(&self, a: &mut Matrix, first: usize, columns: std::ops::Range<usize>) {
        for j in columns {
            let dot: f64 = (0..).zip(&self.v).map(|(i, v)| v * a[(first + i, j)]).sum();
            (0..).zip(&self.v).for_each(|(i, v)| a[(first + i, j)] -= self.beta * dot * v);
        }
    }

    /// From the right, on the columns from `first`.
    fn columns(&self, a: &mut Matrix, first: usize, rows: std::ops::Range<usize>) {
        for i in rows {
            let dot: f64 = (0..).zip(&self.v).map(|(j, v)| v * a[(i, first + j)]).sum();
            (0..).zip(&self.v).for_each(|(j, v)| a[(i, first + j)] -= self.beta * dot * v);
        }
    }
}

/// What is left of a matrix whose eigenvalues are found from its end.
struct Hessenberg {
    h: Matrix,
    found: Vec<Complex>,
}

impl Hessenberg {
    /// Finds one or two eigenvalues at the end of the first `size` rows and columns; how many rows are left.
    fn deflate(&mut self, size: usize) -> Result<usize, LinearError> {
        for sweep in 0..=MOST_SWEEPS {
            let first = self.block(size);
            match size - first {
                1 => self.found.push(Complex::new(self.h[(first, first)], 0.0)),
                2 => self.found.extend(self.pair(first)),
                _ => {
                    let unusual = sweep % 10 == 9;
                    self.sweep(first, size, unusual);
                    continue;
                }
            }
            return Ok(first);
        }
        Err(LinearError::NotConverged)
    }

    /// Where the last block that hangs together begins.
    fn block(&mut self, size: usize) -> usize {
        let h = &mut self.h;
        for i in (1..size).rev() {
            let beside = h[(i - 1, i - 1)].abs() + h[(i, i)].abs();
            let around = if beside > 0.0 { beside } else { h.amax() };
            if h[(i, i - 1)].abs() <= f64::EPSILON * around {
                h[(i, i - 1)] = 0.0;
                return i;
            }
        }
        0
    }

    /// Eigenvalues of the two rows and columns from `first`.
    fn pair(&self, first: usize) -> [Complex; 2] {
        let h = |i: usize, j: usize| self.h[(first + i, first + j)];
        let (middle, half) = (0.5 * (h(0, 0) + h(1, 1)), 0.5 * (h(0, 0) - h(1, 1)));
        let across = h(0, 1) * h(1, 0);
        let square = half * half + across;
        if square < 0.0 {
            let swing = (-square).sqrt();
            return [Complex::new(middle, swing), Complex::new(middle, -swing)];
        }
        // the one further from the last diagonal entry, and the other by what they sum up to: nothing cancels
        let root = half + square.sqrt().copysign(half);
        let other = if root == 0.0 { 0.0 } else { -across / root };
        [Complex::new(h(1, 1) + root, 0.0), Complex::new(h(1, 1) + other, 0.0)]
    }

    /// One implicit double-shift sweep over the rows and columns from `first` to before `size`, three at least.
    fn sweep(&mut self, first: usize, size: usize, unusual: bool) {
        let mut bulge = self.shifted_column(first, size, unusual).to_vec();
        for k in first..size - 1 {
            if let Some(mirror) = Mirror::of(&bulge) {
                let from = if k > first { k - 1 } else { first };
                mirror.rows(&mut self.h, k, from..size);
                mirror.columns(&mut self.h, k, first..size.min(k + 4));
            }
            let below = k + 1..size.min(k + 4);
            bulge = below.clone().map(|i| self.h[(i, k)]).collect();
            if k > first {
                (k + 1..size.min(k + 3)).for_each(|i| self.h[(i, k - 1)] = 0.0);
            }
        }
    }

    /// The first column of (H − aI)(H − bI) for the shifts a and b, as far as it is not zero.
    fn shifted_column(&self, first: usize, size: usize, unusual: bool) -> [f64; 3] {
        let h = |i: usize, j: usize| self.h[(i, j)];
        let last = size - 1;
        let (sum, product) = if unusual {
            // Wilkinson's, for matrices that ordinary shifts only turn round
            let s = h(last, last - 1).abs() + h(last - 1, last - 2).abs();
            (2.0 * 0.75 * s + 2.0 * h(last, last), powi(0.75 * s + h(last, last), 2) + 0.4375 * s * s)
        } else {
            let (a, d) = (h(last - 1, last - 1), h(last, last));
            (a + d, a * d - h(last - 1, last) * h(last, last - 1))
        };
        let (a, b, c) = (h(first, first), h(first + 1, first), h(first + 1, first + 1));
        [a * a + h(first, first + 1) * b - sum * a + product, b * (a + c - sum), b * h(first + 2, first + 1)]
    }
}

#[cfg(test)]
mod tests {
    use tracelight_maths::complex;

    use super::*;

    fn check(name: &str, rows: usize, entries: &[f64], truth: &[Complex], tolerance: f64) {
        let found = eigenvalues(&Matrix::from_row_slice(rows, rows, entries)).unwrap();
        let mut left = found.clone();
        assert_eq!(left.len(), truth.len(), "{name}");
        for t in truth {
            let apart = |z: &Complex| complex::norm(z - t);
            let nearest =
                (0..left.len()).min_by(|&a, &b| apart(&left[a]).total_cmp(&apart(&left[b]))).unwrap();
            let found = left.swap_remove(nearest);
            assert!(apart(&found) <= tolerance * (1.0 + complex::norm(*t)), "{name}: {found} is not {t}");
        }
    }

    fn real(values: &[f64]) -> Vec<Complex> {
        values.iter().map(|&v| Complex::new(v, 0.0)).collect()
    }

    #[test]
    fn matrices_with_known_eigenvalues() {
        check("one", 1, &[-3.0], &real(&[-3.0]), 0.0);
        check("diagonal", 3, &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0], &real(&[1.0, 2.0, 3.0]), 0.0);
        check("turn", 2, &[0.0, -2.0, 2.0, 0.0], &[Complex::new(0.0, 2.0), Complex::new(0.0, -2.0)], 1e-15);
        check("triangle", 3, &[1.0, 5.0, 7.0, 0.0, 2.0, 9.0, 0.0, 0.0, 1e9], &real(&[1.0, 2.0, 1e9]), 1e-15);
        check("badly scaled", 2, &[1.0, 1e12, 1e-12, 1.0], &real(&[0.0, 2.0]), 1e-15);
    }

    /// Those on which an eigenvalue iteration was reported never to end: zeros, permutations, companions of xⁿ and xⁿ − 1.
    #[test]
    fn what_hangs_others_ends() {
        for n in [1, 2, 3, 4, 5, 8, 12, 30] {
            let zeros = Matrix::zeros(n, n);
            assert!(eigenvalues(&zeros).unwrap().iter().all(|z| *z == Complex::ZERO));
            let mut companion = Matrix::zeros(n, n);
            (1..n).for_each(|i| companion[(i, i - 1)] = 1.0);
            assert!(eigenvalues(&companion).unwrap().iter().all(|z| *z == Complex::ZERO), "{n}");
            companion[(0, n - 1)] = 1.0;
            for z in eigenvalues(&companion).unwrap() {
                assert!(complex::norm(z.powu(n as u32) - 1.0) < 1e-12, "{n}: {z}");
            }
        }
        let swap = [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        check("swap", 4, &swap, &real(&[1.0, 1.0, -1.0, -1.0]), 1e-12);
    }

    #[test]
    fn random_matrices_have_their_trace_and_their_determinant() {
        let mut random = oorandom::Rand64::new(4);
        for round in 0..2000 {
            let n = random.rand_range(1..13) as usize;
            let scale = [0.0, 4.0][round % 2];
            let entry = |_, _| {
                let size = 10_f64.powf(scale * (random.rand_float() - 0.5));
                if random.rand_float() < 0.2 { 0.0 } else { size * (2.0 * random.rand_float() - 1.0) }
            };
            let matrix = Matrix::from_fn(n, n, entry);
            let found = eigenvalues(&matrix).unwrap();
            let trace: Complex = found.iter().sum();
            assert!(complex::norm(trace - matrix.trace()) <= 1e-12 * matrix.norm() * n as f64, "{matrix}");
            let product: Complex = found.iter().product();
            let size: f64 = found.iter().map(|z| complex::norm(*z).max(1e-3 * matrix.norm())).product();
            assert!(complex::norm(product - matrix.determinant()) <= 1e-9 * size, "{matrix} {found:?}");
        }
    }

    #[test]
    fn what_has_no_eigenvalues_is_refused() {
        assert!(eigenvalues(&Matrix::zeros(2, 3)).is_err());
        assert!(eigenvalues(&Matrix::from_element(2, 2, f64::NAN)).is_err());
        assert_eq!(eigenvalues(&Matrix::zeros(0, 0)).unwrap(), []);
    }
}
