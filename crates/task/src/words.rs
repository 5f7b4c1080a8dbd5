//! Counts and phases in words; those of faults and darknesses stand in `rig`'s tables.

use tracelight_rig::Phase;

/// So many of something, in words: "1 stroke", "2 strokes".
#[must_use]
pub fn counted(count: usize, one: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {one}{plural}")
}

/// A phase's name in tables and logs.
#[must_use]
pub const fn phase_word(phase: Phase) -> &'static str {
    match phase {
        Phase::Dark => "dark",
        Phase::Armed => "armed",
        Phase::Tracing => "tracing",
        Phase::Holding => "holding",
        Phase::Testing => "testing",
        Phase::Done => "done",
        Phase::Faulted => "faulted",
    }
}
