//! Whether a quadrilateral is a sheet: by the levels along its sides, and what is to be seen on it and beside it.

use tracelight_image::Plane;
use tracelight_image::median::middle;
use tracelight_stroke::{Point, Vec2};

use crate::quad::{Quad, SIDES, is_upright, off_border};
use crate::rim::are_as_wide;
use crate::shadow::SHADE;
use crate::small::{BESIDE, Small};

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
/// A table's grain is seen in nearly all blocks beside the sheet, and is at most so many times what this share of them has; in as many blocks
/// just within the sheet's edge, so many blocks wide, there is less.
const GRAIN_BLOCKS: f64 = 0.25;
const MOST_GRAIN: f64 = 3.0;
const EDGE_BLOCKS: f64 = 3.0;
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
/// Least of a sheet that is like its paper.
const LEAST_PAPER: f64 = 0.67;
/// Most of as bright beside the sheet, as a share of the sheet: other sheets.
const MOST_OUTSIDE: f64 = 0.4;
/// A level is the paper's again within this share, and half of the step; the paper goes on if it is on this share of the way.
const SAME: f64 = 0.1;
const LEAST_BACK: f64 = 0.25;
/// So many px are looked at, every other one, out of the sheet and into it.
const FAR: usize = 40;
/// A line along the picture's border is narrower than this share of its shorter side and so many px.
const FRAME: f64 = 0.05;
const FRAME_PX: f64 = 2.0;
/// Its level is below this share of a shadow's.
const LINE_DARKER: f64 = 0.7;

/// The small picture, and what it is without lines.
pub(crate) struct Calm<'a> {
    calm: &'a Plane<u8>,
    /// The middle of each block, its level without lines there, and how far its pixels differ from what they are without
    /// lines, where they differ most.
    blocks: Vec<(Point, u8, f64)>,
    /// How far they differ where there is nothing but noise.
    noise: f64,
}

/// What is seen along the sides of a quadrilateral.
struct Evidence {
    /// Usual level just inside each side.
    inner: [Option<f64>; 4],
    /// The same just outside each.
    outer: [Option<f64>; 4],
    /// And outside all of them.
    beyond: f64,
    /// Share of the sides at which the level differs on both sides, and does not come back further out, or a dark line is.
    firm: f64,
    /// Whether what falls across it does so: it is seen in it as well as elsewhere.
    is_shadow: bool,
    /// The sides that are steps of brightness, not dark lines.
    steps: Vec<usize>,
}

impl<'a> Calm<'a> {
    pub(crate) fn of(small: &'a Small) -> Self {
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
        let noise = strong(blocks.iter().map(|block| block.2).collect(), NOISE_BLOCKS).unwrap_or(0.0);
        Self { calm, blocks, noise }
    }

    /// Whether a quadrilateral may be a sheet, and whether there is far less to be seen beside it than on it.
    pub(crate) fn judged(&self, quad: &Quad) -> Option<bool> {
        let Evidence { inner, outer, beyond, firm, is_shadow, steps } = self.beside(quad)?;
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
            && !self.is_framed(quad, &inner, &outer)
            && !is_ink
            && firm >= least_firm
            && is_shadow
            && self.is_paper(quad, paper);
        let is_calmer = is_sheet && self.is_calmer_outside(quad, paper);
        // rules or a frame, and a shadow's edge, beyond which the drawing goes on
        let is_in_shade = |&side: &usize| {
            either_side(&inner, &outer, side).is_some_and(|(dark, bright)| SHADE.contains(&(dark / bright)))
        };
        let goes_on = !is_calmer && steps.len() < 2 && steps.iter().all(is_in_shade);
        (is_sheet && !goes_on).then_some(is_calmer)
    }

    /// Whether there is nothing beside it but a line along the picture's border, as wide everywhere, and on the other sides what is no
    /// darker than in a shadow that falls on what it frames: on one of them, or on all where the line is darker than that. A table is
    /// as dark on all sides.
    fn is_framed(&self, quad: &Quad, inner: &[Option<f64>; 4], outer: &[Option<f64>; 4]) -> bool {
        let most = FRAME * self.calm.width.min(self.calm.height) as f64 + FRAME_PX;
        let width = |side: usize| off_border(self.calm, &quad.corners, side);
        let seen = SIDES.into_iter().filter(|&side| quad.sides[side].is_some());
        let (frame, rest): (Vec<usize>, Vec<usize>) =
            seen.partition(|&side| width(side).into_iter().all(|width| width < most));
        let is_even = are_as_wide(frame.iter().flat_map(|&side| width(side)));
        let darkest = frame.iter().filter_map(|&side| outer[side]).fold(f64::INFINITY, f64::min);
        let is_shadow = |&side: &usize| {
            let is_alone = rest.len() == 1 && frame.len() > 1;
            either_side(inner, outer, side).is_some_and(|(dark, bright)| {
                dark > SHADE.start * bright && (is_alone || darkest < LINE_DARKER * dark)
            })
        };
        is_even && !frame.is_empty() && rest.iter().all(is_shadow)
    }

    /// What is seen along its sides; `None` where all of them are at the picture's border.
    fn beside(&self, quad: &Quad) -> Option<Evidence> {
        let (mut inner, mut outer): ([Option<f64>; 4], [Option<f64>; 4]) = Default::default();
        let (mut all, mut firm, mut lines) = (Vec::new(), 0, 0);
        let (mut in_shade, mut firm_in_shade) = (0, 0);
        let mut steps = Vec::new();
        for (k, side) in quad.sides.iter().enumerate() {
            let Some(side) = side else { continue };
            let (from, to) = quad.ends(k);
            let inward = quad.inward(k);
            let (mut levels, first) = (Vec::new(), all.len());
            let (firm_before, lines_before) = (firm, lines);
            for i in 1..40 {
                let at = from.lerp(to, f64::from(i) / 40.0);
                let (inside, outside) = (at + inward * BESIDE, at - inward * BESIDE);
                let (Some(paper), Some(beside)) = (self.level(inside), self.level(outside)) else { continue };
                all.push(beside);
                let differs =
                    (paper > beside) == quad.is_brighter && (paper - beside).abs() > STEP * paper.max(beside);
                let (paper, table) = (quad.lit(inside, paper), quad.lit(outside, beside));
                levels.push(paper);
                // on neither side it is soon as on the other again, else it is a line
                let is_line = || {
                    self.comes_back(quad, outside, -inward, paper)
                        || self.comes_back(quad, inside, inward, table)
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
            (inner[k], outer[k]) = (middle(levels), middle(all[first..].to_vec()));
            if firm - firm_before > lines - lines_before {
                steps.push(k);
            }
        }
        let share = |places: usize| places as f64 / all.len().max(1) as f64;
        // a line alone is a frame that someone drew, or a rule
        let by_lines = share(firm) > LEAST_FIRM_BY_LINES && quad.seen() > 2;
        let firm = share(firm + if by_lines { lines } else { 0 });
        let is_shadow = f64::from(firm_in_shade) >= LEAST_FIRM_IN_SHADE * f64::from(in_shade);
        Some(Evidence { inner, outer, beyond: middle(all)?, firm, is_shadow, steps })
    }

    /// Whether much of what lies on a way is as bright again as on the other side of its beginning: brighter than a sheet that is brighter
    /// than what lies beside it nothing is there either.
    fn comes_back(&self, quad: &Quad, from: Point, way: Vec2, paper: f64) -> bool {
        let on = (0..FAR).step_by(2).map(|k| from + way * k as f64);
        let lit: Vec<f64> = on.map_while(|at| Some(quad.lit(at, self.level(at)?))).collect();
        let step = lit.first().map_or(0.0, |beside| paper - beside);
        let same = (SAME * paper).min(0.5 * step.abs());
        let is_bright = quad.is_brighter && step > 0.0;
        let is_back = |level: &&f64| (paper - **level).abs() < same || is_bright && **level > paper;
        let back = lit.iter().filter(is_back).count();
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
        like as f64 > LEAST_PAPER * inside as f64 && (like_outside as f64) < MOST_OUTSIDE * inside as f64
    }

    /// Whether there is far less to be seen beside the sheet than on it, block by block.
    fn is_calmer_outside(&self, quad: &Quad, paper: f64) -> bool {
        let (mut inside, mut outside, mut at_edge) = (Vec::new(), Vec::new(), Vec::new());
        let (depth, block) = (quad.depths(), BLOCK as f64);
        for (at, _, fine) in &self.blocks {
            match depth(*at) {
                depth if depth > block => {
                    inside.push(*fine);
                    at_edge.extend((depth < EDGE_BLOCKS * block).then_some(*fine));
                }
                depth if depth < -block => outside.push(*fine),
                _ => {}
            }
        }
        // noise is the same everywhere, a table's grain all over the table, and a corner of the table is no drawing
        let noise = self.noise;
        let grain = strong(outside.clone(), GRAIN_BLOCKS);
        let at_edge = strong(at_edge, 1.0 - GRAIN_BLOCKS);
        let grain = grain.zip(at_edge).filter(|(grain, paper)| paper < grain);
        let grain = grain.map_or(0.0, |(grain, _)| MOST_GRAIN * grain);
        match (strong(inside, MOST_BLOCKS), strong(outside, MOST_BLOCKS)) {
            (Some(inside), Some(outside)) => {
                outside - noise.max(grain) < CALMER * (inside - noise).max(STEP * paper)
            }
            _ => true,
        }
    }

    fn level(&self, at: Point) -> Option<f64> {
        self.calm.holds(at).then(|| f64::from(self.calm.row(at.y as usize)[at.x as usize]))
    }
}

/// The darker and the brighter level on either side of a side.
fn either_side(inner: &[Option<f64>; 4], outer: &[Option<f64>; 4], side: usize) -> Option<(f64, f64)> {
    inner[side].zip(outer[side]).map(|(inside, outside)| (inside.min(outside), inside.max(outside)))
}

/// What a share of some values stays below; `None` of fewer than ten.
fn strong(mut values: Vec<f64>, share: f64) -> Option<f64> {
    let at = (share * values.len() as f64) as usize;
    (values.len() >= 10).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}
