//! The drawing order.

use tracelight_stroke::{Drawing, Effort, Element, OrderOptions, Ordered, Path, Point, Stroke, order};

use crate::bytes::Bytes;

const MOST_STROKES: usize = 60;

/// Layout: effort, seed, start; then a stroke after the other, each its flags, its start and its elements.
///
/// # Panics
/// When a stroke is lost, doubled or changed, or the figures are not those of the order.
pub fn check(data: &[u8]) {
    let mut bytes = Bytes::of(data);
    let effort = bytes.one_of(&[Effort::Quick, Effort::Normal]);
    let seed = u64::from(bytes.byte());
    let start = point(&mut bytes);
    let mut drawing = Drawing::default();
    while drawing.strokes.len() < MOST_STROKES && !bytes.is_empty() {
        let name = drawing.strokes.len().to_string();
        let stroke = Stroke { layer: Some(name.into()), ..Stroke::new(path(&mut bytes)) };
        drawing.strokes.push(stroke);
    }
    // uphill is dearer: a cost that is no distance
    let cost = |a: Point, b: Point| a.distance(b) + (b.y - a.y).max(0.0);
    let options = OrderOptions { effort, seed };
    let ordered = order(&drawing, start, options, &cost);
    check_ordered(&drawing, &ordered, start, &cost);
    assert_eq!(ordered, order(&drawing, start, options, &cost), "a second run differs");
}

fn point(bytes: &mut Bytes<'_>) -> Point {
    // steps of 1/64 where many coincide, and bytes where most do
    Point::new(f64::from(bytes.byte() as i8), f64::from(bytes.byte() as i8) / 4.0)
}

/// Bit 0 closes it, the rest says of how many elements it is: none too, which is a dot.
fn path(bytes: &mut Bytes<'_>) -> Path {
    let flags = bytes.byte();
    let mut path = Path::new(point(bytes));
    for _ in 0..flags >> 1 & 7 {
        match bytes.byte() % 4 {
            0 => {
                path.push(Element::Arc { centre: point(bytes), sweep: f64::from(bytes.byte() as i8) / 20.0 })
            }
            1 => path.push(Element::Cubic { c1: point(bytes), c2: point(bytes), to: point(bytes) }),
            2 => path.push(Element::Line { to: point(bytes) }),
            _ => path.line_to(point(bytes)),
        }
    }
    if flags & 1 == 1 {
        path.close();
    }
    path
}

fn check_ordered(before: &Drawing, after: &Ordered, start: Point, cost: &impl Fn(Point, Point) -> f64) {
    let name = |stroke: &Stroke| stroke.layer.as_deref().and_then(|l| l.parse::<usize>().ok());
    let mut seen = vec![false; before.strokes.len()];
    let (mut at, mut sum) = (start, 0.0);
    for stroke in &after.drawing.strokes {
        let number = name(stroke).unwrap_or(usize::MAX);
        assert!(!std::mem::replace(&mut seen[number], true), "stroke {number} is drawn twice");
        check_same(&before.strokes[number], stroke);
        sum += cost(at, stroke.path.start());
        at = stroke.path.end();
    }
    assert!(seen.iter().all(|&s| s), "a stroke is lost");
    assert!((after.cost - sum).abs() <= 1e-9 * sum.max(1.0), "cost {} is not {sum}", after.cost);
    let travel = after.drawing.travel(start);
    assert!((after.travel - travel).abs() <= 1e-9 * travel.max(1.0), "travel {} not {travel}", after.travel);
    assert!(after.lower_bound >= 0.0 && after.lower_bound <= travel * (1.0 + 1e-9));
    assert!(after.gap_percent().is_none_or(|g| g >= -1e-6), "a gap of {:?} %", after.gap_percent());
}

/// Turned round or begun elsewhere, but the same line.
fn check_same(a: &Stroke, b: &Stroke) {
    let (a, b) = (&a.path, &b.path);
    assert_eq!((a.is_closed(), a.elements().len()), (b.is_closed(), b.elements().len()));
    let (was, is) = (a.length(1e-3), b.length(1e-3));
    assert!((was - is).abs() <= 0.02 * (1.0 + was), "a length of {was} became {is}");
    let ends = |p: &Path| [p.start(), p.end()];
    if !a.is_closed() {
        let kept = ends(a) == ends(b);
        let turned = a.start().distance(b.end()) + a.end().distance(b.start()) < 1e-6;
        assert!(kept || turned, "{:?} became {:?}", ends(a), ends(b));
    }
}
