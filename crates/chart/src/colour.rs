//! Colours of curves.

use plotters::prelude::RGBColor;

use crate::theme::Theme;

/// Colours that people who see red and green alike can tell apart (Okabe and Ito, "Color universal design", 2008).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// #D55E00.
    Vermilion,
    /// #0072B2.
    Blue,
    /// #009E73.
    Green,
    /// #CC79A7.
    Purple,
    /// #E69F00.
    Orange,
    /// #56B4E9.
    Sky,
    /// The ink of the ground.
    Black,
    /// Of what only helps.
    Grey,
}

impl Colour {
    /// Of curves that have none of their own, again from the first once there are no more.
    pub fn in_turn() -> impl Iterator<Item = Self> + Clone {
        [Self::Blue, Self::Vermilion, Self::Green, Self::Purple, Self::Orange, Self::Sky].into_iter().cycle()
    }

    pub(crate) const fn rgb(self, theme: Theme) -> RGBColor {
        if matches!(theme, Theme::Dark) {
            return self.on_dark();
        }
        match self {
            Colour::Vermilion => RGBColor(213, 94, 0),
            Colour::Blue => RGBColor(0, 114, 178),
            Colour::Green => RGBColor(0, 158, 115),
            Colour::Purple => RGBColor(204, 121, 167),
            Colour::Orange => RGBColor(230, 159, 0),
            Colour::Sky => RGBColor(86, 180, 233),
            Colour::Black => RGBColor(20, 20, 20),
            Colour::Grey => RGBColor(125, 125, 125),
        }
    }

    /// The same, lighter where they would be too dark.
    const fn on_dark(self) -> RGBColor {
        match self {
            Colour::Vermilion => RGBColor(240, 120, 50),
            Colour::Blue => RGBColor(70, 160, 230),
            Colour::Green => RGBColor(40, 190, 140),
            Colour::Purple => RGBColor(220, 140, 185),
            Colour::Orange => RGBColor(240, 180, 40),
            Colour::Sky => RGBColor(120, 200, 245),
            Colour::Black => RGBColor(235, 235, 235),
            Colour::Grey => RGBColor(150, 150, 150),
        }
    }
}
