//! Detects areas filled to and fro with a broad pen, with slits of paper between the passes.
//!
//! Each way is a line by its width, and nobody means them. Where ways lie so close that less than half a pen's width of paper
//! shows between them, and many of them do, the area is what was drawn: its slits are ink. Hatching leaves more paper than that.
//!
//! Where no line tells how wide the pen is (`slits`), a hole of a filled shape is such a slit if it is narrow and leads through it.

use tracelight_image::median::median;
use tracelight_image::{Mask, Region, long_axis, pinholes, regions};
use tracelight_maths::powi;
use tracelight_stroke::{Point, Vec2};

/// Widest slit, pen widths; of slanted ones half as much more.
const SLIT_PENS: f64 = 0.5;
/// Of a narrower pen, px, a single pixel of paper may be what parts two lines.
const LEAST_PX: f64 = 4.0;
/// Such an area holds a regular octagon of so many pens: four ways at least lie beside each other.
const ACROSS_PENS: f64 = 4.5;
/// So much of it is ink, and so much at least is slits; what is larger than a square of so many pens may have a single slit, with
/// ink all round.
const INK_SHARE: f64 = 0.76;
const LEAST_SLITS: f64 = 0.04;
const BROAD_PENS: f64 = 6.5;
/// A hand that goes to and fro meets its last way here and there: this share of the ink hangs together. Lines side by side do not.
const TOGETHER: f64 = 0.5;
/// An area goes beyond the octagons in it by so many pens.
const RIM_PENS: f64 = 0.5;

/// The ink with the slits of such areas; `None` where there are none. `pen` is the usual width of its lines, px; 0 where that is not
/// known.
pub(crate) fn filled(ink: &Mask, pen: f64) -> Option<Mask> {
    if pen < LEAST_PX {
        return None;
    }
    let slit = (SLIT_PENS * pen).round() as usize;
    let mut closed = ink.clone().closed(slit + 1);
    closed.add(ink);
    let slits = closed.clone().without(ink);
    if slits.is_empty() {
        return None;
    }
    let mut areas = closed.clone().opened((ACROSS_PENS * pen).ceil() as usize);
    if areas.is_empty() {
        return None;
    }
    let mut broad = areas.clone();
    let found = regions(&areas);
    let inked = Inked::of(&found, regions(&areas.clone().and(ink)));
    for (area, (all, largest)) in found.iter().zip(inked.0) {
        let share = all as f64 / area.area() as f64;
        let is_filled = largest as f64 >= TOGETHER * all as f64 && share >= INK_SHARE;
        if !is_filled || share > 1.0 - LEAST_SLITS {
            area.erase_from(&mut areas);
        }
        if !is_filled || (area.area() as f64) < powi(BROAD_PENS * pen, 2) {
            area.erase_from(&mut broad);
        }
    }
    let mut filled = areas.dilated_by((RIM_PENS * pen).ceil() as usize).and(&closed);
    if !broad.is_empty() {
        let is_single = |slit: &&Region| slit.cells(&broad).next().is_some() && is_enclosed(slit, &closed);
        regions(&slits).iter().filter(is_single).for_each(|slit| slit.fill_into(&mut filled));
    }
    filled.add(ink);
    (filled.count() > ink.count()).then_some(filled)
}

/// Of a shape by itself a slit is so many times as long as wide, and about as wide all along; beside another one that leads the same way,
/// within this angle, rad, the shorter one.
const SLIT_LONG: f64 = 5.0;
const SLIT_STRAIGHT: f64 = 2.0;
const SLIT_SHORT: f64 = 2.5;
const SLIT_ALIKE: f64 = 0.2;
/// Smallest share of the shape's length that a slit spans.
const THROUGH: f64 = 0.5;
/// Largest width of a slit, as a share of the shape's and in px.
const SLIT_ACROSS: f64 = 0.12;
const SLIT_PX: f64 = 2.5;
/// Smallest width of the ink on either side, in slit widths: one pass of the pen.
const WAY_SLITS: f64 = 1.5;
/// A hole is no slit that is larger than this share of the picture.
const LARGEST: usize = 50;

/// The slits in what was filled with a pen that no line tells of: they lead from side to side of a shape, all but its rim, and are
/// narrow. A key's hole is short, and the slot of a letter's counter as wide as its strokes.
pub(crate) fn slits(shapes: &Mask) -> Vec<Region> {
    let holes = pinholes(shapes, shapes.width() * shapes.height() / LARGEST);
    let mut solid = shapes.clone();
    holes.iter().for_each(|hole| hole.fill_into(&mut solid));
    let long = holes.into_iter().filter_map(|hole| Some((Slit::of(&hole)?, hole)));
    let narrow = long.filter(|(slit, _)| slit.is_between_ways(shapes, &solid));
    let (sure, short): (Vec<_>, Vec<_>) = narrow.partition(|(slit, _)| slit.leads_through(&solid));
    let is_beside = |slit: &Slit| sure.iter().any(|(other, _)| slit.is_beside(other, &solid));
    let short: Vec<Region> = short.into_iter().filter(|(s, _)| is_beside(s)).map(|(_, hole)| hole).collect();
    sure.into_iter().map(|(_, hole)| hole).chain(short).collect()
}

/// A long, narrow hole.
struct Slit {
    middle: Point,
    /// Along it.
    way: Vec2,
    length: f64,
    width: f64,
}

/// How far one gets in a mask from a place, px.
fn run(mask: &Mask, from: Point, way: Vec2) -> f64 {
    let is_in = |k: &usize| {
        let at = from + way * *k as f64;
        mask.get(at.x.floor() as isize, at.y.floor() as isize)
    };
    (0..).take_while(is_in).count() as f64
}

impl Slit {
    /// A hole that is one.
    fn of(hole: &Region) -> Option<Self> {
        let area = hole.area() as f64;
        let (middle, variances) = hole.moments(|_, _| 1.0);
        let way = long_axis(variances);
        let extent = |way: Vec2| {
            let at = |(x, y): (usize, usize)| Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let along = hole.places().map(|place| (at(place) - middle).dot(way));
            let (from, to) = along.fold((0.0_f64, 0.0_f64), |(from, to), v| (from.min(v), to.max(v)));
            to - from + 1.0
        };
        let (length, across) = (extent(way), extent(way.turn_90()));
        let width = area / length;
        let is_slit = length >= SLIT_SHORT * width && across <= SLIT_STRAIGHT * width + 2.0;
        is_slit.then_some(Self { middle, way, length, width })
    }

    /// How wide a mask is through its middle, px.
    fn through(&self, mask: &Mask, way: Vec2) -> f64 {
        run(mask, self.middle, way) + run(mask, self.middle, -way)
    }

    /// Whether it is narrow, and a way of the pen lies on either side: `solid` are the shapes without their holes.
    fn is_between_ways(&self, shapes: &Mask, solid: &Mask) -> bool {
        let aside = self.way.turn_90();
        let ways = |side: Vec2| {
            let beside = (1..=9).map(|k| self.middle + self.way * (self.length * (0.1 * f64::from(k) - 0.5)));
            let ways = beside.map(|p| run(shapes, p + side * (0.5 * self.width + 1.0), side));
            median(&ways.collect::<Vec<_>>()) >= WAY_SLITS * self.width
        };
        self.width <= (SLIT_ACROSS * self.through(solid, aside)).max(SLIT_PX) && ways(aside) && ways(-aside)
    }

    /// Whether it leads from one side of its shape to the other.
    fn leads_through(&self, solid: &Mask) -> bool {
        self.length >= SLIT_LONG * self.width && self.length >= THROUGH * self.through(solid, self.way)
    }

    /// Whether it leads the same way as another one in the same shape.
    fn is_beside(&self, other: &Self, solid: &Mask) -> bool {
        let between = other.middle - self.middle;
        self.way.cross(other.way).abs() <= SLIT_ALIKE
            && run(solid, self.middle, between.normalize()) >= between.hypot()
    }
}

/// Whether a slit has nothing but ink round it: `closed` is all ink and all slits.
fn is_enclosed(slit: &Region, closed: &Mask) -> bool {
    slit.runs.iter().all(|run| {
        let (y, from, to) = (run.y as isize, run.from as isize, run.to as isize);
        (y - 1..=y + 1).all(|y| (from - 1..=to).all(|x| closed.get(x, y)))
    })
}

/// Of each area the pixels of ink in it, and those of the largest piece that hangs together there.
struct Inked(Vec<(usize, usize)>);

impl Inked {
    /// `pieces` are all the ink of the areas.
    fn of(areas: &[Region], pieces: Vec<Region>) -> Self {
        let numbered = areas.iter().enumerate();
        let mut runs: Vec<(u32, u32, usize)> =
            numbered.flat_map(|(k, area)| area.runs.iter().map(move |run| (run.y, run.from, k))).collect();
        runs.sort_unstable();
        let mut inked = vec![(0, 0); areas.len()];
        for piece in pieces {
            let Some(first) = piece.runs.first() else { continue };
            // the run that it begins in
            let behind = runs.partition_point(|&(y, from, _)| (y, from) <= (first.y, first.from));
            if let Some(&(.., area)) = behind.checked_sub(1).and_then(|k| runs.get(k)) {
                let (all, largest): &mut (usize, usize) = &mut inked[area];
                *all += piece.area();
                *largest = (*largest).max(piece.area());
            }
        }
        Self(inked)
    }
}
