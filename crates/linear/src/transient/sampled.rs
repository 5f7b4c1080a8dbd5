//! What a step of a sampled system ends in, and by what it is judged.

use tracelight_maths::{complex, ln};

use crate::stability::{Stability, stabilities};
use crate::transient::ending::Ending;
use crate::transient::figures::{Extreme, StepInfo};
use crate::{Complex, LinearError, Response, TransferFunction};

/// Most samples that are looked at.
const MOST: f64 = 2_000_000.0;

pub(super) fn step_info(system: &TransferFunction, band: f64) -> Result<StepInfo, LinearError> {
    let (above, order) = (system.numerator().degree(), system.denominator().degree());
    if above > order {
        return Err(LinearError::Improper { zeros: above, poles: order, what: "response" });
    }
    let ending = ending(system);
    let Ending::Converges(goal) = ending else { return Ok(StepInfo::none(ending)) };
    let response = system.step_response(1.0, until_still(system)?)?;
    Ok(figures(&response, ending, goal, band))
}

/// What a step ends in: which of its modes stay, and how large they are.
fn ending(system: &TransferFunction) -> Ending {
    let (mut diverges, mut by) = (false, 0.0);
    let all = stabilities(system.denominator(), system.time());
    for (i, &(pole, stability)) in all.iter().enumerate() {
        if stability == Stability::Stable || system.numerator().may_vanish_at(pole) {
            continue;
        }
        let others = all.iter().enumerate().filter(|(j, _)| *j != i);
        let apart: Complex = others.map(|(_, (other, _))| pole - other).product();
        let size = complex::norm(system.numerator().at(pole) / (apart * (pole - 1.0)));
        // at 1 it sums the step, and two at one place grow
        let is_bounded = stability == Stability::Marginal && size.is_finite() && size < 1e12;
        if is_bounded { by += size } else { diverges = true }
    }
    let about = system.dc_gain();
    match (diverges, by > 0.0) {
        (true, _) => Ending::Diverges,
        (false, true) => Ending::Oscillates { about, by },
        (false, false) => Ending::Converges(about),
    }
}

/// After how many samples nothing moves any more.
fn until_still(system: &TransferFunction) -> Result<usize, LinearError> {
    /// Time constants, and more of them for each pole that may be at the same place.
    const CONSTANTS: f64 = 32.0;
    const EACH: f64 = 3.0;
    let poles = system.poles();
    let order = poles.len() as f64;
    let rates = poles.iter().map(|&pole| -ln(complex::norm(pole))).filter(|rate| *rate > 0.0);
    let slowest = rates.fold(f64::INFINITY, f64::min);
    let count = 2.0 * order + 2.0 + (CONSTANTS + EACH * order) / slowest;
    if count <= MOST { Ok(count.ceil() as usize) } else { Err(LinearError::NotConverged) }
}

/// How long a plot has to be, s: all samples that its order makes, and those of its slowest mode.
pub(super) fn lasts_s(system: &TransferFunction, period_s: f64) -> f64 {
    /// e⁻⁷ is a thousandth.
    const CONSTANTS: f64 = 7.0;
    const LEAST_DAMPING: f64 = 0.05;
    let poles = system.poles();
    let rates = poles.iter().filter(|pole| **pole != Complex::ZERO).map(|&pole| complex::ln(pole));
    let rates = rates.map(|s| s.re.abs().max(LEAST_DAMPING * complex::norm(s))).filter(|rate| *rate > 1e-9);
    let slowest = rates.fold(f64::INFINITY, f64::min);
    let least = 2.0 * (poles.len() + 1) as f64;
    period_s * (CONSTANTS / slowest).max(least)
}

/// Of samples that end where nothing moves any more.
fn figures(response: &Response, ending: Ending, goal: f64, band: f64) -> StepInfo {
    let (values, step_s) = (&response.values, response.step_s);
    let (value, peak_s) = response.peak();
    let peak = if goal.abs() >= value.abs() {
        Extreme { value: goal, time_s: None }
    } else {
        Extreme { value, time_s: Some(peak_s) }
    };
    let mut info = StepInfo { peak: Some(peak), ..StepInfo::none(ending) };
    if goal == 0.0 {
        return info;
    }
    let shares = || values.iter().map(|value| value / goal);
    let first = |level: f64| response.first(|value| value / goal - level);
    let outside = values.iter().rposition(|value| (value / goal - 1.0).abs() > band);
    info.rise_s = first(0.9).zip(first(0.1)).map(|(high, low)| high - low);
    info.rise_from_s = first(0.1);
    info.settle_s = Some(outside.map_or(0.0, |place| (place + 1) as f64 * step_s));
    info.overshoot_percent = Some(100.0 * (shares().fold(0.0, f64::max) - 1.0).max(0.0));
    info.undershoot_percent = Some(100.0 * (-shares().fold(0.0, f64::min)).max(0.0));
    info
}
