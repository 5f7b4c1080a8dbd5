//! Tracelight: give it a picture, and a pan/tilt laser head draws it on the wall, to scale.

mod bar;
mod batch;
mod carried;
mod cli;
mod eye;
mod interrupt;
mod job;
mod named;
mod output;
mod paper;
mod quality;
mod record;
mod schedule;
mod settings;
mod sketch;
mod table;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
