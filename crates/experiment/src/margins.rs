//! Margins, as they are shown.

use serde_json::{Value, json};
use tracelight_linear::{DelayMargin, GainMargin, Margins, PhaseMargin, decibels};

use crate::named::Named;
use crate::numbers::four;

/// Margins of an open loop for people, a line each.
pub(crate) fn margin_lines(delay: DelayMargin, margins: &Margins) -> String {
    let mut lines = Vec::new();
    if delay == DelayMargin::Unstable {
        lines.push(
            "    the closed loop is not stable: gain and phase say how far from stable it is".to_owned(),
        );
    }
    lines.push(match margins.least_gain() {
        Some(margin) => format!(
            "    gain margin     {} dB (factor {}) at {} rad/s",
            four(decibels(margin.factor)),
            four(margin.factor),
            four(margin.rad_s)
        ),
        None if margins.is_always_real => {
            "    gain margin     none: it is real at every frequency".to_owned()
        }
        None => "    gain margin     none: it is nowhere real and negative".to_owned(),
    });
    lines.push(match margins.least_phase() {
        Some(margin) => {
            format!("    phase margin    {}° at {} rad/s", four(margin.degrees()), four(margin.rad_s))
        }
        None if margins.is_always_one => {
            "    phase margin    none: its gain is 1 at every frequency".to_owned()
        }
        None => "    phase margin    none: its gain is nowhere 1".to_owned(),
    });
    lines.push(match delay {
        DelayMargin::Delay { delay_s, rad_s } => {
            format!("    delay margin    {} ms at {} rad/s", four(1e3 * delay_s), four(rad_s))
        }
        DelayMargin::Zero => {
            "    delay margin    0: any delay makes it unstable, as its gain at infinite frequency is 1 or more".to_owned()
        }
        DelayMargin::Unlimited => "    delay margin    none: no delay makes it unstable".to_owned(),
        DelayMargin::Unstable => "    delay margin    none: it is unstable without a delay".to_owned(),
        DelayMargin::Unknown => {
            "    delay margin    not known: measured data do not say whether the loop is stable".to_owned()
        }
    });
    if let Some(margin) = margins.modulus {
        lines.push(format!(
            "    modulus margin  {} at {} rad/s: sensitivity at most {}",
            four(margin.distance),
            four(margin.rad_s),
            four(1.0 / margin.distance)
        ));
    }
    lines.join("\n")
}

/// Whether the loop that a measured one becomes is stable, and what that rests on, a line.
pub(crate) fn counted_lines(open: &Named) -> String {
    let Some((data, unstable)) = open.data.as_ref().zip(open.unstable) else {
        return "    whether it is stable once it is closed, measured data alone do not tell: say with --unstable how many unstable poles the \
                open loop has\n"
            .to_owned();
    };
    let (low, high) = data.band();
    let doubt = format!(
        "that holds if below {} rad/s the loop goes on as it begins, and above {} rad/s its gain stays below 1",
        four(low),
        four(high)
    );
    let feedback = open.feedback();
    match data.unstable_when_closed(unstable) {
        Ok(0) => format!(
            "    closed by {feedback} feedback it is stable, by its turns round −1 and the open loop's unstable poles ({unstable}); {doubt}\n"
        ),
        Ok(count) => format!(
            "    closed by {feedback} feedback it is not stable: {count} {}, by its turns round −1 and the open loop's unstable poles \
             ({unstable}); {doubt}\n",
            if count == 1 { "pole grows" } else { "poles grow" }
        ),
        Err(why) => format!("    whether it is stable once it is closed, the data do not tell: {why}\n"),
    }
}

/// Margins of an open loop for scripts.
pub(crate) fn margins_json(delay: DelayMargin, margins: &Margins) -> Value {
    let gain = |m: &GainMargin| json!({"rad_s": m.rad_s, "factor": m.factor, "db": decibels(m.factor)});
    let phase = |m: &PhaseMargin| json!({"rad_s": m.rad_s, "deg": m.degrees(), "delay_s": m.delay_s});
    let modulus = margins.modulus.map(|m| {
        // JSON has no infinity
        json!({"rad_s": m.rad_s.is_finite().then_some(m.rad_s), "distance": m.distance})
    });
    json!({
        "gain": margins.least_gain().as_ref().map(gain),
        "phase": margins.least_phase().as_ref().map(phase),
        "delay_s": delay.delay_s(),
        "modulus": modulus,
        "every_gain": margins.gain.iter().map(gain).collect::<Vec<_>>(),
        "every_phase": margins.phase.iter().map(phase).collect::<Vec<_>>(),
    })
}

/// A name with its margins.
pub(crate) fn summary(name: &str, margins: &Margins) -> String {
    let phase = margins.least_phase().map(|m| format!("{}° of phase", four(m.degrees())));
    let gain = margins.least_gain().map(|m| format!("{} dB of gain", four(decibels(m.factor))));
    let both: Vec<String> = phase.into_iter().chain(gain).collect();
    if both.is_empty() { name.to_owned() } else { format!("{name}: {}", both.join(", ")) }
}
