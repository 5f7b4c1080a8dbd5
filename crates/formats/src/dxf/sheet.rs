//! The sheet round a drawing, and how large it truly is.

use tracelight_maths::{ln, log10, powf};
use tracelight_stroke::{Affine, Drawing, Place, extent};

use crate::limit::MAX_COORDINATE;
use crate::meant::{is_meant, lengths};
use crate::options::LengthUnit;
use crate::{Coordinates, FormatError, Sheet};

/// Sides of a sheet are at least so long, in its unit, or numbers with four decimals would show.
const LEAST_SIDE: f64 = 10.0;

/// A side of a drawing without width or height, as a share of the other.
const LEAST_ASPECT: f64 = 0.01;

/// The size of which a unit makes the most sense, m.
const USUAL_M: f64 = 1.0;

/// Length of a drawing's unit, and who says so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Unit {
    /// The user, m.
    Asked(f64),
    /// The file, m.
    Told(f64),
    /// Nobody: it is taken for the millimetre.
    Guessed,
}

/// A sheet and what is to be said of its size.
pub(super) struct Sized {
    pub(super) sheet: Sheet,
    pub(super) remark: Option<String>,
    pub(super) doubt: Option<String>,
}

impl Unit {
    /// The unit asked for, else the file's own, m.
    pub(super) fn of(asked: Option<LengthUnit>, told_m: Option<f64>) -> Self {
        match (asked, told_m) {
            (Some(unit), _) => Self::Asked(unit.metres()),
            (None, Some(metres)) => Self::Told(metres),
            (None, None) => Self::Guessed,
        }
    }

    const fn metres(self) -> f64 {
        match self {
            Self::Asked(metres) | Self::Told(metres) => metres,
            Self::Guessed => LengthUnit::Millimetre.metres(),
        }
    }

    /// Says that the unit is a guess, and what it makes of a drawing of that size in units.
    fn remark(self, size: [f64; 2]) -> Option<String> {
        (self == Self::Guessed).then(|| {
            let size = lengths(size.map(|s| s * self.metres()));
            format!(
                "the file names no unit: in millimetres it is {size}; --unit cm, m, in or ft if it is not"
            )
        })
    }

    /// Why a drawing of that size in units cannot be meant, and which unit would make sense.
    fn doubt(self, size: [f64; 2]) -> Option<String> {
        let in_metres = |metres: f64| size.map(|s| s * metres);
        let own = in_metres(self.metres());
        if is_meant(own) || matches!(self, Self::Asked(_)) {
            return None;
        }
        let who = match self {
            Self::Guessed => "the file names no unit, and in millimetres it would be",
            _ => "by the unit that the file names it is",
        };
        let far = |unit: &LengthUnit| ln(size[0].max(size[1]) * unit.metres() / USUAL_M).abs();
        let best = LengthUnit::ALL.into_iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        let way_out = best.filter(|unit| is_meant(in_metres(unit.metres()))).map_or_else(
            || "say how large it is to be, --width".to_owned(),
            |unit| {
                let so = lengths(in_metres(unit.metres()));
                format!("--unit {} makes it {so}, --width as wide as you say", unit.symbol())
            },
        );
        Some(format!("{who} {}, and drawings from 1 mm to 100 m are drawn: {way_out}", lengths(own)))
    }
}

/// The sheet round a drawing, and places of it: y down, the corner at the origin. `None` for a drawing of nothing, or of a single point.
///
/// # Errors
/// A drawing too large for numbers.
pub(super) fn sheet(drawing: &Drawing, places: &[Place], unit: Unit) -> Result<Option<Sized>, FormatError> {
    let Some(bounds) = extent(drawing) else { return Ok(None) };
    let size = bounds.width().max(bounds.height());
    if size == 0.0 {
        return Ok(None); // a single point
    }
    let unit_m = unit.metres();
    // millimetres
    let scale = 1e3 * unit_m;
    let scale = scale * of_usual_size(size * scale);
    if !(size > 0.0 && size.is_finite() && scale.is_finite() && scale > 0.0) {
        return Err(FormatError::Far { place: "extent of the drawing".into(), x: bounds.x1, y: bounds.y1 });
    }
    let (width, height) = (bounds.width().max(LEAST_ASPECT * size), bounds.height().max(LEAST_ASPECT * size));
    let (left, top) = (bounds.center().x - 0.5 * width, bounds.center().y + 0.5 * height);
    let place = Affine::new([scale, 0.0, 0.0, -scale, -left * scale, top * scale]);
    let sheet = Sheet {
        width: width * scale,
        height: height * scale,
        metres_per_unit: Some(unit_m / scale),
        drawing: drawing.transformed(place),
        coordinates: Coordinates::File(place * Affine::scale(1.0 / unit_m)),
        places: places.iter().map(|own| own.moved(place * own.at)).collect(),
    };
    let own = [bounds.width(), bounds.height()];
    Ok(Some(Sized { sheet, remark: unit.remark(own), doubt: unit.doubt(own) }))
}

/// The power of ten that brings a size between what four decimals and what readers can hold.
fn of_usual_size(size: f64) -> f64 {
    let exponent = match size {
        s if s > MAX_COORDINATE => log10(MAX_COORDINATE / s).floor(),
        s if s > 0.0 && s < LEAST_SIDE => log10(LEAST_SIDE / s).ceil(),
        _ => 0.0,
    };
    powf(10.0, exponent)
}
