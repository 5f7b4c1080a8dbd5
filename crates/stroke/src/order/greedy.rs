use kurbo::{Point, Rect};

use super::kdtree::{Gather, KdTree};
use super::ports::Ports;
use super::route::Stop;

/// From `start` always on to the nearest port of a stroke not yet drawn.
pub(super) fn nearest_neighbour(ports: &Ports, start: Point) -> Vec<Stop> {
    let tree = KdTree::new(&ports.points);
    let mut left = Left::all(&tree);
    let mut route = Vec::with_capacity(ports.strokes());
    let mut at = start;
    for _ in 0..ports.strokes() {
        let mut nearest = Nearest { left: &left, best: None };
        tree.search(at, &mut nearest);
        let Some((_, entry)) = nearest.best else { break };
        let stroke = ports.stroke[entry as usize];
        ports.range(stroke).for_each(|port| left.take(port));
        route.push(Stop { stroke, entry });
        at = ports.points[ports.exit(entry) as usize];
    }
    route
}

/// Ports of strokes not yet drawn.
struct Left<'a> {
    tree: &'a KdTree<'a>,
    slots: Vec<u32>,
    is_left: Vec<bool>,
    /// The lowest number below each node; [`NONE`] where none is left.
    lowest: Vec<u32>,
}

/// Higher than any port's number.
const NONE: u32 = u32::MAX;

impl<'a> Left<'a> {
    fn all(tree: &'a KdTree<'a>) -> Self {
        let slots = tree.slots();
        let lowest = tree.fold(|points| points.iter().copied().min().unwrap_or(NONE), u32::min);
        Self { tree, is_left: vec![true; slots.len()], slots, lowest }
    }

    fn take(&mut self, port: u32) {
        self.is_left[port as usize] = false;
        let path: Vec<usize> = self.tree.path_to(self.slots[port as usize]).collect();
        for node in path.into_iter().rev() {
            // where another number is the lowest, it is in all nodes above too
            if self.lowest[node] != port {
                break;
            }
            self.lowest[node] = self.lowest_in(node);
        }
    }

    fn lowest_in(&self, node: usize) -> u32 {
        match self.tree.children(node) {
            Some(halves) => halves.map(|half| self.lowest[half]).into_iter().min().unwrap_or(NONE),
            None => {
                let points = self.tree.points_of(node).iter().copied();
                points.filter(|&p| self.is_left[p as usize]).min().unwrap_or(NONE)
            }
        }
    }
}

struct Nearest<'a> {
    left: &'a Left<'a>,
    best: Option<(f64, u32)>,
}

impl Gather for Nearest<'_> {
    fn wants(&self, node: usize, _: &Rect, distance_sq: f64) -> bool {
        let lowest = self.left.lowest[node];
        // asked this way round, a point that is not a number is still found
        let no_better = self.best.is_some_and(|best| (distance_sq, lowest) >= best);
        lowest != NONE && !no_better
    }

    fn rank(&self, node: usize) -> u32 {
        self.left.lowest[node]
    }

    fn offer(&mut self, port: u32, distance_sq: f64) {
        // equal distances go to the lower number: the order must not hang on the tree's layout
        let nearer = self.best.is_none_or(|best| (distance_sq, port) < best);
        if self.left.is_left[port as usize] && nearer {
            self.best = Some((distance_sq, port));
        }
    }
}
