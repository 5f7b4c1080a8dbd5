use tracelight_stroke::{Colour, Drawing, Path, Point, Stroke, StrokeKind};
use usvg::roxmltree::{Document, Node};
use usvg::tiny_skia_path::PathSegment;

use tracelight_letters::Kind;

use super::guard;
use super::lines::{Drawn, Lines};
use super::names::{Names, Place};
use super::text::Fonts;
use crate::extent::controls;
use crate::lettering::{faces, kind};
use crate::options::{Letters, ReadOptions};
use crate::pen::Pen;
use crate::{FormatError, Reading, Sheet, check_size, is_sound, text};

/// CSS: an inch is 96 px.
const METRES_PER_PX: f64 = 0.0254 / 96.0;

/// Elements of all strokes at most, for the memory they take.
const MAX_ELEMENTS: usize = 2_000_000;

/// A stroke takes the memory of so many elements at least.
const LEAST_ELEMENTS: usize = 4;

/// Nodes of the XML tree at most, for the memory they take.
const MAX_NODES: u32 = 2_000_000;

/// Reads the visible paths of an SVG, in document order, a stroke for each subpath.
///
/// Shapes, `use`, CSS, transforms, `viewBox` and units are resolved. Lines stay lines and cubics cubics; quadratic
/// curves become cubics; arcs that are circular on the sheet are arcs again, elliptical ones cubics within 3e-4 of
/// their radius. A path with a stroke is a centreline of that width, one with a fill only is an outline. A filled
/// rectangle that covers the whole sheet is background and left out. Clipping, masks, dashes and filters are not
/// applied; pictures are not read, which a remark says. Text is drawn as outlines in a given font or DejaVu Sans, or as single lines.
///
/// A stroke's colour is that of its line, else of its fill. Its layer is the nearest layer of the drawing program
/// (`inkscape:groupmode="layer"`, by its label) or, outside of all of them, the nearest group with an id.
///
/// The unit is the CSS px; a sheet with a physical size (mm, cm, in, pt, pc, Q) says how large that is.
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
    check_size(bytes)?;
    let text = text(bytes)?;
    guard::check_text(text)?;
    let parsing =
        usvg::roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..Default::default() };
    let xml = Document::parse_with_options(text, parsing).map_err(syntax)?;
    guard::check_tree(&xml)?;
    let fonts = Fonts::of(options)?;
    let tree = usvg::Tree::from_xmltree(&xml, &resolving(&fonts)).map_err(unreadable)?;
    let (width, height) = (f64::from(tree.size().width()), f64::from(tree.size().height()));
    if !is_sound(Point::new(width, height)) {
        return Err(FormatError::Far { place: "size of the sheet".into(), x: width, y: height });
    }
    let names = Names::of(&xml);
    let has_lines = kind(options, Letters::Outline)? == Kind::Line;
    let lines = has_lines.then(|| faces(options, Letters::Outline)).transpose()?.map(Lines::new);
    let mut collector = Collector { width, height, names, lines, elements: 0, strokes: Vec::new() };
    collector.group(tree.root())?;
    if collector.strokes.is_empty() {
        return Err(FormatError::Nothing { hint: hint(&xml) });
    }
    let metres_per_unit = is_physical(xml.root_element()).then_some(METRES_PER_PX);
    let sheet = Sheet { width, height, metres_per_unit, drawing: Drawing { strokes: collector.strokes } };
    let text = collector.lines.as_ref().map_or_else(|| fonts.remarks(&tree), Lines::remarks);
    Ok(Reading { sheet, remarks: remarks(&xml).into_iter().chain(text).collect() })
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

/// Elements of that name, in whatever namespace, that hold something.
fn count(xml: &Document, name: &str) -> usize {
    let holds = |n: &Node| n.descendants().any(|d| d.text().is_some_and(|t| !t.trim().is_empty()));
    xml.descendants().filter(|n| n.tag_name().name() == name && (name != "text" || holds(n))).count()
}

/// What is left out of a drawing that has strokes.
fn remarks(xml: &Document) -> Vec<String> {
    let said = |name, what: &str| {
        let found = count(xml, name);
        (found > 0).then(|| format!("not drawn: {what} ({found} found)"))
    };
    said("image", "embedded pictures; trace their own files").into_iter().collect()
}

fn hint(xml: &Document) -> &'static str {
    if count(xml, "text") > 0 {
        "the SVG holds text that shows no letter: give a font that has its letters (--font FILE)"
    } else if count(xml, "image") > 0 {
        "the SVG holds an embedded picture, not paths: trace the picture's own file"
    } else {
        "the SVG has no visible path"
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

struct Collector {
    width: f64,
    height: f64,
    names: Names,
    /// For text as single lines; outlines without.
    lines: Option<Lines>,
    elements: usize,
    strokes: Vec<Stroke>,
}

impl Collector {
    fn group(&mut self, root: &usvg::Group) -> Result<(), FormatError> {
        let mut left: Vec<(&usvg::Node, Place)> =
            root.children().iter().rev().map(|n| (n, Place::default())).collect();
        while let Some((node, around)) = left.pop() {
            match node {
                usvg::Node::Group(group) => {
                    let place = self.names.within(&around, group.id());
                    left.extend(group.children().iter().rev().map(|n| (n, place.clone())));
                }
                usvg::Node::Path(path) => self.path(path, &around)?,
                usvg::Node::Text(text) => match self.lines.as_mut().and_then(|lines| lines.set(text)) {
                    Some(drawn) => self.letters(drawn, &around)?,
                    None => {
                        let outlines = text.flattened().children().iter().rev();
                        left.extend(outlines.map(|n| (n, around.clone())));
                    }
                },
                _ => {}
            }
        }
        Ok(())
    }

    fn letters(&mut self, drawn: Vec<Drawn>, place: &Place) -> Result<(), FormatError> {
        for Drawn { path, colour, is_edge } in drawn {
            self.elements += path.elements().len().max(LEAST_ELEMENTS);
            self.check(&path)?;
            let kind = if is_edge { StrokeKind::Outline } else { StrokeKind::Centreline };
            self.strokes.push(Stroke { path, kind, pen: None, layer: place.layer.clone(), colour });
        }
        Ok(())
    }

    fn path(&mut self, path: &usvg::Path, place: &Place) -> Result<(), FormatError> {
        let stroke = path.stroke().filter(|s| s.opacity().get() > 0.0);
        let fill = path.fill().filter(|f| f.opacity().get() > 0.0);
        let filled_only = stroke.is_none();
        if !path.is_visible() || (stroke.is_none() && fill.is_none()) {
            return Ok(());
        }
        if filled_only && self.is_background(path) {
            return Ok(());
        }
        let scale = scale(path);
        let pen = stroke.map(|s| f64::from(s.width().get()) * scale);
        let colour = colour_of(stroke.map(usvg::Stroke::paint).or(fill.map(usvg::Fill::paint)));
        let kind = if filled_only { StrokeKind::Outline } else { StrokeKind::Centreline };
        for line in subpaths(path, filled_only) {
            self.elements += line.elements().len().max(LEAST_ELEMENTS);
            self.check(&line)?;
            self.strokes.push(Stroke { path: line, kind, pen, layer: place.layer.clone(), colour });
        }
        Ok(())
    }

    fn check(&self, path: &Path) -> Result<(), FormatError> {
        if self.elements > MAX_ELEMENTS {
            let found = self.elements;
            return Err(FormatError::TooLarge {
                what: "SVG",
                found,
                unit: "path segments",
                limit: MAX_ELEMENTS,
            });
        }
        match controls(path).find(|&p| !is_sound(p)) {
            Some(Point { x, y }) => {
                Err(FormatError::Far { place: format!("stroke {}", self.strokes.len() + 1), x, y })
            }
            None => Ok(()),
        }
    }

    /// A rectangle over the whole sheet, which drawing programs put behind everything.
    fn is_background(&self, path: &usvg::Path) -> bool {
        let bounds = path.abs_bounding_box();
        let slack = 0.005 * (self.width + self.height) as f32;
        let covers = bounds.left() <= slack
            && bounds.top() <= slack
            && bounds.right() >= self.width as f32 - slack
            && bounds.bottom() >= self.height as f32 - slack;
        let straight = |s: PathSegment| matches!(s, PathSegment::LineTo(_));
        covers && path.data().segments().filter(|s| straight(*s)).count() <= 4 && path.data().len() <= 6
    }
}

/// The colour of a paint; gradients and patterns have several.
fn colour_of(paint: Option<&usvg::Paint>) -> Option<Colour> {
    match paint {
        Some(usvg::Paint::Color(c)) => Some(Colour::new(c.red, c.green, c.blue)),
        _ => None,
    }
}

/// How much larger a path is on the sheet than in its own numbers.
fn scale(path: &usvg::Path) -> f64 {
    let at = path.abs_transform();
    (f64::from(at.sx) * f64::from(at.sy) - f64::from(at.kx) * f64::from(at.ky)).abs().sqrt()
}

/// What single precision, in which paths are resolved, leaves uncertain of a path's points on the sheet.
fn noise(path: &usvg::Path) -> f64 {
    let bounds = path.bounding_box();
    let sides = [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()];
    let largest = sides.into_iter().map(|v| f64::from(v.abs())).fold(0.0, f64::max);
    8.0 * f64::from(f32::EPSILON) * largest * scale(path)
}

/// The connected parts of a path that have a length, in sheet coordinates.
fn subpaths(path: &usvg::Path, close_all: bool) -> Vec<Path> {
    let t = path.abs_transform();
    let [sx, kx, tx, ky, sy, ty] = [t.sx, t.kx, t.tx, t.ky, t.sy, t.ty].map(f64::from);
    let at = |p: usvg::tiny_skia_path::Point| {
        let (x, y) = (f64::from(p.x), f64::from(p.y));
        Point::new(sx * x + kx * y + tx, ky * x + sy * y + ty)
    };
    let noise = noise(path);
    let mut done = Vec::new();
    let mut open: Option<Pen> = None;
    for segment in path.data().segments() {
        if let PathSegment::MoveTo(p) = segment {
            done.extend(open.replace(Pen::new(at(p))).and_then(|pen| pen.finish(close_all)));
            continue;
        }
        let Some(mut pen) = open.take() else { continue };
        match segment {
            PathSegment::MoveTo(_) => {}
            PathSegment::LineTo(p) => pen.line_to(at(p)),
            PathSegment::QuadTo(c, p) => pen.quadratic_to(at(c), at(p)),
            PathSegment::CubicTo(c1, c2, p) => pen.cubic_or_arc_to([c1, c2, p].map(at), noise),
            PathSegment::Close => {
                done.extend(pen.finish(true));
                continue;
            }
        }
        open = Some(pen);
    }
    done.extend(open.and_then(|pen| pen.finish(close_all)));
    done
}
