//! Fonts in SVG (`<font>`, SVG 1.1 chapter 20): bytes to glyphs.

use std::collections::{BTreeMap, HashMap};

use roxmltree::{Document, Node, ParsingOptions};
use svgtypes::{SimplePathSegment, SimplifyingPathParser};
use tracelight_stroke::{Affine, Element, Path, Point};

use crate::error::LettersError;
use crate::glyph::Glyph;

/// Nodes of the XML tree at most.
const MAX_NODES: u32 = 1_000_000;
/// Pairs of letters with a kerning at most.
const MAX_PAIRS: usize = 1_000_000;
/// Letters of a ligature at most.
const MAX_LIGATURE: usize = 8;

/// What a font says.
pub(crate) struct SvgFont {
    /// By the text that they stand for, one letter or several.
    pub(crate) glyphs: BTreeMap<String, Glyph>,
    /// How much nearer the second letter of a pair is, em.
    pub(crate) kerns: HashMap<(char, char), f64>,
    /// Letters of the longest ligature.
    pub(crate) longest: usize,
    /// Most of its subpaths are closed: the edges of letters, not their strokes.
    pub(crate) has_outlines: bool,
}

impl SvgFont {
    /// The first font of an SVG that has glyphs.
    ///
    /// # Errors
    /// Bytes that are no SVG, or one without glyphs.
    pub(crate) fn read(name: &str, bytes: &[u8]) -> Result<Self, LettersError> {
        let no_font = |why: String| LettersError::NoFont { name: name.to_owned(), why };
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let text = std::str::from_utf8(bytes).map_err(|e| no_font(e.to_string()))?;
        let options = ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options).map_err(|e| no_font(e.to_string()))?;
        let fonts = document.descendants().filter(|node| node.tag_name().name() == "font");
        let has_glyphs = |font: &Node| font.children().any(|n| n.tag_name().name() == "glyph");
        let font = fonts.into_iter().find(has_glyphs).ok_or_else(|| no_font("it holds no glyph".into()))?;
        Self::of(name, font)
    }

    fn of(name: &str, font: Node) -> Result<Self, LettersError> {
        let named = |wanted: &'static str| font.children().filter(move |n| n.tag_name().name() == wanted);
        let em = named("font-face").find_map(|face| number(face, "units-per-em")).filter(|em| *em > 0.0);
        let scale = 1.0 / em.unwrap_or(1000.0);
        let usual = number(font, "horiz-adv-x").unwrap_or(0.0);
        let (mut glyphs, mut by_name, mut longest) = (BTreeMap::new(), HashMap::new(), 1);
        let (mut closed, mut open) = (0, 0);
        for node in named("glyph") {
            let Some(stands_for) = node.attribute("unicode").filter(|text| !text.is_empty()) else {
                continue;
            };
            let letters = stands_for.chars().count();
            if letters > MAX_LIGATURE || node.attribute("orientation") == Some("v") {
                continue;
            }
            let advance = number(node, "horiz-adv-x").unwrap_or(usual) * scale;
            let paths = node.attribute("d").map(|d| paths(d, scale)).unwrap_or_default();
            closed += paths.iter().filter(|path| path.is_closed()).count();
            open += paths.iter().filter(|path| !path.is_closed()).count();
            longest = longest.max(letters);
            if let (Some(name), Some(first), 1) =
                (node.attribute("glyph-name"), stands_for.chars().next(), letters)
            {
                by_name.insert(name, first);
            }
            // of two for one text the first is taken, as SVG has it
            glyphs.entry(stands_for.to_owned()).or_insert(Glyph { paths, advance });
        }
        let mut kerns = HashMap::new();
        for node in named("hkern") {
            let near = number(node, "k").unwrap_or(0.0) * scale;
            let (left, right) = (side(node, "u1", "g1", &by_name), side(node, "u2", "g2", &by_name));
            if kerns.len() + left.len() * right.len() > MAX_PAIRS {
                return Err(LettersError::TooMany {
                    name: name.to_owned(),
                    what: "kerning pairs",
                    limit: MAX_PAIRS,
                });
            }
            for &first in &left {
                right.iter().for_each(|&second| {
                    kerns.entry((first, second)).or_insert(near);
                });
            }
        }
        Ok(Self { glyphs, kerns, longest, has_outlines: closed > open })
    }
}

fn number(node: Node, name: &str) -> Option<f64> {
    const MOST: f64 = 1e6;
    node.attribute(name)?.trim().parse::<f64>().ok().filter(|value| value.abs() <= MOST)
}

/// Letters on one side of a pair: by themselves, by ranges of code points, or by the names of their glyphs.
fn side(node: Node, letters: &str, names: &str, by_name: &HashMap<&str, char>) -> Vec<char> {
    const MOST: u32 = 1024;
    let mut all = Vec::new();
    for part in node.attribute(letters).unwrap_or_default().split(',') {
        match part.trim().strip_prefix("U+").map(|range| range.split_once('-').unwrap_or((range, range))) {
            Some((first, last)) => {
                let code = |text: &str| u32::from_str_radix(text.trim_start_matches("U+"), 16).ok();
                if let (Some(first), Some(last)) = (code(first), code(last)) {
                    all.extend((first..=last.min(first.saturating_add(MOST))).filter_map(char::from_u32));
                }
            }
            None => all.extend(part.trim().chars().next()),
        }
    }
    let named = node.attribute(names).unwrap_or_default().split(',');
    all.extend(named.filter_map(|name| by_name.get(name.trim())));
    all
}

/// Path data, as far as it can be read.
fn paths(d: &str, scale: f64) -> Vec<Path> {
    let to_em = Affine::scale(scale);
    let at = |x: f64, y: f64| to_em * within_bounds(Point::new(x, y));
    let (mut done, mut open): (Vec<Path>, Option<Path>) = (Vec::new(), None);
    for segment in SimplifyingPathParser::from(d).map_while(Result::ok) {
        if let SimplePathSegment::MoveTo { x, y } = segment {
            done.extend(open.replace(Path::new(at(x, y))));
            continue;
        }
        let Some(path) = &mut open else { continue };
        match segment {
            SimplePathSegment::MoveTo { .. } => {}
            SimplePathSegment::LineTo { x, y } => path.line_to(at(x, y)),
            SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => {
                path.push(Element::Cubic { c1: at(x1, y1), c2: at(x2, y2), to: at(x, y) });
            }
            SimplePathSegment::Quadratic { x1, y1, x, y } => {
                let (from, c, to) = (path.end(), at(x1, y1), at(x, y));
                path.push(Element::Cubic { c1: from.lerp(c, 2.0 / 3.0), c2: to.lerp(c, 2.0 / 3.0), to });
            }
            SimplePathSegment::ClosePath => path.close(),
        }
    }
    done.extend(open);
    done.retain(|path| !path.elements().is_empty());
    done
}

/// A point within bounds, whatever its numbers are.
fn within_bounds(point: Point) -> Point {
    const FURTHEST: f64 = 1e6;
    let near = |value: f64| if value.is_finite() { value.clamp(-FURTHEST, FURTHEST) } else { 0.0 };
    Point::new(near(point.x), near(point.y))
}
