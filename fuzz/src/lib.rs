//! Bytes nobody meant for it, for everything of Tracelight that reads: what must hold whatever they are.
//!
//! Each of the modules below is a target of `cargo fuzz`, and its `check` panics on the first thing that does not hold. The same
//! checks replay the seeds and all that was ever found as ordinary tests, without a fuzzer: `tests/seeds.rs`.
//!
//! | target | bytes are | and then |
//! |---|---|---|
//! | [`picture`] | a file, as the program is given it | decoded within its bounds, or refused in a sentence |
//! | [`formats`] | a drawing's file | read, written in every format, read back |
//! | [`trace`] | an image and options | traced: finite, inside the image, the same every time |
//! | [`fit`] | points and options | a path near them, from the first to the last |
//! | [`order`] | strokes and options | the same strokes in another order |
//! | [`wire`] | what a host and a board hear | both go on, and nothing is lit that was not asked for |

pub mod fit;
pub mod formats;
pub mod order;
pub mod picture;
pub mod trace;
pub mod wire;

mod bytes;
mod sound;
