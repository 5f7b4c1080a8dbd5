use std::f64::consts::{PI, TAU};

use tracelight_stroke::{Affine, Path, Point};

use super::plain;
use crate::shapes::{arc, circle, ellipse, line, line_through, polyline, spline};
use crate::{Figure, Hand, Nib, Random};

/// Heights of letters, px.
const HEIGHT_PX: (f64, f64) = (6.0, 30.0);
/// Lengths and diameters of marks, px.
const MARK_PX: (f64, f64) = (5.0, 14.0);
/// The thinnest pen, px, and pens as shares of the height.
const THINNEST_PX: f64 = 1.2;
const PEN_SHARE: (f64, f64) = (1.0 / 12.0, 1.0 / 6.0);
/// Letters of a word, fewest and most.
const LETTERS: (usize, usize) = (1, 7);
/// Letters with three or more lines above each other need this height, in pens.
const TALL_PENS: f64 = 8.0;
/// Of the figures this share is large.
const LARGE: f64 = 0.2;
/// And of the rest this share is a title: in a pen so many times the page's, which is that share of its height.
const TITLES: f64 = 0.15;
const TITLE_LETTERS: (usize, usize) = (3, 7);
const TITLE_PENS: (f64, f64) = (1.5, 4.0);
const TITLE_PEN_SHARE: (f64, f64) = (1.0 / 8.0, 1.0 / 4.5);

/// A word, now and then a large figure, or a title in a fat marker.
pub(super) fn words(random: &mut Random, hand: &Hand) -> Figure {
    if random.chance(LARGE) {
        return large(random, hand);
    }
    if random.chance(TITLES) {
        let marker =
            Hand { pen: hand.pen * random.between(TITLE_PENS.0, TITLE_PENS.1), nib: Nib::Round, ..*hand };
        let height = marker.pen / random.between(TITLE_PEN_SHARE.0, TITLE_PEN_SHARE.1);
        return Figure::lines(&marker, row(random, &marker, height, TITLE_LETTERS));
    }
    let height = random.log_between(HEIGHT_PX.0, HEIGHT_PX.1);
    let small = small(random, hand, height);
    let rows = if random.chance(0.3) { random.whole(2, 4) } else { 1 };
    let row = |i: usize| {
        let down = Affine::translate((0.0, 1.9 * height * i as f64));
        row(random, &small, height, LETTERS).into_iter().map(move |p| p.transformed(down))
    };
    Figure::lines(&small, (0..rows).flat_map(row).collect::<Vec<_>>())
}

/// A word in the page's pen.
pub(super) fn word(random: &mut Random, hand: &Hand) -> Figure {
    let height = random.between(10.0, 15.0) * hand.pen;
    Figure::lines(hand, row(random, hand, height, LETTERS))
}

/// So many letters side by side, their feet at zero.
fn row(random: &mut Random, hand: &Hand, height: f64, (fewest, most): (usize, usize)) -> Vec<Path> {
    let mut x = 0.0;
    let mut paths = Vec::new();
    for _ in 0..random.whole(fewest, most) {
        let wide = height * random.between(0.5, 0.75);
        let drawn = letter(random, (wide, height), height > TALL_PENS * hand.pen);
        paths.extend(drawn.into_iter().map(|p| p.transformed(Affine::translate((x, 0.0)))));
        x += wide + hand.pen + (2.5 * hand.pen).max(2.5) * random.between(1.0, 1.4);
    }
    paths
}

/// A dash, a ring, a tick, a cross or a plus; now and then a large figure.
pub(super) fn marks(random: &mut Random, hand: &Hand) -> Figure {
    if random.chance(0.5 * LARGE) {
        return large(random, hand);
    }
    let size = random.log_between(MARK_PX.0, MARK_PX.1);
    let small = small(random, hand, size);
    let half = 0.5 * size.max(4.5 * small.pen);
    let through = |angle: f64| line_through(Point::ORIGIN, angle, half, half);
    let turn = random.angle();
    let paths = match random.whole(0, 4) {
        0 => vec![through(turn)],
        1 => vec![circle(Point::ORIGIN, half)],
        2 => vec![polyline(
            &[(-0.6, -0.1), (-0.1, 0.6), (0.9, -0.9)].map(|(x, y)| Point::new(x * half, y * half)),
            false,
        )],
        3 => vec![through(0.25 * PI), through(-0.25 * PI)],
        _ => vec![through(0.0), through(0.5 * PI)],
    };
    Figure::lines(&small, paths)
}

fn large(random: &mut Random, hand: &Hand) -> Figure {
    let variants = [plain::closed, plain::bent, plain::free, plain::cornered];
    random.pick(&variants)(random, hand)
}

/// A pen for what is so many px high.
fn small(random: &mut Random, hand: &Hand, height: f64) -> Hand {
    let pen = (height * random.between(PEN_SHARE.0, PEN_SHARE.1)).max(THINNEST_PX);
    Hand { pen: pen.min(0.95 * hand.pen), nib: Nib::Round, ..*hand }
}

/// A letter or digit in a box, its foot at zero; tall ones have more lines above each other.
fn letter(random: &mut Random, (w, h): (f64, f64), tall: bool) -> Vec<Path> {
    let p = |x: f64, y: f64| Point::new(x * w, -y * h);
    let through =
        |points: &[(f64, f64)]| polyline(&points.iter().map(|&(x, y)| p(x, y)).collect::<Vec<_>>(), false);
    let bar = |a: (f64, f64), b: (f64, f64)| line(p(a.0, a.1), p(b.0, b.1));
    let oval = || ellipse(0.5 * w, 0.5 * h).transformed(Affine::translate((0.5 * w, -0.5 * h)));
    match random.whole(0, if tall { 19 } else { 11 }) {
        0 => vec![bar((0.5, 0.0), (0.5, 1.0))],
        1 => vec![through(&[(0.0, 1.0), (0.0, 0.0), (0.9, 0.0)])],
        2 => vec![bar((0.0, 1.0), (1.0, 1.0)), bar((0.5, 1.0), (0.5, 0.0))],
        3 => vec![through(&[(0.0, 1.0), (0.5, 0.0), (1.0, 1.0)])],
        4 => vec![bar((0.0, 0.0), (1.0, 1.0)), bar((0.0, 1.0), (1.0, 0.0))],
        5 => vec![oval()],
        6 => vec![open_ring((w, h), 0.9)],
        7 => vec![hoop((w, h))],
        8 => vec![through(&[(0.0, 1.0), (1.0, 1.0), (0.3, 0.0)])],
        9 => vec![bar((0.0, 0.5), (1.0, 0.5)), bar((0.5, 0.1), (0.5, 0.9))],
        10 => vec![bar((0.0, 0.45), (1.0, 0.45))],
        11 => vec![bar((0.0, 0.0), (1.0, 1.0))],
        12 => vec![through(&[(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)]), bar((0.2, 0.4), (0.8, 0.4))],
        13 => vec![through(&[(1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0)]), bar((0.0, 0.5), (0.8, 0.5))],
        14 => vec![through(&[(1.0, 1.0), (0.0, 1.0), (0.0, 0.0)]), bar((0.0, 0.5), (0.7, 0.5))],
        15 => vec![bar((0.0, 0.0), (0.0, 1.0)), bar((1.0, 0.0), (1.0, 1.0)), bar((0.0, 0.5), (1.0, 0.5))],
        16 => vec![through(&[(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)])],
        17 => vec![through(&[(0.0, 1.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0)])],
        18 => vec![snake((w, h))],
        // Y with one stroke straight through: of three lines that meet alike nobody says which two are one
        _ => vec![bar((1.0, 1.0), (0.2, 0.0)), bar((0.05, 1.0), (0.6, 0.5))],
    }
}

/// C: a ring open to the right by this angle, rad, to either side.
fn open_ring((w, h): (f64, f64), open: f64) -> Path {
    let at = |i: usize| {
        let angle = -open - (TAU - 2.0 * open) * i as f64 / 10.0;
        Point::new(0.5 * w + 0.5 * w * angle.cos(), -0.5 * h + 0.5 * h * angle.sin())
    };
    spline(&(0..=10).map(at).collect::<Vec<_>>(), false)
}

/// U: two legs and a round foot.
fn hoop((w, h): (f64, f64)) -> Path {
    let radius = 0.5 * w;
    let mut path = Path::new(Point::new(0.0, -h));
    path.line_to(Point::new(0.0, -radius));
    let foot = arc(Point::new(radius, -radius), radius, PI, -PI);
    foot.elements().iter().for_each(|&e| path.push(e));
    path.line_to(Point::new(w, -h));
    path
}

/// S.
fn snake((w, h): (f64, f64)) -> Path {
    let p = |x: f64, y: f64| Point::new(x * w, -y * h);
    let points = [(0.95, 0.85), (0.5, 1.0), (0.05, 0.77), (0.5, 0.5), (0.95, 0.23), (0.5, 0.0), (0.05, 0.15)];
    spline(&points.map(|(x, y)| p(x, y)), false)
}
