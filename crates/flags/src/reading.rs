//! How a drawing file is read: the flags of every command that takes a drawing.

use std::path::Path;
use std::sync::Arc;

use clap::{ArgAction, Args, ValueEnum};
use tracelight_files as files;
use tracelight_formats::{Font, FontFinder, Hatch, Hidden, LengthUnit, Letters, ReadOptions};
use tracelight_letters::{bundled, kind_of};
use tracelight_report::AxisUnit;
use tracelight_task::Failure;

use crate::fonts::SystemFonts;

/// How an SVG or DXF is read. Pixels have none of this.
#[derive(Args, Clone, Debug)]
pub struct ReadingArgs {
    /// Lines covered by other shapes of the drawing: cut (not drawn) or keep (drawn, as for a cutting template)
    #[arg(long, value_enum, default_value_t)]
    hidden: HiddenName,
    /// Crop to the SVG's page and to its clip paths
    #[arg(long, value_enum, default_value_t)]
    crop: Switch,
    /// Draw dashed lines as dashes
    #[arg(long, value_enum, default_value_t)]
    dashes: Switch,
    /// Unit of the numbers in a DXF [default: the file's, otherwise mm]. With plan --axes, deg or rad is the unit of the board's axes
    #[arg(long, value_enum)]
    unit: Vec<UnitName>,
    /// Pixels per inch of an SVG whose size is in pixels: 96 (browsers), 90 (old Inkscape), 72 (Illustrator)
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = dpi)]
    dpi: Option<f64>,
    /// Hatches of a DXF: boundary only, or also the lines of the pattern
    #[arg(long, value_enum, default_value_t)]
    hatch: HatchName,
    /// How letters are drawn: as single lines or as outlines [default: line in a DXF, otherwise outline]
    #[arg(long, value_enum)]
    letters: Option<LettersName>,
    /// Font for text: a file (.ttf, .otf, or an SVG font with single-line letters) or a built-in font: ems, hershey (single lines), dejavu
    /// (outlines). Repeatable; later fonts supply missing letters
    #[arg(long, value_name = "FILE", action = ArgAction::Append)]
    font: Vec<String>,
    /// Also take fonts of this computer, where a text or --font names their family, such as --font "Comic Neue"; another computer may have
    /// others, so that the drawing may differ there
    #[arg(long)]
    system_fonts: bool,
}

/// Lines that are painted over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum HiddenName {
    /// Left out
    #[default]
    Cut,
    /// Drawn
    Keep,
}

/// Whether something is done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Switch {
    /// Yes
    #[default]
    On,
    /// No
    Off,
}

/// Units of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum UnitName {
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Metres
    M,
    /// Inches
    In,
    /// Feet
    Ft,
    /// Degrees, of a board's axes
    Deg,
    /// Radians, of a board's axes
    Rad,
}

/// What of a hatch is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum HatchName {
    /// Its edge
    #[default]
    Boundary,
    /// Its edge and its pattern
    Pattern,
}

/// How letters are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum LettersName {
    /// Each stroke as one line
    Line,
    /// Their edges
    Outline,
}

impl ReadingArgs {
    /// The unit of a board's axes, if one was given.
    ///
    /// # Errors
    /// Two of them.
    pub fn axis_unit(&self) -> Result<Option<AxisUnit>, Failure> {
        only(self.unit.iter().filter_map(|unit| unit.angle()))
    }

    /// What they mean; reads the fonts.
    ///
    /// # Errors
    /// A font file that cannot be read; two units.
    pub fn options(&self) -> Result<ReadOptions, Failure> {
        let system = self.system_fonts.then(|| Arc::new(SystemFonts::look()));
        let fonts = self.font.iter().map(|name| font(name, system.as_deref()));
        Ok(ReadOptions {
            hidden: match self.hidden {
                HiddenName::Cut => Hidden::Cut,
                HiddenName::Keep => Hidden::Keep,
            },
            crop: self.crop == Switch::On,
            dashes: self.dashes == Switch::On,
            unit: only(self.unit.iter().filter_map(|unit| unit.length()))?,
            dpi: self.dpi,
            hatch: match self.hatch {
                HatchName::Boundary => Hatch::Boundary,
                HatchName::Pattern => Hatch::Pattern,
            },
            letters: self.letters.map(|letters| match letters {
                LettersName::Line => Letters::Line,
                LettersName::Outline => Letters::Outline,
            }),
            fonts: fonts.collect::<Result<_, Failure>>()?,
            finder: system.map(|system| FontFinder::new(move |family| system.find(family))),
        })
    }
}

impl UnitName {
    const fn length(self) -> Option<LengthUnit> {
        match self {
            Self::Mm => Some(LengthUnit::Millimetre),
            Self::Cm => Some(LengthUnit::Centimetre),
            Self::M => Some(LengthUnit::Metre),
            Self::In => Some(LengthUnit::Inch),
            Self::Ft => Some(LengthUnit::Foot),
            Self::Deg | Self::Rad => None,
        }
    }

    const fn angle(self) -> Option<AxisUnit> {
        match self {
            Self::Deg => Some(AxisUnit::Degrees),
            Self::Rad => Some(AxisUnit::Radians),
            _ => None,
        }
    }
}

/// A font in the program, in a file, which must be one, or of a family that the system has.
fn font(name: &str, system: Option<&SystemFonts>) -> Result<Font, Failure> {
    let of_system = || system.filter(|_| !Path::new(name).exists())?.find(name).into_iter().next();
    let bytes: Arc<[u8]> = match bundled(name) {
        Some(bytes) => bytes.into(),
        None => match of_system() {
            Some(font) => return Ok(font),
            None => files::read(name)?.into(),
        },
    };
    kind_of(name, &bytes).map_err(|e| Failure::usage("malformed", e.to_string()))?;
    Ok(Font { name: name.to_owned(), bytes })
}

/// The one unit of its kind, if there is any.
fn only<T>(mut units: impl Iterator<Item = T>) -> Result<Option<T>, Failure> {
    let first = units.next();
    match units.next() {
        None => Ok(first),
        Some(_) => Err(Failure::usage("usage", "--unit is given twice for the same thing: leave one out")),
    }
}

/// Pixels to an inch, within what screens and printers have.
fn dpi(text: &str) -> Result<f64, String> {
    const LEAST: f64 = 1.0;
    const MOST: f64 = 100_000.0;
    let number = text.trim().strip_suffix("dpi").unwrap_or(text).trim();
    match number.parse::<f64>() {
        Ok(value) if (LEAST..=MOST).contains(&value) => Ok(value),
        Ok(_) => Err(format!("{text} is not between {LEAST} and {MOST} pixels to an inch")),
        Err(_) => Err(format!("{text} is no number of pixels to an inch, such as 96")),
    }
}
