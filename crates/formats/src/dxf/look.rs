//! How entities look: their layers, colours and linetypes.

use std::collections::HashMap;
use std::sync::Arc;

use tracelight_stroke::{Colour, Path};

use super::aci;
use super::groups::Record;
use super::linetype::{self, LineFrom, Lines};
use super::origin::Origin;
use crate::FormatError;

/// An entity that is a path.
#[derive(Debug)]
pub(super) struct Shape {
    pub(super) path: Path,
    pub(super) look: Look,
}

/// Layer, colour and linetype as an entity has them, and which one it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) layer: usize,
    pub(super) paint: Paint,
    pub(super) line: LineFrom,
    /// Factor of the linetype's lengths.
    pub(super) line_scale: f64,
    /// Which entity that is.
    pub(super) origin: Origin,
}

impl Look {
    /// The look of a record.
    ///
    /// # Errors
    /// A colour or factor that is no number.
    pub(super) fn of(record: &Record, layers: &mut Layers, lines: &mut Lines) -> Result<Self, FormatError> {
        Ok(Self {
            layer: layers.numbered(&record.text(8)),
            paint: Paint::of(record)?,
            line: lines.of(&record.key(6)),
            line_scale: record.number_or(48, 1.0)?,
            origin: Origin::of(record),
        })
    }
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
    /// Number of its linetype.
    pub(super) line: usize,
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
                line: linetype::CONTINUOUS,
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
    pub(super) fn declare(&mut self, record: &Record, lines: &mut Lines) -> Result<(), FormatError> {
        let number = self.numbered(&record.text(2));
        let layer = &mut self.all[number];
        let colour = record.whole_or(62, 7)?;
        // a negative colour is how a layer is off
        layer.is_off = colour < 0;
        layer.line = lines.numbered(&record.key(6));
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
