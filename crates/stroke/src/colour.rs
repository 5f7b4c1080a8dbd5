use std::fmt;

/// A colour as a drawing program has it: red, green and blue from 0 to 255, sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Colour {
    /// Red.
    pub r: u8,
    /// Green.
    pub g: u8,
    /// Blue.
    pub b: u8,
}

impl Colour {
    /// Ink on paper, where nothing else is said.
    pub const BLACK: Self = Self::new(0, 0, 0);
    /// Light on a wall, where nothing else is said.
    pub const WHITE: Self = Self::new(255, 255, 255);

    /// Of red, green and blue.
    pub const fn new(r: u8, g: u8, b: u8) -> Self {
        Self { r, g, b }
    }

    /// Of `0xRRGGBB`; higher bits are ignored.
    pub const fn from_rgb(rgb: u32) -> Self {
        Self::new((rgb >> 16) as u8, (rgb >> 8) as u8, rgb as u8)
    }

    /// Of `#RRGGBB`, in digits of either case; `None` for anything else.
    pub fn from_hex(text: &str) -> Option<Self> {
        let digits =
            text.strip_prefix('#').filter(|d| d.len() == 6 && d.bytes().all(|b| b.is_ascii_hexdigit()));
        u32::from_str_radix(digits?, 16).ok().map(Self::from_rgb)
    }
}

/// `#rrggbb`.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.r, self.g, self.b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_is_read_back_as_it_was_written() {
        for colour in [Colour::BLACK, Colour::WHITE, Colour::new(1, 0xab, 0x20)] {
            assert_eq!(Colour::from_hex(&colour.to_string()), Some(colour));
        }
        for text in ["", "#", "ff0000", "#ff00", "#ff00zz", "#+f0000", "#ff0000ff", "#é0000"] {
            assert_eq!(Colour::from_hex(text), None, "{text}");
        }
    }
}
