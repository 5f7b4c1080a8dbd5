//! What a DXF holds, before its blocks are unfolded.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use tracelight_stroke::{Affine, Colour, Path, Point};

use super::aci;
use super::groups::Record;
use super::text::{Styles, Text};
use crate::FormatError;

/// Everything that counts of a file.
#[derive(Default)]
pub(super) struct Scene {
    pub(super) layers: Layers,
    pub(super) blocks: HashMap<String, Block>,
    /// Model space.
    pub(super) items: Vec<Item>,
    pub(super) skipped: Skipped,
    pub(super) styles: Styles,
}

/// Something that is drawn.
#[derive(Debug)]
pub(super) enum Item {
    Shape(Shape),
    Insert(Box<Insert>),
    Text(Box<Text>),
}

/// An entity that is a path.
#[derive(Debug)]
pub(super) struct Shape {
    pub(super) path: Path,
    pub(super) look: Look,
}

/// A block drawn in place.
#[derive(Debug)]
pub(super) struct Insert {
    /// Key of the block.
    pub(super) block: String,
    /// From the block's points, its base point at the origin, to the point of insertion; without the steps of an array.
    pub(super) place: Affine,
    /// From one column to the next, and from one row to the next.
    pub(super) steps: [tracelight_stroke::Vec2; 2],
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) look: Look,
}

/// A definition that inserts refer to.
#[derive(Default)]
pub(super) struct Block {
    pub(super) base: Point,
    pub(super) items: Vec<Item>,
    /// What it holds and does not draw.
    pub(super) skipped: Skipped,
}

/// Layer and colour as an entity has them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) layer: usize,
    pub(super) paint: Paint,
}

/// Where an entity's colour comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Paint {
    ByLayer,
    ByBlock,
    Of(Colour),
}

impl Paint {
    /// True colour before number, `ByLayer` where nothing is said.
    ///
    /// # Errors
    /// A colour that is no number.
    pub(super) fn of(record: &Record) -> Result<Self, FormatError> {
        if record.has(420) {
            return Ok(Paint::Of(Colour::from_rgb(record.whole_or(420, 0)? as u32)));
        }
        Ok(match record.whole_or(62, 256)?.abs() {
            0 => Paint::ByBlock,
            number => aci::colour(number).map_or(Paint::ByLayer, Paint::Of),
        })
    }
}

/// A layer.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub(super) name: Arc<str>,
    pub(super) colour: Colour,
    pub(super) is_off: bool,
    pub(super) is_frozen: bool,
}

/// The layers by number; names differ in more than case.
pub(super) struct Layers {
    all: Vec<Layer>,
    by_key: HashMap<String, usize>,
}

impl Default for Layers {
    fn default() -> Self {
        let mut layers = Self { all: Vec::new(), by_key: HashMap::new() };
        layers.numbered("0");
        layers
    }
}

/// Number of the layer `0`, whose entities within a block lie on the layer of the insert.
pub(super) const LAYER_0: usize = 0;

impl Layers {
    /// The number of a layer; entities may name ones that are declared later or nowhere.
    pub(super) fn numbered(&mut self, name: &str) -> usize {
        let name = if name.is_empty() { "0" } else { name };
        *self.by_key.entry(name.to_lowercase()).or_insert_with(|| {
            self.all.push(Layer {
                name: name.into(),
                colour: Colour::BLACK,
                is_off: false,
                is_frozen: false,
            });
            self.all.len() - 1
        })
    }

    /// Takes a record LAYER of the table.
    ///
    /// # Errors
    /// A colour or flag that is no number.
    pub(super) fn declare(&mut self, record: &Record) -> Result<(), FormatError> {
        let number = self.numbered(&record.text(2));
        let layer = &mut self.all[number];
        let colour = record.whole_or(62, 7)?;
        // a negative colour is how a layer is off
        layer.is_off = colour < 0;
        layer.is_frozen = record.whole_or(70, 0)? & 1 != 0;
        layer.colour = match Paint::of(record)? {
            Paint::Of(colour) => colour,
            Paint::ByLayer | Paint::ByBlock => Colour::BLACK,
        };
        Ok(())
    }

    pub(super) fn get(&self, number: usize) -> &Layer {
        &self.all[number]
    }
}

/// What is in a file and not drawn.
#[derive(Default)]
pub(super) struct Skipped {
    kinds: BTreeMap<String, usize>,
    /// Entities on layers that are off or frozen, or invisible themselves.
    pub(super) hidden: usize,
    /// Entities of layouts.
    pub(super) in_paper_space: usize,
    /// Inserts of blocks that are in another file, or nowhere.
    pub(super) missing_blocks: usize,
}

impl Skipped {
    /// Counts an entity of a kind that is not drawn.
    pub(super) fn count(&mut self, kind: &[u8]) {
        const MOST_KINDS: usize = 50; // more than there are: the rest is rubbish
        let name = String::from_utf8_lossy(&kind[..kind.len().min(24)]).into_owned();
        let name = if self.kinds.len() < MOST_KINDS { name } else { "others".into() };
        *self.kinds.entry(name).or_default() += 1;
    }

    /// Counts what a block does not draw, once for each time it is inserted.
    pub(super) fn add(&mut self, block: &Self) {
        for (kind, count) in &block.kinds {
            *self.kinds.entry(kind.clone()).or_default() += count;
        }
        self.hidden += block.hidden;
    }

    /// How many kinds there are: the work that [`add`](Self::add) is.
    pub(super) fn kinds(&self) -> usize {
        self.kinds.len()
    }

    /// Whether anything of a kind was counted.
    pub(super) fn has(&self, kinds: &[&str]) -> bool {
        kinds.iter().any(|k| self.kinds.contains_key(*k))
    }

    /// One sentence for each reason.
    pub(super) fn remarks(&self) -> Vec<String> {
        const NAMED: usize = 6;
        let mut kinds: Vec<_> = self.kinds.iter().collect();
        kinds.sort_by_key(|(_, n)| std::cmp::Reverse(**n));
        let named: Vec<_> = kinds.iter().take(NAMED).map(|(kind, n)| format!("{n} {kind}")).collect();
        let more = if kinds.len() > NAMED { ", …" } else { "" };
        let kinds = (!named.is_empty()).then(|| {
            let named = named.join(", ");
            format!("not drawn: {named}{more}; explode them into lines and arcs")
        });
        let said = |n: usize, what: &str| (n > 0).then(|| format!("not drawn: {what} ({n} found)"));
        let hidden = said(self.hidden, "what is invisible, or on a layer that is off or frozen");
        let paper = said(self.in_paper_space, "layouts (paper space); the model is");
        let missing = said(self.missing_blocks, "blocks that the file does not hold; bind them to it");
        [kinds, hidden, paper, missing].into_iter().flatten().collect()
    }
}
