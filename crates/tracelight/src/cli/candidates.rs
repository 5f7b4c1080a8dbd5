//! What a shell offers while a command line is typed: besides commands, flags and their values, what there is here and now.

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{Arg, Command, ValueHint};
use clap_complete::engine::{
    ArgValueCandidates, ArgValueCompleter, CompletionCandidate, PathCompleter, ValueCompleter as _,
};
use clap_complete::env::CompleteEnv;
use tracelight_camera::devices;
use tracelight_picture::Source;
use tracelight_sim::RigConfig;

use crate::named;

/// The variable in the environment by which a shell's script asks what to offer; its value is the shell.
pub(crate) const ASKS: &str = "TRACELIGHT_COMPLETE";
/// Longest drawing that is read for the names of its layers, bytes: longer ones keep a shell waiting.
const MOST_BYTES: u64 = 1 << 24;

/// Answers a shell that asks; whether one did.
///
/// # Errors
/// A shell that is not known, or that does not listen.
pub(crate) fn offer(program: fn() -> Command, arguments: &[OsString]) -> Result<bool, String> {
    let asked = CompleteEnv::with_factory(|| offered(program())).var(ASKS).bin("tracelight");
    let folder = std::env::current_dir().ok();
    asked.try_complete(arguments, folder.as_deref()).map_err(|e| e.to_string())
}

/// The program, and what is offered for arguments that are neither a name of a list nor any file.
fn offered(command: Command) -> Command {
    let of = command.get_name().to_owned();
    let command = command.mut_args(|arg| match (of.as_str(), arg.get_id().as_str()) {
        (_, "rig") | ("show", "name") => arg.add(ArgValueCompleter::new(rigs)),
        (_, "camera") => arg.add(ArgValueCompleter::new(cameras)),
        (_, "layer") => arg.add(ArgValueCandidates::new(layers)),
        ("explain", "code") => arg.add(ArgValueCandidates::new(codes)),
        _ if is_unhinted_file(&arg) => arg.value_hint(ValueHint::AnyPath),
        _ => arg,
    });
    command.mut_subcommands(offered)
}

/// Whether an argument is the name of a file, and nothing else is known of it: what has no flag is one, or may be.
fn is_unhinted_file(arg: &Arg) -> bool {
    let names = arg.get_value_names().unwrap_or_default();
    let is_file = arg.is_positional() || names.iter().any(|name| name.starts_with("FILE"));
    is_file && arg.get_value_hint() == ValueHint::Unknown
}

/// Presets, and rig files.
fn rigs(typed: &OsStr) -> Vec<CompletionCandidate> {
    let presets = RigConfig::presets().into_iter();
    let presets = presets.map(|rig| CompletionCandidate::new(rig.name).help(Some(rig.description.into())));
    let files = PathCompleter::any().filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    begun(presets, typed).chain(files.complete(typed)).collect()
}

/// The simulated one, those that are plugged in, and files.
fn cameras(typed: &OsStr) -> Vec<CompletionCandidate> {
    const SIMULATED: &str = "sim:";
    if let Some(picture) = typed.to_str().and_then(|text| text.strip_prefix(SIMULATED)) {
        let pictures = PathCompleter::any().complete(OsStr::new(picture)).into_iter();
        return pictures.map(|picture| picture.add_prefix(SIMULATED)).collect();
    }
    let plugged = devices().into_iter().map(CompletionCandidate::new);
    let named = ["sim", SIMULATED].map(CompletionCandidate::new).into_iter().chain(plugged);
    begun(named, typed).chain(PathCompleter::any().complete(typed)).collect()
}

/// Those of the drawing that stands on the command line already.
fn layers() -> Vec<CompletionCandidate> {
    let words = std::env::args_os().skip_while(|word| word != "--").skip(1);
    let drawings = words.map(PathBuf::from).filter(|path| is_drawing(path));
    let sources = drawings.filter_map(|path| named::picture(path.to_str()?).ok());
    let strokes = sources.flat_map(|source| match source {
        Source::Strokes(reading) => reading.sheet.drawing.strokes,
        Source::Pixels(_) => Vec::new(),
    });
    let names: BTreeSet<String> = strokes.filter_map(|stroke| Some(stroke.layer?.to_string())).collect();
    names.into_iter().map(CompletionCandidate::new).collect()
}

/// Whether a file may be a drawing with layers, and is short enough to be read while somebody waits.
fn is_drawing(path: &Path) -> bool {
    let ending = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
    let is_named = ending.is_some_and(|ending| ["svg", "dxf", "json"].contains(&ending.as_str()));
    is_named && path.metadata().is_ok_and(|file| file.is_file() && file.len() <= MOST_BYTES)
}

fn codes() -> Vec<CompletionCandidate> {
    let first = |words: String| words.split_inclusive(". ").next().unwrap_or_default().trim().to_owned();
    let all = tracelight_task::codes().into_iter();
    all.map(|(code, words)| CompletionCandidate::new(code).help(Some(first(words).into()))).collect()
}

/// Those that begin as what is typed.
fn begun(
    all: impl Iterator<Item = CompletionCandidate>,
    typed: &OsStr,
) -> impl Iterator<Item = CompletionCandidate> {
    let typed = typed.to_string_lossy().into_owned();
    all.filter(move |one| one.get_value().to_string_lossy().starts_with(&typed))
}
