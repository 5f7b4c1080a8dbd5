//! Error constants and norms, as they are shown.

use serde_json::{Value, json};
use tracelight_linear::{ErrorConstants, Norm, Peak, Stability, decibels};

use crate::named::Named;
use crate::numbers::four;

/// Type and error constants of an open loop, and the errors that remain once negative feedback closes it, two lines; nothing of one that
/// is not stable then, or was measured.
pub(crate) fn error_lines(open: &Named) -> String {
    let Some(constants) = constants(open) else { return String::new() };
    let ErrorConstants { system_type, position, velocity, acceleration } = constants;
    let [step, ramp, parabola] = constants.remaining();
    let remains = |error: f64| if error.is_infinite() { "grows".to_owned() } else { four(error) };
    format!(
        "    error constants type {system_type}: Kp {}, Kv {} 1/s, Ka {} 1/s²\n    steady-state error {} of a step, {} of a ramp, {} of a parabola t²/2\n",
        four(position),
        four(velocity),
        four(acceleration),
        remains(step),
        remains(ramp),
        remains(parabola)
    )
}

/// Error constants for scripts: nothing for what is infinite.
pub(crate) fn errors_json(open: &Named) -> Value {
    constants(open).map_or(Value::Null, |constants| {
        let finite = |value: f64| value.is_finite().then_some(value);
        let [step, ramp, parabola] = constants.remaining().map(finite);
        json!({
            "type": constants.system_type,
            "kp": finite(constants.position),
            "kv": finite(constants.velocity),
            "ka": finite(constants.acceleration),
            "steady_state_error": {"step": step, "ramp": ramp, "parabola": parabola},
        })
    })
}

fn constants(open: &Named) -> Option<ErrorConstants> {
    (open.data.is_none() && open.closed_stability() == Some(Stability::Stable))
        .then(|| open.delayed().error_constants())?
}

/// The H∞ norm, and the H2 norm where there is one, a line each; nothing of what was measured.
pub(crate) fn norm_lines(named: &Named) -> String {
    let Some(norm) = named.h_infinity() else { return String::new() };
    let mut text = format!("    H∞ norm         {}\n", norm_words(norm));
    if let Some(h2) = named.h2_norm() {
        text += &format!("    H2 norm         {}\n", four(h2));
    }
    text
}

/// A norm for people.
pub(crate) fn norm_words(norm: Norm) -> String {
    match norm {
        Norm::Finite(peak) => peak_words(peak),
        Norm::Edge => "infinite: a pole is on the edge of stability".to_owned(),
        Norm::Unstable => "none: it is not stable".to_owned(),
        Norm::Improper => "infinite: its gain rises with the frequency (more zeros than poles)".to_owned(),
    }
}

/// A largest gain and where it is, for people.
pub(crate) fn peak_words(Peak { rad_s, gain }: Peak) -> String {
    let place = match rad_s {
        0.0 => "at rest (0 rad/s)".to_owned(),
        w if w.is_infinite() => "at infinite frequency".to_owned(),
        w => format!("at {} rad/s ({} Hz)", four(w), four(w / std::f64::consts::TAU)),
    };
    if gain > 0.0 {
        format!("{} dB (factor {}) {place}", four(tidy_db(gain)), four(gain))
    } else {
        "0 at every frequency".to_owned()
    }
}

/// Decibels of a gain, 0 where only rounding keeps it from 1.
pub(crate) fn tidy_db(gain: f64) -> f64 {
    let db = decibels(gain);
    if db.abs() < 1e-9 { 0.0 } else { db }
}

/// Norms for scripts.
pub(crate) fn norms_json(named: &Named) -> Value {
    named.h_infinity().map_or(Value::Null, |norm| {
        let mut object = norm_json(norm);
        object["h2"] = named.h2_norm().into();
        object
    })
}

/// An H∞ norm for scripts: with why there is none, where there is none.
pub(crate) fn norm_json(norm: Norm) -> Value {
    let why = match norm {
        Norm::Finite(peak) => return peak_json(peak),
        Norm::Edge => "marginal",
        Norm::Unstable => "unstable",
        Norm::Improper => "improper",
    };
    json!({"h_infinity": null, "none": why})
}

/// A largest gain for scripts. JSON has no infinity.
pub(crate) fn peak_json(Peak { rad_s, gain }: Peak) -> Value {
    json!({
        "h_infinity": gain,
        "db": (gain > 0.0).then(|| decibels(gain)),
        "rad_s": rad_s.is_finite().then_some(rad_s),
    })
}
