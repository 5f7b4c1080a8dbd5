//! Accents, drawn as single lines. Sizes are shares of the height of capitals.

use tracelight_stroke::{Affine, Path, Vec2};

use crate::glyph::{Glyph, curve, line};

/// Where a mark goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Over the letter, its lower edge at y = 0.
    Above,
    /// Under the letter, its upper edge at y = 0.
    Below,
    /// Joined to the letter's lower edge, in its middle.
    Foot,
    /// Joined to the letter's lower edge, at its right.
    RightFoot,
    /// After the letter, its upper edge at the letter's.
    Beside,
}

/// A mark about x = 0.
pub(crate) struct Mark {
    pub(crate) place: Place,
    pub(crate) paths: Vec<Path>,
}

/// Height of most marks.
pub(crate) const HIGH: f64 = 0.19;

/// The mark of a combining character on a base; `None` for one that is not drawn here. `dot` is the face's own dot about the origin.
pub(crate) fn mark(combining: char, base: char, dot: &Glyph) -> Option<Mark> {
    let above = |paths| Some(Mark { place: Place::Above, paths });
    let below = |paths| Some(Mark { place: Place::Below, paths });
    match combining {
        '\u{300}' => above(vec![line(&[(-0.10, HIGH), (0.05, 0.0)])]),
        '\u{301}' => above(vec![acute(0.0)]),
        '\u{302}' => above(vec![line(&[(-0.13, 0.0), (0.0, HIGH), (0.13, 0.0)])]),
        '\u{303}' => above(vec![curve([(-0.17, 0.02), (-0.09, 0.20), (0.09, -0.06), (0.17, 0.12)])]),
        '\u{304}' => above(vec![line(&[(-0.15, 0.07), (0.15, 0.07)])]),
        '\u{306}' => above(vec![curve([(-0.14, 0.15), (-0.11, -0.05), (0.11, -0.05), (0.14, 0.15)])]),
        '\u{307}' => above(dots(dot, &[0.0])),
        '\u{308}' => above(dots(dot, &[-0.13, 0.13])),
        '\u{30a}' => above(ring(0.095)),
        '\u{30b}' => above(vec![acute(-0.08), acute(0.12)]),
        '\u{30c}' if has_mark_beside(base) => Some(Mark { place: Place::Beside, paths: vec![tick()] }),
        '\u{30c}' => above(vec![line(&[(-0.13, HIGH), (0.0, 0.0), (0.13, HIGH)])]),
        '\u{30f}' => above(vec![line(&[(-0.18, HIGH), (-0.06, 0.0)]), line(&[(0.0, HIGH), (0.12, 0.0)])]),
        '\u{311}' => above(vec![curve([(-0.14, 0.0), (-0.11, 0.20), (0.11, 0.20), (0.14, 0.0)])]),
        '\u{323}' => below(dots(dot, &[0.0]).iter().map(|path| path.transformed(flipped())).collect()),
        '\u{326}' => below(vec![comma()]),
        // the letters of Latvian and Romanian have commas where Unicode says cedilla
        '\u{327}' => match base {
            'g' => above(vec![comma().transformed(HALF_TURN)]),
            'G' | 'K' | 'k' | 'L' | 'l' | 'N' | 'n' | 'R' | 'r' => below(vec![comma()]),
            _ => Some(Mark { place: Place::Foot, paths: vec![cedilla()] }),
        },
        '\u{328}' => Some(Mark { place: Place::RightFoot, paths: vec![ogonek()] }),
        '\u{331}' => below(vec![line(&[(-0.15, -0.06), (0.15, -0.06)])]),
        _ => None,
    }
}

/// Whether the caron of a letter stands beside it, like an apostrophe.
pub(crate) const fn has_mark_beside(base: char) -> bool {
    matches!(base, 'd' | 'l' | 'L' | 't')
}

/// Turned upside down.
pub(crate) const HALF_TURN: Affine = Affine::new([-1.0, 0.0, 0.0, -1.0, 0.0, 0.0]);

fn flipped() -> Affine {
    Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, 0.0])
}

fn acute(x: f64) -> Path {
    line(&[(x - 0.05, 0.0), (x + 0.10, HIGH)])
}

/// An apostrophe.
pub(crate) fn tick() -> Path {
    curve([(0.03, 0.0), (0.04, -0.08), (0.02, -0.14), (-0.04, -0.20)])
}

/// A comma that stands free.
fn comma() -> Path {
    curve([(0.04, 0.0), (0.05, -0.07), (0.02, -0.13), (-0.05, -0.18)])
}

fn cedilla() -> Path {
    let mut path = line(&[(0.02, 0.0), (-0.01, -0.07)]);
    let hook = [(0.12, -0.06), (0.13, -0.24), (-0.09, -0.22)].map(Into::into);
    path.push(tracelight_stroke::Element::Cubic { c1: hook[0], c2: hook[1], to: hook[2] });
    path
}

fn ogonek() -> Path {
    curve([(0.0, 0.0), (-0.16, -0.12), (-0.10, -0.26), (0.09, -0.20)])
}

/// A circle of four cubics, standing on y = 0. Their handles are 0.5523 radii: off by less than 3e-4 of one.
pub(crate) fn ring(radius: f64) -> Vec<Path> {
    const HANDLE: f64 = 0.552_284_75;
    let (r, h) = (radius, HANDLE * radius);
    let quarters = [
        [(r, h), (h, r), (0.0, r)],
        [(-h, r), (-r, h), (-r, 0.0)],
        [(-r, -h), (-h, -r), (0.0, -r)],
        [(h, -r), (r, -h), (r, 0.0)],
    ];
    let mut path = Path::new((r, 0.0).into());
    for [c1, c2, to] in quarters {
        path.push(tracelight_stroke::Element::Cubic { c1: c1.into(), c2: c2.into(), to: to.into() });
    }
    path.close();
    vec![path.transformed(Affine::translate(Vec2::new(0.0, radius)))]
}

/// The face's dot standing on y = 0, at each of these places.
fn dots(dot: &Glyph, places: &[f64]) -> Vec<Path> {
    let up = dot.bounds().map_or(0.0, |bounds| -bounds.y0);
    places.iter().flat_map(|&x| dot.clone().shifted(x, up).paths).collect()
}
