//! What a group of poles contributes to the output.

use tracelight_maths::{complex, exp, ln};

use crate::Complex;
use crate::transient::taylor::{LEVELS, Taylor};

/// The real part of e^(ct) Σ mᵢ tⁱ/i!.
#[derive(Clone, Debug)]
pub(super) struct Term {
    /// c, in its unit of time.
    pub(super) rate: Complex,
    /// How many mᵢ there are.
    count: usize,
    /// mᵢ of the value, then of each of its derivatives.
    moments: Vec<Complex>,
    /// |mᵢ| of the value, and of the last derivative.
    sizes: [Vec<f64>; 2],
    /// ln i!.
    factorials_ln: Vec<f64>,
}

impl Term {
    pub(super) fn new(rate: Complex, value: Vec<Complex>) -> Self {
        let count = value.len();
        let mut moments = value;
        moments.reserve(LEVELS * count);
        for k in 0..LEVELS * count {
            let next = if (k + 1) % count == 0 { Complex::ZERO } else { moments[k + 1] };
            moments.push(rate * moments[k] + next);
        }
        let sizes =
            [0, LEVELS * count].map(|at| moments[at..at + count].iter().map(|&m| complex::norm(m)).collect());
        let factorials_ln = (0..count)
            .scan(0.0, |sum, i| {
                *sum += if i > 1 { ln(i as f64) } else { 0.0 };
                Some(*sum)
            })
            .collect();
        Self { rate, count, moments, sizes, factorials_ln }
    }

    /// Its largest value at time 0, whatever its phase.
    pub(super) fn size(&self) -> f64 {
        self.sizes[0][0]
    }

    fn at(&self, time: f64) -> f64 {
        (complex::exp(self.rate * time) * series(&self.moments[..self.count], time)).re
    }

    /// Adds its derivatives at a time; e^(Re c t).
    fn add_to(&self, taylor: &mut Taylor) -> f64 {
        let time = taylor.time;
        let size = exp(self.rate.re * time);
        if size > 0.0 {
            let turn = self.rate.im * time;
            let e = if turn == 0.0 { size.into() } else { complex::from_polar(size, turn) };
            for (value, moments) in taylor.derivatives.iter_mut().zip(self.moments.chunks_exact(self.count)) {
                let m = series(moments, time);
                *value += e.re * m.re - e.im * m.im;
            }
        }
        size
    }

    /// Most that its last derivative is for `span` from a time on, at which e^(Re c t) is `size`.
    fn most_last(&self, size: f64, time: f64, span: f64) -> f64 {
        let grown = if self.rate.re > 0.0 { exp(self.rate.re * span) } else { 1.0 };
        size * grown * series(&self.sizes[1], time + span)
    }

    /// Most of it at any time from then on; what is real and alone only where it has that sign.
    fn most_after(&self, time: f64, sign: f64) -> f64 {
        let decay = -self.rate.re;
        if self.count == 1 {
            let size = if self.rate.im == 0.0 { (sign * self.moments[0].re).max(0.0) } else { self.size() };
            return size * exp(-decay * time);
        }
        let most = |(i, &size): (usize, &f64)| {
            let worst = time.max(i as f64 / decay);
            let power = if i > 0 { i as f64 * ln(worst) - self.factorials_ln[i] } else { 0.0 };
            if size == 0.0 { 0.0 } else { size * exp(power - decay * worst) }
        };
        self.sizes[0].iter().enumerate().map(most).sum()
    }

    /// How long it takes to die out to a share of what it was, or to grow as much.
    fn lasts(&self, share: f64) -> f64 {
        /// What decays slower than that share of how fast it swings is not waited for.
        const LEAST_DAMPING: f64 = 0.05;
        const MOST_TOGETHER: f64 = 12.0;
        let rate = self.rate.re.abs().max(LEAST_DAMPING * complex::norm(self.rate));
        (((self.count - 1) as f64).min(MOST_TOGETHER) - ln(share)) / rate
    }
}

/// Σ mᵢ tⁱ/i!.
fn series<T>(moments: &[T], time: f64) -> T
where
    T: Copy + Default + std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let each = moments.iter().enumerate().rev();
    each.fold(T::default(), |sum, (i, &m)| sum * (time / (i + 1) as f64) + m)
}

/// An output as a constant, powers of time and contributions of modes. Times are in its own unit.
#[derive(Clone, Debug)]
pub(super) struct Sum {
    /// mᵢ of Σ mᵢ tⁱ/i!, what poles at 0 make: a constant at least.
    pub(super) powers: Vec<f64>,
    pub(super) terms: Vec<Term>,
    /// Derivatives of the output just after time 0, the value first.
    pub(super) start: [f64; LEVELS],
    /// Units of its time in a second.
    pub(super) per_second: f64,
}

impl Sum {
    /// Value at a time, s.
    pub(super) fn at(&self, time_s: f64) -> f64 {
        let time = time_s * self.per_second;
        series(&self.powers, time) + self.terms.iter().map(|term| term.at(time)).sum::<f64>()
    }

    /// The modes alone about a time in its own unit; `sizes` is what [`most_last`](Self::most_last) needs of them there.
    pub(super) fn modes(&self, time: f64) -> Taylor {
        let mut taylor = Taylor::at(time);
        let sizes = self.terms.iter().map(|term| term.add_to(&mut taylor)).collect();
        taylor.sizes = sizes;
        self.begin(&mut taylor);
        taylor
    }

    /// Just after time 0 large modes may cancel to next to nothing: there the first derivatives are those of its power series.
    fn begin(&self, taylor: &mut Taylor) {
        /// Times the fastest rate: what is left out is less than a rounding.
        const SOON: f64 = 0.1;
        const FIRST: usize = 4;
        let fastest = self.terms.iter().map(|term| complex::norm(term.rate)).fold(0.0, f64::max);
        if taylor.time * fastest < SOON {
            for (k, derivative) in taylor.derivatives.iter_mut().enumerate().take(FIRST) {
                let constant = self.powers.get(k).copied().unwrap_or_default();
                *derivative = series(&self.start[k..], taylor.time) - constant;
            }
        }
    }

    /// Most that the last derivative of the modes is from there on, for so long.
    pub(super) fn most_last(&self, from: &Taylor, span: f64) -> f64 {
        let of = |(term, &size): (&Term, &f64)| term.most_last(size, from.time, span);
        self.terms.iter().zip(&from.sizes).map(of).sum()
    }

    /// Most that all modes together are at any time from then on, if they die out; with a sign, in that direction.
    pub(super) fn most_after(&self, time: f64, sign: f64) -> f64 {
        self.terms.iter().map(|term| term.most_after(time, sign)).sum()
    }

    /// Fastest and slowest rate of its modes; none of a constant.
    pub(super) fn rates(&self) -> Option<(f64, f64)> {
        let fastest = self.terms.iter().map(|term| complex::norm(term.rate)).reduce(f64::max)?;
        let slowest = self.terms.iter().map(|term| -term.rate.re).reduce(f64::min)?;
        Some((fastest, slowest))
    }

    /// How long until all that dies out has done so to a share of itself, or what grows has grown by as much; 0 of a constant.
    pub(super) fn lasts(&self, share: f64) -> f64 {
        self.terms.iter().map(|term| term.lasts(share)).fold(0.0, f64::max)
    }
}
