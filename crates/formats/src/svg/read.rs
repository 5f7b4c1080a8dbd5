use tracelight_letters::Kind;
use tracelight_maths::hypot;
use tracelight_stroke::{Drawing, Point};
use usvg::roxmltree::{Document, Node};

use super::lines::Lines;
use super::names::Names;
use super::paint::{Painter, do_bands_matter, page};
use super::seen::{View, seen, work_of};
use super::text::Fonts;
use super::{guard, remarks};
use crate::lettering::{faces, kind};
use crate::options::{Hidden, Letters, ReadOptions};
use crate::unpacked::{unpacked, xml_text};
use crate::{Coordinates, FormatError, Reading, Sheet, check_size, is_sound};

const METRES_PER_INCH: f64 = 0.0254;

/// CSS: an inch is 96 px.
const METRES_PER_PX: f64 = METRES_PER_INCH / 96.0;

/// Nodes of the XML tree at most, for the memory they take.
const MAX_NODES: u32 = 2_000_000;

/// Reads an SVG as it is seen, in document order, a stroke for each connected line that is left.
///
/// Shapes, `use`, CSS, transforms, `viewBox` and units are resolved. Lines stay lines and cubics cubics; quadratic
/// curves become cubics; arcs that are circular on the sheet are arcs again, elliptical ones cubics within 3e-4 of
/// their radius. A path with a stroke is a centreline of that width, one with a fill only is an outline. Dashes are
/// strokes of their own, and a dot is a line of the pen's width.
///
/// Not drawn are: a white rectangle behind everything (the paper), and what nobody sees. That is what opaque paint
/// covers, what has on both sides the same colour (to 6 %), fills without area, opacity 0, what lies off the page,
/// outside clip paths and nested viewports or in the dark of masks of shapes and gradients. The edge of a
/// gradient is drawn as far as it is told from what is beside it. Paths are
/// cut at parameters of their own elements. The band of a pen hides what is below it, but no line of its colour that is
/// more than a quarter as wide. A centreline is drawn where it is itself uncovered. What a clip path cuts off a fill ends in a stroke
/// along the clip path. A remark says for each reason how many lines are left out and how long they are. Filters,
/// blends, masks of other things and the lines of patterns are not applied; pictures are not read: remarks too. Text is drawn as outlines
/// in a given font or DejaVu Sans, or as single lines.
///
/// A stroke's colour is that of its line, else of its fill. Its layer is the nearest layer of the drawing program
/// (`inkscape:groupmode="layer"`, by its label) or, outside of all of them, the nearest group with an id. Its entity is the element
/// that it is of: a shape, a text, or the `use` by which that is drawn.
///
/// The unit is the CSS px; a sheet with a physical size (mm, cm, in, pt, pc, Q) says how large that is, else the pixels
/// to an inch that are asked for. Files may be packed with gzip (`.svgz`), and in any encoding that XML declares.
///
/// # Errors
/// Anything that is not an SVG, one that draws nothing, and one that is made to fill the memory.
pub fn read(bytes: &[u8]) -> Result<Reading, FormatError> {
    read_with(bytes, &ReadOptions::default())
}

/// As [`read`], by options.
///
/// # Errors
/// As there.
pub fn read_with(bytes: &[u8], options: &ReadOptions) -> Result<Reading, FormatError> {
    let bytes = &*unpacked(bytes)?;
    check_size(bytes)?;
    let text = &*xml_text(bytes)?;
    guard::check_text(text)?;
    let xml = document(text).map_err(syntax)?;
    guard::check_tree(&xml)?;
    let fonts = Fonts::of(options)?;
    let (names, with_ids) = Names::of(text, &xml);
    let with_ids = with_ids.as_deref().and_then(|text| document(text).ok());
    let tree = usvg::Tree::from_xmltree(with_ids.as_ref().unwrap_or(&xml), &resolving(&fonts));
    let tree = tree.map_err(unreadable)?;
    let (width, height) = (f64::from(tree.size().width()), f64::from(tree.size().height()));
    if !is_sound(Point::new(width, height)) {
        return Err(FormatError::Far { place: "size of the sheet".into(), x: width, y: height });
    }
    let view = View {
        page: page(width, height),
        hides: options.hidden == Hidden::Cut,
        crops: options.crop,
        work: work_of(bytes.len(), letters(&xml)),
    };
    let bands = view.hides && do_bands_matter(tree.root());
    let has_lines = kind(options, Letters::Outline)? == Kind::Line;
    let letters = has_lines.then(|| faces(options, Letters::Outline)).transpose()?.map(Lines::new);
    let mut painter = Painter::new(names, view, options.dashes, bands, letters);
    painter.paint(tree.root())?;
    let seen = seen(&painter.scene, view);
    if seen.strokes.is_empty() {
        let hidden: Vec<_> = painter.unseen.iter().chain(&seen.unseen).copied().collect();
        return Err(FormatError::Nothing { hint: remarks::hint(&xml, &hidden) });
    }
    let by_dpi = options.dpi.map(|dpi| METRES_PER_INCH / dpi);
    let metres_per_unit = if is_physical(xml.root_element()) { Some(METRES_PER_PX) } else { by_dpi };
    let mut said = remarks::things(&xml, painter.told);
    said.extend(remarks::lines(&seen, &painter.unseen, hypot(width, height), metres_per_unit));
    said.extend(painter.letters.as_ref().map_or_else(|| fonts.remarks(&tree), Lines::remarks));
    let unit_m = Some(metres_per_unit.unwrap_or(METRES_PER_PX));
    let drawing = Drawing { strokes: seen.strokes };
    let coordinates = Coordinates::Page { unit_m };
    let sheet = Sheet { width, height, metres_per_unit, drawing, coordinates, places: Vec::new() };
    Ok(Reading { doubt: sheet.doubt(), sheet, remarks: said, unit_guessed: false, is_list: false })
}

fn document(text: &str) -> Result<Document<'_>, usvg::roxmltree::Error> {
    let options =
        usvg::roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..Default::default() };
    Document::parse_with_options(text, options)
}

/// Options that never open a file: links to pictures lead nowhere, fonts are those in memory.
fn resolving(fonts: &Fonts) -> usvg::Options<'_> {
    usvg::Options {
        font_family: "sans-serif".to_owned(),
        fontdb: fonts.database(),
        font_resolver: fonts.resolver(),
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..Default::default()
    }
}

/// How many letters the texts have.
fn letters(xml: &Document) -> usize {
    let texts = xml.descendants().filter(|node| node.tag_name().name() == "text");
    let parts =
        texts.flat_map(|text| text.descendants()).filter(Node::is_text).filter_map(|part| part.text());
    parts.flat_map(str::chars).filter(|c| !c.is_whitespace()).count()
}

fn syntax(error: usvg::roxmltree::Error) -> FormatError {
    let at = error.pos();
    let message = error.to_string();
    FormatError::Syntax { format: "SVG", line: at.row as usize, column: at.col as usize, message }
}

fn unreadable(error: usvg::Error) -> FormatError {
    match error {
        usvg::Error::ParsingFailed(error) => syntax(error),
        other => FormatError::Syntax { format: "SVG", line: 1, column: 1, message: other.to_string() },
    }
}

/// Whether the sheet has its size in a unit of length.
fn is_physical(svg: Node) -> bool {
    let in_unit = |name: &str| {
        let size = svg.attribute(name).unwrap_or_default().trim();
        let unit = size.trim_start_matches(|c: char| !c.is_ascii_alphabetic() || c == 'e' || c == 'E');
        ["mm", "cm", "in", "pt", "pc", "Q"].contains(&unit)
    };
    in_unit("width") || in_unit("height")
}
