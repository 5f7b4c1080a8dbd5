//! What a system with a dead time, or the loop it makes, answers, and the figures of that.

use tracelight_maths::{complex, ln};

use super::chain::{Chain, Parts};
use super::search::{highest, turned};
use super::steps::Steps;
use super::{Delayed, GrowingPoles};
use crate::transient::{Ending, Extreme, Input, StepInfo, Transient};
use crate::{Complex, LinearError};

/// What comes out, from rest.
#[derive(Clone, Debug)]
pub struct Answer {
    form: Form,
    ending: Ending,
}

#[derive(Clone, Debug)]
enum Form {
    /// In modes, so much later.
    Late(Transient, f64),
    /// Of a closed loop.
    Steps(Steps),
}

impl Delayed {
    /// What this system answers.
    ///
    /// # Errors
    /// As [`TransferFunction::transient`](crate::TransferFunction::transient).
    pub fn answer(&self, input: Input) -> Result<Answer, LinearError> {
        let transient = self.rational.transient(input)?;
        let ending = transient.ending();
        Ok(Answer { form: Form::Late(transient, self.delay_s), ending })
    }

    /// What this loop answers once it is closed by negative feedback, for that long, s: values are good to 1e-9 of the largest, unless
    /// [`Answer::accuracy`] says otherwise.
    ///
    /// # Errors
    /// [`LinearError::Improper`] with more zeros than poles; [`LinearError::AlgebraicLoop`]; [`LinearError::Wish`] where the dead time is
    /// too small a part of that time.
    pub fn closed_answer(&self, input: Input, duration_s: f64) -> Result<Answer, LinearError> {
        if self.delay_s == 0.0 {
            return Self::from(self.rational.closed()?).answer(input);
        }
        let ending = self.closed_ending(input);
        Ok(Answer { form: Form::Steps(Steps::closed(&Chain::of(self)?, input, duration_s)?), ending })
    }

    /// What a loop of two parts with a dead time answers, and ends in, for that long, s; as [`closed_answer`](Self::closed_answer).
    pub(crate) fn loop_answer(
        parts: Parts<'_>,
        input: Input,
        ending: Ending,
        duration_s: f64,
    ) -> Result<Answer, LinearError> {
        let steps = Steps::closed(&Chain::of_parts(parts)?, input, duration_s)?;
        Ok(Answer { form: Form::Steps(steps), ending })
    }

    fn closed_ending(&self, input: Input) -> Ending {
        match (self.closed_growing(), input) {
            (GrowingPoles::Count(0), Input::Impulse) => Ending::Converges(0.0),
            (GrowingPoles::Count(0), Input::Step) => Ending::Converges(self.closed_gain()),
            (GrowingPoles::Count(0), Input::Ramp) if self.closed_gain() != 0.0 => Ending::Diverges,
            (GrowingPoles::Edge(0) | GrowingPoles::Undefined | GrowingPoles::Count(0), _) => {
                Ending::Undecided
            }
            _ => Ending::Diverges,
        }
    }

    /// What a constant comes out as of the closed loop.
    fn closed_gain(&self) -> f64 {
        let open = self.rational.dc_gain();
        if open.is_infinite() { 1.0 } else { open / (1.0 + open) }
    }

    /// Poles of the closed loop that decay slowest or grow, the worst first: those that Padé's approximation leads to. There are
    /// infinitely many more.
    pub fn closed_poles(&self) -> Vec<Complex> {
        const ORDER: usize = 9;
        let near = self.approximated(ORDER).and_then(|open| open.closed()).map(|closed| closed.poles());
        let mut found: Vec<Complex> = Vec::new();
        for pole in near.unwrap_or_default().into_iter().filter_map(|pole| self.refined_pole(pole)) {
            if !found.iter().any(|other| complex::norm(pole - other) <= 1e-7 * (1e-9 + complex::norm(pole))) {
                found.push(pole);
            }
        }
        found.sort_by(|a, b| {
            b.re.total_cmp(&a.re).then(a.im.abs().total_cmp(&b.im.abs())).then(b.im.total_cmp(&a.im))
        });
        found
    }

    /// Newton's iteration on D + N e^(−sT); none if it leads far away or nowhere.
    fn refined_pole(&self, near: Complex) -> Option<Complex> {
        let (above, below) = (self.rational.numerator(), self.rational.denominator());
        let (above_slope, below_slope) = (above.derivative(), below.derivative());
        let mut place = near;
        for _ in 0..30 {
            let late = complex::exp(-place * self.delay_s);
            let value = below.at(place) + above.at(place) * late;
            let slope =
                below_slope.at(place) + (above_slope.at(place) - above.at(place) * self.delay_s) * late;
            let step = value / slope;
            if !step.is_finite() {
                return None;
            }
            place -= step;
            if complex::norm(step) <= 1e-13 * complex::norm(place) + 1e-300 {
                let is_near = complex::norm(place - near) <= 0.2 * complex::norm(near) + 1e-9;
                // what rounding alone moves off the real axis
                let on_axis = place.im.abs() <= 1e-12 * complex::norm(place);
                return is_near.then(|| if on_axis { place.re.into() } else { place });
            }
        }
        None
    }

    /// How long a plot of what the closed loop answers has to be, s.
    pub fn closed_lasts_s(&self) -> f64 {
        /// Dead times that are waited for where no pole says more.
        const DELAYS: f64 = 20.0;
        if self.delay_s == 0.0 {
            return self.rational.closed().map_or(1.0, |closed| closed.lasts_s());
        }
        let slowest = self.closed_poles().first().map_or(0.0, |pole| pole.re.abs());
        let lasts_s = if slowest > 0.0 { ln(1e3) / slowest } else { 0.0 };
        lasts_s.clamp(5.0 * self.delay_s, 1e3 * DELAYS * self.delay_s)
    }
}

impl Answer {
    /// What it does in the long run.
    pub const fn ending(&self) -> Ending {
        self.ending
    }

    /// The output at a moment, s; of a closed loop no later than what was asked for.
    pub fn at(&self, time_s: f64) -> f64 {
        match &self.form {
            Form::Late(_, delay_s) if time_s < *delay_s => 0.0,
            Form::Late(transient, delay_s) => transient.at(time_s - delay_s),
            Form::Steps(steps) => steps.at(time_s),
        }
    }

    /// Share of the largest value by which values of a closed loop may be off; 0 of what is in modes.
    pub const fn accuracy(&self) -> f64 {
        match &self.form {
            Form::Late(..) => 0.0,
            Form::Steps(steps) => steps.accuracy,
        }
    }

    /// Area of the impulse that goes straight through.
    pub fn impulse(&self) -> f64 {
        match &self.form {
            Form::Late(transient, _) => transient.impulse(),
            Form::Steps(steps) => steps.impulse,
        }
    }

    /// Poles that the output does not show, of an open system.
    pub fn hidden(&self) -> &[Complex] {
        match &self.form {
            Form::Late(transient, _) => transient.hidden(),
            Form::Steps(_) => &[],
        }
    }

    /// Figures of a response to a step; settled is within that share of the final value.
    ///
    /// # Errors
    /// As [`Transient::step_info`].
    pub fn step_info(&self, band: f64) -> Result<StepInfo, LinearError> {
        match &self.form {
            Form::Late(transient, delay_s) => {
                let later = |time_s: f64| time_s + delay_s;
                let mut info = transient.step_info(band)?;
                info.settle_s = info.settle_s.map(later);
                info.peak = info.peak.map(|peak| Extreme { time_s: peak.time_s.map(later), ..peak });
                Ok(info)
            }
            Form::Steps(steps) => Ok(figures(steps, self.ending, band)),
        }
    }

    /// Value furthest from zero, if it converges.
    ///
    /// # Errors
    /// As [`Transient::peak`].
    pub fn peak(&self) -> Result<Option<Extreme>, LinearError> {
        match &self.form {
            Form::Late(transient, delay_s) => Ok(transient
                .peak()?
                .map(|peak| Extreme { time_s: peak.time_s.map(|time_s| time_s + delay_s), ..peak })),
            Form::Steps(steps) => Ok(self.ending.value().map(|goal| peak(steps, goal))),
        }
    }
}

fn peak(steps: &Steps, goal: f64) -> Extreme {
    let [above, below] = [1.0, -1.0].map(|sign| furthest(steps, sign, goal));
    if below.value.abs() > above.value.abs() { below } else { above }
}

fn figures(steps: &Steps, ending: Ending, band: f64) -> StepInfo {
    let mut info = StepInfo::none(ending);
    let Some(goal) = ending.value() else { return info };
    info.peak = Some(peak(steps, goal));
    if goal != 0.0 {
        let sign = goal.signum();
        let (beyond, below) = (furthest(steps, sign, goal), furthest(steps, -sign, goal));
        info.overshoot_percent = Some(100.0 * (beyond.value / goal - 1.0).max(0.0));
        info.undershoot_percent = Some(100.0 * (-below.value / goal).max(0.0));
        let first = |share: f64| first(steps, |value| value / goal >= share);
        info.rise_s = Some((first(0.1), first(0.9))).and_then(|(from, to)| Some(to? - from?));
        info.settle_s = last(steps, |value| (value / goal - 1.0).abs() <= band);
    }
    info
}

/// Furthest value to one side; the final value if none is further.
fn furthest(steps: &Steps, sign: f64, goal: f64) -> Extreme {
    let mut best = Extreme { value: 0.0, time_s: Some(0.0) };
    let mut at = 0;
    for (i, (time_s, value)) in steps.nodes().enumerate() {
        if sign * value > sign * best.value {
            best = Extreme { value, time_s: Some(time_s) };
            at = i;
        }
    }
    // between its neighbours, where the polynomial goes on
    let times: Vec<f64> =
        steps.nodes().skip(at.saturating_sub(1)).take(3).map(|(time_s, _)| time_s).collect();
    if let (Some(&from), Some(&to)) = (times.first(), times.last()) {
        let time_s = highest(|time_s| sign * steps.at(time_s), from, to);
        if sign * steps.at(time_s) > sign * best.value {
            best = Extreme { value: steps.at(time_s), time_s: Some(time_s) };
        }
    }
    if sign * goal > sign * best.value { Extreme { value: goal, time_s: None } } else { best }
}

/// The first moment at which something holds.
fn first(steps: &Steps, holds: impl Fn(f64) -> bool) -> Option<f64> {
    let mut before = 0.0;
    for (time_s, value) in steps.nodes() {
        if holds(value) {
            return Some(turned(|time_s| holds(steps.at(time_s)), before, time_s));
        }
        before = time_s;
    }
    None
}

/// From when on it always holds.
fn last(steps: &Steps, holds: impl Fn(f64) -> bool) -> Option<f64> {
    let nodes: Vec<(f64, f64)> = steps.nodes().collect();
    match nodes.iter().rposition(|(_, value)| !holds(*value)) {
        None => Some(0.0),
        Some(at) => {
            nodes.get(at + 1).map(|(after, _)| turned(|time_s| holds(steps.at(time_s)), nodes[at].0, *after))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Time, TransferFunction};

    fn delayed(text: &str, delay_s: f64) -> Delayed {
        Delayed::new(TransferFunction::parse(text, Time::Continuous).unwrap(), delay_s).unwrap()
    }

    #[test]
    fn an_open_system_answers_the_same_and_later() {
        let late = delayed("4/(s^2+s+4)", 0.7);
        let now = late.rational().transient(Input::Step).unwrap().step_info(0.02).unwrap();
        let answer = late.answer(Input::Step).unwrap();
        let info = answer.step_info(0.02).unwrap();
        assert_eq!(info.rise_s, now.rise_s);
        assert_eq!(info.settle_s, now.settle_s.map(|s| s + 0.7));
        assert_eq!(info.peak.unwrap().time_s, now.peak.unwrap().time_s.map(|s| s + 0.7));
        assert_eq!(
            (answer.at(0.69), answer.at(0.7 + 1.0)),
            (0.0, late.rational().transient(Input::Step).unwrap().at(1.0))
        );
    }

    #[test]
    fn a_closed_loop_is_nearly_that_of_a_high_approximation() {
        let late = delayed("2/(s(s+2))", 0.3);
        let answer = late.closed_answer(Input::Step, late.closed_lasts_s()).unwrap();
        let info = answer.step_info(0.02).unwrap();
        let rational = late.approximated(9).unwrap().closed().unwrap().step_info(0.02).unwrap();
        assert_eq!(info.ending, Ending::Converges(1.0));
        let near = |a: Option<f64>, b: Option<f64>| (a.unwrap() - b.unwrap()).abs() < 1e-4;
        assert!(near(info.overshoot_percent, rational.overshoot_percent), "{info:?} {rational:?}");
        assert!(
            near(info.rise_s, rational.rise_s) && near(info.settle_s, rational.settle_s),
            "{info:?} {rational:?}"
        );
        let peaks = [info, rational].map(|info| info.peak.unwrap());
        assert!((peaks[0].value - peaks[1].value).abs() < 1e-6);
    }

    /// s = W(−T)/T of s + e^(−sT) = 0, Lambert's function.
    #[test]
    fn poles_of_a_late_integrator_are_lamberts() {
        let worst = delayed("1/s", 1.0).closed_poles()[0];
        assert!((worst.re + 0.318_131_505_204_764_1).abs() < 1e-12, "{worst}");
        assert!((worst.im - 1.337_235_701_430_689_4).abs() < 1e-12, "{worst}");
    }

    #[test]
    fn what_has_no_final_value_has_no_figures() {
        let late = delayed("1/s", 2.0);
        let answer = late.closed_answer(Input::Step, 30.0).unwrap();
        assert_eq!(answer.ending(), Ending::Diverges);
        assert_eq!(answer.step_info(0.02).unwrap().overshoot_percent, None);
        assert!((answer.at(29.9)).abs() > 2.0);
    }
}
