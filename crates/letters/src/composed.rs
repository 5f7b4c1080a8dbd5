//! Letters that a single-line face lacks, composed of what it has.

use tracelight_stroke::{Affine, Vec2};
use unicode_normalization::char::{decompose_canonical, decompose_compatible, is_combining_mark};

use crate::drawn;
use crate::glyph::{Glyph, beside};
use crate::letter::Letter;
use crate::line_face::LineFace;
use crate::marks::{HIGH, Place, has_mark_beside, mark};
use crate::own_marks::upper;

/// Space between a letter and its marks, as a share of the height of capitals.
const GAP: f64 = 0.10;

/// The letter that a text begins with, how many characters of it that is, and the character before kerning is asked for; `None`
/// where the face has no such letter.
pub(crate) fn letter(face: &LineFace, text: &[char], before: Option<char>) -> Option<(Letter, f64)> {
    let &first = text.first()?;
    let kern = before.and_then(|before| face.kerns.get(&(before, first))).copied().unwrap_or(0.0);
    let (glyph, chars) = face.longest_own(text).map_or_else(|| composed(face, text), Some)?;
    let has_outlines = face.has_outlines;
    Some((Letter { at: 0.0, chars, advance: glyph.advance, paths: glyph.paths, has_outlines }, kern))
}

fn composed(face: &LineFace, text: &[char]) -> Option<(Glyph, usize)> {
    const MOST_MARKS: usize = 4;
    let marks = text[1..].iter().take_while(|c| is_combining_mark(**c)).count();
    let all = &text[1..=marks];
    let glyph = match all {
        [] => glyph(face, text[0]),
        marks => marked(face, text[0], &marks[..marks.len().min(MOST_MARKS)]),
    };
    // parts may share a line
    glyph.map(|glyph| (if face.has_outlines { glyph } else { glyph.once() }, 1 + marks))
}

/// A letter of a face: its own, drawn from its parts, or of a base and marks; `None` where it has not even the parts.
pub(crate) fn glyph(face: &LineFace, letter: char) -> Option<Glyph> {
    if let Some(own) = face.own(letter) {
        return Some(own.clone());
    }
    if let Some(drawn) = drawn::letter(face, letter) {
        return Some(drawn);
    }
    let mut parts = Vec::new();
    decompose_canonical(letter, |part| parts.push(part));
    let (&base, marks) = parts.split_first()?;
    if base != letter {
        return marked(face, base, marks);
    }
    similar(face, letter)
}

/// A base with its marks.
pub(crate) fn marked(face: &LineFace, base: char, marks: &[char]) -> Option<Glyph> {
    let is_above = |mark: &char| matches!(*mark, '\u{300}'..='\u{315}');
    let mut all = match base {
        'i' | 'j' if marks.iter().any(is_above) => drawn::without_dot(face, base)?,
        _ => glyph(face, base)?,
    };
    for &combining in marks {
        all = attached(face, all, (combining, base))?;
    }
    Some(all)
}

/// A letter with one more mark: the face's own where it has that, else one drawn here, of the size of the face's own.
fn attached(face: &LineFace, letter: Glyph, (combining, base): (char, char)) -> Option<Glyph> {
    let c = face.capital;
    let (Some(bounds), Some(upper)) = (letter.bounds(), upper(&letter)) else { return Some(letter) };
    let middle = upper.center().x;
    if let Some(own) = own_mark(face, combining, base) {
        return Some(letter.with(own.shifted(middle, bounds.y1).paths));
    }
    let mark = mark(combining, base, face.dot())?;
    let lower = bounds.y0 + 0.12 * bounds.height();
    let foot = letter.below(lower).unwrap_or(bounds);
    let (gap, size) = if mark.place == Place::Above { usual(face, base) } else { (GAP * c, c) };
    let at = match mark.place {
        Place::Above => (middle, bounds.y1 + gap),
        Place::Below => (foot.center().x, bounds.y0 - gap),
        Place::Foot => (foot.center().x, bounds.y0),
        Place::RightFoot => right_foot(&letter, foot.x0 + 0.8 * foot.width(), lower),
        Place::Beside => (upper.x1 + 0.14 * c, bounds.y1),
    };
    let place = Affine::translate(Vec2::from(at)) * Affine::scale(size);
    let wider = if mark.place == Place::Beside { 0.12 * c } else { 0.0 };
    let advance = letter.advance + wider;
    Some(Glyph { advance, ..letter }.with(mark.paths.iter().map(|path| path.transformed(place))))
}

/// The face's own mark about the top of a letter, or one made of its own: a caron is a circumflex upside down, a double acute is two.
fn own_mark(face: &LineFace, combining: char, base: char) -> Option<Glyph> {
    const APART: f64 = 0.1; // of the height of capitals, either way
    let own = |mark: char| face.marks.get(mark, base.is_uppercase()).cloned();
    match combining {
        '\u{30c}' if !has_mark_beside(base) => own(combining).or_else(|| {
            let circumflex = own('\u{302}')?;
            let bounds = circumflex.bounds()?;
            Some(circumflex.mapped(Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, bounds.y0 + bounds.y1])))
        }),
        '\u{30b}' => own(combining).or_else(|| {
            let acute = own('\u{301}')?;
            let second = acute.clone().shifted(APART * face.capital, 0.0);
            Some(acute.shifted(-APART * face.capital, 0.0).with(second.paths))
        }),
        '\u{30c}' => None,
        _ => own(combining),
    }
}

/// The space below marks that are drawn here, and the size of what is drawn for capitals of height 1, em: as the face's own acute has them.
fn usual(face: &LineFace, base: char) -> (f64, f64) {
    let c = face.capital;
    let acute = face.marks.get('\u{301}', base.is_uppercase()).and_then(Glyph::bounds);
    acute.map_or((GAP * c, c), |acute| {
        (acute.y0.clamp(0.05 * c, 0.3 * c), (acute.height() / HIGH).clamp(0.6 * c, 1.4 * c))
    })
}

/// The point of a letter's foot that is nearest to `x`: what is joined there touches ink.
fn right_foot(letter: &Glyph, x: f64, lower: f64) -> (f64, f64) {
    let points = letter.points().filter(|point| point.y <= lower);
    let nearest = points.min_by(|a, b| (a.x - x).abs().total_cmp(&(b.x - x).abs()));
    nearest.map_or((x, 0.0), |point| (point.x, point.y))
}

/// Something that reads alike: `…` as three dots, `ﬁ` as two letters, a non-breaking space as a space.
fn similar(face: &LineFace, letter: char) -> Option<Glyph> {
    let mut parts = Vec::new();
    decompose_compatible(letter, |part| parts.push(part));
    if parts == [letter] || parts.iter().any(|&part| is_combining_mark(part)) {
        return None;
    }
    let mut all = Glyph::default();
    for part in parts {
        let own = face.own(part).cloned().or_else(|| drawn::letter(face, part))?;
        all = beside(all, own);
    }
    Some(all)
}
