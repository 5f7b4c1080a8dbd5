//! Which sides, with the picture's borders, make the sheet.

use tracelight_stroke::{Point, Vec2};

use super::shade::Shade;
use super::sides::{self, Side};
use super::{Small, inward, steps};
use crate::outline::area;
use crate::plane::Plane;
use crate::ridge::middle;

/// Least of a side that is seen; a finger, a shadow or another sheet hides the rest.
const LEAST_SEEN: f64 = 0.5;
/// A shorter part of a side in a shadow is not looked at, px.
const LEAST_IN_SHADE: usize = 5;
/// A side is at least this share of the picture's.
const LEAST_SIDE: f64 = 0.2;
/// Least share of the picture that is sheet.
const LEAST_AREA: f64 = 0.12;
/// The same where it is darker than what lies beside it.
const LEAST_AREA_IN_LIGHT: f64 = 0.25;
/// A corner is at least this far from straight and from folded, as a sine.
const LEAST_SINE: f64 = 0.6;
/// Paper is so even from one side of the sheet to another, as a ratio: in a shadow it keeps this much.
const EVEN: std::ops::Range<f64> = 0.42..2.4;
/// The same of a sheet that is darker than what lies beside it and not seen on all sides: else it may be a filled shape.
const EVEN_IN_LIGHT: std::ops::Range<f64> = 0.75..1.33;
/// A darker sheet has at least this share of the brightness beside it: less is ink.
const LEAST_SHADE: f64 = 0.5;
/// Of the blocks beside a sheet most have less than this share of the fine contrast of those on it; else there is
/// drawing on both sides. Sheets seen on two sides only, and those darker than what lies beside them, are believed only
/// then; others if there is nothing better, on a table of wood.
const CALMER: f64 = 0.4;
/// Share of the blocks that are below what counts as their contrast.
const MOST_BLOCKS: f64 = 0.97;
/// Of all blocks this share has no more than noise.
const NOISE_BLOCKS: f64 = 0.2;
/// Pixels of such a block, either way.
const BLOCK: usize = 8;
/// Levels differ from this share on.
const STEP: f64 = 0.06;
/// Least share of the sides along which paper ends for good: a finger and another sheet below hide the rest.
const LEAST_FIRM: f64 = 0.6;
/// The same with places at which a dark line tells the edge of a sheet on another: so much without them.
const LEAST_FIRM_BY_LINES: f64 = 0.3;
/// Of a sheet seen on three sides, and of one that is darker than what lies beside it and seen on all.
const LEAST_FIRM_OF_THREE: f64 = 0.7;
/// Of what lies in a shadow across the sheet.
const LEAST_FIRM_IN_SHADE: f64 = 0.8;
/// Of a sheet seen on two sides or one, and of one that is darker than what lies beside it and seen on three.
const LEAST_FIRM_OF_TWO: f64 = 0.85;
/// What a shadow on the paper lets through of the light: a step of that size on a single side may be its edge.
const SHADE: std::ops::Range<f64> = 0.42..0.88;
/// Most of as bright beside the sheet, as a share of the sheet: other sheets.
const MOST_OUTSIDE: f64 = 0.4;
/// A calm table beside it does not make a sheet likelier than one of which more is seen by this factor.
const RIVAL: f64 = 0.75;
/// So many of the likeliest are looked at.
const LOOKED_AT: usize = 24;
/// A level is the paper's again within this share, and half of the step; the paper goes on if it is on this share of the way.
const SAME: f64 = 0.1;
const LEAST_BACK: f64 = 0.25;
/// So far out of the sheet, and into it, px.
const FAR: f64 = 40.0;
const FAR_INSIDE: f64 = 40.0;
/// A side so near to the picture's border all along is none, px.
const AT_BORDER: f64 = 2.5;
/// A line along the picture's border is narrower than this share of its shorter side, and as wide everywhere within so
/// many px, and as a share.
const FRAME: f64 = 0.05;
const SAME_WIDTH_PX: f64 = 1.0;
const SAME_WIDTH: f64 = 0.15;
/// Levels beside a side are taken so far from it, px.
const BESIDE: f64 = 4.0;

/// A sheet in the small picture.
#[derive(Clone, Debug)]
pub(super) struct Quad {
    /// Left, top, right, bottom; `None` where it runs out of the picture.
    pub(super) sides: [Option<Side>; 4],
    /// Upper left, upper right, lower right, lower left, px.
    pub(super) corners: [Point; 4],
    /// Whether it is brighter than what lies beside it.
    pub(super) is_brighter: bool,
    /// What falls across it.
    shade: Option<Shade>,
}

/// Of left, top, right and bottom: its number.
pub(super) const SIDES: [usize; 4] = [0, 1, 2, 3];

/// Whether a side is the left or the right one.
const fn is_upright(side: usize) -> bool {
    matches!(side, 0 | 2)
}

impl Quad {
    /// All of a picture.
    pub(super) fn all(plane: &Plane<u8>) -> Self {
        Self { sides: Default::default(), corners: corners(plane, [None; 4]), is_brighter: true, shade: None }
    }

    /// Between corners that someone gives; `None` where they are no quadrilateral.
    pub(super) fn between(corners: [Point; 4]) -> Option<Self> {
        let turns = |k: usize| {
            let [a, b, c] = [k, k + 1, k + 2].map(|k| corners[k % 4]);
            (b - a).cross(c - b) > 0.0
        };
        let quad = Self { sides: Default::default(), corners, is_brighter: true, shade: None };
        (0..4).all(turns).then_some(quad)
    }

    /// The ends of a side, clockwise.
    pub(super) const fn ends(&self, side: usize) -> (Point, Point) {
        ends(&self.corners, side)
    }

    /// The way into the sheet, square to a side.
    pub(super) fn inward(&self, side: usize) -> Vec2 {
        let (from, to) = self.ends(side);
        inward(from, to)
    }

    /// How far inside a point lies, px; negative outside.
    pub(super) fn depths(&self) -> impl Fn(Point) -> f64 + use<> {
        let sides = SIDES.map(|side| (self.ends(side).0, self.inward(side)));
        move |at| sides.iter().map(|(from, inward)| (at - *from).dot(*inward)).fold(f64::INFINITY, f64::min)
    }

    fn seen(&self) -> usize {
        self.sides.iter().flatten().count()
    }

    /// Whether its sides are seen both in a shadow and beside it.
    fn goes_on_in(&self, shade: &Shade, plane: &Plane<u8>) -> bool {
        let (width, height) = (plane.width as f64 - BESIDE, plane.height as f64 - BESIDE);
        let may_be_seen = |p: Point| (BESIDE..width).contains(&p.x) && (BESIDE..height).contains(&p.y);
        SIDES.into_iter().filter_map(|k| Some((k, self.sides[k].as_ref()?))).all(|(k, side)| {
            let (from, to) = self.ends(k);
            let row = |p: Point| if is_upright(k) { p.y } else { p.x }.max(0.0) as usize;
            let (first, last) = (row(from).min(row(to)), row(from).max(row(to)));
            // in the light, and in the shadow
            let (mut all, mut seen) = ([0, 0], [0, 0]);
            for row in first..last {
                let at = side.place(is_upright(k), row as f64 + 0.5);
                if may_be_seen(at) {
                    let dark = usize::from(shade.is_dark(at));
                    all[dark] += 1;
                    seen[dark] += side.seen(row..row + 1) + side.lines(row..row + 1);
                }
            }
            let is_seen = |(all, seen)| all < LEAST_IN_SHADE || seen as f64 > LEAST_SEEN * all as f64;
            all.into_iter().zip(seen).all(is_seen)
        })
    }

    /// What a level would be without the shadow across it.
    pub(super) fn lit(&self, at: Point, level: f64) -> f64 {
        self.shade.as_ref().map_or(level, |shade| shade.lit(at, level))
    }
}

/// The sheet with most of its sides seen.
pub(super) fn best(small: &Small) -> Option<Quad> {
    let plane = &small.levels;
    let across = plane.transposed();
    let (rows, columns) = (steps::of_rows(plane), steps::of_rows(&across));
    let of = |rows, plane: &Plane<u8>, rises| {
        let mut sides = sides::of(rows, plane.width, rises);
        sides.iter_mut().for_each(|side| side.look_for_lines(plane));
        sides
    };
    let kinds = |rises| (of(&rows, plane, rises), of(&columns, &across, rises));
    let (rising, falling) = (kinds(true), kinds(false));
    // of a sheet that is brighter than what lies beside it, left, top, right and bottom
    let brighter: [&[Side]; 4] = [&rising.0, &rising.1, &falling.0, &falling.1];
    let darker: [&[Side]; 4] = [&falling.0, &falling.1, &rising.0, &rising.1];
    if brighter.iter().all(|sides| sides.is_empty()) {
        return None;
    }
    let shades: Vec<Shade> = [(&rising.0, true), (&falling.0, true), (&rising.1, false), (&falling.1, false)]
        .into_iter()
        .flat_map(|(sides, is_upright)| {
            sides.iter().filter_map(move |side| Shade::of(small.calm(), side, is_upright))
        })
        .collect();
    let mut found: Vec<(f64, Quad)> = Vec::new();
    for (sides, is_brighter) in [(brighter, true), (darker, false)] {
        let mut likely = candidates(plane, sides, is_brighter);
        likely.sort_by(|a, b| b.0.total_cmp(&a.0));
        found.extend(likely.into_iter().take(LOOKED_AT).map(|(score, numbers)| {
            let chosen = picked(sides, numbers);
            let corners = corners(plane, chosen);
            let mut quad =
                Quad { sides: chosen.map(|side| side.cloned()), corners, is_brighter, shade: None };
            // of a shadow's edge that falls across it as much is told by it as by a side
            let depth = quad.depths();
            let across = shades.iter().filter_map(|shade| Some((shade.across(&depth, plane)?, shade)));
            let across = across.filter(|(_, shade)| quad.goes_on_in(shade, plane));
            let most = across.max_by(|a, b| a.0.total_cmp(&b.0));
            quad.shade = most.map(|(_, shade)| shade.clone());
            (score + most.map_or(0.0, |(seen, _)| seen), quad)
        }));
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
    let calm = Calm::of(small);
    let mut instead: Option<(f64, Quad)> = None;
    for (score, quad) in found.into_iter().take(LOOKED_AT) {
        match calm.judged(&quad) {
            Some(true) => {
                let is_clear = instead.as_ref().is_none_or(|(most, _)| score > RIVAL * most);
                return Some(instead.map(|(_, quad)| quad).filter(|_| !is_clear).unwrap_or(quad));
            }
            Some(false) if instead.is_none() && quad.is_brighter && quad.seen() > 2 => {
                instead = Some((score, quad));
            }
            _ => {}
        }
    }
    instead.map(|(_, quad)| quad)
}

/// Four sides by their numbers among those of their kind, and how much of them is seen.
type Likely = (f64, [Option<usize>; 4]);

/// All that the sides may make.
fn candidates(plane: &Plane<u8>, sides: [&[Side]; 4], is_brighter: bool) -> Vec<Likely> {
    let all = sides.map(|sides| (0..sides.len()).map(Some).chain([None]));
    let mut found = Vec::new();
    for left in all[0].clone() {
        for right in all[2].clone() {
            for top in all[1].clone() {
                for bottom in all[3].clone() {
                    let numbers = [left, top, right, bottom];
                    let chosen = picked(sides, numbers);
                    found.extend(score(plane, chosen, is_brighter).map(|score| (score, numbers)));
                }
            }
        }
    }
    found
}

fn picked(sides: [&[Side]; 4], numbers: [Option<usize>; 4]) -> [Option<&Side>; 4] {
    std::array::from_fn(|k| numbers[k].and_then(|n| sides[k].get(n)))
}

/// Where the picture ends on the left, at the top, on the right and at the bottom.
const fn borders(plane: &Plane<u8>) -> [f64; 4] {
    [0.0, 0.0, plane.width as f64, plane.height as f64]
}

/// Where sides and the picture's borders meet: upper left, upper right, lower right, lower left.
fn corners(plane: &Plane<u8>, sides: [Option<&Side>; 4]) -> [Point; 4] {
    let border = borders(plane);
    let line = |k: usize| sides[k].map_or((border[k], 0.0), |side| (side.at, side.slope));
    // x = a + b y meets y = c + d x
    let meet = |upright: usize, level: usize| {
        let ((a, b), (c, d)) = (line(upright), line(level));
        let x = (a + b * c) / (1.0 - b * d);
        Point::new(x, c + d * x)
    };
    [meet(0, 1), meet(2, 1), meet(2, 3), meet(0, 3)]
}

/// How much of the sides is seen, less what is not, px; `None` where they are no sheet's.
fn score(plane: &Plane<u8>, sides: [Option<&Side>; 4], is_brighter: bool) -> Option<f64> {
    let corners = corners(plane, sides);
    let lies_right = corners[0].x < corners[1].x && corners[0].y < corners[3].y;
    let least_area = if is_brighter { LEAST_AREA } else { LEAST_AREA_IN_LIGHT };
    let pixels = (plane.width * plane.height) as f64;
    if !lies_right || !is_convex(&corners) || area(&corners) < least_area * pixels {
        return None;
    }
    let mut score = 0.0;
    for (k, side) in sides.iter().enumerate() {
        let Some(side) = side else { continue };
        let (from, to) = ends(&corners, k);
        let ([a, b], most) =
            if is_upright(k) { ([from.y, to.y], plane.height) } else { ([from.x, to.x], plane.width) };
        let [first, last] = [a.min(b), a.max(b)].map(|end| end.round().clamp(0.0, most as f64) as usize);
        // a line along the border, or what is left over there
        let [a, b] = off_border(plane, &corners, k);
        if a.max(b) < AT_BORDER {
            return None;
        }
        let (all, steps, lines) = (last - first, side.seen(first..last), side.lines(first..last));
        if ((steps + lines) as f64) < LEAST_SEEN * all as f64 || (all as f64) < LEAST_SIDE * most as f64 {
            return None;
        }
        // a shadow's edge, or the table's, goes on behind the corners
        let beyond = side.seen(0..most) - steps;
        score += side.score(first..last) - beyond as f64;
    }
    (score > 0.0).then_some(score)
}

/// The ends of a side, clockwise.
const fn ends(corners: &[Point; 4], side: usize) -> (Point, Point) {
    let [upper_left, upper_right, lower_right, lower_left] = *corners;
    match side {
        0 => (lower_left, upper_left),
        1 => (upper_left, upper_right),
        2 => (upper_right, lower_right),
        _ => (lower_right, lower_left),
    }
}

/// How far the two ends of a side are from the picture's border on that side, px.
fn off_border(plane: &Plane<u8>, corners: &[Point; 4], side: usize) -> [f64; 2] {
    let (from, to) = ends(corners, side);
    let border = borders(plane)[side];
    [from, to].map(|p| (if is_upright(side) { p.x } else { p.y } - border).abs())
}

/// Whether they turn one way, none of them nearly straight or folded.
fn is_convex(corners: &[Point; 4]) -> bool {
    (0..4).all(|k| {
        let [a, b, c] = [k, k + 1, k + 2].map(|k| corners[k % 4]);
        let (one, next) = (b - a, c - b);
        one.cross(next) > LEAST_SINE * one.hypot() * next.hypot() && one.hypot() > 1.0
    })
}

/// The small picture, and what it is without lines.
struct Calm<'a> {
    calm: &'a Plane<u8>,
    /// The middle of each block, its level without lines there, and how far its pixels differ from what they are without
    /// lines, where they differ most.
    blocks: Vec<(Point, u8, f64)>,
}

/// What is seen along the sides of a quadrilateral.
struct Evidence {
    /// Usual level just inside each side.
    inner: [Option<f64>; 4],
    /// Usual level just outside.
    beyond: f64,
    /// Share of the sides at which the level differs on both sides, and does not come back further out, or a dark line is.
    firm: f64,
    /// Whether what falls across it does so: it is seen in it as well as elsewhere.
    is_shadow: bool,
}

impl<'a> Calm<'a> {
    fn of(small: &'a Small) -> Self {
        let (picture, calm) = (&small.levels, small.calm());
        let mut blocks = Vec::new();
        for top in (0..calm.height).step_by(BLOCK) {
            for left in (0..calm.width).step_by(BLOCK) {
                let (bottom, right) = ((top + BLOCK).min(calm.height), (left + BLOCK).min(calm.width));
                let row = |y: usize| {
                    let pixels = picture.row(y)[left..right].iter().zip(&calm.row(y)[left..right]);
                    pixels.map(|(level, calm)| f64::from(level.abs_diff(*calm)))
                };
                let at = Point::new(0.5 * (left + right) as f64, 0.5 * (top + bottom) as f64);
                let level = calm.row((top + bottom) / 2)[(left + right) / 2];
                let fine = strong((top..bottom).flat_map(row).collect(), 0.9);
                blocks.extend(fine.map(|fine| (at, level, fine)));
            }
        }
        Self { calm, blocks }
    }

    /// Whether a quadrilateral may be a sheet, and whether there is far less to be seen beside it than on it.
    fn judged(&self, quad: &Quad) -> Option<bool> {
        let Evidence { inner, beyond, firm, is_shadow } = self.beside(quad)?;
        let paper = middle(inner.iter().flatten().copied().collect())?;
        let is_even = inner.iter().flatten().all(|level| EVEN.contains(&(level / paper)));
        let is_ink = !quad.is_brighter && paper < LEAST_SHADE * beyond;
        let least_firm = match quad.seen() {
            4 if quad.is_brighter => LEAST_FIRM,
            4 => LEAST_FIRM_OF_THREE,
            3 if quad.is_brighter => LEAST_FIRM_OF_THREE,
            _ => LEAST_FIRM_OF_TWO,
        };
        let may_be_shadow = quad.seen() < 2 && SHADE.contains(&(beyond.min(paper) / beyond.max(paper)));
        let is_sheet = is_even
            && !may_be_shadow
            && !self.is_framed(quad)
            && !is_ink
            && firm >= least_firm
            && is_shadow
            && self.is_paper(quad, paper);
        is_sheet.then(|| self.is_calmer_outside(quad, paper))
    }

    /// Whether there is nothing beside it but a line along the picture's border, as wide everywhere.
    fn is_framed(&self, quad: &Quad) -> bool {
        let seen = SIDES.into_iter().filter(|&side| quad.sides[side].is_some());
        let widths: Vec<f64> = seen.flat_map(|side| off_border(self.calm, &quad.corners, side)).collect();
        let least = widths.iter().copied().fold(f64::INFINITY, f64::min);
        let most = widths.iter().copied().fold(0.0, f64::max);
        let shorter = self.calm.width.min(self.calm.height) as f64;
        most < FRAME * shorter && most - least < SAME_WIDTH_PX + SAME_WIDTH * most
    }

    /// What is seen along its sides; `None` where all of them are at the picture's border.
    fn beside(&self, quad: &Quad) -> Option<Evidence> {
        let mut inner: [Option<f64>; 4] = Default::default();
        let (mut outer, mut firm, mut lines) = (Vec::new(), 0, 0);
        let (mut in_shade, mut firm_in_shade) = (0, 0);
        for (k, side) in quad.sides.iter().enumerate() {
            let Some(side) = side else { continue };
            let (from, to) = quad.ends(k);
            let inward = quad.inward(k);
            let mut levels = Vec::new();
            for i in 1..40 {
                let at = from.lerp(to, f64::from(i) / 40.0);
                let (inside, outside) = (at + inward * BESIDE, at - inward * BESIDE);
                let (Some(paper), Some(beside)) = (self.level(inside), self.level(outside)) else { continue };
                outer.push(beside);
                let differs =
                    (paper > beside) == quad.is_brighter && (paper - beside).abs() > STEP * paper.max(beside);
                let (paper, table) = (quad.lit(inside, paper), quad.lit(outside, beside));
                levels.push(paper);
                // on neither side it is soon as on the other again, else it is a line
                let is_line = || {
                    self.comes_back(quad, (outside, -inward, FAR), paper)
                        || self.comes_back(quad, (inside, inward, FAR_INSIDE), table)
                };
                let is_firm = differs && !is_line();
                let row = if is_upright(k) { at.y } else { at.x }.max(0.0) as usize;
                let is_line = !is_firm && side.is_line_at(row);
                firm += usize::from(is_firm);
                lines += usize::from(is_line);
                if quad.shade.as_ref().is_some_and(|shade| shade.is_dark(at)) {
                    in_shade += 1;
                    firm_in_shade += i32::from(is_firm || is_line);
                }
            }
            inner[k] = middle(levels);
        }
        let share = |places: usize| places as f64 / outer.len().max(1) as f64;
        // a line alone is a frame that someone drew, or a rule
        let by_lines = share(firm) > LEAST_FIRM_BY_LINES && quad.seen() > 2;
        let firm = share(firm + if by_lines { lines } else { 0 });
        let is_shadow = f64::from(firm_in_shade) >= LEAST_FIRM_IN_SHADE * f64::from(in_shade);
        Some(Evidence { inner, beyond: middle(outer)?, firm, is_shadow })
    }

    /// Whether much of what lies on a way, with its length in px, is as bright again as on the other side of its beginning.
    fn comes_back(&self, quad: &Quad, (from, way, far): (Point, Vec2, f64), paper: f64) -> bool {
        let on = (0..(0.5 * far) as usize).map(|k| from + way * (2.0 * k as f64));
        let lit: Vec<f64> = on.map_while(|at| Some(quad.lit(at, self.level(at)?))).collect();
        let step = lit.first().map_or(0.0, |beside| (paper - beside).abs());
        let same = (SAME * paper).min(0.5 * step);
        let back = lit.iter().filter(|level| (**level - paper).abs() < same).count();
        back as f64 > LEAST_BACK * lit.len() as f64
    }

    /// Whether most of what it holds is paper, and hardly any of what it does not.
    fn is_paper(&self, quad: &Quad, paper: f64) -> bool {
        let like_paper = if quad.is_brighter || quad.seen() == 4 { EVEN } else { EVEN_IN_LIGHT };
        let (mut inside, mut like, mut like_outside) = (0_usize, 0_usize, 0_usize);
        let depth = quad.depths();
        for (at, level, _) in &self.blocks {
            let ratio = quad.lit(*at, f64::from(*level)) / paper;
            match depth(*at) > 0.0 {
                true => {
                    inside += 1;
                    like += usize::from(like_paper.contains(&ratio));
                }
                false => like_outside += usize::from((ratio - 1.0).abs() < SAME),
            }
        }
        2 * like > inside && (like_outside as f64) < MOST_OUTSIDE * inside as f64
    }

    /// Whether there is far less to be seen beside the sheet than on it, block by block.
    fn is_calmer_outside(&self, quad: &Quad, paper: f64) -> bool {
        let (mut inside, mut outside) = (Vec::new(), Vec::new());
        let depth = quad.depths();
        for (at, _, fine) in &self.blocks {
            match depth(*at) {
                depth if depth > BLOCK as f64 => inside.push(*fine),
                depth if depth < -(BLOCK as f64) => outside.push(*fine),
                _ => {}
            }
        }
        // noise is the same everywhere, and a corner of the table is no drawing
        let noise = strong(self.blocks.iter().map(|block| block.2).collect(), NOISE_BLOCKS).unwrap_or(0.0);
        match (strong(inside, MOST_BLOCKS), strong(outside, MOST_BLOCKS)) {
            (Some(inside), Some(outside)) => {
                (outside - noise).max(0.0) < CALMER * (inside - noise).max(STEP * paper)
            }
            _ => true,
        }
    }

    fn level(&self, at: Point) -> Option<f64> {
        self.calm.holds(at).then(|| f64::from(self.calm.row(at.y as usize)[at.x as usize]))
    }
}

/// What a share of some values stays below; `None` of fewer than ten.
fn strong(mut values: Vec<f64>, share: f64) -> Option<f64> {
    let at = (share * values.len() as f64) as usize;
    (values.len() >= 10).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}
