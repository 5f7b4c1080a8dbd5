//! A narrow wedge of table, or of a scanner's lid, along the picture's border.
//!
//! A frame drawn along the border looks alike, but is as wide at one end as at the other, and not as bright as what lies
//! beside the sheet elsewhere.

use tracelight_stroke::Point;

use super::edge::straight;
use super::inward;
use crate::plane::Plane;
use crate::ridge::middle;

/// Places along a border that are looked at.
const PLACES: usize = 96;
/// What is wider than this share of the way across the picture is seen in the small picture.
const WIDEST: f64 = 0.03;
/// And this many px are looked at where that is less.
const LEAST_REACH: usize = 8;
/// A wedge differs from the paper by at least this share of the brighter of the two, and by so many levels.
const LEAST_STEP: f32 = 0.12;
const LEAST_LEVELS: f32 = 12.0;
/// One paper is as bright everywhere within this share.
const SAME_PAPER: f64 = 0.15;
/// The table is as bright as beside the sheet's other sides within this share of its step to the paper.
const SAME_TABLE: f64 = 0.25;
/// Least share of the border along which it is seen.
const LEAST_SEEN: f64 = 0.25;
/// Of its widths, from one end of what is seen to the other, the greater is at least this much the greater one: px, and
/// as a share.
const LEAST_WEDGE_PX: f64 = 1.0;
const LEAST_WEDGE: f64 = 0.2;
/// Most of its places are so near to a straight line, px.
const STRAIGHT_PX: f64 = 1.0;

/// How far inside the border, from one end of it to the other, the paper begins; `None` where there is nothing beside it.
/// Known is what is usual beside the sheet's other sides, if any of them is seen.
pub(super) fn strip(plane: &Plane<u8>, from: Point, to: Point, usual: Option<f64>) -> Option<(f64, f64)> {
    let inward = inward(from, to);
    let across = if inward.x.abs() > inward.y.abs() { plane.width } else { plane.height };
    let reach = ((WIDEST * across as f64) as usize).max(LEAST_REACH);
    let mut levels = vec![0.0_f32; 2 * reach];
    let mut found = Vec::new();
    for k in 0..PLACES {
        let share = (k as f64 + 0.5) / PLACES as f64;
        let at = from.lerp(to, share) + inward * 0.5;
        levels.iter_mut().enumerate().for_each(|(d, level)| *level = plane.at(at + inward * d as f64) as f32);
        let border = f64::from(levels[0]);
        found.extend(width(&levels, reach).map(|(width, paper)| (share, width, paper, border)));
    }
    // what is further in is one paper, and no drawing
    let paper = middle(found.iter().map(|f| f.2).collect())?;
    found.retain(|f| (f.2 - paper).abs() < SAME_PAPER * paper);
    let border = middle(found.iter().map(|f| f.3).collect())?;
    let found: Vec<(f64, f64)> = found.into_iter().map(|(share, width, ..)| (share, width)).collect();
    if (found.len() as f64) < LEAST_SEEN * PLACES as f64 {
        return None;
    }
    // a wedge has one side along the border: it is seen from one place to another without a gap
    let (first, last) = (found.first()?.0, found.last()?.0);
    let (start, end) = straight(&found);
    let at = |share: f64| start + (end - start) * share;
    let off = middle(found.iter().map(|(share, width)| (width - at(*share)).abs()).collect())?;
    let is_whole = found.len() as f64 > 0.8 * (last - first) * PLACES as f64;
    let (narrow, wide) = (at(first).min(at(last)), at(first).max(at(last)));
    let is_wedge = wide - narrow > LEAST_WEDGE_PX + LEAST_WEDGE * wide;
    let is_table = usual.is_some_and(|usual| (usual - border).abs() < SAME_TABLE * (usual - paper).abs());
    (is_whole && (is_wedge || is_table) && off < STRAIGHT_PX).then_some((start.max(0.0), end.max(0.0)))
}

/// How many of some levels, from the border inwards, are none of the paper's, and the paper's, which is further in.
fn width(levels: &[f32], reach: usize) -> Option<(f64, f64)> {
    let paper = middle(levels[reach..].iter().map(|&v| f64::from(v)).collect())? as f32;
    let border = levels[0];
    let step = (border - paper).abs();
    if step < LEAST_LEVELS.max(LEAST_STEP * border.max(paper)) {
        return None;
    }
    let half = 0.5 * (border + paper);
    let is_paper = |level: f32| (level > half) == (paper > half);
    let end = levels.iter().position(|&level| is_paper(level))?;
    // behind it there is nothing but paper, or a line that is no part of it
    let (a, b) = (levels[end - 1], levels[end]);
    let share = f64::from((half - a) / (b - a));
    (end <= reach).then_some((end as f64 - 0.5 + share, f64::from(paper)))
}
