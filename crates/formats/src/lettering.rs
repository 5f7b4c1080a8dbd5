//! Words to a drawing, and the fonts that words in drawings are set in.

use std::sync::Arc;

use tracelight_letters::{Align, Faces, Kind, block, kind_of, remarks};
use tracelight_stroke::{Affine, Drawing, Stroke, StrokeKind, extent};

use crate::options::{Letters, ReadOptions};
use crate::{Coordinates, FormatError, Reading, Sheet};

/// Characters of a text at most.
const MAX_CHARACTERS: usize = 10_000;

/// The side of a drawing without width or height, as a share of the other.
const LEAST_ASPECT: f64 = 0.01;

/// The fonts that were given, and after them those in the program. Letters are drawn as asked for; otherwise as the first font has them;
/// otherwise as is usual.
///
/// # Errors
/// A font that is none, or has no single lines where these are asked for.
pub(crate) fn faces(options: &ReadOptions, usual: Letters) -> Result<Faces, FormatError> {
    let fonts: Vec<(String, Arc<[u8]>)> =
        options.fonts.iter().map(|font| (font.name.clone(), font.bytes.clone())).collect();
    Ok(Faces::new(kind(options, usual)?, &fonts)?)
}

/// How letters are drawn.
///
/// # Errors
/// A font that is none.
pub(crate) fn kind(options: &ReadOptions, usual: Letters) -> Result<Kind, FormatError> {
    let asked = |letters| match letters {
        Letters::Line => Kind::Line,
        Letters::Outline => Kind::Outline,
    };
    Ok(match (options.letters, options.fonts.first()) {
        (Some(letters), _) => asked(letters),
        (None, Some(first)) => kind_of(&first.name, &first.bytes)?,
        (None, None) => asked(usual),
    })
}

/// Draws words, several lines of them where they have several, as outlines unless `options` say otherwise.
///
/// The sheet just holds the ink. With a height of capitals, metres, its unit is the millimetre, and it has that size; otherwise the
/// unit is the height of capitals, and it has none.
///
/// # Errors
/// Words without ink, too many of them, and fonts that are none.
pub fn draw(
    words: &str,
    capitals_m: Option<f64>,
    align: Align,
    options: &ReadOptions,
) -> Result<Reading, FormatError> {
    let found = words.chars().count();
    if found > MAX_CHARACTERS {
        return Err(FormatError::TooLarge { what: "text", found, unit: "characters", limit: MAX_CHARACTERS });
    }
    let set = block(&faces(options, Letters::Outline)?, words, align);
    let remarks = remarks(&set.missing, &set.outlined);
    let stroke = |(path, is_edge)| {
        let kind = if is_edge { StrokeKind::Outline } else { StrokeKind::Centreline };
        Stroke { kind, ..Stroke::new(path) }
    };
    let drawing = Drawing { strokes: set.paths.into_iter().map(stroke).collect() };
    let hint = "the text has no letter that a font here has";
    let bounds = extent(&drawing).filter(|bounds| bounds.width().max(bounds.height()) > 0.0);
    let bounds = bounds.ok_or(FormatError::Nothing { hint })?;
    let scale = capitals_m.map_or(1.0, |height| 1e3 * height);
    let least = LEAST_ASPECT * bounds.width().max(bounds.height());
    let (width, height) = (bounds.width().max(least), bounds.height().max(least));
    let (left, top) = (bounds.center().x - 0.5 * width, bounds.center().y + 0.5 * height);
    let place = Affine::new([scale, 0.0, 0.0, -scale, -left * scale, top * scale]);
    let sheet = Sheet {
        width: width * scale,
        height: height * scale,
        metres_per_unit: capitals_m.map(|_| 1e-3),
        drawing: drawing.transformed(place),
        coordinates: Coordinates::Page { unit_m: capitals_m.map(|_| 1e-3) },
        places: Vec::new(),
    };
    Ok(Reading { sheet, remarks, doubt: None, unit_guessed: false, is_list: false })
}
