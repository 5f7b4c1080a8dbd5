//! Clip paths and masks of the resolved tree as gates of a scene.

use std::collections::HashMap;

use kurbo::Affine;
use tracelight_stroke::{Path, Rect};
use usvg::FillRule;

use super::ink::ink_of;
use super::seen::Region;
use super::seen::scene::{Gate, GateKind, Ink, Light, Number, Scene, Veil};
use super::shape::{affine, filled, lines, sides};

/// Gates made of a clip path or mask.
pub(super) struct Made {
    /// The innermost.
    pub(super) gate: Number,
    /// Those that are new, the innermost last.
    pub(super) new: Vec<Number>,
    /// Whether it is a mask whose picture is no plain shapes.
    pub(super) is_unknown: bool,
}

/// Adds gates to a scene.
pub(super) struct Gates<'s, 'a> {
    pub(super) scene: &'s mut Scene<'a>,
    pub(super) tolerance: f64,
    /// Clip paths made already: many groups share one.
    pub(super) made: &'s mut HashMap<Key, Number>,
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

impl Gates<'_, '_> {
    fn add(&mut self, kind: GateKind, own: Rect, around: Option<Number>, outlines: Vec<Path>) -> Number {
        let bounds = around.map_or(own, |gate| own.intersect(self.scene.gates[gate as usize].bounds));
        self.scene.gates.push(Gate { around, kind, bounds, outlines });
        (self.scene.gates.len() - 1) as Number
    }

    /// A clip path of a group at `at`.
    pub(super) fn clip(&mut self, clip: &usvg::ClipPath, at: Affine, around: Option<Number>) -> Made {
        let key = (std::ptr::from_ref(clip).addr(), at.as_coeffs().map(f64::to_bits), around);
        if let Some(&gate) = self.made.get(&key) {
            return Made { gate, new: Vec::new(), is_unknown: false };
        }
        let outer = clip.clip_path().map(|outer| self.clip(outer, at, around));
        let around = outer.as_ref().map_or(around, |made| Some(made.gate));
        let mut shapes =
            ClipShapes { new: outer.map_or_else(Vec::new, |made| made.new), ..Default::default() };
        let within = Within { at: at * affine(clip.transform()), gate: None, veil: None };
        self.clip_shapes(clip.root(), within, &mut shapes);
        let bounds = shapes.regions.iter().map(|(region, _)| region.bounds()).reduce(|a, b| a.union(b));
        let kind = GateKind::Clip(shapes.regions);
        let gate = self.add(kind, bounds.unwrap_or(NOWHERE), around, shapes.outlines);
        self.made.insert(key, gate);
        shapes.new.push(gate);
        Made { gate, new: shapes.new, is_unknown: false }
    }

    fn clip_shapes(&mut self, group: &usvg::Group, within: Within, shapes: &mut ClipShapes) {
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => {
                    let mut within = within;
                    if let Some(clip) = inner.clip_path() {
                        let made = self.clip(clip, within.at * affine(inner.abs_transform()), within.gate);
                        within.gate = Some(made.gate);
                        shapes.new.extend(made.new);
                    }
                    self.clip_shapes(inner, within, shapes);
                }
                usvg::Node::Path(path) if path.is_visible() => {
                    let paths = lines(path, within.at * affine(path.abs_transform()), true).paths;
                    let rule = path.fill().map_or(FillRule::NonZero, usvg::Fill::rule);
                    shapes.regions.push((filled(&paths, rule, self.tolerance), within.gate));
                    shapes.outlines.extend(paths);
                }
                usvg::Node::Text(text) => self.clip_shapes(text.flattened(), within, shapes),
                _ => {}
            }
        }
    }

    /// A mask of a group at `at`.
    pub(super) fn mask(&mut self, mask: &usvg::Mask, at: Affine, around: Option<Number>) -> Made {
        let outer = mask.mask().map(|outer| self.mask(outer, at, around));
        let around = outer.as_ref().map_or(around, |made| Some(made.gate));
        let is_outer_unknown = outer.as_ref().is_some_and(|made| made.is_unknown);
        let mut picture = MaskPicture { is_plain: true, ..Default::default() };
        picture.new = outer.map_or_else(Vec::new, |made| made.new);
        let edge = rectangle(mask.rect(), at);
        let frame = filled(std::slice::from_ref(&edge), FillRule::NonZero, self.tolerance);
        let bounds = frame.bounds();
        let around = self.add(GateKind::Clip(vec![(frame, None)]), bounds, around, vec![edge]);
        picture.new.push(around);
        let within = Within { at, gate: None, veil: None };
        self.mask_shapes(mask.root(), within, &mut picture);
        let luminance = mask.kind() == usvg::MaskType::Luminance;
        let gate = match picture.is_plain {
            true => {
                let kind = GateKind::Mask { luminance, lights: picture.lights };
                self.add(kind, bounds, Some(around), picture.outlines)
            }
            false => self.add(GateKind::Unknown, bounds, Some(around), Vec::new()),
        };
        picture.new.push(gate);
        Made { gate, new: picture.new, is_unknown: is_outer_unknown || !picture.is_plain }
    }

    fn mask_shapes(&mut self, group: &usvg::Group, within: Within, picture: &mut MaskPicture) {
        let mut within = within;
        let at = within.at * affine(group.abs_transform());
        picture.is_plain &= group.filters().is_empty() && group.blend_mode() == usvg::BlendMode::Normal;
        for made in self.gates_of(group, at, within.gate) {
            within.gate = Some(made.gate);
            picture.is_plain &= !made.is_unknown;
            picture.new.extend(made.new);
        }
        within.veil = self.veil(group, within.veil);
        for node in group.children() {
            match node {
                usvg::Node::Group(inner) => self.mask_shapes(inner, within, picture),
                usvg::Node::Path(path) if path.is_visible() => self.mask_path(path, within, picture),
                usvg::Node::Path(_) => {}
                usvg::Node::Text(text) => self.mask_shapes(text.flattened(), within, picture),
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

    fn mask_path(&mut self, path: &usvg::Path, within: Within, picture: &mut MaskPicture) {
        let at = within.at * affine(path.abs_transform());
        let light = |region: Region, paint: &usvg::Paint, opacity: usvg::Opacity| Light {
            region,
            ink: ink_of(paint, at),
            opacity: f64::from(opacity.get()),
            veil: within.veil,
            gate: within.gate,
        };
        let fill = path.fill().map(|fill| {
            let paths = lines(path, at, true).paths;
            let region = filled(&paths, fill.rule(), self.tolerance);
            picture.outlines.extend(paths);
            light(region, fill.paint(), fill.opacity())
        });
        let stroke = path.stroke().map(|stroke| {
            let sides = sides(path, stroke, at, self.tolerance, true);
            let band = filled(&sides, FillRule::NonZero, self.tolerance);
            light(band, stroke.paint(), stroke.opacity())
        });
        let is_plain = |light: &Light| !matches!(light.ink, Ink::Mixed { .. });
        picture.is_plain &= fill.iter().chain(&stroke).all(is_plain);
        match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => picture.lights.extend(fill.into_iter().chain(stroke)),
            usvg::PaintOrder::StrokeAndFill => picture.lights.extend(stroke.into_iter().chain(fill)),
        }
    }
}

/// What a clip path lets pass.
#[derive(Default)]
struct ClipShapes {
    regions: Vec<(Region, Option<Number>)>,
    outlines: Vec<Path>,
    new: Vec<Number>,
}

/// What a mask paints.
#[derive(Default)]
struct MaskPicture {
    lights: Vec<Light>,
    outlines: Vec<Path>,
    new: Vec<Number>,
    /// Only shapes of colours and gradients.
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
