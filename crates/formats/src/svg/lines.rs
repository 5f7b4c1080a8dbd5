//! Text of an SVG as single lines: at its own size, place and turn, spaced as the single-line face has it.

use std::collections::BTreeSet;

use tracelight_letters::{Faces, Run, remarks};
use tracelight_maths::planar;
use tracelight_stroke::{Affine, Colour, Path, Vec2};
use usvg::{
    AlignmentBaseline, BaselineShift, DominantBaseline, Paint, Text, TextAnchor, TextChunk, TextFlow,
    TextSpan, WritingMode,
};

/// A letter's path on the sheet.
pub(super) struct Drawn {
    pub(super) path: Path,
    pub(super) colour: Option<Colour>,
    /// Edge of the letter, otherwise stroke of the pen.
    pub(super) is_edge: bool,
}

/// Sets texts, and remembers what could not be drawn as asked.
pub(super) struct Lines {
    faces: Faces,
    missing: BTreeSet<char>,
    outlined: BTreeSet<char>,
    /// Texts along paths or from top to bottom.
    bent: usize,
}

/// Where the pen is, and how many characters were before it.
#[derive(Clone, Copy, Default)]
struct Pen {
    x: f64,
    y: f64,
    index: usize,
}

/// A letter on its way: its map from the em to the text's frame, before the line is anchored.
struct Set {
    paths: Vec<Path>,
    place: Affine,
    is_edge: bool,
    colour: Option<Colour>,
    is_shown: bool,
}

impl Lines {
    pub(super) const fn new(faces: Faces) -> Self {
        Self { faces, missing: BTreeSet::new(), outlined: BTreeSet::new(), bent: 0 }
    }

    /// What could not be drawn as asked.
    pub(super) fn remarks(&self) -> Vec<String> {
        let bent = (self.bent > 0).then(|| {
            format!("drawn as outlines: text along a path or from top to bottom ({} found)", self.bent)
        });
        remarks(&self.missing, &self.outlined).into_iter().chain(bent).collect()
    }

    /// A text on the sheet; `None` for one along a path or from top to bottom, which is drawn as outlines.
    pub(super) fn set(&mut self, text: &Text) -> Option<Vec<Drawn>> {
        let is_bent = |chunk: &TextChunk| matches!(chunk.text_flow(), TextFlow::Path(_));
        if text.writing_mode() == WritingMode::TopToBottom || text.chunks().iter().any(is_bent) {
            self.bent += 1;
            return None;
        }
        let t = text.abs_transform();
        let sheet = Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from));
        let (mut drawn, mut pen) = (Vec::new(), Pen::default());
        for chunk in text.chunks() {
            for set in self.chunk(text, chunk, &mut pen).into_iter().filter(|set| set.is_shown) {
                let paths = set.paths.iter().map(|path| path.transformed(sheet * set.place));
                drawn.extend(paths.map(|path| Drawn { path, colour: set.colour, is_edge: set.is_edge }));
            }
        }
        Some(drawn)
    }

    /// A line about its anchor. The pen is left at its end.
    fn chunk(&mut self, text: &Text, chunk: &TextChunk, pen: &mut Pen) -> Vec<Set> {
        pen.x = chunk.x().map_or(pen.x, f64::from);
        pen.y = chunk.y().map_or(pen.y, f64::from);
        let start = pen.x;
        let mut sets = Vec::new();
        for span in chunk.spans() {
            let Some(words) = chunk.text().get(span.start()..span.end()) else { continue };
            let run = self.faces.run(words);
            let (missing, outlined) = (run.missing.clone(), run.outlined.clone());
            self.missing.extend(missing);
            self.outlined.extend(outlined);
            sets.extend(self.span(text, span, (words, run), pen));
        }
        let length = pen.x - start;
        let back = match chunk.anchor() {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => -0.5 * length,
            TextAnchor::End => -length,
        };
        pen.x += back;
        let anchored = Affine::translate(Vec2::new(back, 0.0));
        sets.iter_mut().for_each(|set| set.place = anchored * set.place);
        sets
    }

    fn span(&self, text: &Text, span: &TextSpan, (words, run): (&str, Run), pen: &mut Pen) -> Vec<Set> {
        let size = f64::from(span.font_size().get());
        let letters: Vec<char> = words.chars().collect();
        let spacing = spacing(span, &run, &letters, size);
        let rise = self.rise(span, size);
        let (colour, is_shown) = look(span);
        let listed = |list: &[f32], index: usize| list.get(index).copied().map_or(0.0, f64::from);
        let from = (pen.x, pen.index);
        let (mut sets, mut character) = (Vec::new(), 0);
        for (i, letter) in run.letters.iter().enumerate() {
            let index = from.1 + character;
            pen.x += listed(text.dx(), index);
            pen.y += listed(text.dy(), index);
            let turn = planar::rotation(listed(text.rotate(), index).to_radians());
            let at =
                Affine::translate(Vec2::new(pen.x, pen.y)) * turn * Affine::translate(Vec2::new(0.0, -rise));
            let place = at * Affine::scale_non_uniform(size, -size);
            sets.push(Set {
                paths: letter.paths.clone(),
                place,
                is_edge: letter.has_outlines,
                colour,
                is_shown,
            });
            // to the next letter: kerning, and blanks for letters that are missing, are in where that one is
            let next = run.letters.get(i + 1).map_or(run.advance, |next| next.at);
            pen.x += (next - letter.at) * size + spacing.letter;
            if letters.get(character) == Some(&' ') {
                pen.x += spacing.word;
            }
            character += letter.chars;
        }
        pen.index = from.1 + letters.len();
        sets.extend(decorations(span, from.0, pen, size).map(|path| Set {
            paths: vec![path],
            place: Affine::translate(Vec2::new(0.0, -rise)),
            is_edge: false,
            colour,
            is_shown,
        }));
        sets
    }

    /// How far a baseline is shifted up: by `dominant-baseline`, `alignment-baseline` and `baseline-shift`.
    fn rise(&self, span: &TextSpan, size: f64) -> f64 {
        const BELOW: f64 = 0.2; // of the em, what hangs below the baseline
        let capital = self.faces.capital_height();
        let line = match span.alignment_baseline() {
            AlignmentBaseline::Middle => -0.35 * capital,
            AlignmentBaseline::Central => -0.5 * capital,
            AlignmentBaseline::BeforeEdge
            | AlignmentBaseline::TextBeforeEdge
            | AlignmentBaseline::Hanging => -capital,
            AlignmentBaseline::AfterEdge | AlignmentBaseline::TextAfterEdge => BELOW,
            _ => match span.dominant_baseline() {
                DominantBaseline::Middle => -0.35 * capital,
                DominantBaseline::Central => -0.5 * capital,
                DominantBaseline::TextBeforeEdge | DominantBaseline::Hanging => -capital,
                DominantBaseline::TextAfterEdge => BELOW,
                _ => 0.0,
            },
        };
        let shifts = span.baseline_shift().iter().map(|shift| match shift {
            BaselineShift::Baseline => 0.0,
            BaselineShift::Subscript => -0.2 * size,
            BaselineShift::Superscript => 0.4 * size,
            BaselineShift::Number(shift) => f64::from(*shift),
        });
        line * size + shifts.sum::<f64>()
    }
}

/// What is added after each letter, and after each blank.
struct Spacing {
    letter: f64,
    word: f64,
}

/// The spacings of a span; a length that it must have is reached between its letters.
fn spacing(span: &TextSpan, run: &Run, letters: &[char], size: f64) -> Spacing {
    let (letter, word) = (f64::from(span.letter_spacing()), f64::from(span.word_spacing()));
    let blanks = letters.iter().filter(|c| **c == ' ').count() as f64;
    let gaps = run.letters.len().saturating_sub(1) as f64;
    let own = run.advance * size + gaps * letter + blanks * word;
    match span.text_length() {
        Some(length) if gaps > 0.0 => Spacing { letter: letter + (f64::from(length) - own) / gaps, word },
        _ => Spacing { letter, word },
    }
}

/// The colour of a span, and whether it is seen.
fn look(span: &TextSpan) -> (Option<Colour>, bool) {
    let fill = span.fill().filter(|fill| fill.opacity().get() > 0.0);
    let stroke = span.stroke().filter(|stroke| stroke.opacity().get() > 0.0);
    let colour = match fill.map(usvg::Fill::paint).or(stroke.map(usvg::Stroke::paint)) {
        Some(Paint::Color(c)) => Some(Colour::new(c.red, c.green, c.blue)),
        _ => None,
    };
    (colour, span.is_visible() && (fill.is_some() || stroke.is_some()))
}

/// Lines under, over and through a span.
fn decorations(span: &TextSpan, from: f64, pen: &Pen, size: f64) -> impl Iterator<Item = Path> {
    let decoration = span.decoration();
    let heights = [
        decoration.underline().map(|_| 0.12),
        decoration.overline().map(|_| -0.85),
        decoration.line_through().map(|_| -0.28),
    ];
    let (to, y) = (pen.x, pen.y);
    heights.into_iter().flatten().filter_map(move |height| {
        let y = y + height * size;
        Path::polyline(&[(from, y).into(), (to, y).into()], false)
    })
}
