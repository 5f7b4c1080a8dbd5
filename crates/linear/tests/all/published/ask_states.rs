//! Questions that are asked of states: matrices, norms of several channels, regulators.

use tracelight_linear::{Complex, DiskMargin, Matrix, StateSpace, Time, decibels};

use super::ask::{last, real};
use super::system::{matrix, numbers};

/// Of what is made from states: regulators, estimators, placed poles, disk margins.
pub(super) fn design(states: &StateSpace, words: &[&str]) -> Option<Vec<Complex>> {
    let pick = |[gain, cost]: [&Matrix; 2], poles: &[Complex], rest: &[&str]| match rest {
        ["pole"] => Some(poles.to_vec()),
        ["gain", row, column] => entry(gain, row, column),
        ["cost", row, column] => entry(cost, row, column),
        _ => None,
    };
    let refused = Some(Vec::new());
    match words {
        ["lqr", q, r, rest @ ..] => states
            .lqr(&matrix(q), &matrix(r))
            .map_or(refused, |found| pick([&found.gain, &found.cost], &found.poles, rest)),
        ["lqr-outputs", w, r, rest @ ..] => states
            .lqr_of_outputs(&matrix(w), &matrix(r))
            .map_or(refused, |found| pick([&found.gain, &found.cost], &found.poles, rest)),
        ["kalman", pushed, seen, rest @ ..] => states
            .kalman(&matrix(pushed), &matrix(seen))
            .map_or(refused, |found| pick([&found.gain, &found.covariance], &found.poles, rest)),
        ["place", poles, "gain", row, column] => entry(&states.place(&numbers(poles)).unwrap(), row, column),
        ["disk", skew, figure @ ..] => {
            let margins = states.disk_margins(skew.parse().unwrap()).unwrap();
            real(margins.map(|margins| disk(&margins.all, figure)))
        }
        _ => None,
    }
}

fn disk(margin: &DiskMargin, figure: &[&str]) -> f64 {
    match figure {
        ["size"] => margin.alpha,
        ["gain", "dB"] => decibels(margin.gain.1),
        ["phase"] => margin.phase_rad.to_degrees(),
        ["frequency"] => margin.rad_s,
        _ => panic!("{figure:?} is none of a disk margin"),
    }
}

fn entry(of: &Matrix, row: &str, column: &str) -> Option<Vec<Complex>> {
    let index = |word: &str| word.parse::<usize>().unwrap() - 1;
    real([of[(index(row), index(column))]])
}

pub(super) fn of_states(states: &StateSpace, words: &[&str]) -> Option<Vec<Complex>> {
    let peak = || states.h_infinity_norm(1e-12).unwrap();
    match words {
        ["entry", name, row, column] => {
            let of = match *name {
                "A" => states.a(),
                "B" => states.b(),
                "C" => states.c(),
                _ => states.d(),
            };
            entry(of, row, column)
        }
        ["pole"] => Some(states.poles().unwrap()),
        ["poles"] => real([states.order() as f64]),
        ["zero"] => Some(states.zeros().unwrap()),
        ["zeros"] => real([states.zeros().unwrap().len() as f64]),
        ["largest", "gain"] => real(peak().map(|peak| peak.gain)),
        ["largest", "gain", "frequency"] => real(peak().map(|peak| peak.rad_s)),
        ["H2"] => real(states.h2_norm().unwrap()),
        ["H2", "squared"] => real(states.h2_norm().unwrap().map(|norm| norm * norm)),
        ["singular", which, "at", _] => {
            let values = states.singular_values(&[last(words)]).unwrap();
            real([values[0][which.parse::<usize>().unwrap() - 1]])
        }
        [what @ ("step" | "impulse"), "at", _] if states.time() == Time::Continuous => {
            real([of_time(states, what, last(words))])
        }
        _ => None,
    }
}

/// An answer of one channel by states: from one value to the next, the first at time 0.
fn of_time(states: &StateSpace, what: &str, time_s: f64) -> f64 {
    let (step_s, which) = if time_s > 0.0 { (time_s, 1) } else { (1.0, 0) };
    let answers = match what {
        "step" => states.step_responses(step_s, 2),
        _ => states.impulse_responses(step_s, 2),
    };
    answers.unwrap()[0][0].values[which]
}
