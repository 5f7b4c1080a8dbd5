use kurbo::{Point, Rect};

/// Most segments of a leaf.
const LEAF: usize = 6;

/// Line segments, and a tree of the boxes around them, halved at the median of their middles along the longer side.
///
/// Answers "how far to the nearest?" exactly, in logarithmic time however unevenly the segments lie: unlike a grid,
/// one segment far away does not put all others into one cell.
pub(super) struct Segments {
    segments: Vec<[Point; 2]>,
    nodes: Vec<Node>,
}

struct Node {
    bounds: Rect,
    range: std::ops::Range<usize>,
    /// The right child; the left one is the next node. `None` for a leaf.
    right: Option<usize>,
}

impl Segments {
    /// The segments of polylines; a single point is a segment without length.
    pub(super) fn of(polylines: &[Vec<Point>]) -> Self {
        let of = |line: &Vec<Point>| match line.as_slice() {
            [only] => vec![[*only, *only]],
            points => points.windows(2).map(|w| [w[0], w[1]]).collect(),
        };
        let mut tree = Self { segments: polylines.iter().flat_map(of).collect(), nodes: Vec::new() };
        if !tree.segments.is_empty() {
            tree.build(0..tree.segments.len());
        }
        tree
    }

    fn build(&mut self, range: std::ops::Range<usize>) -> usize {
        let own = self.nodes.len();
        let part = &mut self.segments[range.clone()];
        let bounds = part.iter().map(|&[a, b]| Rect::from_points(a, b)).reduce(|r, s| r.union(s));
        let bounds = bounds.unwrap_or_default();
        self.nodes.push(Node { bounds, range: range.clone(), right: None });
        if part.len() > LEAF {
            let middle = part.len() / 2;
            let along_x = bounds.width() >= bounds.height();
            let key = |&[a, b]: &[Point; 2]| if along_x { a.x + b.x } else { a.y + b.y };
            part.select_nth_unstable_by(middle, |s, t| key(s).total_cmp(&key(t)));
            self.build(range.start..range.start + middle);
            self.nodes[own].right = Some(self.build(range.start + middle..range.end));
        }
        own
    }

    /// Distance from a point to the nearest segment; infinite if there is none.
    pub(super) fn distance(&self, at: Point) -> f64 {
        let mut best_sq = f64::INFINITY;
        if !self.nodes.is_empty() {
            self.descend(0, at, &mut best_sq);
        }
        best_sq.sqrt()
    }

    fn descend(&self, node: usize, at: Point, best_sq: &mut f64) {
        let Node { range, right, .. } = &self.nodes[node];
        let Some(right) = *right else {
            let nearest = self.segments[range.clone()].iter().map(|s| distance_sq(s, at));
            *best_sq = nearest.fold(*best_sq, f64::min);
            return;
        };
        let mut children = [node + 1, right].map(|c| (box_distance_sq(&self.nodes[c].bounds, at), c));
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (distance, child) in children {
            if distance < *best_sq {
                self.descend(child, at, best_sq);
            }
        }
    }
}

fn distance_sq(&[a, b]: &[Point; 2], at: Point) -> f64 {
    let along = b - a;
    let share = (at - a).dot(along) / along.hypot2();
    // a segment without length: 0/0, which the clamp leaves as it is
    let foot = if share.is_nan() { a } else { a + along * share.clamp(0.0, 1.0) };
    at.distance_squared(foot)
}

fn box_distance_sq(bounds: &Rect, at: Point) -> f64 {
    let dx = (bounds.x0 - at.x).max(at.x - bounds.x1).max(0.0);
    let dy = (bounds.y0 - at.y).max(at.y - bounds.y1).max(0.0);
    dx * dx + dy * dy
}
