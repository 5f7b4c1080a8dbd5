//! What to say of wrong flags where the parser's own words leave people alone.

use clap::error::{ContextKind, ErrorKind};
use tracelight_task::Failure;

/// A better message for a wrong command line, where there is one.
pub(crate) fn advice(error: &clap::Error) -> Option<Failure> {
    let names =
        |kind: ContextKind, name: &str| error.get(kind).is_some_and(|value| value.to_string().contains(name));
    let is_about = |name: &str| names(ContextKind::InvalidArg, name);
    let message = match error.kind() {
        ErrorKind::MissingRequiredArgument if is_about("<PICTURE>...") => {
            "of which pictures? tracelight strokes drawing.jpg -o drawing.svg"
        }
        ErrorKind::MissingRequiredArgument if is_about("<DRAWING>") => {
            "of which drawing, or picture? tracelight plan examples/star.png -o star.csv"
        }
        ErrorKind::MissingRequiredArgument if is_about("<PICTURE>") => {
            "what is to be drawn? Name a PICTURE: tracelight trace examples/house.png --open; or for what a camera sees on the wall --camera SOURCE"
        }
        ErrorKind::ArgumentConflict
            if is_about("--camera") && names(ContextKind::PriorArg, "PICTURE")
                || is_about("PICTURE") && names(ContextKind::PriorArg, "--camera") =>
        {
            "what is to be drawn? Either a PICTURE, or what a camera sees on the wall; to have a simulated camera look at a picture: --camera sim:PICTURE, and no PICTURE beside it"
        }
        ErrorKind::UnknownArgument if is_about("--text") => {
            "text is not drawn yet: make an SVG of it whose letters are paths (Inkscape: Path, Object to Path) and draw that"
        }
        ErrorKind::UnknownArgument if is_about("--unit") => {
            "the unit of a drawing is its own yet; --width or --height set its size"
        }
        _ => return None,
    };
    Some(Failure::usage("usage", message))
}
