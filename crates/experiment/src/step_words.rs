//! Figures of a step, as every experiment that has one shows them.

use serde_json::{Value, json};
use tracelight_lab::StepFigures;
use tracelight_pipeline::DEFAULT_DISTANCE_M;
use tracelight_rig::Joint;
use tracelight_sim::RigConfig;

/// What is above the rows.
pub(crate) fn heading(rig: &RigConfig, joint: Joint, to_rad: f64) -> String {
    format!(
        "{joint} from rest at 0 to {:.4} rad ({:.2}°) on rig {}; settled: within 2 %\n\n\
         {:10} {:>10} {:>8} {:>10} {:>7} {:>17} {:>8}\n\
         {:10} {:>10} {:>8} {:>10} {:>7} {:>17} {:>8}",
        to_rad,
        to_rad.to_degrees(),
        rig.name,
        "",
        "overshoot",
        "settles",
        "at rest",
        "",
        "linear: overshoot",
        "settles",
        "law",
        "%",
        "s",
        "mm",
        "counts",
        "%",
        "s",
    )
}

/// A law's row: the head as it is, and linearized.
pub(crate) fn row(law: &str, is: &StepFigures, linear: &StepFigures, rig: &RigConfig) -> String {
    format!(
        "\n{law:10} {:10.2} {:>8} {:10.3} {:7.2} {:17.2} {:>8}",
        is.overshoot_percent,
        seconds(is.settle_s),
        error_mm(is),
        is.final_error / rig.truth.model.encoder.count_rad(),
        linear.overshoot_percent,
        seconds(linear.settle_s),
    )
}

/// Figures for scripts.
pub(crate) fn figures_json(figures: &StepFigures, rig: &RigConfig) -> Value {
    json!({
        "overshoot_percent": figures.overshoot_percent,
        "settle_s": figures.settle_s,
        "final_error_mm": error_mm(figures),
        "final_error_counts": figures.final_error / rig.truth.model.encoder.count_rad(),
    })
}

fn seconds(settle_s: Option<f64>) -> String {
    settle_s.map_or_else(|| "never".to_owned(), |s| format!("{s:.3}"))
}

fn error_mm(figures: &StepFigures) -> f64 {
    1e3 * DEFAULT_DISTANCE_M * figures.final_error
}
