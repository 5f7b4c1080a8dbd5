//! The resolved tree as a scene: what it paints, in order, and the lines that could be drawn of it.

use std::collections::HashMap;
use std::sync::Arc;

use tracelight_stroke::{Colour, Entity, Path, Point, Rect, Stroke, StrokeKind};

use super::dash::MAX_DASHES;
use super::gates::{Gates, Key};
use super::ink::{adds_only, colour_of, has_hard_stops, ink_of};
use super::lines::{Drawn, Lines};
use super::names::{Names, Place};
use super::painted::{Fill, Letters, Pen, points};
use super::paper::is_paper;
use super::seen::scene::{Ink, Item, Mark, MarkKind, Number, Scene, Shape};
use super::seen::{Reason, View};
use super::shape::{affine, lines, scale};
use crate::controls::controls;
use crate::{FormatError, is_sound};

/// Elements of all strokes at most, for the memory they take.
const MAX_ELEMENTS: usize = 2_000_000;

/// A stroke takes the memory of so many elements at least.
const LEAST_ELEMENTS: usize = 4;

/// Opacity below this shows nothing: half a step of 8 bits.
const NOTHING: f64 = 0.5 / 255.0;

/// What of the tree cannot be painted as it is, counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Told {
    pub(super) filters: usize,
    pub(super) masks: usize,
    pub(super) patterns: usize,
    /// Gradients that change at once somewhere inside.
    pub(super) stops: usize,
    /// Dashed paths drawn as whole lines because there are too many dashes.
    pub(super) undashed: usize,
}

/// Makes a scene of a tree.
pub(super) struct Painter<'a> {
    pub(super) names: Names,
    pub(super) view: View,
    /// Draw dashes as dashes.
    pub(super) dashes: bool,
    /// Whether bands of pens matter: without other colours or widths, and without fills, no line hides another.
    pub(super) bands: bool,
    /// For text as single lines; outlines without.
    pub(super) letters: Option<Lines>,
    pub(super) scene: Scene<'a>,
    pub(super) told: Told,
    /// What is not even looked at, why and how long.
    pub(super) unseen: Vec<(Reason, f64)>,
    elements: usize,
    dashed: usize,
    paths: u32,
    clips: HashMap<Key, Number>,
    /// Whether the lowest item is paper if something is painted on it.
    is_on_paper: bool,
}

/// What is around a node.
#[derive(Clone)]
struct Around {
    place: Place,
    /// The text whose letters the paths are.
    entity: Option<Arc<Entity>>,
    veil: Option<Number>,
    gate: Option<Number>,
    /// Share of its own opacity that groups leave.
    opacity: f64,
    /// A filter or a blend makes of its colours what is not known here.
    is_mixed: bool,
}

enum Task<'a> {
    Node(&'a usvg::Node, Around),
    /// The edges of gates whose group is done.
    Cuts(Vec<Number>),
}

impl<'a> Painter<'a> {
    pub(super) fn new(names: Names, view: View, dashes: bool, bands: bool, letters: Option<Lines>) -> Self {
        Self {
            names,
            view,
            dashes,
            bands,
            letters,
            scene: Scene::default(),
            told: Told::default(),
            unseen: Vec::new(),
            elements: 0,
            dashed: 0,
            paths: 0,
            clips: HashMap::new(),
            is_on_paper: false,
        }
    }

    /// Paints all of a tree.
    pub(super) fn paint(&mut self, root: &'a usvg::Group) -> Result<(), FormatError> {
        let around = Around {
            place: Place::default(),
            entity: None,
            veil: None,
            gate: None,
            opacity: 1.0,
            is_mixed: false,
        };
        let mut left = Vec::new();
        self.group(root, around, &mut left);
        while let Some(task) = left.pop() {
            match task {
                Task::Node(usvg::Node::Group(group), around) => self.group(group, around, &mut left),
                Task::Node(usvg::Node::Path(path), around) => self.path(path, &around)?,
                Task::Node(usvg::Node::Text(text), around) => self.text(text, around, &mut left)?,
                Task::Node(..) => {}
                Task::Cuts(gates) => gates.into_iter().try_for_each(|gate| self.cut(gate))?,
            }
        }
        if self.is_on_paper && self.scene.items.len() > 1 {
            self.scene.marks.remove(0);
            let paper = self.scene.items[0].shape.lines();
            paper.iter().for_each(|path| self.leave_out(Reason::Paper, path));
        }
        self.topmost_cut();
        self.scene.elements = self.elements;
        Ok(())
    }

    /// Tells the edges of gates which is the topmost item that they could cut.
    fn topmost_cut(&mut self) {
        let mut topmost = vec![0; self.scene.gates.len()];
        for (number, item) in self.scene.items.iter().enumerate() {
            let around = |&gate: &Number| self.scene.gates[gate as usize].around;
            std::iter::successors(item.gate, around)
                .for_each(|gate| topmost[gate as usize] = number as Number);
        }
        for mark in &mut self.scene.marks {
            if let MarkKind::Cut(gate) = mark.kind {
                mark.item = topmost[gate as usize];
            }
        }
    }

    fn group(&mut self, group: &'a usvg::Group, around: Around, left: &mut Vec<Task<'a>>) {
        let mut inner = Around { place: self.names.within(&around.place, group.id()), ..around };
        inner.opacity *= f64::from(group.opacity().get());
        let (is_crop, tolerance) = (self.view.crops, self.view.tolerance());
        let mut gates = Gates { scene: &mut self.scene, tolerance, made: &mut self.clips };
        inner.veil = gates.veil(group, inner.veil);
        let made = match is_crop && inner.opacity > NOTHING {
            true => gates.gates_of(group, affine(group.abs_transform()), inner.gate),
            false => Vec::new(),
        };
        self.told.filters += usize::from(!group.filters().is_empty());
        inner.is_mixed |= group.blend_mode() != usvg::BlendMode::Normal || !adds_only(group);
        for one in made {
            inner.gate = Some(one.gate);
            self.told.masks += usize::from(one.is_unknown);
            left.push(Task::Cuts(one.new));
        }
        left.extend(group.children().iter().rev().map(|node| Task::Node(node, inner.clone())));
    }

    fn text(
        &mut self,
        text: &'a usvg::Text,
        around: Around,
        left: &mut Vec<Task<'a>>,
    ) -> Result<(), FormatError> {
        match self.letters.as_mut().and_then(|letters| letters.set(text)) {
            Some(drawn) => self.letters(drawn, text.id(), &around),
            None => {
                let entity = self.names.entity(&around.place, text.id());
                let around = Around { entity, ..around };
                let outlines = text.flattened().children().iter().rev();
                left.extend(outlines.map(|node| Task::Node(node, around.clone())));
                Ok(())
            }
        }
    }

    /// Letters without width: they hide nothing, and others may hide them.
    fn letters(&mut self, drawn: Vec<Drawn>, id: &str, around: &Around) -> Result<(), FormatError> {
        self.paths += 1;
        drawn.iter().try_for_each(|letter| self.check(controls(&letter.path)))?;
        if around.opacity <= NOTHING {
            drawn.iter().for_each(|letter| self.leave_out(Reason::Invisible, &letter.path));
            return Ok(());
        }
        let entity = self.names.entity(&around.place, id);
        let stroke = |Drawn { path, colour, is_edge }| {
            let kind = if is_edge { StrokeKind::Outline } else { StrokeKind::Centreline };
            let (layer, entity) = (around.place.layer.clone(), entity.clone());
            Stroke { kind, colour, layer, entity, ..Stroke::new(path) }
        };
        let letters: Vec<Stroke> = drawn.into_iter().map(stroke).collect();
        let is_alike = |a: &Stroke, b: &Stroke| (a.kind, a.colour) == (b.kind, b.colour);
        for alike in letters.chunk_by(is_alike) {
            let paths: Vec<Path> = alike.iter().map(|stroke| stroke.path.clone()).collect();
            paths.iter().for_each(|path| self.count(path.elements().len()));
            let looks = alike[0].along(Path::new(Point::ORIGIN));
            let ink = Ink::Plain(looks.colour.unwrap_or(Colour::BLACK));
            let item = self.item(Box::new(Letters(paths)), ink, usvg::Opacity::ONE, looks, around);
            self.scene.marks.push(Mark { kind: MarkKind::Middle, item });
        }
        self.check_count()
    }

    fn path(&mut self, path: &'a usvg::Path, around: &Around) -> Result<(), FormatError> {
        if !path.is_visible() {
            return Ok(());
        }
        let entity = around.entity.clone().or_else(|| self.names.entity(&around.place, path.id()));
        let around = &Around { entity, ..around.clone() };
        self.paths += 1;
        self.check(points(path))?;
        let shown = |opacity: usvg::Opacity| f64::from(opacity.get()) * around.opacity > NOTHING;
        let stroke = path.stroke().filter(|s| shown(s.opacity()));
        let fill = path.fill().filter(|f| shown(f.opacity()));
        if stroke.is_none() && fill.is_none() {
            let at = affine(path.abs_transform());
            lines(path, at, path.stroke().is_none())
                .paths
                .iter()
                .for_each(|p| self.leave_out(Reason::Invisible, p));
            return Ok(());
        }
        match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => {
                self.fill(path, fill, stroke.is_none(), around)?;
                self.stroke(path, stroke, around)
            }
            usvg::PaintOrder::StrokeAndFill => {
                self.stroke(path, stroke, around)?;
                self.fill(path, fill, stroke.is_none(), around)
            }
        }
    }

    fn fill(
        &mut self,
        path: &'a usvg::Path,
        fill: Option<&'a usvg::Fill>,
        is_drawn: bool,
        around: &Around,
    ) -> Result<(), FormatError> {
        let Some(fill) = fill else { return Ok(()) };
        self.tell(fill.paint());
        let looks = looks(StrokeKind::Outline, None, fill.paint(), around);
        let at = affine(path.abs_transform());
        let shape = Fill { path, rule: fill.rule(), tolerance: self.view.tolerance(), is_drawn };
        let item = self.item(Box::new(shape), ink_of(fill.paint(), at), fill.opacity(), looks, around);
        if is_drawn {
            self.count(path.data().len());
            self.scene.marks.push(Mark { kind: MarkKind::Edge, item });
            self.is_on_paper |= item == 0 && is_paper(&self.scene.items[0], self.view.page);
        }
        self.check_count()
    }

    fn stroke(
        &mut self,
        path: &'a usvg::Path,
        stroke: Option<&'a usvg::Stroke>,
        around: &Around,
    ) -> Result<(), FormatError> {
        let Some(stroke) = stroke else { return Ok(()) };
        let (at, tolerance) = (affine(path.abs_transform()), self.view.tolerance());
        let mut pen = Pen { path, stroke, tolerance, is_dashed: false, has_band: self.bands };
        let dashes = pen.dashes().filter(|_| self.dashes);
        pen.is_dashed = dashes.is_some_and(|count| self.may_dash(count));
        self.count(if pen.is_dashed { dashes.unwrap_or(0) * LEAST_ELEMENTS } else { path.data().len() });
        self.tell(stroke.paint());
        let looks = looks(StrokeKind::Centreline, Some(pen.width()), stroke.paint(), around);
        let item = self.item(Box::new(pen), ink_of(stroke.paint(), at), stroke.opacity(), looks, around);
        self.scene.marks.push(Mark { kind: MarkKind::Middle, item });
        self.check_count()
    }

    fn tell(&mut self, paint: &usvg::Paint) {
        self.told.patterns += usize::from(matches!(paint, usvg::Paint::Pattern(_)));
        self.told.stops += usize::from(has_hard_stops(paint));
    }

    fn may_dash(&mut self, count: usize) -> bool {
        let fits = self.dashed.saturating_add(count) <= MAX_DASHES;
        self.dashed += if fits { count } else { 0 };
        self.told.undashed += usize::from(!fits);
        fits
    }

    fn item(
        &mut self,
        shape: Box<dyn Shape + 'a>,
        ink: Ink,
        opacity: usvg::Opacity,
        looks: Stroke,
        around: &Around,
    ) -> Number {
        self.scene.items.push(Item {
            shape,
            ink: if around.is_mixed { Ink::Mixed { hides: false } } else { ink },
            opacity: f64::from(opacity.get()),
            veil: around.veil,
            gate: around.gate,
            pen: looks.pen,
            source: self.paths,
            looks,
        });
        (self.scene.items.len() - 1) as Number
    }

    fn cut(&mut self, gate: Number) -> Result<(), FormatError> {
        let outlines = std::mem::take(&mut self.scene.gates[gate as usize].outlines);
        outlines.iter().try_for_each(|path| self.check(controls(path)))?;
        outlines.iter().for_each(|path| self.count(path.elements().len()));
        self.scene.gates[gate as usize].outlines = outlines;
        self.scene.marks.push(Mark { kind: MarkKind::Cut(gate), item: 0 });
        self.check_count()
    }

    fn leave_out(&mut self, reason: Reason, path: &Path) {
        self.unseen.push((reason, path.length(self.view.tolerance())));
    }

    fn count(&mut self, elements: usize) {
        self.elements += elements.max(LEAST_ELEMENTS);
    }

    fn check_count(&self) -> Result<(), FormatError> {
        let found = self.elements;
        if found > MAX_ELEMENTS {
            return Err(FormatError::TooLarge {
                what: "SVG",
                found,
                unit: "path segments",
                limit: MAX_ELEMENTS,
            });
        }
        Ok(())
    }

    fn check(&self, mut points: impl Iterator<Item = Point>) -> Result<(), FormatError> {
        match points.find(|&p| !is_sound(p)) {
            Some(Point { x, y }) => {
                Err(FormatError::Far { place: format!("stroke {}", self.scene.marks.len() + 1), x, y })
            }
            None => Ok(()),
        }
    }
}

fn looks(kind: StrokeKind, pen: Option<f64>, paint: &usvg::Paint, around: &Around) -> Stroke {
    let path = Path::new(Point::ORIGIN);
    let (layer, entity) = (around.place.layer.clone(), around.entity.clone());
    Stroke { kind, pen, colour: colour_of(paint), layer, entity, ..Stroke::new(path) }
}

/// Whether any line of a tree could hide another: there are fills, text, several colours, or very different pens.
pub(super) fn do_bands_matter(root: &usvg::Group) -> bool {
    const ALIKE: f64 = 4.0;
    let mut left: Vec<&usvg::Node> = root.children().iter().collect();
    let mut one: Option<(&usvg::Paint, [f64; 2])> = None;
    while let Some(node) = left.pop() {
        match node {
            usvg::Node::Group(group) => left.extend(group.children()),
            usvg::Node::Path(path) => {
                let Some(stroke) = path.stroke().filter(|_| path.fill().is_none()) else { return true };
                let pen = f64::from(stroke.width().get()) * scale(affine(path.abs_transform()));
                let (paint, [least, most]) = one.unwrap_or((stroke.paint(), [pen, pen]));
                let [least, most] = [least.min(pen), most.max(pen)];
                if paint != stroke.paint() || most > ALIKE * least {
                    return true;
                }
                one = Some((paint, [least, most]));
            }
            usvg::Node::Text(_) => return true,
            usvg::Node::Image(_) => {}
        }
    }
    false
}

/// The page of a sheet.
pub(super) fn page(width: f64, height: f64) -> Rect {
    Rect::new(0.0, 0.0, width, height)
}
