use crate::eigen::balanced;
use crate::{Matrix, StateSpace};

/// A, B and C in states whose rows and columns of A are about as large.
pub(super) fn balanced_states(system: &StateSpace) -> (Matrix, Matrix, Matrix) {
    let (a, scales) = balanced(system.a().clone());
    let (mut b, mut c) = (system.b().clone(), system.c().clone());
    for (i, scale) in scales.iter().enumerate() {
        b.row_mut(i).iter_mut().for_each(|entry| *entry /= scale);
        c.column_mut(i).iter_mut().for_each(|entry| *entry *= scale);
    }
    (a, b, c)
}

/// An orthogonal matrix that leaves only as many rows of that one as its rank is, and this.
pub(super) fn compressed(matrix: &Matrix, least: f64) -> (Matrix, usize) {
    let mut turn = Matrix::identity(matrix.nrows(), matrix.nrows());
    if matrix.is_empty() {
        return (turn, 0);
    }
    let factored = matrix.clone().col_piv_qr();
    let r = factored.r();
    let rank = (0..r.nrows().min(r.ncols())).take_while(|&i| r[(i, i)].abs() > least).count();
    factored.q_tr_mul(&mut turn);
    (turn, rank)
}
