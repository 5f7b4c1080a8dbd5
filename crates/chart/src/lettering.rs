//! Letters of a figure: their sizes, and what room they take.

use plotters::prelude::IntoFont;
use plotters::style::TextStyle;

use crate::rgb::Rgb;

/// The drawing library rounds to whole units: so many of them make a pixel.
pub(crate) const FINE: i32 = 8;
/// What is written, pixels. Where a page has too little room its figures shrink to eleven twelfths and no further: no letters below 11.
pub(crate) const LARGE: i32 = 16;
pub(crate) const NORMAL: i32 = 13;
pub(crate) const SMALL: i32 = 12;
/// The drawing library takes the height of a font's box, and writes the font's size as this much less.
const BOX: f64 = 1.24;

/// Letters so large, pixels.
pub(crate) fn lettering<'a>(pixels: i32, colour: Rgb) -> TextStyle<'a> {
    ("sans-serif", BOX * f64::from(FINE * pixels)).into_font().color(&colour.plotted())
}

/// What a text takes at most in a usual sans-serif font, pixels: DejaVu Sans, that of the PNG files, is among the widest.
pub(crate) fn width_px(text: &str, pixels: i32) -> f64 {
    let em = |c: char| match c {
        'i' | 'l' | 'j' | '.' | ',' | ':' | ';' | '\'' | '|' | ' ' | '(' | ')' | '/' | 'I' | 't' | 'f'
        | 'r' => 0.36,
        'm' | 'w' | 'M' | 'W' | '%' => 0.93,
        '=' | '−' | '+' | '±' | '→' | '∞' | 'ω' => 0.84,
        _ => 0.62,
    };
    f64::from(pixels) * text.chars().map(em).sum::<f64>()
}
