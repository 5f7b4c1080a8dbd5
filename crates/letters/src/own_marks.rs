//! Accents as a font itself draws them, so that the letters that it lacks have the accents of those that it has: É is E with
//! something above, and that is what Ź gets.

use std::collections::{BTreeMap, BTreeSet};

use tracelight_stroke::{Point, Rect};
use unicode_normalization::char::decompose_canonical;

use crate::glyph::Glyph;

/// A font's own accents by their combining character, of capitals and of small letters: em, about the top of the letter below.
#[derive(Default)]
pub(crate) struct OwnMarks(BTreeMap<(char, bool), Glyph>);

/// Letters with one mark above or below them, in the languages of Europe: Latin-1, Latin Extended-A, Romanian.
fn accented() -> impl Iterator<Item = (char, char, char)> {
    let letters = (0xc0..0x180_u32).chain(0x218..0x21c).filter_map(char::from_u32);
    letters.filter_map(|letter| {
        let mut parts = Vec::new();
        decompose_canonical(letter, |part| parts.push(part));
        match parts[..] {
            [base, mark] => Some((letter, base, mark)),
            _ => None,
        }
    })
}

impl OwnMarks {
    /// Takes the accents of a font's letters. Letters are taken out whose accent cannot be told from the letter, if the font lacks
    /// others of that accent: these and those are then composed alike.
    pub(crate) fn take(glyphs: &mut BTreeMap<String, Glyph>) -> Self {
        let mut own = Self::default();
        let mut lacking = BTreeSet::new();
        for (letter, base, mark) in accented() {
            match glyphs.get(letter.encode_utf8(&mut [0; 4]) as &str) {
                Some(glyph) => {
                    own.note(glyph, glyphs.get(base.encode_utf8(&mut [0; 4]) as &str), (base, mark))
                }
                None => drop(lacking.insert(mark)),
            }
        }
        let is_composed = |mark: &char| lacking.contains(mark) && own.get(*mark, true).is_none();
        for (letter, _, _) in accented().filter(|(.., mark)| is_composed(mark)) {
            glyphs.remove(letter.encode_utf8(&mut [0; 4]) as &str);
        }
        own
    }

    /// Notes what a letter has above its base.
    fn note(&mut self, letter: &Glyph, base: Option<&Glyph>, (base_letter, mark): (char, char)) {
        let Some(base) = base else { return };
        let Some(anchor) = top(base) else { return };
        let mut rest = letter.clone();
        rest.paths.retain(|path| !base.paths.contains(path));
        let is_whole = rest.paths.len() + base.paths.len() == letter.paths.len();
        let is_above = rest.bounds().is_some_and(|mark| mark.y0 > anchor.y);
        if is_whole && is_above {
            let about = rest.shifted(-anchor.x, -anchor.y);
            self.0.entry((mark, base_letter.is_uppercase())).or_insert(about);
        }
    }

    /// An accent for a capital or a small letter; that of the other kind where there is none of this.
    pub(crate) fn get(&self, mark: char, is_capital: bool) -> Option<&Glyph> {
        self.0.get(&(mark, is_capital)).or_else(|| self.0.get(&(mark, !is_capital)))
    }
}

/// The middle of a letter's upper part, at its upper edge: accents stand above it.
fn top(letter: &Glyph) -> Option<Point> {
    upper(letter).map(|upper| Point::new(upper.center().x, upper.y1))
}

/// Where a letter's upper part is.
pub(crate) fn upper(letter: &Glyph) -> Option<Rect> {
    let bounds = letter.bounds()?;
    Some(letter.above(bounds.y1 - 0.3 * bounds.height()).unwrap_or(bounds))
}
