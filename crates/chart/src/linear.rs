//! An even axis.

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;

use crate::range::Range;

/// An even axis, with lines at multiples of a step, or at round numbers.
pub(crate) struct Linear {
    even: RangedCoordf64,
    range: Range,
    step: Option<f64>,
}

impl Linear {
    pub(crate) fn new(range: Range, step: Option<f64>) -> Self {
        Self { even: (range.low..range.high).into(), range, step }
    }
}

impl Ranged for Linear {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.even.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let most = hint.max_num_points();
        self.step.map_or_else(|| self.even.key_points(hint), |step| multiples(self.range, step, most))
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.low..self.range.high
    }
}

/// Multiples of a step within a range; of twice, thrice the step, where there would be too many.
fn multiples(range: Range, step: f64, most: usize) -> Vec<f64> {
    let often = (range.span() / step / most.max(1) as f64).ceil().clamp(1.0, 1e6);
    let step = step * often;
    let (first, last) = ((range.low / step).ceil() as i64, (range.high / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}
