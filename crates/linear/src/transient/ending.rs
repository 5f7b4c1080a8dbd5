//! What comes in, and what the output does in the long run.

/// What comes in, from rest at time 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// 1 from then on.
    Step,
    /// Its integral over time is 1; of samples one sample of 1.
    Impulse,
    /// Rising by 1 a second.
    Ramp,
}

/// What an output does in the long run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// The output converges to this value.
    Converges(f64),
    /// The output grows without bounds.
    Diverges,
    /// The output oscillates for ever `about` a value, by no more than `by`.
    Oscillates {
        /// Mean value.
        about: f64,
        /// Sum of the amplitudes of all modes that do not die out.
        by: f64,
    },
    /// A pole is nearer to the edge of stability than the rounding of the coefficients: nobody can tell.
    Undecided,
}

impl Ending {
    /// The final value, if there is one.
    pub const fn value(self) -> Option<f64> {
        match self {
            Self::Converges(value) => Some(value),
            Self::Diverges | Self::Oscillates { .. } | Self::Undecided => None,
        }
    }
}
