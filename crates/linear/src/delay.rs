use crate::{Margins, Stability, Time, TransferFunction};

/// For how long a loop that is closed by negative feedback may be late.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DelayMargin {
    /// The shortest delay that makes it oscillate, s, and at which frequency, rad/s.
    Delay {
        /// Delay, s.
        delay_s: f64,
        /// Frequency, rad/s.
        rad_s: f64,
    },
    /// Any delay, however short, makes the loop unstable: the open loop's gain is 1 or more at infinite frequency.
    Zero,
    /// No delay does: the open loop's gain is nowhere 1.
    Unlimited,
    /// The loop is unstable without a delay, or may be: there is no margin.
    Unstable,
    /// Measured data do not say whether the loop is stable, and its gain is nowhere 1.
    Unknown,
}

impl DelayMargin {
    /// The margin as a number, s, if it is one.
    pub const fn delay_s(self) -> Option<f64> {
        match self {
            Self::Delay { delay_s, .. } => Some(delay_s),
            Self::Zero => Some(0.0),
            Self::Unlimited | Self::Unstable | Self::Unknown => None,
        }
    }
}

impl TransferFunction {
    /// For how long this open loop, whose margins these are, may be late once it is closed.
    pub fn delay_margin(&self, margins: &Margins) -> DelayMargin {
        let Ok(closed) = self.closed() else { return DelayMargin::Unstable };
        if closed.stability() != Stability::Stable {
            return DelayMargin::Unstable;
        }
        let at_infinity = match self.relative_degree() {
            0 => self.numerator().leading().abs(),
            excess if excess < 0 => f64::INFINITY,
            _ => 0.0,
        };
        match margins.least_delay() {
            _ if self.time() == Time::Continuous && at_infinity >= 1.0 => DelayMargin::Zero,
            Some(margin) => DelayMargin::Delay { delay_s: margin.delay_s, rad_s: margin.rad_s },
            None => DelayMargin::Unlimited,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> DelayMargin {
        let open = TransferFunction::parse(text, Time::Continuous).unwrap();
        open.delay_margin(&open.margins())
    }

    #[test]
    fn a_delay_margin_is_none_zero_or_without_end_where_it_is() {
        assert_eq!(of("10/(s(s+1)(s+2))"), DelayMargin::Unstable);
        // s = (ln 2 + jπ)/T is unstable for every delay T
        assert_eq!(of("(2s+0.5)/(s+1)"), DelayMargin::Zero);
        assert_eq!(of("s^2/(s+1)"), DelayMargin::Zero);
        assert_eq!(of("0.5/(s+1)"), DelayMargin::Unlimited);
        // an integrator is late by a quarter of a turn already: π/2 at 1 rad/s
        let DelayMargin::Delay { delay_s, rad_s } = of("1/s") else { panic!("it has one") };
        assert!((delay_s - std::f64::consts::FRAC_PI_2).abs() < 1e-12 && (rad_s - 1.0).abs() < 1e-12);
    }
}
