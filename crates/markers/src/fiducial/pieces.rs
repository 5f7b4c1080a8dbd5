//! Squares that hang together with something else: four straight pieces of a border, one after the other.

use tracelight_image::border::Edge;
use tracelight_stroke::Point;

use super::quad::{LEAST_SIDE_PX, is_square};
use super::side::{Side, corners, try_four};

/// How far a border is from a straight piece of it at most, px.
const MOST_OFF_PX: f64 = 1.0;
/// Further, as a share of the piece's length: what a lens bends.
const MOST_BENT: f64 = 0.01;
/// Longest border that is looked at, px: one that goes around all of a large image several times.
const LONGEST: usize = 20_000;

/// A straight piece of a border.
#[derive(Clone, Copy, Debug)]
struct Piece {
    from: usize,
    to: usize,
}

/// Corners of every dark square that has most of its border on this one, clockwise as seen.
pub(super) fn squares(edges: &[Edge]) -> Vec<[Point; 4]> {
    let points: Vec<Point> = edges.iter().map(Edge::middle).collect();
    let mut found = Vec::new();
    if points.len() < 3 * LEAST_SIDE_PX as usize || points.len() > LONGEST {
        return found;
    }
    let pieces = pieces(&points);
    let n = pieces.len();
    if n < 4 {
        return found;
    }
    for first in 0..n {
        let four = [0, 1, 2, 3].map(|k| pieces[(first + k) % n]);
        found.extend(square(&points, &four));
    }
    found
}

/// Pieces long enough for a part of a side.
fn pieces(points: &[Point]) -> Vec<Piece> {
    let n = points.len();
    let far = |i: usize| {
        (0..n).max_by(|&a, &b| {
            points[a].distance_squared(points[i]).total_cmp(&points[b].distance_squared(points[i]))
        })
    };
    let Some(a) = far(0) else { return Vec::new() };
    let Some(b) = far(a) else { return Vec::new() };
    let mut bends = Vec::new();
    // both halves, by numbers that go on behind the last
    let mut left = vec![(b, if a > b { a } else { a + n }), (a, if b > a { b } else { b + n })];
    while let Some((from, to)) = left.pop() {
        let (start, end) = (points[from % n], points[to % n]);
        let along = end - start;
        let length = along.hypot();
        let off = |k: usize| {
            let p = points[k % n] - start;
            if length > 0.0 { along.cross(p).abs() / length } else { p.hypot() }
        };
        let worst = (from + 1..to).map(|k| (k, off(k))).max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((k, far)) if far > MOST_OFF_PX + MOST_BENT * length => left.extend([(k, to), (from, k)]),
            _ => bends.push((from, to)),
        }
    }
    bends.sort_unstable_by_key(|(from, _)| from % n);
    let long =
        |&(from, to): &(usize, usize)| points[from % n].distance(points[to % n]) >= 0.4 * LEAST_SIDE_PX;
    bends.into_iter().filter(long).map(|(from, to)| Piece { from, to }).collect()
}

/// The square whose sides four pieces lie on: all of two, and most of the first and the last.
fn square(points: &[Point], pieces: &[Piece; 4]) -> Option<[Point; 4]> {
    let n = points.len();
    let end = |k: usize| (points[pieces[k].from % n], points[pieces[k].to % n]);
    // each turns to the right from the one before
    let turns = (0..3).all(|k| {
        let ((a, b), (c, d)) = (end(k), end(k + 1));
        (b - a).cross(d - c) > 0.17 * (b - a).hypot() * (d - c).hypot()
    });
    if !turns {
        return None;
    }
    let sides: [Side; 4] = try_four(|k| {
        let Piece { from, to } = pieces[k];
        let skip = ((to - from) as f64 * 0.12).ceil() as usize;
        let between: Vec<Point> =
            (from + skip..(to - skip).max(from + skip + 1)).map(|k| points[k % n]).collect();
        (between.len() >= 3).then(|| Side::fit(&between))?.map(|(side, _)| side)
    })?;
    let corners = corners(&sides)?;
    // three corners are where pieces meet; the last is where the first begins and the last ends, or beyond
    for k in 0..3 {
        let corner = corners[k + 1];
        let near = 2.0 + 0.1 * corner.distance(corners[(k + 2) % 4]);
        if corner.distance(end(k).1) > near || corner.distance(end(k + 1).0) > near {
            return None;
        }
    }
    let covers = |k: usize, side: usize| {
        let (a, b) = end(k);
        a.distance(b) >= 0.4 * corners[side].distance(corners[(side + 1) % 4])
    };
    (covers(0, 0) && covers(3, 3) && is_square(&corners)).then_some(corners)
}
