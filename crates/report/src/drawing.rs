//! A drawing as a file of the kind its name says.

use std::path::Path;

use tracelight_formats::gcode::GcodeOptions;
use tracelight_formats::ild::Show;
use tracelight_formats::json::Traced;
use tracelight_formats::{Sheet, csv, dxf, gcode, hpgl, ild, json, svg};
use tracelight_pipeline::{Page, PaperSeen, Placed, QualityFigures, Sketch};
use tracelight_stroke::Point;
use tracelight_task::{Failure, counted};

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

/// A drawing as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DrawingFile {
    /// Content of the file.
    pub bytes: Vec<u8>,
    /// What to know of it: one sentence.
    pub note: Option<String>,
    /// What may go wrong when it is played: one sentence each.
    pub doubts: Vec<String>,
}

/// The placed strokes as a file of that name, as what its extension says. `json` is what `.json` gets: the strokes in
/// pixels, which placing does not change. `light` is how G-code lights them; the usual way where nothing is asked for.
///
/// # Errors
/// An extension that is none of those known; the message lists them. A `light` for what is no G-code.
pub fn file(
    path: &Path,
    placed: &Placed,
    json: &str,
    light: Option<&GcodeOptions>,
) -> Result<DrawingFile, Failure> {
    let kind = kind_of(path)?;
    match (kind, light) {
        (Kind::Gcode, _) | (_, None) => Ok(written(kind, placed, json, light)),
        (_, Some(_)) => {
            let message = format!("--feed and --power are for G-code, and {} is none", path.display());
            Err(Failure::usage("usage", message))
        }
    }
}

/// Whether a file's name says that it is G-code.
#[must_use]
pub fn is_gcode(path: &Path) -> bool {
    matches!(kind_of(path), Ok(Kind::Gcode))
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

fn written(kind: Kind, placed: &Placed, json: &str, light: Option<&GcodeOptions>) -> DrawingFile {
    let page = placed.page(&placed.drawing);
    let Page { drawing, width_m, height_m } = &page;
    let (width_m, height_m) = (*width_m, *height_m);
    let bytes: Vec<u8> = match kind {
        Kind::Svg => svg::write(drawing, width_m, height_m).into(),
        Kind::Dxf => dxf::write(drawing, width_m, height_m).into(),
        Kind::Json => json.into(),
        // in the target's frame: its points say where they lie, whatever the page
        Kind::Csv => csv::write(&placed.drawing, TOLERANCE_M).into(),
        Kind::Gcode => {
            gcode::write(drawing, width_m, height_m, light.unwrap_or(&GcodeOptions::default())).into()
        }
        Kind::Ild => {
            let show = ild::write(drawing, width_m, height_m);
            let doubts = flickering(&show).into_iter().chain(off_sheet(kind, &page)).collect();
            return DrawingFile { note: Some(shown(&show)), bytes: show.bytes, doubts };
        }
        Kind::Hpgl => hpgl::write(drawing, width_m, height_m, TOLERANCE_M).into(),
    };
    DrawingFile { bytes, note: None, doubts: off_sheet(kind, &page).into_iter().collect() }
}

/// Points a second that most projectors are set to.
const PACE: f64 = 30_000.0;

/// How long a projector takes for the largest frame, ms.
fn frame_ms(show: &Show) -> f64 {
    1e3 * show.most_points as f64 / PACE
}

/// The frames, and how long a projector takes for one.
fn shown(show: &Show) -> String {
    let largest = if show.frames == 1 { "" } else { "the largest " };
    format!(
        "{}, {largest}of {} points: {:.0} ms at {PACE:.0} points a second",
        counted(show.frames, "ILDA frame"),
        show.most_points,
        frame_ms(show)
    )
}

/// A frame that takes too long for the eye.
fn flickering(show: &Show) -> Option<String> {
    /// A frame that takes longer is seen to flicker, ms: 20 frames a second.
    const STEADY_MS: f64 = 50.0;
    let ms = frame_ms(show);
    (ms > STEADY_MS).then(|| {
        format!(
            "a projector takes {ms:.0} ms for all of it at {PACE:.0} points a second, and more than {STEADY_MS:.0} ms \
             flicker: draw fewer strokes, or simpler ones"
        )
    })
}

/// What lies off the sheet, for machines that cannot go there.
fn off_sheet(kind: Kind, page: &Page) -> Option<String> {
    let what = match kind {
        Kind::Gcode => {
            "its coordinates are negative or beyond the sheet, where a machine may have its end stops"
        }
        Kind::Hpgl => "its coordinates are negative or beyond the sheet, which a plotter may refuse",
        Kind::Ild => "it is drawn on the edge of the range",
        Kind::Svg | Kind::Dxf | Kind::Json | Kind::Csv => return None,
    };
    let (half_w, half_h) = (0.5 * page.width_m + TOLERANCE_M, 0.5 * page.height_m + TOLERANCE_M);
    let beyond = |p: &Point| (p.x.abs() - half_w).max(p.y.abs() - half_h);
    let (mut length_m, mut furthest_m) = (0.0, 0.0_f64);
    for stroke in &page.drawing.strokes {
        for pair in stroke.path.flatten(TOLERANCE_M).windows(2) {
            let (from, to) = (beyond(&pair[0]), beyond(&pair[1]));
            furthest_m = furthest_m.max(from).max(to);
            let share = share_beyond(from, to);
            length_m += share * pair[0].distance(pair[1]);
        }
    }
    (furthest_m > 0.0).then(|| {
        format!(
            "{:.0} mm of line lie off the sheet, by up to {:.1} mm; {what}",
            1e3 * length_m,
            1e3 * furthest_m
        )
    })
}

/// How much of a straight line is beyond an edge that its ends are so far beyond.
fn share_beyond(from: f64, to: f64) -> f64 {
    let (low, high) = (from.min(to), from.max(to));
    if low >= 0.0 {
        1.0
    } else if high <= 0.0 {
        0.0
    } else {
        high / (high - low)
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
    let sheet = Sheet::in_pixels(width, height, drawing.clone());
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
