//! What is said where there is no plan.

use tracelight_task::Failure;
use tracelight_trajectory::PlanError;

/// Why there is no plan, with its code.
#[must_use]
pub fn refused(error: PlanError) -> Failure {
    let code = match error {
        PlanError::Empty => "no-strokes",
        PlanError::Aim { .. } => "unreachable",
        PlanError::TooWeak { .. } => "motor-too-weak",
        PlanError::TooLong { .. } => "too-long",
        PlanError::NoWayAtSpeed { .. } => "no-way-at-speed",
        PlanError::TooBent { .. } => "too-bent",
    };
    Failure::failed(code, error)
}
