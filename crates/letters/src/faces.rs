//! Faces in order of preference, and a line of text in them.

use std::collections::BTreeSet;
use std::sync::Arc;

use unicode_normalization::UnicodeNormalization;

use crate::composed::letter;
use crate::error::LettersError;
use crate::letter::Letter;
use crate::line_face::LineFace;
use crate::outline_face::OutlineFace;

/// How letters are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Each stroke of a letter as one line.
    Line,
    /// The edges of the letters.
    Outline,
}

/// Fonts that are in the program, by the name that asks for them.
const BUNDLED: [(&str, &[u8]); 2] = [
    ("ems", include_bytes!("../fonts/EMSReadability.svg")),
    ("hershey", include_bytes!("../fonts/HersheySans1.svg")),
];

/// The bytes of a font that is in the program: `ems`, `hershey` (single lines) or `dejavu` (outlines); `None` for any other name.
#[must_use]
pub fn bundled(name: &str) -> Option<&'static [u8]> {
    if name == "dejavu" {
        return Some(dejavu::sans::regular());
    }
    BUNDLED.iter().find(|(own, _)| *own == name).map(|(_, bytes)| *bytes)
}

/// Faces, the first that has a letter is taken.
pub struct Faces {
    faces: Vec<Face>,
    kind: Kind,
}

enum Face {
    Line(Box<LineFace>),
    Outline(OutlineFace),
}

impl Face {
    /// Reads a font of either kind: an SVG begins as text.
    fn read(name: &str, bytes: &Arc<[u8]>) -> Result<Self, LettersError> {
        let start = bytes.iter().find(|byte| !byte.is_ascii_whitespace() && !b"\xEF\xBB\xBF".contains(byte));
        match start {
            Some(b'<') => LineFace::read(name, bytes).map(|face| Self::Line(Box::new(face))),
            _ => OutlineFace::read(name, bytes.clone()).map(Self::Outline),
        }
    }

    const fn has_lines(&self) -> bool {
        matches!(self, Self::Line(_))
    }
}

/// Checks that a font can be read, and returns the kind of its letters: single lines, or outlines.
///
/// # Errors
/// Bytes that are no font.
pub fn kind_of(name: &str, bytes: &Arc<[u8]>) -> Result<Kind, LettersError> {
    Ok(match Face::read(name, bytes)? {
        Face::Line(face) if !face.has_outlines => Kind::Line,
        _ => Kind::Outline,
    })
}

/// A line of text in its faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Its letters, in the order of the pen.
    pub letters: Vec<Letter>,
    /// Of the whole line, em.
    pub advance: f64,
    /// Characters that no face has: not drawn, a space wide.
    pub missing: BTreeSet<char>,
    /// Characters that no single-line face has: drawn as outlines.
    pub outlined: BTreeSet<char>,
}

/// Width of a letter that no face has, em.
const MISSING: f64 = 0.35;

impl Faces {
    /// The given fonts in their order, and after them those in the program: for single lines EMS Readability and Hershey Sans, and DejaVu
    /// Sans as outlines for what these lack; for outlines DejaVu Sans.
    ///
    /// # Errors
    /// Bytes that are no font, and one without single lines where these are asked for.
    pub fn new(kind: Kind, fonts: &[(String, Arc<[u8]>)]) -> Result<Self, LettersError> {
        let mut faces = Vec::new();
        for (name, bytes) in fonts {
            let face = Face::read(name, bytes)?;
            if kind == Kind::Line && !face.has_lines() {
                return Err(LettersError::NoLines { name: name.clone() });
            }
            faces.push(face);
        }
        if kind == Kind::Line {
            for (name, bytes) in BUNDLED {
                faces.push(Face::Line(Box::new(LineFace::read(name, bytes)?)));
            }
        }
        faces.push(Face::Outline(OutlineFace::bundled()?));
        Ok(Self { faces, kind })
    }

    /// Height of capitals in the first face, em.
    #[must_use]
    pub fn capital_height(&self) -> f64 {
        match self.faces.first() {
            Some(Face::Line(face)) => face.capital,
            Some(Face::Outline(face)) => face.capital,
            None => 0.7,
        }
    }

    /// Sets a text as one line from left to right. Control characters take no room.
    #[must_use]
    pub fn run(&self, text: &str) -> Run {
        let text: Vec<char> = text.chars().filter(|c| !c.is_control()).nfc().collect();
        let (mut run, mut i) = (Run::default(), 0);
        while i < text.len() {
            i += self.next(&text, i, &mut run).max(1);
        }
        run
    }

    /// Sets what stands at a place, and returns how many characters that was.
    fn next(&self, text: &[char], at: usize, run: &mut Run) -> usize {
        for face in &self.faces {
            let set = match face {
                Face::Line(face) => set_line(face, text, at, run),
                Face::Outline(face) => self.set_outline(face, text, at, run),
            };
            if set > 0 {
                return set;
            }
        }
        run.missing.insert(text[at]);
        run.advance += MISSING;
        1
    }

    fn set_outline(&self, face: &OutlineFace, text: &[char], at: usize, run: &mut Run) -> usize {
        let reach = face.reach(&text[at..]);
        // a single-line face that has what comes is asked again
        let reach = if self.kind == Kind::Line { reach.min(1 + marks(&text[at + 1..])) } else { reach };
        if reach == 0 {
            return 0;
        }
        let part = &text[at..at + reach];
        if self.kind == Kind::Line {
            run.outlined.extend(part.iter().filter(|c| !c.is_whitespace()));
        }
        for mut letter in face.shaped(&part.iter().collect::<String>()) {
            letter.at += run.advance;
            run.letters.push(letter);
        }
        let end = run.letters.last().map(|last| last.at + last.advance);
        run.advance = end.unwrap_or(run.advance);
        reach
    }
}

fn set_line(face: &LineFace, text: &[char], at: usize, run: &mut Run) -> usize {
    let before = at.checked_sub(1).map(|before| text[before]);
    let Some((mut letter, kern)) = letter(face, &text[at..], before) else { return 0 };
    letter.at = run.advance - kern;
    run.advance = letter.at + letter.advance;
    let chars = letter.chars;
    run.letters.push(letter);
    chars
}

/// Marks that belong to the letter before them.
fn marks(text: &[char]) -> usize {
    text.iter().take_while(|c| unicode_normalization::char::is_combining_mark(**c)).count()
}
