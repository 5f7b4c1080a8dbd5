//! The command line: one file a subcommand.

mod advice;
pub(crate) mod answer;
pub(crate) mod calibrate;
mod candidates;
pub(crate) mod completions;
mod doctor;
pub(crate) mod driving;
pub(crate) mod ending;
mod explain;
pub(crate) mod eyes;
mod failing;
pub(crate) mod gcode;
mod lab;
pub(crate) mod man;
mod meant;
mod moving;
mod others;
pub(crate) mod plan;
mod point;
mod recover;
pub(crate) mod request;
mod resume;
mod rig;
mod rigs;
mod runs;
pub(crate) mod strokes;
mod studio;
mod terminal;
mod trace;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{ColorChoice, CommandFactory, FromArgMatches, Parser, Subcommand};
use tracelight_files as files;
use tracelight_operator::Seat;
use tracelight_task::{Failure, Status, Stop, Task};

use self::answer::{Answer, Voice, print, watched};
use self::terminal::Terminal;
use crate::interrupt;

/// Give it a picture: a pan/tilt laser head draws it on the wall, to scale.
#[derive(Parser, Debug)]
#[command(
    name = "tracelight",
    version,
    after_help = "Example: tracelight trace examples/house.png --width 24in --open\n\
                  With a picture and no command, trace is assumed: tracelight examples/house.png\n\n\
                  Without hardware everything runs on a simulated rig (see `tracelight rigs`)."
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// When help and messages are coloured; auto never does if NO_COLOR is set
    #[arg(long, value_enum, value_name = "WHEN", default_value_t)]
    color: ColorChoice,
}

#[derive(Subcommand, Debug)]
enum Command {
    Trace(Box<request::TraceArgs>),
    Strokes(Box<strokes::StrokesArgs>),
    Plan(Box<plan::PlanArgs>),
    Point(Box<point::PointArgs>),
    Home(moving::HomeArgs),
    Jog(moving::JogArgs),
    Park(moving::ParkArgs),
    Stop(others::StopArgs),
    Watch(others::WatchArgs),
    Studio(studio::StudioArgs),
    Calibrate(calibrate::CalibrateArgs),
    Lab(lab::LabArgs),
    Doctor(doctor::DoctorArgs),
    Rig(rig::RigArgs),
    Rigs(rigs::RigsArgs),
    Resume(resume::ResumeArgs),
    Runs(runs::RunsArgs),
    Compare(runs::CompareArgs),
    Recover(recover::RecoverArgs),
    Explain(explain::ExplainArgs),
    Completions(completions::CompletionsArgs),
    Man(man::ManArgs),
}

/// Runs the program on the process's arguments.
pub(crate) fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args_os().collect();
    if let Some(status) = offered(&arguments) {
        return status;
    }
    let (terminal, typed) = Terminal::of(arguments);
    let json = typed.iter().any(|argument| argument == "--json");
    let program = Cli::command().styles(terminal::STYLES).term_width(terminal::width_of_help());
    let arguments = match files::in_text(&typed).and_then(|()| meant::meant(typed, &program)) {
        Ok(arguments) => arguments,
        Err(failure) => return report(terminal, json, json, &failure),
    };
    let given = arguments.iter().skip(1).map(|argument| argument.to_string_lossy().into_owned()).collect();
    let parsed = program.clone().try_get_matches_from(&arguments);
    let cli = match parsed.and_then(|found| Cli::from_arg_matches(&found)) {
        Ok(cli) => cli,
        Err(error) => {
            return refuse(terminal, &error, json, &advice::more(&error, &program, &arguments));
        }
    };
    let command = cli.command.typed(given);
    let (voice, result) = perform(&command, &interrupt::listen());
    finish(terminal, &command, voice, result)
}

/// Answers a shell that asks what to offer; `None` where none does.
fn offered(arguments: &[OsString]) -> Option<ExitCode> {
    match candidates::offer(Cli::command, arguments) {
        Ok(false) => None,
        Ok(true) => Some(ExitCode::SUCCESS),
        // whoever types sees nothing offered, and no message between the words
        Err(_) => Some(ExitCode::FAILURE),
    }
}

fn perform(command: &Command, stop: &Stop) -> (Voice, Result<Answer, Failure>) {
    match command {
        Command::Trace(args) => (args.voice, watched(args.voice, stop, |task| trace::run(args, None, task))),
        Command::Strokes(args) => (args.voice, strokes::run(args, stop)),
        Command::Plan(args) => (args.voice, watched(args.voice, stop, |task| plan::run(args, traced, task))),
        Command::Point(args) => {
            (args.voice, watched(args.voice, stop, |task| point::run(args, traced, task)))
        }
        Command::Studio(args) => (args.voice, studio::run(args, (done_for, looked_for), stop)),
        Command::Home(args) => (args.head.voice, moving::home(args, stop)),
        Command::Jog(args) => (args.head.voice, moving::jog(args, stop)),
        Command::Park(args) => (args.head.voice, moving::park(args, stop)),
        Command::Stop(args) => (args.voice, others::stop(args)),
        Command::Watch(args) => (args.voice, others::run_watch(args, stop)),
        Command::Calibrate(args) => {
            (args.voice(), watched(args.voice(), stop, |task| calibrate::run(args, task)))
        }
        Command::Lab(args) => (args.voice(), lab::run(args, answer_to, stop)),
        Command::Doctor(args) => (args.voice, doctor::run(args, stop)),
        Command::Rig(args) => (args.voice(), rig::run(args, stop)),
        Command::Rigs(args) => (args.voice, rigs::run(args)),
        Command::Resume(args) => {
            (args.voice, watched(args.voice, stop, |task| resume::run(args, traced, None, task)))
        }
        Command::Runs(args) => (args.voice, runs::run(args)),
        Command::Compare(args) => (args.voice, runs::run_compare(args)),
        Command::Recover(args) => (args.voice, recover::run(args)),
        Command::Explain(args) => (args.voice, explain::run(args)),
        Command::Completions(args) => (args.voice, completions::run(args)),
        Command::Man(args) => (args.voice, man::run(args, Cli::command())),
    }
}

/// The command of a command line, without the program's name.
fn read(arguments: &[String]) -> Result<Command, clap::Error> {
    let all = std::iter::once("tracelight").chain(arguments.iter().map(String::as_str));
    Ok(Cli::try_parse_from(all)?.command.typed(arguments.to_vec()))
}

/// Does what a command line says for somebody who shows its progress: commands that a page may need, with `--json`.
fn done_for(arguments: &[String], seat: Option<&dyn Seat>, task: Task<'_>) -> Result<Answer, Failure> {
    // what is said first is what is wrong; the rest is for a terminal
    match read(arguments).map_err(|e| failing::refused(&e))? {
        Command::Trace(args) => trace::run(&args, seat, task),
        Command::Plan(args) => plan::run(&args, traced, task),
        Command::Resume(args) => resume::run(&args, traced, seat, task),
        Command::Home(args) => moving::home(&args, task.stop),
        Command::Jog(args) => moving::jog(&args, task.stop),
        Command::Park(args) => moving::park(&args, task.stop),
        Command::Lab(args) => lab::run(&args, answer_to, task.stop),
        Command::Calibrate(args) => calibrate::run(&args, task),
        Command::Runs(args) => runs::run(&args),
        Command::Compare(args) => runs::run_compare(&args),
        Command::Rigs(args) => rigs::run(&args),
        Command::Explain(args) => explain::run(&args),
        _ => Err(Failure::usage("usage", "the studio does not do this command")),
    }
}

/// Looks through a camera for somebody who shows its images, until he wants no more.
fn looked_for(
    arguments: &[String],
    stop: &Stop,
    each: &mut dyn FnMut(Vec<u8>, serde_json::Value) -> bool,
) -> Result<(), Failure> {
    match read(arguments).map_err(|e| failing::refused(&e))? {
        Command::Calibrate(args) => calibrate::watch(&args, stop, each),
        _ => Err(Failure::usage("usage", "this command looks through no camera")),
    }
}

/// Does what a command line says, in this process, and returns what would be printed, with the failure of what it worked on, if any.
fn answer_to(arguments: &[&str], stop: &Stop) -> Result<Answer, Failure> {
    let typed: Vec<String> = arguments.iter().map(|&argument| argument.to_owned()).collect();
    perform(&read(&typed).map_err(|e| Failure::failed("internal", e))?, stop).1
}

/// What `trace` was asked by a command that was given earlier.
fn traced(arguments: &[String]) -> Result<request::TraceArgs, Failure> {
    let refused = |why: String| {
        let message = format!("cannot go on with tracelight {}: {why}", arguments.join(" "));
        Failure::usage("usage", message)
    };
    match read(arguments).map_err(|e| refused(e.to_string()))? {
        Command::Trace(args) => Ok(*args),
        _ => Err(refused("only trace can be gone on with".to_owned())),
    }
}

impl Command {
    /// The same, with the command as it was given: a run keeps it, to be gone on with.
    fn typed(mut self, typed: Vec<String>) -> Self {
        match &mut self {
            Self::Trace(args) => args.typed = typed,
            Self::Point(args) => args.typed = typed,
            _ => {}
        }
        self
    }

    /// Whether its answer is meant to become a file.
    fn prints_file(&self) -> bool {
        match self {
            Command::Completions(_) => true,
            Command::Rigs(args) => args.shows_file(),
            _ => false,
        }
    }
}

fn finish(terminal: Terminal, command: &Command, voice: Voice, result: Result<Answer, Failure>) -> ExitCode {
    let shown = |text: String| if command.prints_file() { text } else { terminal::shown(&text) };
    match result {
        Ok(Answer { text, json, failure: None }) => {
            match print(&if voice.json { json } else { shown(text) }) {
                Ok(()) => ExitCode::SUCCESS,
                Err(failure) => report(terminal, voice.json, false, &failure),
            }
        }
        Ok(Answer { text, json, failure: Some(failure) }) => {
            // what failed before counts for more
            drop(print(&if voice.json { with_error(&json, &failure) } else { shown(text) }));
            report(terminal, voice.json, false, &failure)
        }
        Err(failure) => report(terminal, voice.json, voice.json, &failure),
    }
}

/// The figures of work that went wrong, with what went wrong: one object still.
fn with_error(json: &str, failure: &Failure) -> String {
    let error = failing::json(failure);
    match (json.strip_suffix('}'), error.strip_prefix('{')) {
        (Some(figures), Some(error)) => format!("{},{error}", figures.trim_end()),
        _ => error,
    }
}

#[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
fn report(terminal: Terminal, json: bool, on_stdout: bool, failure: &Failure) -> ExitCode {
    if on_stdout {
        // the message below says it too
        drop(print(&failing::json(failure)));
    }
    // of a wrong command line there is no more to be told than its message does
    let tells_more = !json && failure.code != "usage";
    let hint =
        if tells_more { format!("(see `tracelight explain {}`)", failure.code) } else { String::new() };
    // below a caret a hint has its own line
    let gap = if !tells_more {
        ""
    } else if failure.message.contains('\n') {
        "\n"
    } else {
        " "
    };
    eprintln!("{} {}{gap}{hint}", terminal.alarm("error:"), tracelight_camera::shown(&failure.message));
    ExitCode::from(failure.status.code())
}

/// Wrong command lines: help and version are no errors; the rest is said on stderr, and as JSON where asked for.
#[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
fn refuse(terminal: Terminal, error: &clap::Error, json: bool, more: &[String]) -> ExitCode {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        let help = error.render();
        let text = if terminal.colours_output() { help.ansi().to_string() } else { help.to_string() };
        return match print(text.trim_end()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(failure) => report(terminal, false, false, &failure),
        };
    }
    if let Some(failure) = advice::advice(error) {
        return report(terminal, json, json, &failure);
    }
    if json {
        drop(print(&failing::refused_json(error, more)));
    }
    let message = error.render();
    let message = if terminal.colours_errors() { message.ansi().to_string() } else { message.to_string() };
    eprint!("{}", with_more(message, more));
    ExitCode::from(Status::Usage.code())
}

/// What the parser says, with lines of ours before its last paragraph, which sends on to the help.
fn with_more(message: String, more: &[String]) -> String {
    let more: String = more.iter().map(|line| format!("  {line}\n")).collect();
    match message.rsplit_once("\n\n") {
        Some((before, last)) if !more.is_empty() && last.starts_with("For more") => {
            format!("{before}\n\n{more}\n{last}")
        }
        _ => message,
    }
}
