use kurbo::{Point, Rect};

/// Most points of a leaf.
const LEAF: usize = 8;

/// Points in a tree of boxes, each halved at the median of its longer side (Bentley, "K-d trees for semidynamic
/// point sets", 1990). Its depth is log₂ of the number of points whatever their distribution: a thousand points on
/// one spot and one far away cost no more than any others.
pub(super) struct KdTree<'a> {
    points: &'a [Point],
    sorted: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    bounds: Rect,
    range: std::ops::Range<u32>,
    /// The right child; the left one is the next node. `None` for a leaf.
    right: Option<u32>,
}

/// What a search is after; it sees candidates roughly nearest first.
///
/// Points on one spot are all equally near: a search that wanted each of them to be looked at would take the square
/// of their number.
pub(super) trait Gather {
    /// Whether anything below a node can be of interest: its box, and how far that is.
    fn wants(&self, node: usize, bounds: &Rect, distance_sq: f64) -> bool;
    /// Which of two nodes that are equally near is to be seen first: the one of lower rank.
    fn rank(&self, _node: usize) -> u32 {
        0
    }
    /// A point and its squared distance.
    fn offer(&mut self, point: u32, distance_sq: f64);
}

impl<'a> KdTree<'a> {
    pub(super) fn new(points: &'a [Point]) -> Self {
        let mut tree = Self { points, sorted: (0..points.len() as u32).collect(), nodes: Vec::new() };
        if !points.is_empty() {
            tree.build(0, points.len());
        }
        tree
    }

    fn build(&mut self, from: usize, to: usize) -> u32 {
        let own = self.nodes.len();
        let bounds = bounds_of(self.points, &self.sorted[from..to]);
        self.nodes.push(Node { bounds, range: from as u32..to as u32, right: None });
        if to - from > LEAF {
            let middle = (from + to) / 2;
            let points = self.points;
            let along_x = bounds.width() >= bounds.height();
            let key = |&i: &u32| if along_x { points[i as usize].x } else { points[i as usize].y };
            self.sorted[from..to].select_nth_unstable_by(middle - from, |a, b| key(a).total_cmp(&key(b)));
            self.build(from, middle);
            self.nodes[own].right = Some(self.build(middle, to));
        }
        own as u32
    }

    pub(super) fn search(&self, at: Point, gather: &mut impl Gather) {
        if let Some(root) = self.nodes.first()
            && gather.wants(0, &root.bounds, distance_sq(&root.bounds, at))
        {
            self.descend(0, at, gather);
        }
    }

    fn descend(&self, node: usize, at: Point, gather: &mut impl Gather) {
        let Node { range, right, .. } = &self.nodes[node];
        let Some(right) = *right else {
            for &point in &self.sorted[range.start as usize..range.end as usize] {
                gather.offer(point, self.points[point as usize].distance_squared(at));
            }
            return;
        };
        let mut children = [node + 1, right as usize].map(|c| (distance_sq(&self.nodes[c].bounds, at), c));
        let [left, right] = children;
        let tied = left.0 == right.0 && gather.rank(right.1) < gather.rank(left.1);
        if right.0 < left.0 || tied {
            children.swap(0, 1);
        }
        for (distance, child) in children {
            if gather.wants(child, &self.nodes[child].bounds, distance) {
                self.descend(child, at, gather);
            }
        }
    }

    /// For every node one value, made at the leaves from their points and joined upwards.
    pub(super) fn fold<T: Copy>(&self, leaf: impl Fn(&[u32]) -> T, join: impl Fn(T, T) -> T) -> Vec<T> {
        let mut values: Vec<Option<T>> = vec![None; self.nodes.len()];
        for (i, node) in self.nodes.iter().enumerate().rev() {
            let points = &self.sorted[node.range.start as usize..node.range.end as usize];
            let children = node.right.and_then(|r| values[i + 1].zip(values[r as usize]));
            values[i] = Some(children.map_or_else(|| leaf(points), |(l, r)| join(l, r)));
        }
        values.into_iter().flatten().collect()
    }

    /// The points below a node.
    pub(super) fn points_of(&self, node: usize) -> &[u32] {
        let Node { range, .. } = &self.nodes[node];
        &self.sorted[range.start as usize..range.end as usize]
    }

    /// The two halves of a node; none where it is a leaf.
    pub(super) fn children(&self, node: usize) -> Option<[usize; 2]> {
        self.nodes[node].right.map(|right| [node + 1, right as usize])
    }

    /// The nodes a point lies in, root first.
    pub(super) fn path_to(&self, slot: u32) -> impl Iterator<Item = usize> + '_ {
        let mut at = (!self.nodes.is_empty()).then_some(0_usize);
        std::iter::from_fn(move || {
            let node = at?;
            at = self.nodes[node].right.map(|right| match self.nodes[right as usize].range.start <= slot {
                true => right as usize,
                false => node + 1,
            });
            Some(node)
        })
    }

    /// Where each point stands among the leaves, for [`path_to`](Self::path_to).
    pub(super) fn slots(&self) -> Vec<u32> {
        let mut slots = vec![0; self.sorted.len()];
        for (slot, &point) in self.sorted.iter().enumerate() {
            slots[point as usize] = slot as u32;
        }
        slots
    }
}

fn bounds_of(points: &[Point], of: &[u32]) -> Rect {
    let nothing = Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
    of.iter().fold(nothing, |r, &i| {
        let p = points[i as usize];
        Rect::new(r.x0.min(p.x), r.y0.min(p.y), r.x1.max(p.x), r.y1.max(p.y))
    })
}

fn distance_sq(bounds: &Rect, at: Point) -> f64 {
    let dx = (bounds.x0 - at.x).max(at.x - bounds.x1).max(0.0);
    let dy = (bounds.y0 - at.y).max(at.y - bounds.y1).max(0.0);
    dx * dx + dy * dy
}
