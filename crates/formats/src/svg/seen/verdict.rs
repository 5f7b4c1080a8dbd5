//! Whether a line is seen at one of its places, and if not, why.

use tracelight_stroke::{Point, Vec2};

use super::colour::Rgb;
use super::middles::{Middles, WIDE};
use super::picture::{FAINT, Layer, Picture, is_within};
use super::scene::{Gate, GateKind, Ink, Item, Mark, MarkKind, Number};

/// Why something is not drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Reason {
    /// Paper: a white rectangle behind everything.
    Paper,
    /// Opacity 0.
    Invisible,
    /// The edge of a fill that has no area.
    NoArea,
    /// Outside the page.
    OffPage,
    /// Outside a clip path.
    Clipped,
    /// In the dark of a mask.
    Masked,
    /// Below something opaque.
    Covered,
    /// One colour on both sides.
    OneColour,
    /// The edge of something painted above runs here too.
    Again,
}

/// What is to become of a line at one of its places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// Seen, with the looks of that item.
    Seen(Number),
    /// Not seen; of a clip's edge without a reason, for it is nothing painted.
    Unseen(Option<Reason>),
}

/// A place on a line.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) point: Point,
    /// Unit normal.
    pub(crate) normal: Vec2,
}

/// Bands narrower than so many times the distance from which lines are looked at are lines.
const LEAST_BAND: f64 = 10.0;

/// Looks at a line from a small distance on both sides.
pub(crate) struct Judge<'a> {
    pub(crate) picture: &'a Picture<'a>,
    /// Distance from the line, in the drawing's unit.
    pub(crate) aside: f64,
    /// Whether what lies off the page and outside clip paths is cut.
    pub(crate) crops: bool,
    /// How far a line is followed, at most, before it is looked at again.
    pub(crate) step: f64,
    /// Lines that stand for the sides of bands.
    pub(crate) middles: Option<Middles>,
}

impl Judge<'_> {
    pub(crate) fn verdict(&self, mark: Mark, place: Place) -> Verdict {
        let sides = self.sides(place);
        let is_off = sides.map(|p| self.crops && !is_within(self.picture.page, p));
        match mark.kind {
            MarkKind::Cut(_) if is_off[0] || is_off[1] => Verdict::Unseen(None),
            MarkKind::Cut(gate) => self.cut(gate, sides),
            MarkKind::Side if is_off[0] || is_off[1] => Verdict::Unseen(None),
            _ if is_off[0] && is_off[1] => Verdict::Unseen(Some(Reason::OffPage)),
            MarkKind::Edge => self.edge(mark.item, sides),
            MarkKind::Side => self.side(mark.item, place.point, sides),
            MarkKind::Middle => self.middle(mark, place, sides),
        }
    }

    /// What surely covers a line at one of its places.
    pub(crate) fn cover(&self, mark: Mark, place: Place) -> Option<Number> {
        match mark.kind {
            MarkKind::Cut(_) => None,
            _ => self.picture.cover(mark.item, self.sides(place)),
        }
    }

    /// How far a line is followed before it is looked at again: whether a middle stands for a side changes without an edge.
    pub(crate) fn step_of(&self, mark: Mark) -> f64 {
        const OF_PEN: f64 = 0.125;
        match mark.kind {
            MarkKind::Side => self.own_pen(mark.item).map_or(self.step, |pen| self.step.min(OF_PEN * pen)),
            _ => self.step,
        }
    }

    fn sides(&self, place: Place) -> [Point; 2] {
        [-1.0, 1.0].map(|side| place.point + place.normal * (side * self.aside))
    }

    /// Why nothing of a line is seen at a place where something surely covers it, or no gate lets it pass.
    pub(crate) fn hidden(&self, mark: Mark, p: Point) -> Verdict {
        let gate = self.item(mark.item).gate.map(|gate| &self.picture.scene.gates[gate as usize]);
        Verdict::Unseen(match mark.kind {
            MarkKind::Cut(_) | MarkKind::Side => None,
            _ if self.crops && !is_within(self.picture.page, p) => Some(Reason::OffPage),
            _ => Some(gate.filter(|gate| !is_within(gate.bounds, p)).map_or(Reason::Covered, shut_by)),
        })
    }

    fn item(&self, number: Number) -> &Item<'_> {
        &self.picture.scene.items[number as usize]
    }

    /// Why gates shut an item out on both sides; `None` if on one they do not.
    fn shut(&self, item: &Item, sides: [Point; 2]) -> Option<Reason> {
        let [left, right] = sides.map(|p| self.picture.shut(item.gate, p));
        let gate = left.filter(|_| right.is_some())?;
        Some(shut_by(&self.picture.scene.gates[gate as usize]))
    }

    fn edge(&self, number: Number, sides: [Point; 2]) -> Verdict {
        let item = self.item(number);
        if let Some(reason) = self.shut(item, sides) {
            return Verdict::Unseen(Some(reason));
        }
        if !self.picture.hides {
            return Verdict::Seen(number);
        }
        let [left, right] = sides.map(|p| self.picture.stack(p, |_, _| true));
        let holds = |layers: &[Layer]| layers.iter().any(|layer| layer.item == number);
        let is_there = [holds(&left), holds(&right)];
        let reason = if self.are_alike([&left, &right], sides) {
            match is_there {
                [false, false] if sides.iter().all(|&p| !self.picture.is_inside(number, p)) => Reason::NoArea,
                [false, false] => Reason::Covered,
                _ => Reason::OneColour,
            }
        } else if self.topmost_edge([&left, &right]) == Some(number) {
            return Verdict::Seen(number);
        } else if is_there[0] == is_there[1] {
            if is_there[0] { Reason::OneColour } else { Reason::Covered }
        } else {
            Reason::Again
        };
        Verdict::Unseen(Some(reason))
    }

    /// Whether nobody can tell what lies on both sides apart.
    fn are_alike(&self, stacks: [&[Layer]; 2], sides: [Point; 2]) -> bool {
        let [left, right] = [0, 1].map(|i| self.picture.look(stacks[i], sides[i]));
        left.is_like(&right)
    }

    /// The topmost fill that is on one side only.
    fn topmost_edge(&self, stacks: [&[Layer]; 2]) -> Option<Number> {
        self.topmost(stacks, |item| item.pen.is_none())
    }

    /// The topmost that is on one side only, of the items that count.
    fn topmost(&self, stacks: [&[Layer]; 2], counts: impl Fn(&Item) -> bool) -> Option<Number> {
        let lacks = |stack: &[Layer], number| !stack.iter().any(|layer| layer.item == number);
        let alone = |mine: &[Layer], other: &[Layer]| {
            let mut counted = mine.iter().filter(|layer| counts(self.item(layer.item)));
            counted.find(|layer| lacks(other, layer.item)).map(|layer| layer.item)
        };
        alone(stacks[0], stacks[1]).max(alone(stacks[1], stacks[0]))
    }

    /// The side of a band is drawn where it is seen and no line stands for it, nor for the band that it cuts.
    fn side(&self, number: Number, p: Point, sides: [Point; 2]) -> Verdict {
        if self.has_middle(number, p) {
            return Verdict::Unseen(None);
        }
        let stacks = sides.map(|p| self.picture.stack(p, |_, _| true));
        let both = [stacks[0].as_slice(), stacks[1].as_slice()];
        let is_seen = !self.are_alike(both, sides) && self.topmost(both, |_| true) == Some(number);
        let cuts_line =
            || stacks.iter().flatten().any(|layer| layer.item != number && self.has_middle(layer.item, p));
        if is_seen && !cuts_line() { Verdict::Seen(number) } else { Verdict::Unseen(None) }
    }

    /// Whether a short chord of a line is surely nothing to look at: a drawn line stands for both its ends.
    pub(crate) fn is_stood_for(&self, mark: Mark, chord: [Point; 2]) -> bool {
        mark.kind == MarkKind::Side
            && chord[0].distance(chord[1]) <= 2.0 * self.step_of(mark)
            && chord.into_iter().all(|p| self.has_middle(mark.item, p))
    }

    /// Whether a drawn line stands for the side of an item's band.
    fn has_middle(&self, number: Number, p: Point) -> bool {
        self.middles.as_ref().zip(self.own_pen(number)).is_some_and(|(middles, pen)| {
            let (stands, work) = middles.stand_for(p, pen, self.item(number).source);
            self.picture.add_work(work);
            stands
        })
    }

    /// Width of an item's band; of a fill, of the pen that goes along its edge, which is painted just before it or just after.
    fn own_pen(&self, number: Number) -> Option<f64> {
        let item = self.item(number);
        let beside = [number.wrapping_sub(1), number + 1].into_iter();
        let items = beside.filter_map(|one| self.picture.scene.items.get(one as usize));
        let pen = || items.filter(|other| other.source == item.source).find_map(|other| other.pen);
        item.pen.or_else(pen)
    }

    /// The edge of a gate is that of what it cuts, the topmost of all that end here.
    fn cut(&self, gate: Number, sides: [Point; 2]) -> Verdict {
        let stacks = sides.map(|p| self.picture.stack(p, |_, _| true));
        let both = [stacks[0].as_slice(), stacks[1].as_slice()];
        let is_same = self.picture.hides && self.are_alike(both, sides);
        let edge = self.topmost_edge(both).filter(|_| !is_same);
        let is_cut = |&number: &Number| {
            let item = self.item(number);
            let shut = sides.into_iter().find_map(|p| self.picture.shut(item.gate, p));
            shut == Some(gate) && sides.iter().all(|&p| self.picture.is_inside(number, p))
        };
        edge.filter(is_cut).map_or(Verdict::Unseen(None), Verdict::Seen)
    }

    fn middle(&self, mark: Mark, place: Place, sides: [Point; 2]) -> Verdict {
        let item = self.item(mark.item);
        if let Some(reason) = self.shut(item, sides) {
            return Verdict::Unseen(Some(reason));
        }
        if !self.picture.hides {
            return Verdict::Seen(mark.item);
        }
        if matches!(&item.ink, Ink::Gradient(gradient) if gradient.at(place.point).1 <= FAINT) {
            return Verdict::Unseen(Some(Reason::Invisible));
        }
        let hides = |cover: &Item| self.is_area(item, cover) || cover.ink != item.ink;
        let is_hidden = |p: Point| {
            self.picture.gate(item.gate, p) <= FAINT
                || self.picture.is_covered(mark.item, p, |cover| cover.source != item.source && hides(cover))
        };
        if sides.into_iter().all(is_hidden) {
            return Verdict::Unseen(Some(Reason::Covered));
        }
        if self.is_lost(mark.item, place, sides) {
            return Verdict::Unseen(Some(Reason::OneColour));
        }
        Verdict::Seen(mark.item)
    }

    /// Whether an item is an area for a line, not another line.
    fn is_area(&self, line: &Item, item: &Item) -> bool {
        item.pen.is_none_or(|pen| pen > WIDE * line.pen.unwrap_or(0.0))
    }

    /// Whether an item is a band wide enough to be more than a line, so that its sides may be drawn.
    pub(crate) fn has_sides(&self, item: &Item) -> bool {
        item.pen.is_some_and(|pen| self.picture.hides && pen >= LEAST_BAND * self.aside)
    }

    /// Whether a line has the colour of what is below it and of what is beside it.
    fn is_lost(&self, number: Number, place: Place, sides: [Point; 2]) -> bool {
        let item = self.item(number);
        let ink = match &item.ink {
            Ink::Plain(ink) => Rgb::from(*ink),
            Ink::Gradient(gradient) => gradient.at(place.point).0,
            Ink::Mixed { .. } => return false,
        };
        let below = |p: Point| self.picture.stack(p, |other, i| other < number && self.is_area(item, i));
        if !sides.into_iter().all(|p| self.picture.look(&below(p), p).is_plain(ink)) {
            return false;
        }
        let reach = 0.5 * item.pen.unwrap_or(0.0) + self.aside;
        let beside = [-1.0, 1.0].map(|side| place.point + place.normal * (side * reach));
        let around = |p: Point| self.picture.stack(p, |other, i| other != number && self.is_area(item, i));
        let has_its_colour = |p: Point| self.picture.look(&around(p), p).is_plain(ink);
        // of a wide one that shows on one side only, that side is drawn
        let is_lost = match self.has_sides(item) {
            true => beside.into_iter().any(has_its_colour),
            false => beside.into_iter().all(has_its_colour),
        };
        is_lost && !self.is_cased(number, (place, reach), ink)
    }

    /// Whether another colour shows on both sides of a line, and a wider line below runs along with it: one that crosses does not.
    fn is_cased(&self, number: Number, (place, reach): (Place, f64), ink: Rgb) -> bool {
        let beside = |at: Point| [-1.0, 1.0].map(|side| at + place.normal * (side * reach));
        // another line like it that crosses here does not interrupt it
        let is_like = |i: &Item| {
            i.pen.is_some() && i.ink == self.item(number).ink && !self.is_area(self.item(number), i)
        };
        let differs = |p: Point| {
            let seen = self.picture.stack(p, |other, i| other != number && !is_like(i));
            !self.picture.look(&seen, p).is_plain(ink)
        };
        let sides = beside(place.point);
        if !sides.into_iter().all(differs) {
            return false;
        }
        let own = self.item(number).pen.unwrap_or(0.0);
        let along = Vec2::new(place.normal.y, -place.normal.x);
        let runs_along = |&wider: &Number| {
            let pen = self.item(wider).pen.filter(|&pen| wider < number && pen > own);
            pen.is_some_and(|pen| {
                let holds = |at: Point| beside(at).into_iter().all(|p| self.picture.is_inside(wider, p));
                holds(place.point) && [-pen, pen].into_iter().any(|way| holds(place.point + along * way))
            })
        };
        self.picture.items_at(sides[0]).any(|wider| runs_along(&wider))
    }
}

const fn shut_by(gate: &Gate) -> Reason {
    match gate.kind {
        GateKind::Clip(_) => Reason::Clipped,
        _ => Reason::Masked,
    }
}
