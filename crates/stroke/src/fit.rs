//! Fits a path that a head can follow to the points of a tracer.
//!
//! Corners are found first and put where their sides meet; between them, straight runs become lines, round ones arcs
//! that touch them, and the rest few cubics, each passing into the next without a break of direction. A head stops at
//! every corner and brakes at every kink, so neither is made up and none is rounded away.

mod arc;
mod bend;
mod chain;
mod circle;
mod corner;
mod cubic;
mod flank;
mod line;
mod noise;
mod options;
mod plan;
mod round;
mod samples;
mod section;
mod skyline;
mod straight;
mod tangent;
mod window;

use kurbo::Point;

use crate::{Element, Path, Piece, simplify};
use corner::Corner;
use samples::Samples;

pub use options::FitOptions;
pub use window::Parabola;

/// Fewer samples than this hold no curve.
const LEAST_SAMPLES: usize = 8;

/// A path of few lines, arcs and cubics near `points`, taken in order; `None` for fewer than two distinct points.
/// Points that are no numbers, or beyond 1e60, are passed over.
///
/// Open paths keep their end points. A closed path (its first point need not be repeated) starts at a corner where
/// it has one. Between corners neighbouring elements share their direction, at the seam of a closed path too.
/// Cubics after Schneider (1990), corners and lines as the modules here describe.
pub fn fit(points: &[Point], closed: bool, options: &FitOptions) -> Option<Path> {
    // a tolerance that is negative or no number is none
    let options = &FitOptions { tolerance: options.tolerance.max(0.0), ..*options };
    let samples = Samples::of(points, closed, options.step())?;
    let as_lines = || {
        let few = simplify(&samples.points, samples.closed, options.tolerance);
        // what is smaller than the tolerance would be a point
        let small = || points.iter().copied().filter(samples::is_near).collect::<Vec<_>>();
        Path::polyline(&few, samples.closed).or_else(|| Path::polyline(&small(), closed))
    };
    if samples.len() < LEAST_SAMPLES {
        return as_lines();
    }
    let corners = corner::find(&samples, options);
    let path = match (samples.closed, corners.is_empty()) {
        (true, true) => smooth_ring(&samples, options),
        (true, false) => cornered_ring(&samples, &corners, options),
        (false, _) => open_line(&samples, &corners, options),
    };
    // a small ring may be all zone of its only corner: then nothing between is trusted, and nothing is left
    if path.pieces().any(|piece| moves(&piece)) { Some(path) } else { as_lines() }
}

fn moves(piece: &Piece) -> bool {
    match piece.element {
        Element::Line { to } => to != piece.from,
        Element::Arc { centre, .. } => centre != piece.from,
        Element::Cubic { c1, c2, to } => [c1, c2, to].iter().any(|&p| p != piece.from),
    }
}

fn smooth_ring(samples: &Samples, options: &FitOptions) -> Path {
    if let Some(circle) = circle::through(&samples.points, 0.7 * options.tolerance) {
        return circle;
    }
    let tangent = samples.tangent(0, LEAST_SAMPLES - 1).unwrap_or_default();
    let (start, elements) = section::ring(&samples.points, tangent, options);
    assembled(start, elements, true)
}

fn cornered_ring(samples: &Samples, corners: &[Corner], options: &FitOptions) -> Path {
    let next = corners.iter().skip(1).chain(corners.first());
    let mut elements = Vec::new();
    for (from, to) in corners.iter().zip(next) {
        let ahead = if to.index > from.index { to.index } else { to.index + samples.len() };
        let inner = trusted(samples, from.index + from.zone, ahead as isize - to.zone as isize);
        elements.extend(section::open(&[&[from.point], &inner[..], &[to.point]].concat(), options));
    }
    assembled(corners[0].point, elements, true)
}

fn open_line(samples: &Samples, corners: &[Corner], options: &FitOptions) -> Path {
    let last = samples.len() - 1;
    let (start, end) = (samples.points[0], samples.points[last]);
    let mut stops = vec![Corner { index: 0, zone: 1, point: start }];
    stops.extend(corners);
    stops.push(Corner { index: last, zone: 1, point: end });
    let mut elements = Vec::new();
    for pair in stops.windows(2) {
        let inner =
            trusted(samples, pair[0].index + pair[0].zone, pair[1].index as isize - pair[1].zone as isize);
        elements.extend(section::open(&[&[pair[0].point], &inner[..], &[pair[1].point]].concat(), options));
    }
    assembled(start, elements, false)
}

/// Samples from one index to another, none when the zones of two corners overlap.
fn trusted(samples: &Samples, from: usize, to: isize) -> Vec<Point> {
    (from as isize..=to).filter_map(|i| samples.get(i)).collect()
}

fn assembled(start: Point, elements: Vec<Element>, closed: bool) -> Path {
    let mut path = Path::new(start);
    elements.into_iter().for_each(|e| path.push(e));
    if closed {
        path.close();
    }
    path
}

#[cfg(test)]
mod tests;
