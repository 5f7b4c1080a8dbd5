//! Drawings from and to bytes. Nothing here opens a file: bytes in, bytes out.
//!
//! | module | reads | writes | frame |
//! |---|---|---|---|
//! | [`svg`] | any SVG's paths | a placed drawing in true millimetres | sheet; target |
//! | [`dxf`] | the model of a DXF | the same, release 2004 | sheet; target |
//! | [`json`] | `strokes --json` | the same | pixels |
//! | [`lettering`] | words that are to be drawn | – | sheet |
//! | [`csv`] | `stroke,x_m,y_m` | the same | target |
//! | [`gcode`] | – | GRBL in laser mode, millimetres | target |
//! | [`hpgl`] | – | HPGL, plotter units | target |
//! | [`ild`] | – | ILDA, format 5 | target |
//!
//! Layers and colours of SVG, DXF and JSON are the strokes'. CSV, G-code, HPGL and ILDA keep the strokes and their
//! order, HPGL and ILDA the colours too. Whatever is written keeps the tracing order.
//!
//! Readers take bytes from anywhere: what is malformed, not a number or too large is a [`FormatError`] that says
//! where; none panics, runs for long, or takes memory out of proportion to [`MAX_BYTES`].

#![cfg_attr(
    test,
    allow(clippy::disallowed_methods, reason = "tests may ask the C library: they allow for the last digit")
)]

mod circular;
mod controls;
pub mod csv;
pub mod dxf;
mod error;
pub mod gcode;
pub mod hpgl;
pub mod ild;
pub mod json;
mod layers;
pub mod lettering;
mod limit;
mod meant;
mod number;
mod options;
mod pen;
pub mod svg;
mod unpacked;

pub use error::FormatError;
pub use limit::{MAX_BYTES, MAX_COORDINATE};
pub use number::{fixed, length};
pub use options::{Font, FontFinder, Hatch, Hidden, LengthUnit, Letters, ReadOptions};
use tracelight_stroke::{Affine, Colour, Drawing, Place, Point};
pub use unpacked::{head, unpacked};

/// A drawing on its sheet, as a file has it: x right, y down, the sheet spans `[0, width] × [0, height]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Width, in the file's unit.
    pub width: f64,
    /// Height, in the file's unit.
    pub height: f64,
    /// Size of the file's unit on paper, where the file says so.
    pub metres_per_unit: Option<f64>,
    /// What is drawn, in the file's unit and order.
    pub drawing: Drawing,
    /// In which coordinates people say where a place of it is.
    pub coordinates: Coordinates,
    /// Points and places of blocks that the file has, in the file's unit and order.
    pub places: Vec<Place>,
}

/// In which coordinates people say where a place of a drawing is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    /// Those of the file itself, x right, y up, in metres: by this map to the sheet (DXF, CSV).
    File(Affine),
    /// From the sheet's top left corner, in its units, which are pixels to people, or in lengths where one is known to be so many metres.
    Page {
        /// Length of a unit, m.
        unit_m: Option<f64>,
    },
}

impl Coordinates {
    /// Whether people measure in pixels there.
    #[must_use]
    pub const fn has_pixels(&self) -> bool {
        matches!(self, Self::Page { .. })
    }

    /// Where on the sheet a place is that is so many metres right, and up or down as theirs are; `None` where nothing says how long a unit is.
    #[must_use]
    pub fn on_sheet(&self, metres: Point) -> Option<Point> {
        match *self {
            Self::File(sheet_from_file) => Some(sheet_from_file * metres),
            Self::Page { unit_m } => unit_m.map(|m| (metres.to_vec2() / m).to_point()),
        }
    }
}

/// What a reader made of a file, and what it left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The drawing.
    pub sheet: Sheet,
    /// What of the file is not in the drawing, and what to do about it: one sentence each.
    pub remarks: Vec<String>,
    /// Why its size cannot be meant, and what to do about it: one sentence, where nobody has said how large it is to be.
    pub doubt: Option<String>,
    /// Nobody says what its unit is: it was taken for the millimetre.
    pub unit_guessed: bool,
    /// A list of strokes that somebody made one by one, as JSON and CSV are: lines that are in it twice are meant twice.
    pub is_list: bool,
}

impl Reading {
    /// A sheet whose strokes are all that its file lists.
    pub fn of_list(sheet: Sheet) -> Self {
        let doubt = sheet.doubt();
        Self { sheet, remarks: Vec::new(), doubt, unit_guessed: false, is_list: true }
    }
}

impl Sheet {
    /// A drawing whose unit is nobody's but its own, as the pixels of a picture are; `width` and `height` are in it.
    #[must_use]
    pub const fn in_pixels(width: f64, height: f64, drawing: Drawing) -> Self {
        Self {
            width,
            height,
            metres_per_unit: None,
            drawing,
            coordinates: Coordinates::Page { unit_m: None },
            places: Vec::new(),
        }
    }

    /// Why its true size, where its file says one, cannot be meant.
    pub(crate) fn doubt(&self) -> Option<String> {
        self.metres_per_unit.and_then(|m| meant::doubt([self.width * m, self.height * m]))
    }
}

/// A colour as people write it: `#rrggbb`, `#rgb`, `rgb(…)`, or one of CSS's names; `None` for anything else.
pub fn colour_of(text: &str) -> Option<Colour> {
    let text = text.trim().to_ascii_lowercase();
    let css: svgtypes::Color = text.parse().ok()?;
    Some(Colour::new(css.red, css.green, css.blue))
}

fn check_size(bytes: &[u8]) -> Result<(), FormatError> {
    match bytes.len() > MAX_BYTES {
        true => {
            Err(FormatError::TooLarge { what: "file", found: bytes.len(), unit: "bytes", limit: MAX_BYTES })
        }
        false => Ok(()),
    }
}

fn text(bytes: &[u8]) -> Result<&str, FormatError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|e| FormatError::NotText { offset: e.valid_up_to() })
}

fn is_sound(point: Point) -> bool {
    // asked this way round, what is not a number is not sound
    point.x.abs() <= MAX_COORDINATE && point.y.abs() <= MAX_COORDINATE
}

/// The examples of `README.md`, as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
