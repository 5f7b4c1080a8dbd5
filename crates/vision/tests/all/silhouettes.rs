//! What is cut out of black paper, or white on black, comes back as its outline: limbs, necks and ragged edges with it.

use std::f64::consts::TAU;

use tracelight_image::Grey;
use tracelight_maths::planar;
use tracelight_stroke::{Point, StrokeKind, compare_polylines};
use tracelight_vision::{Options, trace};

use crate::raster::Canvas;

const WIDTH: usize = 360;
const HEIGHT: usize = 300;

/// The level of a pixel by the share of it that is ink.
type Look = fn(f64) -> u8;

/// How a silhouette looks: dark on light with soft edges, the other way round, in two tones.
const LOOKS: [(&str, Look); 3] = [
    ("dark on light", |ink| (245.0 - 215.0 * ink) as u8),
    ("light on dark", |ink| (20.0 + 215.0 * ink) as u8),
    ("white on black, two tones", |ink| if ink >= 0.5 { 255 } else { 0 }),
];

/// Traces closed outlines, filled, in every look: they alone must be found.
fn check(name: &str, outlines: &[Vec<Point>]) {
    let mut canvas = Canvas::new(WIDTH, HEIGHT);
    canvas.fill(outlines);
    for (look, level) in LOOKS {
        let levels = canvas.shares().map(level).collect();
        let found = trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap();
        let strokes = &found.strokes.strokes;
        assert!(strokes.iter().all(|s| s.kind == StrokeKind::Outline), "{name}, {look}: a line");
        assert_eq!(strokes.len(), outlines.len(), "{name}, {look}");
        let drawn: Vec<_> = strokes.iter().map(|s| s.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&drawn, outlines, 2.0).unwrap();
        assert!(comparison.coverage > 0.98 && comparison.precision > 0.98, "{name}, {look}: {comparison:?}");
    }
}

fn closed(points: &[(f64, f64)]) -> Vec<Point> {
    points.iter().chain(&points[..1]).map(|&p| p.into()).collect()
}

#[test]
fn legs_that_taper_are_no_sticks() {
    // from the thigh to the hock a leg narrows, below it is as wide as a pen's line down to the hoof; no two are alike
    let leg = |x: f64, thigh: f64, hock: f64, hoof: f64| {
        let side =
            [(thigh, 165.0), (0.3 * thigh, 0.4 * hock + 99.0), (3.0, hock), (2.6, 232.0), (hoof, 245.0)];
        let back = side.into_iter().rev().map(move |(half, y)| (x - half, y));
        side.into_iter().map(move |(half, y)| (x + half, y)).chain(back)
    };
    let legs = [
        (246.0, 14.0, 196.0, 8.0),
        (206.0, 12.0, 203.0, 6.0),
        (122.0, 18.0, 192.0, 9.0),
        (78.0, 20.0, 199.0, 7.0),
    ];
    let head = [
        (54.0, 150.0),
        (60.0, 120.0),
        (90.0, 105.0),
        (230.0, 110.0),
        (265.0, 60.0),
        (310.0, 70.0),
        (280.0, 95.0),
    ];
    let legs = legs.into_iter().flat_map(|(x, thigh, hock, hoof)| leg(x, thigh, hock, hoof));
    let beast = closed(&head.into_iter().chain(legs).collect::<Vec<_>>());
    check("a beast", &[beast]);
}

#[test]
fn a_body_with_a_neck_is_no_thick_line() {
    let bottle = closed(&[
        (168.0, 20.0),
        (192.0, 20.0),
        (194.0, 90.0),
        (214.0, 130.0),
        (214.0, 275.0),
        (146.0, 275.0),
        (146.0, 130.0),
        (166.0, 90.0),
    ]);
    check("a bottle", &[bottle]);
    let bow: Vec<Point> = (0..=80)
        .map(|k| {
            let turn = TAU * f64::from(k) / 80.0;
            Point::new(95.0, 150.0) + planar::direction(turn + 0.4) * 62.0
        })
        .collect();
    let key =
        [&bow[..73], &[(156.0, 130.0), (320.0, 128.0), (320.0, 176.0), (154.0, 174.0)].map(Point::from)]
            .concat();
    check("a key", &[[&key[..], &key[..1]].concat()]);
    let heart = closed(&[
        (180.0, 110.0),
        (150.0, 60.0),
        (90.0, 55.0),
        (55.0, 100.0),
        (70.0, 160.0),
        (180.0, 275.0),
        (290.0, 160.0),
        (305.0, 100.0),
        (270.0, 55.0),
        (210.0, 60.0),
    ]);
    check("a heart", &[heart]);
}

#[test]
fn a_white_sheet_cut_out_of_black_is_drawn_and_a_ragged_edge_keeps_its_rags() {
    check("a card", &[closed(&[(70.0, 60.0), (300.0, 75.0), (292.0, 240.0), (60.0, 225.0)])]);
    // a leaf whose teeth are 9 px long
    let leaf: Vec<Point> = (0..=120)
        .map(|k| {
            let radius = if k % 2 == 0 { 124.0 } else { 115.0 };
            Point::new(180.0, 150.0) + planar::direction(TAU * f64::from(k) / 120.0) * radius
        })
        .collect();
    check("a leaf", &[leaf]);
}

#[test]
fn a_fat_pens_letters_are_all_lines_or_all_outlines() {
    let p = |x: f64, y: f64| Point::new(x, y);
    let ring = |x: f64, y: f64, radius: f64| -> Vec<Point> {
        let at = |k: i32| p(x, y) + planar::direction(TAU * f64::from(k) / 40.0) * radius;
        (0..=40).map(at).collect()
    };
    // A, l, o, s, and twice an h and an a that run together
    let letters = [
        vec![p(40.0, 180.0), p(66.0, 105.0), p(92.0, 180.0)],
        vec![p(48.0, 155.0), p(86.0, 155.0)],
        vec![p(135.0, 95.0), p(135.0, 182.0)],
        ring(195.0, 158.0, 21.0),
        vec![p(285.0, 128.0), p(258.0, 132.0), p(284.0, 158.0), p(255.0, 180.0)],
    ];
    let joined = |x: f64| {
        vec![
            vec![p(x, 200.0), p(x, 282.0)],
            vec![p(x, 246.0), p(x + 20.0, 238.0), p(x + 27.0, 282.0)],
            ring(x + 58.0, 264.0, 17.0),
            vec![p(x + 76.0, 246.0), p(x + 80.0, 282.0)],
        ]
    };
    let closed = [joined(40.0), joined(200.0)].concat();
    let kinds = |letters: &[Vec<Point>]| {
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        letters.iter().for_each(|line| canvas.pen(line, 22.0));
        let levels = canvas.shares().map(|ink| (235.0 - 190.0 * ink) as u8).collect();
        let found = trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap();
        let lines = found.strokes.strokes.iter().filter(|s| s.kind != StrokeKind::Outline).count();
        (lines, found.strokes.strokes.len())
    };
    let (lines, all) = kinds(&letters);
    assert!(lines == all && all >= 4, "{lines} lines of {all}");
    let (lines, all) = kinds(&[&letters[..], &closed[..]].concat());
    assert!(lines == 0 && all >= 6, "{lines} lines of {all}");
}

#[test]
fn a_gate_between_straight_sides_is_no_sheet_of_paper() {
    let gate = [
        (40.0, 285.0),
        (35.0, 18.0),
        (341.0, 15.0),
        (336.0, 288.0),
        (286.0, 285.0),
        (272.0, 132.0),
        (102.0, 129.0),
        (94.0, 285.0),
    ];
    for is_upside_down in [false, true] {
        let outline = closed(&gate.map(|(x, y)| (x, if is_upside_down { 300.0 - y } else { y })));
        let mut canvas = Canvas::new(WIDTH, HEIGHT);
        canvas.fill(std::slice::from_ref(&outline));
        // photographed: light falls off a little, and no level is even
        let level = |(i, ink): (usize, f64)| {
            let light = 1.0 - 0.08 * (i % WIDTH) as f64 / WIDTH as f64;
            ((25.0 + 210.0 * ink) * light + (i * 7919 % 7) as f64) as u8
        };
        let levels = canvas.shares().enumerate().map(level).collect();
        let found = trace(&Grey::new(WIDTH, HEIGHT, levels).unwrap(), &Options::default()).unwrap();
        let drawn: Vec<_> = found.strokes.strokes.iter().map(|s| s.path.flatten(0.02)).collect();
        let comparison = compare_polylines(&drawn, &[outline], 2.0).unwrap();
        assert!(comparison.coverage > 0.98 && comparison.precision > 0.98, "{comparison:?}");
    }
}
