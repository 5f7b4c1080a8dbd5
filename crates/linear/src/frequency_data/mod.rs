//! A frequency response that was measured, or came in a file: values at some frequencies, and what can be said between them.

mod curve;
mod data;
mod encirclement;
mod figures;
mod highest;

pub use data::{FrequencyData, Spacing};
pub use highest::DataPeak;
