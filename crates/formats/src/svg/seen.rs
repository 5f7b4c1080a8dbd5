//! What of a drawing is seen: lines without those that something hides.
//!
//! A [`Scene`] is regions in the order in which they are painted, and lines (marks) that could be drawn of them. Each line
//! is divided where it meets the edge of a region, for only there can change what is seen of it. In between it is looked
//! at once, from a small distance on both sides: what is painted there, from the top down to the first thing that hides
//! the rest. The edge of a fill is seen if the colours on its sides differ and no fill above ends there too; the middle
//! of a pen's band if nothing covers it and it has another colour than what lies around it, and where its middle is not
//! drawn, a side of the band is as the edge of a fill. So covered lines, seams
//! inside one colour, white on white and fills without area all fall out of one rule.

mod colour;
mod coverage;
mod crossings;
mod flat;
pub(super) mod gradient;
mod grid;
mod judged;
mod middles;
mod picture;
mod region;
pub(super) mod scene;
mod tiles;
mod verdict;

use std::borrow::Cow;
use std::collections::BTreeMap;

use tracelight_stroke::{Path, Point, Rect, Stroke, StrokeKind};

use self::crossings::Edges;
use self::judged::{Judged, judged};
use self::middles::{Middle, Middles};
use self::picture::{Picture, is_cover};
use self::scene::{Gate, GateKind, Ink, Mark, MarkKind, Number, Scene};
use self::tiles::{Ground, Layout, laid_out};
use self::verdict::{Judge, Verdict};

pub(super) use self::colour::Rgb;
pub(super) use self::flat::chords;
pub(super) use self::region::Region;
pub(super) use self::verdict::Reason;

/// Whether an ink is white or nearly so.
pub(super) fn is_whitish(ink: &Ink) -> bool {
    matches!(ink, Ink::Plain(colour) if Rgb::from(*colour).is_whitish())
}

/// How a scene is looked at.
#[derive(Clone, Copy)]
pub(super) struct View {
    /// The page.
    pub(super) page: Rect,
    /// Whether what is painted hides what is below.
    pub(super) hides: bool,
    /// Whether what lies off the page is cut.
    pub(super) crops: bool,
    /// Edges and segments looked at, at most; see [`work_of`].
    pub(super) work: usize,
}

/// What is seen, and what is not.
pub(super) struct Seen {
    pub(super) strokes: Vec<Stroke>,
    /// For each line not or not wholly seen, why and how much.
    pub(super) unseen: Vec<(Reason, f64)>,
    /// Lines that were not looked at because too much lies on the way.
    pub(super) unjudged: usize,
    /// Everything is as white as the paper, and therefore was looked at on a black one.
    pub(super) on_black: bool,
}

/// Edges and segments looked at, at most: of any file, for each of its bytes, and of the largest. A small file that is
/// made to take long takes about a second and a half; what somebody drew takes some tens for a byte.
const OWN_WORK: usize = 10_000_000;
const WORK_A_BYTE: usize = 30;
const MAX_WORK: usize = 60_000_000;

/// Bytes that a letter counts as: so many would draw its outline.
const BYTES_A_LETTER: usize = 50;

/// How much may be looked at of a file of so many bytes and letters.
pub(super) fn work_of(bytes: usize, letters: usize) -> usize {
    let bytes = bytes.saturating_add(letters.saturating_mul(BYTES_A_LETTER));
    bytes.saturating_mul(WORK_A_BYTE).saturating_add(OWN_WORK).min(MAX_WORK)
}

/// Distance from which lines are looked at, as a share of the page's diagonal, and at most, px.
const ASIDE: f64 = 1e-4;
const MOST_ASIDE: f64 = 0.1;

/// Below this share of the page's diagonal lies the noise of the single precision in which paths are resolved.
const NOISE: f64 = 1e-6;

impl View {
    /// Distance from which lines are looked at.
    fn aside(&self) -> f64 {
        let diagonal = (self.page.size().to_vec2()).hypot();
        (ASIDE * diagonal).min(MOST_ASIDE).max(NOISE * diagonal)
    }

    /// How closely chords follow curves.
    pub(super) fn tolerance(&self) -> f64 {
        0.45 * self.aside()
    }
}

/// Looks at a scene.
pub(super) fn seen(scene: &Scene, view: View) -> Seen {
    let on_white = look(scene, view, Rgb::WHITE);
    let is_blank =
        on_white.strokes.is_empty() && on_white.unseen.iter().any(|(reason, _)| *reason == Reason::OneColour);
    if !is_blank {
        return on_white;
    }
    let on_black = look(scene, view, Rgb::BLACK);
    if on_black.strokes.is_empty() { on_white } else { Seen { on_black: true, ..on_black } }
}

fn look(scene: &Scene, view: View, paper: Rgb) -> Seen {
    let aside = view.aside();
    let margin = 8.0 * aside + 0.01 * (view.page.width() + view.page.height());
    let boxes = scene.items.iter().map(|item| item.shape.bounds());
    let all = boxes.fold(view.page, |all, bounds| if view.crops { all } else { all.union(bounds) });
    let within = all.inflate(margin, margin);
    let mut seen = Seen { strokes: Vec::new(), unseen: Vec::new(), unjudged: 0, on_black: false };
    let covers = |item: Number| view.hides && is_cover(&scene.items[item as usize]);
    // an edge within the distance from which lines are looked at changes what is seen there: where it ends, it must be met
    let ground = Ground { page: view.page, within, slack: 1.05 * aside };
    let Some(Layout { tiles, regions, edges }) = laid_out(scene, ground, covers) else {
        scene.marks.iter().for_each(|&mark| seen.leave(scene, mark));
        return seen;
    };
    let mut picture = Picture::new(scene, view.page, view.hides, (tiles, regions));
    picture.paper = paper;
    let step = if has_gradients(scene) { STEP * view.page.size().to_vec2().hypot() } else { f64::INFINITY };
    let judge = Judge { picture: &picture, aside, crops: view.crops, step, middles: None };
    let mut looking =
        Looking { scene, view, edges, judge, seen, work: 0, middles: Vec::new(), halves: Vec::new() };
    scene.marks.iter().for_each(|&mark| looking.mark(mark));
    if !looking.halves.is_empty() {
        looking.sides(within);
    }
    looking.seen
}

/// A scene being looked at.
struct Looking<'a> {
    scene: &'a Scene<'a>,
    view: View,
    edges: Edges,
    judge: Judge<'a>,
    seen: Seen,
    work: usize,
    /// What is drawn of the middles of bands.
    middles: Vec<Middle>,
    /// Bands whose middle is not drawn everywhere.
    halves: Vec<Number>,
}

impl Looking<'_> {
    fn mark(&mut self, mark: Mark) {
        let (scene, tolerance) = (self.scene, self.view.tolerance());
        if !matches!(mark.kind, MarkKind::Cut(_)) && self.judge.picture.is_unseen(mark.item) {
            return self.seen.hide(&self.judge, mark, tolerance);
        }
        for path in &*lines_of(scene, mark) {
            let Some(judged) = self.judged(mark, path, tolerance) else {
                self.seen.leave_line(scene, mark, path);
                continue;
            };
            if mark.kind == MarkKind::Middle {
                self.note_band(mark.item, &judged);
            }
            self.seen.unseen.extend(judged.unseen);
            let looks = |item: Number| &scene.items[item as usize].looks;
            self.seen.strokes.extend(judged.seen.into_iter().map(|(path, item)| looks(item).along(path)));
        }
    }

    fn judged(&mut self, mark: Mark, path: &Path, tolerance: f64) -> Option<Judged> {
        let left = self.view.work.saturating_sub(self.work);
        if left == 0 {
            return None;
        }
        let judged = judged(&self.judge, &self.edges, (mark, path), tolerance, left);
        self.work = judged.as_ref().map_or(self.view.work, |judged| self.work + judged.work);
        judged
    }

    /// Remembers which middles are drawn, and whose band may be seen where its middle is not.
    fn note_band(&mut self, number: Number, judged: &Judged) {
        let item = &self.scene.items[number as usize];
        let Some(pen) = item.pen.filter(|_| self.judge.has_sides(item)) else { return };
        let (tolerance, source) = (self.view.tolerance(), item.source);
        let long = judged.seen.iter().filter(|(path, _)| path.length(tolerance) >= LEAST_MIDDLE * pen);
        self.middles.extend(long.map(|(path, _)| Middle { path: path.clone(), pen, source }));
        if !judged.unseen.is_empty() && self.halves.last() != Some(&number) {
            self.halves.push(number);
        }
    }

    /// Whether a piece of a band's side is only what is left beside another line that crosses the band.
    fn is_scrap(&self, number: Number, side: &Path) -> bool {
        let (item, tolerance) = (&self.scene.items[number as usize], self.view.tolerance());
        let Some(pen) = item.pen.filter(|pen| side.length(tolerance) < SCRAP * pen) else { return false };
        let corners = chords(side, tolerance);
        let ends = corners.first().zip(corners.last()).map(|(first, last)| [first.point, last.point]);
        let Some([first, last]) = ends.filter(|[first, last]| first != last) else { return false };
        let crosses = |p: Point| {
            self.judge
                .middles
                .as_ref()
                .is_some_and(|middles| middles.cross(p, last - first, (pen, item.source)))
        };
        [first, last].into_iter().any(crosses)
    }

    /// Draws the sides of bands where they are seen and no middle stands for them.
    fn sides(&mut self, within: Rect) {
        let middles = std::mem::take(&mut self.middles);
        self.judge.middles = Middles::new(&middles, within, self.view.tolerance());
        if self.judge.middles.is_none() {
            return;
        }
        let halves = std::mem::take(&mut self.halves);
        // the pen's own fill is painted just before it, or just after
        let items = &self.scene.items;
        let own = |&number: &Number| {
            let source = items[number as usize].source;
            let near = [number.wrapping_sub(1), number, number + 1].into_iter();
            near.filter(move |&one| items.get(one as usize).is_some_and(|item| item.source == source))
        };
        let all: Vec<Number> = halves.iter().flat_map(own).collect();
        all.into_iter().for_each(|number| self.sides_of(number));
    }

    fn sides_of(&mut self, number: Number) {
        let item = &self.scene.items[number as usize];
        if self.judge.picture.is_unseen(number) {
            return;
        }
        let sides = item.shape.sides();
        for path in &sides.paths {
            let mark = Mark { kind: MarkKind::Side, item: number };
            let seen = self.judged(mark, path, sides.tolerance).map(|judged| judged.seen);
            let paths = seen.into_iter().flatten().map(|(path, _)| path);
            let side = |path| Stroke { kind: StrokeKind::Outline, pen: None, ..item.looks.along(path) };
            let drawn: Vec<Stroke> = paths.filter(|path| !self.is_scrap(number, path)).map(side).collect();
            self.seen.strokes.extend(drawn);
        }
    }
}

/// Rests of a middle shorter than so many widths of its band do not stand for its sides.
const LEAST_MIDDLE: f64 = 0.5;

/// Where another line crosses at a slant, shorter sides than so many widths of a band are left over.
const SCRAP: f64 = 1.25;

/// How far a line is followed before it is looked at again where colours change without an edge, as a share of the page's
/// diagonal.
const STEP: f64 = 0.004;

fn has_gradients(scene: &Scene) -> bool {
    let is_one = |ink: &Ink| matches!(ink, Ink::Gradient(_));
    let in_mask = |gate: &Gate| match &gate.kind {
        GateKind::Mask { lights, .. } => lights.iter().any(|light| is_one(&light.ink)),
        _ => false,
    };
    scene.items.iter().any(|item| is_one(&item.ink)) || scene.gates.iter().any(in_mask)
}

fn lines_of<'a>(scene: &'a Scene, mark: Mark) -> Cow<'a, [Path]> {
    match mark.kind {
        MarkKind::Cut(gate) => Cow::Borrowed(&scene.gates[gate as usize].outlines),
        _ => Cow::Owned(scene.items[mark.item as usize].shape.lines()),
    }
}

impl Seen {
    /// Lines that are drawn without being looked at.
    fn leave(&mut self, scene: &Scene, mark: Mark) {
        lines_of(scene, mark).iter().for_each(|path| self.leave_line(scene, mark, path));
    }

    fn leave_line(&mut self, scene: &Scene, mark: Mark, path: &Path) {
        if !matches!(mark.kind, MarkKind::Cut(_)) {
            self.unjudged += 1;
            self.strokes.push(scene.items[mark.item as usize].looks.along(path.clone()));
        }
    }

    /// Lines of an item of which nothing is seen anywhere.
    fn hide(&mut self, judge: &Judge, mark: Mark, tolerance: f64) {
        for path in &*lines_of(judge.picture.scene, mark) {
            let mut lengths = BTreeMap::new();
            for piece in path.pieces() {
                if let Verdict::Unseen(Some(reason)) = judge.hidden(mark, piece.at(0.5)) {
                    *lengths.entry(reason).or_insert(0.0) += piece.length(tolerance);
                }
            }
            self.unseen.extend(lengths);
        }
    }
}
