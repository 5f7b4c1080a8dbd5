//! Tracelight: give it a picture, and a pan/tilt laser head draws it on the wall, to scale.

mod batch;
mod camera_file;
mod carried;
mod chart;
mod cli;
mod eye;
mod failure;
mod fan;
mod head_file;
mod job;
mod output;
mod paper;
mod picture;
mod progress;
mod quality;
mod quiet;
mod record;
mod rigfile;
mod schedule;
mod settings;
mod sketch;
mod stop;
mod table;
mod units;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
