//! A transfer function of a loop: what it makes of sines, and of steps, impulses and ramps.

use tracelight_maths::complex;

use crate::dead_time::{Parts, Place};
use crate::feedback::around::{FeedbackLoop, LoopMember};
use crate::{
    Answer, Complex, Delayed, Ending, FrequencyResponse, GrowingPoles, Input, LinearError, Polynomial, Time,
    TransferFunction,
};

/// M e^(−sθ) / (D + N e^(−sT)): one of the four transfer functions of a loop whose open loop is N e^(−sT)/D.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopFunction {
    of: FeedbackLoop,
    member: LoopMember,
    above: Polynomial,
    late_s: f64,
    /// The function without a dead time in the loop.
    rational: Option<TransferFunction>,
}

impl FeedbackLoop {
    /// One of its four transfer functions.
    pub fn function(&self, member: LoopMember) -> LoopFunction {
        LoopFunction::new(self.clone(), member)
    }
}

impl LoopFunction {
    fn new(of: FeedbackLoop, member: LoopMember) -> Self {
        let (above, late_s) = of.above(member);
        let open = of.open.rational();
        let below = open.denominator() + open.numerator();
        let rational = (of.open.delay_s() == 0.0)
            .then(|| TransferFunction::new(above.clone(), below, of.time()).ok())
            .flatten();
        Self { of, member, above, late_s, rational }
    }

    /// The loop that has it, opened.
    pub const fn open(&self) -> &Delayed {
        &self.of.open
    }

    /// Which of the four.
    pub const fn member(&self) -> LoopMember {
        self.member
    }

    /// Whether the loop is of positive feedback.
    pub const fn is_positive(&self) -> bool {
        self.of.sign < 0.0
    }

    /// The function itself, if the loop has no dead time: with all poles, none cancelled.
    pub const fn rational(&self) -> Option<&TransferFunction> {
        self.rational.as_ref()
    }

    /// A rational function that is nearly the same: the loop's dead times approximated by Padé's method in that order.
    ///
    /// # Errors
    /// As [`Delayed::approximated`], and as [`FeedbackLoop::new`].
    pub fn approximated(&self, order: usize) -> Result<TransferFunction, LinearError> {
        let near = |part: &Delayed| -> Result<Delayed, LinearError> {
            if part.delay_s() == 0.0 { Ok(part.clone()) } else { Ok(part.approximated(order)?.into()) }
        };
        let near = FeedbackLoop::new(near(&self.of.plant)?, near(&self.of.controller)?, self.is_positive())?;
        let function = near.function(self.member);
        function.rational.ok_or(LinearError::NotFinite)
    }

    /// How many poles of the loop grow: those that this function does not show count as well.
    pub fn growing(&self) -> GrowingPoles {
        self.of.open.closed_growing()
    }

    /// How many more poles than zeros; negative the other way round.
    pub(super) fn relative_degree(&self) -> i64 {
        let open = self.of.open.rational();
        open.denominator().degree().max(open.numerator().degree()) as i64 - self.above.degree() as i64
    }

    /// What is above, over the open loop's denominator.
    pub(super) fn forward(&self) -> Option<TransferFunction> {
        TransferFunction::new(
            self.above.clone(),
            self.of.open.rational().denominator().clone(),
            self.of.time(),
        )
        .ok()
    }

    /// Value at a frequency, rad/s.
    pub fn at_frequency(&self, rad_s: f64) -> Complex {
        let time = self.of.time();
        if let Some(rational) = &self.rational {
            return rational.at(time.at_frequency(rad_s));
        }
        let s = time.at_frequency(rad_s);
        let open = self.of.open.rational();
        let late = |delay_s: f64| complex::from_polar(1.0, -rad_s * delay_s);
        let below = open.denominator().at(s) + open.numerator().at(s) * late(self.of.open.delay_s());
        self.above.at(s) * late(self.late_s) / below
    }

    /// At each of these frequencies, rad/s, which rise; with a dead time its phase is followed from the first.
    pub fn frequency_response(&self, rad_s: Vec<f64>) -> FrequencyResponse {
        /// Turn of the dead time from value to value, rad, and most values between two frequencies.
        const TURN: f64 = 0.2;
        const MOST_BETWEEN: f64 = 1000.0;
        if let Some(rational) = &self.rational {
            return rational.frequency_response(rad_s);
        }
        let values: Vec<Complex> = rad_s.iter().map(|w| self.at_frequency(*w)).collect();
        let mut phases_rad: Vec<f64> = Vec::with_capacity(values.len());
        for (i, value) in values.iter().enumerate() {
            let phase = match i.checked_sub(1) {
                None => complex::arg(*value),
                Some(before) => {
                    let (from, to) = (rad_s[before], rad_s[i]);
                    let turns = (to - from) * self.of.open.delay_s() / TURN;
                    let count = turns.ceil().clamp(8.0, MOST_BETWEEN) as u32;
                    let at = |k: u32| self.at_frequency(from + (to - from) * f64::from(k) / f64::from(count));
                    let turned: f64 = (1..=count).map(|k| complex::arg(at(k) / at(k - 1))).sum();
                    phases_rad[before] + turned
                }
            };
            phases_rad.push(phase);
        }
        FrequencyResponse { rad_s, values, phases_rad }
    }

    /// What a constant comes out as, times it.
    pub fn dc_gain(&self) -> f64 {
        if let Some(rational) = &self.rational {
            return rational.dc_gain();
        }
        let open = self.of.open.rational();
        self.above.constant() / (open.denominator().constant() + open.numerator().constant())
    }

    /// What comes out, from rest, for that long, s; of samples see [`rational`](Self::rational).
    ///
    /// # Errors
    /// As [`Delayed::closed_answer`].
    pub fn answer(&self, input: Input, duration_s: f64) -> Result<Answer, LinearError> {
        if let Some(rational) = &self.rational {
            return Delayed::from(rational.clone()).answer(input);
        }
        let (plant, controller) = (&self.of.plant, &self.of.controller);
        let (first, second, place) = match self.member {
            LoopMember::Sensitivity => (controller, plant, Place::End),
            LoopMember::Complementary => (controller, plant, Place::Start),
            LoopMember::Load => (controller, plant, Place::Middle),
            LoopMember::Control => (plant, controller, Place::Middle),
        };
        let parts = Parts { first, second, sign: self.of.sign, place, late_s: self.late_s };
        Delayed::loop_answer(parts, input, self.ending(input), duration_s)
    }

    fn ending(&self, input: Input) -> Ending {
        match (self.growing(), input) {
            (GrowingPoles::Count(0), Input::Impulse) => Ending::Converges(0.0),
            (GrowingPoles::Count(0), Input::Step) => Ending::Converges(self.dc_gain()),
            // what it is at rest is nothing: its slope there is what a ramp comes to
            (GrowingPoles::Count(0), Input::Ramp) if self.above.constant() == 0.0 => {
                let open = self.of.open.rational();
                let below = open.denominator().constant() + open.numerator().constant();
                Ending::Converges(self.above.coefficient(1) / below)
            }
            (GrowingPoles::Edge(0) | GrowingPoles::Undefined, _) => Ending::Undecided,
            _ => Ending::Diverges,
        }
    }

    /// How long a plot of its answers has to be, s.
    pub fn lasts_s(&self) -> f64 {
        match &self.rational {
            Some(rational) => rational.lasts_s(),
            None => self.of.open.closed_lasts_s(),
        }
    }

    /// How late it is whatever comes, s.
    pub const fn late_s(&self) -> f64 {
        self.late_s
    }

    /// Its time.
    pub const fn time(&self) -> Time {
        self.of.time()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(text: &str, delay_s: f64) -> Delayed {
        Delayed::new(TransferFunction::parse(text, Time::Continuous).unwrap(), delay_s).unwrap()
    }

    #[test]
    fn the_four_are_what_the_loop_says() {
        for (delay_s, is_positive) in [(0.0, false), (0.3, false), (0.0, true), (0.3, true)] {
            let (plant, controller) = (part("2/(s+1)", delay_s), part("0.3 (s+2)/(s+5)", 0.1 * delay_s));
            let of = FeedbackLoop::new(plant.clone(), controller.clone(), is_positive).unwrap();
            for w in [0.03, 1.0, 7.0] {
                let (p, c) = (plant.at_frequency(w), controller.at_frequency(w));
                let below = if is_positive { 1.0 - p * c } else { 1.0 + p * c };
                let expected = [1.0 / below, p * c / below, p / below, c / below];
                for (member, expected) in LoopMember::ALL.into_iter().zip(expected) {
                    let value = of.function(member).at_frequency(w);
                    assert!(complex::norm(value - expected) < 1e-13, "{member:?} at {w}: {value} {expected}");
                }
            }
        }
    }

    /// What the four answer with a short dead time, beside a loop whose dead time is Padé's of high order.
    #[test]
    fn answers_with_a_dead_time_are_nearly_those_of_a_high_approximation() {
        let of = FeedbackLoop::new(part("2/(s+1)", 0.2), part("0.8 (s+2)/s", 0.1), false).unwrap();
        for member in LoopMember::ALL {
            let function = of.function(member);
            for input in [Input::Step, Input::Ramp] {
                let answer = function.answer(input, 40.0).unwrap();
                let near = Delayed::from(function.approximated(9).unwrap()).answer(input).unwrap();
                for t in [0.7, 1.3, 2.9, 11.0, 39.0] {
                    let (value, near) = (answer.at(t), near.at(t));
                    assert!((value - near).abs() < 2e-4, "{member:?} {input:?} at {t}: {value} {near}");
                }
                if let Ending::Converges(value) = answer.ending() {
                    assert!((answer.at(40.0) - value).abs() < 1e-6, "{member:?} {input:?}: {value}");
                }
            }
        }
    }

    #[test]
    fn a_loop_that_answers_without_bounds_is_refused() {
        let refused = FeedbackLoop::of(part("-1", 0.0), false);
        assert_eq!(refused.unwrap_err(), LinearError::AlgebraicLoop);
        assert_eq!(FeedbackLoop::of(part("1", 0.0), true).unwrap_err(), LinearError::AlgebraicLoop);
    }
}
