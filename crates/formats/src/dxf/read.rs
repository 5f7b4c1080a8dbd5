//! The whole way from bytes to a sheet.

use tracelight_maths::{log10, powf};
use tracelight_stroke::{Affine, Drawing, Stroke};

use super::blocks::{Drawn, unfolded};
use super::entities::Entities;
use super::groups::{Record, Records};
use super::header::Header;
use super::join::joined;
use super::scene::{Block, Item, Layers, Scene, Skipped};
use super::text;
use crate::extent::extent;
use crate::lettering::faces;
use crate::limit::MAX_COORDINATE;
use crate::options::{Letters, ReadOptions};
use crate::{FormatError, Reading, Sheet};

/// Sides of a sheet are at least so long, in its unit, or numbers with four decimals would show.
const LEAST_SIDE: f64 = 10.0;

/// A side of a drawing without width or height, as a share of the other.
const LEAST_ASPECT: f64 = 0.01;

/// Reads the model space of an ASCII DXF, seen from above, in file order.
///
/// Lines stay lines and arcs arcs, bulges become arcs, splines cubics (exact up to degree three without weights, else
/// within 1e-5 of their size), ellipses cubics within 5e-6 of their larger half axis. Blocks are unfolded. Paths of one
/// layer and colour that meet end to end become one stroke. Text is drawn as single lines, or as outlines where these are asked for. Each stroke has its layer's name and the colour it shows;
/// what lies on layers that are off or frozen is left out.
///
/// The sheet just holds the drawing. Its unit is the millimetre where the file names a unit (`$INSUNITS`, else
/// `$MEASUREMENT`), else the file's own, times a power of ten where that makes numbers of a usual size.
///
/// # Errors
/// Binary DXF and DWG; anything else that is no DXF, with its line; drawings of nothing; files that are made to fill
/// the memory.
pub fn read(bytes: &[u8]) -> Result<Reading, FormatError> {
    read_with(bytes, &ReadOptions::default())
}

/// As [`read`], by options.
///
/// # Errors
/// As there.
pub fn read_with(bytes: &[u8], options: &ReadOptions) -> Result<Reading, FormatError> {
    check_kind(bytes)?;
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let (mut scene, header) = scene(bytes)?;
    let said = set_texts(&mut scene, header, options)?;
    let drawn = unfolded(&mut scene)?;
    let drawing = strokes(drawn, &scene.layers);
    match sheet(&drawing, header)? {
        Some(sheet) => {
            let remarks = scene.skipped.remarks().into_iter().chain(said).collect();
            Ok(Reading { sheet, remarks })
        }
        None => Err(FormatError::Nothing { hint: hint(&scene.skipped) }),
    }
}

/// Makes paths of all texts, and says what of them is not drawn as it should be.
fn set_texts(scene: &mut Scene, header: Header, options: &ReadOptions) -> Result<Vec<String>, FormatError> {
    let Scene { blocks, items, styles, .. } = scene;
    let mut all = items.iter().chain(blocks.values().flat_map(|block| &block.items));
    if !all.any(|item| matches!(item, Item::Text(_))) {
        return Ok(Vec::new());
    }
    let setting = text::Setting { faces: faces(options, Letters::Line)?, styles, encoding: header.encoding };
    Ok(text::set_all(items, blocks, &setting)?.remarks())
}

fn check_kind(bytes: &[u8]) -> Result<(), FormatError> {
    let instead = "save it as ASCII DXF (2000 or later, or R12) in the drawing program";
    if bytes.starts_with(b"AutoCAD Binary DXF") {
        return Err(FormatError::Refused { what: "binary DXF", instead });
    }
    if bytes.starts_with(b"AC10") {
        return Err(FormatError::Refused { what: "DWG", instead });
    }
    match bytes.len() > super::MAX_BYTES {
        true => Err(FormatError::TooLarge {
            what: "file",
            found: bytes.len(),
            unit: "bytes",
            limit: super::MAX_BYTES,
        }),
        false => Ok(()),
    }
}

/// Sections that hold something of the drawing.
#[derive(Clone, Copy, PartialEq)]
enum Section {
    Tables,
    Blocks,
    Entities,
    Other,
}

/// Where the reader is.
struct Place {
    section: Section,
    /// The block whose entities come, and its key.
    block: Option<(String, Block)>,
    entities: Entities,
    elements: usize,
}

fn scene(bytes: &[u8]) -> Result<(Scene, Header), FormatError> {
    let (mut scene, mut header) = (Scene::default(), Header::default());
    let entities = Entities::default();
    let mut place = Place { section: Section::Other, block: None, entities, elements: 0 };
    let mut records = Records::new(bytes);
    let mut record = Record::default();
    while records.read(&mut record)? {
        match record.kind {
            b"SECTION" => {
                place.section = section(&record);
                if record.key(2) == "header" {
                    header = Header::of(&record);
                }
            }
            b"ENDSEC" => place.end_section(&mut scene),
            _ => place.take(&record, &mut scene)?,
        }
    }
    place.end_section(&mut scene);
    Ok((scene, header))
}

fn section(record: &Record) -> Section {
    match record.key(2).as_str() {
        "tables" => Section::Tables,
        "blocks" => Section::Blocks,
        "entities" => Section::Entities,
        _ => Section::Other,
    }
}

impl Place {
    fn take(&mut self, record: &Record, scene: &mut Scene) -> Result<(), FormatError> {
        match (self.section, record.kind) {
            (Section::Tables, b"LAYER") => scene.layers.declare(record),
            (Section::Tables, b"STYLE") => scene.styles.declare(record),
            (Section::Blocks, b"BLOCK") => {
                self.end_block(scene);
                let block = Block { base: record.point(10)?, ..Block::default() };
                self.block = Some((record.key(2), block));
                Ok(())
            }
            (Section::Blocks, b"ENDBLK") => {
                self.end_block(scene);
                Ok(())
            }
            (Section::Blocks | Section::Entities, _) => self.entity(record, scene),
            _ => Ok(()),
        }
    }

    fn entity(&mut self, record: &Record, scene: &mut Scene) -> Result<(), FormatError> {
        let layers = &mut scene.layers;
        let skipped = match (&mut self.block, self.section) {
            (Some((_, block)), _) => &mut block.skipped,
            (None, Section::Entities) => &mut scene.skipped,
            // between two blocks there is nothing that could be meant
            _ => return Ok(()),
        };
        let before = self.entities.elements;
        self.entities.take(record, layers, skipped)?;
        self.elements += self.entities.elements.saturating_sub(before);
        match self.elements > super::MAX_ELEMENTS {
            true => Err(FormatError::TooLarge {
                what: "DXF",
                found: self.elements,
                unit: "path segments",
                limit: super::MAX_ELEMENTS,
            }),
            false => Ok(()),
        }
    }

    fn end_block(&mut self, scene: &mut Scene) {
        if let Some((key, mut block)) = self.block.take() {
            self.entities.finish();
            block.items = std::mem::take(&mut self.entities).items;
            scene.blocks.insert(key, block);
        }
    }

    fn end_section(&mut self, scene: &mut Scene) {
        self.end_block(scene);
        self.entities.finish();
        if self.section == Section::Entities {
            scene.items.extend(std::mem::take(&mut self.entities).items);
        }
        self.section = Section::Other;
    }
}

/// Joined where they meet, named after their layers.
fn strokes(drawn: Vec<Drawn>, layers: &Layers) -> Drawing {
    let plain = |d: &Drawn| Stroke::new(d.path.clone());
    let bounds = extent(&Drawing { strokes: drawn.iter().map(plain).collect() }).unwrap_or_default();
    let stroke = |d: Drawn| Stroke {
        layer: Some(layers.get(d.layer).name.clone()),
        colour: Some(d.colour),
        ..Stroke::new(d.path)
    };
    let joined = joined(drawn, bounds.width().max(bounds.height()));
    Drawing { strokes: joined.into_iter().map(stroke).collect() }
}

/// The sheet round a drawing: y down, the corner at the origin. `None` for a drawing of nothing.
fn sheet(drawing: &Drawing, header: Header) -> Result<Option<Sheet>, FormatError> {
    let Some(bounds) = extent(drawing) else { return Ok(None) };
    let size = bounds.width().max(bounds.height());
    let unit_m = header.metres_per_unit();
    // millimetres where they are known
    let scale = unit_m.map_or(1.0, |m| 1e3 * m);
    let scale = scale * of_usual_size(size * scale);
    if !(size > 0.0 && size.is_finite() && scale.is_finite() && scale > 0.0) {
        return Err(FormatError::Far { place: "extent of the drawing".into(), x: bounds.x1, y: bounds.y1 });
    }
    let (width, height) = (bounds.width().max(LEAST_ASPECT * size), bounds.height().max(LEAST_ASPECT * size));
    let (left, top) = (bounds.center().x - 0.5 * width, bounds.center().y + 0.5 * height);
    let place = Affine::new([scale, 0.0, 0.0, -scale, -left * scale, top * scale]);
    Ok(Some(Sheet {
        width: width * scale,
        height: height * scale,
        metres_per_unit: unit_m.map(|m| m / scale),
        drawing: drawing.transformed(place),
    }))
}

/// The power of ten that brings a size between what four decimals and what readers can hold.
fn of_usual_size(size: f64) -> f64 {
    let exponent = match size {
        s if s > MAX_COORDINATE => log10(MAX_COORDINATE / s).floor(),
        s if s > 0.0 && s < LEAST_SIDE => log10(LEAST_SIDE / s).ceil(),
        _ => 0.0,
    };
    powf(10.0, exponent)
}

fn hint(skipped: &Skipped) -> &'static str {
    if skipped.hidden > 0 {
        "all layers of the DXF that hold something are off or frozen: turn them on"
    } else if skipped.in_paper_space > 0 {
        "the DXF holds a layout, and its model is empty: export the model space"
    } else if skipped.has(&["TEXT", "MTEXT", "ATTDEF"]) {
        "the DXF holds text, not lines: explode the text into polylines"
    } else if skipped.has(&["HATCH", "SOLID", "3DFACE", "MESH", "3DSOLID", "REGION", "BODY"]) {
        "the DXF holds areas or solids, not lines: export their outlines"
    } else {
        "the DXF has no line, arc, polyline, ellipse or spline in its model"
    }
}
