//! Orders that a person at the wall can follow: layer by layer, or as a page is read.

use std::collections::HashMap;
use std::sync::Arc;

use kurbo::{Point, Rect};

use super::ports::Ports;
use super::route::Stop;
use super::travel::Travel;
use super::{OrderOptions, Ordered, order, travel_cost};
use crate::{Drawing, Stroke};

/// Strokes looked at in all cuts together, at most: what is left is ordered by one sort. A drawing of frames in frames
/// would take the square of their number.
const MOST_WORK: usize = 10_000_000;

/// A gap of at least this share of the widest is cut at the same time: lines of a text are evenly spaced, nearly.
const EVEN: f64 = 0.5;

/// What lies on each layer, in its order; the layers as they come first.
pub fn by_layer<T>(
    all: impl IntoIterator<Item = T>,
    layer_of: impl Fn(&T) -> Option<Arc<str>>,
) -> Vec<Vec<T>> {
    let mut layers: Vec<Vec<T>> = Vec::new();
    let mut numbers = HashMap::new();
    for one in all {
        let number = *numbers.entry(layer_of(&one)).or_insert(layers.len());
        match layers.get_mut(number) {
            Some(layer) => layer.push(one),
            None => layers.push(vec![one]),
        }
    }
    layers
}

/// Puts each layer's strokes in an order with little travel, one layer after the other as the drawing has them first.
///
/// The lower bound is zero: nothing is known of the best order of this kind.
pub fn order_by_layer<C: Travel>(
    drawing: &Drawing,
    start: Point,
    options: OrderOptions,
    cost: &C,
) -> Ordered {
    let (mut at, mut strokes) = (start, Vec::new());
    for layer in by_layer(drawing.strokes.iter().cloned(), |stroke| stroke.layer.clone()) {
        let ordered = order(&Drawing { strokes: layer }, at, options, cost);
        at = ordered.drawing.strokes.last().map_or(at, |stroke| stroke.path.end());
        strokes.extend(ordered.drawing.strokes);
    }
    Ordered::as_it_is(Drawing { strokes }, start, cost)
}

/// Puts strokes in the order in which a page is read: rows from the top, each from the left; what lies round others
/// before them. Each stroke begins at its left or upper end. The plane's y points up.
///
/// The drawing is cut along the widest gap that runs through all of it, across or down, and each part again (the
/// XY cut: Nagy & Seth, "Hierarchical representation of optically scanned documents", 1984).
pub fn reading_order<C: Travel>(drawing: &Drawing, start: Point, cost: &C) -> Ordered {
    let boxes: Vec<Rect> = drawing.strokes.iter().map(bounds).collect();
    let mut sequence = Vec::with_capacity(boxes.len());
    let mut left = vec![(0..boxes.len()).collect::<Vec<_>>()];
    let mut work = 0;
    while let Some(part) = left.pop() {
        work += part.len();
        match if work > MOST_WORK { Cut::Whole(slanting(&boxes, part)) } else { cut(&boxes, part) } {
            Cut::Parts(parts) => left.extend(parts.into_iter().rev()),
            Cut::Whole(strokes) => sequence.extend(strokes),
        }
    }
    let ports = Ports::of(drawing);
    let strokes = sequence.into_iter().map(|stroke| first_entry(&ports, stroke).drawn(drawing, &ports));
    Ordered::as_it_is(Drawing { strokes: strokes.collect() }, start, cost)
}

impl Ordered {
    /// A drawing in the order that it has. The lower bound is zero: nothing is known of a better one.
    pub fn as_it_is(drawing: Drawing, start: Point, cost: &impl Travel) -> Self {
        Self {
            cost: travel_cost(&drawing, start, cost),
            travel: drawing.travel(start),
            lower_bound: 0.0,
            drawing,
        }
    }
}

/// What of a stroke says where it lies: the box of its joints and control points.
fn bounds(stroke: &Stroke) -> Rect {
    let start = stroke.path.start();
    stroke.path.pieces().fold(Rect::from_points(start, start), |all, piece| {
        [0.25, 0.5, 0.75, 1.0].into_iter().fold(all, |all, t| all.union_pt(piece.at(t)))
    })
}

/// The entry of a stroke that is furthest to the left and up.
fn first_entry(ports: &Ports, stroke: usize) -> Stop {
    let stroke = stroke as u32;
    let key = |port: u32| {
        let point = ports.points[port as usize];
        point.x - point.y
    };
    let entry = ports.range(stroke).min_by(|&a, &b| key(a).total_cmp(&key(b)));
    Stop { stroke, entry: entry.unwrap_or_default() }
}

/// What becomes of a part of a drawing.
enum Cut {
    /// Parts, to be read one after the other.
    Parts(Vec<Vec<usize>>),
    /// Strokes in their order.
    Whole(Vec<usize>),
}

fn cut(boxes: &[Rect], part: Vec<usize>) -> Cut {
    if part.len() < 2 {
        return Cut::Whole(part);
    }
    let rows = gaps(boxes, &part, |b| (-b.y1, -b.y0));
    let columns = gaps(boxes, &part, |b| (b.x0, b.x1));
    // where both are there it is rows that are read, unless the page has columns: they stand further apart than lines
    let best = if rows.parts.len() > 1 && 2.0 * rows.width >= columns.width { rows } else { columns };
    if best.parts.len() > 1 {
        return Cut::Parts(best.parts);
    }
    // a frame comes before what it holds
    let holds = |outer: usize| part.iter().filter(|&&inner| contains(boxes[outer], boxes[inner])).count();
    let outermost = part.iter().copied().max_by(|&a, &b| boxes[a].area().total_cmp(&boxes[b].area()));
    if let Some(outer) = outermost.filter(|&outer| 2 * holds(outer) > part.len()) {
        let inner: Vec<usize> = part.into_iter().filter(|&stroke| stroke != outer).collect();
        return Cut::Parts(vec![vec![outer], inner]);
    }
    Cut::Whole(slanting(boxes, part))
}

/// From the upper left to the lower right.
fn slanting(boxes: &[Rect], mut part: Vec<usize>) -> Vec<usize> {
    let key = |stroke: usize| boxes[stroke].center().x - boxes[stroke].center().y;
    part.sort_by(|&a, &b| key(a).total_cmp(&key(b)));
    part
}

fn contains(outer: Rect, inner: Rect) -> bool {
    outer != inner && outer.union(inner) == outer
}

/// The widest gap along one direction, and what lies between it and those like it.
struct Gaps {
    width: f64,
    parts: Vec<Vec<usize>>,
}

fn gaps(boxes: &[Rect], part: &[usize], extent: impl Fn(&Rect) -> (f64, f64)) -> Gaps {
    let mut sorted = part.to_vec();
    sorted.sort_by(|&a, &b| extent(&boxes[a]).0.total_cmp(&extent(&boxes[b]).0));
    // before each stroke, the way from all earlier ones to it
    let mut reached = f64::INFINITY;
    let before: Vec<f64> = sorted
        .iter()
        .map(|&stroke| {
            let (from, to) = extent(&boxes[stroke]);
            let gap = from - reached;
            reached = if reached.is_finite() { reached.max(to) } else { to };
            gap
        })
        .collect();
    let width = before.iter().copied().fold(0.0, f64::max);
    let mut parts: Vec<Vec<usize>> = vec![Vec::new()];
    for (stroke, gap) in sorted.into_iter().zip(before) {
        if gap > 0.0 && gap >= EVEN * width {
            parts.push(Vec::new());
        }
        if let Some(last) = parts.last_mut() {
            last.push(stroke);
        }
    }
    Gaps { width, parts }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Path;

    fn line(from: (f64, f64), to: (f64, f64)) -> Stroke {
        Stroke::new(Path::polyline(&[from.into(), to.into()], false).unwrap())
    }

    fn by_length(a: Point, b: Point) -> f64 {
        a.distance(b)
    }

    fn starts(ordered: &Ordered) -> Vec<(f64, f64)> {
        ordered.drawing.strokes.iter().map(|s| (s.path.start().x, s.path.start().y)).collect()
    }

    #[test]
    fn rows_are_read_from_the_top_and_each_from_the_left() {
        // two rows of three short strokes, some drawn from the right, and a frame round the second
        let mut strokes = Vec::new();
        for (row, y) in [(0, 0.0), (1, 10.0)] {
            for column in [2.0, 0.0, 1.0] {
                let (x, y) = (4.0 * column, y + 0.3 * column);
                strokes.push(if row == 0 {
                    line((x, y), (x + 1.0, y + 1.0))
                } else {
                    line((x + 1.0, y), (x, y + 1.0))
                });
            }
        }
        let corners = [(-1.0, -1.0), (12.0, -1.0), (12.0, 4.0), (-1.0, 4.0)].map(Point::from);
        strokes.push(Stroke::new(Path::polyline(&corners, true).unwrap()));
        let ordered = reading_order(&Drawing { strokes }, Point::ORIGIN, &by_length);
        let wanted = [(0.0, 11.0), (4.0, 11.3), (8.0, 11.6), (-1.0, 4.0), (0.0, 0.0), (4.0, 0.3), (8.0, 0.6)];
        assert_eq!(starts(&ordered), wanted);
        assert!(ordered.gap_percent().is_none());
    }

    #[test]
    fn a_layer_is_drawn_whole_before_the_next_one() {
        let on = |layer: &str, x: f64| Stroke { layer: Some(layer.into()), ..line((x, 0.0), (x + 0.5, 0.0)) };
        let strokes =
            vec![on("b", 3.0), on("a", 0.0), on("b", 1.0), on("a", 2.0), line((9.0, 0.0), (9.0, 1.0))];
        let ordered =
            order_by_layer(&Drawing { strokes }, Point::ORIGIN, OrderOptions::default(), &by_length);
        let layers: Vec<_> = ordered.drawing.strokes.iter().map(|s| s.layer.as_deref()).collect();
        assert_eq!(layers, [Some("b"), Some("b"), Some("a"), Some("a"), None]);
        assert_eq!(starts(&ordered)[0].0, 1.0, "within a layer the way is short");
    }

    #[test]
    fn ten_thousand_strokes_without_a_gap_are_read_too() {
        let strokes = (0..10_000).map(|i| {
            let x = f64::from(i % 100);
            line((x, f64::from(i / 100)), (x + 1.5, f64::from(i / 100) + 1.5))
        });
        let ordered = reading_order(&Drawing { strokes: strokes.collect() }, Point::ORIGIN, &by_length);
        assert_eq!(ordered.drawing.strokes.len(), 10_000);
        // nested frames, each of which holds all others
        let nested = (1..20_000).map(|i| {
            let r = f64::from(i);
            let corners = [(-r, -r), (r, -r), (r, r), (-r, r)].map(Point::from);
            Stroke::new(Path::polyline(&corners, true).unwrap())
        });
        let ordered = reading_order(&Drawing { strokes: nested.collect() }, Point::ORIGIN, &by_length);
        assert_eq!(ordered.drawing.strokes[0].path.start(), Point::new(-19_999.0, 19_999.0));
    }
}
