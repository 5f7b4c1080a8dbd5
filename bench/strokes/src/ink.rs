//! How much of each pixel ink covers.
//!
//! Coverage falls linearly over the pixel that an edge runs through, by the distance of its centre from the edge. That
//! is the exact area for level and upright edges and within 0.06 of it for slanted ones, alike on both sides, so that no
//! edge or middle is moved.

use tracelight_stroke::{Path, Point, Vec2};

use crate::page::crossings;
use crate::plane::Plane;
use crate::warp::Warp;
use crate::{Ink, Nib, Touch};

/// Curves are followed to this, px.
const TOLERANCE_PX: f64 = 0.004;
/// Longer straight pieces are parted, so that the boxes around them stay small, px.
const LONGEST_PX: f64 = 48.0;
/// A sharper corner than this has no mitre: it would be longer than 4 pens (as SVG's default has it).
const MITRE_LIMIT: f64 = 4.0;

/// Puts ink on a plane of coverage, as the camera sees it.
pub(crate) fn draw(plane: &mut Plane, ink: &Ink, warp: Option<&Warp>) {
    let seen = |path: &Path| warp.map_or_else(|| path.clone(), |w| w.path(path)).flatten(TOLERANCE_PX);
    match ink {
        Ink::Line { path, pen, nib } => {
            let points = path.flatten(1.0);
            let scale = warp.map_or(1.0, |w| w.scale(points[points.len() / 2]));
            let line =
                Line { points: parted(&seen(path)), radius: 0.5 * pen * scale, closed: path.is_closed() };
            match nib {
                Nib::Round => line.round(plane),
                Nib::Sharp => line.sharp(plane),
            }
        }
        Ink::Wash { outline, dark } => {
            let mut inside = Plane::filled(plane.width, plane.height, 0.0);
            fill(&mut inside, &[seen(outline)]);
            inside.values.iter_mut().for_each(|value| *value *= *dark as f32);
            plane.at_least(&inside);
        }
        Ink::Fill(paths) => fill(plane, &paths.iter().map(seen).collect::<Vec<_>>()),
        Ink::Touches(touches) => touches.iter().for_each(|t| touch(plane, t, warp)),
        Ink::Scribble { outline, ways, pen } => {
            let lines = || ways.iter().chain([outline]);
            let line = |path| Ink::Line { path, pen: *pen, nib: Nib::Round };
            scribble(plane, &seen(outline), lines().map(|path| line(path.clone())), warp);
        }
    }
}

fn touch(plane: &mut Plane, touch: &Touch, warp: Option<&Warp>) {
    let seen = |p: Point| warp.map_or(p, |w| w.point(p));
    let radius = touch.radius * warp.map_or(1.0, |w| w.scale(touch.at));
    let (a, b) = (seen(touch.at - touch.reach), seen(touch.at + touch.reach));
    let way = b - a;
    let norm = 1.0 / way.hypot2().max(1e-12);
    plane.around(a, b, radius, |p, value| {
        let share = ((p - a).dot(way) * norm).clamp(0.0, 1.0);
        let covered = touch.dark as f32 * coverage(radius - p.distance(a + way * share));
        *value = value.max(covered);
    });
}

/// Share of the darkness where a felt pen goes once; where it goes again, all of it.
const FELT_ONCE: f32 = 0.8;

/// Lines drawn one over the other, as far as they lie inside an outline.
fn scribble(plane: &mut Plane, outline: &[Point], lines: impl Iterator<Item = Ink>, warp: Option<&Warp>) {
    let empty = || Plane::filled(plane.width, plane.height, 0.0);
    let (mut inside, mut inked) = (empty(), empty());
    fill(&mut inside, &[outline.to_vec()]);
    for line in lines {
        let mut own = empty();
        draw(&mut own, &line, warp);
        inked.values.iter_mut().zip(&own.values).for_each(|(v, o)| {
            *v = (*v + (1.0 - *v) * FELT_ONCE * o).min(1.0);
        });
    }
    let drawn = inked.values.iter().zip(&inside.values).map(|(inked, inside)| inked.min(*inside));
    plane.values.iter_mut().zip(drawn).for_each(|(v, d)| *v = v.max(d));
}

/// A spot of ink, for dust.
pub(crate) fn dot(plane: &mut Plane, at: Point, radius: f64) {
    Line { points: vec![at, at], radius, closed: false }.round(plane);
}

fn parted(points: &[Point]) -> Vec<Point> {
    let mut parted = vec![points[0]];
    for pair in points.windows(2) {
        let parts = (pair[0].distance(pair[1]) / LONGEST_PX).ceil().max(1.0) as usize;
        parted.extend((1..=parts).map(|i| pair[0].lerp(pair[1], i as f64 / parts as f64)));
    }
    parted
}

fn coverage(distance_inside: f64) -> f32 {
    (distance_inside + 0.5).clamp(0.0, 1.0) as f32
}

struct Line {
    points: Vec<Point>,
    radius: f64,
    closed: bool,
}

impl Line {
    fn round(&self, plane: &mut Plane) {
        for pair in self.points.windows(2) {
            let (a, way) = (pair[0], pair[1] - pair[0]);
            let norm = 1.0 / way.hypot2().max(1e-12);
            plane.around(pair[0], pair[1], self.radius, |p, value| {
                let share = ((p - a).dot(way) * norm).clamp(0.0, 1.0);
                *value = value.max(coverage(self.radius - p.distance(a + way * share)));
            });
        }
    }

    /// Round, then the ends cut off square and the corners filled up.
    fn sharp(&self, plane: &mut Plane) {
        let mut own = Plane::filled(plane.width, plane.height, 0.0);
        self.round(&mut own);
        let n = self.points.len();
        if !self.closed {
            cut(&mut own, self.points[0], self.points[0] - self.points[1], self.radius);
            cut(&mut own, self.points[n - 1], self.points[n - 1] - self.points[n - 2], self.radius);
        }
        let wrap = self.closed.then(|| [self.points[n - 2], self.points[0], self.points[1]]);
        let corners = self.points.windows(3).map(|w| [w[0], w[1], w[2]]);
        corners.chain(wrap).for_each(|corner| mitre(&mut own, corner, self.radius));
        plane.at_least(&own);
    }
}

/// Takes away what lies beyond an end.
fn cut(plane: &mut Plane, end: Point, out: Vec2, radius: f64) {
    let out = out.normalize();
    plane.around(end, end, radius + 1.0, |p, value| {
        let beyond = (p - end).dot(out);
        if p.distance(end) < radius + 1.0 {
            *value = value.min(coverage(-beyond));
        }
    });
}

/// Fills the outside of a corner up to where the edges meet.
fn mitre(plane: &mut Plane, [before, at, after]: [Point; 3], radius: f64) {
    let (into, out) = ((at - before).normalize(), (after - at).normalize());
    let turn = into.cross(out).atan2(into.dot(out));
    let length = 1.0 / (0.5 * turn).cos();
    if turn.abs() < 0.05 || length > MITRE_LIMIT {
        return;
    }
    let side = -turn.signum();
    let normal = |d: Vec2| Vec2::new(-d.y, d.x) * side;
    plane.around(at, at, radius * length, |p, value| {
        let from = p - at;
        // the kite between the corner and both edges' feet: outside the turn, past neither leg
        let within =
            [radius - from.dot(normal(into)), radius - from.dot(normal(out)), from.dot(into), -from.dot(out)];
        *value = value.max(coverage(within.into_iter().fold(f64::INFINITY, f64::min)));
    });
}

/// The inside of outlines, even-odd.
fn fill(plane: &mut Plane, outlines: &[Vec<Point>]) {
    let mut inside = Plane::filled(plane.width, plane.height, -1.0);
    for y in 0..plane.height {
        let mut at: Vec<f64> = outlines.iter().flat_map(|o| crossings(o, y as f64 + 0.5)).collect();
        at.sort_by(f64::total_cmp);
        for span in at.chunks_exact(2) {
            let pixel = |x: f64| ((x + 0.5).floor().max(0.0) as usize).min(plane.width);
            inside.values[y * plane.width..][pixel(span[0])..pixel(span[1])].fill(1.0);
        }
    }
    // signed distance where it matters: within a pixel of the edge
    for outline in outlines {
        for pair in parted(outline).windows(2) {
            let (a, way) = (pair[0], pair[1] - pair[0]);
            let norm = 1.0 / way.hypot2().max(1e-12);
            inside.around(pair[0], pair[1], 1.0, |p, value| {
                let share = ((p - a).dot(way) * norm).clamp(0.0, 1.0);
                let distance = p.distance(a + way * share) as f32;
                *value = value.signum() * value.abs().min(distance.max(1e-6));
            });
        }
    }
    let covered = inside.values.iter().map(|&v| coverage(f64::from(v)));
    plane.values.iter_mut().zip(covered).for_each(|(v, c)| *v = v.max(c));
}

#[cfg(test)]
mod tests {
    use tracelight_maths::planar;

    use super::*;
    use crate::shapes::{circle, line};

    /// The middle of ink, across a line through (20, 20) at an angle, and its width.
    fn across(ink: &Ink, angle: f64) -> (f64, f64) {
        let mut plane = Plane::filled(40, 40, 0.0);
        draw(&mut plane, ink, None);
        let normal = planar::direction(angle + std::f64::consts::FRAC_PI_2);
        let (mut mass, mut moment, mut rows) = (0.0, 0.0, 0.0);
        for (i, &v) in plane.values.iter().enumerate() {
            let from = Point::new((i % 40) as f64 + 0.5, (i / 40) as f64 + 0.5) - Point::new(20.0, 20.0);
            if from.dot(planar::direction(angle)).abs() < 10.0 {
                mass += f64::from(v);
                moment += f64::from(v) * from.dot(normal);
                rows += 1.0;
            }
        }
        let _ = rows;
        (moment / mass, mass / 20.0)
    }

    #[test]
    fn a_line_lies_where_it_was_drawn_and_is_as_wide() {
        for degrees in [0, 10, 30, 45, 77, 90] {
            let angle = f64::from(degrees).to_radians();
            let way = planar::direction(angle) * 18.0;
            let middle = Point::new(20.0, 20.0) + Vec2::new(-way.y, way.x) * (0.3 / 18.0);
            for nib in [Nib::Round, Nib::Sharp] {
                let ink = Ink::Line { path: line(middle - way, middle + way), pen: 3.0, nib };
                let (off, width) = across(&ink, angle);
                assert!((off - 0.3).abs() < 0.02, "{degrees}°: {off} px");
                assert!((width - 3.0).abs() < 0.15, "{degrees}°: {width} px wide");
            }
        }
    }

    #[test]
    fn a_disc_has_its_area() {
        let mut plane = Plane::filled(40, 40, 0.0);
        draw(&mut plane, &Ink::Fill(vec![circle(Point::new(20.2, 19.7), 12.0)]), None);
        let area: f64 = plane.values.iter().map(|&v| f64::from(v)).sum();
        // an edge moved by 0.02 px changes the area by its length times that
        assert!((area - 452.39).abs() < 75.4 * 0.02, "{area}");
    }

    #[test]
    fn a_mitre_fills_its_corner() {
        let corner = crate::shapes::polyline(&[(5., 20.), (20., 20.), (20., 5.)].map(Point::from), false);
        let ink = |nib| Ink::Line { path: corner.clone(), pen: 6.0, nib };
        let area = |nib| {
            let mut plane = Plane::filled(40, 40, 0.0);
            draw(&mut plane, &ink(nib), None);
            plane.values.iter().map(|&v| f64::from(v)).sum::<f64>()
        };
        assert!((area(Nib::Sharp) - (2. * 15. * 6.)).abs() < 0.6, "{}", area(Nib::Sharp));
    }
}
