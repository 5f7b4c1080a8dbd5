//! The 2006 report made again: every figure and number of it as a command line of the program, and the page of what they come to.
//!
//! [`Book`] knows the command lines and what is taken from each. Who has a book made runs them, in its own way, and puts the
//! page where it belongs. Nothing here runs a command or opens a file.

mod blocks;
mod book;
mod chapter;
mod chapters;
mod counts;
mod given;
mod page;
mod readings;
mod table;

pub use book::{Book, CommandLine, Made};
pub use chapter::Done;
