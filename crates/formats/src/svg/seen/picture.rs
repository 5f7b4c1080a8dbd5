//! What colour is seen at a point, and what makes it.

use std::cell::Cell;

use tracelight_stroke::{Point, Rect};

use super::colour::{Look, Rgb};
use super::region::Region;
use super::scene::{GateKind, Ink, Item, Light, Number, Scene};
use super::tiles::Tiles;

/// Coverage below this share lets nothing pass that could be seen; opacity above one minus it hides.
pub(crate) const FAINT: f64 = 0.02;

/// A scene on its paper, ready to be looked at.
pub(crate) struct Picture<'a> {
    pub(crate) scene: &'a Scene<'a>,
    pub(crate) page: Rect,
    /// Colour below everything.
    pub(crate) paper: Rgb,
    /// Whether what is painted hides what is below.
    pub(crate) hides: bool,
    tiles: Tiles,
    regions: Vec<Option<Region>>,
    /// Segments looked at so far.
    pub(crate) work: Cell<usize>,
}

/// Something that is seen at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    pub(crate) item: Number,
    /// How much of it is seen through its own opacity, groups and masks.
    pub(crate) alpha: f64,
}

impl<'a> Picture<'a> {
    /// A scene as it is laid out.
    pub(crate) fn new(
        scene: &'a Scene<'a>,
        page: Rect,
        hides: bool,
        (tiles, regions): (Tiles, Vec<Option<Region>>),
    ) -> Self {
        Self { scene, page, paper: Rgb::WHITE, hides, tiles, regions, work: Cell::new(0) }
    }

    /// Whether nothing of an item can be seen anywhere.
    pub(crate) fn is_unseen(&self, item: Number) -> bool {
        self.regions[item as usize].is_none()
    }

    /// Whether an item is surely covered all along a segment.
    pub(crate) fn is_hidden(&self, item: Number, segment: [Point; 2]) -> bool {
        self.tiles.is_hidden(item, segment)
    }

    /// Whether an item is surely covered somewhere along a segment.
    pub(crate) fn is_somewhere_hidden(&self, item: Number, segment: [Point; 2]) -> bool {
        self.tiles.is_somewhere_hidden(item, segment)
    }

    /// A fill that hides an item, and everything else below, at two points.
    pub(crate) fn cover(&self, item: Number, sides: [Point; 2]) -> Option<Number> {
        if !self.hides {
            return None;
        }
        let own = &self.scene.items[item as usize];
        self.tiles.cover(item, sides, |number, points| {
            self.add_work(1);
            let cover = &self.scene.items[number as usize];
            is_cover(cover)
                && cover.gate.is_none()
                && cover.source != own.source
                && points.iter().all(|&p| self.is_inside(number, p))
        })
    }

    /// What is seen at a point of the items that count, the topmost first.
    pub(crate) fn stack(&self, p: Point, counts: impl Fn(Number, &Item) -> bool) -> Vec<Layer> {
        let mut layers = Vec::new();
        let mut closed: Vec<Number> = Vec::new();
        for (number, is_full) in self.tiles.at(p) {
            let item = &self.scene.items[number as usize];
            self.add_work(1);
            if !counts(number, item) || self.veils(item.veil).any(|veil| closed.contains(&veil)) {
                continue;
            }
            if !is_full && !self.is_inside(number, p) {
                continue;
            }
            let own = item.opacity * self.gate(item.gate, p);
            if own <= FAINT {
                continue;
            }
            layers.push(Layer { item: number, alpha: own * self.veiled(item.veil) });
            if self.hides && is_opaque(item, own) {
                match item.veil {
                    None => break,
                    Some(veil) => closed.push(veil),
                }
            }
        }
        layers
    }

    /// Items of which something may be seen near a point, the topmost first.
    pub(crate) fn items_at(&self, p: Point) -> impl Iterator<Item = Number> + '_ {
        self.tiles.at(p).map(|(number, _)| {
            self.add_work(1);
            number
        })
    }

    /// Whether something painted after an item hides it at a point, of the items that count.
    pub(crate) fn is_covered(&self, of: Number, p: Point, counts: impl Fn(&Item) -> bool) -> bool {
        let item = &self.scene.items[of as usize];
        let mut above = self.tiles.at(p).take_while(|&(number, _)| number > of);
        above.any(|(number, is_full)| {
            self.add_work(1);
            let cover = &self.scene.items[number as usize];
            let is_within = cover.veil.is_none_or(|veil| self.veils(item.veil).any(|own| own == veil));
            counts(cover)
                && is_within
                && is_opaque(cover, cover.opacity)
                && (is_full || self.is_inside(number, p))
                && is_opaque(cover, cover.opacity * self.gate(cover.gate, p))
        })
    }

    /// The colour that layers make on the paper at a point.
    pub(crate) fn look(&self, layers: &[Layer], p: Point) -> Look {
        let mut look = Look::of(self.paper);
        for layer in layers.iter().rev() {
            match &self.scene.items[layer.item as usize].ink {
                Ink::Plain(colour) => look.paint(Rgb::from(*colour), layer.alpha),
                Ink::Gradient(gradient) => {
                    let (colour, alpha) = gradient.at(p);
                    look.paint(colour, layer.alpha * alpha);
                }
                Ink::Mixed { .. } => look.mix(layer.item, layer.alpha),
            }
        }
        look
    }

    /// Whether a point lies in an item's own region, gates aside.
    pub(crate) fn is_inside(&self, item: Number, p: Point) -> bool {
        self.regions[item as usize].as_ref().is_some_and(|region| self.holds(region, p))
    }

    fn holds(&self, region: &Region, p: Point) -> bool {
        let (inside, work) = region.contains(p);
        self.add_work(work);
        inside
    }

    /// How much a gate and those around it let pass at a point, 0 to 1.
    pub(crate) fn gate(&self, gate: Option<Number>, p: Point) -> f64 {
        let mut passed = 1.0;
        let mut next = gate;
        while let Some(number) = next.filter(|_| passed > FAINT) {
            passed *= self.own_gate(number, p);
            next = self.scene.gates[number as usize].around;
        }
        passed
    }

    /// The innermost gate that does not let pass at a point.
    pub(crate) fn shut(&self, gate: Option<Number>, p: Point) -> Option<Number> {
        let around = |&number: &Number| self.scene.gates[number as usize].around;
        std::iter::successors(gate, around).find(|&number| self.own_gate(number, p) <= FAINT)
    }

    fn own_gate(&self, number: Number, p: Point) -> f64 {
        let gate = &self.scene.gates[number as usize];
        self.add_work(1);
        if !is_within(gate.bounds, p) {
            return 0.0;
        }
        match &gate.kind {
            GateKind::Unknown => 0.5,
            GateKind::Clip(regions) => {
                let passes = |(region, own): &(Region, Option<Number>)| {
                    self.holds(region, p) && self.gate(*own, p) > FAINT
                };
                f64::from(u8::from(regions.iter().any(passes)))
            }
            GateKind::Mask { luminance, lights } => self.masked(*luminance, lights, p),
        }
    }

    fn masked(&self, by_luminance: bool, lights: &[Light], p: Point) -> f64 {
        let (mut light, mut cover) = (0.0, 0.0);
        for own in lights {
            if !self.holds(&own.region, p) {
                continue;
            }
            let (colour, own_alpha) = match &own.ink {
                Ink::Plain(colour) => (Rgb::from(*colour), 1.0),
                Ink::Gradient(gradient) => gradient.at(p),
                Ink::Mixed { .. } => continue,
            };
            let alpha = own_alpha * own.opacity * self.veiled(own.veil) * self.gate(own.gate, p);
            light = light * (1.0 - alpha) + colour.luminance() * alpha;
            cover = cover * (1.0 - alpha) + alpha;
        }
        if by_luminance { light } else { cover }
    }

    /// What groups leave of an opacity.
    fn veiled(&self, veil: Option<Number>) -> f64 {
        self.veils(veil).map(|veil| self.scene.veils[veil as usize].opacity).product()
    }

    fn veils(&self, innermost: Option<Number>) -> impl Iterator<Item = Number> + '_ {
        std::iter::successors(innermost, |&veil| self.scene.veils[veil as usize].around)
    }

    pub(crate) fn add_work(&self, segments: usize) {
        self.work.set(self.work.get() + segments);
    }
}

/// Whether nothing shines through an item at that opacity.
pub(crate) fn is_opaque(item: &Item, opacity: f64) -> bool {
    opacity >= 1.0 - FAINT && item.ink.hides()
}

/// Whether an item hides all below it where it is: a fill. Of a line's band it depends on what is below.
pub(crate) fn is_cover(item: &Item) -> bool {
    item.pen.is_none() && item.veil.is_none() && is_opaque(item, item.opacity)
}

/// Whether a point lies in a rectangle, its edge included.
pub(crate) fn is_within(rect: Rect, p: Point) -> bool {
    p.x >= rect.x0 && p.x <= rect.x1 && p.y >= rect.y0 && p.y <= rect.y1
}
