use thiserror::Error;

use crate::notation::four_digits;

/// Why there is no such system, or no such figure of it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LinearError {
    /// A denominator is zero.
    #[error("a denominator is zero")]
    NoDenominator,
    /// More zeros than poles: it would have to know what comes.
    #[error("{zeros} zeros and {poles} poles: what has more zeros than poles has no {what}")]
    Improper {
        /// Number of zeros.
        zeros: usize,
        /// Number of poles.
        poles: usize,
        /// What was asked for.
        what: &'static str,
    },
    /// A coefficient is no number, or became none on the way.
    #[error("a coefficient is infinite or no number")]
    NotFinite,
    /// Roots that are not real come in pairs.
    #[error(
        "{0} has no conjugate beside it; a system with real coefficients has its complex poles and zeros in pairs"
    )]
    Unpaired(String),
    /// Systems of different sampling do not go together.
    #[error("{0} and {1} do not go together: sample the one, or choose the same period")]
    Sampling(String, String),
    /// A period, frequency or other number that has to be positive is not.
    #[error("{name} is {value}; it has to be more than zero{below}")]
    Range {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// And less than what, if anything.
        below: String,
    },
    /// Matrices that do not fit together.
    #[error("{0}")]
    Shape(&'static str),
    /// Feedback without an answer: 1 + G H is zero everywhere, or where s (or z) is infinite.
    #[error(
        "1 + G H is zero, everywhere or at infinite frequency: that loop answers at once and without bounds; break it by a delay or a pole"
    )]
    AlgebraicLoop,
    /// A weight that has to be positive, and symmetric, is not.
    #[error("{0} is not symmetric and positive")]
    NotPositive(&'static str),
    /// Nothing settles that system: a mode at or beyond the edge of stability is not moved by any input, or not seen, or costs nothing.
    #[error(
        "nothing brings that system to rest: a mode that does not die out by itself is not moved by the input, not seen, or costs nothing"
    )]
    NoRegulator,
    /// What is wished for cannot be had.
    #[error("{0}")]
    Wish(String),
    /// The faster the better: a crossover has to be chosen.
    #[error(
        "the faster the better, up to {} rad/s and beyond: nothing in the system bounds the crossover; choose one, such as {} rad/s",
        four_digits(*to_rad_s),
        four_digits(*offer_rad_s)
    )]
    Unbounded {
        /// How far it was looked for, rad/s.
        to_rad_s: f64,
        /// One that will do, rad/s.
        offer_rad_s: f64,
    },
    /// Data that are no frequency response, or do not tell what is asked: with the point, its value and the bound.
    #[error("{0}")]
    Data(String),
    /// An iteration did not end where it should.
    #[error("an iteration did not converge")]
    NotConverged,
}
