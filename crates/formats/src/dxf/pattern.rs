//! Families of parallel lines, cut by the edges of an area.

use tracelight_maths::{cos, sin};
use tracelight_stroke::{Path, Point, Vec2};

/// Dashes of one hatch at most; a pattern of more is not drawn.
const MOST_DASHES: usize = 20_000;

/// Crossings of lines and edges in one file at most: what comes after has no pattern.
pub(super) const MOST_CROSSINGS: usize = 2_000_000;

/// And in one hatch.
const MOST_IN_ONE: usize = 400_000;

/// Lengths of dashes in one family at most. AutoCAD takes six.
const MOST_LENGTHS: usize = 64;

/// Families of one pattern at most. Those that come with AutoCAD have up to fifteen.
const MOST_FAMILIES: usize = 64;

/// Length of a dot, as a share of the whole row of dashes.
const DOT: f64 = 0.02;

/// How far the chords of an edge may be from it, as a share of the area's size.
const TOLERANCE: f64 = 1e-4;

/// Parallel lines.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Family {
    angle_rad: f64,
    /// A point of the first line, where its first dash begins.
    pub(super) base: Point,
    /// From one line to the next.
    pub(super) offset: Vec2,
    /// Dashes positive, gaps negative, dots zero; none for whole lines.
    pub(super) dashes: Vec<f64>,
}

impl Family {
    pub(super) const fn at_angle(angle_rad: f64) -> Self {
        Self { angle_rad, base: Point::ORIGIN, offset: Vec2::ZERO, dashes: Vec::new() }
    }
}

/// The parts of a pattern's lines within an area: inside an odd number of its edges. `None` for more than are drawn, or
/// more crossings than are left.
pub(super) fn lines(edges: &[Path], families: &[Family], left: &mut usize) -> Option<Vec<Path>> {
    let is_endless = families.len() > MOST_FAMILIES || families.iter().any(|f| f.dashes.len() > MOST_LENGTHS);
    if is_endless || *left == 0 {
        return None;
    }
    let all: Vec<Point> = edges.iter().flat_map(|e| e.pieces().map(|p| p.from)).collect();
    let size = all.iter().map(|p| p.distance(all[0])).fold(0.0, f64::max);
    let tolerance = TOLERANCE * size;
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Some(Vec::new());
    }
    let rings: Vec<Vec<Point>> = edges.iter().map(|e| e.flatten(tolerance)).collect();
    let mut paths = Vec::new();
    for family in families {
        drawn(family, &rings, left, &mut paths)?;
    }
    Some(paths)
}

fn drawn(family: &Family, rings: &[Vec<Point>], left: &mut usize, paths: &mut Vec<Path>) -> Option<()> {
    let along = Vec2::new(cos(family.angle_rad), sin(family.angle_rad));
    let across = Vec2::new(-along.y, along.x);
    let spacing = family.offset.dot(across);
    if spacing == 0.0 {
        return None;
    }
    let mut crossings: Vec<(i64, f64)> = Vec::new();
    for ring in rings {
        for (i, &from) in ring.iter().enumerate() {
            let to = ring[(i + 1) % ring.len()];
            let before = crossings.len();
            crossed([from, to].map(|p| p - family.base), [along, across], spacing, &mut crossings)?;
            *left = left.saturating_sub(crossings.len() - before);
            if *left == 0 || crossings.len() > MOST_IN_ONE {
                return None;
            }
        }
    }
    crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    for row in crossings.chunk_by(|a, b| a.0 == b.0) {
        let origin = family.base + family.offset * row[0].0 as f64;
        // distances along the line from its own first dash
        let shift = family.offset.dot(along) * row[0].0 as f64;
        for pair in row.chunks_exact(2) {
            let span = [pair[0].1 - shift, pair[1].1 - shift];
            for [a, b] in dashes(&family.dashes, span)? {
                paths.extend(Path::polyline(&[origin + along * a, origin + along * b], false));
                if paths.len() > MOST_DASHES {
                    return None;
                }
            }
        }
    }
    Some(())
}

/// The lines that an edge crosses, by number, and where along them, both seen from the family's base.
fn crossed(
    edge: [Vec2; 2],
    [along, across]: [Vec2; 2],
    spacing: f64,
    crossings: &mut Vec<(i64, f64)>,
) -> Option<()> {
    let [u, v] = edge.map(|p| p.dot(across) / spacing);
    let (low, high) = (u.min(v), u.max(v));
    // a line through a corner belongs to the edge above it alone
    let (first, last) = (low.ceil(), high.ceil() - 1.0);
    let count = last - first + 1.0;
    if !(count <= MOST_IN_ONE as f64 && first.abs() < 1e15) {
        return None;
    }
    for i in 0..count.max(0.0) as i64 {
        let number = first as i64 + i;
        let share = (number as f64 - u) / (v - u);
        crossings.push((number, edge[0].lerp(edge[1], share).dot(along)));
    }
    Some(())
}

/// The dashes between two places along a line.
fn dashes(lengths: &[f64], [from, to]: [f64; 2]) -> Option<Vec<[f64; 2]>> {
    let period: f64 = lengths.iter().map(|l| l.abs()).sum();
    if lengths.is_empty() || period <= 0.0 {
        return Some(vec![[from, to]]);
    }
    let times = (to - from) / period;
    if times.is_nan() || times * lengths.len() as f64 > MOST_DASHES as f64 {
        return None;
    }
    let mut at = (from / period).floor() * period;
    let mut found = Vec::new();
    for _ in 0..times as usize + 2 {
        for &own in lengths {
            let end = if own > 0.0 { at + own } else { at + DOT * period };
            let span = [at.max(from), end.min(to)];
            if own >= 0.0 && span[0] < span[1] {
                found.push(span);
            }
            at += own.abs();
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(side: f64, at: f64) -> Path {
        let corners = [(at, at), (at + side, at), (at + side, at + side), (at, at + side)];
        Path::polyline(&corners.map(Point::from), true).unwrap()
    }

    fn length(paths: &[Path]) -> f64 {
        paths.iter().map(|p| p.length(1e-9)).sum()
    }

    #[test]
    fn lines_end_at_the_edges_and_leave_holes_out() {
        let family =
            Family { offset: Vec2::new(0.0, 1.0), base: Point::new(0.0, 0.5), ..Family::at_angle(0.0) };
        let full = lines(&[square(10.0, 0.0)], std::slice::from_ref(&family), &mut 1000).unwrap();
        assert_eq!((full.len(), length(&full)), (10, 100.0));
        let holed = lines(&[square(10.0, 0.0), square(4.0, 3.0)], &[family], &mut 1000).unwrap();
        assert_eq!((holed.len(), length(&holed)), (14, 84.0));
    }

    #[test]
    fn dashes_begin_at_the_base_of_each_line() {
        let family = Family {
            offset: Vec2::new(0.5, 1.0),
            base: Point::new(0.0, 0.5),
            dashes: vec![1.0, -1.0],
            ..Family::at_angle(0.0)
        };
        let found = lines(&[square(2.0, 0.0)], &[family], &mut 1000).unwrap();
        let spans: Vec<_> = found.iter().map(|p| (p.start().x, p.end().x, p.start().y)).collect();
        assert_eq!(spans, [(0.0, 1.0, 0.5), (0.5, 1.5, 1.5)]);
    }

    #[test]
    fn patterns_too_dense_are_none() {
        let family = Family { offset: Vec2::new(0.0, 1e-9), ..Family::at_angle(0.3) };
        assert_eq!(lines(&[square(2.0, 0.0)], &[family], &mut 1000), None);
        let family = Family { offset: Vec2::new(0.0, 0.1), ..Family::at_angle(0.0) };
        let mut left = 100;
        assert!(lines(&[square(2.0, 0.0)], std::slice::from_ref(&family), &mut left).is_some());
        assert_eq!(left, 60);
        assert_eq!(lines(&[square(20.0, 0.0)], &[family], &mut left), None);
    }
}
