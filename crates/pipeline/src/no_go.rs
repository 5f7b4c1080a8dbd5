//! Areas of the target that are never lit.

use serde::Serialize;
use tracelight_stroke::{Drawing, Path, Piece, Point, Rect, distance_to_segment};

/// Strokes are cut within this of the border, m: a hundredth of a millimetre, on the dark side.
const CUT_TOLERANCE_M: f64 = 1e-5;

/// Borders of areas are polygons that stay within this of them, m.
const BORDER_TOLERANCE_M: f64 = 1e-5;

/// What is left out, for scripts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct LeftOut {
    /// Areas that are kept dark.
    pub areas: usize,
    /// Strokes that enter one.
    pub strokes: usize,
    /// How much of their length is left out, m.
    pub length_m: f64,
    /// How far from an area's border light stays, mm: the spot's radius.
    pub margin_mm: f64,
}

impl LeftOut {
    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let areas = tracelight_task::counted(self.areas, "no-go area");
        if self.strokes == 0 {
            return format!("no stroke enters the {areas}");
        }
        format!(
            "{:.3} m of {} left out, in {areas} and up to {:.1} mm round {}, the spot's radius; dark moves pass there",
            self.length_m,
            tracelight_task::counted(self.strokes, "stroke"),
            self.margin_mm,
            if self.areas == 1 { "it" } else { "them" },
        )
    }
}

/// Areas that are kept dark: closed paths. What lies within any of them is dark, also within a ring's hole.
pub(crate) struct KeptDark {
    areas: Vec<Area>,
    /// How far light stays from them, m.
    margin_m: f64,
}

impl KeptDark {
    pub(crate) fn of(areas: &[Path], margin_m: f64) -> Self {
        Self { areas: areas.iter().filter_map(Area::of).collect(), margin_m }
    }

    /// Whether there is none.
    pub(crate) const fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Nothing left out yet.
    pub(crate) fn nothing_left_out(&self) -> LeftOut {
        LeftOut { areas: self.areas.len(), margin_mm: 1e3 * self.margin_m, ..LeftOut::default() }
    }

    /// A drawing without what lies in one of the areas, or nearer to one than the margin, and what that is.
    pub(crate) fn cut(&self, drawing: &Drawing) -> (Drawing, LeftOut) {
        let mut left_out = self.nothing_left_out();
        let mut strokes = Vec::new();
        for stroke in &drawing.strokes {
            let (parts, lost_m) = self.lit_parts(&stroke.path);
            if lost_m == 0.0 {
                strokes.push(stroke.clone());
                continue;
            }
            left_out.strokes += 1;
            left_out.length_m += lost_m;
            strokes.extend(parts.into_iter().map(|path| stroke.along(path)));
        }
        (Drawing { strokes }, left_out)
    }

    /// Whether all of a path may be lit.
    pub(crate) fn is_clear(&self, path: &Path) -> bool {
        self.is_empty() || self.lit_parts(path).1 == 0.0
    }

    fn lit_parts(&self, path: &Path) -> (Vec<Path>, f64) {
        lit_parts(path, &|p| clearance(&self.areas, p) - self.margin_m)
    }
}

/// The border of an area.
struct Area {
    points: Vec<Point>,
    bounds: Rect,
}

impl Area {
    fn of(path: &Path) -> Option<Self> {
        let points = path.flatten(BORDER_TOLERANCE_M);
        let bounds = points.iter().map(|&p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
        Some(Self { points, bounds })
    }

    /// How far outside a place is, m; negative inside (even-odd rule).
    fn clearance(&self, p: Point) -> f64 {
        let (mut nearest, mut is_inside) = (f64::INFINITY, false);
        for pair in self.points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            nearest = nearest.min(distance_to_segment(p, a, b));
            is_inside ^= (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y);
        }
        if is_inside { -nearest } else { nearest }
    }

    /// No more than that.
    fn clearance_at_least(&self, p: Point) -> f64 {
        let beside = (self.bounds.x0 - p.x).max(p.x - self.bounds.x1).max(0.0);
        let above = (self.bounds.y0 - p.y).max(p.y - self.bounds.y1).max(0.0);
        tracelight_maths::hypot(beside, above)
    }
}

/// How far outside all areas a place is, m.
fn clearance(areas: &[Area], p: Point) -> f64 {
    let nearest = |least: f64, area: &Area| match area.clearance_at_least(p) < least {
        true => least.min(area.clearance(p)),
        false => least,
    };
    areas.iter().fold(f64::INFINITY, nearest)
}

/// The parts of a path where a clearance is above zero, and how long the rest is. The clearance changes by no more than the way along the path.
fn lit_parts(path: &Path, clearance: &dyn Fn(Point) -> f64) -> (Vec<Path>, f64) {
    let mut parts: Vec<Path> = Vec::new();
    let (mut lost_m, mut is_open) = (0.0, false);
    let (mut starts_lit, mut ends_lit) = (false, false);
    for (number, piece) in path.pieces().enumerate() {
        let length = piece.length(1e-7);
        let lit = lit_of(&piece, length, clearance);
        if number == 0 {
            starts_lit = lit.first().is_some_and(|part| part.0 == 0.0);
        }
        lost_m += length - lit.iter().map(|(from, to)| to - from).sum::<f64>();
        is_open &= lit.first().is_some_and(|part| part.0 == 0.0);
        for &(from, to) in &lit {
            let part = if (from, to) == (0.0, length) { piece } else { piece.part(from, to, 1e-7) };
            match parts.last_mut().filter(|_| is_open && from == 0.0) {
                Some(open) => open.push(part.element),
                None => {
                    let mut begun = Path::new(part.from);
                    begun.push(part.element);
                    parts.push(begun);
                }
            }
            is_open = to == length;
        }
        is_open &= !lit.is_empty();
        ends_lit = is_open;
    }
    if lost_m > 0.0 && path.is_closed() && starts_lit && ends_lit && parts.len() > 1 {
        // a closed stroke begins somewhere: its last part goes on in its first
        let first = parts.remove(0);
        if let Some(last) = parts.last_mut() {
            first.elements().iter().for_each(|element| last.push(*element));
        }
    }
    (parts, lost_m.max(0.0))
}

/// The parts of a piece where a clearance is above zero, from and to lengths along it.
fn lit_of(piece: &Piece, length: f64, clearance: &dyn Fn(Point) -> f64) -> Vec<(f64, f64)> {
    if length <= CUT_TOLERANCE_M {
        return if clearance(piece.at(0.5)) > CUT_TOLERANCE_M { vec![(0.0, length)] } else { Vec::new() };
    }
    let mut lit: Vec<(f64, f64)> = Vec::new();
    let mut waiting = vec![(0.0, length)];
    while let Some((from, to)) = waiting.pop() {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let clear = clearance(piece.at_length(middle, 1e-7).point);
        if clear <= -half || (clear <= half && half < CUT_TOLERANCE_M) {
            continue;
        }
        if clear > half {
            match lit.last_mut().filter(|last| last.1 == from) {
                Some(last) => last.1 = to,
                None => lit.push((from, to)),
            }
            continue;
        }
        waiting.extend([(middle, to), (from, middle)]);
    }
    lit
}

/// A rectangle as a closed path.
pub(crate) fn rectangle(area: Rect) -> Option<Path> {
    let corners = [(area.x0, area.y0), (area.x1, area.y0), (area.x1, area.y1), (area.x0, area.y1)];
    Path::polyline(&corners.map(Point::from), true)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use tracelight_maths::{cos, sin};
    use tracelight_stroke::{Element, Stroke};

    use super::*;

    fn cut(drawing: &Drawing, areas: &[Path], margin_m: f64) -> (Drawing, LeftOut) {
        KeptDark::of(areas, margin_m).cut(drawing)
    }

    fn square(side: f64) -> Path {
        rectangle(Rect::new(-0.5 * side, -0.5 * side, 0.5 * side, 0.5 * side)).unwrap()
    }

    fn of(path: Path, margin_m: f64) -> (Vec<Path>, LeftOut) {
        let (drawing, left_out) =
            cut(&Drawing { strokes: vec![Stroke::new(path)] }, &[square(0.2)], margin_m);
        (drawing.strokes.into_iter().map(|s| s.path).collect(), left_out)
    }

    #[test]
    fn a_line_is_cut_at_the_border_with_the_margin() {
        let line = Path::polyline(&[Point::new(-1.0, 0.03), Point::new(1.0, 0.03)], false).unwrap();
        let (parts, left_out) = of(line, 2e-3);
        assert_eq!((parts.len(), left_out.strokes), (2, 1));
        assert!((parts[0].end().x + 0.102).abs() < 2e-5 && (parts[1].start().x - 0.102).abs() < 2e-5);
        assert!(parts[0].end().x <= -0.102 && parts[1].start().x >= 0.102, "{:?}", parts[0].end());
        assert!((left_out.length_m - 0.204).abs() < 4e-5, "{left_out:?}");
        // round a corner the margin is round
        let past = Path::polyline(&[Point::new(-1.0, 0.102), Point::new(1.0, 0.102)], false).unwrap();
        assert_eq!(of(past.clone(), 1.9e-3).1.strokes, 0);
        assert_eq!(of(past, 2.1e-3).1.strokes, 1);
    }

    #[test]
    fn a_closed_stroke_stays_one_piece_where_it_is_lit() {
        let mut circle = Path::new(Point::new(-0.12, 0.0));
        circle.push(Element::Arc { centre: Point::new(-0.22, 0.0), sweep: TAU });
        circle.close();
        let (parts, left_out) = of(circle.clone(), 0.0);
        // it begins beside the square, and is not touched
        assert_eq!((parts.len(), left_out.strokes, parts[0].is_closed()), (1, 0, true));
        let mut crossing = Path::new(Point::new(-0.3, 0.0));
        crossing.push(Element::Arc { centre: Point::new(-0.2, 0.0), sweep: TAU });
        crossing.push(Element::Line { to: Point::new(-0.3, 0.0) });
        crossing.close();
        let grown = cut(&Drawing { strokes: vec![Stroke::new(crossing)] }, &[square(0.24)], 1e-3);
        let parts = &grown.0.strokes;
        assert_eq!(parts.len(), 1, "{parts:?}");
        assert!(
            (parts[0].path.start().x + 0.121).abs() < 2e-5 && (parts[0].path.end().x + 0.121).abs() < 2e-5
        );
        let lit = parts[0].path.length(1e-9);
        assert!((lit + grown.1.length_m - 0.1 * TAU).abs() < 1e-9);
    }

    #[test]
    fn nothing_that_is_left_lies_in_an_area() {
        let mut dice = 12_345_u64;
        let mut draw = || {
            dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            0.6 * ((dice >> 33) as f64 / f64::from(u32::MAX >> 1) - 0.5)
        };
        let mut star = Path::new(Point::new(0.15, 0.0));
        for k in 1..10 {
            let (turn, far) = (TAU * f64::from(k) / 10.0, if k % 2 == 0 { 0.15 } else { 0.06 });
            star.line_to(Point::new(far * cos(turn), far * sin(turn)));
        }
        star.close();
        let areas = [star, square(0.05)];
        let solid: Vec<Area> = areas.iter().filter_map(Area::of).collect();
        for _ in 0..60 {
            let mut place = || Point::new(draw(), draw());
            let mut path = Path::new(place());
            path.push(Element::Cubic { c1: place(), c2: place(), to: place() });
            path.push(Element::Arc { centre: place(), sweep: 2.5 });
            path.line_to(place());
            let whole = path.length(1e-9);
            let (kept, left_out) = cut(&Drawing { strokes: vec![Stroke::new(path)] }, &areas, 1.5e-3);
            for stroke in &kept.strokes {
                for p in stroke.path.flatten(1e-7) {
                    assert!(clearance(&solid, p) >= 1.5e-3 - 1e-7, "{p}");
                }
            }
            let kept_m = kept.length(1e-9);
            assert!((whole - kept_m - left_out.length_m).abs() < 1e-6, "{whole} {kept_m} {left_out:?}");
        }
    }
}
