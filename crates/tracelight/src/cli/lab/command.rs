//! What every command of the bench has in common: it reads what was named, has it tried, and puts what was found where it belongs.

use std::path::Path;

use tracelight_chart as chart;
use tracelight_experiment::table::Log;
use tracelight_experiment::{Experiment, Filed, Finding, Plotted, svg};
use tracelight_files as files;
use tracelight_task::{Failure, Stop};

use crate::cli::answer::{Answer, Voice, watched};

/// A command of the bench.
pub(super) trait LabCommand {
    fn voice(&self) -> Voice;

    fn run(&self, stop: &Stop) -> Result<Answer, Failure>;
}

/// Has it tried, writes every plot and table that was asked for, and answers.
pub(super) fn plotted<E: Experiment<Finding: Plotted>>(
    request: E,
    out: &[OutFile],
    voice: Voice,
    stop: &Stop,
) -> Result<Answer, Failure> {
    let finding = tried(request, voice, stop)?;
    out.iter().try_for_each(|file| file.write(&finding))?;
    Ok(answer(&finding, voice))
}

/// Has it tried, leaves its files in a folder, which is made if missing, and answers.
pub(super) fn filed<E: Experiment<Finding: Filed>>(
    request: E,
    out: &Path,
    voice: Voice,
    stop: &Stop,
) -> Result<Answer, Failure> {
    let finding = tried(request, voice, stop)?;
    leave(&finding, out)?;
    Ok(answer(&finding, voice))
}

/// What it came to.
pub(super) fn tried<E: Experiment>(request: E, voice: Voice, stop: &Stop) -> Result<E::Finding, Failure> {
    watched(voice, stop, |task| request.run(task))
}

/// Leaves a finding's files in a folder, which is made if missing.
pub(super) fn leave(finding: &impl Filed, out: &Path) -> Result<(), Failure> {
    let files = finding.files()?;
    make_folder(out, "--out")?;
    files.iter().try_for_each(|(name, text)| files::write(&out.join(name).display().to_string(), text))
}

/// What is printed of a finding; what is not printed is not made.
pub(super) fn answer(finding: &impl Finding, voice: Voice) -> Answer {
    Answer::either(voice, || finding.text(), || finding.json())
}

/// What is in the logs that were named.
pub(super) fn logs(paths: &[String]) -> Result<Vec<Log>, Failure> {
    paths.iter().map(|path| log(path)).collect()
}

/// What is in a log that was named.
pub(super) fn log(path: &str) -> Result<Log, Failure> {
    Ok(Log { name: path.to_owned(), bytes: files::read(path)? })
}

/// A file to write; its ending says what goes into it.
#[derive(Clone, Debug)]
pub(super) struct OutFile {
    pub(super) path: String,
    pub(super) kind: OutKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OutKind {
    Plot,
    /// The plot as pixels.
    Pixels,
    Table,
}

impl OutFile {
    /// Writes what is asked for of a finding.
    pub(super) fn write(&self, finding: &impl Plotted) -> Result<(), Failure> {
        let bytes = match self.kind {
            OutKind::Plot => svg(&finding.figure()?)?.into_bytes(),
            OutKind::Pixels => {
                chart::pixels(&svg(&finding.figure()?)?).map_err(|e| Failure::failed("internal", e))?
            }
            OutKind::Table => finding.csv()?.into_bytes(),
        };
        files::write(&self.path, bytes)
    }
}

pub(super) fn out_file(text: &str) -> Result<OutFile, String> {
    let ending = text.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let kind = match ending.as_deref() {
        Some("svg") => OutKind::Plot,
        Some("png") => OutKind::Pixels,
        Some("csv") => OutKind::Table,
        _ => return Err(format!("{text} ends in none of .svg, .png (a plot) and .csv (a table)")),
    };
    Ok(OutFile { path: text.into(), kind })
}

/// Makes the folder that a flag names.
pub(super) fn make_folder(folder: &Path, flag: &str) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|e| {
        let message = format!("cannot write {}: {e}; choose another with {flag}", folder.display());
        Failure::failed("cannot-write", message)
    })
}
