//! State feedback that costs least, with weights on the states: u = −K x, and what it does.

use tracelight_chart::Theme;
use tracelight_linear::{
    Complex, Discretization, Input, LinearError, Margins, Matrix, Polynomial, Response, Stability,
    StateSpace, StepInfo, Time, TransferFunction,
};
use tracelight_maths::{exp, powi};
use tracelight_task::{Failure, Task};

use super::{MOST_ORDER, settled_step};
use crate::finding::Experiment;
use crate::systems::OneSystem;

/// A system whose state is fed back, and by what it is weighed.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is controlled.
    pub system: OneSystem,
    /// What the states and the input cost.
    pub weights: Weights,
    /// What the output's integral over time costs: a weight, or its largest allowed value as those of the states are; none: it does not
    /// integrate.
    pub integral: Option<f64>,
}

/// What the states and the input cost.
#[derive(Clone, Debug)]
pub enum Weights {
    /// The diagonal of Q, of each state or by name, and R.
    Given(Vec<Entry>, f64),
    /// Largest allowed deviations of states and of the input: each costs as much as the others where it is reached (Bryson's rule).
    Largest(Vec<Entry>, f64),
}

/// A number for a state: the one of that name, or the next.
pub type Entry = (Option<String>, f64);

/// State feedback, and its loop.
pub struct Finding {
    pub(super) name: String,
    pub(super) plant: TransferFunction,
    /// Of the states, the integral last.
    pub(super) names: Vec<String>,
    pub(super) q: Vec<f64>,
    pub(super) r: f64,
    pub(super) gain: Vec<f64>,
    /// Before the setpoint, so that the output comes to it; none with an integral.
    pub(super) prefilter: Option<f64>,
    /// The loop cut at the plant's input.
    pub(super) open: TransferFunction,
    pub(super) margins: Margins,
    pub(super) poles: Vec<Complex>,
    pub(super) stability: Stability,
    /// A step of the setpoint: output and input.
    pub(super) step: Response,
    pub(super) input: Response,
    pub(super) info: StepInfo,
    pub(super) allowed: Option<Allowed>,
    pub(super) time: Time,
    pub(super) theme: Theme,
}

/// What was allowed, and what is reached from the first state's largest deviation.
pub(super) struct Allowed {
    /// Of the states, then of the input.
    pub(super) most: Vec<f64>,
    pub(super) reached: Vec<f64>,
    /// With this R the input stays within what is allowed.
    pub(super) nearest_r: Option<f64>,
}

impl Experiment for Request {
    type Finding = Finding;

    fn run(self, _: Task<'_>) -> Result<Finding, Failure> {
        let named = self.system.system()?;
        let (name, plant) = (named.name, named.system);
        let failed = |e: LinearError| Failure::failed("no-such-design", format!("{name}: {e}"));
        let states = self.states().map_err(|e| match e {
            Ok(failure) => failure,
            Err(e) => failed(e),
        })?;
        if states.order() > MOST_ORDER {
            let message = format!("{name} is of order {}; at most {MOST_ORDER} will do", states.order());
            return Err(Failure::failed("no-such-design", message));
        }
        let mut names = names(&plant, states.order());
        let whole = match self.integral {
            Some(_) => {
                names.push("integral".to_owned());
                states.with_integrals().map_err(failed)?
            }
            None => states.clone(),
        };
        let (numbers, of_input) = match &self.weights {
            Weights::Given(entries, r) | Weights::Largest(entries, r) => (entries, *r),
        };
        let mut numbers = by_state(numbers, &names[..states.order()])?;
        numbers.extend(self.integral);
        let is_largest = matches!(self.weights, Weights::Largest(..));
        let (q, r) = if is_largest {
            // a state without a largest deviation costs nothing
            let weight = |most: &f64| if *most == 0.0 { 0.0 } else { powi(*most, -2) };
            (numbers.iter().map(weight).collect(), powi(of_input, -2))
        } else {
            (numbers.clone(), of_input)
        };
        let loops = Loops { states: &states, whole: &whole, q: &q, integrates: self.integral.is_some() };
        let allowed = is_largest.then(|| loops.allowed(r, &numbers, of_input)).transpose().map_err(failed)?;
        loops.finding((name.clone(), plant), (names, r, allowed), self.system.theme).map_err(failed)
    }
}

impl Request {
    /// The plant with states that have a meaning: of samples those of the plant in continuous time.
    fn states(&self) -> Result<StateSpace, Result<Failure, LinearError>> {
        let Some((period_s, how)) = self.system.how.sampling else {
            let plant = self.system.system().map_err(Ok)?.system;
            return plant.phase_variables().map_err(Err);
        };
        if how != Discretization::ZeroOrderHold {
            let message = "lqr samples the states by a hold: leave --method out";
            return Err(Ok(Failure::usage("usage", message)));
        }
        let mut continuous = self.system.clone();
        continuous.how.sampling = None;
        let plant = continuous.system().map_err(Ok)?.system;
        let states = plant.phase_variables().map_err(Err)?;
        states.sampled(period_s, Discretization::ZeroOrderHold).map_err(Err)
    }
}

/// The output and its derivatives, where there are no zeros; else numbers.
fn names(plant: &TransferFunction, order: usize) -> Vec<String> {
    let is_chain = plant.numerator().degree() == 0 || matches!(plant.time(), Time::Sampled(_));
    let name = |k: usize| match k {
        0 => "y".to_owned(),
        1 => "dy".to_owned(),
        k => format!("d{k}y"),
    };
    if is_chain { (0..order).map(name).collect() } else { (1..=order).map(|k| format!("x{k}")).collect() }
}

/// A number for each state; 0 of those that are not named.
fn by_state(entries: &[Entry], names: &[String]) -> Result<Vec<f64>, Failure> {
    let known = names.join(", ");
    if entries.iter().all(|(name, _)| name.is_none()) {
        if entries.len() != names.len() {
            let message = format!(
                "{} numbers for {} states: give one for each of {known}, or by name, such as {}=1",
                entries.len(),
                names.len(),
                names[0]
            );
            return Err(Failure::usage("usage", message));
        }
        return Ok(entries.iter().map(|(_, number)| *number).collect());
    }
    let mut numbers = vec![0.0; names.len()];
    for (name, number) in entries {
        let name = name.as_deref().unwrap_or_default();
        let Some(at) = names.iter().position(|known| known == name) else {
            return Err(Failure::usage("usage", format!("{name:?} is no state; the states are {known}")));
        };
        numbers[at] = *number;
    }
    Ok(numbers)
}

/// A plant, with its integral, and what its states cost.
struct Loops<'a> {
    states: &'a StateSpace,
    whole: &'a StateSpace,
    q: &'a [f64],
    integrates: bool,
}

impl Loops<'_> {
    fn regulator(&self, r: f64) -> Result<(Matrix, Vec<Complex>), LinearError> {
        let q = Matrix::from_diagonal(&self.q.to_vec().into());
        let regulator = self.whole.lqr(&q, &Matrix::from_element(1, 1, r)).map_err(|e| match e {
            LinearError::NotConverged | LinearError::NoRegulator => LinearError::Wish(
                "with these weights nothing brings it to rest: a mode that does not die out by itself costs nothing, or the input does not \
                 move it; give the first state a weight, as --q y=1 does (without an integral where a zero is at rest)"
                    .into(),
            ),
            e => e,
        })?;
        Ok((regulator.gain, regulator.poles))
    }

    /// The loop cut at the plant's input, K (sI − A)⁻¹ B. In continuous time by the coefficients themselves: there the integral is at 0 exactly.
    fn open(&self, gain: &Matrix, plant: &TransferFunction) -> Result<TransferFunction, LinearError> {
        let (whole, n) = (self.whole, self.states.order());
        if matches!(whole.time(), Time::Sampled(_)) {
            let none = Matrix::zeros(1, 1);
            let cut =
                StateSpace::new(whole.a().clone(), whole.b().clone(), gain.clone(), none, whole.time())?;
            return Ok(cut.transfer(0, 0)?.transfer());
        }
        // each state is the one before times s, the first is b₀ over the denominator
        let first = self.states.b()[(n - 1, 0)];
        let chain: Vec<f64> = (0..n).rev().map(|k| gain[(0, k)] * first).collect();
        let chain = Polynomial::new(chain);
        if !self.integrates {
            return TransferFunction::new(chain, plant.denominator().clone(), whole.time());
        }
        let above = &chain.shifted(1) + &plant.numerator().scaled(gain[(0, n)]);
        TransferFunction::new(above, plant.denominator().shifted(1), whole.time())
    }

    /// From the setpoint to the output, or with −K for C to the input.
    fn closed(
        &self,
        gain: &Matrix,
        (c, d): (Matrix, f64),
        prefilter: Option<f64>,
    ) -> Result<TransferFunction, LinearError> {
        let (a, n) = (self.whole.a() - self.whole.b() * gain, self.whole.order());
        let (_, per_sample) = integral_step(self.whole.time());
        let b = match prefilter {
            Some(factor) => self.whole.b() * factor,
            // the integral is that of y − r
            None => Matrix::from_fn(n, 1, |row, _| if row + 1 == n { -per_sample } else { 0.0 }),
        };
        let d = Matrix::from_element(1, 1, d * prefilter.unwrap_or(0.0));
        Ok(StateSpace::new(a, b, c, d, self.whole.time())?.transfer(0, 0)?.transfer())
    }

    fn finding(
        &self,
        (name, plant): (String, TransferFunction),
        (names, r, allowed): (Vec<String>, f64, Option<Allowed>),
        theme: Theme,
    ) -> Result<Finding, LinearError> {
        let (gain, poles) = self.regulator(r)?;
        let n = self.whole.order();
        let time = self.whole.time();
        let open = self.open(&gain, &plant)?;
        let through = self.states.d()[(0, 0)];
        let output = self.whole.c().rows(0, 1) - &gain * through;
        let prefilter = match self.integrates {
            true => None,
            false => Some(1.0 / self.closed(&gain, (output.clone(), through), Some(1.0))?.dc_gain()),
        };
        if prefilter.is_some_and(|factor| !factor.is_finite()) {
            let message = "its output rests at 0 whatever the input: no setpoint can be reached";
            return Err(LinearError::Wish(message.into()));
        }
        let to_output = self.closed(&gain, (output, through), prefilter)?;
        let to_input = self.closed(&gain, (-&gain, 1.0), prefilter)?;
        let (step, info) = settled_step(&to_output)?;
        let input = to_input.step_response(step.step_s, step.values.len())?;
        Ok(Finding {
            margins: open.margins(),
            stability: to_output.stability(),
            q: self.q.to_vec(),
            gain: (0..n).map(|k| gain[(0, k)]).collect(),
            name,
            plant,
            names,
            r,
            prefilter,
            open,
            poles,
            step,
            input,
            info,
            allowed,
            time,
            theme,
        })
    }

    /// What is reached from the largest deviation of the first state that has one, and the R with which the input stays within bounds.
    fn allowed(&self, r: f64, most: &[f64], most_input: f64) -> Result<Allowed, LinearError> {
        /// e-folds of R that are tried.
        const WIDEST: f64 = 40.0;
        const HALVINGS: usize = 40;
        let reached = self.reached(r, most)?;
        let input = |r: f64| self.reached(r, most).map(|all| all[all.len() - 1]);
        let last = reached[reached.len() - 1];
        let mut nearest_r = None;
        if last > most_input * (1.0 + 1e-9) && input(r * exp(WIDEST)).is_ok_and(|u| u <= most_input) {
            let (mut bad, mut good) = (0.0, WIDEST);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (bad + good);
                if input(r * exp(middle)).is_ok_and(|u| u <= most_input) {
                    good = middle
                } else {
                    bad = middle
                }
            }
            nearest_r = Some(r * exp(good));
        }
        let most = most.iter().copied().chain([most_input]).collect();
        Ok(Allowed { most, reached, nearest_r })
    }

    /// Largest values of every state and of the input, on the way to rest.
    fn reached(&self, r: f64, most: &[f64]) -> Result<Vec<f64>, LinearError> {
        let (gain, _) = self.regulator(r)?;
        let (a, n) = (self.whole.a() - self.whole.b() * &gain, self.whole.order());
        let first = most.iter().position(|most| *most != 0.0).unwrap_or(0);
        let from = Matrix::from_fn(n, 1, |row, _| if row == first { most[first] } else { 0.0 });
        let peak = |row: Matrix| -> Result<f64, LinearError> {
            let seen = StateSpace::new(a.clone(), from.clone(), row, Matrix::zeros(1, 1), self.whole.time())?;
            let seen = seen.transfer(0, 0)?.transfer();
            if seen.numerator().is_zero() {
                return Ok(0.0);
            }
            match self.whole.time() {
                Time::Continuous => {
                    Ok(seen.transient(Input::Impulse)?.peak()?.map_or(f64::INFINITY, |peak| peak.value.abs()))
                }
                Time::Sampled(period_s) => {
                    let count = (seen.lasts_s() / period_s).clamp(2.0, 60_000.0) as usize;
                    let impulse: Vec<f64> = (0..count).map(|k| f64::from(u8::from(k == 0))).collect();
                    // samples: the state is there one after the impulse
                    Ok(seen
                        .response(period_s, &impulse)?
                        .values
                        .iter()
                        .fold(0.0, |most, y| y.abs().max(most)))
                }
            }
        };
        let states = (0..n).map(|k| Matrix::from_fn(1, n, |_, column| f64::from(u8::from(column == k))));
        states.chain([gain.clone()]).map(peak).collect()
    }
}

/// What is kept of an integral, and what it takes of a sample.
fn integral_step(time: Time) -> (f64, f64) {
    match time {
        Time::Continuous => (0.0, 1.0),
        Time::Sampled(period_s) => (1.0, period_s),
    }
}
