//! Colours of a figure's ground and of what is written on it.

use plotters::prelude::RGBColor;

/// Light or dark ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// White.
    #[default]
    Light,
    /// Nearly black.
    Dark,
}

impl Theme {
    pub(crate) const fn ground(self) -> RGBColor {
        match self {
            Self::Light => RGBColor(255, 255, 255),
            Self::Dark => RGBColor(24, 26, 31),
        }
    }

    pub(crate) const fn ink(self) -> RGBColor {
        match self {
            Self::Light => RGBColor(51, 51, 51),
            Self::Dark => RGBColor(215, 215, 215),
        }
    }

    /// Of lines that only help.
    pub(crate) const fn faint(self) -> RGBColor {
        match self {
            Self::Light => RGBColor(225, 225, 225),
            Self::Dark => RGBColor(58, 61, 68),
        }
    }

    /// Of lines between those.
    pub(crate) const fn fainter(self) -> RGBColor {
        match self {
            Self::Light => RGBColor(242, 242, 242),
            Self::Dark => RGBColor(38, 41, 47),
        }
    }

    /// Of what is written at those.
    pub(crate) const fn dim(self) -> RGBColor {
        match self {
            Self::Light => RGBColor(140, 140, 140),
            Self::Dark => RGBColor(140, 145, 152),
        }
    }
}
