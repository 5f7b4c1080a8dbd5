//! Eight lessons on a joint's loop: what is tried, what is asked, and how an answer is graded by simulating it.
//!
//! The order is that of K. J. Åström and R. M. Murray, *Feedback Systems* (2nd ed., 2021), ch. 11, and of the same authors' PID:
//! a spring, a damper, what takes away the rest, and then what is in the way on a real head.

mod check;
mod counts;
mod experiment;
mod feedforward;
mod friction;
mod jumps;
mod overshoot;
mod pd;
mod proportional;
mod question;
mod rigs;
mod two_degrees;
mod windup;

pub use check::Check;
pub use experiment::{Experiment, Quantity};
pub use question::{Ask, Graded, Lesson};

impl Lesson {
    /// Every lesson.
    pub const ALL: [Self; 8] = [
        proportional::LESSON,
        overshoot::LESSON,
        pd::LESSON,
        windup::LESSON,
        counts::LESSON,
        friction::LESSON,
        feedforward::LESSON,
        two_degrees::LESSON,
    ];
}
