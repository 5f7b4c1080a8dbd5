//! Faces whose letters are areas: TrueType and OpenType.

use std::collections::BTreeSet;
use std::sync::Arc;

use harfrust::{ShapeOptions, ShaperData, UnicodeBuffer};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use tracelight_stroke::{Element, Path, Point};

use crate::error::LettersError;
use crate::glyph::Glyph;
use crate::letter::Letter;

/// A face of a TrueType or OpenType font, the first one of a collection.
pub(crate) struct OutlineFace {
    data: Data,
    /// Em in units of the font.
    em: f64,
    /// Height of capitals, em.
    pub(crate) capital: f64,
}

/// The bytes of a font.
enum Data {
    Bundled(&'static [u8]),
    Given(Arc<[u8]>),
}

impl Data {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Bundled(bytes) => bytes,
            Self::Given(bytes) => bytes,
        }
    }
}

impl OutlineFace {
    /// DejaVu Sans.
    ///
    /// # Errors
    /// None: it is read in a test.
    pub(crate) fn bundled() -> Result<Self, LettersError> {
        Self::of("DejaVu Sans", Data::Bundled(dejavu::sans::regular()))
    }

    /// Reads a font.
    ///
    /// # Errors
    /// Bytes that are no font with outlines.
    pub(crate) fn read(name: &str, bytes: Arc<[u8]>) -> Result<Self, LettersError> {
        Self::of(name, Data::Given(bytes))
    }

    fn of(name: &str, data: Data) -> Result<Self, LettersError> {
        let no_font = |why: String| LettersError::NoFont { name: name.to_owned(), why };
        let font = FontRef::from_index(data.bytes(), 0).map_err(|e| no_font(e.to_string()))?;
        let em = f64::from(font.metrics(Size::unscaled(), LocationRef::default()).units_per_em);
        if em < 1.0 {
            return Err(no_font("its em has no size".into()));
        }
        let top = |letter: char| {
            let glyph = font.charmap().map(letter)?;
            Glyph { paths: paths(&font, glyph, em), advance: 0.0 }.bounds().map(|bounds| bounds.y1)
        };
        let capital =
            top('H').or_else(|| top('x').map(|x| 1.4 * x)).filter(|height| (0.05..5.0).contains(height));
        Ok(Self { em, capital: capital.unwrap_or(0.7), data })
    }

    fn font(&self) -> Option<FontRef<'_>> {
        FontRef::from_index(self.data.bytes(), 0).ok()
    }

    /// How many of a text's first characters the face has, in a row; spaces and marks count with what is before them.
    pub(crate) fn reach(&self, text: &[char]) -> usize {
        let Some(font) = self.font() else { return 0 };
        let charmap = font.charmap();
        text.iter().take_while(|&&letter| charmap.map(letter).is_some()).count()
    }

    /// A text whose letters the face all has, shaped: kerning, ligatures, marks.
    pub(crate) fn shaped(&self, text: &str) -> Vec<Letter> {
        let Some(font) = self.font() else { return Vec::new() };
        let data = ShaperData::new(&font);
        let shaper = data.shaper(&font).build();
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.guess_segment_properties();
        let shaped = shaper.shape(buffer, ShapeOptions::new());
        let em = |units: i32| f64::from(units) / self.em;
        let clusters: Vec<usize> = shaped.glyph_infos().iter().map(|info| info.cluster as usize).collect();
        let starts: BTreeSet<usize> = clusters.iter().copied().collect();
        let (mut letters, mut pen): (Vec<Letter>, f64) = (Vec::new(), 0.0);
        for (i, (info, position)) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()).enumerate() {
            let glyph = Glyph { paths: paths(&font, GlyphId::new(info.glyph_id), self.em), advance: 0.0 };
            let advance = em(position.x_advance);
            let own = glyph.shifted(em(position.x_offset), em(position.y_offset));
            match letters.last_mut() {
                // several glyphs of one letter
                Some(last) if i > 0 && clusters[i - 1] == clusters[i] => {
                    last.paths.extend(own.shifted(pen - last.at, 0.0).paths);
                    last.advance += advance;
                }
                _ => letters.push(Letter {
                    at: pen,
                    chars: chars(text, &starts, clusters[i]),
                    advance,
                    paths: own.paths,
                    has_outlines: true,
                }),
            }
            pen += advance;
        }
        letters
    }
}

/// How many characters a cluster that begins at a byte stands for.
fn chars(text: &str, starts: &BTreeSet<usize>, from: usize) -> usize {
    let to = starts.range(from + 1..).next().copied().unwrap_or(text.len());
    text.get(from..to).map_or(1, |part| part.chars().count())
}

/// A glyph's outline, em; nothing for one without.
fn paths(font: &FontRef, glyph: GlyphId, em: f64) -> Vec<Path> {
    let mut pen = Pen { em, done: Vec::new(), open: None };
    if let Some(outline) = font.outline_glyphs().get(glyph) {
        // what of a broken glyph can be drawn is drawn
        let _ = outline.draw(DrawSettings::unhinted(Size::unscaled(), LocationRef::default()), &mut pen);
    }
    pen.end();
    pen.done
}

struct Pen {
    em: f64,
    done: Vec<Path>,
    open: Option<Path>,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> Point {
        Point::new(f64::from(x) / self.em, f64::from(y) / self.em)
    }

    fn push(&mut self, element: Element) {
        if let Some(path) = &mut self.open {
            path.push(element);
        }
    }

    fn end(&mut self) {
        if let Some(mut path) = self.open.take().filter(|path| !path.elements().is_empty()) {
            path.close();
            self.done.push(path);
        }
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.end();
        self.open = Some(Path::new(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.at(x, y);
        if let Some(path) = &mut self.open {
            path.line_to(to);
        }
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        let (c, to) = (self.at(cx, cy), self.at(x, y));
        let from = self.open.as_ref().map_or(to, Path::end);
        self.push(Element::Cubic { c1: from.lerp(c, 2.0 / 3.0), c2: to.lerp(c, 2.0 / 3.0), to });
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (c1, c2, to) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.push(Element::Cubic { c1, c2, to });
    }

    fn close(&mut self) {
        self.end();
    }
}
