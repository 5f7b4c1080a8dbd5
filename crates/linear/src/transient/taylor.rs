//! A function about a moment: its derivatives there, and what they say of it for a while.

/// How many derivatives are known, the value among them; the next one is bounded.
pub(super) const LEVELS: usize = 12;

/// Derivatives of a function at a time.
#[derive(Clone, Debug)]
pub(super) struct Taylor {
    pub(super) time: f64,
    /// The value, its slope, and so on.
    pub(super) derivatives: [f64; LEVELS],
    /// What else is known there, for each mode.
    pub(super) sizes: Vec<f64>,
}

/// A function over a stretch of time as a polynomial in Bernstein's form, and how far off it may be: it is nowhere above its largest
/// coefficient by more than that.
pub(super) struct Bernstein {
    coefficients: [f64; LEVELS],
    count: usize,
    /// How far off.
    error: f64,
}

impl Taylor {
    pub(super) const fn at(time: f64) -> Self {
        Self { time, derivatives: [0.0; LEVELS], sizes: Vec::new() }
    }

    pub(super) const fn value(&self) -> f64 {
        self.derivatives[0]
    }

    pub(super) const fn slope(&self) -> f64 {
        self.derivatives[1]
    }

    /// The `level`-th derivative for `span` from here on; the last one is no more than `most_last`.
    pub(super) fn over(&self, span: f64, level: usize, most_last: f64) -> Bernstein {
        let count = LEVELS - level;
        let mut coefficients = [0.0; LEVELS];
        let mut share = 1.0; // hⁱ/i!
        for (i, coefficient) in coefficients[..count].iter_mut().enumerate() {
            *coefficient = self.derivatives[level + i] * share;
            share *= span / (i + 1) as f64;
        }
        // from powers of t/h: aᵢ over the binomial coefficient, then sums of sums
        let degree = count - 1;
        let mut binomial = 1.0;
        for (i, coefficient) in coefficients[..count].iter_mut().enumerate() {
            *coefficient /= binomial;
            binomial *= (degree - i) as f64 / (i + 1) as f64;
        }
        for end in 1..count {
            for i in (end..count).rev() {
                coefficients[i] += coefficients[i - 1];
            }
        }
        Bernstein { coefficients, count, error: most_last * share }
    }
}

impl Bernstein {
    fn coefficients(&self) -> impl Iterator<Item = f64> + '_ {
        self.coefficients[..self.count].iter().copied()
    }

    /// An upper bound of the function, times `sign`.
    pub(super) fn most(&self, sign: f64) -> f64 {
        self.coefficients().map(|b| sign * b).fold(f64::NEG_INFINITY, f64::max) + self.error
    }

    /// Whether the function has one sign all the time, and is not zero.
    pub(super) fn has_one_sign(&self) -> bool {
        self.most(1.0) < 0.0 || self.most(-1.0) < 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernsteins_form_begins_and_ends_with_the_function_and_bounds_it() {
        // sin t from 0.3 on
        let mut taylor = Taylor::at(0.3);
        let (sin, cos) = 0.3_f64.sin_cos();
        taylor.derivatives = std::array::from_fn(|i| [sin, cos, -sin, -cos][i % 4]);
        for span in [0.1, 0.7, 2.0] {
            let over = taylor.over(span, 0, 1.0);
            assert!((over.coefficients[0] - sin).abs() < 1e-15);
            let end = (0.3 + span).sin();
            assert!((over.coefficients[LEVELS - 1] - end).abs() <= over.error + 1e-15, "{span}");
            let true_most = if 0.3 + span > 1.57 { 1.0 } else { end };
            assert!(over.most(1.0) >= true_most && over.most(1.0) < 1.1 * true_most, "{span}");
            let slope = taylor.over(span, 1, 1.0);
            assert_eq!(slope.has_one_sign(), 0.3 + span < 1.5, "{span}");
        }
    }
}
