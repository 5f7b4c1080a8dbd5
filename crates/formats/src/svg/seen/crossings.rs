//! Where a chord meets the edges of what is painted: nothing changes along it in between.

use std::ops::Range;

use tracelight_stroke::Point;

use super::grid::Listing;
use super::scene::{MarkKind, Number};

/// Whose edge a segment is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Owner {
    Item(Number),
    /// A gate's, or the page's.
    Gate,
}

/// The edges of a scene that could be seen, by the tiles in which they could.
pub(crate) struct Edges {
    pub(crate) segments: Vec<[Point; 2]>,
    pub(crate) owners: Vec<Owner>,
    /// Numbers of each item's segments.
    pub(crate) of_items: Vec<Range<u32>>,
    pub(crate) listing: Listing,
    /// How close a line must come to an edge to meet it.
    pub(crate) slack: f64,
}

impl Edges {
    /// Finds the parameters of a chord, in order, where it meets edges that count. Returns how many edges were looked at.
    pub(crate) fn met(
        &self,
        chord: [Point; 2],
        own: Own,
        counts: impl Fn(Owner) -> bool,
        met: &mut Vec<f64>,
    ) -> usize {
        let mut work = 0;
        met.clear();
        self.listing.near(chord, |number| {
            work += 1;
            let edge = self.segments[number as usize];
            if is_apart(chord, edge, self.slack) {
                return;
            }
            let owner = self.owners[number as usize];
            let is_neighbour = own.is(owner) && edge.iter().any(|end| chord.contains(end));
            if !is_neighbour && counts(owner) {
                meet(chord, edge, self.slack, met);
            }
        });
        met.sort_by(f64::total_cmp);
        met.dedup();
        work
    }

    /// Whether a chord comes near the edge of an item.
    pub(crate) fn nears(&self, chord: [Point; 2], item: Number) -> bool {
        let slack = 2.0 * self.slack;
        self.listing.any_near(chord, self.of_items[item as usize].clone(), |number| {
            let (edge, mut met) = (self.segments[number as usize], Vec::new());
            if !is_apart(chord, edge, slack) {
                meet(chord, edge, slack, &mut met);
            }
            !met.is_empty()
        })
    }
}

/// Whose edge the chord itself is part of, if any's: what it shares a corner with goes on from it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Own(pub(crate) MarkKind, pub(crate) Number);

impl Own {
    fn is(self, owner: Owner) -> bool {
        match self.0 {
            MarkKind::Cut(_) => owner == Owner::Gate,
            _ => owner == Owner::Item(self.1),
        }
    }
}

/// Whether the upright rectangles round two segments are further apart than `slack`.
fn is_apart([a, b]: [Point; 2], [c, d]: [Point; 2], slack: f64) -> bool {
    a.x.max(b.x) + slack < c.x.min(d.x)
        || c.x.max(d.x) + slack < a.x.min(b.x)
        || a.y.max(b.y) + slack < c.y.min(d.y)
        || c.y.max(d.y) + slack < a.y.min(b.y)
}

/// Adds the parameters at which a chord crosses an edge, or comes as close to an end of it as `slack`.
fn meet([a, b]: [Point; 2], [c, d]: [Point; 2], slack: f64, met: &mut Vec<f64>) {
    let (chord, edge) = (b - a, d - c);
    let (long, wide) = (chord.hypot2(), edge.hypot2());
    if long == 0.0 || wide == 0.0 {
        return;
    }
    let (c_side, d_side) = (chord.cross(c - a), chord.cross(d - a));
    let near = slack * slack * long;
    // both ends far on one side
    if c_side * d_side > 0.0 && c_side * c_side > near && d_side * d_side > near {
        return;
    }
    let (a_side, b_side) = (edge.cross(a - c), edge.cross(b - c));
    let reach = slack * slack * wide;
    if a_side * b_side > 0.0 && a_side * a_side > reach && b_side * b_side > reach {
        return;
    }
    if (c_side < 0.0) != (d_side < 0.0) && (a_side < 0.0) != (b_side < 0.0) {
        met.push((a_side / (a_side - b_side)).clamp(0.0, 1.0));
    }
    for (end, side) in [(c, c_side), (d, d_side)] {
        let t = (end - a).dot(chord) / long;
        if side * side <= near && (0.0..=1.0).contains(&t) {
            met.push(t);
        }
    }
    for (t, from, side) in [(0.0, a, a_side), (1.0, b, b_side)] {
        let along = (from - c).dot(edge) / wide;
        if side * side <= reach && (0.0..=1.0).contains(&along) {
            met.push(t);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_and_touches_are_met() {
        let check = |edge: [(f64, f64); 2], wanted: &[f64]| {
            let mut met = Vec::new();
            meet([Point::ORIGIN, Point::new(10.0, 0.0)], edge.map(Point::from), 0.01, &mut met);
            assert_eq!(met, wanted, "{edge:?}");
        };
        check([(5.0, -1.0), (5.0, 1.0)], &[0.5]);
        check([(5.0, 0.1), (5.0, 1.0)], &[]);
        check([(2.0, 0.001), (7.0, 0.001)], &[0.2, 0.7]);
        check([(5.0, 0.005), (5.0, 1.0)], &[0.5]);
        check([(12.0, -1.0), (12.0, 1.0)], &[]);
        check([(10.0, -1.0), (10.0, 1.0)], &[1.0]);
        check([(3.0, 5.0), (7.0, 5.0)], &[]);
    }
}
