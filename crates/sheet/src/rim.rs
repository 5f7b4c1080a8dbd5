//! A narrow wedge of table, or of a scanner's lid, along the picture's border.
//!
//! A frame drawn along the border looks alike, but is as wide at one end as at the other, and not as bright as what lies
//! beside the sheet elsewhere.

use tracelight_image::Plane;
use tracelight_image::median::middle;
use tracelight_stroke::Point;

use crate::quad::inward;
use crate::straight::straight;

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
/// Of its widths, from one end of what is seen to the other, the greater is greater by at least this: px, as a share, and as a
/// multiple of what most places are off it.
const LEAST_WEDGE_PX: f64 = 0.35;
const LEAST_WEDGE: f64 = 0.15;
const LEAST_WEDGE_OFF: f64 = 6.0;
/// There is no greater gap in what is seen of it than leaves this share.
const LEAST_WHOLE: f64 = 0.7;
/// What has fewer pixels has none that is all its own.
const FEW_PX: f64 = 2.0;
/// What is narrower is nothing that someone drew, px.
const SLIVER_PX: f64 = 1.5;
/// Most of its places are so near to a straight line, px.
const STRAIGHT_PX: f64 = 1.0;

/// A strip that is no paper.
pub(crate) struct Strip {
    /// How far inside the border the paper begins, at its one end and at its other, px.
    pub(crate) first: f64,
    pub(crate) last: f64,
    /// Whether it is a wedge, or as bright as what lies beside the sheet's other sides: no line that someone drew.
    is_beside: bool,
}

impl Strip {
    /// In the middle, px.
    fn width(&self) -> f64 {
        0.5 * (self.first + self.last)
    }

    /// The strip along a border; `None` where there is none. Known is what is usual beside the sheet's other sides, if any of
    /// them is seen.
    pub(crate) fn along(plane: &Plane<u8>, from: Point, to: Point, usual: Option<f64>) -> Option<Self> {
        let found = places(plane, from, to);
        // what is further in is one paper, and no drawing
        let paper = middle(found.iter().map(|f| f.paper).collect())?;
        let found: Vec<Place> =
            found.into_iter().filter(|f| (f.paper - paper).abs() < SAME_PAPER * paper).collect();
        if (found.len() as f64) < LEAST_SEEN * PLACES as f64 {
            return None;
        }
        let levels = || found.iter().map(|f| f.border);
        let border = middle(levels().collect())?;
        // where a single pixel is left of it, that is not all of its own
        let (darkest, brightest) =
            levels().fold((f64::INFINITY, 0.0_f64), |(low, high), level| (low.min(level), high.max(level)));
        let own = if border < paper { darkest } else { brightest };
        let widths: Vec<(f64, f64)> = found.iter().map(|f| (f.share, f.width(own))).collect();
        // a strip is seen from one place to another without a gap
        let (start, end) = straight(&widths);
        let at = |share: f64| start + (end - start) * share;
        let (a, b) = (widths.first()?.0, widths.last()?.0);
        let off = middle(widths.iter().map(|(share, width)| (width - at(*share)).abs()).collect())?;
        let is_whole = widths.len() as f64 > LEAST_WHOLE * (b - a) * PLACES as f64;
        let (narrow, wide) = (at(a).min(at(b)), at(a).max(at(b)));
        let is_wedge = wide - narrow > (LEAST_WEDGE * wide).max(LEAST_WEDGE_OFF * off).max(LEAST_WEDGE_PX);
        let is_table = usual.is_some_and(|usual| (usual - border).abs() < SAME_TABLE * (usual - paper).abs());
        (is_whole && off < STRAIGHT_PX).then_some(Self {
            first: start.max(0.0),
            last: end.max(0.0),
            is_beside: is_wedge || is_table,
        })
    }
}

/// Which of the strips along the four borders lie beside the sheet. One that is as wide everywhere may be a line that someone
/// drew, if it is not too narrow for that; such strips on all sides are a frame, however narrow. Lines are as wide as each other.
pub(crate) fn beside(strips: [Option<Strip>; 4]) -> [Option<Strip>; 4] {
    let is_even = are_as_wide(strips.iter().flatten().map(Strip::width));
    let is_frame = is_even && strips.iter().all(|strip| strip.as_ref().is_some_and(|strip| !strip.is_beside));
    let is_line = |strip: &Strip| !strip.is_beside && is_even && (is_frame || strip.width() > SLIVER_PX);
    strips.map(|strip| strip.filter(|strip| !is_line(strip)))
}

/// A frame along the picture's border is as wide everywhere within so many px, and as a share.
const SAME_WIDTH_PX: f64 = 1.0;
const SAME_WIDTH: f64 = 0.15;

/// Whether some widths are those of one frame, px.
pub(crate) fn are_as_wide(widths: impl Iterator<Item = f64>) -> bool {
    let (narrowest, widest) =
        widths.fold((f64::INFINITY, 0.0_f64), |(low, high), width| (low.min(width), high.max(width)));
    widest - narrowest < SAME_WIDTH_PX + SAME_WIDTH * widest
}

/// Where along a border something else than paper is seen.
struct Place {
    /// Of the way along it.
    share: f64,
    /// The outermost level, and the paper's.
    border: f64,
    paper: f64,
    /// How many levels are none of the paper's, and how much these differ from its in sum.
    px: f64,
    sum: f64,
}

impl Place {
    /// What is seen from the border inwards, the paper behind it; `None` where that is the same.
    fn of(share: f64, levels: &[f32], reach: usize) -> Option<Self> {
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
        let px = end as f64 - 0.5 + f64::from((half - a) / (b - a));
        let sum = levels[..=end].iter().map(|level| f64::from((level - paper).abs())).sum();
        (end <= reach).then_some(Self { share, border: f64::from(border), paper: f64::from(paper), px, sum })
    }

    /// How wide it is there if it has a level of its own, px.
    fn width(&self, own: f64) -> f64 {
        if self.px < FEW_PX { self.sum / (self.paper - own).abs().max(1.0) } else { self.px }
    }
}

/// What is seen along a border.
fn places(plane: &Plane<u8>, from: Point, to: Point) -> Vec<Place> {
    let inward = inward(from, to);
    let across = if inward.x.abs() > inward.y.abs() { plane.width } else { plane.height };
    let reach = ((WIDEST * across as f64) as usize).max(LEAST_REACH);
    let mut levels = vec![0.0_f32; 2 * reach];
    let place = |k: usize| {
        let share = (k as f64 + 0.5) / PLACES as f64;
        let at = from.lerp(to, share) + inward * 0.5;
        levels.iter_mut().enumerate().for_each(|(d, level)| *level = plane.at(at + inward * d as f64) as f32);
        Place::of(share, &levels, reach)
    };
    (0..PLACES).filter_map(place).collect()
}
