//! What a formula is made of while it is read, and what may be wrong with it.

use thiserror::Error;

use crate::{Delayed, TransferFunction};

/// What is wrong with a formula, and where.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{message}")]
pub struct FormulaError {
    /// Characters before the place.
    pub at: usize,
    /// What is wrong there and what would be right.
    pub message: String,
}

/// Systems by name.
pub type Names<'a> = dyn Fn(&str) -> Option<Delayed> + 'a;

/// A part of a formula: on the way a dead time may be negative.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) rational: TransferFunction,
    pub(super) delay_s: f64,
}

impl From<TransferFunction> for Part {
    fn from(rational: TransferFunction) -> Self {
        Self { rational, delay_s: 0.0 }
    }
}

impl Part {
    pub(super) fn scaled(&self, by: f64) -> Self {
        Self { rational: self.rational.scaled(by), delay_s: self.delay_s }
    }

    pub(super) fn is_zero(&self) -> bool {
        self.rational.numerator().is_zero()
    }
}
