//! Inserts unfolded: what is drawn, where, on which layer and in which colour, in the end.

use std::collections::HashMap;

use tracelight_stroke::{Affine, Colour, Path, Point};

use super::curves::{has_length, moved};
use super::scene::Block;
use super::scene::{Insert, Item, LAYER_0, Layer, Layers, Look, Paint, Scene, Shape, Skipped};
use crate::FormatError;
use crate::extent::controls;

/// Inserts within inserts. Nobody nests this deep; circles do.
const MAX_DEPTH: usize = 32;

/// Items looked at, at most: blocks may repeat nothing a billion times.
const MAX_VISITS: usize = 4_000_000;

/// Points beyond this, after all scales of all inserts, are a broken file's.
const MAX_PLACE: f64 = 1e15;

/// A path in the world with its own look.
pub(super) struct Drawn {
    pub(super) path: Path,
    pub(super) layer: usize,
    pub(super) colour: Colour,
}

/// Where the items of a block are drawn.
#[derive(Clone, Copy)]
struct Setting {
    world_from_block: Affine,
    /// Layer of what lies on layer 0.
    layer: usize,
    /// Colour of what is coloured by its block.
    colour: Colour,
    depth: usize,
}

struct Unfolding<'a> {
    layers: &'a Layers,
    blocks: &'a HashMap<String, Block>,
    skipped: &'a mut Skipped,
    drawn: Vec<Drawn>,
    elements: usize,
    visits: usize,
}

/// Everything of the model that is visible, in file order.
///
/// # Errors
/// Blocks that hold themselves, and ones that repeat each other beyond all measure.
pub(super) fn unfolded(scene: &mut Scene) -> Result<Vec<Drawn>, FormatError> {
    let Scene { layers, blocks, items, skipped, styles: _ } = scene;
    let mut unfolding = Unfolding { layers, blocks, skipped, drawn: Vec::new(), elements: 0, visits: 0 };
    let world =
        Setting { world_from_block: Affine::IDENTITY, layer: LAYER_0, colour: Colour::BLACK, depth: 0 };
    unfolding.items(items, world)?;
    Ok(unfolding.drawn)
}

impl Unfolding<'_> {
    fn items(&mut self, items: &[Item], at: Setting) -> Result<(), FormatError> {
        for item in items {
            self.visits += 1;
            check("DXF, its blocks repeated,", [self.visits, MAX_VISITS], "entities")?;
            match item {
                Item::Shape(shape) => self.shape(shape, at)?,
                Item::Insert(insert) => self.insert(insert, at)?,
                Item::Text(text) => text.shapes.iter().try_for_each(|shape| self.shape(shape, at))?,
            }
        }
        Ok(())
    }

    fn shape(&mut self, shape: &Shape, at: Setting) -> Result<(), FormatError> {
        let (layer, colour) = self.look(shape.look, at);
        let Layer { is_off, is_frozen, .. } = *self.layers.get(layer);
        if is_off || is_frozen {
            self.skipped.hidden += 1;
            return Ok(());
        }
        let path = match at.depth {
            0 => shape.path.clone(),
            _ => moved(&shape.path, at.world_from_block),
        };
        self.elements += path.elements().len().max(super::LEAST_ELEMENTS);
        check("DXF, its blocks repeated,", [self.elements, super::MAX_ELEMENTS], "path segments")?;
        self.check_place(&path)?;
        if has_length(&path) {
            self.drawn.push(Drawn { path, layer, colour });
        }
        Ok(())
    }

    fn check_place(&self, path: &Path) -> Result<(), FormatError> {
        // asked this way round, what is not a number is not sound
        let is_sound = |p: &Point| p.x.abs() <= MAX_PLACE && p.y.abs() <= MAX_PLACE;
        match controls(path).find(|p| !is_sound(p)) {
            Some(Point { x, y }) => Err(FormatError::Value {
                place: format!("path {}", self.drawn.len() + 1),
                field: "a point",
                value: format!("({x}, {y})"),
                expected: "coordinates up to 1e15, all scales of inserts applied",
            }),
            None => Ok(()),
        }
    }

    fn insert(&mut self, insert: &Insert, at: Setting) -> Result<(), FormatError> {
        let blocks = self.blocks; // outlives the loan of self
        let (layer, colour) = self.look(insert.look, at);
        if self.layers.get(layer).is_frozen {
            self.skipped.hidden += 1;
            return Ok(());
        }
        let Some(block) = blocks.get(&insert.block) else {
            self.skipped.missing_blocks += 1;
            return Ok(());
        };
        check("DXF's nesting of blocks (one may hold itself)", [at.depth + 1, MAX_DEPTH], "levels")?;
        let own = at.world_from_block * insert.place * Affine::translate(-block.base.to_vec2());
        for (row, column) in (0..insert.rows).flat_map(|r| (0..insert.columns).map(move |c| (r, c))) {
            self.visits += 1 + block.skipped.kinds();
            check("DXF, its blocks repeated,", [self.visits, MAX_VISITS], "inserts")?;
            let step = insert.steps[0] * f64::from(column) + insert.steps[1] * f64::from(row);
            let step = at.world_from_block * step.to_point() - at.world_from_block * Point::ORIGIN;
            let world_from_block = Affine::translate(step) * own;
            self.skipped.add(&block.skipped);
            self.items(&block.items, Setting { world_from_block, layer, colour, depth: at.depth + 1 })?;
        }
        Ok(())
    }

    fn look(&self, look: Look, at: Setting) -> (usize, Colour) {
        let layer = if look.layer == LAYER_0 { at.layer } else { look.layer };
        let colour = match look.paint {
            Paint::Of(colour) => colour,
            Paint::ByBlock => at.colour,
            Paint::ByLayer => self.layers.get(layer).colour,
        };
        (layer, colour)
    }
}

fn check(what: &'static str, [found, limit]: [usize; 2], unit: &'static str) -> Result<(), FormatError> {
    match found > limit {
        true => Err(FormatError::TooLarge { what, found, unit, limit }),
        false => Ok(()),
    }
}
