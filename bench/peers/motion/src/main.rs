//! Runs Tracelight's order and timing on the cases that `cases.py` writes, for `run.sh` to set beside others.
#![allow(clippy::print_stdout, reason = "a benchmark prints its figures")]
#![allow(clippy::disallowed_methods, reason = "a measurement may ask the C library: it keeps no results")]

mod order;
mod retime;
mod steer;

use std::process::ExitCode;

#[derive(clap::Parser)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Orders strokes given by their ends: `x0,y0,x1,y1` a line.
    Order(order::Arguments),
    /// Times the fastest motion along sampled joint paths.
    Retime(retime::Arguments),
    /// Finds the fastest moves of two joints from any state to any other.
    Steer(steer::Arguments),
}

fn main() -> ExitCode {
    let arguments = <Arguments as clap::Parser>::parse();
    let done = match arguments.command {
        Command::Order(arguments) => order::run(&arguments),
        Command::Retime(arguments) => retime::run(&arguments),
        Command::Steer(arguments) => steer::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            println!("{message}");
            ExitCode::FAILURE
        }
    }
}
