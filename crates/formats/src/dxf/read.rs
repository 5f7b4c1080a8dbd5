//! The whole way from bytes to a sheet.

use std::sync::Arc;

use tracelight_stroke::{Drawing, Element, Path, Place, Stroke, Vec2, extent};

use super::blocks::{Definitions, Drawn, Spot, Unfolded, unfolded};
use super::entities::{Around, Entities};
use super::groups::Record;
use super::header::Header;
use super::join::joined;
use super::look::Layers;
use super::pattern;
use super::records::{Cut, Records};
use super::scene::{Block, Item, Scene};
use super::sheet::{Unit, sheet};
use super::skipped::Skipped;
use super::text;
use super::twice::apart;
use crate::lettering::faces;
use crate::options::{Hatch, Letters, ReadOptions};
use crate::{FormatError, Reading};

/// Length of the line that stands for a point, as a share of the drawing's longer side: 1 mm on a wall of half a metre.
const DOT: f64 = 0.002;

/// Reads the model space of a DXF, ASCII or binary, seen from above, in file order.
///
/// Lines stay lines and arcs arcs, bulges become arcs, splines cubics (exact up to degree three without weights, else
/// within 1e-5 of their size), ellipses cubics within 5e-6 of their larger half axis. Blocks are unfolded, dimensions
/// drawn by theirs; faces and meshes by their edges; hatches by the edges of their areas, and by their pattern if that is
/// asked for; a point as a level line of 1/500 of the drawing's longer side. Text is drawn as single
/// lines, or as outlines where these are asked for. Linetypes make dashes, half a dash or more at either end of a path. Paths of one layer and colour that meet end to end become one stroke; what
/// lies on earlier lines of its layer and colour comes last. Points and the places of inserts are told, see [`Sheet::places`](crate::Sheet::places). Each stroke has its layer's name, the colour it shows and its entity, of a block's lines the insert; what lies on layers that are off or frozen is left out. Where the model is
/// empty, the layout is drawn. Whatever is not drawn is counted by name in a remark.
///
/// The sheet just holds the drawing, in millimetres, times a power of ten where that makes numbers of a usual size. Its
/// unit is the one asked for, else `$INSUNITS`, else the millimetre, which a remark says. A size that cannot be meant is
/// doubted, see [`Reading::doubt`].
///
/// # Errors
/// DWG; anything else that is no DXF, with its line; drawings of nothing; files that are made to fill the memory.
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
    let mut records = Records::new(bytes);
    let (mut scene, header) = scene(&mut records, options.hatch)?;
    let lettered = set_texts(&mut scene, header, options)?;
    let dash_scale = options.dashes.then_some(header.linetype_scale);
    let (Unfolded { drawn, spots }, skipped, is_layout) = space(&scene, dash_scale)?;
    let drawing = strokes(drawn, &scene.layers);
    let places: Vec<Place> = spots.into_iter().map(|spot| place(spot, &scene.layers)).collect();
    let unit = Unit::of(options.unit, header.metres_per_unit());
    let Some(size) = sheet(&drawing, &places, unit)? else {
        return Err(match records.cut() {
            Some(_) => records.cut_off(),
            None => skipped.nothing(),
        });
    };
    let layout = is_layout.then(|| "its model is empty: the layout (paper space) is drawn".to_owned());
    let cut = records.cut().map(|cut| cut_remark(cut).to_owned());
    let before = [size.remark, layout, cut].into_iter().flatten();
    Ok(Reading {
        sheet: size.sheet,
        remarks: before.chain(skipped.remarks()).chain(lettered).collect(),
        doubt: size.doubt,
        unit_guessed: unit == Unit::Guessed,
        is_list: false,
    })
}

/// Makes paths of all texts, and says what of them is not drawn as it should be.
fn set_texts(scene: &mut Scene, header: Header, options: &ReadOptions) -> Result<Vec<String>, FormatError> {
    let Scene { model, layout, blocks, styles, .. } = scene;
    let spaces = model.items.iter_mut().chain(&mut layout.items);
    let blocks = blocks.values_mut().flat_map(|block| &mut block.items);
    let of = |is_in_block: bool| move |item| Item::text(item).map(|text| (text, is_in_block));
    let mut texts = spaces.filter_map(of(false)).chain(blocks.filter_map(of(true))).peekable();
    if texts.peek().is_none() {
        return Ok(Vec::new());
    }
    let setting = text::Setting { faces: faces(options, Letters::Line)?, styles, encoding: header.encoding };
    Ok(text::set_all(texts, &setting)?.remarks())
}

const fn cut_remark(cut: Cut) -> &'static str {
    match cut {
        Cut::Between => "the file ends without EOF: what it holds is drawn, more of it may be missing",
        Cut::Within => "the file is cut off: what stands before is drawn, its last entity is not",
    }
}

/// What is drawn of a scene, what is not, and whether that is a layout: the model, unless it is empty.
fn space(scene: &Scene, dash_scale: Option<f64>) -> Result<(Unfolded, Skipped, bool), FormatError> {
    let Scene { layers, lines, blocks, model, layout, in_layouts, styles: _ } = scene;
    let definitions = Definitions { layers, lines, blocks, dash_scale };
    let drawn = |items, skipped: &Skipped| {
        let mut own = Skipped::default();
        own.add(skipped);
        unfolded(items, &mut own, &definitions).map(|drawn| (drawn, own))
    };
    let (own, mut skipped) = drawn(&model.items, &model.skipped)?;
    if model.items.is_empty() && model.skipped.is_empty() {
        let mut others: Vec<_> = blocks.iter().filter(|(key, _)| key.starts_with("*paper_space")).collect();
        others.sort_by(|a, b| a.0.cmp(b.0));
        let others = others.into_iter().map(|(_, block)| (&block.items, &block.skipped));
        for (items, skipped) in std::iter::once((&layout.items, &layout.skipped)).chain(others) {
            let (own, skipped) = drawn(items, skipped)?;
            if !own.drawn.is_empty() {
                return Ok((own, skipped, true));
            }
        }
    }
    skipped.in_paper_space = *in_layouts;
    Ok((own, skipped, false))
}

fn check_kind(bytes: &[u8]) -> Result<(), FormatError> {
    if bytes.starts_with(b"AC10") {
        let instead = "save it as ASCII DXF (2000 or later, or R12) in the drawing program";
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
struct Reader {
    section: Section,
    /// The block whose entities come, and its key.
    block: Option<(String, Block)>,
    /// Entities of the block or of the model.
    entities: Entities,
    /// Entities of the layout.
    layout: Entities,
    /// Whether the entity before was the layout's, as its vertices are.
    is_in_layout: bool,
    /// Crossings that are left for the patterns of hatches, if these are asked for.
    patterns: Option<usize>,
    elements: usize,
}

fn scene(records: &mut Records, hatch: Hatch) -> Result<(Scene, Header), FormatError> {
    let (mut scene, mut header) = (Scene::default(), Header::default());
    let mut reader = Reader::new(hatch);
    let mut record = Record::default();
    while records.read(&mut record)? {
        match record.kind {
            b"SECTION" => {
                reader.section = section(&record);
                if record.key(2) == "header" {
                    header = Header::of(&record);
                }
            }
            b"ENDSEC" => reader.end_section(&mut scene),
            _ => reader.take(&record, &mut scene)?,
        }
    }
    reader.end_section(&mut scene);
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

impl Reader {
    fn new(hatch: Hatch) -> Self {
        let [entities, layout] = [Entities::default(), Entities::default()];
        let (section, block) = (Section::Other, None);
        let patterns = (hatch == Hatch::Pattern).then_some(pattern::MOST_CROSSINGS);
        Self { section, block, entities, layout, is_in_layout: false, patterns, elements: 0 }
    }

    fn take(&mut self, record: &Record, scene: &mut Scene) -> Result<(), FormatError> {
        match (self.section, record.kind) {
            (Section::Tables, b"LAYER") => scene.layers.declare(record, &mut scene.lines),
            (Section::Tables, b"STYLE") => scene.styles.declare(record),
            (Section::Tables, b"LTYPE") => scene.lines.declare(record),
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
        let Scene { layers, lines, model, layout, in_layouts, .. } = scene;
        let is_part = matches!(record.kind, b"VERTEX" | b"SEQEND");
        let (entities, skipped) = match (&mut self.block, self.section) {
            (Some((_, block)), _) => (&mut self.entities, &mut block.skipped),
            (None, Section::Entities) => {
                if !is_part {
                    self.is_in_layout = record.whole_or(67, 0)? == 1;
                    let is_counted = self.is_in_layout && record.kind != b"VIEWPORT";
                    *in_layouts += usize::from(is_counted);
                }
                match self.is_in_layout {
                    true => (&mut self.layout, &mut layout.skipped),
                    false => (&mut self.entities, &mut model.skipped),
                }
            }
            // between two blocks there is nothing that could be meant
            _ => return Ok(()),
        };
        let before = entities.elements;
        entities.take(record, &mut Around { layers, lines, skipped, patterns: &mut self.patterns })?;
        self.elements += entities.elements.saturating_sub(before);
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
            self.entities.finish(&mut block.skipped);
            block.items = std::mem::take(&mut self.entities).items;
            scene.blocks.insert(key, block);
        }
    }

    fn end_section(&mut self, scene: &mut Scene) {
        self.end_block(scene);
        if self.section == Section::Entities {
            let spaces = [(&mut self.entities, &mut scene.model), (&mut self.layout, &mut scene.layout)];
            for (entities, space) in spaces {
                entities.finish(&mut space.skipped);
                space.items.extend(std::mem::take(entities).items);
            }
        }
        self.section = Section::Other;
    }
}

fn place(spot: Spot, layers: &Layers) -> Place {
    let Spot { at, kind, block, layer, colour, origin } = spot;
    Place {
        at,
        kind,
        block,
        layer: Some(layers.get(layer).name.clone()),
        colour: Some(colour),
        entity: Some(Arc::new(origin.entity(0))),
    }
}

/// Joined where they meet, named after their layers.
fn strokes(mut drawn: Vec<Drawn>, layers: &Layers) -> Drawing {
    let plain = |d: &Drawn| Stroke::new(d.path.clone());
    let bounds = extent(&Drawing { strokes: drawn.iter().map(plain).collect() }).unwrap_or_default();
    let size = bounds.width().max(bounds.height());
    for dot in drawn.iter_mut().filter(|d| d.is_dot) {
        let half = Vec2::new(0.5 * DOT * size, 0.0);
        let (from, to) = (dot.path.start() - half, dot.path.start() + half);
        dot.path = Path::new(from);
        dot.path.push(Element::Line { to });
    }
    let stroke = |d: Drawn| Stroke {
        layer: Some(layers.get(d.layer).name.clone()),
        colour: Some(d.colour),
        entity: Some(Arc::new(d.origin.entity(d.more))),
        ..Stroke::new(d.path)
    };
    let [once, again] = apart(drawn);
    Drawing { strokes: joined(once, size).into_iter().chain(again).map(stroke).collect() }
}
