//! Many pictures: on all cores, past those that fail, in the order they were named, and again from where it stopped.
//!
//! | module | knows |
//! |---|---|
//! | `batch` | the whole way |
//! | `places` | the file each picture's strokes go to |
//! | `manifest` | what is done already |
//! | `queue` | threads, memory, panics |
//! | `weight` | the memory a picture takes |
//! | `figures`, `row`, `table`, `report` | what is told of it |
//!
//! Journal and results lie in a folder that the caller names; what a picture is and how it is traced, the caller knows.

mod batch;
mod figures;
mod manifest;
mod places;
mod queue;
mod report;
mod row;
mod table;
mod weight;

pub use batch::{Batch, Finding, Out, Tracer, run};
pub use figures::{Figures, Unit};
pub use places::files;
pub use report::Ended;
