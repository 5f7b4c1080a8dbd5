//! Linear systems: polynomials, transfer functions, state space, their poles, margins and responses.
//!
//! It knows nothing of heads and their joints: numbers in, numbers out. Everything here ends: iterations are bounded, and what they
//! reached is said.

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod binary;
mod cascade;
mod convert;
mod crossings;
mod damped;
mod dead_time;
mod delay;
mod design;
mod discretize;
mod eigen;
mod error;
mod feedback;
mod formula;
mod frequency;
mod frequency_data;
mod golden;
mod locus;
mod margins;
mod mimo;
mod notation;
mod nyquist;
mod peak;
mod polynomial;
mod response;
mod roots;
mod stability;
mod state_space;
mod time;
mod transfer;
mod transient;
mod turns;
mod twofold;
mod zpk;

/// A complex number.
pub type Complex = nalgebra::Complex<f64>;

/// A matrix of any size.
pub type Matrix = nalgebra::DMatrix<f64>;

pub use crossings::{LocusCrossing, RealCrossing};
pub use damped::DampedGains;
pub use dead_time::{Answer, Delayed, GrowingPoles};
pub use delay::DelayMargin;
pub use design::{
    Estimator, IdealForm, LeadLagWish, LqgWish, Pid, PidWish, Regulator, SeriesForm, SetpointWeights, Terms,
};
pub use discretize::Discretization;
pub use eigen::eigenvalues;
pub use error::LinearError;
pub use feedback::{ErrorConstants, FeedbackLoop, LoopFunction, LoopMember, Norm};
pub use formula::{FormulaError, Names};
pub use frequency::{FrequencyResponse, decibels, logspace};
pub use frequency_data::{DataPeak, FrequencyData, Spacing};
pub use locus::{Asymptotes, Breakaway, RootLocus};
pub use margins::{GainMargin, Margins, ModulusMargin, PhaseMargin};
pub use mimo::{ComplexMatrix, DiskMargin, DiskMargins, Hidden, Minimal, singular_values};
pub use notation::four_digits;
pub use nyquist::{InfiniteArc, NyquistCurve, NyquistPart};
pub use peak::Peak;
pub use polynomial::Polynomial;
pub use response::{Mode, Response};
pub use roots::{DistinctRoot, Root};
pub use stability::Stability;
pub use state_space::StateSpace;
pub use time::Time;
pub use transfer::TransferFunction;
pub use transient::{Ending, Extreme, Input, StepInfo, Transient};
pub use zpk::Zpk;

/// The examples of `README.md`, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
