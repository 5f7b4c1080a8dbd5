//! Which sides, with the picture's borders, make the sheet.

use tracelight_image::Plane;
use tracelight_image::border::area;
use tracelight_stroke::Point;

use crate::evidence::Calm;
use crate::quad::{LEAST_SEEN, Quad, corners, ends, is_upright, off_border};
use crate::shade::Shade;
use crate::sides::{self, Side};
use crate::small::Small;
use crate::steps;

/// A side is at least this share of the picture's.
const LEAST_SIDE: f64 = 0.2;
/// Least share of the picture that is sheet.
const LEAST_AREA: f64 = 0.12;
/// The same where it is darker than what lies beside it.
const LEAST_AREA_IN_LIGHT: f64 = 0.25;
/// A corner is at least this far from straight and from folded, as a sine.
const LEAST_SINE: f64 = 0.6;
/// A calm table beside it does not make a sheet likelier than one of which more is seen by this factor.
const RIVAL: f64 = 0.75;
/// So many of the likeliest are looked at.
const LOOKED_AT: usize = 24;
/// A side so near to the picture's border all along is none, px.
const AT_BORDER: f64 = 2.5;

/// The sheet with most of its sides seen.
pub(crate) fn best(small: &Small) -> Option<Quad> {
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

/// Whether they turn one way, none of them nearly straight or folded.
fn is_convex(corners: &[Point; 4]) -> bool {
    (0..4).all(|k| {
        let [a, b, c] = [k, k + 1, k + 2].map(|k| corners[k % 4]);
        let (one, next) = (b - a, c - b);
        one.cross(next) > LEAST_SINE * one.hypot() * next.hypot() && one.hypot() > 1.0
    })
}
