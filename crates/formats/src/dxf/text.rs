//! Text of a DXF: TEXT, ATTRIB and MTEXT as paths.

use std::collections::BTreeSet;
use std::fmt;

use encoding_rs::Encoding;
use tracelight_letters::{Faces, Run, named, remarks};
use tracelight_maths::{hypot, planar};
use tracelight_stroke::{Affine, Point, Vec2};

use super::codes;
use super::curves::world_from_plane;
use super::groups::{Group, Record};
use super::look::{Look, Shape};
use super::mtext;
use super::origin::Origin;
use super::styles::{Styles, slanted, width_factor};
use crate::FormatError;
use crate::number::fixed;

/// Characters of one text at most.
const MAX_CHARACTERS: usize = 100_000;

/// What hangs below the baseline, as a share of the height: where a text is placed by its lower edge.
const DESCENT: f64 = 1.0 / 3.0;

/// A text as its record has it, and its paths once it is set.
#[derive(Debug)]
pub(super) struct Text {
    raw: Vec<u8>,
    layout: Layout,
    /// From the entity's own plane to the world.
    world: Affine,
    /// Where it is placed in its plane.
    at: Point,
    /// Height of capitals.
    height: f64,
    /// Direction of the line, rad.
    turn_rad: f64,
    look: Look,
    /// In the world, or in the block's frame.
    pub(super) shapes: Vec<Shape>,
}

#[derive(Debug)]
enum Layout {
    Line(LineText),
    Lines(mtext::Lines),
}

/// What a TEXT or ATTRIB says of its place and form.
#[derive(Debug)]
struct LineText {
    horizontal: i64,
    vertical: i64,
    /// Where it ends, or is centred, by its justification.
    to: Point,
    width: f64,
    oblique_rad: f64,
    is_backward: bool,
    is_upside_down: bool,
}

impl Text {
    /// Takes a record TEXT, ATTRIB, ATTDEF or MTEXT; `None` for one that shows nothing.
    ///
    /// # Errors
    /// A value that is no number.
    pub(super) fn of(record: &Record, look: Look) -> Result<Option<Self>, FormatError> {
        const INVISIBLE: i64 = 1;
        let is_attribute = matches!(record.kind, b"ATTRIB" | b"ATTDEF");
        let height = record.number_or(40, 1.0)?.abs();
        if height == 0.0 || is_attribute && record.whole_or(70, 0)? & INVISIBLE != 0 {
            return Ok(None);
        }
        let (layout, turn_rad) = match record.kind {
            b"MTEXT" => (Layout::Lines(mtext::Lines::of(record)?), direction(record)?),
            _ => (Layout::Line(LineText::of(record, is_attribute)?), record.number_or(50, 0.0)?.to_radians()),
        };
        // MTEXT's point is the world's, the others' is their plane's
        let elevation = if record.kind == b"MTEXT" { 0.0 } else { record.number_or(30, 0.0)? };
        let world =
            if record.kind == b"MTEXT" { Affine::IDENTITY } else { world_from_plane(record, elevation)? };
        let raw = raw(record);
        (raw.len() <= 4 * MAX_CHARACTERS).then_some(()).ok_or(too_long(raw.len()))?;
        Ok(Some(Self {
            raw,
            layout,
            world,
            at: record.point(10)?,
            height,
            turn_rad,
            look,
            shapes: Vec::new(),
        }))
    }

    /// Makes paths of the letters.
    fn set(&mut self, setting: &Setting, is_in_block: bool, said: &mut Said) {
        let Setting { faces, styles, encoding } = setting;
        let text = codes::decoded(&self.raw, *encoding);
        let frame = self.world * Affine::translate(self.at.to_vec2());
        let placed = match &self.layout {
            Layout::Line(line) => vec![line.set(&text, self, faces)],
            Layout::Lines(lines) => {
                let turn = frame * planar::rotation(self.turn_rad);
                let all = lines.set(&text, self.height, faces, styles);
                all.into_iter().map(|(run, place)| (run, turn * place)).collect()
            }
        };
        let mut lacking = BTreeSet::new();
        for (run, place) in placed {
            for letter in &run.letters {
                let place = place * Affine::translate(Vec2::new(letter.at, 0.0));
                // lines and cubics only, which any map may move
                let paths = letter.paths.iter().map(|path| path.transformed(place));
                self.shapes.extend(paths.map(|path| Shape { path, look: self.look }));
            }
            said.outlined.extend(run.outlined);
            lacking.extend(run.missing);
        }
        if !lacking.is_empty() {
            said.missing.extend(lacking);
            said.lacking += 1;
            let place = (!is_in_block).then(|| self.world * self.at);
            let own = Lacking { origin: self.look.origin, place, words: excerpt(&text) };
            let is_first = said.first.as_ref().is_none_or(|first| own.order() < first.order());
            said.first = if is_first { Some(own) } else { said.first.take() };
        }
    }
}

/// The bytes of the text: an MTEXT's first pieces are in groups of their own.
fn raw(record: &Record) -> Vec<u8> {
    // what follows an embedded object is that object's
    let own = record.groups.iter().take_while(|group| group.code != 101);
    let is_text = |code: i32| code == 1 || code == 3 && record.kind == b"MTEXT";
    let pieces: Vec<&[u8]> = own.filter(|group| is_text(group.code)).map(Group::bytes).collect();
    match record.kind {
        b"MTEXT" => pieces.concat(),
        _ => pieces.first().map(|first| first.to_vec()).unwrap_or_default(),
    }
}

/// The direction of an MTEXT: by the angle or the axis, whichever comes last.
fn direction(record: &Record) -> Result<f64, FormatError> {
    let last =
        record.groups.iter().take_while(|g| g.code != 101).filter(|g| matches!(g.code, 11 | 50)).last();
    Ok(match last.map(|group| group.code) {
        Some(11) => planar::heading(record.point(11)?.to_vec2()),
        _ => record.number_or(50, 0.0)?.to_radians(),
    })
}

impl LineText {
    /// Justifications that stretch the text between two points.
    const ALIGNED: i64 = 3;
    const FIT: i64 = 5;
    const MIDDLE: i64 = 4;

    fn of(record: &Record, is_attribute: bool) -> Result<Self, FormatError> {
        let flags = record.whole_or(71, 0)?;
        Ok(Self {
            horizontal: record.whole_or(72, 0)?,
            vertical: record.whole_or(if is_attribute { 74 } else { 73 }, 0)?,
            to: record.point(11)?,
            width: width_factor(record)?,
            oblique_rad: record.number_or(51, 0.0)?.to_radians(),
            is_backward: flags & 2 != 0,
            is_upside_down: flags & 4 != 0,
        })
    }

    /// The line, and the map from its em to the world.
    fn set(&self, text: &str, own: &Text, faces: &Faces) -> (Run, Affine) {
        let run = faces.run(&codes::plain(text));
        let mut size = own.height / faces.capital_height();
        let (mut width, mut at, mut turn_rad) = (self.width, own.at, own.turn_rad);
        let (mut x, mut y) = (0.0, 0.0);
        let is_between = matches!(self.horizontal, Self::ALIGNED | Self::FIT);
        let (span, advance) = (self.to - own.at, run.advance);
        let length = hypot(span.x, span.y);
        if is_between && length > 0.0 && advance > 0.0 {
            turn_rad = planar::heading(span);
            match self.horizontal {
                Self::FIT => width = length / (advance * size),
                _ => size = length / (advance * width),
            }
        } else if !is_between && (self.horizontal != 0 || self.vertical != 0) {
            at = self.to;
            x = match self.horizontal {
                1 | Self::MIDDLE => -0.5 * advance,
                2 => -advance,
                _ => 0.0,
            };
            y = match (self.horizontal, self.vertical) {
                (Self::MIDDLE, _) | (_, 2) => -0.5 * own.height,
                (_, 1) => DESCENT * own.height,
                (_, 3) => -own.height,
                _ => 0.0,
            };
        }
        let mirror = [self.is_backward, self.is_upside_down].map(|is_so| if is_so { -1.0 } else { 1.0 });
        let place = own.world
            * Affine::translate(at.to_vec2())
            * planar::rotation(turn_rad)
            * Affine::scale_non_uniform(mirror[0], mirror[1])
            * Affine::translate(Vec2::new(0.0, y))
            * slanted(self.oblique_rad)
            * Affine::scale_non_uniform(size * width, size)
            * Affine::translate(Vec2::new(x, 0.0));
        (run, place)
    }
}

fn too_long(found: usize) -> FormatError {
    FormatError::TooLarge { what: "DXF's text", found, unit: "characters", limit: MAX_CHARACTERS }
}

/// A text of which letters are not drawn.
struct Lacking {
    origin: Origin,
    /// Where it is in the drawing's own numbers, unless a block holds it.
    place: Option<Point>,
    words: String,
}

impl Lacking {
    /// Texts of the drawing before those of blocks, as the file has them.
    fn order(&self) -> (bool, Option<u32>, Origin) {
        (self.place.is_none(), self.origin.line(), self.origin)
    }
}

impl fmt::Display for Lacking {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} \"{}\"", self.origin.entity(0), self.words)?;
        match self.place {
            Some(Point { x, y }) => write!(f, " at x {}, y {}", fixed(x, 3), fixed(y, 3)),
            None => write!(f, " in a block"),
        }
    }
}

/// The beginning of a text, to know it by.
fn excerpt(text: &str) -> String {
    const MOST: usize = 24;
    let short: String = text.chars().take(MOST).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().count() > MOST { short + "…" } else { short }
}

/// What was found out on the way.
#[derive(Default)]
pub(super) struct Said {
    missing: BTreeSet<char>,
    outlined: BTreeSet<char>,
    /// Texts with letters that are missing.
    lacking: usize,
    first: Option<Lacking>,
}

impl Said {
    /// One sentence for each reason.
    pub(super) fn remarks(&self) -> Vec<String> {
        let missing = self.first.as_ref().map(|first| {
            let more = match self.lacking - 1 {
                0 => String::new(),
                1 => " and 1 more text".to_owned(),
                more => format!(" and {more} more texts"),
            };
            let letters = named(&self.missing);
            format!("not drawn: {letters}, which no font here has, in {first}{more}; --font FILE adds one")
        });
        missing.into_iter().chain(remarks(&BTreeSet::new(), &self.outlined)).collect()
    }
}

/// Sets texts, each with whether a block holds it.
///
/// # Errors
/// Letters of more lines than are read.
pub(super) fn set_all<'a>(
    texts: impl Iterator<Item = (&'a mut Text, bool)>,
    setting: &Setting,
) -> Result<Said, FormatError> {
    let (mut said, mut elements) = (Said::default(), 0);
    for (text, is_in_block) in texts {
        text.set(setting, is_in_block, &mut said);
        let cost = |shape: &Shape| shape.path.elements().len().max(super::LEAST_ELEMENTS);
        elements += text.shapes.iter().map(cost).sum::<usize>();
        if elements > super::MAX_ELEMENTS {
            let limit = super::MAX_ELEMENTS;
            return Err(FormatError::TooLarge {
                what: "DXF's text",
                found: elements,
                unit: "path segments",
                limit,
            });
        }
    }
    Ok(said)
}

/// What texts are set with.
pub(super) struct Setting<'a> {
    pub(super) faces: Faces,
    pub(super) styles: &'a Styles,
    /// Of bytes that are no UTF-8.
    pub(super) encoding: Option<&'static Encoding>,
}
