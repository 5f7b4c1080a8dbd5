//! A drawing as a file of the kind its name says.

use std::path::Path;

use tracelight_formats::gcode::GcodeOptions;
use tracelight_formats::json::Traced;
use tracelight_formats::{Sheet, csv, dxf, gcode, hpgl, ild, json, svg};
use tracelight_pipeline::{Page, PaperSeen, Placed, QualityFigures, Sketch};
use tracelight_stroke::Point;
use tracelight_task::Failure;

/// How close points and chords keep to their curve, m: a hundredth of a millimetre.
const TOLERANCE_M: f64 = 1e-5;

/// How close `points` keep to their path, px.
const POINTS_TOLERANCE_PX: f64 = 0.05;

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

/// Pixels, to a hundredth.
fn round(px: f64) -> f64 {
    (100.0 * px).round() / 100.0
}

/// The strokes of a picture in its pixels, as JSON; with the sheet it was on and what its pixels are worth.
#[must_use]
pub fn json(sketch: &Sketch) -> String {
    let (drawing, (width, height)) = sketch.in_picture();
    let sheet = Sheet { width, height, metres_per_unit: None, drawing: drawing.clone() };
    let text = json::write(&Traced { sheet, mode: sketch.mode.to_owned() }, POINTS_TOLERANCE_PX);
    let quality = sketch.quality.as_ref().map(QualityFigures::of);
    let quality = quality.and_then(|figures| serde_json::to_string(&figures).ok());
    let points = |points: &[Point]| points.iter().map(|p| [round(p.x), round(p.y)]).collect::<Vec<_>>();
    let paper = sketch.paper.as_ref().map(|PaperSeen { sheet, slanted, .. }| {
        serde_json::json!({
            "outline": points(&sheet.outline),
            "corners": sheet.corners.as_ref().map(|corners| points(corners)),
            "beside": round(sheet.beside),
            "laid_square": slanted.is_some(),
        })
    });
    let Some(object) = text.strip_suffix('}') else { return text };
    let mut all = object.to_owned();
    all.extend(paper.map(|paper| format!(",\"sheet\":{paper}")));
    all.extend(quality.map(|quality| format!(",\"quality\":{quality}")));
    all.push('}');
    all
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
