//! Where a chord meets the edges of what is painted: nothing changes along it in between.

use tracelight_stroke::{Point, Rect};

use super::grid::Listing;
use super::scene::{GateKind, MarkKind, Number, Scene};

/// Whose edge a segment is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Owner {
    Item(Number),
    /// A gate's, or the page's.
    Gate,
}

/// All edges of a scene.
pub(crate) struct Edges {
    segments: Vec<[Point; 2]>,
    owners: Vec<Owner>,
    listing: Listing,
    slack: f64,
}

impl Edges {
    /// Edges within a rectangle, which meet what comes as close as `slack`.
    pub(crate) fn new(scene: &Scene, page: Rect, within: Rect, slack: f64) -> Self {
        let (mut segments, mut owners) = (Vec::new(), Vec::new());
        let shown = within.inflate(slack, slack);
        let mut add = |new: &[[Point; 2]], owner: Owner| {
            let is_near = |&&[a, b]: &&[Point; 2]| {
                let bounds = Rect::from_points(a, b);
                bounds.x1 >= shown.x0
                    && bounds.x0 <= shown.x1
                    && bounds.y1 >= shown.y0
                    && bounds.y0 <= shown.y1
            };
            let before = segments.len();
            segments.extend(new.iter().filter(is_near));
            owners.resize(owners.len() + segments.len() - before, owner);
        };
        for (number, item) in scene.items.iter().enumerate() {
            add(item.region.segments(), Owner::Item(number as Number));
        }
        for gate in &scene.gates {
            match &gate.kind {
                GateKind::Clip(regions) => {
                    regions.iter().for_each(|(region, _)| add(region.segments(), Owner::Gate))
                }
                GateKind::Mask { items, .. } => {
                    items.iter().for_each(|item| add(item.region.segments(), Owner::Gate));
                    add(&sides(gate.bounds), Owner::Gate);
                }
                GateKind::Unknown => {}
            }
        }
        add(&sides(page), Owner::Gate);
        let listing = Listing::new(within, &segments, slack);
        Self { segments, owners, listing, slack }
    }

    /// Parameters of the chord, in order, where it meets edges that count; how many edges were looked at.
    pub(crate) fn met(
        &self,
        chord: [Point; 2],
        own: Own,
        counts: &dyn Fn(Owner) -> bool,
    ) -> (Vec<f64>, usize) {
        let (mut met, mut work) = (Vec::new(), 0);
        self.listing.near(chord, |number| {
            work += 1;
            let edge = self.segments[number as usize];
            let owner = self.owners[number as usize];
            let is_neighbour = own.is(owner) && edge.iter().any(|end| chord.contains(end));
            if !is_neighbour && counts(owner) {
                meet(chord, edge, self.slack, &mut met);
            }
        });
        met.sort_by(f64::total_cmp);
        met.dedup();
        (met, work)
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

fn sides(r: Rect) -> [[Point; 2]; 4] {
    let [a, b, c, d] = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)].map(Point::from);
    [[a, b], [b, c], [c, d], [d, a]]
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
