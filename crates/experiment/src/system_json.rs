//! Systems for scripts.

use serde_json::{Value, json};
use tracelight_linear::{Complex, Stability, Time, TransferFunction};

/// Complex numbers as pairs.
pub(crate) fn pairs(values: &[Complex]) -> Vec<[f64; 2]> {
    // without the sign that a zero may have
    values.iter().map(|z| [z.re + 0.0, z.im + 0.0]).collect()
}

/// A system: its coefficients, zeros and poles, and whether it is stable.
pub(crate) fn system_json(name: &str, system: &TransferFunction) -> Value {
    let (gain, stability) = (system.dc_gain(), system.stability());
    json!({
        "name": name,
        "period_s": match system.time() {
            Time::Continuous => None,
            Time::Sampled(period_s) => Some(period_s),
        },
        "num": system.numerator().coefficients(),
        "den": system.denominator().coefficients(),
        "zeros": pairs(&system.zeros()),
        "poles": pairs(&system.poles()),
        "dc_gain": gain.is_finite().then_some(gain),
        "stable": stability == Stability::Stable,
        "stability": stability_name(stability),
    })
}

pub(crate) const fn stability_name(stability: Stability) -> &'static str {
    match stability {
        Stability::Stable => "stable",
        Stability::Marginal => "marginal",
        Stability::Growing => "growing",
    }
}
