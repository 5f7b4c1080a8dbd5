//! Colours that are told apart by looking.

use tracelight_stroke::Colour;

/// Red, green and blue as a file has them, 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rgb([f64; 3]);

/// Steps of a colour's channels below which two colours look alike as parts of a picture: 6 % of white.
const SAME: f64 = 15.0;

/// Least of every channel of what is white or nearly so: what looks like white.
const WHITISH: f64 = 255.0 - SAME;

impl Rgb {
    pub(crate) const WHITE: Self = Self([255.0; 3]);
    pub(crate) const BLACK: Self = Self([0.0; 3]);

    /// Brightness, 0 to 1, as masks take it.
    pub(crate) fn luminance(self) -> f64 {
        let [r, g, b] = self.0;
        (0.2125 * r + 0.7154 * g + 0.0721 * b) / 255.0
    }

    pub(crate) fn is_whitish(self) -> bool {
        self.0.iter().all(|&channel| channel >= WHITISH)
    }

    pub(crate) fn looks_like(self, other: Self) -> bool {
        self.0.iter().zip(other.0).all(|(a, b)| (a - b).abs() <= SAME)
    }

    /// The colour that another one of that opacity makes on it.
    pub(crate) fn under(self, ink: Self, alpha: f64) -> Self {
        let [r, g, b] = [0, 1, 2].map(|i| self.0[i] * (1.0 - alpha) + ink.0[i] * alpha);
        Self([r, g, b])
    }
}

impl From<Colour> for Rgb {
    fn from(colour: Colour) -> Self {
        Self([colour.r, colour.g, colour.b].map(f64::from))
    }
}

/// What several layers look like.
#[derive(Clone, Debug)]
pub(crate) struct Look {
    /// Colour, as far as it is one.
    colour: Rgb,
    /// Things of several colours that show, the lowest first, with their opacity.
    mixed: Vec<(u32, f64)>,
}

impl Look {
    pub(crate) const fn of(paper: Rgb) -> Self {
        Self { colour: paper, mixed: Vec::new() }
    }

    /// Paints one colour over it.
    pub(crate) fn paint(&mut self, ink: Rgb, alpha: f64) {
        self.colour = self.colour.under(ink, alpha);
        if alpha >= 1.0 {
            self.mixed.clear();
        }
    }

    /// Paints something of several colours over it, known by its number.
    pub(crate) fn mix(&mut self, number: u32, alpha: f64) {
        if alpha >= 1.0 {
            self.mixed.clear();
        }
        self.colour = self.colour.under(Rgb([127.5; 3]), alpha);
        self.mixed.push((number, alpha));
    }

    /// Whether nobody can tell them apart.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let close = |(a, b): (&(u32, f64), &(u32, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= SAME / 255.0;
        self.colour.looks_like(other.colour)
            && self.mixed.len() == other.mixed.len()
            && self.mixed.iter().zip(&other.mixed).all(close)
    }

    /// Whether it is one colour that looks like that.
    pub(crate) fn is_plain(&self, colour: Rgb) -> bool {
        self.mixed.is_empty() && self.colour.looks_like(colour)
    }
}
