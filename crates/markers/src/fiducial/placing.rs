//! Places a marker whose cells are known, by all of its boundaries.
//!
//! Each look across its boundaries starts from where the last one put it. A marker that was read is not lost because few of them are
//! seen: those that are seen place it, and how they scatter says how well.

use tracelight_image::Plane;
use tracelight_maths::powi;
use tracelight_stroke::{Point, Vec2};

use super::boundary::{Cells, Found, View, Which};
use super::place::TagPlace;
use super::side;
use super::square::{Off, Square};

/// Blur at first, standard deviation, px: as most cameras have it, and as one that sharpens.
const FIRST_BLUR_PX: f64 = 1.0;
const SHARP_BLUR_PX: f64 = 0.5;
/// Looks before the last: by the border alone where enough of it is seen.
const LOOKS: usize = 2;
/// Most of them, where few boundaries are seen.
const MOST_LOOKS: usize = 6;
/// One look does if the blur, and half of how far boundaries are off, change by less, px.
const NEAR_PX: f64 = 0.2;
/// Fewest boundaries by which a marker is placed at all: twice as many as its square has parameters.
const FEWEST: usize = 16;
/// Share of the boundaries looked at from which on a marker is where it was looked for.
const ENOUGH: f64 = 0.75;
/// Boundaries that are further off than so many deviations are not what they are taken for: what lies beside the marker, dirt, glare.
const MOST_DEVIATIONS: f64 = 4.0;

/// A marker placed: its square, its boundaries, and their scatter, px.
pub(super) struct Placed {
    pub(super) square: Square,
    pub(super) places: Vec<TagPlace>,
    pub(super) deviation_px: f64,
    /// Whether most of its boundaries are seen.
    is_whole: bool,
}

/// Places a marker that is thought to have these corners, to a pixel or so.
pub(super) fn placed(plane: &Plane<u8>, cells: &Cells, rough: &[Point; 4]) -> Option<Placed> {
    let first = attempt(plane, cells, rough, FIRST_BLUR_PX);
    if first.as_ref().is_some_and(|first| first.is_whole) {
        return first;
    }
    let corners = side::refined(plane, rough).unwrap_or(*rough);
    let second = attempt(plane, cells, &corners, SHARP_BLUR_PX);
    let number = |placed: &Option<Placed>| placed.as_ref().map_or(0, |placed| placed.places.len());
    if number(&second) > number(&first) { second } else { first }
}

/// Looks from some corners on, with some blur at first.
fn attempt(plane: &Plane<u8>, cells: &Cells, corners: &[Point; 4], blur_px: f64) -> Option<Placed> {
    let mut view = View::of(plane, cells, corners, blur_px)?;
    for looks in 1..=MOST_LOOKS {
        let which = if looks == 1 { Which::Few } else { Which::Border };
        let (mut found, mut asked) = view.look(which, false);
        if looks > LOOKS || !is_most(found.len(), asked) {
            (found, asked) = view.look(Which::All, false);
        }
        if found.len() < FEWEST {
            return None;
        }
        let blur_px = view.blur_px;
        view.blur_by(&found);
        view.square = view.square.moved(&offs(&found))?;
        let was_near =
            (view.blur_px - blur_px).abs() < NEAR_PX && found.iter().all(|f| f.off_px.abs() < 2.0 * NEAR_PX);
        if (looks >= LOOKS || was_near) && is_most(found.len(), asked) {
            break;
        }
    }
    let (found, asked) = view.look(Which::All, true);
    let (square, kept) = without_strays(&view.square, found)?;
    let mut squares = 0.0;
    let mut places = Vec::with_capacity(kept.len());
    for found in &kept {
        let (at, off_px) = against(&view.square, &square, found)?;
        squares += powi(off_px, 2);
        let Found { cell, upright, black_behind, .. } = *found;
        places.push(TagPlace { cell, upright, black_behind, at });
    }
    // eight of them it takes to place the square
    let deviation_px = (squares / (kept.len() - 8) as f64).sqrt();
    Some(Placed { square, is_whole: is_most(places.len(), asked), places, deviation_px })
}

fn is_most(found: usize, asked: usize) -> bool {
    found as f64 >= ENOUGH * asked as f64
}

/// A square moved by boundaries that were found from it, and those of them that agree.
fn without_strays(from: &Square, mut found: Vec<Found>) -> Option<(Square, Vec<Found>)> {
    loop {
        if found.len() < FEWEST {
            return None;
        }
        let square = from.moved(&offs(&found))?;
        let offs: Vec<f64> = found
            .iter()
            .map(|found| against(from, &square, found).map(|(_, off_px)| off_px.abs()))
            .collect::<Option<_>>()?;
        let mut sorted = offs.clone();
        // half of a normal distribution lies within 0.6745 deviations
        let median = *sorted.select_nth_unstable_by(offs.len() / 2, f64::total_cmp).1;
        let most = MOST_DEVIATIONS * median / 0.6745;
        let before = found.len();
        let mut offs = offs.iter();
        found.retain(|_| offs.next().is_some_and(|&off| off <= most));
        if found.len() == before {
            return Some((square, found));
        }
    }
}

/// Where a boundary is seen, and by how much a square has it elsewhere, across, px.
fn against(from: &Square, square: &Square, found: &Found) -> Option<(Point, f64)> {
    let Found { cell, normal, off_px, .. } = *found;
    let at: Point = from.at(cell.x, cell.y)? + normal * off_px;
    let off: Vec2 = at - square.at(cell.x, cell.y)?;
    Some((at, off.dot(normal)))
}

fn offs(found: &[Found]) -> Vec<Off> {
    found.iter().map(|f| (f.cell, f.off_px, f.normal)).collect()
}
