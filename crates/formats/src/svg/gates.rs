//! Clip paths and masks of the resolved tree as gates of a scene.

use std::collections::HashMap;

use kurbo::Affine;
use tracelight_stroke::{Path, Rect, Stroke};
use usvg::FillRule;

use super::ink::ink_of;
use super::seen::Region;
use super::seen::scene::{Gate, GateKind, Ink, Item, Number, Scene, Veil};
use super::shape::{affine, band, filled, lines};

/// A gate and the lines along which it cuts.
pub(super) struct Made {
    pub(super) gate: Number,
    pub(super) outlines: Vec<Path>,
    /// Whether it is a mask whose picture is no plain shapes.
    pub(super) is_unknown: bool,
}

/// Adds gates to a scene.
pub(super) struct Gates<'a> {
    pub(super) scene: &'a mut Scene,
    pub(super) tolerance: f64,
    /// Clip paths made already: many groups share one.
    pub(super) made: &'a mut HashMap<Key, Number>,
}

/// A clip path of the tree, where it is, and the gate around it.
pub(super) type Key = (usize, [u64; 6], Option<Number>);

/// Where in a gate's own picture a node is.
#[derive(Clone, Copy)]
struct Within {
    at: Affine,
    gate: Option<Number>,
    veil: Option<Number>,
}

impl Gates<'_> {
    fn add(&mut self, kind: GateKind, own: Rect, around: Option<Number>) -> Number {
        let bounds = around.map_or(own, |gate| own.intersect(self.scene.gates[gate as usize].bounds));
        self.scene.gates.push(Gate { around, kind, bounds });
        (self.scene.gates.len() - 1) as Number
    }

    /// A clip path of a group at `at`.
    pub(super) fn clip(&mut self, clip: &usvg::ClipPath, at: Affine, around: Option<Number>) -> Made {
        let key = (std::ptr::from_ref(clip).addr(), at.as_coeffs().map(f64::to_bits), around);
        if let Some(&gate) = self.made.get(&key) {
            return Made { gate, outlines: Vec::new(), is_unknown: false };
        }
        let mut outlines = Vec::new();
        let around = match clip.clip_path() {
            Some(outer) => {
                let made = self.clip(outer, at, around);
                outlines.extend(made.outlines);
                Some(made.gate)
            }
            None => around,
        };
        let mut regions = Vec::new();
        let within = Within { at: at * affine(clip.transform()), gate: None, veil: None };
        self.clip_shapes(clip.root(), within, &mut regions, &mut outlines);
        let bounds = regions.iter().map(|(region, _)| region.bounds()).reduce(|a, b| a.union(b));
        let gate = self.add(GateKind::Clip(regions), bounds.unwrap_or(NOWHERE), around);
        self.made.insert(key, gate);
        Made { gate, outlines, is_unknown: false }
    }

    fn clip_shapes(
        &mut self,
        group: &usvg::Group,
        within: Within,
        regions: &mut Vec<(Region, Option<Number>)>,
        outlines: &mut Vec<Path>,
    ) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => {
                    let mut within = within;
                    if let Some(clip) = inner.clip_path() {
                        let made = self.clip(clip, within.at * affine(inner.abs_transform()), within.gate);
                        within.gate = Some(made.gate);
                        outlines.extend(made.outlines);
                    }
                    self.clip_shapes(inner, within, regions, outlines);
                }
                usvg::Node::Path(path) if path.is_visible() => {
                    let paths = lines(path, within.at * affine(path.abs_transform()), true).paths;
                    let rule = path.fill().map_or(FillRule::NonZero, usvg::Fill::rule);
                    regions.push((filled(&paths, rule, self.tolerance), within.gate));
                    outlines.extend(paths);
                }
                usvg::Node::Text(text) => self.clip_shapes(text.flattened(), within, regions, outlines),
                _ => {}
            }
        }
    }

    /// A mask of a group at `at`.
    pub(super) fn mask(&mut self, mask: &usvg::Mask, at: Affine, around: Option<Number>) -> Made {
        let mut outlines = Vec::new();
        let mut is_unknown = false;
        let around = match mask.mask() {
            Some(outer) => {
                let made = self.mask(outer, at, around);
                outlines.extend(made.outlines);
                is_unknown = made.is_unknown;
                Some(made.gate)
            }
            None => around,
        };
        let edge = rectangle(mask.rect(), at);
        let frame = filled(std::slice::from_ref(&edge), FillRule::NonZero, self.tolerance);
        let bounds = frame.bounds();
        let around = self.add(GateKind::Clip(vec![(frame, None)]), bounds, around);
        let mut picture = MaskPicture { items: Vec::new(), is_plain: true };
        let within = Within { at, gate: None, veil: None };
        self.mask_shapes(mask.root(), within, &mut picture, &mut outlines);
        if !picture.is_plain {
            let gate = self.add(GateKind::Unknown, bounds, Some(around));
            return Made { gate, outlines: Vec::new(), is_unknown: true };
        }
        let luminance = mask.kind() == usvg::MaskType::Luminance;
        let gate = self.add(GateKind::Mask { luminance, items: picture.items }, bounds, Some(around));
        Made { gate, outlines, is_unknown }
    }

    fn mask_shapes(
        &mut self,
        group: &usvg::Group,
        within: Within,
        picture: &mut MaskPicture,
        outlines: &mut Vec<Path>,
    ) {
        let mut within = within;
        let at = within.at * affine(group.abs_transform());
        picture.is_plain &= group.filters().is_empty() && group.blend_mode() == usvg::BlendMode::Normal;
        for made in self.gates_of(group, at, within.gate) {
            within.gate = Some(made.gate);
            outlines.extend(made.outlines);
            picture.is_plain &= !made.is_unknown;
        }
        within.veil = self.veil(group, within.veil);
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => self.mask_shapes(inner, within, picture, outlines),
                usvg::Node::Path(path) if path.is_visible() => {
                    self.mask_path(path, within, picture, outlines)
                }
                usvg::Node::Path(_) => {}
                usvg::Node::Text(text) => self.mask_shapes(text.flattened(), within, picture, outlines),
                _ => picture.is_plain = false,
            }
        }
    }

    /// The clip path and the mask of a group, the inner one last.
    pub(super) fn gates_of(&mut self, group: &usvg::Group, at: Affine, around: Option<Number>) -> Vec<Made> {
        let clip = group.clip_path().map(|clip| self.clip(clip, at, around));
        let around = clip.as_ref().map_or(around, |made| Some(made.gate));
        let mask = group.mask().map(|mask| self.mask(mask, at, around));
        clip.into_iter().chain(mask).collect()
    }

    /// The group's own translucency.
    pub(super) fn veil(&mut self, group: &usvg::Group, around: Option<Number>) -> Option<Number> {
        let opacity = f64::from(group.opacity().get());
        if opacity >= 1.0 {
            return around;
        }
        self.scene.veils.push(Veil { around, opacity });
        Some((self.scene.veils.len() - 1) as Number)
    }

    fn mask_path(
        &mut self,
        path: &usvg::Path,
        within: Within,
        picture: &mut MaskPicture,
        outlines: &mut Vec<Path>,
    ) {
        let at = within.at * affine(path.abs_transform());
        let item = |region: Region, ink: Ink, opacity: f64| Item {
            region,
            ink,
            opacity,
            veil: within.veil,
            gate: within.gate,
            pen: None,
            source: 0,
            looks: Stroke::new(Path::new(tracelight_stroke::Point::ORIGIN)),
        };
        let fill = path.fill().map(|fill| {
            let paths = lines(path, at, true).paths;
            let region = filled(&paths, fill.rule(), self.tolerance);
            outlines.extend(paths);
            item(region, ink_of(fill.paint()), f64::from(fill.opacity().get()))
        });
        let stroke = path.stroke().map(|stroke| {
            let region = band(path, stroke, at, self.tolerance, true);
            item(region, ink_of(stroke.paint()), f64::from(stroke.opacity().get()))
        });
        let is_plain = |item: &Item| matches!(item.ink, Ink::Plain(_));
        picture.is_plain &= fill.iter().chain(&stroke).all(is_plain);
        match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => picture.items.extend(fill.into_iter().chain(stroke)),
            usvg::PaintOrder::StrokeAndFill => picture.items.extend(stroke.into_iter().chain(fill)),
        }
    }
}

/// What a mask paints.
struct MaskPicture {
    items: Vec<Item>,
    /// Only shapes of one colour each.
    is_plain: bool,
}

/// A rectangle in which nothing lies.
const NOWHERE: Rect = Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);

fn rectangle(rect: usvg::NonZeroRect, at: Affine) -> Path {
    let [x0, y0, x1, y1] = [rect.left(), rect.top(), rect.right(), rect.bottom()].map(f64::from);
    let corners =
        [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|corner| at * tracelight_stroke::Point::from(corner));
    let mut path = Path::new(corners[0]);
    corners.iter().skip(1).for_each(|&corner| path.line_to(corner));
    path.close();
    path
}
