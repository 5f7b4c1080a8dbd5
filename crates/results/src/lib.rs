//! Folders of runs: what is written while a run goes on and when it is over, what it was asked, how far it came, and which runs there are.

mod compared;
mod folder;
mod journal;
mod listed;
mod points;
mod table;
mod written;

pub use compared::{Compared, Figure, compare};
pub use folder::{Records, open};
pub use journal::{Asked, Before, Input, Kept, NOTHING_LEFT, Progress, read};
pub use listed::{ListedRun, check_newest, runs};
pub use table::table;
pub use written::{Told, target, write};
