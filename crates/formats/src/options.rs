use std::fmt;
use std::sync::Arc;

/// How a drawing file is read. By default as it is seen, in the size that the file gives.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadOptions {
    /// Lines that something painted later covers.
    pub hidden: Hidden,
    /// Cut off what lies outside the page, clip paths and nested viewports.
    pub crop: bool,
    /// Draw dashed lines as dashes; otherwise as whole lines.
    pub dashes: bool,
    /// Length of a unit of a DXF, in place of what the file says.
    pub unit: Option<LengthUnit>,
    /// Pixels to an inch of an SVG whose size is in pixels; it has no physical size without it.
    pub dpi: Option<f64>,
    /// What of a DXF's hatch is drawn.
    pub hatch: Hatch,
    /// How letters are drawn; as the kind of file has it where nothing is asked for.
    pub letters: Option<Letters>,
    /// Fonts for the drawing's text, the first that has a glyph is taken.
    pub fonts: Vec<Font>,
    /// Where fonts are found that an SVG's text names, if that is asked for.
    pub finder: Option<FontFinder>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            hidden: Hidden::Cut,
            crop: true,
            dashes: true,
            unit: None,
            dpi: None,
            hatch: Hatch::Boundary,
            letters: None,
            fonts: Vec::new(),
            finder: None,
        }
    }
}

/// Lines that something painted later covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hidden {
    /// Not drawn, as nobody sees them.
    #[default]
    Cut,
    /// Drawn, as a template for cutting needs them.
    Keep,
}

/// What of a hatch is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hatch {
    /// The edge of the hatched area.
    #[default]
    Boundary,
    /// The edge, and the lines of its pattern.
    Pattern,
}

/// How letters are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Letters {
    /// Each stroke of a letter as one line.
    Line,
    /// The edges of the letters.
    Outline,
}

/// A unit in which a drawing's numbers may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetres.
    Millimetre,
    /// Centimetres.
    Centimetre,
    /// Metres.
    Metre,
    /// Inches.
    Inch,
    /// Feet.
    Foot,
}

impl LengthUnit {
    /// All of them, the smallest first.
    pub const ALL: [Self; 5] = [Self::Millimetre, Self::Centimetre, Self::Inch, Self::Foot, Self::Metre];

    /// Length in metres.
    #[must_use]
    pub const fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Metre => 1.0,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
        }
    }

    /// Symbol, as `--unit` takes it.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }
}

/// A font file: TrueType, OpenType, or a font in SVG.
#[derive(Clone, PartialEq)]
pub struct Font {
    /// Name for messages.
    pub name: String,
    /// Content of the file.
    pub bytes: Arc<[u8]>,
}

impl fmt::Debug for Font {
    /// The name and a checksum (FNV-1a): what is made with a font is known by what is printed here.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        const PRIME: u64 = 0x0000_0100_0000_01b3;
        let sum = self.bytes.iter().fold(BASIS, |sum, &byte| (sum ^ u64::from(byte)).wrapping_mul(PRIME));
        write!(f, "Font({}, {sum:016x})", self.name)
    }
}

/// Finds the fonts of a family by its name.
type Find = dyn Fn(&str) -> Vec<Font> + Send + Sync;

/// Way to the fonts of a family, such as those of a computer.
#[derive(Clone)]
pub struct FontFinder(Arc<Find>);

impl FontFinder {
    /// A finder that calls `find` with the name of a family.
    pub fn new(find: impl Fn(&str) -> Vec<Font> + Send + Sync + 'static) -> Self {
        Self(Arc::new(find))
    }

    /// The fonts of a family; none where it is not there.
    #[must_use]
    pub fn find(&self, family: &str) -> Vec<Font> {
        (self.0)(family)
    }
}

impl PartialEq for FontFinder {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for FontFinder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("FontFinder")
    }
}
