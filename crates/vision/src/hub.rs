//! Hubs: junctions of many lines with more ink than any of them, which are no filled shapes.

use std::collections::BTreeMap;

use tracelight_image::median::median;
use tracelight_image::{Cell, Mask, Region};
use tracelight_stroke::{Point, Vec2, polyline_length};

use crate::bridge::Tip;
use crate::graph::{Branch, Graph};
use crate::missed::paint;

/// Fewer lines leave no ink between them that is wider than where two cross.
const FEWEST: usize = 3;
/// A line is seen over so many of its widths outside the hub at least.
const LEAST_PENS: f64 = 1.0;
/// Half width covered by the extension of a line, in half widths plus px of blur.
const REACH: f64 = 1.1;
const REACH_PX: f64 = 0.75;
/// Smallest share of a hub that the extended lines cover: a disc with rays has more area between them.
const COVERED: f64 = 0.95;

/// A line that leads into a wide part of the ink.
struct Arm {
    /// Where its skeleton is in that part.
    enters: Point,
    tip: Tip,
    /// px
    width: f64,
}

/// Those of some wide parts of the ink of graphs that are where their lines meet: carried on, the lines that lead into one cover it.
/// `wide` is all parts.
pub(crate) fn hubs<'a, 'g>(
    parts: &'a [Region],
    wide: &Mask,
    graphs: impl Iterator<Item = &'g Graph>,
) -> Vec<&'a Region> {
    let mut arms_at: BTreeMap<Cell, Vec<Arm>> = BTreeMap::new();
    let mut entries = Mask::empty(wide.width(), wide.height());
    for arm in graphs.flat_map(|graph| arms(graph, wide)) {
        let cell = wide.cell(arm.enters.x as usize, arm.enters.y as usize);
        entries.set(cell);
        arms_at.entry(cell).or_default().push(arm);
    }
    let is_hub = |part: &&Region| {
        let arms: Vec<&Arm> = part.cells(&entries).filter_map(|cell| arms_at.get(&cell)).flatten().collect();
        arms.len() >= FEWEST && is_covered(part, &arms, (wide.width(), wide.height()))
    };
    parts.iter().filter(is_hub).collect()
}

/// Whether some lines, carried on, cover a part of a mask of some size.
fn is_covered(part: &Region, arms: &[&Arm], size: (usize, usize)) -> bool {
    let Some((columns, rows)) = part.bounds(0, size) else { return false };
    let corner = Vec2::new(columns.start as f64, rows.start as f64);
    let mut covered = Mask::empty(columns.len(), rows.len());
    for Arm { tip, width, .. } in arms {
        let far = tip.beyond(columns.len().max(rows.len()) as f64).0;
        paint(&mut covered, tip.at - corner, far - corner, REACH * 0.5 * width + REACH_PX);
    }
    let own = part.seen_from(columns.start, rows.start);
    own.cells(&covered).count() as f64 >= COVERED * part.area() as f64
}

/// The lines of a graph that lead into wide parts of its ink.
fn arms(graph: &Graph, wide: &Mask) -> Vec<Arm> {
    let is_in = |p: &Point| wide.get(p.x.floor() as isize, p.y.floor() as isize);
    let of = |branch: &Branch| {
        let Branch { points, radii, nodes, .. } = branch;
        let outside: Vec<usize> = (0..points.len()).filter(|&i| !is_in(&points[i])).collect();
        let runs = outside.chunk_by(|a, b| a + 1 == *b).map(|run| (run[0], run[run.len() - 1]));
        let node = |end: usize| nodes[end].map(|node| graph.nodes[node].at).filter(is_in);
        let ends = runs.flat_map(|(from, to)| {
            let before = from.checked_sub(1).map_or_else(|| node(0), |i| Some(points[i]));
            let behind = points.get(to + 1).copied().or_else(|| node(1));
            let arm = move |(end, enters): (usize, Option<Point>)| {
                Arm::of(enters?, &points[from..=to], &radii[from..=to], end)
            };
            [before, behind].into_iter().enumerate().filter_map(arm)
        });
        ends.collect::<Vec<Arm>>()
    };
    graph.branches.iter().flat_map(of).collect()
}

impl Arm {
    /// One of two ends of a line; `None` of what is too short to lead anywhere.
    fn of(enters: Point, points: &[Point], radii: &[f64], end: usize) -> Option<Self> {
        let width = 2.0 * median(radii);
        let tip = Tip::of(points, end)?;
        (polyline_length(points) >= LEAST_PENS * width).then_some(Self { enters, tip, width })
    }
}
