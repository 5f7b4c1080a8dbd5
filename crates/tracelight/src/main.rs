//! Tracelight: give it a picture, and a pan/tilt laser head draws it on the wall, to scale.

mod bar;
mod batch;
mod camera_file;
mod carried;
mod cli;
mod eye;
mod head_file;
mod interrupt;
mod job;
mod output;
mod paper;
mod quality;
mod record;
mod rigfile;
mod schedule;
mod settings;
mod sketch;
mod source;
mod table;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
