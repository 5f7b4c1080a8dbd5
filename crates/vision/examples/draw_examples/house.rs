use std::f64::consts::{FRAC_PI_4, PI};

use tracelight_maths::planar;
use tracelight_stroke::{Drawing, Element, Path, Point};

use super::figures::{circle, curve, line, pen, polygon, ring};

const PEN_PX: f64 = 4.5;

/// Where walls, door and trunk stand.
const GROUND: f64 = 404.0;

/// A house with a smoking chimney, a sun and a tree.
pub(crate) fn house() -> Drawing {
    let parts = [walls_and_roof(), chimney(), door(), window(188.0), window(392.0), tree(), sun()];
    let paths = parts.into_iter().flatten().chain(footpath()).chain([ground()]);
    Drawing { strokes: pen(PEN_PX, paths) }
}

fn walls_and_roof() -> Vec<Path> {
    let roof = polygon(&[(290.0, 98.0), (484.0, 246.0), (96.0, 246.0)]);
    let wall = |u| line(&[(u, 246.0), (u, GROUND)]);
    vec![roof, wall(126.0), wall(454.0), circle((290.0, 184.0), 24.0)]
}

/// Stands on the right slope, which falls by 148 on 194.
fn chimney() -> Vec<Path> {
    let slope = |u: f64| 98.0 + (u - 290.0) * 148.0 / 194.0;
    let stack = line(&[(372.0, slope(372.0)), (372.0, 96.0), (412.0, 96.0), (412.0, slope(412.0))]);
    let smoke = curve(&[
        (392.0, 76.0),
        (398.0, 58.0),
        (420.0, 48.0),
        (446.0, 58.0),
        (474.0, 66.0),
        (500.0, 50.0),
        (492.0, 32.0),
        (474.0, 42.0),
    ]);
    vec![stack, smoke]
}

fn door() -> Vec<Path> {
    let mut frame = line(&[(250.0, GROUND), (250.0, 334.0)]);
    frame.push(Element::Arc { centre: Point::new(290.0, 334.0), sweep: PI });
    frame.line_to(Point::new(330.0, GROUND));
    vec![frame, circle((306.0, 356.0), 6.0)]
}

/// A window of 64 by 72 about an upright centre line.
fn window(centre: f64) -> Vec<Path> {
    let (left, right, top, sill) = (centre - 32.0, centre + 32.0, 284.0, 356.0);
    let frame = polygon(&[(left, top), (right, top), (right, sill), (left, sill)]);
    let upright = line(&[(centre, top), (centre, sill)]);
    vec![frame, upright, line(&[(left, 320.0), (right, 320.0)])]
}

fn tree() -> Vec<Path> {
    let crown = ring(&[
        (556.0, 190.0),
        (598.0, 230.0),
        (600.0, 290.0),
        (556.0, 322.0),
        (512.0, 290.0),
        (514.0, 230.0),
    ]);
    let trunk = line(&[(556.0, 238.0), (556.0, GROUND)]);
    let branch = |to, v| line(&[(556.0, v), (to, v - 26.0)]);
    vec![crown, trunk, branch(582.0, 294.0), branch(532.0, 278.0)]
}

fn sun() -> Vec<Path> {
    let centre = Point::new(98.0, 98.0);
    let ray = |k: i32| {
        let out = planar::direction(FRAC_PI_4 * f64::from(k));
        line(&[(centre + out * 46.0).into(), (centre + out * 70.0).into()])
    };
    (0..8).map(ray).chain([circle(centre.into(), 28.0)]).collect()
}

fn footpath() -> [Path; 2] {
    let left = curve(&[(250.0, GROUND), (234.0, 432.0), (196.0, 452.0)]);
    let right = curve(&[(330.0, GROUND), (324.0, 432.0), (304.0, 452.0)]);
    [left, right]
}

/// Level where something stands on it, falling off at both ends.
fn ground() -> Path {
    let mut line = Path::new(Point::new(34.0, 414.0));
    let cubic = |c1, c2, to| Element::Cubic { c1: Point::from(c1), c2: Point::from(c2), to: Point::from(to) };
    line.push(cubic((60.0, 408.0), (90.0, GROUND), (126.0, GROUND)));
    line.line_to(Point::new(556.0, GROUND));
    line.push(cubic((574.0, GROUND), (590.0, 406.0), (606.0, 411.0)));
    line
}
