//! A drawing as a file of the kind its name says.

use std::path::Path;

use tracelight_formats::gcode::GcodeOptions;
use tracelight_formats::{csv, dxf, gcode, hpgl, ild, svg};
use tracelight_pipeline::{Page, Placed};
use tracelight_task::Failure;

/// How close points and chords keep to their curve, m: a hundredth of a millimetre.
const TOLERANCE_M: f64 = 1e-5;

/// Kinds of files a drawing can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Svg,
    Dxf,
    Json,
    Csv,
    Gcode,
    Ild,
    Hpgl,
}

/// Extensions and what they are; the first of a kind is its usual one.
const EXTENSIONS: [(&str, Kind); 11] = [
    ("svg", Kind::Svg),
    ("dxf", Kind::Dxf),
    ("json", Kind::Json),
    ("csv", Kind::Csv),
    ("gcode", Kind::Gcode),
    ("gc", Kind::Gcode),
    ("nc", Kind::Gcode),
    ("ngc", Kind::Gcode),
    ("ild", Kind::Ild),
    ("hpgl", Kind::Hpgl),
    ("plt", Kind::Hpgl),
];

/// The usual extension of each kind, the default first.
pub const FORMATS: [&str; 7] = ["svg", "dxf", "json", "csv", "gcode", "ild", "hpgl"];

/// The placed strokes as a file of that name, as what its extension says. `json` is what `.json` gets: the strokes in
/// pixels, which placing does not change.
///
/// # Errors
/// An extension that is none of those known; the message lists them.
pub fn file(path: &Path, placed: &Placed, json: &str) -> Result<Vec<u8>, Failure> {
    Ok(bytes(kind_of(path)?, placed, json))
}

fn kind_of(path: &Path) -> Result<Kind, Failure> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let known = EXTENSIONS.iter().find(|(name, _)| *name == extension);
    known.map(|&(_, kind)| kind).ok_or_else(|| {
        let all: Vec<String> = EXTENSIONS.iter().map(|(name, _)| format!(".{name}")).collect();
        let what =
            if extension.is_empty() { "a name without extension".into() } else { format!(".{extension}") };
        let message = format!("{}: cannot write {what}; use {}", path.display(), all.join(", "));
        Failure::usage("usage", message)
    })
}

fn bytes(kind: Kind, placed: &Placed, json: &str) -> Vec<u8> {
    let Page { drawing, width_m, height_m } = placed.page(&placed.drawing);
    match kind {
        Kind::Svg => svg::write(&drawing, width_m, height_m).into(),
        Kind::Dxf => dxf::write(&drawing, width_m, height_m).into(),
        Kind::Json => json.into(),
        // in the target's frame: its points say where they lie, whatever the page
        Kind::Csv => csv::write(&placed.drawing, TOLERANCE_M).into(),
        Kind::Gcode => gcode::write(&drawing, width_m, height_m, &GcodeOptions::default()).into(),
        Kind::Ild => ild::write(&drawing, width_m, height_m),
        Kind::Hpgl => hpgl::write(&drawing, width_m, height_m, TOLERANCE_M).into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_says_what_is_written() {
        for (name, kind) in [("a.SVG", Kind::Svg), ("b.plt", Kind::Hpgl), ("c.d/e.nc", Kind::Gcode)] {
            assert_eq!(kind_of(Path::new(name)).unwrap(), kind, "{name}");
        }
        for name in ["drawing", "drawing.pdf", ".svg", "a.svg.gz"] {
            let message = kind_of(Path::new(name)).unwrap_err().message;
            assert!(EXTENSIONS.iter().all(|(e, _)| message.contains(&format!(".{e}"))), "{message}");
        }
    }
}
