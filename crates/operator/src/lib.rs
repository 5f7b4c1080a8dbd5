//! Somebody at the wall, the operator of a head: keys in a terminal and the clock to a job, what happens to a terminal or a script.
//!
//! [`AtWall`] is a job's [`Hands`](tracelight_job::Hands): it reads keys if standard input is a terminal, keeps real time for a simulated rig, prints events as
//! JSON lines, and says in words what they mean. Whoever attends from elsewhere, such as from a page, has a [`Seat`].

mod asked;
mod at_wall;
mod bar;
mod keys;
mod seat;

pub use asked::{asked, nobody_arms};
pub use at_wall::{AtWall, Attending};
pub use bar::Bar;
pub use keys::{Key, Keys};
pub use seat::{Seat, Wish};
