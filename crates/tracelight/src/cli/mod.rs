//! The command line: one file a subcommand.

pub(crate) mod answer;
mod calibrate;
pub(crate) mod choosing;
mod completions;
mod doctor;
pub(crate) mod driving;
mod explain;
pub(crate) mod eyes;
mod lab;
pub(crate) mod laws;
mod meant;
pub(crate) mod nearest;
pub(crate) mod placing;
mod plan;
pub(crate) mod request;
mod rigs;
pub(crate) mod shapes;
mod strokes;
mod trace;
pub(crate) mod tracing;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser, Subcommand};
use tracelight_task::{Failure, Status, Stop};

use self::answer::{Answer, Voice, print};
use crate::interrupt;

/// Give it a picture: a pan/tilt laser head draws it on the wall, to scale.
#[derive(Parser, Debug)]
#[command(
    name = "tracelight",
    version,
    after_help = "Example: tracelight trace examples/house.png --width 24in --open\n\
                  A picture alone is traced: tracelight examples/house.png\n\n\
                  Without hardware everything runs on a simulated rig (see `tracelight rigs`)."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    Trace(Box<request::TraceArgs>),
    Strokes(strokes::StrokesArgs),
    Plan(Box<plan::PlanArgs>),
    Calibrate(calibrate::CalibrateArgs),
    Lab(lab::LabArgs),
    Doctor(doctor::DoctorArgs),
    Rigs(rigs::RigsArgs),
    Explain(explain::ExplainArgs),
    Completions(completions::CompletionsArgs),
}

/// Runs the program on the process's arguments.
pub(crate) fn main() -> ExitCode {
    let typed: Vec<OsString> = std::env::args_os().collect();
    let json = typed.iter().any(|argument| argument == "--json");
    let arguments = match meant::meant(typed, &Cli::command()) {
        Ok(arguments) => arguments,
        Err(failure) => return report(json, json, &failure),
    };
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return refuse(&error, json),
    };
    let (voice, result) = perform(&cli.command, &interrupt::listen());
    finish(voice, result)
}

fn perform(command: &Command, stop: &Stop) -> (Voice, Result<Answer, Failure>) {
    match command {
        Command::Trace(args) => (args.voice, trace::run(args, stop)),
        Command::Strokes(args) => (args.voice, strokes::run(args, stop)),
        Command::Plan(args) => (args.voice, plan::run(args, stop)),
        Command::Calibrate(args) => (args.voice(), calibrate::run(args, stop)),
        Command::Lab(args) => (args.voice(), lab::run(args, answer_to, stop)),
        Command::Doctor(args) => (args.voice, doctor::run(args, stop)),
        Command::Rigs(args) => (args.voice, rigs::run(args)),
        Command::Explain(args) => (args.voice, explain::run(args)),
        Command::Completions(args) => (args.voice, Ok(completions::run::<Cli>(args))),
    }
}

/// Does what a command line says, in this process, and returns what would be printed.
fn answer_to(arguments: &[&str], stop: &Stop) -> Result<Answer, Failure> {
    let all = std::iter::once("tracelight").chain(arguments.iter().copied());
    let cli = Cli::try_parse_from(all).map_err(|e| Failure::failed("internal", e))?;
    let answer = perform(&cli.command, stop).1?;
    match answer.failure {
        Some(failure) => Err(failure),
        None => Ok(answer),
    }
}

fn finish(voice: Voice, result: Result<Answer, Failure>) -> ExitCode {
    match result {
        Ok(Answer { text, json, failure: None }) => {
            print(if voice.json { &json } else { &text });
            ExitCode::SUCCESS
        }
        Ok(Answer { text, json, failure: Some(failure) }) => {
            print(if voice.json { with_error(&json, &failure) } else { text }.as_str());
            report(voice.json, false, &failure)
        }
        Err(failure) => report(voice.json, voice.json, &failure),
    }
}

/// The figures of work that went wrong, with what went wrong: one object still.
fn with_error(json: &str, failure: &Failure) -> String {
    let error = failure.json();
    match (json.strip_suffix('}'), error.strip_prefix('{')) {
        (Some(figures), Some(error)) => format!("{},{error}", figures.trim_end()),
        _ => error,
    }
}

#[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
fn report(json: bool, on_stdout: bool, failure: &Failure) -> ExitCode {
    if on_stdout {
        print(&failure.json());
    }
    // of a wrong command line there is no more to be told than its message does
    let tells_more = !json && failure.code != "usage";
    let hint =
        if tells_more { format!(" (see `tracelight explain {}`)", failure.code) } else { String::new() };
    eprintln!("error: {}{hint}", failure.message);
    ExitCode::from(failure.status.code())
}

/// Wrong command lines: help and version are no errors; the rest is said on stderr, and as JSON where asked for.
#[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
fn refuse(error: &clap::Error, json: bool) -> ExitCode {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        print(error.render().to_string().trim_end());
        return ExitCode::SUCCESS;
    }
    if json {
        let text = error.render().to_string();
        let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        print(&Failure::usage("usage", first).json());
    }
    eprint!("{}", error.render());
    ExitCode::from(Status::Usage.code())
}
