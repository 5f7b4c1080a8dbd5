//! The resolved tree as a scene: what it paints, in order, and the lines that could be drawn of it.

use std::collections::HashMap;
use std::sync::Arc;

use kurbo::Affine;
use tracelight_stroke::{Colour, Entity, Path, Point, Rect, Stroke, StrokeKind};

use super::dash::{Dashes, MAX_DASHES, dot, moved};
use super::gates::{Gates, Key};
use super::ink::{adds_only, colour_of, ink_of};
use super::lines::{Drawn, Lines};
use super::names::{Names, Place};
use super::paper::is_paper;
use super::seen::scene::{Ink, Item, Mark, MarkKind, Number, Scene};
use super::seen::{Reason, Region, View};
use super::shape::{affine, band, filled, lines, own_lines, scale};
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
    /// Dashed paths drawn as whole lines because there are too many dashes.
    pub(super) undashed: usize,
}

/// Makes a scene of a tree.
pub(super) struct Painter {
    pub(super) names: Names,
    pub(super) view: View,
    /// Draw dashes as dashes.
    pub(super) dashes: bool,
    /// Whether bands of pens matter: without other colours or widths, and without fills, no line hides another.
    pub(super) bands: bool,
    /// For text as single lines; outlines without.
    pub(super) letters: Option<Lines>,
    pub(super) scene: Scene,
    pub(super) told: Told,
    /// What is not even looked at, why and how long.
    pub(super) unseen: Vec<(Reason, f64)>,
    elements: usize,
    dashed: usize,
    paths: u32,
    clips: HashMap<Key, Number>,
    /// The mark that is paper if something is painted on it.
    paper: Option<Mark>,
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
    /// The edges of a gate whose group is done.
    Cuts(Number, Vec<Path>),
}

impl Painter {
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
            paper: None,
        }
    }

    /// Paints all of a tree.
    pub(super) fn paint(&mut self, root: &usvg::Group) -> Result<(), FormatError> {
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
                Task::Cuts(gate, outlines) => {
                    outlines.into_iter().try_for_each(|path| self.cut(gate, path))?
                }
            }
        }
        if let Some(paper) = self.paper.take() {
            if self.scene.items.len() > 1 {
                self.leave_out(Reason::Paper, &paper.stroke.path);
            } else {
                self.scene.marks.insert(0, paper);
            }
        }
        Ok(())
    }

    fn group<'a>(&mut self, group: &'a usvg::Group, around: Around, left: &mut Vec<Task<'a>>) {
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
            left.push(Task::Cuts(one.gate, one.outlines));
        }
        left.extend(group.children().iter().rev().map(|node| Task::Node(node, inner.clone())));
    }

    fn text<'a>(
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
        let mut item: Option<(Option<Colour>, Number)> = None;
        drawn.iter().try_for_each(|letter| self.check(&letter.path))?;
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
        for stroke in drawn.into_iter().map(stroke) {
            self.count(&stroke.path);
            let colour = stroke.colour;
            let of_colour = item.filter(|(before, _)| *before == colour).map(|(_, number)| number);
            let number = of_colour.unwrap_or_else(|| {
                let ink = Ink::Plain(colour.unwrap_or(Colour::BLACK));
                self.item(Region::default(), ink, usvg::Opacity::ONE, &stroke, around)
            });
            item = Some((colour, number));
            self.scene.marks.push(Mark { kind: MarkKind::Middle, item: number, stroke });
        }
        self.check_count()
    }

    fn path(&mut self, path: &usvg::Path, around: &Around) -> Result<(), FormatError> {
        if !path.is_visible() {
            return Ok(());
        }
        let entity = around.entity.clone().or_else(|| self.names.entity(&around.place, path.id()));
        let around = &Around { entity, ..around.clone() };
        self.paths += 1;
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
        path: &usvg::Path,
        fill: Option<&usvg::Fill>,
        is_drawn: bool,
        around: &Around,
    ) -> Result<(), FormatError> {
        let Some(fill) = fill else { return Ok(()) };
        let outlines = lines(path, affine(path.abs_transform()), true).paths;
        outlines.iter().try_for_each(|outline| self.check(outline))?;
        let region = filled(&outlines, fill.rule(), self.view.tolerance());
        self.told.patterns += usize::from(matches!(fill.paint(), usvg::Paint::Pattern(_)));
        let looks = looks(StrokeKind::Outline, None, fill.paint(), around);
        let item = self.item(region, ink_of(fill.paint()), fill.opacity(), &looks, around);
        for outline in outlines.into_iter().filter(|_| is_drawn) {
            self.count(&outline);
            let mark = Mark { kind: MarkKind::Edge, item, stroke: looks.along(outline) };
            if item == 0
                && self.paper.is_none()
                && is_paper(&self.scene.items[0], &mark.stroke.path, self.view.page)
            {
                self.paper = Some(mark);
            } else {
                self.scene.marks.push(mark);
            }
        }
        self.check_count()
    }

    fn stroke(
        &mut self,
        path: &usvg::Path,
        stroke: Option<&usvg::Stroke>,
        around: &Around,
    ) -> Result<(), FormatError> {
        let Some(stroke) = stroke else { return Ok(()) };
        let at = affine(path.abs_transform());
        let pen = f64::from(stroke.width().get()) * scale(at);
        let found = lines(path, at, false);
        found.paths.iter().try_for_each(|line| self.check(line))?;
        let dashes = Dashes::of(stroke, scale(at)).filter(|_| self.dashes);
        let dashes = dashes.filter(|dashes| self.may_dash(dashes, &found.paths));
        let is_dashed = dashes.is_some();
        let mut drawn = match dashes {
            Some(_) if !is_similar(at) => dashed_askew(path, stroke, at),
            Some(dashes) => found.paths.iter().flat_map(|line| dashes.along(line)).collect(),
            None => found.paths,
        };
        let is_dotted = stroke.linecap() != usvg::LineCap::Butt;
        let dots = found.dots.into_iter().filter(|&p| is_dotted && is_sound(p));
        drawn.extend(dots.map(|p| dot(p, pen)));
        let region = match self.bands {
            true => band(path, stroke, at, self.view.tolerance(), is_dashed),
            false => Region::default(),
        };
        self.told.patterns += usize::from(matches!(stroke.paint(), usvg::Paint::Pattern(_)));
        let looks = looks(StrokeKind::Centreline, Some(pen), stroke.paint(), around);
        let item = self.item(region, ink_of(stroke.paint()), stroke.opacity(), &looks, around);
        for line in drawn {
            self.count(&line);
            self.scene.marks.push(Mark { kind: MarkKind::Middle, item, stroke: looks.along(line) });
        }
        self.check_count()
    }

    fn may_dash(&mut self, dashes: &Dashes, paths: &[Path]) -> bool {
        let count = paths.iter().map(|path| dashes.count(path)).fold(0, usize::saturating_add);
        let fits = self.dashed.saturating_add(count) <= MAX_DASHES;
        self.dashed += if fits { count } else { 0 };
        self.told.undashed += usize::from(!fits);
        fits
    }

    fn item(
        &mut self,
        region: Region,
        ink: Ink,
        opacity: usvg::Opacity,
        looks: &Stroke,
        around: &Around,
    ) -> Number {
        self.scene.items.push(Item {
            region,
            ink: if around.is_mixed { Ink::Mixed { hides: false } } else { ink },
            opacity: f64::from(opacity.get()),
            veil: around.veil,
            gate: around.gate,
            pen: looks.pen,
            source: self.paths,
            looks: looks.clone(),
        });
        (self.scene.items.len() - 1) as Number
    }

    fn cut(&mut self, gate: Number, path: Path) -> Result<(), FormatError> {
        self.check(&path)?;
        self.count(&path);
        self.scene.marks.push(Mark { kind: MarkKind::Cut(gate), item: 0, stroke: Stroke::new(path) });
        self.check_count()
    }

    fn leave_out(&mut self, reason: Reason, path: &Path) {
        self.unseen.push((reason, path.length(self.view.tolerance())));
    }

    fn count(&mut self, path: &Path) {
        self.elements += path.elements().len().max(LEAST_ELEMENTS);
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

    fn check(&self, path: &Path) -> Result<(), FormatError> {
        match controls(path).find(|&p| !is_sound(p)) {
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

/// Whether lengths grow alike in all directions.
fn is_similar(at: Affine) -> bool {
    let [a, b, c, d, ..] = at.as_coeffs();
    let size = a.abs().max(b.abs()).max(c.abs()).max(d.abs());
    let is_turn = (a - d).abs().max((b + c).abs()) <= 1e-4 * size;
    let is_flip = (a + d).abs().max((b - c).abs()) <= 1e-4 * size;
    is_turn || is_flip
}

/// Dashes measured in the path's own numbers, for lengths on the sheet depend on the direction.
fn dashed_askew(path: &usvg::Path, stroke: &usvg::Stroke, at: Affine) -> Vec<Path> {
    let Some(dashes) = Dashes::of(stroke, 1.0) else { return Vec::new() };
    own_lines(path).iter().flat_map(|line| dashes.along(line)).map(|dash| moved(&dash, at)).collect()
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
