use std::fmt;

use tracelight_maths::complex;

use crate::{Complex, LinearError};

/// Whether a system goes on all the time or from sample to sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Time {
    /// All the time; its variable is s.
    #[default]
    Continuous,
    /// Once in so many seconds; its variable is z.
    Sampled(f64),
}

impl Time {
    /// Once in so many seconds, more than none.
    pub fn sampled(period_s: f64) -> Result<Self, LinearError> {
        positive("the sampling period", period_s).map(Self::Sampled)
    }

    /// Its variable at an angular frequency: jω, or e^(jωT).
    pub fn at_frequency(self, rad_s: f64) -> Complex {
        match self {
            Self::Continuous => Complex::new(0.0, rad_s),
            Self::Sampled(period_s) => complex::from_polar(1.0, rad_s * period_s),
        }
    }

    /// Its variable where nothing changes: 0, or 1.
    pub const fn at_rest(self) -> Complex {
        match self {
            Self::Continuous => Complex::ZERO,
            Self::Sampled(_) => Complex::ONE,
        }
    }

    /// The pole in continuous time that does the same between samples, and itself in continuous time: ln z / T.
    pub fn continuous(self, pole: Complex) -> Complex {
        match self {
            Self::Continuous => pole,
            Self::Sampled(period_s) => complex::ln(pole) / period_s,
        }
    }

    /// Above this a system can do nothing of its own, rad/s: half the sampling frequency.
    pub fn nyquist_rad_s(self) -> f64 {
        match self {
            Self::Continuous => f64::INFINITY,
            Self::Sampled(period_s) => std::f64::consts::PI / period_s,
        }
    }

    /// How an integral goes on: what is kept of it, and what it takes of what it integrates; its slope in continuous time, of samples the
    /// next one.
    pub(crate) const fn integral(self) -> (f64, f64) {
        match self {
            Self::Continuous => (0.0, 1.0),
            Self::Sampled(period_s) => (1.0, period_s),
        }
    }

    /// The letter its variable has.
    pub const fn variable(self) -> &'static str {
        match self {
            Self::Continuous => "s",
            Self::Sampled(_) => "z",
        }
    }

    /// This, if both are.
    pub(crate) fn with(self, other: Self) -> Result<Self, LinearError> {
        let same = match (self, other) {
            (Self::Sampled(a), Self::Sampled(b)) => (a - b).abs() <= 1e-9 * a,
            (a, b) => a == b,
        };
        if same { Ok(self) } else { Err(LinearError::Sampling(self.to_string(), other.to_string())) }
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Continuous => f.write_str("continuous time"),
            Self::Sampled(period_s) => write!(f, "samples every {period_s} s"),
        }
    }
}

/// Checks that a value is positive and finite, and returns it.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<f64, LinearError> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(LinearError::Range { name, value, below: String::new() })
    }
}
