//! Systems as the table writes them: `24/(s^3+6s^2+11s+6) -> hold 0.3`, `1/(z-0.5) @ 0.1`, `sys322 -> channel 1 2`.

use std::collections::HashMap;

use serde::Deserialize;
use tracelight_linear::{Complex, Delayed, Discretization, Matrix, StateSpace, Time, TransferFunction};

/// Matrices by name, as in `systems.jsonl`.
pub(super) struct Library(HashMap<String, StateSpace>);

#[derive(Deserialize)]
struct Written {
    name: String,
    a: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
    c: Vec<Vec<f64>>,
    d: Vec<Vec<f64>>,
    /// Of samples, s.
    period: Option<f64>,
}

impl Library {
    pub(super) fn read() -> Self {
        let text = include_str!("../../goldens/published/systems.jsonl");
        let named = text.lines().map(|line| {
            let written: Written = serde_json::from_str(line).unwrap();
            let [a, b, c, d] = [&written.a, &written.b, &written.c, &written.d]
                .map(|rows| Matrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j]));
            (written.name, StateSpace::new(a, b, c, d, time(written.period)).unwrap())
        });
        Self(named.collect())
    }
}

fn time(period: Option<f64>) -> Time {
    period.map_or(Time::Continuous, Time::Sampled)
}

pub(super) enum System {
    Formula(Delayed),
    States(StateSpace),
}

impl System {
    /// From a formula or a name, and what is done to it after each arrow.
    pub(super) fn made(text: &str, library: &Library) -> Self {
        let mut parts = text.split(" -> ");
        let first = parts.next().unwrap();
        let begun = match (library.0.get(first), first.split_once(" @ ")) {
            (Some(states), _) => Self::States(states.clone()),
            (None, Some((formula, period))) => Self::formula(formula, Some(period.parse().unwrap())),
            (None, None) => Self::formula(first, None),
        };
        parts.fold(begun, |system, step| system.after(step, library))
    }

    fn formula(text: &str, period: Option<f64>) -> Self {
        Self::Formula(Delayed::parse_with(text, time(period), &|_| None).unwrap())
    }

    fn after(self, step: &str, library: &Library) -> Self {
        let (verb, rest) = step.split_once(' ').unwrap_or((step, ""));
        let arguments: Vec<f64> = rest.split(' ').filter_map(|word| word.parse().ok()).collect();
        match (self, verb) {
            (Self::Formula(loop_), "pade") => rational(loop_.approximated(arguments[0] as usize).unwrap()),
            (Self::Formula(loop_), "states") => Self::States(loop_.rational().state_space().unwrap()),
            (Self::Formula(loop_), "feedback") => {
                let back = TransferFunction::parse(rest, loop_.rational().time()).unwrap();
                rational(loop_.rational().feedback(&back).unwrap())
            }
            (Self::Formula(loop_), "minimal") => rational(loop_.rational().minimal(1e-9).0),
            (Self::Formula(loop_), _) => {
                rational(loop_.rational().sampled(arguments[0], sampling(verb, &arguments)).unwrap())
            }
            (Self::States(states), "transfer") => rational(states.transfer(0, 0).unwrap().transfer()),
            (Self::States(states), "minimal") => Self::States(states.minimal().unwrap().system),
            (Self::States(states), "channel") => {
                let [output, input] = arguments[..] else { panic!("{step}") };
                Self::States(states.channel(output as usize - 1, input as usize - 1).unwrap())
            }
            (Self::States(states), "back") => Self::States(states.feedback(&library.0[rest]).unwrap()),
            (Self::States(states), "pushed") => with(&states, matrix(rest), states.c().clone()),
            (Self::States(states), "seen") => with(&states, states.b().clone(), matrix(rest)),
            (Self::States(states), _) => {
                Self::States(states.sampled(arguments[0], sampling(verb, &arguments)).unwrap())
            }
        }
    }
}

fn rational(system: TransferFunction) -> System {
    System::Formula(Delayed::from(system))
}

/// The same states with other inputs and outputs.
fn with(states: &StateSpace, b: Matrix, c: Matrix) -> System {
    let d = Matrix::zeros(c.nrows(), b.ncols());
    System::States(StateSpace::new(states.a().clone(), b, c, d, states.time()).unwrap())
}

fn sampling(verb: &str, arguments: &[f64]) -> Discretization {
    match verb {
        "hold" => Discretization::ZeroOrderHold,
        "first-order" => Discretization::FirstOrderHold,
        "tustin" => Discretization::Tustin(arguments.get(1).copied()),
        "impulse" => Discretization::Impulse,
        "matched" => Discretization::Matched,
        _ => panic!("{verb} is nothing that is done to a system"),
    }
}

/// A matrix such as `[1,0;0,1]`.
pub(super) fn matrix(text: &str) -> Matrix {
    let inner = text.trim_start_matches('[').trim_end_matches(']');
    let rows: Vec<Vec<f64>> =
        inner.split(';').map(|row| row.split(',').map(|entry| entry.parse().unwrap()).collect()).collect();
    Matrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// Numbers such as `-2+1j,-2-1j`.
pub(super) fn numbers(text: &str) -> Vec<Complex> {
    let number = |word: &str| {
        let Some(both) = word.strip_suffix('j') else { return Complex::from(word.parse::<f64>().unwrap()) };
        // the sign between the parts, not one of an exponent
        let mut signs = both
            .char_indices()
            .filter(|(at, c)| matches!(c, '+' | '-') && *at > 0 && !both[..*at].ends_with(['e', 'E']));
        match signs.next_back() {
            Some((at, _)) => Complex::new(both[..at].parse().unwrap(), both[at..].parse().unwrap()),
            None => Complex::new(0.0, both.parse().unwrap()),
        }
    };
    text.split(',').map(number).collect()
}
