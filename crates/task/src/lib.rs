//! A piece of work that takes its time: it says how far it is, is stopped, fails with a code and a sentence, and uses all cores.
//!
//! Who has the work done brings a [`Progress`] and a [`Stop`]; nothing here knows of a terminal, a signal or a process.

mod failure;
mod fan;
mod meanings;
mod nearest;
mod pace;
mod place;
mod progress;
mod quoted;
mod stop;
mod words;

pub use failure::{Failure, Status};
pub use fan::on_all_cores;
pub use meanings::{codes, meaning};
pub use nearest::nearest;
pub use pace::Pace;
pub use place::Place;
pub use progress::{NoProgress, Progress, Task};
pub use quoted::quoted;
pub use stop::{Kept, Stop};
pub use words::{counted, phase_word};
