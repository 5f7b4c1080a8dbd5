//! What a DXF holds, before its blocks are unfolded.

use std::collections::HashMap;
use std::sync::Arc;

use tracelight_stroke::{Affine, Point};

use super::linetype::Lines;
use super::look::{Layers, Look, Shape};
use super::skipped::Skipped;
use super::styles::Styles;
use super::text::Text;

/// Everything that counts of a file.
#[derive(Default)]
pub(super) struct Scene {
    pub(super) layers: Layers,
    pub(super) lines: Lines,
    pub(super) blocks: HashMap<String, Block>,
    pub(super) model: Space,
    /// The layout that was open when the file was saved.
    pub(super) layout: Space,
    /// Entities of the layout, whether they are drawn or not.
    pub(super) in_layouts: usize,
    pub(super) styles: Styles,
}

/// A space that is drawn in.
#[derive(Default)]
pub(super) struct Space {
    pub(super) items: Vec<Item>,
    /// What it holds and does not draw.
    pub(super) skipped: Skipped,
}

/// Something that is drawn.
#[derive(Debug)]
pub(super) enum Item {
    Shape(Shape),
    Dot(Dot),
    Insert(Box<Insert>),
    Text(Box<Text>),
}

impl Item {
    /// The text that it is, if it is one.
    pub(super) fn text(&mut self) -> Option<&mut Text> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// An entity that is a point.
#[derive(Debug)]
pub(super) struct Dot {
    pub(super) at: Point,
    pub(super) look: Look,
}

/// A block drawn in place.
#[derive(Debug)]
pub(super) struct Insert {
    /// Key of the block.
    pub(super) block: String,
    /// Its name, as the insert has it.
    pub(super) name: Arc<str>,
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
