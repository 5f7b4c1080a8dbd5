use std::f64::consts::TAU;

use kurbo::Vec2;

use super::search::Search;
use super::*;
use crate::{Element, Path, Stroke};

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self) -> Point {
        Point::new(self.next(), self.next())
    }

    /// A short line, or (every third) a closed triangle.
    fn stroke(&mut self, size: f64, triangles: bool) -> Stroke {
        let at = self.point();
        let mut near = || at + (self.point() - Point::new(0.5, 0.5)) * size;
        let corners = [near(), near(), near()];
        let closed = triangles && self.next() < 0.33;
        let points = if closed { &corners[..] } else { &corners[..2] };
        Stroke::new(Path::polyline(points, closed).unwrap())
    }

    fn drawing(&mut self, strokes: usize, triangles: bool) -> Drawing {
        let size = 0.5 / (strokes as f64).sqrt();
        Drawing { strokes: (0..strokes).map(|_| self.stroke(size, triangles)).collect() }
    }
}

fn euclid(a: Point, b: Point) -> f64 {
    a.distance(b)
}

fn ordered(drawing: &Drawing, effort: Effort) -> Ordered {
    order(drawing, Point::ORIGIN, OrderOptions { effort, seed: 1 }, &euclid)
}

/// What does not change when a stroke is reversed or begun elsewhere, to compare drawings as sets.
fn fingerprints(drawing: &Drawing) -> Vec<(i64, i64)> {
    let print = |s: &Stroke| {
        let points = s.path.pieces().map(|p| p.from).chain((!s.path.is_closed()).then(|| s.path.end()));
        let sum = points.map(|p| p.x + 3.0 * p.y).sum::<f64>();
        ((sum * 1e9).round() as i64, (s.path.length(1e-9) * 1e9).round() as i64)
    };
    let mut prints: Vec<_> = drawing.strokes.iter().map(print).collect();
    prints.sort_unstable();
    prints
}

/// The shortest travel of all orders, directions and start joints, by trying them all.
fn shortest(drawing: &Drawing, at: Point) -> f64 {
    let others = |skip: usize| {
        let kept = drawing.strokes.iter().enumerate().filter(move |(i, _)| *i != skip);
        Drawing { strokes: kept.map(|(_, s)| s.clone()).collect() }
    };
    let through = |(i, s): (usize, &Stroke)| {
        let rest = others(i);
        let ways: Vec<(Point, Point)> = match s.path.is_closed() {
            true => s.path.pieces().map(|p| (p.from, p.from)).collect(),
            false => vec![(s.path.start(), s.path.end()), (s.path.end(), s.path.start())],
        };
        let way = |(entry, exit): (Point, Point)| at.distance(entry) + shortest(&rest, exit);
        ways.into_iter().map(way).fold(f64::INFINITY, f64::min)
    };
    let best = drawing.strokes.iter().enumerate().map(through).fold(f64::INFINITY, f64::min);
    if drawing.strokes.is_empty() { 0.0 } else { best }
}

#[test]
fn an_order_keeps_every_stroke_and_tells_its_travel() {
    for (seed, strokes) in [(1, 2), (2, 3), (3, 40), (4, 700)] {
        let drawing = Random(seed).drawing(strokes, true);
        let result = ordered(&drawing, Effort::Normal);
        assert_eq!(fingerprints(&drawing), fingerprints(&result.drawing));
        assert!((result.travel - result.drawing.travel(Point::ORIGIN)).abs() < 1e-12);
        assert!((result.travel - result.cost).abs() < 1e-12);
        assert!(result.travel < drawing.travel(Point::ORIGIN));
    }
}

#[test]
fn small_drawings_are_ordered_best_and_the_bound_holds() {
    let mut best = 0;
    for seed in 0..60 {
        let drawing = Random(seed).drawing(1 + seed as usize % 6, true);
        let result = ordered(&drawing, Effort::Normal);
        let truth = shortest(&drawing, Point::ORIGIN);
        assert!(result.lower_bound <= truth + 1e-12, "seed {seed}: {} > {truth}", result.lower_bound);
        assert!(result.travel >= truth - 1e-12);
        best += usize::from(result.travel <= truth + 1e-12);
    }
    assert!(best >= 55, "only {best} of 60 orders were the best");
}

/// Strokes between the knots of a small lattice, so that many ends meet.
fn net(random: &mut Random, strokes: usize, size: f64) -> Drawing {
    let mut knot = || Point::new((random.next() * size).floor(), (random.next() * size).floor());
    let mut stroke = |i: usize| {
        let corners = [knot(), knot(), knot()];
        Path::polyline(if i % 4 == 3 { &corners } else { &corners[..2] }, i % 4 == 3).map(Stroke::new)
    };
    Drawing { strokes: (0..strokes).filter_map(&mut stroke).collect() }
}

#[test]
fn no_order_travels_less_than_the_bound() {
    let mut above_nothing = 0;
    for seed in 0..300 {
        let mut random = Random(seed);
        let count = 1 + seed as usize % 6;
        let (drawing, start) = match seed % 3 {
            0 => (random.drawing(count, true), random.point()),
            _ => (net(&mut random, count, 3.0), Point::new(1.0, 1.0)),
        };
        let truth = shortest(&drawing, start);
        for rounds in [0, 15, 60] {
            let bound = bound::lower_bound(&Ports::of(&drawing), start, rounds);
            assert!(bound <= truth + 1e-9, "seed {seed}, {rounds} rounds: {bound} > {truth}");
            above_nothing += usize::from(bound > 0.5 * truth);
        }
    }
    assert!(above_nothing > 600, "only {above_nothing} of 900 bounds say something");
}

#[test]
fn a_search_gains_what_the_tour_gets_shorter_by() {
    for seed in 0..40 {
        let mut random = Random(seed);
        let drawing = if seed % 2 == 0 { random.drawing(60, false) } else { net(&mut random, 60, 6.0) };
        let ends: Vec<_> = drawing.strokes.iter().map(|s| StrokeEnd::of(&s.path).into()).collect();
        let mut search = Search::new(&ends, Point::ORIGIN, &euclid);
        let before = search.total();
        let gained = search.settle();
        let after = search.total();
        assert!((before - after - gained).abs() < 1e-9, "seed {seed}: {before} - {gained} is not {after}");
        search.kick(200, seed);
        assert!(search.total() <= after + 1e-12, "seed {seed}: {} after {after}", search.total());
        assert_eq!(search.sequence().count(), ends.len());
    }
}

#[test]
fn a_net_of_lines_is_drawn_with_as_few_lifts_as_its_odd_junctions_ask() {
    // a ladder of 31 rungs: 58 junctions of three lines, the start at one, and 4 corners of two; every line a stroke
    let at = |x: usize, y: usize| Point::new(0.03 * (x as f64 - 1.0), 0.03 * y as f64);
    let rails = (0..60).map(|i| [at(i % 30, i / 30), at(i % 30 + 1, i / 30)]);
    let rungs = (0..=30).map(|x| [at(x, 0), at(x, 1)]);
    let strokes: Vec<_> =
        rails.chain(rungs).filter_map(|ends| Path::polyline(&ends, false)).map(Stroke::new).collect();
    let ordered = ordered(&Drawing { strokes }, Effort::Normal);
    let mut at = Point::ORIGIN;
    let mut lifts = 0;
    for stroke in &ordered.drawing.strokes {
        lifts += usize::from(at.distance(stroke.path.start()) > 1e-9);
        at = stroke.path.end();
    }
    // 58 odd junctions make 29 lines without a lift, so 28 lifts; each as long as a side at least
    assert_eq!(lifts, 28);
    assert!((ordered.travel - 28.0 * 0.03).abs() < 1e-9, "{}", ordered.travel);
    assert!(ordered.gap_percent().unwrap() < 5.0, "{:?}", ordered.gap_percent());
}

#[test]
fn an_order_of_many_strokes_is_close_to_its_bound() {
    let drawing = Random(7).drawing(2000, false);
    let quick = ordered(&drawing, Effort::Quick);
    let normal = ordered(&drawing, Effort::Normal);
    assert!(normal.travel < 0.97 * quick.travel, "{} of {}", normal.travel, quick.travel);
    assert!(normal.gap_percent().unwrap() < 12.0, "{:?}", normal.gap_percent());
}

#[test]
fn equal_seeds_give_equal_orders() {
    let drawing = Random(11).drawing(300, true);
    assert_eq!(ordered(&drawing, Effort::Normal), ordered(&drawing, Effort::Normal));
}

#[test]
fn no_stroke_and_one_stroke_are_in_order() {
    let nothing = ordered(&Drawing::default(), Effort::Best);
    assert_eq!((nothing.travel, nothing.lower_bound, nothing.gap_percent()), (0.0, 0.0, Some(0.0)));
    let line = Path::polyline(&[Point::new(3.0, 0.0), Point::new(1.0, 0.0)], false).unwrap();
    let one = ordered(&Drawing { strokes: vec![Stroke::new(line)] }, Effort::Normal);
    assert_eq!(one.drawing.strokes[0].path.start(), Point::new(1.0, 0.0));
    assert_eq!((one.travel, one.lower_bound), (1.0, 1.0));
}

#[test]
fn a_closed_stroke_begins_at_a_corner_near_the_way() {
    // a half disc: two corners on the right, a joint of the arc far left and nearest to the start
    let mut path = Path::new(Point::new(5.0, 1.0));
    path.push(Element::Arc { centre: Point::new(5.0, 0.0), sweep: TAU / 4.0 });
    path.push(Element::Arc { centre: Point::new(5.0, 0.0), sweep: TAU / 4.0 });
    path.close();
    let half_disc = Drawing { strokes: vec![Stroke::new(path)] };
    let start = ordered(&half_disc, Effort::Quick).drawing.strokes[0].path.start();
    assert!(start.distance(Point::new(5.0, -1.0)) < 1e-9 || start.distance(Point::new(5.0, 1.0)) < 1e-9);

    let mut circle = Path::new(Point::new(6.0, 0.0));
    for _ in 0..4 {
        circle.push(Element::Arc { centre: Point::new(5.0, 0.0), sweep: TAU / 4.0 });
    }
    circle.close();
    let smooth = Drawing { strokes: vec![Stroke::new(circle)] };
    let start = ordered(&smooth, Effort::Quick).drawing.strokes[0].path.start();
    assert!(start.distance(Point::new(4.0, 0.0)) < 1e-9, "{start:?}");
}

#[test]
fn the_cost_that_is_handed_in_decides() {
    // sideways is ten times as dear: a column is finished before the next one
    let spots = (0..36).map(|i| Point::new(f64::from(i % 6), 0.9 * f64::from(i / 6)));
    let dash = |p: Point| Stroke::new(Path::polyline(&[p, p + Vec2::new(0.01, 0.01)], false).unwrap());
    let drawing = Drawing { strokes: spots.map(dash).collect() };
    let dear = |a: Point, b: Point| 10.0 * (a.x - b.x).abs() + (a.y - b.y).abs();
    let result = order(&drawing, Point::ORIGIN, OrderOptions::default(), &dear);
    let column = |s: &Stroke| s.path.start().x.floor();
    let changes = result.drawing.strokes.windows(2).filter(|w| column(&w[0]) != column(&w[1]));
    assert_eq!(changes.count(), 5);
}

#[test]
fn hostile_points_and_costs_end_the_search_too() {
    let line = |a: Point, b: Point| {
        let mut path = Path::new(a);
        path.push(Element::Line { to: b });
        Stroke::new(path)
    };
    let same = line(Point::new(1.0, 1.0), Point::new(1.0, 1.0));
    let far = line(Point::new(1e308, -1e308), Point::new(-1e308, 1e308));
    let nan = line(Point::new(f64::NAN, 0.0), Point::new(0.0, f64::INFINITY));
    let mut strokes = vec![same; 3000];
    strokes.extend([far, nan.clone(), nan]);
    let drawing = Drawing { strokes };
    assert_eq!(ordered(&drawing, Effort::Normal).drawing.strokes.len(), 3003);
    let mut toggle = Random(5).drawing(200, true);
    toggle.strokes.push(Stroke::new(Path::new(Point::ORIGIN)));
    // one way free, the other dear; and a cost that is no number at all
    let one_way = |a: Point, b: Point| if a.x < b.x { 0.0 } else { 1.0 };
    let costs: [&dyn Fn(Point, Point) -> f64; 2] = [&one_way, &|_, _| f64::NAN];
    for cost in costs {
        let result = order(&toggle, Point::ORIGIN, OrderOptions::default(), &|a, b| cost(a, b));
        assert_eq!(result.drawing.strokes.len(), 201);
    }
}

#[test]
fn strokes_on_top_of_each_other_take_no_longer_than_others() {
    let began = std::time::Instant::now();
    let line = Stroke::new(Path::polyline(&[Point::new(1.0, 1.0), Point::new(2.0, 1.0)], false).unwrap());
    let drawing = Drawing { strokes: vec![line; 40_000] };
    let ordered = ordered(&drawing, Effort::Normal);
    assert!((ordered.travel - 2f64.sqrt()).abs() < 1e-9, "{}", ordered.travel);
    assert!((ordered.lower_bound - ordered.travel).abs() < 1e-9, "{}", ordered.lower_bound);
    // looking at all of them from each of them took two minutes
    assert!(began.elapsed().as_secs() < 20, "{:?}", began.elapsed());
}
