use kurbo::{Point, Rect};

/// Most segments of a leaf.
const LEAF: usize = 6;

/// Line segments, and a tree of the boxes around them, halved at the median of their middles along the longer side.
///
/// Answers "how far to the nearest?" and "which are near?" exactly, in logarithmic time however unevenly the segments
/// lie: unlike a grid, one segment far away does not put all others into one cell.
pub(super) struct Segments {
    segments: Vec<Segment>,
    nodes: Vec<Node>,
}

/// A segment, and where it comes from.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    ends: [Point; 2],
    /// The polyline it is of.
    pub(super) line: usize,
    /// Length of the polyline before it.
    before: f64,
}

/// The place on the segments that is nearest to a point.
#[derive(Clone, Copy)]
pub(super) struct Foot {
    /// How far, squared.
    pub(super) distance_sq: f64,
    /// The polyline it is on.
    pub(super) line: usize,
    /// How far along that.
    pub(super) along: f64,
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
        let segments = polylines.iter().enumerate().flat_map(|(line, points)| segments(line, points));
        let mut tree = Self { segments: segments.collect(), nodes: Vec::new() };
        if !tree.segments.is_empty() {
            tree.build(0..tree.segments.len());
        }
        tree
    }

    fn build(&mut self, range: std::ops::Range<usize>) -> usize {
        let own = self.nodes.len();
        let part = &mut self.segments[range.clone()];
        let bounds = part.iter().map(|s| Rect::from_points(s.ends[0], s.ends[1])).reduce(|r, s| r.union(s));
        let bounds = bounds.unwrap_or_default();
        self.nodes.push(Node { bounds, range: range.clone(), right: None });
        if part.len() > LEAF {
            let middle = part.len() / 2;
            let along_x = bounds.width() >= bounds.height();
            let key = |s: &Segment| s.ends.map(|p| if along_x { p.x } else { p.y }).iter().sum::<f64>();
            part.select_nth_unstable_by(middle, |s, t| key(s).total_cmp(&key(t)));
            self.build(range.start..range.start + middle);
            self.nodes[own].right = Some(self.build(range.start + middle..range.end));
        }
        own
    }

    /// Distance from a point to the nearest segment; infinite if there is none.
    pub(super) fn distance(&self, at: Point) -> f64 {
        self.nearest(at).map_or(f64::INFINITY, |foot| foot.distance_sq.sqrt())
    }

    /// The nearest place; `None` if there is no segment.
    pub(super) fn nearest(&self, at: Point) -> Option<Foot> {
        let mut best = None;
        if !self.nodes.is_empty() {
            self.descend(0, at, &mut best);
        }
        best
    }

    fn descend(&self, node: usize, at: Point, best: &mut Option<Foot>) {
        let nearer = |than: &Option<Foot>, distance_sq: f64| than.is_none_or(|b| distance_sq < b.distance_sq);
        let Node { range, right, .. } = &self.nodes[node];
        let Some(right) = *right else {
            for foot in self.segments[range.clone()].iter().map(|s| s.foot(at)) {
                if nearer(best, foot.distance_sq) {
                    *best = Some(foot);
                }
            }
            return;
        };
        let mut children = [node + 1, right].map(|c| (box_distance_sq(&self.nodes[c].bounds, at), c));
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (distance_sq, child) in children {
            if nearer(best, distance_sq) {
                self.descend(child, at, best);
            }
        }
    }

    /// Puts into `lines` each polyline that comes within `reach` of a point, once, in ascending order.
    pub(super) fn lines_near(&self, at: Point, reach: f64, lines: &mut Vec<usize>) {
        lines.clear();
        let reach_sq = reach * reach;
        let mut open: Vec<usize> = if self.nodes.is_empty() { vec![] } else { vec![0] };
        while let Some(node) = open.pop() {
            let Node { bounds, range, right } = &self.nodes[node];
            if box_distance_sq(bounds, at) > reach_sq {
                continue;
            }
            match *right {
                Some(right) => open.extend([node + 1, right]),
                None => {
                    let near =
                        self.segments[range.clone()].iter().filter(|s| s.foot(at).distance_sq <= reach_sq);
                    lines.extend(near.map(|s| s.line));
                }
            }
        }
        lines.sort_unstable();
        lines.dedup();
    }
}

fn segments(line: usize, points: &[Point]) -> Vec<Segment> {
    let mut before = 0.0;
    let mut next = |a: Point, b: Point| {
        let segment = Segment { ends: [a, b], line, before };
        before += a.distance(b);
        segment
    };
    match points {
        [only] => vec![next(*only, *only)],
        points => points.windows(2).map(|w| next(w[0], w[1])).collect(),
    }
}

impl Segment {
    fn foot(&self, at: Point) -> Foot {
        let [a, b] = self.ends;
        let way = b - a;
        let share = (at - a).dot(way) / way.hypot2();
        // a segment without length: 0/0
        let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
        let distance_sq = at.distance_squared(a + way * share);
        Foot { distance_sq, line: self.line, along: self.before + share * way.hypot() }
    }
}

fn box_distance_sq(bounds: &Rect, at: Point) -> f64 {
    let dx = (bounds.x0 - at.x).max(at.x - bounds.x1).max(0.0);
    let dy = (bounds.y0 - at.y).max(at.y - bounds.y1).max(0.0);
    dx * dx + dy * dy
}
