//! Letters without a decomposition that single-line faces lack: made of the face's other letters and a line, or drawn.

use tracelight_stroke::{Affine, Path, Rect};

use crate::glyph::{Glyph, beside, curve, line};
use crate::line_face::LineFace;
use crate::marks::{HALF_TURN, ring, tick};

/// A letter made of other letters of the face; `None` for one that is not known here, or whose parts the face lacks.
pub(crate) fn letter(face: &LineFace, letter: char) -> Option<Glyph> {
    let own = |letter: char| face.own(letter).cloned();
    match letter {
        'ı' => without_dot(face, 'i'),
        'ȷ' => without_dot(face, 'j'),
        'Ø' | 'ø' => slashed(own(if letter == 'Ø' { 'O' } else { 'o' })?),
        'Ł' | 'ł' => stem_slashed(face, own(if letter == 'Ł' { 'L' } else { 'l' })?),
        'Đ' | 'Ð' | 'Ħ' | 'Ŧ' | 'đ' | 'ħ' | 'ŧ' => barred(face, letter),
        'Æ' | 'æ' | 'Œ' | 'œ' => joined(face, letter),
        'ĳ' => Some(beside(own('i')?, own('j')?)),
        'Ĳ' => Some(beside(own('I')?, own('J')?)),
        'ŀ' => Some(beside(own('l')?, own('·')?)),
        'Ŀ' => Some(beside(own('L')?, own('·')?)),
        'ŉ' => Some(beside(quote(face, false), own('n')?)),
        'ẞ' => own('ß'),
        'Ə' | 'ə' | 'Ʒ' | 'ʒ' | 'Ǥ' | 'ǥ' => turned(face, letter),
        'ß' | 'ſ' | 'Þ' | 'þ' | 'ð' | 'ŋ' | 'Ŋ' | 'ĸ' | 'µ' | 'μ' => other(face, letter),
        _ => sign(face, letter),
    }
}

/// Signs that are no letters.
fn sign(face: &LineFace, sign: char) -> Option<Glyph> {
    let own = |letter: char| face.own(letter).cloned();
    let c = face.capital;
    let blank = |advance: f64| Some(Glyph { paths: Vec::new(), advance });
    match sign {
        '\u{a0}' | '\u{2007}' | '\u{202f}' => own(' ').or_else(|| blank(0.4)),
        '\u{2000}'..='\u{2006}' | '\u{2008}'..='\u{200a}' => blank(0.2),
        '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}' | '\u{feff}' => blank(0.0),
        '‐' | '‑' => own('-'),
        '−' => own('+').and_then(|plus| Some(minus(&plus, plus.bounds()?))),
        '–' | '—' => own('-')
            .and_then(|hyphen| Some(dash(&hyphen, hyphen.bounds()?, if sign == '–' { 1.5 } else { 2.5 }))),
        '’' => Some(quote(face, false)),
        '‘' => Some(quote(face, true)),
        '”' => Some(beside(quote(face, false), quote(face, false))),
        '“' => Some(beside(quote(face, true), quote(face, true))),
        '‚' => own(','),
        '„' => Some(beside(own(',')?, own(',')?)),
        '•' => {
            let up = Affine::translate((0.25 * c, 0.3 * c)) * Affine::scale(c);
            Some(Glyph { paths: moved(ring(0.12), up), advance: 0.5 * c })
        }
        '‰' => {
            let (percent, zero) = (own('%')?, own('0')?);
            Some(beside(percent, Glyph { advance: 0.5 * zero.advance, ..zero.mapped(Affine::scale(0.5)) }))
        }
        '§' => {
            let small = own('S')?.mapped(Affine::scale(0.62));
            let upper = small.clone().shifted(0.0, 0.38 * c);
            Some(Glyph { advance: 0.62 * small.advance, ..small }.with(upper.paths))
        }
        '¶' => Some(drawn(
            c,
            0.75,
            vec![
                line(&[(0.38, 0.0), (0.38, 1.0)]),
                line(&[(0.62, 0.0), (0.62, 1.0), (0.38, 1.0)]),
                curve([(0.38, 1.0), (0.02, 1.0), (0.02, 0.46), (0.38, 0.46)]),
            ],
        )),
        '¤' => {
            let rays = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
            let ray = |(x, y): (f64, f64)| {
                line(&[(0.35 + 0.14 * x, 0.4 + 0.14 * y), (0.35 + 0.25 * x, 0.4 + 0.25 * y)])
            };
            let round = moved(ring(0.2), Affine::translate((0.35, 0.2)));
            Some(drawn(c, 0.7, rays.map(ray).into_iter().chain(round).collect()))
        }
        '¬' => Some(drawn(c, 0.8, vec![line(&[(0.1, 0.55), (0.7, 0.55), (0.7, 0.35)])])),
        '¯' => Some(drawn(c, 0.5, vec![line(&[(0.08, 1.0), (0.42, 1.0)])])),
        '⌀' | '∅' => letter(face, 'Ø').or_else(|| own('Ø')),
        '≤' | '≥' => {
            let sharp = own(if sign == '≤' { '<' } else { '>' })?;
            let bounds = sharp.bounds()?;
            Some(sharp.with([line(&[(bounds.x0, bounds.y0 - 0.1 * c), (bounds.x1, bounds.y0 - 0.1 * c)])]))
        }
        '≠' => {
            let equals = own('=')?;
            let (at, (x, y)) = (equals.bounds()?.center(), (0.12 * c, 0.26 * c));
            Some(equals.with([line(&[(at.x - x, at.y - y), (at.x + x, at.y + y)])]))
        }
        _ => None,
    }
}

/// `i` or `j` without what is over it.
pub(crate) fn without_dot(face: &LineFace, letter: char) -> Option<Glyph> {
    let dotted = face.own(letter)?.clone();
    let is_under = |path: &Path| {
        let lowest = path.flatten(1e-3).iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
        lowest < 0.98 * face.small
    };
    let paths: Vec<Path> = dotted.paths.iter().filter(|path| is_under(path)).cloned().collect();
    (!paths.is_empty()).then_some(Glyph { paths, ..dotted })
}

fn moved(paths: Vec<Path>, by: Affine) -> Vec<Path> {
    paths.iter().map(|path| path.transformed(by)).collect()
}

/// Something drawn in heights of capitals.
fn drawn(capital: f64, advance: f64, paths: Vec<Path>) -> Glyph {
    Glyph { paths, advance }.mapped(Affine::scale(capital)).scaled_advance(capital)
}

impl Glyph {
    fn scaled_advance(self, by: f64) -> Self {
        Self { advance: self.advance * by, ..self }
    }
}

/// With a line from lower left to upper right.
fn slashed(round: Glyph) -> Option<Glyph> {
    let Rect { x0, y0, x1, y1 } = round.bounds()?;
    let (over_x, over_y) = (0.06 * (x1 - x0), 0.08 * (y1 - y0));
    Some(round.with([line(&[(x0 - over_x, y0 - over_y), (x1 + over_x, y1 + over_y)])]))
}

/// `L` or `l` with a short line across its stem.
fn stem_slashed(face: &LineFace, stem: Glyph) -> Option<Glyph> {
    let c = face.capital;
    let bounds = stem.bounds()?;
    // where the stem is half-way up
    let x = stem.above(bounds.y0 + 0.7 * bounds.height())?.center().x;
    let y = bounds.y0 + 0.5 * bounds.height();
    Some(stem.with([line(&[(x - 0.15 * c, y - 0.10 * c), (x + 0.19 * c, y + 0.12 * c)])]))
}

/// A letter with a level line across a stem.
fn barred(face: &LineFace, letter: char) -> Option<Glyph> {
    let c = face.capital;
    let base = match letter {
        'Đ' | 'Ð' => 'D',
        'Ħ' => 'H',
        'Ŧ' => 'T',
        'đ' => 'd',
        'ħ' => 'h',
        _ => 't',
    };
    let glyph = face.own(base)?.clone();
    let bounds = glyph.bounds()?;
    // the stem of a small letter is all that is up there
    let stem = glyph.above(0.5 * (face.small + bounds.y1)).unwrap_or(bounds).center().x;
    let over = 0.5 * (face.small + bounds.y1);
    let (from, to, y) = match base {
        'D' => (bounds.x0 - 0.13 * c, bounds.x0 + 0.22 * c, 0.5 * c),
        'H' => (bounds.x0 - 0.09 * c, bounds.x1 + 0.09 * c, 0.76 * c),
        'T' => (bounds.center().x - 0.18 * c, bounds.center().x + 0.18 * c, 0.45 * c),
        'd' => (stem - 0.22 * c, stem + 0.12 * c, over),
        'h' => (stem - 0.12 * c, stem + 0.22 * c, over),
        _ => (stem - 0.15 * c, stem + 0.15 * c, 0.55 * face.small),
    };
    Some(glyph.with([line(&[(from, y), (to, y)])]))
}

/// Letters of Azerbaijani and Sami: e turned about, 3 as a letter, G and g with a line.
fn turned(face: &LineFace, letter: char) -> Option<Glyph> {
    let (c, x) = (face.capital, face.small);
    let own = |letter: char| face.own(letter).cloned();
    match letter {
        'Ə' | 'ə' => {
            let e = own('e')?;
            let (middle, advance) = (e.bounds()?.center(), e.advance);
            let about = Affine::translate(middle.to_vec2() * 2.0) * HALF_TURN;
            let schwa = e.mapped(about);
            let size = if letter == 'Ə' { c / x } else { 1.0 };
            Some(Glyph { advance, ..schwa.mapped(Affine::scale(size)) }.scaled_advance(size))
        }
        'Ʒ' => own('3'),
        'ʒ' => own('3').map(|three| three.shifted(0.0, x - c)),
        _ => {
            let g = own(if letter == 'Ǥ' { 'G' } else { 'g' })?;
            let right = g.bounds()?.x1;
            let y = if letter == 'Ǥ' { 0.22 * c } else { -0.12 * c };
            Some(g.with([line(&[(right - 0.24 * c, y), (right + 0.12 * c, y)])]))
        }
    }
}

/// Two letters that share a side.
fn joined(face: &LineFace, letter: char) -> Option<Glyph> {
    let (first, second) = match letter {
        'Æ' => return Some(ae(face.capital)),
        'Œ' => ('O', 'E'),
        'œ' => ('o', 'e'),
        _ => ('a', 'e'),
    };
    let (first, second) = (face.own(first)?.clone(), face.own(second)?.clone());
    let to_the_left = first.bounds()?.x1 - second.bounds()?.x0;
    let advance = to_the_left + second.advance;
    let second = second.shifted(to_the_left, 0.0);
    Some(Glyph { advance, ..first }.with(second.paths))
}

fn ae(capital: f64) -> Glyph {
    drawn(
        capital,
        1.28,
        vec![
            line(&[(0.08, 0.0), (0.60, 1.0), (1.18, 1.0)]),
            line(&[(0.66, 1.0), (0.66, 0.0), (1.20, 0.0)]),
            line(&[(0.66, 0.52), (1.10, 0.52)]),
            line(&[(0.25, 0.33), (0.66, 0.33)]),
        ],
    )
}

fn other(face: &LineFace, letter: char) -> Option<Glyph> {
    let (c, x) = (face.capital, face.small);
    let own = |letter: char| face.own(letter).cloned();
    match letter {
        'ß' => Some(drawn(
            c,
            0.75,
            vec![
                line(&[(0.1, 0.0), (0.1, 0.72)]),
                curve([(0.1, 0.72), (0.1, 1.1), (0.56, 1.08), (0.52, 0.78)]),
                curve([(0.52, 0.78), (0.48, 0.62), (0.3, 0.6), (0.34, 0.5)]),
                curve([(0.34, 0.5), (0.42, 0.36), (0.64, 0.36), (0.62, 0.18)]),
                curve([(0.62, 0.18), (0.6, -0.02), (0.36, -0.04), (0.26, 0.06)]),
            ],
        )),
        'ſ' => Some(drawn(
            c,
            0.42,
            vec![
                line(&[(0.14, 0.0), (0.14, 0.76)]),
                curve([(0.14, 0.76), (0.14, 0.98), (0.24, 1.04), (0.40, 1.0)]),
                line(&[(0.04, 0.66), (0.14, 0.66)]),
            ],
        )),
        'Þ' => Some(drawn(
            c,
            0.82,
            vec![
                line(&[(0.12, 0.0), (0.12, 1.0)]),
                line(&[(0.12, 0.78), (0.42, 0.78)]),
                curve([(0.42, 0.78), (0.80, 0.78), (0.80, 0.24), (0.42, 0.24)]),
                line(&[(0.42, 0.24), (0.12, 0.24)]),
            ],
        )),
        'þ' => {
            let p = own('p')?;
            let left = p.below(0.0)?.x0;
            let top = own('b').and_then(|b| b.bounds()).map_or(c, |bounds| bounds.y1);
            Some(p.with([line(&[(left, 0.9 * x), (left, top)])]))
        }
        'ð' => {
            let o = own('o')?;
            let Rect { x0, x1, .. } = o.bounds()?;
            let (w, y) = (x1 - x0, 0.5 * x);
            let back = curve([(x1, y), (x1, 0.75 * c), (x0 + 0.6 * w, c), (x0 + 0.2 * w, 1.05 * c)]);
            Some(o.with([back, line(&[(x0 + 0.2 * w, 0.82 * c), (x0 + 0.85 * w, 1.0 * c)])]))
        }
        'ŋ' | 'Ŋ' => {
            let n = own(if letter == 'ŋ' { 'n' } else { 'N' })?;
            let foot = n.below(0.12 * c)?;
            let (r, y) = (foot.x1, foot.y0);
            Some(n.with([curve([
                (r, y),
                (r, y - 0.22 * c),
                (r - 0.10 * c, y - 0.30 * c),
                (r - 0.26 * c, y - 0.26 * c),
            ])]))
        }
        'ĸ' => {
            let k = own('k')?;
            let low = x / k.bounds()?.y1.max(x);
            Some(k.mapped(Affine::scale_non_uniform(1.0, low)))
        }
        _ => {
            let u = own('u')?;
            let Rect { x0, .. } = u.bounds()?;
            Some(u.with([line(&[(x0, 0.5 * x), (x0, -0.32 * c)])]))
        }
    }
}

/// A single quotation mark: the one that ends a quotation, or the one that opens it.
fn quote(face: &LineFace, opens: bool) -> Glyph {
    let c = face.capital;
    let turn = if opens { Affine::translate((0.0, -0.20)) * HALF_TURN } else { Affine::IDENTITY };
    let place = Affine::translate((0.14 * c, 1.02 * c)) * Affine::scale(c) * turn;
    Glyph { paths: vec![tick().transformed(place)], advance: 0.28 * c }
}

/// The level bar of a plus.
fn minus(plus: &Glyph, bounds: Rect) -> Glyph {
    let y = bounds.center().y;
    Glyph { paths: vec![line(&[(bounds.x0, y), (bounds.x1, y)])], advance: plus.advance }
}

/// A longer hyphen.
fn dash(hyphen: &Glyph, bounds: Rect, times: f64) -> Glyph {
    let (y, more) = (bounds.center().y, (times - 1.0) * bounds.width());
    Glyph { paths: vec![line(&[(bounds.x0, y), (bounds.x1 + more, y)])], advance: hyphen.advance + more }
}
