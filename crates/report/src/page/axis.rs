use tracelight_maths::{log10, powf};

use super::html::number;

/// A range of values shown from edge to edge, with its marks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    step: f64,
}

impl Axis {
    /// Shows exactly `low` to `high` with about `marks` marks; widened where there is nothing between them.
    pub(super) fn new(low: f64, high: f64, marks: usize) -> Self {
        let (low, high) = match (low.is_finite() && high.is_finite(), high - low) {
            (true, span) if span > 1e-12 => (low, high),
            (true, _) => (low - 0.5, low + 0.5),
            (false, _) => (0.0, 1.0),
        };
        Self { low, high, step: round_step((high - low) / marks.max(1) as f64) }
    }

    /// Shows all of some values between two marks.
    pub(super) fn around(values: impl Iterator<Item = f64>, marks: usize) -> Self {
        let (low, high) = values
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        let tight = Self::new(low, high, marks);
        let low = (tight.low / tight.step).floor() * tight.step;
        let high = (tight.high / tight.step).ceil() * tight.step;
        Self { low, high, step: tight.step }
    }

    /// First value.
    pub(super) const fn low(&self) -> f64 {
        self.low
    }

    /// Last value.
    pub(super) const fn high(&self) -> f64 {
        self.high
    }

    /// Where a value lies, 0 at the low end, 1 at the high one; cut a little outside.
    pub(super) fn share(&self, value: f64) -> f64 {
        ((value - self.low) / (self.high - self.low)).clamp(-0.05, 1.05)
    }

    /// Marks and their labels from low to high.
    pub(super) fn marks(&self) -> Vec<(f64, String)> {
        const MOST: usize = 50;
        let first = (self.low / self.step - 1e-6).ceil();
        let mark = |i: usize| (first + i as f64) * self.step;
        let inside = |value: &f64| *value <= self.high + 1e-6 * self.step;
        (0..MOST).map(mark).take_while(inside).map(|v| (v, self.label(v))).collect()
    }

    fn label(&self, value: f64) -> String {
        let decimals = (-log10(self.step).floor()).clamp(0.0, 6.0) as usize;
        let value = (value / self.step).round() * self.step;
        let whole = log10(value.abs().max(1.0)).floor() as usize + 1;
        number(value, whole + decimals)
    }
}

/// The least 1, 2, 5 · 10ⁿ that is not below `step`.
pub(super) fn round_step(step: f64) -> f64 {
    let power = powf(10.0, log10(step.max(1e-12)).floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= step * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_inside() {
        let labels = |axis: Axis| axis.marks().into_iter().map(|m| m.1).collect::<Vec<_>>();
        assert_eq!(labels(Axis::new(0.0, 8.19, 6)), ["0", "2", "4", "6", "8"]);
        assert_eq!(
            labels(Axis::around([-0.31, 0.44].into_iter(), 4)),
            ["−0.4", "−0.2", "0.0", "0.2", "0.4", "0.6"]
        );
    }

    #[test]
    fn nothing_to_show_is_an_axis_too() {
        for axis in [
            Axis::around(std::iter::empty(), 4),
            Axis::around([3.0].into_iter(), 4),
            Axis::new(f64::NAN, 1.0, 4),
            Axis::new(0.0, f64::INFINITY, 4),
        ] {
            assert!(axis.high() > axis.low());
            assert!((1..20).contains(&axis.marks().len()), "{axis:?}");
        }
    }
}
