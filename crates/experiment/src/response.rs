//! What transfer functions answer to a step, an impulse or a ramp.

mod figure;
mod view;

use tracelight_linear::{
    Answer, Complex, Delayed, Ending, Extreme, LinearError, LoopMember, Response, StepInfo, Time,
    TransferFunction, logspace,
};
use tracelight_task::{Failure, Task};

use crate::closing::Around;
use crate::finding::Experiment;
use crate::named::Named;
use crate::numbers::two_digits;
use crate::systems::{Systems, bounded, not_measured};

/// Systems and what comes into them.
#[derive(Clone, Debug)]
pub struct Request {
    /// The systems.
    pub systems: Systems,
    /// What comes in, from rest at time 0.
    pub input: Input,
    /// A controller beside each system, which then is the plant of a loop; without one a loop that is closed has a controller of 1.
    pub controller: Option<String>,
    /// Where it comes in.
    pub enters: Enters,
    /// For how long, s; if not given, until all have settled and somewhat longer.
    pub duration_s: Option<f64>,
    /// How many values, evenly over that time; of samples each of them counts instead.
    pub points: u32,
}

/// What comes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// 1 from then on.
    Step,
    /// All at once, its integral over time 1; of samples one sample of 1.
    Impulse,
    /// Rising by 1 a second.
    Ramp,
}

/// Where what comes in does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enters {
    /// As the system's input, of a loop as its setpoint.
    Setpoint,
    /// As a disturbance at the plant's input: a load.
    PlantInput,
    /// As a disturbance at the plant's output.
    PlantOutput,
}

/// What each system answers.
pub struct Finding {
    of: Request,
    entries: Vec<Entry>,
}

/// A system and its answer.
struct Entry {
    named: Named,
    /// What is plotted.
    response: Response,
    /// Some values between those at its beginning, where much happens between them: times and values.
    early: Vec<(f64, f64)>,
    /// What it ends in, where that is known.
    ending: Option<Ending>,
    /// Its value furthest from zero, of all time.
    peak: Option<Extreme>,
    /// Of a step.
    info: Option<StepInfo>,
    /// Area of the impulse that goes straight through.
    impulse: f64,
    /// Poles that the output does not show.
    hidden: Vec<Complex>,
}

impl Input {
    const fn input(self) -> tracelight_linear::Input {
        match self {
            Self::Step => tracelight_linear::Input::Step,
            Self::Impulse => tracelight_linear::Input::Impulse,
            Self::Ramp => tracelight_linear::Input::Ramp,
        }
    }
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let systems = self.answering()?;
        bounded(self.points, systems.len())?;
        let own = || systems.iter().map(|named| shown(named, self.input)).fold(0.0, f64::max);
        let duration_s = self.duration_s.unwrap_or_else(own);
        let entries =
            systems.into_iter().map(|named| self.entry(named, duration_s)).collect::<Result<_, _>>()?;
        Ok(Finding { of: self, entries })
    }
}

impl Request {
    /// The systems whose answers are asked for.
    fn answering(&self) -> Result<Vec<Named>, Failure> {
        if self.controller.is_none() && self.enters == Enters::Setpoint {
            if self.systems.positive && !self.systems.closed {
                let message = "--positive is of a loop: close it with --closed, or name a --controller";
                return Err(Failure::usage("usage", message.to_owned()));
            }
            return self.systems.systems();
        }
        if self.controller.is_none() && !self.systems.closed {
            let message = "--disturbance is of a loop: close it with --closed, or name a --controller";
            return Err(Failure::usage("usage", message.to_owned()));
        }
        let formula = self.controller.clone().unwrap_or_else(|| "1".to_owned());
        let (member, what) = match self.enters {
            Enters::Setpoint => (LoopMember::Complementary, ", closed"),
            Enters::PlantInput => (LoopMember::Load, ", disturbed at the plant's input"),
            Enters::PlantOutput => (LoopMember::Sensitivity, ", disturbed at the plant's output"),
        };
        let plants = self.systems.opened()?.into_iter().map(not_measured);
        let answering = plants.map(|plant| {
            let plant = plant?;
            let controllers = self.systems.controllers(std::slice::from_ref(&formula))?;
            let controller =
                controllers.into_iter().next().map_or_else(|| Err(no_controller()), not_measured)?;
            let (name, open) = match &self.controller {
                Some(formula) => {
                    (format!("{} with {formula}{what}", plant.name), format!("{formula} {}", plant.name))
                }
                None => (format!("{}{what}", plant.name), plant.name.clone()),
            };
            Around::new(plant, controller, open, self.systems.positive)?.member(member, name)
        });
        answering.collect()
    }

    fn entry(&self, named: Named, duration_s: f64) -> Result<Entry, Failure> {
        let name = named.name.clone();
        let failed = |message: String| Failure::failed("no-such-system", format!("{name}: {message}"));
        let count = match named.system.time() {
            Time::Continuous => f64::from(self.points),
            Time::Sampled(period_s) => (duration_s / period_s).floor() + 1.0,
        };
        if !(2.0..=100_000.0).contains(&count) {
            return Err(failed(format!(
                "{duration_s} s are {count} samples; between 2 and 100000 of them are shown: choose another --duration"
            )));
        }
        let step_s = duration_s / f64::from(self.points - 1);
        let entry = match named.system.time() {
            Time::Continuous => continuous(named, self.input, step_s, count as usize),
            Time::Sampled(_) => sampled(named, self.input, count as usize),
        };
        entry.map_err(|e| failed(e.to_string()))
    }
}

fn no_controller() -> Failure {
    Failure::usage("usage", "--controller names none".to_owned())
}

/// For how long the answer of a system is shown, s; with a dead time so much longer.
fn shown(named: &Named, input: Input) -> f64 {
    match (&named.late, named.closed_late()) {
        (_, Some(closed)) => {
            let lasts_s = closed.lasts_s() + closed.late_s();
            let settled = closed.answer(input.input(), lasts_s).and_then(|answer| answer.step_info(BAND));
            settled.ok().and_then(|info| info.settle_s).map_or(lasts_s, |s| two_digits_up(1.35 * s))
        }
        (Some(late), None) => late.open.delay_s() + shown_s(late.open.rational(), input),
        (None, None) => shown_s(&named.system, input),
    }
}

/// For how long an answer is shown, s: until it has settled, and some more to see that it has; what does not settle as long as its modes
/// last.
fn shown_s(system: &TransferFunction, input: Input) -> f64 {
    const MORE: f64 = 1.35;
    let lasts_s = system.lasts_s();
    let settled_s = match input {
        Input::Step => system.step_info(BAND).ok().and_then(|info| info.settle_s),
        Input::Impulse => still_s(system, lasts_s),
        Input::Ramp => None,
    };
    let least_s = match system.time() {
        Time::Continuous => 0.0,
        // as many samples as show its order
        Time::Sampled(period_s) => period_s * (2 * system.denominator().degree() + 2) as f64,
    };
    match settled_s {
        Some(s) if s > 0.0 => two_digits_up(MORE * s).max(least_s),
        _ => lasts_s,
    }
}

/// From when on the answer to an impulse stays within a share of its largest value, s; none if it does not, within a time.
fn still_s(system: &TransferFunction, within_s: f64) -> Option<f64> {
    const COUNT: u32 = 2000;
    let values: Vec<f64> = match system.time() {
        Time::Continuous => {
            let transient = system.transient(tracelight_linear::Input::Impulse).ok()?;
            (0..=COUNT).map(|k| transient.at(within_s * f64::from(k) / f64::from(COUNT))).collect()
        }
        Time::Sampled(period_s) => {
            samples(system, Input::Impulse, (within_s / period_s).clamp(2.0, 1e5) as usize).ok()?.values
        }
    };
    let most = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
    let last = values.iter().rposition(|value| value.abs() > BAND * most)?;
    let share = (last + 1) as f64 / values.len() as f64;
    (share < 0.9).then_some(share * within_s)
}

/// The next number of two digits, not below.
fn two_digits_up(value: f64) -> f64 {
    let nearest = two_digits(value);
    if nearest >= value { nearest } else { two_digits(1.05 * value) }
}

/// Within this share of its final value it is settled.
const BAND: f64 = 0.02;

fn continuous(named: Named, input: Input, step_s: f64, count: usize) -> Result<Entry, LinearError> {
    let duration_s = count as f64 * step_s;
    let answer = match (&named.late, named.closed_late()) {
        (_, Some(closed)) => closed.answer(input.input(), duration_s.max(closed.lasts_s()))?,
        (Some(late), None) => late.open.answer(input.input())?,
        (None, None) => Delayed::from(named.system.clone()).answer(input.input())?,
    };
    let values = (0..count).map(|k| answer.at(k as f64 * step_s)).collect();
    let info = if input == Input::Step { Some(answer.step_info(BAND)?) } else { None };
    Ok(Entry {
        early: early(&answer, info, step_s),
        response: Response { step_s, values },
        ending: Some(answer.ending()),
        peak: info.map_or_else(|| answer.peak(), |info| Ok(info.peak))?,
        info,
        impulse: answer.impulse(),
        hidden: answer.hidden().to_vec(),
        named,
    })
}

/// Values at its beginning, evenly on a logarithmic scale, where it rises or peaks within some steps.
fn early(answer: &Answer, info: Option<StepInfo>, step_s: f64) -> Vec<(f64, f64)> {
    const STEPS: f64 = 20.0;
    const BEFORE: f64 = 0.05;
    const COUNT: usize = 2000;
    let peak_s = info.and_then(|info| info.peak).and_then(|peak| peak.time_s);
    let rise_s = info.and_then(|info| info.rise_s);
    let first_s = peak_s.into_iter().chain(rise_s).filter(|s| *s > 0.0).fold(f64::INFINITY, f64::min);
    if first_s > STEPS * step_s {
        return Vec::new();
    }
    logspace((BEFORE * first_s, STEPS * step_s), COUNT).into_iter().map(|s| (s, answer.at(s))).collect()
}

fn sampled(named: Named, input: Input, count: usize) -> Result<Entry, LinearError> {
    let response = samples(&named.system, input, count)?;
    let info = if input == Input::Step { Some(named.system.step_info(BAND)?) } else { None };
    let (ending, peak) = (info.map(|info| info.ending), info.and_then(|info| info.peak));
    Ok(Entry { named, response, early: Vec::new(), ending, peak, info, impulse: 0.0, hidden: Vec::new() })
}

fn samples(system: &TransferFunction, input: Input, count: usize) -> Result<Response, LinearError> {
    let period_s = match system.time() {
        Time::Continuous => 1.0,
        Time::Sampled(period_s) => period_s,
    };
    let input = |k: usize| match input {
        Input::Step => 1.0,
        Input::Impulse if k == 0 => 1.0,
        Input::Impulse => 0.0,
        Input::Ramp => k as f64 * period_s,
    };
    system.response(period_s, &(0..count).map(input).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown_of(text: &str) -> f64 {
        shown_s(&TransferFunction::parse(text, Time::Continuous).unwrap(), Input::Step)
    }

    #[test]
    fn an_answer_is_shown_until_it_has_settled_and_not_much_longer() {
        for text in ["1/(s+1)", "1/(s^2+0.4s+1)", "1/((s+1)(s+50))", "(1-s)/(s+1)^2", "100/(s+7)^3"] {
            let system = TransferFunction::parse(text, Time::Continuous).unwrap();
            let settled = system.step_info(BAND).unwrap().settle_s.unwrap();
            let share = settled / shown_of(text);
            assert!((0.65..0.8).contains(&share), "{text}: {share}");
        }
        // what grows, and what is constant
        assert!(shown_of("1/s") > 0.0 && shown_of("1/(s-1)") > 1.0 && shown_of("7") > 0.0);
        assert!((two_digits_up(1.21) - 1.3).abs() < 1e-12 && (two_digits_up(0.0999) - 0.1).abs() < 1e-12);
    }
}
