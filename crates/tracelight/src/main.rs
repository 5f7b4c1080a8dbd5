//! Tracelight: give it a picture, and a pan/tilt laser head draws it on the wall, to scale.

mod cli;
mod interrupt;
mod job;
mod named;
mod settings;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
