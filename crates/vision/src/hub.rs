//! Where many lines meet: their ink together is wider than any of them, and no filled shape.

use tracelight_stroke::{Point, polyline_length};

use crate::bridge::Tip;
use crate::graph::{Branch, Graph};
use crate::mask::Mask;
use crate::missed::paint;
use crate::region::Region;
use crate::ridge::median;

/// Fewer lines leave no ink between them that is wider than where two cross.
const FEWEST: usize = 3;
/// A line is seen over so many of its widths outside the hub at least.
const LEAST_PENS: f64 = 1.0;
/// Carried on, a line reaches so far to either side, in half widths and px of blur,
const REACH: f64 = 1.1;
const REACH_PX: f64 = 0.75;
/// and all of them cover at least this share of a hub: a disc with rays has more between them.
const COVERED: f64 = 0.95;

/// A line that leads into a wide part of the ink, and how wide it is, px.
struct Arm {
    tip: Tip,
    width: f64,
}

/// Whether a wide part of the ink of some graphs is where their lines meet: carried on, those that lead into it cover it.
pub(crate) fn is_hub<'a>(part: &Region, ink: &Mask, graphs: impl Iterator<Item = &'a Graph>) -> bool {
    let mut inside = Mask::empty(ink.width, ink.height);
    part.fill_into(&mut inside);
    let arms: Vec<Arm> = graphs.flat_map(|graph| arms(graph, &inside)).collect();
    if arms.len() < FEWEST {
        return false;
    }
    let (width, height) = part.extent();
    let mut covered = Mask::empty(ink.width, ink.height);
    for Arm { tip, width: pen } in arms {
        paint(&mut covered, tip.at, tip.beyond(width.max(height) as f64).0, REACH * 0.5 * pen + REACH_PX);
    }
    part.cells(&covered).count() as f64 >= COVERED * part.area() as f64
}

/// The lines of a graph that lead into a part of its ink.
fn arms(graph: &Graph, part: &Mask) -> Vec<Arm> {
    let is_in = |p: Point| part.get(p.x.floor() as isize, p.y.floor() as isize);
    let of = |branch: &Branch| {
        let outside: Vec<usize> = (0..branch.points.len()).filter(|&i| !is_in(branch.points[i])).collect();
        let runs = outside.chunk_by(|a, b| a + 1 == *b).map(|run| (run[0], run[run.len() - 1]));
        let at_node = |end: usize| branch.nodes[end].is_some_and(|node| is_in(graph.nodes[node].at));
        let last = branch.points.len() - 1;
        let ends = runs.flat_map(|(from, to)| {
            let enters = [from > 0 || at_node(0), to < last || at_node(1)];
            let arm = move |end: usize| Arm::of(&branch.points[from..=to], &branch.radii[from..=to], end);
            [0, 1].into_iter().filter(move |&end| enters[end]).filter_map(arm)
        });
        ends.collect::<Vec<Arm>>()
    };
    graph.branches.iter().flat_map(of).collect()
}

impl Arm {
    /// One of two ends of a line; `None` of what is too short to lead anywhere.
    fn of(points: &[Point], radii: &[f64], end: usize) -> Option<Self> {
        let width = 2.0 * median(radii);
        let tip = Tip::of(points, end)?;
        (polyline_length(points) >= LEAST_PENS * width).then_some(Self { tip, width })
    }
}
