//! What a traced job leaves behind: figures, tables, pictures and the run log, as bytes.
//!
//! Everything here is computed from one read-only [`Finished`]; nothing here decides anything, and nothing here opens a file.
//!
//! | file | made by |
//! |---|---|
//! | `summary.json`, `--json` | [`Summary`] |
//! | `trace.csv`, `fault.csv` | [`trace_csv`], [`fault_csv`] |
//! | `run.mcap` | [`LogWriter`], tick by tick while the run goes on, and [`index`] |
//! | `trace.png` | [`paint`] |
//! | `seen.csv` | [`seen_csv`], where a camera followed the spot |
//! | `report.html` | [`page()`] |
//! | `trace --film` | [`film()`] |
//! | `plan --preview`, `strokes --stages` | [`preview()`], [`stages`] |
//! | a drawing | [`drawing`] |

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod csv;
pub mod drawing;
mod error;
mod events;
mod film;
mod finished;
#[cfg(test)]
mod fixture;
mod head_gcode;
mod limit;
mod log;
mod origin;
mod page;
mod painting;
mod plan;
mod preview;
mod sample;
mod seen;
mod sequence;
pub mod stages;
mod summary;
mod words;

pub use csv::{fault_csv, trace_csv};
pub use error::EncodeError;
pub use events::{Event, events};
pub use film::{Film, film};
pub use finished::{Finished, Picture, PointFigures, Setting, Target, Timing};
pub use head_gcode::{AxisUnit, HeadGcode, HeadProgram, head_gcode};
pub use log::{LogMeta, LogWriter, Recovered, index, recover};
pub use page::{html, page};
pub use painting::paint;
pub use plan::{plan_csv, plan_json, plan_words};
pub use preview::{ColourBy, preview};
pub use sample::planned;
pub use seen::seen_csv;
pub use sequence::{DrawnStroke, sequence};
pub use summary::{LogFigures, PlanFigures, StrokeFigures, Summary};
