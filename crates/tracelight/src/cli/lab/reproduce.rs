use std::path::{Path, PathBuf};

use clap::Args;
use tracelight_book::{Book, CommandLine, Done};
use tracelight_files as files;
use tracelight_task::{Failure, Stop};

use super::command::make_folder;
use crate::cli::answer::{Answer, Performs, Voice, watched};

/// Reproduce the figures and tables of the 2006 report on one page, its numbers beside ours, with what explains each difference
#[derive(Args, Debug)]
#[command(after_help = "Example: tracelight lab reproduce -o book\n\n\
                  The folder gets index.html, which needs nothing but itself, the figures by themselves, and the arrays and pictures that its \
                  commands are given. Above each number stands the command that makes it, as it is typed in that folder.")]
pub(crate) struct ReproduceArgs {
    /// Folder for the book
    #[arg(short, long, value_name = "DIR", default_value = "book")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) voice: Voice,
}

/// Makes the book of what `perform` answers.
pub(super) fn run(args: &ReproduceArgs, perform: Performs, stop: &Stop) -> Result<Answer, Failure> {
    let book = Book::new(&args.out);
    book.folders().try_for_each(|folder| make_folder(&folder, "-o"))?;
    for (path, bytes) in book.given()? {
        files::write(&path.display().to_string(), bytes)?;
    }
    let made = watched(args.voice, stop, |task| book.make(task, |line| done(line, perform, stop)))?;
    let index = args.out.join("index.html").display().to_string();
    files::write(&index, &made.page)?;
    Ok(Answer::either(args.voice, || made.text(&index), || made.json(&index)))
}

/// Runs a command and reads its figure.
fn done(line: CommandLine<'_>, perform: Performs, stop: &Stop) -> Result<Done, Failure> {
    let with = ["--json", "--quiet"];
    let arguments: Vec<&str> = line.arguments.iter().map(String::as_str).chain(with).collect();
    let failed = |e: Failure| Failure {
        message: format!("tracelight {}: {}", line.arguments.join(" "), e.message),
        ..e
    };
    let answer = perform(&arguments, stop).map_err(failed)?;
    if let Some(failure) = answer.failure.filter(|_| !line.may_fail) {
        return Err(failed(failure));
    }
    let value = serde_json::from_str(&answer.json).unwrap_or_default();
    let figure = line.figure.map(read).transpose()?;
    if let Some(path) = line.figure.filter(|_| line.passing) {
        // what stays behind where it cannot be removed harms nothing
        let _ = std::fs::remove_file(path);
    }
    Ok((value, figure))
}

fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path)
        .map_err(|e| Failure::failed("unreadable", format!("cannot read {}: {e}", path.display())))
}
