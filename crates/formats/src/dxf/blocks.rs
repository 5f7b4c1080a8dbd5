//! Inserts unfolded: what is drawn, where, on which layer and in which colour, in the end.

use std::collections::HashMap;
use std::sync::Arc;

use tracelight_stroke::{Affine, Colour, Element, Path, PlaceKind, Point};

use super::curves::{has_length, moved};
use super::dashes::{Dashed, dashed};
use super::linetype::{CONTINUOUS, LineFrom, Lines};
use super::look::{LAYER_0, Layer, Layers, Look, Paint, Shape};
use super::origin::Origin;
use super::scene::{Block, Dot, Insert, Item};
use super::skipped::Skipped;
use crate::FormatError;
use crate::controls::controls;

/// Inserts within inserts. Nobody nests this deep; circles do.
const MAX_DEPTH: usize = 32;

/// Items looked at, at most: blocks may repeat nothing a billion times.
const MAX_VISITS: usize = 4_000_000;

/// Elements from which on lines are drawn whole: dashes may not be why a drawing is refused.
const MOST_DASHED: usize = super::MAX_ELEMENTS / 2;

/// Points and inserts that are told, at most: nobody marks more of them.
const MOST_SPOTS: usize = 100_000;

/// Points beyond this, after all scales of all inserts, are a broken file's.
const MAX_PLACE: f64 = 1e15;

/// A path in the world with its own look.
pub(super) struct Drawn {
    pub(super) path: Path,
    pub(super) layer: usize,
    pub(super) colour: Colour,
    /// A point, whose path has no length yet.
    pub(super) is_dot: bool,
    /// Entity of the space that draws it: of a block's lines, the insert.
    pub(super) origin: Origin,
    /// Further entities that are one path with it.
    pub(super) more: usize,
}

impl Drawn {
    /// Another path with everything else of this one.
    pub(super) const fn along(&self, path: Path) -> Self {
        Self { path, ..*self }
    }
}

/// A point, or where a block is inserted.
pub(super) struct Spot {
    pub(super) at: Point,
    pub(super) kind: PlaceKind,
    /// The block's name.
    pub(super) block: Option<Arc<str>>,
    pub(super) layer: usize,
    pub(super) colour: Colour,
    pub(super) origin: Origin,
}

/// All of some items that is visible, in file order.
pub(super) struct Unfolded {
    pub(super) drawn: Vec<Drawn>,
    pub(super) spots: Vec<Spot>,
}

/// Definitions that what is drawn refers to.
pub(super) struct Definitions<'a> {
    pub(super) layers: &'a Layers,
    pub(super) lines: &'a Lines,
    pub(super) blocks: &'a HashMap<String, Block>,
    /// Factor of the lengths of dashes; `None` draws all lines whole.
    pub(super) dash_scale: Option<f64>,
}

/// Where the items of a block are drawn.
#[derive(Clone, Copy)]
struct Setting {
    world_from_block: Affine,
    /// Layer of what lies on layer 0.
    layer: usize,
    /// Colour of what is coloured by its block.
    colour: Colour,
    /// Linetype of what has that of its block.
    line: usize,
    /// Entity of the space that draws the block.
    origin: Option<Origin>,
    depth: usize,
}

/// Layer, colour and linetype as they are in the end, and the entity that is found there.
#[derive(Clone, Copy)]
struct Shown {
    layer: usize,
    colour: Colour,
    line: usize,
    origin: Origin,
}

struct Unfolding<'a> {
    definitions: &'a Definitions<'a>,
    skipped: &'a mut Skipped,
    drawn: Vec<Drawn>,
    spots: Vec<Spot>,
    elements: usize,
    visits: usize,
}

/// Unfolds some items; what is not visible is counted.
///
/// # Errors
/// Blocks that hold themselves, and ones that repeat each other beyond all measure.
pub(super) fn unfolded(
    items: &[Item],
    skipped: &mut Skipped,
    definitions: &Definitions,
) -> Result<Unfolded, FormatError> {
    let (drawn, spots) = (Vec::new(), Vec::new());
    let mut unfolding = Unfolding { definitions, skipped, drawn, spots, elements: 0, visits: 0 };
    let world = Setting {
        world_from_block: Affine::IDENTITY,
        layer: LAYER_0,
        colour: Colour::BLACK,
        line: CONTINUOUS,
        origin: None,
        depth: 0,
    };
    unfolding.items(items, world)?;
    Ok(Unfolded { drawn: unfolding.drawn, spots: unfolding.spots })
}

impl Unfolding<'_> {
    fn items(&mut self, items: &[Item], at: Setting) -> Result<(), FormatError> {
        for item in items {
            self.visits += 1;
            check("DXF, its blocks repeated,", [self.visits, MAX_VISITS], "entities")?;
            match item {
                Item::Shape(shape) => self.shape(shape, at)?,
                Item::Dot(dot) => self.dot(dot, at)?,
                Item::Insert(insert) => self.insert(insert, at)?,
                Item::Text(text) => text.shapes.iter().try_for_each(|shape| self.shape(shape, at))?,
            }
        }
        Ok(())
    }

    fn shape(&mut self, shape: &Shape, at: Setting) -> Result<(), FormatError> {
        let Some(shown) = self.visible(shape.look, at) else { return Ok(()) };
        let path = match at.depth {
            0 => shape.path.clone(),
            _ => moved(&shape.path, at.world_from_block),
        };
        self.check_place(&path)?;
        if !has_length(&path) {
            self.skipped.without_length += 1;
            return Ok(());
        }
        let definitions = self.definitions;
        let lengths = definitions.lines.lengths(shown.line);
        let scale = definitions.dash_scale.filter(|_| !lengths.is_empty());
        if scale.is_some() && self.elements > MOST_DASHED {
            self.skipped.too_fine += 1;
            return self.push(path, shown);
        }
        match scale.map(|scale| dashed(&path, lengths, scale * shape.look.line_scale.abs())) {
            None | Some(Dashed::Whole) => self.push(path, shown),
            Some(Dashed::TooFine) => {
                self.skipped.too_fine += 1;
                self.push(path, shown)
            }
            Some(Dashed::Parts(parts)) => parts.into_iter().try_for_each(|part| self.push(part, shown)),
        }
    }

    fn push(&mut self, path: Path, shown: Shown) -> Result<(), FormatError> {
        self.elements += path.elements().len().max(super::LEAST_ELEMENTS);
        check("DXF, its blocks repeated,", [self.elements, super::MAX_ELEMENTS], "path segments")?;
        let Shown { layer, colour, origin, .. } = shown;
        self.drawn.push(Drawn { path, layer, colour, is_dot: false, origin, more: 0 });
        Ok(())
    }

    fn dot(&mut self, dot: &Dot, at: Setting) -> Result<(), FormatError> {
        let Some(shown) = self.visible(dot.look, at) else { return Ok(()) };
        let to = at.world_from_block * dot.at;
        let mut path = Path::new(to);
        path.push(Element::Line { to });
        self.check_place(&path)?;
        self.push(path, shown)?;
        self.drawn.iter_mut().last().into_iter().for_each(|own| own.is_dot = true);
        self.spot(to, (PlaceKind::Point, None), shown);
        Ok(())
    }

    fn spot(&mut self, at: Point, (kind, block): (PlaceKind, Option<Arc<str>>), shown: Shown) {
        let Shown { layer, colour, origin, .. } = shown;
        if self.spots.len() >= MOST_SPOTS {
            return;
        }
        self.spots.push(Spot { at, kind, block, layer, colour, origin });
    }

    /// How something looks; `None`, and counted, where its layer is not seen.
    fn visible(&mut self, look: Look, at: Setting) -> Option<Shown> {
        let shown = self.shown(look, at);
        let Layer { is_off, is_frozen, .. } = *self.definitions.layers.get(shown.layer);
        if is_off || is_frozen {
            self.skipped.hidden += 1;
            return None;
        }
        Some(shown)
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
        let Definitions { blocks, layers, .. } = self.definitions; // outlives the loan of self
        let shown = self.shown(insert.look, at);
        let Shown { layer, colour, line, origin } = shown;
        if layers.get(layer).is_frozen {
            self.skipped.hidden += 1;
            return Ok(());
        }
        let Some(block) = blocks.get(&insert.block) else {
            self.skipped.missing_blocks += 1;
            return Ok(());
        };
        if !insert.look.origin.is_insert() && block.items.is_empty() && block.skipped.is_empty() {
            self.skipped.empty_pictures += 1;
            return Ok(());
        }
        check("DXF's nesting of blocks (one may hold itself)", [at.depth + 1, MAX_DEPTH], "levels")?;
        let placed = at.world_from_block * insert.place * Affine::translate(-block.base.to_vec2());
        for (row, column) in (0..insert.rows).flat_map(|r| (0..insert.columns).map(move |c| (r, c))) {
            self.visits += 1 + block.skipped.kinds();
            check("DXF, its blocks repeated,", [self.visits, MAX_VISITS], "inserts")?;
            let step = insert.steps[0] * f64::from(column) + insert.steps[1] * f64::from(row);
            let step = at.world_from_block * step.to_point() - at.world_from_block * Point::ORIGIN;
            let world_from_block = Affine::translate(step) * placed;
            let to = world_from_block * block.base;
            // where its layer is off, others of its lines may be seen
            if insert.look.origin.is_insert() && !layers.get(layer).is_off && to.is_finite() {
                self.spot(to, (PlaceKind::Block, Some(insert.name.clone())), shown);
            }
            self.skipped.add(&block.skipped);
            let own =
                Setting { world_from_block, layer, colour, line, origin: Some(origin), depth: at.depth + 1 };
            self.items(&block.items, own)?;
        }
        Ok(())
    }

    fn shown(&self, look: Look, at: Setting) -> Shown {
        let layer = if look.layer == LAYER_0 { at.layer } else { look.layer };
        let own = self.definitions.layers.get(layer);
        let colour = match look.paint {
            Paint::Of(colour) => colour,
            Paint::ByBlock => at.colour,
            Paint::ByLayer => own.colour,
        };
        let line = match look.line {
            LineFrom::Of(line) => line,
            LineFrom::Block => at.line,
            LineFrom::Layer => own.line,
        };
        // whoever looks for a block's lines finds the insert
        Shown { layer, colour, line, origin: at.origin.unwrap_or(look.origin) }
    }
}

fn check(what: &'static str, [found, limit]: [usize; 2], unit: &'static str) -> Result<(), FormatError> {
    match found > limit {
        true => Err(FormatError::TooLarge { what, found, unit, limit }),
        false => Ok(()),
    }
}
