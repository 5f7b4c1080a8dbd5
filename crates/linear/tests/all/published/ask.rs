//! Questions as the table writes them: `gain margin`, `step at 0.5`, `lqr [1,0;0,1] [1] gain 1 2`.

use tracelight_linear::{Complex, Delayed, Input, Mode, StepInfo, Time, TransferFunction, decibels};
use tracelight_maths::complex;

use super::ask_states::{design, of_states};
use super::system::{System, numbers};

/// All answers to a question, of which the nearest is meant: none where there is none.
pub(super) fn answers(system: &System, question: &str) -> Vec<Complex> {
    let words: Vec<&str> = question.split(' ').collect();
    let found = match system {
        System::Formula(loop_) => of_formula(loop_, &words),
        System::States(states) => design(states, &words)
            .or_else(|| of_states(states, &words))
            // all else is a question to its transfer function
            .or_else(|| of_formula(&Delayed::from(states.transfer(0, 0).ok()?.transfer()), &words)),
    };
    found.unwrap_or_else(|| panic!("{question} is no question"))
}

/// Real answers.
pub(super) fn real(values: impl IntoIterator<Item = f64>) -> Option<Vec<Complex>> {
    Some(values.into_iter().map(Complex::from).collect())
}

/// The only number among the last words.
pub(super) fn last(words: &[&str]) -> f64 {
    words[words.len() - 1].parse().unwrap()
}

fn of_formula(loop_: &Delayed, words: &[&str]) -> Option<Vec<Complex>> {
    let system = loop_.rational();
    of_roots(system, words)
        .or_else(|| of_frequency(system, words))
        .or_else(|| of_margins(system, words))
        .or_else(|| of_time(loop_, words))
        .or_else(|| of_step(system, words))
}

fn of_roots(system: &TransferFunction, words: &[&str]) -> Option<Vec<Complex>> {
    let coefficient = |polynomial: &tracelight_linear::Polynomial| {
        real([polynomial.coefficient(last(words) as usize) / system.denominator().leading()])
    };
    // of the pole that is nearest to a place
    let mode = |figure: fn(&Mode) -> f64| {
        let place = numbers(words[words.len() - 1])[0];
        let apart = |mode: &Mode| complex::norm(mode.pole - place);
        let modes = system.modes();
        real(modes.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).map(figure))
    };
    match words {
        ["pole"] => Some(system.poles()),
        ["zero"] => Some(system.zeros()),
        ["poles"] => real([system.poles().len() as f64]),
        ["zeros"] => real([system.zeros().len() as f64]),
        ["above", _] => coefficient(system.numerator()),
        ["below", _] => coefficient(system.denominator()),
        ["damping", "near", _] => mode(|mode| mode.damping),
        ["natural", "frequency", "near", _] => mode(|mode| mode.natural_rad_s),
        ["breakaway"] => Some(system.breakaways().iter().map(|meeting| meeting.pole).collect()),
        ["breakaway", "gain", "near", _] => {
            let near = |pole: Complex| complex::norm(pole - numbers(words[3])[0]) < 1e-3;
            real(system.breakaways().iter().filter(|meeting| near(meeting.pole)).map(|meeting| meeting.gain))
        }
        _ => None,
    }
}

fn of_frequency(system: &TransferFunction, words: &[&str]) -> Option<Vec<Complex>> {
    let value = || system.at(system.time().at_frequency(last(words)));
    match words {
        ["gain", "at", "rest"] => real([system.dc_gain()]),
        ["gain", "at", _] => real([complex::norm(value())]),
        ["decibels", "at", _] => real([decibels(complex::norm(value()))]),
        ["phase", "at", _] => real([system.phase(last(words)).to_degrees()]),
        ["angle", "at", _] => real([value().im.atan2(value().re)]),
        ["value", "at", _] => Some(vec![value()]),
        ["value", "in", place] => Some(vec![system.at(numbers(place)[0])]),
        ["bandwidth"] => real(system.bandwidth()),
        ["largest", "gain"] => real(system.peak().map(|peak| peak.gain)),
        ["largest", "gain", "frequency"] => real(system.peak().map(|peak| peak.rad_s)),
        ["H2"] => real(system.state_space().ok()?.h2_norm().unwrap()),
        ["H2", "squared"] => real(system.state_space().ok()?.h2_norm().unwrap().map(|norm| norm * norm)),
        ["real", "crossing", "frequency"] => real(system.real_crossings().iter().map(|c| c.rad_s)),
        ["real", "value", "near", _] => {
            let apart = |c: &tracelight_linear::RealCrossing| (c.rad_s - last(words)).abs();
            let crossings = system.real_crossings();
            real(crossings.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).map(|c| c.value))
        }
        _ => None,
    }
}

fn of_margins(system: &TransferFunction, words: &[&str]) -> Option<Vec<Complex>> {
    let margins = system.margins();
    match words {
        ["gain", "margin"] => real(margins.least_gain().map(|margin| margin.factor)),
        ["gain", "margin", "frequency"] => real(margins.least_gain().map(|margin| margin.rad_s)),
        ["phase", "margin"] => real(margins.least_phase().map(|margin| margin.degrees())),
        ["phase", "margin", "frequency"] => real(margins.least_phase().map(|margin| margin.rad_s)),
        ["modulus", "margin"] => real(margins.modulus.map(|margin| margin.distance)),
        ["modulus", "margin", "frequency"] => real(margins.modulus.map(|margin| margin.rad_s)),
        ["any", "gain", "margin"] => real(margins.gain.iter().map(|margin| margin.factor)),
        ["any", "gain", "margin", "frequency"] => real(margins.gain.iter().map(|margin| margin.rad_s)),
        ["any", "phase", "margin"] => real(margins.phase.iter().map(|margin| margin.degrees())),
        ["any", "phase", "margin", "frequency"] => real(margins.phase.iter().map(|margin| margin.rad_s)),
        ["delay", "margin"] => real(system.delay_margin(&margins).delay_s()),
        _ => None,
    }
}

fn of_time(loop_: &Delayed, words: &[&str]) -> Option<Vec<Complex>> {
    let (closed, words) = match words {
        ["closed", rest @ ..] => (true, rest),
        _ => (false, words),
    };
    match words {
        [what @ ("step" | "impulse"), "at", time_s] => {
            let time_s: f64 = time_s.parse().unwrap();
            if let Time::Sampled(period_s) = loop_.rational().time() {
                return real([sample(loop_.rational(), what, (time_s / period_s).round() as usize)]);
            }
            let input = if *what == "step" { Input::Step } else { Input::Impulse };
            let answer = if closed { loop_.closed_answer(input, 2.0 * time_s) } else { loop_.answer(input) };
            real([answer.unwrap().at(time_s)])
        }
        ["sample", which, "of", what] => real([sample(loop_.rational(), what, which.parse().unwrap())]),
        _ => None,
    }
}

/// One sample of an answer to a step or to one sample of 1.
fn sample(system: &TransferFunction, what: &str, which: usize) -> f64 {
    let Time::Sampled(period_s) = system.time() else { panic!("no samples") };
    let mut input = vec![if what == "step" { 1.0 } else { 0.0 }; which + 1];
    input[0] = 1.0;
    system.response(period_s, &input).unwrap().values[which]
}

fn of_step(system: &TransferFunction, words: &[&str]) -> Option<Vec<Complex>> {
    let figure = |pick: fn(&StepInfo) -> Option<f64>| real(pick(&system.step_info(0.02).unwrap()));
    match words {
        ["rise"] => figure(|info| info.rise_s),
        ["settle"] => figure(|info| info.settle_s),
        ["overshoot"] => figure(|info| info.overshoot_percent),
        ["undershoot"] => figure(|info| info.undershoot_percent),
        ["peak"] => figure(|info| info.peak.map(|peak| peak.value)),
        ["peak", "time"] => figure(|info| info.peak.and_then(|peak| peak.time_s)),
        ["final"] => figure(|info| info.ending.value()),
        _ => None,
    }
}
