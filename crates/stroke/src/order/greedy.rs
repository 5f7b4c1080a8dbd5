use kurbo::Point;

use super::kdtree::{Gather, KdTree};
use super::ports::Ports;
use super::route::Stop;

/// From `start` always on to the nearest port of a stroke not yet drawn.
pub(super) fn nearest_neighbour(ports: &Ports, start: Point) -> Vec<Stop> {
    let tree = KdTree::new(&ports.points);
    let slots = tree.slots();
    let mut left: Vec<u32> = tree.fold(|points| points.len() as u32, |a, b| a + b);
    let mut drawn = vec![false; ports.strokes()];
    let mut route = Vec::with_capacity(ports.strokes());
    let mut at = start;
    for _ in 0..ports.strokes() {
        let mut nearest = Nearest { ports, drawn: &drawn, left: &left, best: None };
        tree.search(at, &mut nearest);
        let Some((_, entry)) = nearest.best else { break };
        let stroke = ports.stroke[entry as usize];
        drawn[stroke as usize] = true;
        for port in ports.range(stroke) {
            tree.path_to(slots[port as usize]).for_each(|node| left[node] -= 1);
        }
        route.push(Stop { stroke, entry });
        at = ports.points[ports.exit(entry) as usize];
    }
    route
}

struct Nearest<'a> {
    ports: &'a Ports,
    drawn: &'a [bool],
    /// Ports of strokes not yet drawn, by node.
    left: &'a [u32],
    best: Option<(f64, u32)>,
}

impl Gather for Nearest<'_> {
    fn reach_sq(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(distance, _)| distance)
    }

    fn wants(&self, node: usize) -> bool {
        self.left[node] > 0
    }

    fn offer(&mut self, port: u32, distance_sq: f64) {
        let drawn = self.drawn[self.ports.stroke[port as usize] as usize];
        // equal distances go to the lower number: the order must not hang on the tree's layout
        let nearer = self.best.is_none_or(|(d, p)| (distance_sq, port) < (d, p));
        if !drawn && nearer {
            self.best = Some((distance_sq, port));
        }
    }
}
