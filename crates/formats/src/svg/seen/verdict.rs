//! Whether a line is seen at one of its places, and if not, why.

use tracelight_stroke::{Point, Vec2};

use super::colour::Rgb;
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

/// Bands wider than so many times a line are areas that it lies on.
const WIDE: f64 = 4.0;

/// Looks at a line from a small distance on both sides.
pub(crate) struct Judge<'a> {
    pub(crate) picture: &'a Picture<'a>,
    /// Distance from the line, in the drawing's unit.
    pub(crate) aside: f64,
    /// Whether what lies off the page and outside clip paths is cut.
    pub(crate) crops: bool,
    /// How far a line is followed, at most, before it is looked at again.
    pub(crate) step: f64,
}

impl Judge<'_> {
    pub(crate) fn verdict(&self, mark: Mark, place: Place) -> Verdict {
        let sides = self.sides(place);
        let is_off = sides.map(|p| self.crops && !is_within(self.picture.page, p));
        match mark.kind {
            MarkKind::Cut(_) if is_off[0] || is_off[1] => Verdict::Unseen(None),
            MarkKind::Cut(gate) => self.cut(gate, sides),
            _ if is_off[0] && is_off[1] => Verdict::Unseen(Some(Reason::OffPage)),
            MarkKind::Edge => self.edge(mark.item, sides),
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

    fn sides(&self, place: Place) -> [Point; 2] {
        [-1.0, 1.0].map(|side| place.point + place.normal * (side * self.aside))
    }

    /// Why nothing of a line is seen at a place where something surely covers it, or no gate lets it pass.
    pub(crate) fn hidden(&self, mark: Mark, p: Point) -> Verdict {
        let gate = self.item(mark.item).gate.map(|gate| &self.picture.scene.gates[gate as usize]);
        Verdict::Unseen(match mark.kind {
            MarkKind::Cut(_) => None,
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
        let reason = if self.picture.look(&left, sides[0]).is_like(&self.picture.look(&right, sides[1])) {
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

    /// The topmost fill that is on one side only.
    fn topmost_edge(&self, stacks: [&[Layer]; 2]) -> Option<Number> {
        let lacks = |stack: &[Layer], number| !stack.iter().any(|layer| layer.item == number);
        let alone = |mine: &[Layer], other: &[Layer]| {
            let mut fills = mine.iter().filter(|layer| self.item(layer.item).pen.is_none());
            fills.find(|layer| lacks(other, layer.item)).map(|layer| layer.item)
        };
        alone(stacks[0], stacks[1]).max(alone(stacks[1], stacks[0]))
    }

    /// The edge of a gate is that of what it cuts, the topmost of all that end here.
    fn cut(&self, gate: Number, sides: [Point; 2]) -> Verdict {
        let stacks = sides.map(|p| self.picture.stack(p, |_, _| true));
        let is_same = self.picture.hides
            && self.picture.look(&stacks[0], sides[0]).is_like(&self.picture.look(&stacks[1], sides[1]));
        let edge = self.topmost_edge([&stacks[0], &stacks[1]]).filter(|_| !is_same);
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
        beside.into_iter().all(has_its_colour) && !self.is_cased(number, (place, reach), ink)
    }

    /// Whether another colour shows on both sides of a line, and a wider line below runs along with it: one that crosses does not.
    fn is_cased(&self, number: Number, (place, reach): (Place, f64), ink: Rgb) -> bool {
        let beside = |at: Point| [-1.0, 1.0].map(|side| at + place.normal * (side * reach));
        let differs = |p: Point| {
            let seen = self.picture.stack(p, |other, _| other != number);
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
