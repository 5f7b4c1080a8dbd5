//! What is in the files that the user named.

use std::path::PathBuf;

use tracelight_files as files;
use tracelight_formats::ReadOptions;
use tracelight_picture::{Pixels, Raster, Source, decode, decode_with};
use tracelight_port::{At, Speaks};
use tracelight_rigfile as rigfile;
use tracelight_rigfile::camera::KnownCamera;
use tracelight_rigfile::head::KnownHead;
use tracelight_sim::{Emulation, RigConfig};
use tracelight_task::{Failure, nearest};

use tracelight_flags::LetteringArgs;

/// A picture or a drawing; `-` is standard input. What it is, its content says, not its name.
pub(crate) fn picture(path: &str) -> Result<Source, Failure> {
    decode(path, &files::read(path)?)
}

/// As [`picture`]; a drawing is read by the options.
pub(crate) fn drawing(path: &str, options: &ReadOptions) -> Result<Source, Failure> {
    let source = decode_with(path, &files::read(path)?, options)?;
    let flag = options.unit.map(|_| "--unit").or(options.dpi.map(|_| "--dpi"));
    match (&source, flag) {
        (Source::Pixels(_), Some(flag)) => {
            let message = format!(
                "{flag} is for drawings (DXF, SVG), and {path} is a picture: --width or --height set its size"
            );
            Err(Failure::usage("usage", message))
        }
        _ => Ok(source),
    }
}

/// The words that are to be drawn, else a picture as in [`drawing`].
pub(crate) fn source(path: &str, options: &ReadOptions, words: &LetteringArgs) -> Result<Source, Failure> {
    words.source(options)?.map_or_else(|| drawing(path, options), Ok)
}

/// A picture to hang on a simulated wall.
pub(crate) fn pixels(path: &str) -> Result<Pixels, Failure> {
    match picture(path)? {
        Source::Pixels(pixels) => Ok(pixels),
        Source::Strokes(_) => {
            let message = format!(
                "{path} is a drawing; a simulated wall wants a picture with pixels: PNG, JPEG, WebP, BMP, GIF, PNM or TIFF"
            );
            Err(Failure::usage("not-a-picture", message))
        }
    }
}

/// Its colours.
pub(crate) fn painted(path: &str) -> Result<Raster, Failure> {
    Ok(pixels(path)?.colour)
}

/// A preset by name, or a rig file by path.
pub(crate) fn rig(name: &str) -> Result<RigConfig, Failure> {
    rig_of(name, "")
}

/// Likewise; what is neither is told so, and what else it is not.
fn rig_of(name: &str, nor: &str) -> Result<RigConfig, Failure> {
    if let Some(preset) = RigConfig::preset(name) {
        return Ok(preset);
    }
    if let Some(base) = rigfile::emulated(name) {
        return Ok(RigConfig { emulated: Some(Emulation::default()), ..rig(base)? });
    }
    let on_grbl = || rigfile::on_grbl(name).map(|_| (name, None));
    if let Some((port, _)) = rigfile::at_port(name, is_device).or_else(on_grbl) {
        let message = format!(
            "{name} is a port, and this command drives no head: give a preset that `tracelight rigs` lists, or a rig file; `trace`, `point`, `home`, `jog` and `park` drive \
             the head at a port, and `tracelight doctor --rig {port}` looks at its board"
        );
        return Err(Failure::usage("rig-file", message));
    }
    if !name.ends_with(".toml") && !std::path::Path::new(name).exists() {
        let known: Vec<String> = RigConfig::presets().into_iter().map(|p| p.name).collect();
        let near = nearest(name, known.iter().map(String::as_str));
        let hint = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
        let message = format!("{name} is no preset ({}) and no rig file{hint}{nor}", known.join(", "));
        return Err(Failure::usage("rig-file", message));
    }
    let file = rigfile::read(name, files::read(name)?)?;
    file.remark.iter().for_each(|remark| say(remark));
    Ok(file.rig)
}

/// The head that is taken to be at a port of which nobody says what is there.
const AT_PORT: &str = "report";
/// Likewise on a Grbl board.
const ON_GRBL: &str = "stepper";

/// Likewise, or a port with the head that is there: `PORT` or `PORT:RIG`.
pub(crate) fn rig_or_port(name: &str) -> Result<(RigConfig, Option<At>), Failure> {
    if let Some((port, head)) = rigfile::on_grbl(name) {
        let at = At { port: port.to_owned(), speaks: Speaks::Grbl, is_said: head.is_some() };
        return Ok((rig(head.unwrap_or(ON_GRBL))?, Some(at)));
    }
    let Some((port, head)) = rigfile::at_port(name, is_device) else {
        return Ok((rig_of(name, ", and there is no such port of a board")?, None));
    };
    let at = At { port: port.to_owned(), speaks: Speaks::Wire, is_said: head.is_some() };
    match rig(head.unwrap_or(AT_PORT))? {
        RigConfig { emulated: Some(_), .. } => {
            let message = format!(
                "{name}: a board is at {port}, none is to be emulated: give {port}:RIG with the head that it drives"
            );
            Err(Failure::usage("rig-file", message))
        }
        rig => Ok((rig, Some(at))),
    }
}

/// Whether a real head may be lit with the laser that its rig file tells of.
///
/// # Errors
/// `rig-file`: it does not say enough of the laser, or nobody answers for its class.
pub(crate) fn fit(rig: &RigConfig) -> Result<(), Failure> {
    let because = |why| Failure::usage("rig-file", format!("{}: this head is not lit: {why}", rig.name));
    rig.light.unfit().map_or(Ok(()), |why| Err(because(why)))
}

/// A name of a head as it is everywhere: files from the root.
pub(crate) fn from_root(name: &str) -> String {
    let whole = |file: &str| {
        let path = std::path::absolute(file).ok().filter(|_| std::path::Path::new(file).is_file());
        path.map(|path| path.to_string_lossy().into_owned())
    };
    let root = |path: &str| {
        std::path::absolute(path).map_or_else(|_| path.to_owned(), |path| path.to_string_lossy().into_owned())
    };
    if let Some((port, head)) = rigfile::on_grbl(name) {
        let port = if is_device(port) { root(port) } else { port.to_owned() };
        let head = head.map(|head| format!(":{}", whole(head).unwrap_or_else(|| head.to_owned())));
        return format!("grbl:{port}{}", head.unwrap_or_default());
    }
    if let Some((port, head)) = rigfile::at_port(name, is_device) {
        // Windows has ports that are no paths
        let port = if is_device(port) { root(port) } else { port.to_owned() };
        let head = head.map(|head| whole(head).unwrap_or_else(|| head.to_owned()));
        return head.map_or_else(|| port.clone(), |head| format!("{port}:{head}"));
    }
    let behind = || {
        let (before, file) = name.rsplit_once(':')?;
        Some(format!("{before}:{}", whole(file)?))
    };
    whole(name).or_else(behind).unwrap_or_else(|| name.to_owned())
}

/// The head that is at a port by a name of both; [`AT_PORT`] where it does not say. `None` of a name without a port.
pub(crate) fn head_at_port(name: &str) -> Option<&str> {
    let on_grbl = rigfile::on_grbl(name).map(|(_, head)| head.unwrap_or(ON_GRBL));
    on_grbl.or_else(|| rigfile::at_port(name, is_device).map(|(_, head)| head.unwrap_or(AT_PORT)))
}

/// The port that a name means, which may say whose head is there.
pub(crate) fn port(name: &str) -> PathBuf {
    let port = rigfile::on_grbl(name).or_else(|| rigfile::at_port(name, is_device));
    port.map_or(name, |(port, _)| port).into()
}

/// Whether there is a device of that name to talk to, also by a link.
fn is_device(name: &str) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt as _;
        std::fs::metadata(name).is_ok_and(|is| is.file_type().is_char_device())
    }
    #[cfg(not(unix))]
    false
}

/// A remark on standard error: files are read before there is a bar that it could disturb.
#[expect(clippy::print_stderr, reason = "messages to people go to stderr")]
fn say(remark: &str) {
    if !std::env::args_os().any(|argument| argument == "--quiet") {
        eprintln!("note: {remark}");
    }
}

/// Writes a rig's model, what was identified of it and how it is driven into the rig file it came from, whole or not at all.
pub(crate) fn save_rig(path: &str, old: &RigConfig, new: &RigConfig) -> Result<(), Failure> {
    let wrong = |e: String| Failure::usage("rig-file", format!("{path} cannot be saved: {e}"));
    let text = std::fs::read_to_string(path).map_err(|e| wrong(e.to_string()))?;
    files::replace(path, rigfile::saved(path, &text, old, new).map_err(wrong)?)
}

/// What a camera file knows.
pub(crate) fn camera(path: &str) -> Result<KnownCamera, Failure> {
    rigfile::camera::read(path, files::read(path)?)
}

/// The head of a file, for a rig.
pub(crate) fn head(path: &str, rig: &RigConfig) -> Result<KnownHead, Failure> {
    rigfile::head::read(path, files::read(path)?, rig)
}

/// The day, as 2026-11-23.
pub(crate) fn today() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d").to_string()
}

/// Date and time, UTC.
pub(crate) fn now() -> String {
    jiff::Timestamp::now().strftime("%Y-%m-%d %H:%M:%S").to_string()
}
