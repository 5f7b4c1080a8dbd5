//! Logs as people have them: which of their columns hold what, and their numbers in SI.
//!
//! One way in for every command that reads a log: [`read`] reads the text of a table (`dialect`), takes the columns that were asked for
//! (`expression`) or that their headers tell (`guess`), and makes seconds of their times (`clock`). Nothing is guessed in silence:
//! what was taken for what is said in one line, and what could be two things is refused with both named.

mod asked;
mod clock;
mod dialect;
mod expression;
mod found;
mod guess;
mod quantity;
mod taken;

pub use asked::Columns;
pub(crate) use found::{Found, Reading, read};
pub use quantity::Quantity;
pub(crate) use taken::{Kind, tells};
