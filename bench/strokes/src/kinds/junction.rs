use std::f64::consts::PI;

use tracelight_maths::planar;
use tracelight_stroke::{Element, Path, Point};

use crate::shapes::{arc, circle, line, line_through, polar, polyline, spline};
use crate::{Figure, Hand, Random};

pub(super) fn figure(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [tee, why, tree, comb, ladder, letter, on_a_bow, on_a_ring, between_waves];
    let paths = random.pick(&variants)(random, hand.size);
    Figure::lines(hand, paths)
}

/// From 32° to 148° off a line.
fn aside(random: &mut Random) -> f64 {
    random.between(32.0, 148.0).to_radians()
}

fn tee(random: &mut Random, size: f64) -> Vec<Path> {
    let bar = line_through(Point::ORIGIN, 0.0, size * random.between(0.4, 1.0), size);
    vec![bar, line(Point::ORIGIN, polar(Point::ORIGIN, aside(random), size * random.between(0.5, 1.2)))]
}

/// The straightest pair, bent by up to 40°, is one stroke; the third one stands clearly aside.
fn why(random: &mut Random, size: f64) -> Vec<Path> {
    let bend = random.between(0.0, 40.0);
    // the third is at least 20° further from straight with either than the pair is
    let clear = (bend + 25.0 + bend).min(110.0);
    let third = random.between(clear, 360.0 - (180.0 - bend) - (bend + 25.0));
    let from = random.angle();
    let mut arm =
        |degrees: f64| polar(Point::ORIGIN, from + degrees.to_radians(), size * random.between(0.5, 1.0));
    let (first, second) = (arm(0.0), arm(180.0 - bend));
    let third = arm(-third.clamp(45.0, 150.0));
    vec![polyline(&[first, Point::ORIGIN, second], false), line(Point::ORIGIN, third)]
}

/// A curved trunk with branches.
fn tree(random: &mut Random, size: f64) -> Vec<Path> {
    let bow = size * random.between(-0.4, 0.4);
    let mut trunk = Path::new(Point::new(0.0, size));
    trunk.push(Element::Cubic {
        c1: Point::new(bow, 0.4 * size),
        c2: Point::new(-bow, -0.4 * size),
        to: Point::new(0.0, -size),
    });
    let mut paths = vec![trunk.clone()];
    let length = trunk.length(1e-6);
    let mut branch = |share: f64, side: f64| {
        let on = trunk.pieces().next().map(|p| p.at_length(share * length, 1e-9));
        on.into_iter().for_each(|on| {
            let angle = planar::heading(on.tangent) + side * random.between(40.0, 90.0).to_radians();
            paths.push(line(on.point, polar(on.point, angle, size * random.between(0.4, 0.8))));
        });
    };
    branch(0.3, 1.0);
    branch(0.6, -1.0);
    branch(0.8, 1.0);
    paths
}

fn comb(random: &mut Random, size: f64) -> Vec<Path> {
    let mut paths = vec![line_through(Point::ORIGIN, 0.0, size, size)];
    let (teeth, angle) = (random.whole(2, 5), aside(random));
    for i in 0..teeth {
        let foot = Point::new(size * (2.0 * (i as f64 + 1.0) / (teeth as f64 + 1.0) - 1.0), 0.0);
        let side = if random.chance(0.2) { -1.0 } else { 1.0 };
        paths.push(line(foot, polar(foot, side * angle, size * random.between(0.4, 0.9))));
    }
    paths
}

/// Two rails and what stands between them.
fn ladder(random: &mut Random, size: f64) -> Vec<Path> {
    let half = size * random.between(0.3, 0.6);
    let mut paths = vec![
        line(Point::new(-half, -size), Point::new(-half, size)),
        line(Point::new(half, -size), Point::new(half, size)),
    ];
    let (rungs, lean) = (random.whole(1, 4), size * random.between(-0.15, 0.15));
    for i in 0..rungs {
        let y = size * (1.8 * (i as f64 + 1.0) / (rungs as f64 + 1.0) - 0.9);
        paths.push(line(Point::new(-half, y - lean), Point::new(half, y + lean)));
    }
    paths
}

/// A, E, F, H or T.
fn letter(random: &mut Random, size: f64) -> Vec<Path> {
    let (w, h) = (0.65 * size, size);
    let p = |x: f64, y: f64| Point::new(x * w, y * h);
    let through = |points: &[Point]| polyline(points, false);
    match random.whole(0, 4) {
        0 => vec![
            through(&[p(-1., 1.), p(0., -1.), p(1., 1.)]),
            line(p(-1., 1.).lerp(p(0., -1.), 0.4), p(1., 1.).lerp(p(0., -1.), 0.4)),
        ],
        1 => vec![
            through(&[p(1., -1.), p(-1., -1.), p(-1., 1.), p(1., 1.)]),
            line(p(-1., 0.), p(random.between(0.3, 0.9), 0.)),
        ],
        2 => vec![through(&[p(1., -1.), p(-1., -1.), p(-1., 1.)]), line(p(-1., 0.), p(0.6, 0.))],
        3 => vec![
            line(p(-1., -1.), p(-1., 1.)),
            line(p(1., -1.), p(1., 1.)),
            line(p(-1., 0.), p(1., random.between(-0.2, 0.2))),
        ],
        _ => vec![line(p(-1., -1.), p(1., -1.)), line(p(0., -1.), p(0., 1.))],
    }
}

/// Stems on the outside or inside of an arc.
fn on_a_bow(random: &mut Random, size: f64) -> Vec<Path> {
    let sweep = random.between(1.5, 4.0);
    let radius = size * random.between(0.7, 1.0);
    let mut paths = vec![arc(Point::ORIGIN, radius, 0.0, sweep)];
    let stems = random.whole(1, 3);
    for i in 0..stems {
        let at = sweep * (i as f64 + 1.0) / (stems as f64 + 1.0);
        let foot = polar(Point::ORIGIN, at, radius);
        let inward = if random.chance(0.3) { PI } else { 0.0 };
        let way = at + inward + random.between(-0.7, 0.7);
        paths.push(line(foot, polar(foot, way, size * random.between(0.3, 0.5))));
    }
    paths
}

/// A closed figure with lines that end on it.
fn on_a_ring(random: &mut Random, size: f64) -> Vec<Path> {
    let radius = size * random.between(0.4, 0.6);
    let mut paths = vec![circle(Point::ORIGIN, radius)];
    let (rays, from) = (random.whole(1, 5), random.angle());
    for i in 0..rays {
        let at = from + 2.0 * PI * i as f64 / rays as f64;
        let foot = polar(Point::ORIGIN, at, radius);
        paths.push(line(foot, polar(foot, at + random.between(-0.5, 0.5), size * random.between(0.3, 0.6))));
    }
    paths
}

/// A free curve that ends on another one.
fn between_waves(random: &mut Random, size: f64) -> Vec<Path> {
    let mut y = || size * random.between(-0.25, 0.25);
    let points: Vec<_> = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|x| Point::new(x * size, y())).into();
    let foot = points[2];
    let way = planar::direction(planar::heading(points[3] - points[1]) + aside(random));
    let knee = foot + way * (0.4 * size);
    let tip = knee + planar::direction(planar::heading(way) + random.between(-0.7, 0.7)) * (0.5 * size);
    vec![spline(&points, false), spline(&[foot, knee, tip], false)]
}
