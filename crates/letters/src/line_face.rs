//! Faces whose letters are single lines, or whatever else a font in SVG holds.

use std::collections::{BTreeMap, HashMap};

use unicode_normalization::char::is_combining_mark;

use crate::error::LettersError;
use crate::glyph::{Glyph, line};
use crate::own_marks::OwnMarks;
use crate::svg_font::SvgFont;

/// A face of an SVG font.
pub(crate) struct LineFace {
    glyphs: BTreeMap<String, Glyph>,
    pub(crate) kerns: HashMap<(char, char), f64>,
    longest: usize,
    /// The edges of letters, not their strokes.
    pub(crate) has_outlines: bool,
    /// Height of capitals, em.
    pub(crate) capital: f64,
    /// Height of small letters without ascender, em.
    pub(crate) small: f64,
    /// Its full stop about the origin.
    dot: Glyph,
    /// Its own accents.
    pub(crate) marks: OwnMarks,
}

impl LineFace {
    /// Reads a font.
    ///
    /// # Errors
    /// See [`SvgFont::read`].
    pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Self, LettersError> {
        let SvgFont { mut glyphs, kerns, longest, has_outlines } = SvgFont::read(name, bytes)?;
        if !has_outlines {
            // pens go back over some of their lines
            glyphs.values_mut().for_each(|glyph| *glyph = std::mem::take(glyph).once());
        }
        stand_on_baseline(&mut glyphs);
        let marks = OwnMarks::take(&mut glyphs);
        let top = |letter: &str| glyphs.get(letter).and_then(Glyph::bounds).map(|bounds| bounds.y1);
        // what fonts say of their heights is often wrong: measured
        let sound = |height: &f64| *height > 0.05 && *height < 5.0;
        let capital = top("H").or_else(|| top("E")).or_else(|| top("x").map(|x| 1.4 * x)).filter(sound);
        let capital = capital.unwrap_or(0.7);
        let small = top("x").filter(sound).unwrap_or(0.7 * capital);
        let dot = dot(&glyphs, 0.06 * capital);
        Ok(Self { glyphs, kerns, longest, has_outlines, capital, small, dot, marks })
    }

    /// The font's own glyph of a letter.
    pub(crate) fn own(&self, letter: char) -> Option<&Glyph> {
        self.glyphs.get(letter.encode_utf8(&mut [0; 4]) as &str)
    }

    /// The full stop about the origin.
    pub(crate) const fn dot(&self) -> &Glyph {
        &self.dot
    }

    /// The longest glyph of the font's own that a text begins with, and how many characters of it that is.
    pub(crate) fn longest_own(&self, text: &[char]) -> Option<(Glyph, usize)> {
        let marks = text[1..].iter().take_while(|c| is_combining_mark(**c)).count();
        let ligature = (2..=self.longest.min(text.len())).rev().find_map(|chars| {
            let glyph = self.glyphs.get(&text[..chars].iter().collect::<String>())?;
            Some((glyph.clone(), chars))
        });
        let single = || self.own(text[0]).filter(|_| marks == 0).map(|glyph| (glyph.clone(), 1));
        ligature.or_else(single)
    }
}

/// Lets capitals stand on y = 0: fonts traced from others hover by half of the others' strokes.
fn stand_on_baseline(glyphs: &mut BTreeMap<String, Glyph>) {
    const MOST: f64 = 0.1;
    let foot = glyphs.get("H").and_then(Glyph::bounds).map_or(0.0, |bounds| bounds.y0);
    if foot != 0.0 && foot.abs() <= MOST {
        for glyph in glyphs.values_mut() {
            *glyph = std::mem::take(glyph).shifted(0.0, -foot);
        }
    }
}

/// The full stop about the origin; a square where there is none.
fn dot(glyphs: &BTreeMap<String, Glyph>, size: f64) -> Glyph {
    let own = glyphs.get(".").and_then(|glyph| Some((glyph.clone(), glyph.bounds()?)));
    match own {
        Some((glyph, bounds)) => glyph.shifted(-bounds.center().x, -bounds.center().y),
        None => {
            let half = 0.5 * size;
            let mut square = line(&[(-half, -half), (half, -half), (half, half), (-half, half)]);
            square.close();
            Glyph { paths: vec![square], advance: 0.0 }
        }
    }
}
